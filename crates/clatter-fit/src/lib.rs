//! This crate goes from the measured data of a drop to the data of the product.
//!
//! A drop that was measured, by the times of its strikes, the heights of the ends from a video, or the acceleration at a place,
//! determines the data that a product file needs: the restitution, the radius of gyration, the contact time, how the drop fell. [`fit`]
//! finds the values with which a computed drop is nearest to the measured one, how far they may be off, and what the data cannot
//! tell. Of a product that bounces flat, [`bounces`] tells the restitution by the ratio of flight times.
//!
//! # Method
//! Least squares by Levenberg and Marquardt (MINPACK, the crate `levenberg-marquardt`) over the flights of `clatter-flight`, from
//! several starts. Each strike multiplies what is off before it, so that the sum of squares has a long and narrow valley: for any
//! restitution the first three strikes determine the radius of gyration and the gap over the speed, and where the fourth is met too,
//! searches go down, over more and more of the strikes. Where that leads to no fit, they begin at the best of a grid over the restitution,
//! the radius of gyration and the range of the speed; then the first strikes are met as they may be within their noise, and the later
//! strikes one by one. Where nothing says which end touches first, an explanation of the record with one end is a start for the other, and
//! both are reported.
//!
//! # What the product file gives in a range
//! The speed, the contact time and the restitution are data as long as the records do not tell them better: any value of the range is
//! as likely, with the standard deviation of half its width over √3 (JCGM 100:2008, 4.3.7). The range of the speed stays a datum where
//! strikes tell the speed as well. One value counts as exact, until the
//! data contradict it. Where the scatter of the data is not given, the leverage of a range sets its weight.
//!
//! # Which strike is which
//! Measured strikes are computed ones in the same order, the first is the first. Strikes at the end may be missing freely. All strikes
//! and none missing is the plain explanation, which is tried first. It stands unless chance makes the data scatter so much, or one of them
//! be so far off (by its externally studentized residual), less than once in ten thousand records. Else the speed or the restitution of one
//! end is freed, a time is taken for wrong, a strike for none, or one or two for missing, anywhere among the first 16 (two
//! strikes measured as one are one that is missing). Akaike's criterion decides: each unknown pays, each strike that is dropped or invented
//! as well, and for being one of so many ways. None is taken that leaves no degree of freedom. Explanations whose likelihood is
//! a twentieth of the best one or more are all reported, other minima of the plain one too, and the intervals hold all of them.
//! Contacts that take time take too long for that: there one time may be wrong where all else fits.
//!
//! Data that scatter more than the deviation given, which chance does once in ten thousand records, are no fit ([`Error::Scatter`]).
//!
//! # Intervals
//! An interval reaches as far as a quantity goes without the sum of squares, with all other free unknowns at their best, rising by
//! more than s² t²: its profile (Bates and Watts 1988, chapter 6). t is the quantile of Student's t, s² the sum of squares over the
//! number of data less that of unknowns; where the standard deviation of the data is given, s = 1 and t is normal. A quantity that is
//! bound ends there. With heights, accelerations or contacts that take time a flight takes too long for that, and the derivatives
//! at the minimum say how far it goes: the covariance is s² (JᵀJ)⁻¹, J the derivatives of the residuals over s. Correlations are those of
//! the derivatives.
//!
//! Measured over a thousand drops of each kind (`tests/fit`): 94 to 97 of 100 hold the truth for strikes timed to 2 to 10 µs,
//! with the radius of gyration known or fitted, the timing given or not. By the derivatives alone they would be about as many, but
//! where the timing is given and the radius fitted three quarters of the restitutions that are missed would be above. Of 300 records
//! of heights 95 to 97 of 100 by the derivatives. These drops have no gravity.
//!
//! With gravity (`tests/fit/real.rs`: an own simulation, tilts of 0.5 to 5 degrees, a center of mass off by up to 5 %, e of 0.25 to 0.6,
//! six strikes timed to 5 µs, at least a quarter of a millisecond apart), of 200 drops each with the speed exact, known to 1, 10 and
//! 50 %, and with the timing not given, no true strike is left out, and 92 to 98 of 100 intervals hold the restitution, the radius of
//! gyration and the tilt. Where neither the timing is given nor the speed to better than 50 %, 90 of 100 hold the restitution: that is
//! too few. Where strikes come closer the search may fail, and the record is then refused.
//!
//! # Both ends
//! They have one restitution unless the data tell the two apart to 0.02, or would contradict one less often than once in a hundred.
//! Where the timing is given, 95 of 100 intervals of each end hold the truth. Where it is not, two are found more often in records
//! that scatter little by chance, of which the intervals then are too narrow: 92 to 94 of 100 hold it where ends differ by up to
//! 0.1; two or three records in a hundred of equal ends are wrongly said to differ where they are timed badly, and of these about half
//! hold it, or fewer. Where ends differ and the data do not tell it, the one restitution misses their mean in a quarter to a half
//! of the records; a note says that it is one for both.
//!
//! # What the data cannot tell
//! An unknown is left free as long as every direction in the space of unknowns is determined: the singular values of J, each column scaled
//! by how well the unknown has to be known to be of use, say so. An unknown that is not determined is held at the value of the product
//! file, unless the data contradict it, and the unknown that undoes its change in the data is named. Of strike times alone the radius of
//! gyration stays free unless it is given as known: the file has no range of it by which the others could be widened, and a value that is a
//! tenth off would leave every second interval wrong.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

