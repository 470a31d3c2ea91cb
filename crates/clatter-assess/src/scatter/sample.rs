//! This module defines the inputs that vary from sample to sample, and one sample.

use std::f64::consts::TAU;

use clatter::End;
use clatter_flight::{Drop, Place};
use clatter_shock::Suspension;

use super::draw::Quantile;
use super::philox::Stream;
use super::{Column, PlateAs};
use clatter_product::{
    Base, Component, Damping, Error, INPUTS, Input, Inside, Law, Limit, LimitKind, Listed, Mount, NUMBERS_OF_ALL,
    NUMBERS_OF_DROP, Product, ProductFile, Source, Spread, Stops, places,
};

/// An input that varies from sample to sample; parts are given by their index in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Varied {
    /// An input of the drop; where each of several drops has its own, that of this one by its order in the file.
    Drop(Input, Option<usize>),
    /// Natural frequency of a part.
    Frequency(usize),
    /// Damping ratio or quality factor of a part, whichever the file gives.
    Damping(usize),
    /// A number of the stops of a part, by its index in [`Stops::INPUTS`].
    Stop(usize, usize),
    /// The place of a part.
    Position(usize),
    /// The place of a part across a plate.
    Across(usize),
    /// The limit of a part; of a damage boundary the critical velocity change.
    Limit(usize, LimitKind),
    /// The critical acceleration of the damage boundary of a part.
    CriticalAcceleration(usize),
}

impl Varied {
    /// Returns the name of the input of the drop, or `natural-frequency`, `damping`, `stop-gap`, …, `position`, `position-across`, `limit` or
    /// `critical-acceleration`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Drop(input, _) => input.row().name,
            Self::Frequency(_) => "natural-frequency",
            Self::Damping(_) => "damping",
            Self::Stop(_, n) => Stops::INPUTS[*n].name,
            Self::Position(_) => "position",
            Self::Across(_) => "position-across",
            Self::Limit(..) => "limit",
            Self::CriticalAcceleration(_) => "critical-acceleration",
        }
    }
    /// Returns the drop of several that it belongs to, by its order in the file; none of an input that all drops share.
    #[must_use]
    pub fn landing(&self) -> Option<usize> {
        if let Self::Drop(_, landing) = self { *landing } else { None }
    }
    /// Returns the part that it belongs to, by its index in the file; none of an input that all parts share.
    #[must_use]
    pub fn component(&self) -> Option<usize> {
        match self {
            Self::Frequency(i)
            | Self::Damping(i)
            | Self::Stop(i, _)
            | Self::Position(i)
            | Self::Across(i)
            | Self::Limit(i, _)
            | Self::CriticalAcceleration(i) => Some(*i),
            Self::Drop(..) => None,
        }
    }
    /// Returns the column that holds it.
    pub(super) fn column(self) -> Column {
        match self {
            Self::Drop(input, landing) => Column::Drop(input.told(), landing),
            Self::Frequency(i) => Column::FrequencyHz(i),
            Self::Damping(i) => Column::DampingRatio(i),
            Self::Stop(i, n) => Column::Stop(i, n),
            Self::Position(i) => Column::PositionM(i),
            Self::Across(i) => Column::AcrossM(i),
            Self::Limit(i, kind) => Column::Limit(i, kind),
            Self::CriticalAcceleration(i) => Column::CriticalAccelerationMS2(i),
        }
    }
    /// Returns which of the uniform numbers of a sample it is drawn from, whatever else is drawn. There is room for other inputs and kinds
    /// of limits, so that they move no number of these.
    fn number(self) -> u32 {
        const OWN: u32 = 32;
        /// Beyond the last part.
        const LANDINGS: u32 = 1 << 20;
        let own = match self {
            #[expect(clippy::cast_possible_truncation, reason = "a list has some tens of drops")]
            Self::Drop(input, Some(n)) => return LANDINGS + NUMBERS_OF_DROP * n as u32 + input.number(true),
            Self::Drop(input, None) => return input.number(false),
            Self::Frequency(_) => 0,
            Self::Damping(_) => 1,
            Self::Position(_) => 2,
            Self::CriticalAcceleration(_) => 3,
            Self::Across(_) => 4,
            #[expect(clippy::cast_possible_truncation, reason = "one of three")]
            Self::Stop(_, n) => 5 + n as u32,
            Self::Limit(_, kind) => 8 + kind as u32,
        };
        #[expect(clippy::cast_possible_truncation, reason = "a file has at most 1000 parts")]
        let component = self.component().unwrap_or_default() as u32;
        NUMBERS_OF_ALL + OWN * component + own
    }
}

