//! How far contacts are followed: until nothing that can come raises the quantity.

use clatter::flight::{CompliantFlight, Stop};

use super::forecast::{later_response, later_shock};
use super::lane::{Ends, Lane};
use super::swing::{Motion, Swing};
use super::{Quantity, Setup};
use crate::Error;

/// Strikes followed at most, in turn, before all are.
const LIMITS: [usize; 4] = [3, 8, 24, 96];

/// What can come must stay below this share of the peak: pulses flatten both, not alike.
const CLEAR: f64 = 0.75;
/// Contact times beyond which a contact is no shock.
const LONG: f64 = 4.0;

impl Setup {
    /// A flight with contacts, and the time after which no strike of it raises the quantity: by the bound of [`Forecast::until_s`] on the
    /// flight itself, which is followed further until it holds, or to its end.
    ///
    /// [`Forecast::until_s`]: super::Forecast::until_s
    pub(super) fn settled_flight(&self, quantity: Quantity, contact_s: f64) -> Result<(CompliantFlight, f64), Error> {
        for limit in LIMITS {
            let flight = self.scene.with_impact_limit(limit)?.simulate_compliant(contact_s)?;
            let whole = !matches!(flight.flight.stop, Stop::ImpactLimit { .. });
            let settled_s = self.settled_s(&flight, quantity, contact_s);
            if whole || settled_s < f64::INFINITY {
                return Ok((flight, settled_s));
            }
        }
        Ok((self.scene.simulate_compliant(contact_s)?, f64::INFINITY))
    }

    /// When nothing later in this flight raises the quantity; infinite where that is not known.
    pub(crate) fn settled_s(&self, flight: &CompliantFlight, quantity: Quantity, contact_s: f64) -> f64 {
        let (omega, g) = (self.suspension.omega(), self.scene.gravity_m_s2());
        let ends = Ends::new(&self.scene, self.position);
        let swing = Swing::new(self.suspension.damping().get(), quantity == Quantity::PeakAcceleration);
        let shocks = quantity == Quantity::VelocityShock;
        let (mut motion, mut peak, mut parted) = (Motion::default(), 0.0_f64, 0.0_f64);
        // Strikes whose contacts overlap act as one.
        let (mut together, mut from_s) = (0.0, 0.0);
        // What long contacts did, however it turned since.
        let mut loose = 0.0_f64;
        let strikes = &flight.flight.strikes;
        for ((strike, pulse), next) in strikes.iter().zip(&flight.pulses).zip(&strikes[1..]) {
            together += strike.delta_v_at(self.position);
            parted = parted.max(pulse.until_s);
            if parted >= next.time_s {
                continue;
            }
            let mut rings = 0.0;
            if shocks {
                peak = peak.max(together.abs() / ((parted - from_s) / contact_s).max(1.0).ceil());
            } else {
                let turned = omega * (next.time_s - from_s);
                let turn = swing.turn(turned);
                if parted - from_s > LONG * contact_s {
                    loose += swing.factor * together.abs();
                } else {
                    motion.w -= together;
                }

                if swing.bound(motion) > peak + loose {
                    peak = peak.max(swing.peak(motion, turned).value - loose);
                }
                motion = swing.after(&turn, motion);
                peak = peak.max(swing.quantity(motion).abs() - loose);
                loose *= turn.fade;
                rings = swing.bound(motion) + loose;
            }
            (together, from_s) = (0.0, next.time_s);
            let now = flight.sample(parted);
            let speed = Lane::of(now.height_m, now.velocity_m_s, g).reach(&ends);
            let later = if shocks { later_shock(speed, g, contact_s) } else { later_response(&swing, speed, g, omega) };
            if rings + later < CLEAR * peak {
                return 0.5 * (parted + next.time_s);
            }
        }
        f64::INFINITY
    }
}
