//! What a pair of models answers.

use clatter::flight::{Body, CompliantFlight, Flight, Model, Scene};
use clatter::{Bar, PeakImpact, Start};
use clatter_shock::{Extreme, Peaked, Pulses, Suspension, VelocityShock, VelocityShocks};

use super::history;
use super::quick::{decay, ln};
use super::{BarRung, ComponentRung, Pair, Quantity, Setup};
use crate::Error;

/// Pieces of the polygon of one pulse, and within what share its peak and its effect then are in 999 of 1000 random
/// scenes; with more of them, that falls with this power of their number.
const CELLS: usize = 34;
const WITHIN: f64 = 1e-4;
const POWER: f64 = 2.5;
/// The share of a tolerance that the pieces of pulses take, about.
const OF_PIECES: f64 = 0.1;
/// Pieces of a pulse at most: 1e-6; and at least, of the softest part.
const MOST_CELLS: f64 = 200.0;
const LEAST: f64 = 3.0;

/// Beyond this phase in one contact the pieces grow finer with it.
const FINE: f64 = 6.0;

/// Strikes of the map at most: a train as long has died down, or goes on like this.
const MOST_OF_MAP: usize = 1000;

/// What a pair says, and what it took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The quantity asked, in m/s², m or m/s.
    pub value: f64,
    /// Strikes followed; 0 in closed form.
    pub strikes: usize,
    /// Straight pieces of the pulses that the component was driven through; 0 without pulses.
    pub pieces: usize,
}

impl Answer {
    /// In closed form.
    fn at_once(value: f64) -> Self {
        Self { value, strikes: 0, pieces: 0 }
    }
}

impl Setup {
    /// The quantity asked, by one pair of models, in m/s², m or m/s. Strikes after `until_s` ([`Forecast::until_s`], or
    /// infinity) are left out; all but the map find for themselves, by the energy of the flight that they follow, when
    /// nothing later raises the quantity.
    ///
    /// The closed form has no train: with it, the trains are those of the map.
    ///
    /// # Accuracy
    /// That of the models; pulses are polygons, whose peak and effect are within 1e-4 in 999 of 1000 random scenes, and
    /// of light ends whose contacts act on each other within 1.3e-3.
    ///
    /// # Errors
    /// [`Error::Bar`] where the compliant model refuses the scene; [`Error::Contact`] for a rung that needs the contact
    /// time where there is none.
    ///
    /// [`Forecast::until_s`]: super::Forecast::until_s
    pub fn demand(&self, pair: Pair, quantity: Quantity, until_s: f64) -> Result<f64, Error> {
        self.answer(pair, quantity, until_s).map(|answer| answer.value)
    }

    /// As [`demand`](Self::demand), with what it took.
    ///
    /// # Errors
    /// As [`demand`](Self::demand).
    pub fn answer(&self, pair: Pair, quantity: Quantity, until_s: f64) -> Result<Answer, Error> {
        self.answer_in(pair, quantity, until_s, CELLS, 0.0)
    }

    /// As [`answer`](Self::answer), in pulses of `cells` pieces, and strikes followed until nothing later raises it
    /// beyond a tolerance.
    pub(super) fn answer_in(
        &self,
        pair: Pair,
        quantity: Quantity,
        until_s: f64,
        cells: usize,
        tolerance: f64,
    ) -> Result<Answer, Error> {
        if pair == Pair::HIGHEST {
            let contact_s = self.known_contact_s()?;
            let (flight, settled_s) = self.settled_flight(quantity, contact_s, tolerance)?;
            return self.of_contacts(&flight, settled_s, contact_s, quantity, cells);
        }
        let model = match (pair.bar, pair.component) {
            // A net change is that of all strikes.
            (_, ComponentRung::NetChange) => return self.answer_fine(pair, quantity, until_s, cells),
            (BarRung::Ballistic, _) => Model::Ballistic,
            (BarRung::FiniteTilt, _) => Model::FiniteTilt,
            _ => return self.answer_fine(pair, quantity, until_s, cells),
        };
        let lasts_s = if pair.component == ComponentRung::PulseTrain { self.known_contact_s()? } else { 0.0 };
        let flight = self.settled_strikes(&self.scene_until(until_s)?, model, quantity, lasts_s, tolerance);
        self.of_flight(&flight, pair.component, quantity, cells)
    }

    /// As [`demand`](Self::demand), followed until `until_s` or rest whatever it takes, and pulses of `cells` pieces:
    /// twice as many are five times as close.
    ///
    /// # Errors
    /// As [`demand`](Self::demand).
    pub fn demand_fine(&self, pair: Pair, quantity: Quantity, until_s: f64, cells: usize) -> Result<f64, Error> {
        self.answer_fine(pair, quantity, until_s, cells).map(|answer| answer.value)
    }

