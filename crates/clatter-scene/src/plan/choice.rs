//! The cheapest pair within a tolerance, and why.

use std::fmt;

use super::demand::{pieces_for, serves};
use super::forecast::Prices;
use super::walked::Stop;
use super::{BarRung, ComponentRung, Estimate, Forecast, Groups, Pair, Quantity, Setup};
use crate::Error;

/// The models for one scene and quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// One rung of each ladder.
    pub pair: Pair,
    /// The tolerance that it was chosen for.
    pub tolerance: f64,
    /// What it gets wrong, as a share of the quantity; the pieces of its pulses come to that, and the strikes that
    /// [`Plan::run`] leaves out.
    pub estimate: Estimate,
    /// The estimates for all pairs.
    pub forecast: Forecast,
    /// Models need not be followed beyond this time since the first touch; infinite where that is not known.
    pub until_s: f64,
    /// Where the tolerance is not reached, or is reached on a condition.
    pub warning: Option<Warning>,
}

/// Which groups made cheaper models too coarse; `Display` says it in a sentence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reason {
    /// The quantity asked.
    pub quantity: Quantity,
    /// The rungs that are good enough.
    pub pair: Pair,
    /// Errors of the map, of parabolas and of real tilt.
    pub bar: [f64; 3],
    /// Whether contacts overlap.
    pub overlaps: bool,
    /// Whether later rebounds may decide.
    pub rebounds: bool,
    /// The scene's groups.
    pub groups: Groups,
}

/// Why a plan may not hold.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// No contact time is known: the estimate holds for contacts up to this time.
    ContactTimeUnknown {
        /// At longer ones pulses are no impulses within the tolerance, or contacts overlap; 0 where strikes decide that
        /// come later than those foreseen.
        longest_s: f64,
    },
    /// No rung reaches the tolerance: the compliant one, which would, refuses the scene or has no contact time.
    ToleranceNotReached {
        /// What the pair gets wrong, about.
        error: f64,
        /// Whether contacts overlap, which no rigid model knows.
        overlaps: bool,
    },
}

impl Forecast {
    /// The cheapest pair whose estimate is within a tolerance; the highest where none is, and with a warning the
    /// closest where that is not to be had.
    #[must_use]
    pub fn plan(&self, tolerance: f64) -> Plan {
        let chosen = self.cheapest(tolerance);
        let pair = chosen.unwrap_or_else(|| self.closest());
        let estimate = self.pair(pair);
        let warning = if chosen.is_none() {
            Some(Warning::ToleranceNotReached { error: estimate.error, overlaps: self.overlaps })
        } else if self.contact_known {
            None
        } else {
            Some(Warning::ContactTimeUnknown { longest_s: self.longest_contact_s(pair, tolerance) })
        };
        Plan { pair, tolerance, estimate, forecast: *self, warning, until_s: self.until_s }
    }

    /// The cheapest pair whose estimate is within a tolerance.
    fn cheapest(&self, tolerance: f64) -> Option<Pair> {
        let is_pulses = |pair: Pair| pair.component == ComponentRung::PulseTrain;
        if self.bar(BarRung::FiniteTilt).error > tolerance {
            // No bar without contacts knows more.
            return (self.error(Pair::HIGHEST) <= tolerance).then_some(Pair::HIGHEST);
        }
        // Of few strikes, impulses cost less than any pulses, and the pieces of coarse pulses change no order.
        let is_short = self.is_short();
        let counts = !is_short || tolerance < COARSE;
        let mut pieces = 0;
        let mut chosen: Option<(Pair, Option<(Prices, f64)>)> = None;
        for &pair in Pair::planned(self.quantity) {
            let error = self.error(pair);
            if !(if is_pulses(pair) { serves(error, tolerance) } else { error <= tolerance }) {
                continue;
            }
            let Some((cheapest, priced)) = &mut chosen else {
                chosen = Some((pair, None));
                if pair.bar == BarRung::ClosedForm {
                    // Nothing costs less.
                    break;
                }
                continue;
            };
            if is_short && is_pulses(pair) && !is_pulses(*cheapest) {
                break;
            }
            if counts && is_pulses(pair) && pieces == 0 {
                pieces = whole_pieces_for(tolerance);
            }
            let (prices, least) = priced.get_or_insert_with(|| {
                let prices = self.prices();
                (prices, prices.of(*cheapest, pieces))
            });
            let cost = prices.of(pair, pieces);
            if cost < *least {
                (*cheapest, *least) = (pair, cost);
            }
        }
        chosen.map(|(pair, _)| pair)
    }

    /// The pair with the least error, the one with most physics of several.
    fn closest(&self) -> Pair {
        let mut closest = Pair { bar: BarRung::FiniteTilt, component: ComponentRung::ImpulseTrain };
        for &pair in Pair::planned(self.quantity) {
            // Where none has an estimate, not one that cannot be used.
            let error = self.pair(pair).error;
            if error < f64::INFINITY && error <= self.pair(closest).error {
                closest = pair;
            }
        }
        closest
    }

    /// Up to which contact time impulses stay within the tolerance that a pair leaves, and contacts apart.
    fn longest_contact_s(&self, pair: Pair, tolerance: f64) -> f64 {
        if self.doubt > tolerance {
            return 0.0;
        }
        let room = (tolerance - self.pair(pair).error).max(0.0);
        let [linear, square] = self.impulse_phase;
        // linear x + square x² = room
        let phase = 2.0 * room / (linear + (linear * linear + 4.0 * square * room).sqrt());
        let pulses = if self.quantity == Quantity::VelocityShock { f64::INFINITY } else { phase / self.omega };
        pulses.min(self.shortest_gap_s)
    }
}