mod beside;
mod bounces;
mod criterion;
mod drop;
mod explain;
mod first_strikes;
mod join;
mod matching;
mod premise;
mod records;
mod region;
mod report;
mod set;
mod solve;
mod starts;
mod student;
mod told;
mod write;

use std::f64::consts::FRAC_PI_6;

use clatter::End;
use clatter_flight::{Body, ContactLaw};

use clatter_product::{First, Model, ProductFile};

pub use beside::{Comparison, MeasuredDrop};
pub use bounces::bounces;
pub use explain::fit;
use set::{Set, Which};
pub use write::{Written, written};

/// Strikes of a record at most.
pub const MOST_STRIKES: usize = 4096;
/// Samples of a record at most.
pub const MOST_SAMPLES: usize = 1_000_000;

/// The data of the product and of its drop that the product file states.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// Length and center of mass; the radius of gyration is where the search begins, and stays where the data do not tell it.
    pub body: Body,
    /// Range of the radius of gyration, in m.
    pub gyration_m: [f64; 2],
    /// True where the radius of gyration is known and not fitted. Strike times tell it and the restitution mostly together, so that
    /// the restitution is then known several times better.
    pub gyration_known: bool,
    /// The end that touches first.
    pub first: First,
    /// Gravity, in m/s²; 0 switches it off.
    pub gravity_m_s2: f64,
    /// Range of the restitution.
    pub restitution: [f64; 2],
    /// Range of the speed at the first touch.
    pub speed_m_s: [f64; 2],
    /// Range of the tilt.
    pub tilt_rad: [f64; 2],
    /// Range of the contact time, where it is known: contacts then take time in the fit as well.
    pub contact_time_s: Option<[f64; 2]>,
    /// The law of the force of the ground on an end while it touches.
    pub contact_law: ContactLaw,
}

impl From<&ProductFile> for Known {
    fn from(file: &ProductFile) -> Self {
        let range = |spread: &clatter_product::Spread| [spread.lo(), spread.hi()];
        Self {
            body: file.product.body,
            gyration_m: range(&file.product.gyration_m),
            gyration_known: false,
            first: file.drop.first,
            gravity_m_s2: file.drop.gravity_m_s2,
            restitution: range(&file.product.restitution),
            speed_m_s: file.drop.speeds_m_s(),
            tilt_rad: range(&file.drop.tilt_rad),
            contact_time_s: file.product.contact_time_s.as_ref().map(range),
            contact_law: file.product.law(),
        }
    }
}

impl Known {
    /// Checks that every range is one that a product may have.
    ///
    /// # Errors
    /// [`Error::Known`] for the first value that is not.
    pub fn check(&self) -> Result<(), Error> {
        const POSITIVE: [f64; 2] = [f64::MIN_POSITIVE, 1e6];
        // Angles come from degrees.
        let most_tilt = FRAC_PI_6 * (1.0 + 4.0 * f64::EPSILON);
        let contact_time_s = self.contact_time_s.unwrap_or([1e-3; 2]);
        let ranges = [
            ("restitution", self.restitution, [0.0, 1.0], "within [0, 1], from the lower end"),
            ("speed in m/s", self.speed_m_s, POSITIVE, "positive and at most 1e6, from the lower end"),
            ("tilt in rad", self.tilt_rad, [0.0, most_tilt], "within [0, pi/6], from the lower end"),
            ("contact time in s", contact_time_s, [1e-12, 1e3], "within [1e-12, 1000], from the lower end"),
            ("radius of gyration in m", self.gyration_m, POSITIVE, "positive and at most 1e6, from the lower end"),
            ("gravity in m/s2", [self.gravity_m_s2; 2], [0.0, 1e3], "in [0, 1000]"),
        ];
        for (name, [lo, hi], [least, most], allowed) in ranges {
            for (value, within) in [(lo, least..=most), (hi, lo..=most)] {
                if !within.contains(&value) {
                    return Err(Error::Known { name, value, allowed });
                }
            }
        }
        Ok(())
    }
}

