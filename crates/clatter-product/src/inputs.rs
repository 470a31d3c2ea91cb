//! The inputs of a drop: a row each, over which everything loops that reads, checks, searches, draws, repeats or tells them.

use std::f64::consts::{SQRT_2, TAU};

use clatter::End;
use clatter_flight::Drop;

use crate::keys::{self, Key};
use crate::{DropRanges, Fall, Product, Spread};

/// An input of a drop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// The end that touches first: either is as likely.
    First,
    /// Height of the drop.
    Height,
    /// Speed at the first touch.
    Speed,
    /// Tilt at the first touch.
    Tilt,
    /// The direction to which a plate rises from its lowest corner: every direction is as likely unless the file has some.
    Direction,
    /// Angular velocity at the first touch.
    Spin,
    /// Coefficient of restitution.
    Restitution,
    /// The time of a lone contact.
    ContactTime,
    /// Radius of gyration of the product.
    Gyration,
    /// Coefficient of friction of the ground.
    Friction,
}

/// Everything that differs from input to input.
#[derive(Debug)]
pub struct Row {
    /// The input.
    pub input: Input,
    /// Its name for programs: `contact-time`.
    pub name: &'static str,
    /// Its name for people: `contact time`.
    pub words: &'static str,
    /// Its column, in SI: `contact_time_s`.
    pub column: &'static str,
    /// Its SI unit; 1 where it has none, nothing of a choice.
    pub unit: &'static str,
    /// The table of a product file that has it, and its key there.
    pub(crate) key: (&'static [Key], &'static str),
    /// The uniform numbers from which it is drawn: of a product that falls once, and of one of several drops; none of what all drops share.
    numbers: (u32, Option<u32>),
    /// The value in a drop.
    value: fn(&Drop) -> Option<f64>,
    /// The range that a file gives of it.
    given: fn(&Product, &DropRanges) -> Option<Spread>,
    /// Puts a value that was drawn into a drop; none of what an attitude has.
    pub set: Option<fn(&mut Drop, f64)>,
    /// Where in its range the demand is highest as a rule, from 0 to 1: there it is where one drop stands for all.
    pub hardest: f64,
    /// The data of an input that a file may leave out.
    pub optional: Option<Optional>,
    /// The data of the search over it.
    pub(crate) search: Option<Search>,
}

/// An input of a drop that a product file may leave out.
#[derive(Debug, Clone, Copy)]
pub struct Optional {
    /// The value that it has then.
    pub without: f64,
    /// The words before its value: `turning at`.
    pub phrase: &'static str,
    /// The words behind its range in a report.
    pub report: &'static str,
    /// Puts it into the drops of a file.
    pub(crate) put: fn(&mut DropRanges, Spread),
}

impl Optional {
    /// Returns whether this value is that of a file that leaves it out.
    #[must_use]
    pub fn is_left_out(&self, value: f64) -> bool {
        value - self.without == 0.0
    }
}

/// The data of the search over the range of an input.
#[derive(Debug, Clone, Copy)]
pub struct Search {
    /// Its axis.
    pub axis: usize,
    /// True where its root goes evenly from end to end.
    pub(crate) is_root: bool,
    /// The place of the input in lines of drops: at this end of its range first, and evenly over it by multiples of an irrational number;
    /// none of what lines go along.
    pub line: Option<(f64, f64)>,
}

const SQRT_3: f64 = 1.732_050_807_568_877;
const SQRT_5: f64 = 2.236_067_977_499_79;
const SQRT_13: f64 = 3.605_551_275_463_989;
const SQRT_17: f64 = 4.123_105_625_617_661;