/// A quantity, and the input that it varies with.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    quantile: Quantile,
    input: Option<usize>,
}

impl Drawn {
    fn at(&self, uniforms: &[f64]) -> f64 {
        self.quantile.at(self.input.map_or(0.0, |input| uniforms[input]))
    }
}

/// Everything that a sample is drawn from.
#[derive(Debug)]
pub(super) struct Inputs {
    merge_s: f64,
    /// The inputs that vary.
    pub(super) varied: Vec<Varied>,
    /// The inputs among them that are given as a range without a distribution.
    pub(super) assumed_even: Vec<Varied>,
    /// The varying inputs that act on each part.
    pub(super) of_part: Vec<Vec<usize>>,
    /// The way in which a plate is followed; none of a bar, and of a box that lands on anything.
    pub(super) plate: Option<PlateAs>,
    /// The drop data that are the same in all drops.
    drop: Drop,
    /// True where a sample goes through the drops of a list.
    has_list: bool,
    /// Inputs that all drops share.
    shared: Vec<(Input, Drawn)>,
    /// One, or those that it goes through.
    drops: Vec<DropInputs>,
    parts: Vec<PartInputs>,
}

/// The inputs from which one drop is drawn.
#[derive(Debug)]
struct DropInputs {
    /// The posture of a box as it lands, but for its tolerance.
    base: Option<Base>,
    /// Ends that may be first, and what either of them is drawn from.
    firsts: &'static [End],
    first: Option<usize>,
    /// Its own inputs.
    own: Vec<(Input, Drawn)>,
    /// The direction of a plate and of a box.
    direction: Option<Drawn>,
}

#[derive(Debug)]
struct PartInputs {
    /// Along the length, and across a plate.
    position: [Drawn; 2],
    extent_m: [f64; 2],
    inside: Inside,
    mount: Option<(Drawn, Drawn, Damping)>,
    stops: Option<[Drawn; 3]>,
    limits: Vec<(LimitKind, Drawn, Option<Drawn>)>,
}

/// A product that is dropped, and the parts in it.
#[derive(Debug)]
pub(super) struct Sample {
    /// The uniform number from which each varying input comes.
    pub(super) uniforms: Vec<f64>,
    /// One, or all that it goes through, one after the other.
    pub(super) drops: Vec<Drop>,
    pub(super) parts: Vec<PartSample>,
}

/// A part in a sample.
#[derive(Debug, Clone)]
pub(super) struct PartSample {
    /// Its number in the file.
    pub(super) number: usize,
    /// How many limits of the part come before its first one here.
    pub(super) skipped: usize,
    /// Its middle, along the product and across it.
    pub(super) at_m: [f64; 2],
    /// The range that it reaches along the product and across it, the same for a point.
    pub(super) reaches_m: [[f64; 2]; 2],
    pub(super) inside: Inside,
    pub(super) suspension: Option<Suspension>,
    pub(super) limits: Vec<Limit>,
}

impl DropInputs {
    /// Returns whether it is tilted by a range of angles, or has an input that a file may leave out, such as a spin, which acts towards a
    /// side.
    fn turns(&self) -> bool {
        let varies = |(input, drawn): &(Input, Drawn)| match input {
            Input::Tilt => drawn.input.is_some(),
            // One that is left out is not among them.
            _ => input.row().optional.is_some(),
        };
        self.own.iter().any(varies)
    }
}