/// One record of a drop. Its time axis begins anywhere.
#[derive(Debug, Clone, PartialEq)]
pub enum Measured {
    /// Times of strikes.
    Strikes {
        /// The strikes, in order of time.
        strikes: Vec<MeasuredStrike>,
        /// Standard deviation of a time; without it the scatter about the fit tells it.
        deviation_s: Option<f64>,
    },
    /// Heights of both ends over the ground, from a video.
    Heights {
        /// The samples, in order of time.
        samples: Vec<MeasuredHeights>,
        /// Standard deviation of a height; without it the scatter about the fit tells it.
        deviation_m: Option<f64>,
    },
    /// Acceleration at a place, upward positive and 0 in free fall, as sensors have it.
    Acceleration {
        /// The place of the sensor from the middle of the product towards end b.
        position_m: f64,
        /// Time of the first value.
        start_s: f64,
        /// Time between two values.
        step_s: f64,
        /// Each the mean over a step about its time.
        values_m_s2: Vec<f64>,
    },
}

/// One strike of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredStrike {
    /// The time, on the time axis of the record.
    pub time_s: f64,
    /// The end that strikes, where it is known.
    pub end: Option<End>,
}

/// Heights of both ends at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredHeights {
    /// The time, on the time axis of the record.
    pub time_s: f64,
    /// The heights of ends a and b over the ground.
    pub height_m: [f64; 2],
}

/// A quantity that a fit may determine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Quantity {
    /// Coefficient of restitution of both ends.
    Restitution,
    /// The restitution of end a.
    RestitutionA,
    /// The restitution of end b.
    RestitutionB,
    /// Radius of gyration about the center of mass, in m.
    RadiusOfGyration,
    /// Inertia ratio of the level body.
    InertiaRatio,
    /// Height gap of the ends at the first touch over the speed, in s.
    GapOverSpeed,
    /// Speed at the first touch, in m/s.
    Speed,
    /// Height from which a body reaches that speed, in m.
    DropHeight,
    /// Angle to the ground at the first touch, in rad.
    Tilt,
    /// Angular velocity at the first touch, end b upward, in rad/s.
    Spin,
    /// The time of a lone contact, in s.
    ContactTime,
}

impl Quantity {
    /// Returns the name: `restitution`, `restitution-a`, `restitution-b`, `radius-of-gyration`, `inertia-ratio`, `gap-over-speed`, `speed`,
    /// `drop-height`, `tilt`, `spin` or `contact-time`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Restitution => "restitution",
            Self::RestitutionA => "restitution-a",
            Self::RestitutionB => "restitution-b",
            Self::RadiusOfGyration => "radius-of-gyration",
            Self::InertiaRatio => "inertia-ratio",
            Self::GapOverSpeed => "gap-over-speed",
            Self::Speed => "speed",
            Self::DropHeight => "drop-height",
            Self::Tilt => "tilt",
            Self::Spin => "spin",
            Self::ContactTime => "contact-time",
        }
    }
    /// Its SI unit; empty for a plain number.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Restitution | Self::RestitutionA | Self::RestitutionB | Self::InertiaRatio => "",
            Self::RadiusOfGyration | Self::DropHeight => "m",
            Self::GapOverSpeed | Self::ContactTime => "s",
            Self::Speed => "m/s",
            Self::Tilt => "rad",
            Self::Spin => "rad/s",
        }
    }
}

/// A quantity, its value and how far it may be off.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The estimated quantity.
    pub quantity: Quantity,
    /// Its value with which the computed drop is nearest to the measured one.
    pub value: f64,
    /// Holds the true value in 95 of 100 measurements of this drop with other noise, for which see [`fit`]; none where nothing tells the
    /// scatter of the data.
    pub interval: Option<[f64; 2]>,
    /// A remark where the value depends on data of the product file; else none.
    pub note: Option<String>,
}

/// A quantity that the data do not tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Undetermined {
    /// The quantity that is not determined.
    pub quantity: Quantity,
    /// Its value in the computed drop: that of the product file, or within its range there.
    pub held_at: f64,
    /// The reason.
    pub reason: String,
}

/// The outcome of a fit for one measured strike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrikeFit {
    /// The strike as measured.
    pub measured: MeasuredStrike,
    /// The computed strike that it is, from 1; none if it was left out as wrong.
    pub number: Option<usize>,
    /// Measured less computed time.
    pub residual_s: Option<f64>,
}

/// The outcome of a fit for one record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFit {
    /// The first touch on the time axis of the record.
    pub first_touch_s: f64,
    /// Root mean square of measured less computed values, in s, m or m/s².
    pub scatter: f64,
    /// The fits of strikes, one by one; else empty.
    pub strikes: Vec<StrikeFit>,
    /// Numbers of computed strikes before the last measured one that the record does not have.
    pub missing: Vec<usize>,
    /// The curves of heights of ends a and b, or of accelerations: time, measured and computed value; else empty.
    pub curves: Vec<Vec<[f64; 3]>>,
}

