//! The motion of one component over a history of its base.

use crate::suspension::{Modes, Motion, Phase, Suspension};
use crate::{Error, Quantity};

impl Suspension {
    /// Returns the response of a component at each point of a history of its base, with straight lines between the
    /// points (s, acceleration): the quantity with its sign, from rest at the first point on. Two points at one time
    /// are a jump.
    ///
    /// # Accuracy
    /// The response is exact but for rounding: each line is crossed in closed form, as in the spectrum.
    ///
    /// # Examples
    /// Without damping the response to a constant acceleration from rest is z = −(1 − cos ωt) a/ω², so that the
    /// absolute acceleration of the part is 2 a half a period later:
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Quantity, Suspension};
    /// let part = Suspension::from_hz(50.0, DampingRatio::new(0.0)?)?;
    /// let response = part.history(&[(0.0, 30.0), (5e-3, 30.0), (10e-3, 30.0)], Quantity::AbsoluteAcceleration)?;
    /// assert!(response[0] == 0.0 && (response[1] - 30.0).abs() < 1e-12 && (response[2] - 60.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Entry`] for a value that is not finite, [`Error::TimeOrder`] where times run back; [`Error::Stop`] for a
    /// suspension with a stop.
    pub fn history(&self, points: &[(f64, f64)], quantity: Quantity) -> Result<Vec<f64>, Error> {
        const LIST: &str = "the history";
        self.refuse_stop("the response at each point of a history")?;
        let (modes, omega) = (Modes::new(self.damping()), self.omega());
        let (row, factor) = quantity.row(omega);
        let mut motion = Motion { x: 0.0, w: 0.0 };
        let mut response = Vec::with_capacity(points.len());
        let mut last = points.first().copied().unwrap_or_default();
        // Samples that are even in time share one propagator.
        let mut driven = (f64::NAN, modes.driven(Phase::product(omega, 0.0)));
        for (i, &(time, a)) in points.iter().enumerate() {
            for (name, value) in [("time", time), ("acceleration", a)] {
                if !value.is_finite() {
                    return Err(Error::Entry { list: LIST, entry: i + 1, name, value, allowed: "finite" });
                }
            }
            if time < last.0 {
                return Err(Error::TimeOrder { list: LIST, entry: i + 1, time, previous: last.0 });
            }
            let step = time - last.0;
            if step > 0.0 {
                let phase = Phase::product(omega, step);
                if step.to_bits() != driven.0.to_bits() {
                    driven = (step, modes.driven(phase));
                }
                let (free, ramp) = &driven.1;
                // The forcing is −a/ω, and its slope is taken over the phase.
                let [from, slope] = [-last.1 / omega, (last.1 - a) / (omega * phase.hi)];
                let moved = free.apply(modes.p, motion);
                motion = Motion {
                    x: moved.x + from * ramp.x0 + slope * ramp.x1,
                    w: moved.w + from * ramp.w0 + slope * ramp.w1,
                };
            }
            response.push(factor * modes.quantity(row, motion));
            last = (time, a);
        }
        Ok(response)
    }
}

#[cfg(test)]
mod tests {
    use crate::{DampingRatio, Error, Quantity, Suspension};

    /// Integrates z″ + 2ζω z′ + ω² z = −a in steps of 1 µs (classical Runge–Kutta): it shares nothing with the closed
    /// form.
    fn in_small_steps(omega: f64, zeta: f64, points: &[(f64, f64)]) -> Vec<[f64; 2]> {
        let mut z = [0.0, 0.0];
        let mut all = vec![z];
        for pair in points.windows(2) {
            let [(from, a), (to, b)] = [pair[0], pair[1]];
            let count = ((to - from) / 1e-6).ceil().max(1.0);
            let h = (to - from) / count;
            let mut t = 0.0;
            while t < (to - from) - 0.5 * h {
                let rate = |t: f64, z: [f64; 2]| {
                    [z[1], -(a + (b - a) * t / (to - from)) - 2.0 * zeta * omega * z[1] - omega * omega * z[0]]
                };
                let add = |z: [f64; 2], k: [f64; 2], h: f64| [z[0] + h * k[0], z[1] + h * k[1]];
                let k1 = rate(t, z);
                let k2 = rate(t + 0.5 * h, add(z, k1, 0.5 * h));
                let k3 = rate(t + 0.5 * h, add(z, k2, 0.5 * h));
                let k4 = rate(t + h, add(z, k3, h));
                for i in 0..2 {
                    z[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
                }
                t += h;
            }
            all.push(z);
        }
        all
    }

    #[test]
    fn lines_are_crossed_as_in_small_steps_at_any_damping() {
        let points = [(0.0, 0.0), (1e-3, 900.0), (1.7e-3, -300.0), (4e-3, 50.0), (4.001e-3, 0.0), (12e-3, 0.0)];
        for (hz, zeta) in [(40.0, 0.0), (180.0, 0.05), (600.0, 1.0), (200.0, 3.0)] {
            let part = Suspension::from_hz(hz, DampingRatio::new(zeta).expect("a ratio")).expect("a part");
            let omega = part.omega();
            let of = |quantity| part.history(&points, quantity).expect("a history");
            let [z, v, a] =
                [Quantity::RelativeDisplacement, Quantity::RelativeVelocity, Quantity::AbsoluteAcceleration].map(of);
            for (i, [plain_z, plain_v]) in in_small_steps(omega, zeta, &points).into_iter().enumerate() {
                let plain_a = -2.0 * zeta * omega * plain_v - omega * omega * plain_z;
                // The errors are relative to the largest, 900 m/s²: the small steps are good to some 1e-9 of it.
                assert!((z[i] - plain_z).abs() * omega * omega < 1e-6, "{hz} Hz {zeta}, point {i}: {} {plain_z}", z[i]);
                assert!((v[i] - plain_v).abs() * omega < 1e-6, "{hz} Hz {zeta}, point {i}: {} {plain_v}", v[i]);
                assert!(
                    (a[i] - plain_a).abs() < 1e-6 * (1.0 + 2.0 * zeta),
                    "{hz} Hz {zeta}, point {i}: {} {plain_a}",
                    a[i]
                );
            }
        }
    }

    #[test]
    fn what_is_no_history_is_refused() {
        let part = Suspension::from_hz(100.0, DampingRatio::new(0.05).expect("a ratio")).expect("a part");
        let of = |points: &[(f64, f64)]| part.history(points, Quantity::PseudoVelocity);
        assert_eq!(of(&[]), Ok(Vec::new()));
        assert!(matches!(of(&[(0.0, 1.0), (1.0, f64::NAN)]), Err(Error::Entry { entry: 2, .. })));
        assert!(matches!(of(&[(1.0, 1.0), (0.5, 1.0)]), Err(Error::TimeOrder { entry: 2, .. })));
    }
}
