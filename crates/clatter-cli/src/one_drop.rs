//! One drop and one part of a product file: of each range the value that is worst as far as one can tell beforehand.

use std::path::Path;

use clatter::End;
use clatter_assess::units::{Quantity, Unit};
use clatter_assess::{
    Accuracy, Component, Damping, Fall, Feet, First, Limit, LimitKind, Limits, Mount, OwnContacts, ProductFile, Side,
    Spread, WorstCase,
};
use clatter_flight::ContactLaw;
use clatter_shock::DampingRatio;

use crate::numbers::given;
use crate::output::Files;
use crate::quantities::{Place, Show, neat};
use crate::text::{shown, visible};
use crate::words::drop;
use crate::{Failure, Streams, assess};

/// A part of a product file, each range at one value.
#[derive(Debug, Clone)]
pub(crate) struct PartSetup {
    pub(crate) name: String,
    /// Its middle, of a bar as the drop is seen; along the product and across a plate.
    pub(crate) place: [Place; 2],
    /// Where its worst place is one of, in m from the middle of the product.
    pub(crate) places_m: Vec<[f64; 2]>,
    pub(crate) limits: Limits,
    /// The same as numbers.
    pub(crate) allowed: Vec<Limit>,
    /// Natural frequency and damping; none of a part that is mounted rigidly.
    pub(crate) suspension: Option<(Quantity, DampingRatio)>,
}

/// Of which limit of a part the worst drop is taken: of this kind, or of the one with the least margin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Worst(Option<LimitKind>);

impl clap::ValueEnum for Worst {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Worst; LimitKind::ALL.len() + 1] = {
            let mut all = [Worst(None); LimitKind::ALL.len() + 1];
            let mut k = 0;
            while k < LimitKind::ALL.len() {
                all[k + 1] = Worst(Some(LimitKind::ALL[k]));
                k += 1;
            }
            all
        };
        &ALL
    }
    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        let (name, help) =
            self.0.map_or(("tightest", "the one with the least margin"), |kind| (kind.name(), kind.allowed()));
        Some(clap::builder::PossibleValue::new(name).help(help))
    }
}

/// A product file of which one drop is taken.
pub(crate) struct OneDrop {
    file: ProductFile,
    component: Option<usize>,
    /// Whether end b touches first: the product is then seen from behind, so that the end in front is a.
    mirrored: bool,
    /// The worst drop of the ranges, where that is the one.
    worst: Option<WorstCase>,
    notes: Vec<String>,
}

/// Which value of a range is taken.
#[derive(Clone, Copy)]
enum Taken {
    Least,
    Largest,
    Middle,
}

impl OneDrop {
    pub(crate) fn read(
        path: &Path,
        component: Option<&str>,
        first: Option<End>,
        at_worst: bool,
        files: &Files<'_>,
        streams: &mut Streams<'_>,
    ) -> Result<Self, Failure> {
        let file = assess::read(path, files, streams)?;
        if !(file.landings.is_empty() || at_worst) {
            let (path, is, others) = if file.is_box() {
                (crate::text::path(path), "is that of a box", "--thickness and --orientation")
            } else {
                (crate::text::path(path), "lists several drops", "options in place of the file")
            };
            return Err(Failure::Wrong(format!(
                "{path} {is}: 'clatter respond --worst' takes its worst drop; give others by {others}"
            )));
        }
        let found = match component {
            Some(name) => {
                let found = file
                    .components
                    .iter()
                    .position(|component| component.name.trim_matches(' ') == name.trim_matches(' '));
                let names = || {
                    let names: Vec<_> = file.components.iter().map(|c| format!("\"{}\"", shown(&c.name, 60))).collect();
                    names.join(", ")
                };
                Some(found.ok_or_else(|| {
                    let (path, name) = (crate::text::path(path), visible(name));
                    Failure::Wrong(format!("{path} has no component \"{name}\": its components are {}", names()))
                })?)
            }
            None => (file.components.len() == 1).then_some(0),
        };
        let mut notes = Vec::new();
        let first = first.unwrap_or_else(|| match file.drop.first {
            First::End(end) => end,
            // Of a plate its direction tells the corner.
            First::Either if file.product.body.is_wide() => End::A,
            First::Either => {
                notes.push("either end may touch first: taken is end a".to_owned());
                End::A
            }
        });
        Ok(Self { file, component: found, mirrored: first == End::B, worst: None, notes })
    }