/// The inputs of a drop. A new one stands last.
pub static INPUTS: [Row; 10] = [
    Row {
        input: Input::First,
        name: "first",
        words: "first end",
        column: "b_first",
        unit: "",
        key: (keys::DROP, "first"),
        numbers: (0, Some(4)),
        value: |drop| Some(if drop.first() == End::A { 0.0 } else { 1.0 }),
        given: |_, _| None,
        set: None,
        hardest: 0.5,
        optional: None,
        search: None,
    },
    Row {
        input: Input::Height,
        name: "height",
        words: "height",
        column: "height_m",
        unit: "m",
        key: (keys::DROP, "height"),
        numbers: (1, Some(0)),
        value: |_| None,
        given: |_, drop| if let Fall::HeightM(height) = drop.fall { Some(height) } else { None },
        set: Some(|drop, height_m| drop.speed_m_s = (2.0 * drop.gravity_m_s2 * height_m).sqrt()),
        hardest: 1.0,
        optional: None,
        search: None,
    },
    Row {
        input: Input::Speed,
        name: "speed",
        words: "speed",
        column: "speed_m_s",
        unit: "m/s",
        key: (keys::DROP, "speed"),
        numbers: (1, Some(0)),
        value: |drop| Some(drop.speed_m_s),
        given: |_, drop| if let Fall::SpeedMS(speed) = drop.fall { Some(speed) } else { None },
        set: Some(|drop, speed_m_s| drop.speed_m_s = speed_m_s),
        hardest: 1.0,
        optional: None,
        search: Some(Search { axis: 1, is_root: false, line: None }),
    },
    Row {
        input: Input::Tilt,
        name: "tilt",
        words: "tilt",
        column: "tilt_rad",
        unit: "rad",
        key: (keys::DROP, "tilt"),
        numbers: (2, Some(1)),
        value: |drop| Some(drop.tilt_rad),
        given: |_, drop| Some(drop.tilt_rad),
        set: Some(|drop, tilt_rad| drop.tilt_rad = tilt_rad),
        hardest: 0.5,
        optional: None,
        search: Some(Search { axis: 0, is_root: true, line: None }),
    },
    Row {
        input: Input::Direction,
        name: "direction",
        words: "direction",
        column: "direction_rad",
        unit: "rad",
        key: (keys::DROP, "direction"),
        numbers: (6, Some(2)),
        value: |drop| drop.body.is_wide().then_some(drop.direction_rad),
        given: |_, drop| drop.direction_rad,
        set: None,
        hardest: 0.5,
        optional: None,
        search: None,
    },
    Row {
        input: Input::Restitution,
        name: "restitution",
        words: "restitution",
        column: "restitution",
        unit: "1",
        key: (keys::PRODUCT, "restitution"),
        numbers: (3, None),
        value: |drop| Some(drop.restitution),
        given: |product, _| Some(product.restitution),
        set: Some(|drop, restitution| drop.restitution = restitution),
        hardest: 1.0,
        optional: None,
        search: Some(Search { axis: 2, is_root: false, line: Some((1.0, SQRT_2)) }),
    },
    Row {
        input: Input::ContactTime,
        name: "contact-time",
        words: "contact time",
        column: "contact_time_s",
        unit: "s",
        key: (keys::PRODUCT, "contact_time"),
        numbers: (4, None),
        value: |drop| drop.contact_time_s,
        given: |product, _| product.contact_time_s,
        set: Some(|drop, time_s| drop.contact_time_s = Some(time_s)),
        hardest: 0.0,
        optional: None,
        search: Some(Search { axis: 3, is_root: false, line: Some((0.0, SQRT_3)) }),
    },
    Row {
        input: Input::Gyration,
        name: "radius-of-gyration",
        words: "radius of gyration",
        column: "gyration_m",
        unit: "m",
        key: (keys::PRODUCT, "radius_of_gyration"),
        numbers: (5, None),
        value: |drop| Some(drop.body.gyration_m()),
        given: |product, _| Some(product.gyration_m),
        // Both ends of the range were checked as it was read.
        set: Some(|drop, gyration_m| drop.body = drop.body.with_gyration_m(gyration_m).unwrap_or(drop.body)),
        hardest: 0.5,
        optional: None,
        search: Some(Search { axis: 6, is_root: false, line: Some((0.0, SQRT_5)) }),
    },
    Row {
        input: Input::Spin,
        name: "spin",
        words: "spin",
        column: "spin_rad_s",
        unit: "rad/s",
        key: (keys::DROP, "spin"),
        numbers: (7, Some(3)),
        value: |drop| Some(drop.spin_rad_s),
        given: |_, drop| Some(drop.spin_rad_s),
        set: Some(|drop, spin_rad_s| drop.spin_rad_s = spin_rad_s),
        hardest: 0.5,
        optional: Some(Optional {
            without: 0.0,
            phrase: "turning at",
            report: "at the first touch about the axis of the tilt, which grows where positive",
            put: |drop, spin| drop.spin_rad_s = spin,
        }),
        search: Some(Search { axis: 8, is_root: false, line: Some((1.0, SQRT_13)) }),
    },
    Row {
        input: Input::Friction,
        name: "friction",
        words: "friction",
        column: "friction",
        unit: "1",
        key: (keys::PRODUCT, "friction"),
        numbers: (8, None),
        value: |drop| drop.is_solid().then_some(drop.friction),
        given: |product, _| product.friction,
        set: Some(|drop, friction| drop.friction = friction),
        // Friction takes energy from the blows along the thickness.
        hardest: 0.0,
        optional: None,
        search: Some(Search { axis: 9, is_root: false, line: Some((1.0, SQRT_17)) }),
    },
];

