//! A drop at the moment of the first touch.

use clatter::{Error, Restitution};

use crate::Profile;

/// A drop at the moment when end a touches, with the limits of its simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene<const N: usize = 2> {
    body: Profile<N>,
    e: Restitution,
    speed: f64,
    tilt: f64,
    /// Height of end b at the first touch.
    gap: f64,
    gravity: f64,
    spin: f64,
    time_limit: f64,
    impact_limit: usize,
}

impl<const N: usize> Scene<N> {
    /// A body that touches with end a at the given speed and tilt, without spin. The ends' height gap is
    /// `length · sin(tilt)` in every model.
    ///
    /// Limits until set otherwise: no limit of time, 100 000 strikes.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1; [`Error::Quantity`] unless the speed is in [1e−30, 1e30] m/s, the
    /// tilt 0 or in [1e−60°, 90°), and gravity 0 or in [1e−60, 1e30] m/s².
    pub fn new(body: Profile<N>, e: f64, speed_m_s: f64, tilt_deg: f64, gravity_m_s2: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?;
        within("speed in m/s", speed_m_s, 1e-30, 1e30, "in [1e-30, 1e30]")?;
        if tilt_deg != 0.0 && !(1e-60..90.0).contains(&tilt_deg) {
            return Err(Error::Quantity { name: "tilt in degrees", value: tilt_deg, allowed: "0 or in [1e-60, 90)" });
        }
        if gravity_m_s2 != 0.0 {
            within("gravity in m/s²", gravity_m_s2, 1e-60, 1e30, "0 or in [1e-60, 1e30]")?;
        }
        let tilt = tilt_deg.to_radians();
        Ok(Self {
            body,
            e,
            speed: speed_m_s,
            tilt,
            gap: body.length_m() * libm::sin(tilt),
            gravity: gravity_m_s2 + 0.0,
            spin: 0.0,
            time_limit: f64::INFINITY,
            impact_limit: 100_000,
        })
    }
    /// A body let go with its lower end at a height: the speed at the first touch is `√(2 g h)`.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the height is in [1e−30, 1e30] m and gravity is positive; else as [`Scene::new`].
    pub fn from_height(
        body: Profile<N>,
        e: f64,
        height_m: f64,
        tilt_deg: f64,
        gravity_m_s2: f64,
    ) -> Result<Self, Error> {
        within("height in m", height_m, 1e-30, 1e30, "in [1e-30, 1e30]")?;
        within("gravity in m/s²", gravity_m_s2, 1e-60, 1e30, "in [1e-60, 1e30] for a drop from a height")?;
        Self::new(body, e, (2.0 * gravity_m_s2 * height_m).sqrt(), tilt_deg, gravity_m_s2)
    }
    /// Already turning at the first touch, end b upward where positive; end a is the first point.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the spin is finite and end a still approaches, at small tilt and at the scene's:
    /// above `−v0/L_a` (and, where a thick body's center is beyond end a, below v0 over the lever arm); its end speed
    /// at most 1e30 m/s.
    pub fn with_spin(mut self, spin_rad_s: f64) -> Result<Self, Error> {
        let far = 1e30 / self.body.length_m();
        let (sin, cos) = libm::sincos(self.tilt);
        let x = self.body.levers(sin, cos).0[0];
        self.spin = spin_rad_s + 0.0;
        // As it rounds: next to -speed/arm nothing may be left of the approach.
        let [level, _] = self.body.points_m()[0];
        let approaches = level * self.spin - self.speed <= -SLOWEST && x * spin_rad_s < self.speed;
        if !(approaches && spin_rad_s <= far) {
            let allowed = "such that end a approaches (above -speed/arm) and at most 1e30/length";
            return Err(Error::Quantity { name: "spin in rad/s", value: spin_rad_s, allowed });
        }
        Ok(self)
    }
    /// No strike after this time since the first touch.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless positive; infinity is no limit.
    pub fn with_time_limit_s(mut self, time_s: f64) -> Result<Self, Error> {
        if time_s > 0.0 {
            self.time_limit = time_s;
            Ok(self)
        } else {
            Err(Error::Quantity { name: "time limit in s", value: time_s, allowed: "positive" })
        }
    }
    /// No more strikes than this.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless in 1 ..= 10⁸ (a list of 10 GB).
    pub fn with_impact_limit(mut self, impacts: usize) -> Result<Self, Error> {
        if (1..=100_000_000).contains(&impacts) {
            self.impact_limit = impacts;
            Ok(self)
        } else {
            #[expect(clippy::cast_precision_loss, reason = "only shown in a message")]
            Err(Error::Quantity { name: "impact limit", value: impacts as f64, allowed: "in 1 ..= 100000000" })
        }
    }
    /// The body.
    #[must_use]
    pub fn body(&self) -> Profile<N> {
        self.body
    }
    /// Coefficient of restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        self.e.get()
    }
    /// Speed of the center of mass at the first touch, downward.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        self.speed
    }
    /// Tilt at the first touch.
    #[must_use]
    pub fn tilt_rad(&self) -> f64 {
        self.tilt
    }
    /// Acceleration of gravity.
    #[must_use]
    pub fn gravity_m_s2(&self) -> f64 {
        self.gravity
    }
    /// Angular velocity at the first touch, end b upward.
    #[must_use]
    pub fn spin_rad_s(&self) -> f64 {
        self.spin
    }
    /// Height of end b when end a touches, h0.
    #[must_use]
    pub fn height_gap_m(&self) -> f64 {
        self.gap
    }
    /// Limit of time since the first touch.
    #[must_use]
    pub fn time_limit_s(&self) -> f64 {
        self.time_limit
    }
    /// Limit of the number of strikes.
    #[must_use]
    pub fn impact_limit(&self) -> usize {
        self.impact_limit
    }
}

impl Scene<2> {
    /// Vertical velocities of the ends at the first touch for these lever arms.
    pub(crate) fn end_velocities(&self, levers: [f64; 2]) -> [f64; 2] {
        levers.map(|x| x * self.spin - self.speed)
    }
    /// The same at small tilt.
    pub(crate) fn level_velocities(&self) -> [f64; 2] {
        let [a, b] = self.body.arms_m();
        self.end_velocities([-a, b])
    }
}

/// The slowest approach that a [`Start`](clatter::Start) takes.
pub(crate) const SLOWEST: f64 = 1e-150;

pub(crate) fn within(name: &'static str, value: f64, lo: f64, hi: f64, allowed: &'static str) -> Result<(), Error> {
    if (lo..=hi).contains(&value) { Ok(()) } else { Err(Error::Quantity { name, value, allowed }) }
}