    /// The drop of the ranges that asks most of a limit of the part, found as an assessment finds it.
    pub(crate) fn at_worst(mut self, of: Worst, accuracy: &Accuracy) -> Result<Self, Failure> {
        let Some(component) = self.component() else {
            return Err(Failure::Usage("--worst is the drop that asks most of one part: give its --component=NAME"));
        };
        let part = assess::watched_one(&self.file, component, accuracy)?;
        let found = match of.0 {
            None => part.tightest(),
            Some(kind) => part.limits.iter().find(|limit| limit.limit == kind).ok_or_else(|| {
                let has: Vec<_> = part.limits.iter().map(|limit| limit.limit.name()).collect();
                let (name, has) = (shown(&part.name, 60), has.join(", "));
                Failure::Wrong(format!("\"{name}\" has no limit {}: its limits are {has}", kind.name()))
            })?,
        };
        let Some(worst) = &found.worst_case else {
            let why = found.why_undecided().unwrap_or_default();
            return Err(Failure::Wrong(format!("no worst drop is known: {why}")));
        };
        let limit = found.limit.name();
        self.mirrored = worst.drop.first() == End::B && !self.is_plate();
        self.notes = vec![format!("the worst drop of its ranges, for the {limit} limit: {}", drop(worst))];
        self.worst = Some(*worst);
        Ok(self)
    }

    /// Whether both ends land as one.
    pub(crate) fn is_flat(&self) -> bool {
        self.worst.as_ref().is_some_and(|worst| worst.drop.is_flat)
    }

    pub(crate) fn is_plate(&self) -> bool {
        self.file.product.body.is_wide()
    }

    /// The worst drop of a box, where that is the one.
    pub(crate) fn worst_of_box(&self) -> Option<WorstCase> {
        self.worst.filter(|_| self.file.is_box())
    }

    pub(crate) fn is_mirrored(&self) -> bool {
        self.mirrored
    }

    pub(crate) fn note(&mut self, note: &str) {
        self.notes.push(note.to_owned());
    }

    pub(crate) fn into_notes(self) -> impl Iterator<Item = String> {
        let product = shown(&self.file.product.name, 60);
        self.notes.into_iter().map(move |note| format!("{product}: {note}"))
    }