/// An explanation that is about as good as the best one: other strikes are missing or left out, or the other end touches first.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The end that touches first.
    pub first: End,
    /// For each record, the numbers of computed strikes that it does not have.
    pub missing: Vec<Vec<usize>>,
    /// For each record, the times of strikes that are left out.
    pub left_out_s: Vec<Vec<f64>>,
    /// The estimates that this record alone would give, with intervals of its own.
    pub estimates: Vec<Estimate>,
}

/// The result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The model of the computed drop: finite-tilt, or compliant where contacts take time.
    pub model: Model,
    /// The end that touches first.
    pub first: End,
    /// The quantities that the data determine, with their intervals.
    pub estimates: Vec<Estimate>,
    /// The quantities that the data do not determine.
    pub untold: Vec<Undetermined>,
    /// Correlations of the estimates, in their order; empty where nothing tells the scatter of the data.
    pub correlations: Vec<Vec<f64>>,
    /// Number of data less that of unknowns.
    pub degrees_of_freedom: usize,
    /// Explanations that are about as good; the intervals hold all of them.
    pub others: Vec<Explanation>,
    /// Each record.
    pub records: Vec<RecordFit>,
    /// Computed strikes, up to the last one that was measured and three more: time since the first touch, and which end.
    pub computed: Vec<(f64, End)>,
    /// Remarks on anything odd: strikes missing or left out, a drop that does not explain the data.
    pub notes: Vec<String>,
}

/// The reason why there is no fit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number of a record that none can be.
    #[error("record {record}: {name} = {value:?} is not {allowed}")]
    Value {
        /// The number of the record, from 1.
        record: usize,
        /// Its name.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A value of the product or its drop that none has.
    #[error("{name} = {value:?} is not {allowed}")]
    Known {
        /// Its name.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// Too few or too many data.
    #[error("record {record}: {count} {name}; allowed: {allowed}")]
    Count {
        /// The number of the record, from 1.
        record: usize,
        /// The number of data.
        count: usize,
        /// The name of the data.
        name: &'static str,
        /// The allowed values.
        allowed: &'static str,
    },
    /// No records.
    #[error("nothing was measured: give at least one record")]
    Nothing,
    /// The nearest computed drop is far from the data.
    #[error(
        "record {record}: no drop was found that comes near: {name} of the nearest are off by {percent:.0} % of {of}, root mean \
             square; allowed are {allowed:.0} %: check units, ends and the length in the product file; with contacts that take time \
             missing strikes are not looked for"
    )]
    Far {
        /// The number of the record, from 1.
        record: usize,
        /// The measured quantity.
        name: &'static str,
        /// The root mean square of the difference in percent,
        percent: f64,
        /// as a share of this.
        of: &'static str,
        /// The largest share that is accepted, in percent.
        allowed: f64,
    },
    /// The data scatter more than the deviation given explains.
    #[error(
        "record {record}: no drop was found that explains it: the data scatter by {factor:.1} times the standard deviation given \
             about the nearest one. Either they are timed less well, or what is odd about them is not one of the things that are looked for; \
             with contacts that take time missing strikes are not looked for. Without a standard deviation the scatter tells it. \
             Where strikes come within a millisecond of each other, what follows depends on them so much that it may not be found: leave \
             later strikes out"
    )]
    Scatter {
        /// The number of the record, from 1.
        record: usize,
        /// The scatter over the standard deviation that was given.
        factor: f64,
    },
    /// The nearest drop leaves more of the accelerations unexplained than the noise before the first touch.
    #[error(
        "record {record}: no drop was found that explains it: the nearest one leaves {factor:.1} times the noise before the first touch. \
             Either the case rings or the sensor filters, or another drop was not found: check --position, the sign of the axis, the units and \
             the length in the product file, or cut the record after the first strikes"
    )]
    Noise {
        /// The number of the record, from 1.
        record: usize,
        /// The remainder over the root mean square before the first touch.
        factor: f64,
    },
    /// No computed drop comes near the data.
    #[error(
        "no drop was found whose {0} are as measured: check units, ends and the length in the product file. Where strikes come within \
             a millisecond of each other, what follows depends on them so much that it may not be found: leave later strikes out"
    )]
    NoDrop(&'static str),
}

impl Error {
    /// Returns whether the records are as they should be, and no drop explains them.
    #[must_use]
    pub const fn is_no_drop(&self) -> bool {
        matches!(self, Self::Far { .. } | Self::Scatter { .. } | Self::Noise { .. } | Self::NoDrop(_))
    }
}