impl Input {
    /// Its row.
    #[must_use]
    pub fn row(self) -> &'static Row {
        INPUTS.iter().find(|row| row.input == self).unwrap_or_else(|| unreachable!("every input has a row"))
    }
    /// Returns whether it is an angle, which reports show in degrees.
    #[must_use]
    pub fn is_angle(self) -> bool {
        self.row().unit == "rad"
    }
    /// Returns its column as reports show it: an angle in degrees, an end by its letter.
    #[must_use]
    pub fn title(self) -> String {
        match self {
            Self::First => self.row().name.to_owned(),
            _ if self.is_angle() => self.row().column.replace("_rad", "_deg"),
            _ => self.row().column.to_owned(),
        }
    }
    /// Returns the input that a drop reports in place of this one: a height is reported as the speed that it gives.
    #[must_use]
    pub fn told(self) -> Self {
        if self == Self::Height { Self::Speed } else { self }
    }
    /// Returns the value in a drop, in SI; none where the drop has none.
    #[must_use]
    pub fn value(self, drop: &Drop) -> Option<f64> {
        (self.row().value)(drop)
    }
    /// Returns the range that a file gives of it.
    #[must_use]
    pub fn given(self, product: &Product, drop: &DropRanges) -> Option<Spread> {
        (self.row().given)(product, drop)
    }
    /// Returns whether drops of the ranges may have it: not one that is left out.
    #[must_use]
    pub fn is_there(self, product: &Product, drop: &DropRanges) -> bool {
        let left_out = |given: Spread| {
            self.row().optional.is_some_and(|optional| given.is_value() && optional.is_left_out(given.lo()))
        };
        self.given(product, drop).is_some_and(|given| !left_out(given))
    }
    /// Returns whether each of several drops has its own.
    #[must_use]
    pub fn is_of_drop(self) -> bool {
        self.row().numbers.1.is_some()
    }
    /// Returns the uniform number of a sample from which it is drawn; of several drops, in one of them.
    #[must_use]
    pub fn number(self, landing: bool) -> u32 {
        let (shared, own) = self.row().numbers;
        own.filter(|_| landing).unwrap_or(shared)
    }
    /// Returns the least and the largest value in drops of the ranges; none of an input that has no range of numbers.
    #[must_use]
    pub fn range(self, product: &Product, drop: &DropRanges) -> Option<[f64; 2]> {
        match self {
            Self::Speed => Some(drop.speeds_m_s()),
            Self::Direction if drop.direction_rad.is_none() => Some([0.0, TAU]),
            _ => self.given(product, drop).map(|given| [given.lo(), given.hi()]),
        }
    }
}