    /// As [`demand_fine`](Self::demand_fine), with what it took.
    ///
    /// # Errors
    /// As [`demand`](Self::demand).
    pub fn answer_fine(&self, pair: Pair, quantity: Quantity, until_s: f64, cells: usize) -> Result<Answer, Error> {
        let scene = self.scene_until(until_s)?;
        let model = match pair.bar {
            BarRung::ClosedForm => match pair.component {
                ComponentRung::NetChange => return Ok(Answer::at_once(self.of_one(self.net_change(), quantity))),
                ComponentRung::LargestShock => return Ok(Answer::at_once(self.of_one(self.largest_shock(), quantity))),
                _ => Model::Map,
            },
            BarRung::Map => Model::Map,
            BarRung::Ballistic => Model::Ballistic,
            BarRung::FiniteTilt => Model::FiniteTilt,
            BarRung::Compliant => {
                let time = self.known_contact_s()?;
                let flight = scene.simulate_compliant(time)?;
                if pair.component != ComponentRung::PulseTrain {
                    return self.of_flight(&flight.flight, pair.component, quantity, cells);
                }
                return self.of_contacts(&flight, f64::INFINITY, time, quantity, cells);
            }
        };
        let scene = if model == Model::Map { scene.with_impact_limit(MOST_OF_MAP)? } else { scene };
        self.of_flight(&scene.simulate(model), pair.component, quantity, cells)
    }

    fn scene_until(&self, until_s: f64) -> Result<Scene, Error> {
        Ok(if until_s < f64::INFINITY { self.scene.with_time_limit_s(until_s)? } else { self.scene })
    }

    fn known_contact_s(&self) -> Result<f64, Error> {
        self.contact_time_s.ok_or(Error::Contact)
    }

    /// Pieces of a pulse.
    fn cells(&self, cells: usize, contact_s: f64) -> usize {
        #[expect(clippy::cast_precision_loss, reason = "a few hundred")]
        let pieces =
            cells as f64 * fineness(&self.suspension, contact_s) * crowding(&self.scene.body(), &self.suspension);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
        let pieces = pieces.ceil().max(LEAST) as usize;
        pieces
    }

    fn of_contacts(
        &self,
        flight: &CompliantFlight,
        until_s: f64,
        contact_s: f64,
        quantity: Quantity,
        cells: usize,
    ) -> Result<Answer, Error> {
        let shocks = quantity == Quantity::VelocityShock;
        let cells = if shocks { cells } else { self.cells(cells, contact_s) };
        #[expect(clippy::cast_precision_loss, reason = "a few hundred")]
        let pushes = history::of_contacts(&self.scene, flight, until_s, contact_s, cells as f64);
        let at = |[a, b]: [f64; 2]| 0.5 * ((1.0 - self.position) * a + (1.0 + self.position) * b);
        let polygon = history::at_place(&pushes, &self.suspension, at);
        let strikes = flight.flight.strikes.len();
        if shocks {
            let value = history::largest_change(&polygon, contact_s).abs();
            return Ok(Answer { value, strikes, pieces: pieces(&polygon) });
        }
        self.of_polygon(&polygon, quantity, strikes)
    }

    /// The response to one velocity shock, or the shock itself.
    pub(crate) fn of_one(&self, delta_v: f64, quantity: Quantity) -> f64 {
        let (factors, omega) = (self.suspension.damping().impulse_factors(), self.suspension.omega());
        delta_v.abs()
            * match quantity {
                Quantity::PeakAcceleration => omega * factors.acceleration,
                Quantity::RattleSpace => factors.displacement / omega,
                Quantity::VelocityShock => 1.0,
            }
    }

    fn of_flight(
        &self,
        flight: &Flight,
        component: ComponentRung,
        quantity: Quantity,
        cells: usize,
    ) -> Result<Answer, Error> {
        let (shocks, strikes) = (self.shocks(flight)?, flight.strikes.len());
        let value = match component {
            _ if quantity == Quantity::VelocityShock => shocks.largest(),
            ComponentRung::NetChange => self.of_one(shocks.net(), quantity),
            ComponentRung::LargestShock => self.of_one(shocks.largest(), quantity),
            ComponentRung::ImpulseTrain => self.of_impulses(&shocks, quantity),
            ComponentRung::PulseTrain => {
                let time = self.known_contact_s()?;
                let polygon = history::of_shocks(shocks.as_slice(), self.scene.e(), time, self.cells(cells, time));
                return self.of_polygon(&polygon, quantity, strikes);
            }
        };
        Ok(Answer { value, strikes, pieces: 0 })
    }

    /// What a flight does to the component's place.
    pub(crate) fn shocks(&self, flight: &Flight) -> Result<VelocityShocks, Error> {
        let mut last = 0.0_f64;
        // Times of strikes at one instant may run back by a rounding.
        let shocks = flight.strikes.iter().map(|s| {
            last = last.max(s.time_s);
            VelocityShock { time: last, delta_v: s.delta_v_at(self.position) }
        });
        Ok(VelocityShocks::new(shocks.collect())?)
    }

