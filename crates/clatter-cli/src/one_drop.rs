//! This module takes one drop and one part from a product file: of each range the value that is worst as far as can be known beforehand.

use std::path::Path;

use clatter::End;
use clatter_assess::{Accuracy, Part, WorstCase};
use clatter_product::{
    Component, Damping, Drop, Fall, First, Input, Limit, LimitKind, Limits, Mount, Place, ProductFile, Spread, Stops,
    units::{Quantity, Unit},
};
use clatter_shock::{DampingRatio, Stop};

use crate::numbers::given;
use crate::output::Files;
use crate::quantities::{Show, neat};
use crate::text::{shown, visible};
use crate::words::drop;
use crate::{Failure, Streams, assess};

/// A part of a product file, each range at one value.
#[derive(Debug, Clone)]
pub(crate) struct PartSetup {
    pub(crate) name: String,
    /// Its middle.
    pub(crate) middle: Place,
    /// The places of which its worst place is one.
    pub(crate) places: Vec<Place>,
    /// The units in which the file has its place.
    pub(crate) units: [Option<&'static Unit>; 2],
    pub(crate) limits: Limits,
    /// The same as numbers.
    pub(crate) allowed: Vec<Limit>,
    /// Natural frequency and damping; none of a part that is mounted rigidly.
    pub(crate) suspension: Option<(Quantity, DampingRatio)>,
    /// Its stops.
    pub(crate) stop: Option<Stop>,
}

/// The limit of a part that the worst drop is taken of: the one of this kind, or the one with the least margin.
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
    /// The end that touches first.
    first: End,
    /// The worst drop of the ranges, where that is the one.
    worst: Option<WorstCase>,
    notes: Vec<String>,
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
                let is_it = |component: &Component| component.name.trim_matches(' ') == name.trim_matches(' ');
                let found = file.components.iter().position(is_it);
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
            // The direction of a plate decides the corner.
            First::Either if file.product.body.is_wide() => End::A,
            First::Either => {
                notes.push("either end may touch first: taken is end a".to_owned());
                End::A
            }
        });
        Ok(Self { file, component: found, first, worst: None, notes })
    }

    /// Finds the drop of the ranges with the highest demand on a limit of the part, as an assessment finds it.
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
        self.notes = vec![format!("the worst drop of its ranges, for the {limit} limit: {}", drop(worst))];
        self.worst = Some(*worst);
        Ok(self)
    }

    /// Returns the worst drop of its ranges, where the drop is that one.
    pub(crate) fn worst(&self) -> Option<&WorstCase> {
        self.worst.as_ref()
    }

    pub(crate) fn note(&mut self, note: &str) {
        self.notes.push(note.to_owned());
    }

    pub(crate) fn into_notes(self) -> impl Iterator<Item = String> {
        let product = shown(&self.file.product.name, 60);
        self.notes.into_iter().map(move |note| format!("{product}: {note}"))
    }

    /// Returns the drop and its fall height: each input has the value of the highest demand, except those that are given otherwise.
    pub(crate) fn drop(&mut self, is_given: impl Fn(Input) -> bool) -> (Drop, Option<f64>) {
        let (notes, mut height_m) = (&mut self.notes, None);
        let mut drop = self.file.one_drop(self.first, |row, spread| {
            let notes = if is_given(row.input) { None } else { Some(&mut *notes) };
            let value = take(notes, row.words, spread, row.hardest, row.unit);
            height_m = if row.input == Input::Height { Some(value) } else { height_m };
            if row.input.is_angle() { round_angle(value, spread) } else { value }
        });
        if drop.body.is_wide() {
            drop.direction_rad = match &self.file.drop.direction_rad {
                _ if is_given(Input::Direction) => 0.0,
                Some(spread) => round_angle(take(Some(notes), "direction", spread, 0.5, "rad"), spread),
                None => {
                    notes.push("it may rise to any direction: taken is 45 deg, corner a first".to_owned());
                    45_f64.to_radians()
                }
            };
        }
        (drop, height_m)
    }

    /// Returns the length between ends or feet of a product of the file that is so long from edge to edge.
    pub(crate) fn length_of(&self, edges_m: f64) -> Result<f64, Failure> {
        let beyond_m = self.file.product.body.feet.map_or(0.0, |feet| 2.0 * feet.inset_m[0]);
        if edges_m > beyond_m {
            return Ok(edges_m - beyond_m);
        }
        let [edges, beyond] = [edges_m, beyond_m].map(|m| given(neat(1e3 * m)));
        Err(Failure::Wrong(format!("--length: the feet of the product leave out {beyond} mm of its {edges} mm")))
    }

    fn component(&self) -> Option<&Component> {
        self.component.and_then(|i| self.file.components.get(i))
    }

    /// Returns the part; none where it is not named.
    pub(crate) fn part(&mut self) -> Result<Option<PartSetup>, Failure> {
        let Some(component) = self.component().cloned() else { return Ok(None) };
        let (notes, worst) = (&mut self.notes, self.worst.as_ref());
        let (middle, places) = if let Some(WorstCase { part: Part { place, .. }, .. }) = worst {
            let others = component.places_m().into_iter().map(|[x, y]| [x, y, place.at_m[2]]);
            (*place, others.chain([place.at_m]).map(|at_m| Place { at_m, axis: place.axis }).collect())
        } else {
            let along = take(Some(notes), "position", &component.position_m, 0.5, "m");
            let across = take(Some(notes), "position across", &component.across_m, 0.5, "m");
            let places = component.places_at_m([along, across]).into_iter().map(Place::flat).collect();
            (Place::flat([along, across]), places)
        };
        let suspension = match component.mount {
            Mount::Hard => None,
            Mount::Suspended { frequency_hz, damping } => {
                let unit = frequency_hz.unit();
                let worst = worst.and_then(|worst| worst.frequency_hz().zip(worst.damping_ratio()));
                Some(if let Some((si, ratio)) = worst {
                    (Quantity { si, unit }, DampingRatio::new(ratio)?)
                } else {
                    let si = take(Some(notes), "natural frequency", &frequency_hz, 0.5, "Hz");
                    let given = match &damping {
                        Damping::Ratio(ratio) => take(Some(notes), "damping ratio", ratio, 0.0, ""),
                        Damping::Quality(quality) => take(Some(notes), "quality factor", quality, 1.0, ""),
                    };
                    (Quantity { si, unit }, damping.ratio(given)?)
                })
            }
        };
        let stop = match (&component.stops, worst.and_then(|worst| worst.part.suspension)) {
            (_, Some(part)) => part.stop(),
            (Some(stops), None) => {
                let mut numbers = [0.0; 3];
                for (n, (input, range)) in Stops::INPUTS.iter().zip(stops.ranges()).enumerate() {
                    let unit = if input.unit == "1" { "" } else { input.unit };
                    numbers[n] = take(Some(notes), input.words, range, Stops::HARDEST[n], unit);
                }
                Some(Stops::of(numbers)?)
            }
            (None, None) => None,
        };
        Ok(Some(PartSetup {
            middle,
            places,
            units: [component.position_m.unit(), component.across_m.unit()],
            suspension,
            stop,
            allowed: Limit::of(&component),
            limits: component.limits,
            name: component.name,
        }))
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

impl PartSetup {
    /// Refuses places beyond a product of these sides.
    pub(crate) fn check_within(&self, sides_m: [f64; 2]) -> Result<(), Failure> {
        for (side, side_m) in sides_m.into_iter().enumerate() {
            let farthest = self.places.iter().fold(0.0_f64, |most, place| most.max(place.at_m[side].abs()));
            if farthest > 0.5 * side_m * (1.0 + 1e-9) {
                return Err(Failure::Wrong(format!(
                    "the component is {} m from the middle of a body of {} m: its position is beyond the end",
                    given(neat(farthest)),
                    given(neat(side_m))
                )));
            }
        }
        Ok(())
    }
}

/// Returns an angle within a range without the digits that degrees get in radians: the middle of 2 and 6 degrees is 4 degrees.
fn round_angle(angle_rad: f64, spread: &Spread) -> f64 {
    if spread.is_value() { angle_rad } else { neat(angle_rad.to_degrees()).to_radians() }
}

/// Returns the value at a share of a range, from 0 to 1, and notes which value of a range it is.
fn take(notes: Option<&mut Vec<String>>, name: &str, spread: &Spread, share: f64, si: &'static str) -> f64 {
    let (value, which) = match share {
        0.0 => (spread.lo(), "the least"),
        1.0 => (spread.hi(), "the largest"),
        share => (spread.at(share), "the middle"),
    };
    if let (Some(notes), false) = (notes, spread.is_value()) {
        let show = Show { unit: spread.unit(), name: if si == "1" { "" } else { si } };
        let [value, lo, hi] = [value, spread.lo(), spread.hi()].map(|x| given(neat(show.value(x))));
        let unit = if show.name().is_empty() { String::new() } else { format!(" {}", show.name()) };
        notes.push(format!("{name} = {value}{unit}, {which} of {lo} to {hi}{unit}"));
    }
    value
}