impl Search {
    /// Returns the value at a share of the way from the least to the largest.
    #[must_use]
    pub fn at(self, [lo, hi]: [f64; 2], share: f64) -> f64 {
        if self.is_root {
            let root = lo.sqrt() + share * (hi.sqrt() - lo.sqrt());
            (root * root).clamp(lo, hi)
        } else {
            (lo + share * (hi - lo)).clamp(lo, hi)
        }
    }
    /// Returns the share at which a value is; 0 where there is no range.
    pub fn share(self, range: [f64; 2], x: f64) -> f64 {
        let [lo, hi, x] = if self.is_root { [range[0], range[1], x].map(f64::sqrt) } else { [range[0], range[1], x] };
        if hi > lo { ((x - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// The uniform numbers of a sample that are kept for the inputs of a product, with room for others, so that they move no number of these.
pub const NUMBERS_OF_ALL: u32 = 16;
/// The same of one of several drops.
pub const NUMBERS_OF_DROP: u32 = 8;
const _: () = {
    let mut row = 0;
    while row < INPUTS.len() {
        let (all, own) = INPUTS[row].numbers;
        assert!(all < NUMBERS_OF_ALL, "a number of another part");
        if let Some(own) = own {
            assert!(own < NUMBERS_OF_DROP, "a number of another drop");
        }
        row += 1;
    }
};

/// The number of axes of a search: those of [`INPUTS`], of the natural frequency, the damping ratio and the stops of a part, and of the
/// direction.
pub const AXES: usize = {
    let (mut row, mut axes) = (0, 6);
    while row < INPUTS.len() {
        axes += INPUTS[row].search.is_some() as usize;
        row += 1;
    }
    axes
};

/// Returns the inputs that a file may leave out.
pub fn optional_inputs() -> impl Iterator<Item = (&'static Row, Optional)> {
    INPUTS.iter().filter_map(|row| row.optional.map(|optional| (row, optional)))
}

/// Returns the rows that are searched along an axis.
pub fn searched() -> impl Iterator<Item = (&'static Row, Search)> {
    INPUTS.iter().filter_map(|row| row.search.map(|search| (row, search)))
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::{Attitude, Body, DropRanges, Law, Product};

    /// No two inputs share a name, a column or the number of a draw, but for height and speed, which are one.
    #[test]
    fn every_input_is_told_from_the_others() {
        let names: HashSet<_> = INPUTS.iter().flat_map(|row| [row.name, row.column]).collect();
        assert_eq!(names.len(), 2 * INPUTS.len() - 2, "restitution and friction are called as their columns");
        let others = || INPUTS.iter().filter(|row| row.input != Input::Height);
        let numbers: HashSet<_> = others().map(|row| row.numbers.0).collect();
        let own: HashSet<_> = others().filter_map(|row| row.numbers.1).collect();
        assert_eq!(numbers.len(), INPUTS.len() - 1);
        assert_eq!(own.len(), others().filter(|row| row.numbers.1.is_some()).count());
    }

    /// A value that is put into a drop is the value that it has, and is searched, as else an assessment would not see its range; the row
    /// stands for a key of the file.
    #[test]
    fn what_is_set_is_told() {
        let (length, side) = (Body::new(0.15, 0.04).unwrap(), clatter_flight::Side::even(0.03));
        let body = length.with_width(side).with_thickness(side);
        let mut drop = Drop { is_level: false, contact_time_s: None, ..Drop::new(body, 3.0, 0.1, 0.4) };
        for row in INPUTS.iter().filter(|row| row.input != Input::Height) {
            let Some(set) = row.set else { continue };
            assert!(row.search.is_some(), "{} is drawn and not searched", row.name);
            set(&mut drop, 0.05);
            assert_eq!(row.input.value(&drop).map(f64::to_bits), Some(0.05_f64.to_bits()), "{}", row.name);
        }
        (INPUTS[1].set.unwrap())(&mut drop, 2.0);
        assert!((drop.speed_m_s - (4.0 * drop.gravity_m_s2).sqrt()).abs() < 1e-12);
        for row in &INPUTS {
            let (table, name) = row.key;
            assert!(table.iter().any(|key| key.name == name), "{name} is no key");
        }
    }

    /// A range of spins to both sides turns as fast as its faster end.
    #[test]
    fn the_fastest_spin_is_that_of_either_end() {
        for [lo, hi] in [[-20.0, 5.0], [-5.0, 20.0], [-20.0, -5.0], [5.0, 20.0]] {
            let spin_rad_s = Spread::new(lo, hi, Law::Range).unwrap();
            let drop =
                DropRanges { spin_rad_s, ..DropRanges::new(Fall::SpeedMS(Spread::finite(3.0)), Spread::finite(0.1)) };
            assert_eq!(drop.fastest_rad_s().to_bits(), 20.0_f64.to_bits(), "{lo} to {hi}");
        }
    }

    /// Where a share of a range is found it was taken from, evenly or along the root.
    #[test]
    fn a_share_is_where_it_was_taken_from() {
        for (_, search) in searched() {
            for share in [0.0, 0.2, 0.7, 1.0] {
                let x = search.at([0.5, 4.0], share);
                assert!((search.share([0.5, 4.0], x) - share).abs() < 1e-12, "{search:?} {share}");
            }
        }
        let spread = |lo: f64, hi: f64| Spread::new(lo, hi, Law::Range).unwrap();
        let product = Product::new("bar", Body::new(0.15, 0.04).unwrap(), spread(0.2, 0.4));
        let drop = DropRanges::new(Fall::HeightM(spread(1.0, 2.0)), spread(0.0, 0.1));
        assert_eq!(Input::Speed.range(&product, &drop), Some(drop.speeds_m_s()));
        assert!(Input::ContactTime.range(&product, &drop).is_none() && Attitude::on("top").is_some());
    }
}