impl PartSample {
    /// Returns the part with one of its limits, by its number.
    pub(super) fn with_one_limit(&self, number: usize) -> Self {
        Self { skipped: self.skipped + number, limits: vec![self.limits[number]], ..self.clone() }
    }
    /// Returns both ends along the product, or the point.
    pub(super) fn ends(&self) -> &[f64] {
        let along = &self.reaches_m[0];
        if along[0] < along[1] { along } else { &along[..1] }
    }
    /// Places at which a drop with contacts is answered, as [`Component::places_m`](clatter_product::Component::places_m).
    pub(super) fn spots(&self) -> Vec<Place> {
        let stops = self.suspension.is_some_and(|part| part.stop().is_some());
        let places = places(self.reaches_m, stops || self.limits.iter().any(|limit| limit.kind.is_largest_between()));
        places.into_iter().map(|at_m| self.inside.place(at_m)).collect()
    }
}

/// The inputs that vary, as they are found.
#[derive(Debug, Default)]
struct Finder {
    varied: Vec<Varied>,
    assumed_even: Vec<Varied>,
}

impl Finder {
    fn drawn(&mut self, input: Varied, spread: &Spread, of: &str) -> Result<Drawn, Error> {
        if spread.law() == Law::Range {
            self.assumed_even.push(input);
        }
        let varies = !spread.is_value();
        if varies {
            self.varied.push(input);
        }
        let quantity = || format!("{}{of}", input.name().replace('-', " "));
        let quantile = Quantile::new(spread).ok_or_else(|| Error::Tail(quantity()))?;
        Ok(Drawn { quantile, input: varies.then(|| self.varied.len() - 1) })
    }

    fn part(&mut self, i: usize, component: &Component) -> Result<PartInputs, Error> {
        let of = format!(" of {:?}", component.name);
        let mount = match component.mount {
            Mount::Hard => None,
            Mount::Suspended { frequency_hz, damping } => {
                // A suspension that is sound at both ends of its range is sound between them.
                for (hz, given) in
                    [(frequency_hz.lo(), damping.spread().lo()), (frequency_hz.hi(), damping.spread().hi())]
                {
                    Suspension::from_hz(hz, damping.ratio(given)?)?;
                }
                let frequency = self.drawn(Varied::Frequency(i), &frequency_hz, &of)?;
                Some((frequency, self.drawn(Varied::Damping(i), damping.spread(), &of)?, damping))
            }
        };
        let along = self.drawn(Varied::Position(i), &component.position_m, &of)?;
        let position = [along, self.drawn(Varied::Across(i), &component.across_m, &of)?];
        let mut limits = Vec::new();
        for kind in component.limits.kinds() {
            let Some(spread) = component.limits.get(kind) else { continue };
            let allowed = self.drawn(Varied::Limit(i, kind), spread, &of)?;
            let critical = component.limits.critical_acceleration_m_s2().filter(|_| kind.source() == Source::Boundary);
            let critical =
                critical.map(|spread| self.drawn(Varied::CriticalAcceleration(i), spread, &of)).transpose()?;
            limits.push((kind, allowed, critical));
        }
        let stops = match &component.stops {
            None => None,
            Some(stops) => {
                let [gap, time, restitution] = stops.ranges();
                let mut drawn = |n, range| self.drawn(Varied::Stop(i, n), range, &of);
                Some([drawn(0, gap)?, drawn(1, time)?, drawn(2, restitution)?])
            }
        };
        let extent_m = [component.extent_m, component.extent_across_m];
        Ok(PartInputs { position, extent_m, inside: component.inside, mount, stops, limits })
    }

