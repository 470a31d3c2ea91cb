//! One drop and one part of a product file: of each range the value that is worst as far as one can tell beforehand.

use std::path::Path;

use clatter::End;
use clatter_assess::units::{Quantity, Unit};
use clatter_assess::{Component, Damping, Fall, First, Mount, ProductFile, Spread};
use clatter_flight::ContactLaw;
use clatter_shock::DampingRatio;

use crate::numbers::given;
use crate::quantities::{Place, Show, neat};
use crate::text::{shown, visible};
use crate::{Failure, Streams, assess};

/// A part of a product file, each range at one value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PartSetup {
    pub(crate) place: Place,
    /// Natural frequency and damping; none of a part that is mounted rigidly.
    pub(crate) suspension: Option<(Quantity, DampingRatio)>,
}

/// A product file of which one drop is taken.
pub(crate) struct OneDrop {
    file: ProductFile,
    component: Option<usize>,
    /// The end that touches first is called a: where it is b, the product is seen from behind.
    mirrored: bool,
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
    pub(crate) fn read(path: &Path, component: Option<&str>, streams: &mut Streams<'_>) -> Result<Self, Failure> {
        let file = assess::read(path, streams)?;
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
        let mirrored = file.drop.first == First::End(End::B);
        let mut notes = Vec::new();
        if mirrored {
            notes.push(
                "end b touches first and is called a here: places of the file are turned around; those of --at, \
                 --center-of-mass and --mass are not, they count towards the end that strikes second"
                    .to_owned(),
            );
        }
        if file.drop.first == First::Either {
            notes.push("either end may touch first: taken is end a".to_owned());
        }
        Ok(Self { file, component: found, mirrored, notes })
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
    /// Position of the center of mass, and radius of gyration over the half-length.
    pub(crate) fn inertia(&self) -> (f64, f64) {
        let body = &self.file.product.body;
        let ([a, b], side) = (body.arms_m(), if self.mirrored { -1.0 } else { 1.0 });
        (side * (a - b) / (a + b) + 0.0, 2.0 * body.gyration_m() / (a + b))
    }
    pub(crate) fn has_contact_time(&self) -> bool {
        self.file.product.contact_time_s.is_some()
    }
    pub(crate) fn contact_time_s(&mut self) -> Option<f64> {
        let spread = self.file.product.contact_time_s?;
        Some(Self::take(&mut self.notes, "contact time", &spread, Taken::Least, "s"))
    }
    pub(crate) fn contact_law(&self) -> ContactLaw {
        self.file.product.law()
    }
    pub(crate) fn restitution(&mut self) -> f64 {
        Self::take(&mut self.notes, "restitution", &self.file.product.restitution, Taken::Largest, "")
    }
    pub(crate) fn tilt_deg(&mut self) -> f64 {
        neat(Self::take(&mut self.notes, "tilt", &self.file.drop.tilt_rad, Taken::Middle, "rad").to_degrees())
    }
    pub(crate) fn gravity_m_s2(&self) -> f64 {
        self.file.drop.gravity_m_s2
    }
    /// Speed or height.
    pub(crate) fn fall(&mut self) -> (Option<f64>, Option<f64>) {
        match &self.file.drop.fall {
            Fall::SpeedMS(speed) => (Some(Self::take(&mut self.notes, "speed", speed, Taken::Largest, "m/s")), None),
            Fall::HeightM(height) => (None, Some(Self::take(&mut self.notes, "height", height, Taken::Largest, "m"))),
        }
    }

    fn component(&self) -> Option<&Component> {
        self.component.and_then(|i| self.file.components.get(i))
    }

    /// The part on a body of this half-length; none where it is not named.
    pub(crate) fn part(&mut self, half_m: f64) -> Result<Option<PartSetup>, Failure> {
        let Some(component) = self.component().cloned() else { return Ok(None) };
        let notes = &mut self.notes;
        let position_m = Self::take(notes, "position", &component.position_m, Taken::Middle, "m");
        if component.extent_m > 0.0 {
            let extent = Show { unit: component.position_m.unit(), name: "m" }.given(component.extent_m);
            notes.push(format!("the part extends over {extent}: taken is its middle"));
        }
        let side = if self.mirrored { -1.0 } else { 1.0 };
        let length = Quantity { si: side * position_m, unit: component.position_m.unit() };
        let suspension = match component.mount {
            Mount::Hard => None,
            Mount::Suspended { frequency_hz, damping } => {
                let hz = Self::take(notes, "natural frequency", &frequency_hz, Taken::Middle, "Hz");
                let frequency = Quantity { si: hz, unit: frequency_hz.unit() };
                Some((frequency, Self::damping(notes, &damping)?))
            }
        };
        if length.si.abs() > half_m * (1.0 + 1e-9) {
            return Err(Failure::Wrong(format!(
                "the component is {} m from the middle of a body of {} m: its position is beyond the end",
                given(neat(length.si.abs())),
                given(neat(2.0 * half_m))
            )));
        }
        Ok(Some(PartSetup { place: Place::Length(length), suspension }))
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
        self.component().and_then(|component| component.limits.acceleration_m_s2).and_then(|limit| limit.unit())
    }
}