    /// The response to impulses, or the largest of them.
    pub(crate) fn of_impulses(&self, shocks: &VelocityShocks, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::VelocityShock => shocks.largest(),
            _ => self.scaled(shocks.peak_above(&self.suspension, peaked(quantity), 0.0), quantity),
        }
    }

    fn of_polygon(&self, polygon: &[(f64, f64)], quantity: Quantity, strikes: usize) -> Result<Answer, Error> {
        let pulses = Pulses::piecewise_linear(polygon)?;
        let value = self.scaled(pulses.peak_above(&self.suspension, peaked(quantity), 0.0), quantity);
        Ok(Answer { value, strikes, pieces: pieces(polygon) })
    }

    /// A peak, from velocity to what is asked.
    fn scaled(&self, peak: Option<Extreme>, quantity: Quantity) -> f64 {
        let (peak, omega) = (peak.map_or(0.0, |peak| peak.value.abs()), self.suspension.omega());
        if quantity == Quantity::PeakAcceleration { omega * peak } else { peak / omega }
    }

    /// Sum of all velocity shocks of the map, in closed form; infinite where it has no limit.
    fn net_change(&self) -> f64 {
        let (bar, start, kappa) = self.scene.symmetric_bar();
        let summary = bar.summary(&start);
        let at = |a: f64, b: f64| 0.5 * ((1.0 - self.position) * a + (1.0 + self.position) * b);
        summary.net.map_or(f64::INFINITY, |net| at(net.a, net.b / kappa))
    }

    /// Largest velocity shock of the map at the position, in closed form: that of one end stands beside that of the
    /// other.
    fn largest_shock(&self) -> f64 {
        let (bar, start, kappa) = self.scene.symmetric_bar();
        let first = match bar.peak(&start).impact {
            PeakImpact::Number(n) => n.saturating_sub(2),
            PeakImpact::Huge(_) | PeakImpact::Limit => return f64::INFINITY,
        };
        let ratios = self.scene.body().inertia_ratios();
        let shock = |i: clatter::Impact| {
            let (toward, ratio, scale) = match i.end {
                clatter::End::A => (-self.position, ratios[0], 1.0),
                clatter::End::B => (self.position, ratios[1], 1.0 / kappa),
            };
            let jump = (1.0 + self.scene.e()) * i.approach * scale;
            (0.5 * jump * ((1.0 + toward) - (1.0 - toward) * ratio)).abs()
        };
        nearby(&bar, &start, first).map(shock).fold(0.0, f64::max)
    }
}

/// Pieces of a polygon, jumps left out.
fn pieces(polygon: &[(f64, f64)]) -> usize {
    polygon.windows(2).filter(|pair| pair[0].0 < pair[1].0).count()
}

/// Whether a bar with this error serves, its pulses in pieces.
pub(super) fn serves(error: f64, tolerance: f64) -> bool {
    error <= (1.0 - OF_PIECES) * tolerance
}

/// Pieces of a pulse that take [`OF_PIECES`] of a tolerance.
pub(crate) fn pieces_for(tolerance: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let cells = CELLS as f64 * decay(ln(OF_PIECES * tolerance / WITHIN) / POWER);
    cells.clamp(1.0, MOST_CELLS)
}

/// Share of the pieces of a pulse that a component needs: a stiff or much damped one follows the corners of a polygon,
/// a soft one sees little of them, but by its dashpot the turning of the velocity where contacts overlap.
pub(crate) fn fineness(suspension: &Suspension, contact_s: f64) -> f64 {
    let (turned, zeta) = (suspension.omega() * contact_s, suspension.damping().get());
    let fineness = (turned * (1.0 + 2.0 * zeta)).max(turned / 8.0);
    let least = (0.6 * zeta).clamp(0.125, 0.3);
    // By the fastest of its motions.
    let fast = turned * (zeta + (zeta * zeta - 1.0).max(0.0).sqrt()).max(1.0);
    fineness.clamp(least, 1.0) * (fast / FINE).clamp(1.0, 4.0)
}

/// How many times as many pieces a part with a strong dashpot needs on a body with light ends: there the shocks of both
/// nearly cancel in overlap, to a share of 1 − q, and the dashpot follows what is left; that is off by the second to
/// third power of a piece. Random scenes show it from ζ = 1.1 on; ten times as many at most.
pub(crate) fn crowding(body: &Body, suspension: &Suspension) -> f64 {
    let [a, b] = body.inertia_ratios();
    let apart = 1.0 - a.max(b);
    if suspension.damping().get() < 0.7 || apart >= 0.5 { 1.0 } else { (2.0 * apart).max(0.01).sqrt().recip() }
}

/// Three impacts from number `first` + 1 on.
fn nearby(bar: &Bar, start: &Start, first: u64) -> impl Iterator<Item = clatter::Impact> {
    let mut train = bar.train(start);
    let skip = usize::try_from(first).unwrap_or(usize::MAX);
    let head = train.nth(skip);
    head.into_iter().chain(train.take(2))
}

fn peaked(quantity: Quantity) -> Peaked {
    match quantity {
        Quantity::PeakAcceleration => Peaked::AccelerationOverOmega,
        _ => Peaked::PseudoVelocity,
    }
}