    /// Collects which end is first, and the inputs of a drop; of one of several, which it is.
    fn drop(&mut self, product: &Product, listed: &Listed, landing: Option<usize>) -> Result<DropInputs, Error> {
        let Listed { drop, base } = listed;
        let (firsts, is_bar) = (drop.first_ends(), !product.body.is_wide());
        let first = (is_bar && firsts.len() > 1).then(|| {
            self.varied.push(Varied::Drop(Input::First, landing));
            self.varied.len() - 1
        });
        let mut own = Vec::new();
        for row in INPUTS.iter().filter(|row| row.input.is_of_drop() && row.set.is_some()) {
            let Some(mut given) = row.input.given(product, drop).filter(|_| row.input.is_there(product, drop)) else {
                continue;
            };
            let input = Varied::Drop(row.input, landing);
            if row.input == Input::Tilt && base.is_some() && !given.is_value() {
                // All attitudes within the tolerance: rings of them grow with the angle.
                self.assumed_even.push(input);
                given = Spread::new(given.lo(), given.hi(), Law::Triangular { mode: given.hi() })?;
            }
            own.push((row.input, self.drawn(input, &given, "")?));
        }
        Ok(DropInputs { base: *base, firsts, first, own, direction: None })
    }
}

impl Inputs {
    /// Returns the inputs of a product, all checked.
    pub(super) fn new(file: &ProductFile, merge_s: f64) -> Result<Self, Error> {
        file.check()?;
        crate::verdict::merge(merge_s)?;
        file.check_apart(merge_s)?;
        let (product, drop, listed) = (&file.product, &file.drop, file.listed());
        let mut finder = Finder::default();
        let is_bar = !product.body.is_wide();
        let has_list = !file.landings.is_empty();
        let number = |n: usize| has_list.then_some(n);
        let mut drops = Vec::with_capacity(listed.len());
        for (n, one) in listed.iter().enumerate() {
            drops.push(finder.drop(product, one, number(n))?);
        }
        let mut shared = Vec::new();
        for row in INPUTS.iter().filter(|row| !row.input.is_of_drop()) {
            let given = row.input.given(product, drop).filter(|_| row.input.is_there(product, drop));
            // The body has its own radius of gyration.
            let varies = |given: &Spread| row.input != Input::Gyration || !given.is_value();
            if let Some(given) = given.filter(varies) {
                shared.push((row.input, finder.drawn(Varied::Drop(row.input, None), &given, "")?));
            }
        }
        let any = Spread::new(0.0, TAU, Law::Uniform)?;
        for (n, one) in drops.iter_mut().enumerate().filter(|_| !is_bar) {
            let input = Varied::Drop(Input::Direction, number(n));
            // A box that is turned off nothing, and does not turn, is turned towards nothing.
            let any = if one.base.is_some() && !one.turns() { Spread::finite(0.0) } else { any };
            one.direction = Some(finder.drawn(input, listed[n].drop.direction_rad.as_ref().unwrap_or(&any), "")?);
        }
        let of_all = finder.varied.len();
        let (mut parts, mut of_part) = (Vec::new(), Vec::new());
        for (i, component) in file.components.iter().enumerate() {
            let own = finder.varied.len();
            parts.push(finder.part(i, component)?);
            of_part.push((0..of_all).chain(own..finder.varied.len()).collect());
        }
        let same = Drop {
            direction_rad: Drop::towards(drop.first_ends()[0]),
            speed_m_s: listed[0].drop.speeds_m_s()[0],
            tilt_rad: drop.tilt_rad.lo(),
            restitution: product.restitution.lo(),
            contact_time_s: product.contact_time_s.map(|time| time.lo()),
            ..product.unset(drop, listed[0].base)
        };
        let plate = (!is_bar && same.is_level).then(|| {
            same.boxed().map_or(PlateAs::Level, |boxed| PlateAs::Box {
                thickness_m: boxed.body.thickness().m(),
                assumed: product.body.thickness.is_none(),
            })
        });
        let Finder { varied, assumed_even } = finder;
        Ok(Self { merge_s, varied, assumed_even, of_part, plate, drop: same, has_list, shared, drops, parts })
    }