/// From this tolerance on pulses have 24 pieces at most, and by [`Prices`] those of impacts cost less than contacts.
const COARSE: f64 = 0.0025;

/// Pieces of a pulse that take their share of a tolerance, as plans count them. In line, it would be worked out for all.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
#[expect(clippy::cast_precision_loss, reason = "a few hundred")]
#[inline(never)]
fn whole_pieces_for(tolerance: f64) -> usize {
    let pieces = pieces_for(tolerance);
    // `ceil` is a call.
    let below = pieces as usize;
    below + usize::from((below as f64) < pieces)
}

impl Plan {
    /// The quantity asked.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        self.forecast.quantity
    }
    /// Which groups decided.
    #[must_use]
    pub fn reason(&self) -> Reason {
        let forecast = &self.forecast;
        Reason {
            quantity: forecast.quantity,
            pair: self.pair,
            bar: [BarRung::Map, BarRung::Ballistic, BarRung::FiniteTilt].map(|rung| forecast.bar(rung).error),
            overlaps: forecast.overlaps,
            rebounds: forecast.until_s == f64::INFINITY && forecast.stop != Stop::Off,
            groups: forecast.groups,
        }
    }
    /// Pieces of a pulse that does all: they take a tenth of the tolerance, about.
    #[must_use]
    pub fn pieces(&self) -> usize {
        whole_pieces_for(self.tolerance)
    }
    /// What it costs, about: see [`Forecast::cost_ns`].
    #[must_use]
    pub fn cost_ns(&self) -> f64 {
        self.forecast.cost_ns(self.pair, self.pieces())
    }
    /// Whether the strikes looked at leave open what later ones do, and there are later ones to look at: none are
    /// foreseen of a bar that turns upright or over, or comes to rest. [`Setup::plan_from`] more strikes may then find a
    /// cheaper pair.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.forecast.stop == Stop::CutShort && !serves(self.forecast.doubt, self.tolerance)
    }
    /// The quantity asked, by the models of the plan. Strikes and contacts are followed until, by the energy left,
    /// nothing later raises it by more than about 20 % with a tolerance of 10 %, or at all with one of 7 % and less. Of
    /// 1.4·10⁵ random answers of the highest pair none was off by more than 1e-5 where nothing was allowed; at 10 % one or
    /// two in a thousand are by more than that, and none of 59 000 was by 21 %. Of 60 000 of impacts none was by 6 %.
    ///
    /// # Errors
    /// As [`Setup::demand`].
    pub fn run(&self, setup: &Setup) -> Result<f64, Error> {
        setup
            .answer_in(self.pair, self.quantity(), self.until_s, self.pieces(), self.tolerance)
            .map(|answer| answer.value)
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let g = &self.groups;
        let [map, ballistic, tilted] = self.bar;
        match self.pair.bar {
            BarRung::ClosedForm | BarRung::Map => {
                write!(f, "gravity (g h0/v0² = {:.1e}), tilt (φ² = {:.1e})", g.gravity, g.geometry)?;
                f.write_str(" and contact time change too little to count")?;
            }
            BarRung::Ballistic => {
                write!(f, "gravity counts (g h0/v0² = {:.1e}, without it {})", g.gravity, Share(map))?;
            }
            BarRung::FiniteTilt if g.geometry == 0.0 => {
                write!(
                    f,
                    "both ends land at once, and what small-tilt models make of that may be {}",
                    Share(ballistic)
                )?;
            }
            BarRung::FiniteTilt => {
                write!(
                    f,
                    "the tilt changes the lever arms (φ² = {:.1e}, without it {})",
                    g.geometry,
                    Share(ballistic)
                )?;
            }
            BarRung::Compliant if self.overlaps && g.overlap < 100.0 => {
                write!(f, "contacts overlap (contact time {:.2} of the time between strikes)", g.overlap)?;
            }
            BarRung::Compliant if self.overlaps => f.write_str("contacts overlap (strikes come together)")?,
            BarRung::Compliant if self.rebounds => {
                write!(f, "later rebounds may decide, and contacts shift them ({} without)", Share(tilted))?;
            }
            BarRung::Compliant => {
                write!(f, "contacts take time enough to delay the strikes ({} without)", Share(tilted))?;
            }
        }
        match self.pair.component {
            _ if self.quantity == Quantity::VelocityShock => f.write_str("; one shock decides"),
            ComponentRung::NetChange => write!(f, "; the whole clatter is one push (ω t_N = {:.2})", g.train),
            ComponentRung::LargestShock => f.write_str("; one shock decides"),
            ComponentRung::ImpulseTrain if g.pulse == 0.0 => f.write_str("; strikes act as impulses"),
            ComponentRung::ImpulseTrain => write!(f, "; pulses are as good as impulses (ωτ = {:.2})", g.pulse),
            ComponentRung::PulseTrain => write!(f, "; pulses last {:.2} rad of the component's motion", g.pulse),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ContactTimeUnknown { longest_s: 0.0 } => f.write_str(
                "no contact time is known, and later rebounds may decide: this holds for contacts that are over long before the next",
            ),
            Self::ContactTimeUnknown { longest_s } => {
                write!(f, "no contact time is known: this holds for contacts of up to {:.3} ms", 1e3 * longest_s)
            }
            Self::ToleranceNotReached { error, overlaps } => {
                write!(f, "no model reaches the tolerance; this one may be {}", Share(error))?;
                if overlaps {
                    f.write_str(", because contacts overlap, which rigid models do not know")
                } else {
                    Ok(())
                }
            }
        }
    }
}

/// An error as people read it.
pub(crate) struct Share(pub(crate) f64);

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 <= 1.0 { write!(f, "{:.2} % off", 100.0 * self.0) } else { f.write_str("far off") }
    }
}
