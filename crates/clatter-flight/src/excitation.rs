//! What a place of the body feels: velocity shocks, and accelerations that are straight lines and sinusoids in time.
//!
//! A part that falls with the body and is then carried by it feels the acceleration of its place above free fall,
//! `a + g`. Of impacts that take no time that is a velocity shock at each strike; at real tilt also what the turning of
//! the body does to the height of the place between them, `−ω² × height over the center of mass`. Of contacts it is a sum of
//! the modes of each phase.

use crate::flight::{Flight, Model};
use crate::scene::Scene;

/// A sinusoid, `amplitude · sin(phase + rate t)` from the begin of its stretch on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wave {
    /// With its sign.
    pub amplitude_m_s2: f64,
    /// Positive.
    pub rate_rad_s: f64,
    /// At the begin of the stretch.
    pub phase_rad: f64,
}

/// A time in which the acceleration of a place is one sum of known functions; the next one begins where it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch<const N: usize = 2> {
    /// When it begins, since the first touch.
    pub from_s: f64,
    /// How long it lasts.
    pub length_s: f64,
    /// Velocity shock as it begins.
    pub delta_v_m_s: f64,
    /// Acceleration above free fall at its begin and end, on a straight line between, besides the waves.
    pub acceleration_m_s2: [f64; 2],
    /// Sinusoids besides; those that are not there have amplitude 0.
    pub waves: [Wave; N],
    /// Whether nothing presses all along it: what is felt then is the turning of the body alone, and no shock.
    pub free: bool,
}

/// Turn of a free flight, in rad, from which on a body tumbles: a part turns with it, so that what turning does to the height
/// of its place is nothing that it feels along its axis.
const TUMBLES: f64 = 0.5 * std::f64::consts::PI;

impl<const N: usize> Stretch<N> {
    /// Nothing but a velocity shock.
    pub(crate) fn shock(from_s: f64, length_s: f64, delta_v_m_s: f64) -> Self {
        Self { from_s, length_s, delta_v_m_s, acceleration_m_s2: [0.0; 2], waves: [Wave::default(); N], free: false }
    }
    /// What turning at a spin does in free flight to a place at x, z on the body, from this tilt on: nothing where the body
    /// [tumbles](TUMBLES). Returns what it changes the velocity by in either case.
    pub(crate) fn turning(&mut self, [x, z]: [f64; 2], tilt: f64, spin: f64) -> f64 {
        // −ω² (x sin φ + z cos φ) = −ω² r sin(φ + ψ)
        let (square, phase) = (spin * spin, tilt + z.atan2(x));
        let side = if spin < 0.0 { -1.0 } else { 1.0 };
        self.waves[0] =
            Wave { amplitude_m_s2: -side * square * x.hypot(z), rate_rad_s: spin.abs(), phase_rad: side * phase };
        let change = self.velocity_after(self.length_s) - self.delta_v_m_s;
        if spin.abs() * self.length_s > TUMBLES {
            self.waves[0] = Wave::default();
        }
        change
    }
    /// Acceleration above free fall at a time after its begin.
    #[must_use]
    pub fn acceleration_at(&self, t: f64) -> f64 {
        let [a, b] = self.acceleration_m_s2;
        let waves = self.waves.iter().filter(|w| w.amplitude_m_s2 != 0.0);
        let share = if self.length_s > 0.0 { t / self.length_s } else { 0.0 };
        a + (b - a) * share + waves.map(|w| w.amplitude_m_s2 * (w.phase_rad + w.rate_rad_s * t).sin()).sum::<f64>()
    }
    /// Change of velocity above free fall from its begin, shock included, until a time after it.
    #[must_use]
    pub fn velocity_after(&self, t: f64) -> f64 {
        let [a, b] = self.acceleration_m_s2;
        let share = if self.length_s > 0.0 { t / self.length_s } else { 0.0 };
        let one = |w: &Wave| {
            // cos ψ − cos(ψ + νt) without cancellation.
            let half = 0.5 * w.rate_rad_s * t;
            let over_rate = if w.rate_rad_s > 0.0 { half.sin() / w.rate_rad_s } else { 0.5 * t };
            w.amplitude_m_s2 * 2.0 * over_rate * (w.phase_rad + half).sin()
        };
        let waves = self.waves.iter().filter(|w| w.amplitude_m_s2 != 0.0).map(one).sum::<f64>();
        self.delta_v_m_s + t * (a + 0.5 * (b - a) * share) + waves
    }
}