    /// Returns a sample to draw into.
    pub(super) fn blank(&self) -> Sample {
        let limit = |(kind, ..): &(LimitKind, _, _)| Limit::new(*kind, f64::INFINITY);
        let part = |(number, part): (usize, &PartInputs)| {
            let limits = part.limits.iter().map(limit).collect();
            let (at_m, reaches_m) = ([0.0; 2], [[0.0; 2]; 2]);
            PartSample { number, skipped: 0, at_m, reaches_m, inside: part.inside, suspension: None, limits }
        };
        let parts = self.parts.iter().enumerate().map(part).collect();
        Sample { uniforms: vec![0.0; self.varied.len()], drops: vec![self.drop; self.drops.len()], parts }
    }

    /// Draws sample k of a seed.
    pub(super) fn draw(&self, seed: u64, k: u64, sample: &mut Sample) -> Result<(), Error> {
        let stream = Stream::new(seed, k);
        for (uniform, input) in sample.uniforms.iter_mut().zip(&self.varied) {
            *uniform = stream.at(input.number());
        }
        let Sample { uniforms, drops, parts } = sample;
        self.product(uniforms, drops);
        for (inputs, part) in self.parts.iter().zip(parts) {
            part.at_m = inputs.position.map(|position| position.at(uniforms));
            part.reaches_m = [0, 1].map(|side| {
                let (middle, half) = (part.at_m[side], 0.5 * inputs.extent_m[side]);
                [middle - half, middle + half]
            });
            if let Some((frequency, given, damping)) = &inputs.mount {
                let ratio = damping.ratio(given.at(uniforms))?;
                let free = Suspension::from_hz(frequency.at(uniforms), ratio)?;
                let stop = inputs.stops.map(|stops| Stops::of(stops.map(|drawn| drawn.at(uniforms)))).transpose()?;
                part.suspension = Some(stop.map_or(free, |stop| free.with_stop(stop)));
            }
            for (limit, (_, allowed, critical)) in part.limits.iter_mut().zip(&inputs.limits) {
                limit.allowed = allowed.at(uniforms);
                limit.critical_acceleration_m_s2 = critical.as_ref().map_or(f64::INFINITY, |c| c.at(uniforms));
            }
        }
        Ok(())
    }

    /// Sets the drops that these uniform numbers give, all of one product.
    fn product(&self, uniforms: &[f64], drops: &mut [Drop]) {
        for (inputs, drop) in self.drops.iter().zip(drops) {
            if let Some(base) = &inputs.base {
                (drop.base, drop.spin_axis) = (base.up, base.spin_axis);
            }
            drop.direction_rad = match (&inputs.direction, inputs.first) {
                (Some(direction), _) => direction.at(uniforms),
                (None, None) => Drop::towards(inputs.firsts[0]),
                (None, Some(first)) => Drop::towards(if uniforms[first] < 0.5 { End::A } else { End::B }),
            };
            for (input, drawn) in inputs.own.iter().chain(&self.shared) {
                if let Some(set) = input.row().set {
                    set(drop, drawn.at(uniforms));
                }
            }
            drop.is_flat = drop.lands_as_one(self.merge_s);
        }
    }

    /// Returns the quantities that may describe a sample: all that the product has, whether it varies or not.
    pub(super) fn quantities(&self) -> Vec<Column> {
        let is_plate = self.drops[0].direction.is_some();
        let mut all = self.falls();
        let is_drawn = |input: Input| self.shared.iter().any(|(drawn, _)| *drawn == input);
        let has =
            |input: Input| input.value(&self.drop).is_some() && (input.row().optional.is_none() || is_drawn(input));
        let shared = INPUTS.iter().map(|row| row.input).filter(|input| !input.is_of_drop() && has(*input));
        all.extend(shared.map(|input| Column::Drop(input, None)));
        for (i, part) in self.parts.iter().enumerate() {
            all.extend(part.mount.map(|_| [Column::FrequencyHz(i), Column::DampingRatio(i)]).into_iter().flatten());
            all.extend((0..3).filter(|_| part.stops.is_some()).map(|n| Column::Stop(i, n)));
            all.push(Column::PositionM(i));
            all.extend(is_plate.then_some(Column::AcrossM(i)));
            for (kind, _, critical) in &part.limits {
                all.push(Column::Limit(i, *kind));
                all.extend(critical.map(|_| Column::CriticalAccelerationMS2(i)));
            }
        }
        all
    }
    /// Returns how many drops of a list a sample goes through; none of a product that falls once.
    pub(super) fn landings(&self) -> usize {
        if self.has_list { self.drops.len() } else { 0 }
    }