    /// One value of a range; of a range, it is told which.
    fn take(notes: &mut Vec<String>, name: &str, spread: &Spread, taken: Taken, si: &'static str) -> f64 {
        let (value, which) = match taken {
            Taken::Least => (spread.lo(), "the least"),
            Taken::Largest => (spread.hi(), "the largest"),
            Taken::Middle => (spread.at(0.5), "the middle"),
        };
        if !spread.is_value() {
            let show = Show { unit: spread.unit(), name: si };
            let [value, lo, hi] = [value, spread.lo(), spread.hi()].map(|x| given(neat(show.value(x))));
            let unit = if show.name().is_empty() { String::new() } else { format!(" {}", show.name()) };
            notes.push(format!("{name} = {value}{unit}, {which} of {lo} to {hi}{unit}"));
        }
        value
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.file.product.body.length_m()
    }
    /// Between its ends or feet, of a product of the file that is so long from edge to edge.
    pub(crate) fn length_of(&self, edges_m: f64) -> Result<f64, Failure> {
        let beyond_m = self.file.product.body.feet.map_or(0.0, |feet| 2.0 * feet.inset_m[0]);
        if edges_m > beyond_m {
            return Ok(edges_m - beyond_m);
        }
        let [edges, beyond] = [edges_m, beyond_m].map(|m| given(neat(1e3 * m)));
        Err(Failure::Wrong(format!("--length: the feet of the product leave out {beyond} mm of its {edges} mm")))
    }
    /// Position of the center of mass, and radius of gyration over the half-length.
    pub(crate) fn inertia(&mut self) -> (f64, f64) {
        let gyration_m = self.worst.as_ref().and_then(WorstCase::gyration_m).unwrap_or_else(|| {
            Self::take(&mut self.notes, "radius of gyration", &self.file.product.gyration_m, Taken::Middle, "m")
        });
        (self.center_of_mass(), 2.0 * gyration_m / self.length_m())
    }
    pub(crate) fn center_of_mass(&self) -> f64 {
        let ([a, b], side) = (self.file.product.body.arms_m(), if self.mirrored { -1.0 } else { 1.0 });
        side * (a - b) / (a + b) + 0.0
    }
    pub(crate) fn has_contact_time(&self) -> bool {
        self.file.product.contact_time_s.is_some()
    }
    pub(crate) fn contact_time_s(&mut self) -> Option<f64> {
        if let Some(worst) = &self.worst {
            return worst.drop.contact_time_s;
        }
        let spread = self.file.product.contact_time_s?;
        Some(Self::take(&mut self.notes, "contact time", &spread, Taken::Least, "s"))
    }
    /// The same with a word, where edges beyond its feet are not looked at.
    pub(crate) fn on_feet_alone(mut self) -> Self {
        if self.file.product.body.feet.is_some() {
            self.note("its ends here are its feet; edges beyond them are not looked at, as 'clatter respond' does");
        }
        self
    }
    /// Refuses contacts that differ.
    pub(crate) fn alike(self) -> Result<Self, Failure> {
        if self.own_contacts().is_none() {
            return Ok(self);
        }
        Err(Failure::Wrong(
            "'clatter simulate' takes a product whose contacts are alike, without `contacts` of their own; 'clatter respond' takes them"
                .to_owned(),
        ))
    }
    /// Contacts of their own.
    pub(crate) fn own_contacts(&self) -> OwnContacts {
        self.file.product.own_contacts
    }
    /// Feet that it lands on.
    pub(crate) fn feet(&self) -> Option<Feet> {
        self.file.product.body.feet
    }
    pub(crate) fn contact_law(&self) -> ContactLaw {
        self.file.product.law()
    }
    pub(crate) fn restitution(&mut self) -> f64 {
        if let Some(worst) = &self.worst {
            return worst.drop.restitution;
        }
        Self::take(&mut self.notes, "restitution", &self.file.product.restitution, Taken::Largest, "")
    }
    /// Angular velocity at the first touch about the axis of the tilt, positive where that grows.
    pub(crate) fn spin_rad_s(&mut self) -> f64 {
        if let Some(worst) = &self.worst {
            return worst.drop.spin_rad_s;
        }
        neat(Self::take(&mut self.notes, "spin", &self.file.drop.spin_rad_s, Taken::Middle, "rad/s"))
    }
    pub(crate) fn tilt_deg(&mut self) -> f64 {
        if let Some(worst) = &self.worst {
            return worst.tilt_deg();
        }
        neat(Self::take(&mut self.notes, "tilt", &self.file.drop.tilt_rad, Taken::Middle, "rad").to_degrees())
    }
    /// Where a plate rises to.
    pub(crate) fn direction_deg(&mut self) -> f64 {
        if let Some(direction) = self.worst.as_ref().and_then(WorstCase::direction_deg) {
            return direction;
        }
        let Some(spread) = &self.file.drop.direction_rad else {
            self.notes.push("it may rise to any direction: taken is 45 deg, corner a first".to_owned());
            return 45.0;
        };
        neat(Self::take(&mut self.notes, "direction", spread, Taken::Middle, "rad").to_degrees())
    }
    pub(crate) fn width(&self) -> Option<Side> {
        self.file.product.body.width
    }
    pub(crate) fn product_of_inertia_m2(&self) -> f64 {
        self.file.product.body.products_m2[0]
    }
    pub(crate) fn gravity_m_s2(&self) -> f64 {
        self.file.drop.gravity_m_s2
    }
    /// Speed or height.
    pub(crate) fn fall(&mut self) -> (Option<f64>, Option<f64>) {
        if let Some(worst) = &self.worst {
            return (Some(worst.drop.speed_m_s), None);
        }
        match &self.file.drop.fall {
            Fall::SpeedMS(speed) => (Some(Self::take(&mut self.notes, "speed", speed, Taken::Largest, "m/s")), None),
            Fall::HeightM(height) => (None, Some(Self::take(&mut self.notes, "height", height, Taken::Largest, "m"))),
        }
    }