impl Scene<2> {
    /// What position `s` in [−1, 1] of a bar (−1 is end a) feels in a flight of instant impacts by this model.
    ///
    /// # Accuracy
    /// Exact for strikes and free flight. While the bar turns about an end that lies, the mean acceleration. Where it turns by more
    /// than a right angle in one flight, nothing is felt of that turn: the axis of a part has turned with it.
    ///
    /// # Examples
    /// ```
    /// use clatter_flight::{Body, Model, Scene};
    /// let scene = Scene::new(Body::new(0.14, 0.04)?, 0.3, 4.43, 5.0, 9.81)?;
    /// let flight = scene.simulate(Model::FiniteTilt);
    /// let felt = scene.felt(Model::FiniteTilt, &flight, 0.5);
    /// assert_eq!(felt[0].delta_v_m_s, flight.strikes[0].delta_v_at(0.5));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn felt(&self, model: Model, flight: &Flight, s: f64) -> Vec<Stretch> {
        let g = if model == Model::Map { 0.0 } else { self.gravity_m_s2() };
        let place = self.body().place(s);
        let at = |[a, b]: [f64; 2]| 0.5 * ((1.0 - s) * a + (1.0 + s) * b);
        let end_s = flight.stop.time_s();
        let mut felt = Vec::with_capacity(flight.strikes.len());
        for (k, strike) in flight.strikes.iter().enumerate() {
            let next = flight.strikes.get(k + 1);
            let until = next.map_or(end_s, |next| next.time_s).max(strike.time_s);
            let mut stretch = Stretch::shock(strike.time_s, until - strike.time_s, strike.delta_v_at(s));
            if model == Model::FiniteTilt && next.is_some() {
                stretch.turning(place, strike.tilt_rad, strike.spin_rad_s);
            }
            let first = flight.pivots.partition_point(|p| p.from_s < strike.time_s);
            let pivots = flight.pivots[first..].iter().take_while(|p| p.from_s < until);
            let mut velocity = at(strike.velocity_m_s);
            for pivot in pivots {
                let other = |v: f64| at(if pivot.point == 0 { [0.0, v] } else { [v, 0.0] });
                let flown = pivot.from_s - stretch.from_s;
                stretch.length_s = flown;
                velocity += stretch.velocity_after(flown) - stretch.delta_v_m_s - g * flown;
                felt.push(stretch);
                let whole = pivot.until_s - pivot.from_s;
                let begin = other(pivot.velocity_m_s);
                let end = match (pivot.lift_off, next) {
                    (Some(off), _) => other(off.velocity_m_s),
                    (None, Some(next)) => other(next.approach_m_s),
                    (None, None) => begin,
                };
                let mean = if whole > 0.0 { (end - begin) / whole + g } else { 0.0 };
                let shock = Stretch::shock(pivot.from_s, whole, begin - velocity);
                felt.push(Stretch { acceleration_m_s2: [mean; 2], ..shock });
                velocity = end;
                stretch = Stretch::shock(pivot.until_s, until - pivot.until_s, 0.0);
                if let (Model::FiniteTilt, Some(off)) = (model, pivot.lift_off) {
                    stretch.turning(place, off.tilt_rad, off.spin_rad_s);
                }
            }
            felt.push(stretch);
        }
        felt
    }
}