    /// Returns how a sample falls.
    fn falls(&self) -> Vec<Column> {
        let is_wide = self.drop.body.is_wide();
        if self.has_list {
            let of = |n: usize| {
                let one = &self.drops[n];
                let has = move |input: Input| match input {
                    Input::First => one.first.is_some(),
                    Input::Direction => one.direction.is_some(),
                    _ => one.own.iter().any(|(own, _)| own.told() == input),
                };
                let own = INPUTS.iter().map(|row| row.input).filter(move |input| has(*input));
                own.map(move |input| Column::Drop(input, Some(n)))
            };
            return (0..self.drops.len()).flat_map(of).collect();
        }
        let first = if is_wide { Input::Direction } else { Input::First };
        let own = self.drops[0].own.iter().map(|(input, _)| input.told());
        [first].into_iter().chain(own).map(|input| Column::Drop(input, None)).collect()
    }

    /// Returns the columns of a row of values.
    pub(super) fn columns(&self) -> Vec<Column> {
        let mut columns = self.falls();
        columns.extend(self.shared.iter().map(|(input, _)| Column::Drop(*input, None)));
        for (i, part) in self.parts.iter().enumerate() {
            columns.extend(part.mount.map(|_| Column::FrequencyHz(i)));
            columns.extend(self.varied.iter().filter_map(|input| match *input {
                Varied::Damping(of) if of == i => Some(Column::DampingRatio(i)),
                Varied::Stop(of, n) if of == i => Some(Column::Stop(i, n)),
                Varied::Position(of) if of == i => Some(Column::PositionM(i)),
                Varied::Across(of) if of == i => Some(Column::AcrossM(i)),
                Varied::Limit(of, kind) if of == i => Some(Column::Limit(i, kind)),
                Varied::CriticalAcceleration(of) if of == i => Some(Column::CriticalAccelerationMS2(i)),
                _ => None,
            }));
        }
        columns.extend((0..self.parts.len()).map(Column::Utilization));
        if self.has_list {
            let of = |n| (0..self.parts.len()).map(move |i| Column::LandingUtilization(n, i));
            columns.extend((0..self.drops.len()).flat_map(of));
        }
        columns
    }
}

impl Sample {
    /// Returns the value of a column of the sample, in SI.
    pub(super) fn value(&self, column: Column) -> f64 {
        let suspension = |i: usize| self.parts[i].suspension.as_ref();
        let limit = |i: usize, kind| self.parts[i].limits.iter().find(|limit| limit.kind == kind);
        let value = match column {
            // A quantity of the product is the same in all of its drops.
            Column::Drop(input, landing) => input.value(&self.drops[landing.unwrap_or(0)]),
            Column::FrequencyHz(i) => suspension(i).map(|part| part.omega() / TAU),
            Column::DampingRatio(i) => suspension(i).map(|part| part.damping().get()),
            Column::Stop(i, n) => suspension(i).and_then(Suspension::stop).map(|stop| Stops::numbers(&stop)[n]),
            Column::PositionM(i) => Some(self.parts[i].at_m[0]),
            Column::AcrossM(i) => Some(self.parts[i].at_m[1]),
            Column::Limit(i, kind) => limit(i, kind).map(|limit| limit.allowed),
            Column::CriticalAccelerationMS2(i) => {
                limit(i, LimitKind::DamageBoundary).map(|limit| limit.critical_acceleration_m_s2)
            }
            Column::Utilization(_) | Column::LandingUtilization(..) => None,
        };
        value.unwrap_or(f64::NAN)
    }
}