    fn component(&self) -> Option<&Component> {
        self.component.and_then(|i| self.file.components.get(i))
    }

    /// The part on a body of these half-sides, across 0 of a bar; none where it is not named.
    pub(crate) fn part(&mut self, halves_m: [f64; 2]) -> Result<Option<PartSetup>, Failure> {
        let Some(component) = self.component().cloned() else { return Ok(None) };
        let notes = &mut self.notes;
        let (at_m, places_m) = if let Some(WorstCase { part, .. }) = &self.worst {
            let at_m = part.place.plan_m();
            (at_m, component.places_m().into_iter().chain([at_m]).collect())
        } else {
            let along = Self::take(notes, "position", &component.position_m, Taken::Middle, "m");
            let across = Self::take(notes, "position across", &component.across_m, Taken::Middle, "m");
            ([along, across], component.places_at_m([along, across]))
        };
        let side = if self.mirrored { -1.0 } else { 1.0 };
        let place = |si, spread: &Spread| Place::Length(Quantity { si, unit: spread.unit() });
        let place = [place(side * at_m[0], &component.position_m), place(at_m[1], &component.across_m)];
        let suspension = match component.mount {
            Mount::Hard => None,
            Mount::Suspended { frequency_hz, damping } => {
                let unit = frequency_hz.unit();
                let worst = self.worst.as_ref().and_then(|worst| worst.frequency_hz().zip(worst.damping_ratio()));
                Some(if let Some((si, ratio)) = worst {
                    (Quantity { si, unit }, DampingRatio::new(ratio)?)
                } else {
                    let si = Self::take(notes, "natural frequency", &frequency_hz, Taken::Middle, "Hz");
                    (Quantity { si, unit }, Self::damping(notes, &damping)?)
                })
            }
        };
        let beyond_m = self.file.product.body.feet.map_or([0.0; 2], |feet| feet.inset_m);
        for (side, half_m) in halves_m.into_iter().enumerate() {
            let half_m = half_m + beyond_m[side];
            let farthest = places_m.iter().fold(0.0_f64, |most, at| most.max(at[side].abs()));
            if farthest > half_m * (1.0 + 1e-9) {
                return Err(Failure::Wrong(format!(
                    "the component is {} m from the middle of a body of {} m: its position is beyond the end",
                    given(neat(farthest)),
                    given(neat(2.0 * half_m))
                )));
            }
        }
        Ok(Some(PartSetup {
            place,
            places_m,
            suspension,
            allowed: Limit::of(&component),
            limits: component.limits,
            name: component.name,
        }))
    }

    /// The least damping.
    fn damping(notes: &mut Vec<String>, damping: &Damping) -> Result<DampingRatio, Failure> {
        let given = match damping {
            Damping::Ratio(ratio) => Self::take(notes, "damping ratio", ratio, Taken::Least, ""),
            Damping::Quality(quality) => Self::take(notes, "quality factor", quality, Taken::Largest, ""),
        };
        Ok(damping.ratio(given)?)
    }

    pub(crate) fn length_unit(&self) -> Option<&'static Unit> {
        let height = if let Fall::HeightM(height) = &self.file.drop.fall { height.unit() } else { None };
        self.component().or(self.file.components.first()).and_then(|c| c.position_m.unit()).or(height)
    }
    pub(crate) fn speed_unit(&self) -> Option<&'static Unit> {
        if let Fall::SpeedMS(speed) = &self.file.drop.fall { speed.unit() } else { None }
    }
    pub(crate) fn time_unit(&self) -> Option<&'static Unit> {
        self.file.product.contact_time_s.and_then(|time| time.unit())
    }
    pub(crate) fn acceleration_unit(&self) -> Option<&'static Unit> {
        self.component()
            .and_then(|component| component.limits.unit(LimitKind::Acceleration, LimitKind::Acceleration.unit()))
    }
}
