//! What is dropped and how.

use crate::{Error, Restitution};

/// A rigid body that strikes the ground with its two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    arm: [f64; 2],
    gyration: f64,
    thickness: f64,
}

impl Body {
    /// A body with its center of mass in the middle: length from end to end and radius of gyration.
    ///
    /// # Errors
    /// As [`Body::off_center`].
    pub fn new(length_m: f64, gyration_m: f64) -> Result<Self, Error> {
        within("length in m", length_m, 1e-30, 1e30, "in [1e-30, 1e30]")?;
        Self::off_center(0.5 * length_m, 0.5 * length_m, gyration_m)
    }
    /// A body with its center of mass at distances `a_m` and `b_m` from ends a and b.
    ///
    /// A radius of gyration of 0 is legal (q = 1, the ends are massless), so is one beyond the arms (q < 0).
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both arms are in [1e−31, 1e30], the longer at most 10⁶ times the shorter, and the
    /// radius of gyration is 0 or between 10⁻¹² and 10⁶ times the length.
    pub fn off_center(a_m: f64, b_m: f64, gyration_m: f64) -> Result<Self, Error> {
        for (name, arm) in [("arm of end a in m", a_m), ("arm of end b in m", b_m)] {
            within(name, arm, 1e-31, 1e30, "in [1e-31, 1e30]")?;
        }
        within("ratio of the arms", a_m / b_m, 1e-6, 1e6, "in [1e-6, 1e6]")?;
        if gyration_m != 0.0 {
            let length = a_m + b_m;
            let allowed = "0 or between 1e-12 and 1e6 times the length";
            within("radius of gyration in m", gyration_m, 1e-12 * length, 1e6 * length, allowed)?;
        }
        Ok(Self { arm: [a_m, b_m], gyration: gyration_m + 0.0, thickness: 0.0 })
    }
    /// The same body with corners: seen from the side a rectangle, its center of mass on the line midway between the
    /// two long sides. At a tilt it stands on a corner of the lower side, which is half a thickness below that line:
    ///
    /// ```text
    ///            b        height of a corner below the center   σ L sin φ − (t/2) cos φ
    ///      ·  ·  /        its lever arm                         σ L cos φ + (t/2) sin φ
    ///   ·   · · /         (σ = −1 at a, +1 at b)
    ///  a · · ·
    ///  ‾‾‾‾‾‾‾‾‾‾
    /// ```
    ///
    /// So the lever arm of the end that is down is shorter by `(t/2) sin φ`, that of the other end longer. Everywhere
    /// in this module "end a" and "end b" are then these two corners. [`Model::FiniteTilt`](super::Model::FiniteTilt)
    /// knows corners, until the body has turned past its end and comes down on others
    /// ([`Stop::TurnedOver`](super::Stop::TurnedOver)); at small tilt they make no difference.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the thickness is 0 or between 10⁻¹² and 1 times the length.
    ///
    /// ```
    /// use clatter::flight::{Body, Model, Scene};
    /// // Length 2, thickness 1 and radius of gyration 1 at 45°: lever arms −½/√2 and 1½/√2. The free end gets
    /// // (1 + x_a x_b/ρ²)/(1 + x_a²/ρ²) = (1 − 3/8)/(1 + 1/8) = 5/9 of the jump of the struck one.
    /// let body = Body::new(2.0, 1.0)?.with_thickness(1.0)?;
    /// let strike = Scene::new(body, 0.5, 1.0, 45.0, 0.0)?.simulate(Model::FiniteTilt).strikes[0];
    /// assert!((strike.delta_v_m_s[0] - 1.5).abs() < 1e-15);
    /// assert!((strike.delta_v_m_s[1] / strike.delta_v_m_s[0] - 5.0 / 9.0).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn with_thickness(mut self, thickness_m: f64) -> Result<Self, Error> {
        if thickness_m != 0.0 {
            let length = self.length_m();
            let allowed = "0 or between 1e-12 and 1 times the length";
            within("thickness in m", thickness_m, 1e-12 * length, length, allowed)?;
        }
        self.thickness = thickness_m + 0.0;
        Ok(self)
    }
    /// Distances of ends a and b from the center of mass.
    #[must_use]
    pub fn arms_m(&self) -> [f64; 2] {
        self.arm
    }
    /// From end to end.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.arm[0] + self.arm[1]
    }
    /// Radius of gyration about the center of mass.
    #[must_use]
    pub fn gyration_m(&self) -> f64 {
        self.gyration
    }
    /// Thickness, from corner to corner of an end.
    #[must_use]
    pub fn thickness_m(&self) -> f64 {
        self.thickness
    }
    /// Lever arms of the ends with sign, and their heights over the center of mass, at the angle with this sine and
    /// cosine.
    pub(super) fn levers(&self, sin: f64, cos: f64) -> ([f64; 2], [f64; 2]) {
        let ([a, b], d) = (self.arm, 0.5 * self.thickness);
        ([d * sin - a * cos, d * sin + b * cos], [-a * sin - d * cos, b * sin - d * cos])
    }
    /// Distance of end i from the center of mass.
    pub(super) fn radius(&self, i: usize) -> f64 {
        self.arm[i].hypot(0.5 * self.thickness)
    }
    /// Inertia ratios of a level body, `q_a = (L_a L_b − ρ²)/(L_a² + ρ²)` and `q_b` likewise: minus the jump of the
    /// other end over the jump of the striking end.
    #[must_use]
    pub fn inertia_ratios(&self) -> [f64; 2] {
        let [a, b] = self.arm;
        let product = self.product(1.0);
        [product / self.inertia(a), product / self.inertia(b)]
    }
    /// `x_a x_b − ρ²` for lever arms `x = L cos φ`, `cos2` = cos² φ.
    pub(super) fn product(&self, cos2: f64) -> f64 {
        let [a, b] = self.arm;
        if a - b == 0.0 && cos2 - 1.0 == 0.0 {
            (a - self.gyration) * (a + self.gyration)
        } else {
            a * b * cos2 - self.gyration * self.gyration
        }
    }
    /// x² + ρ²: the inertia about a point at lever arm x.
    pub(super) fn inertia(&self, x: f64) -> f64 {
        x * x + self.gyration * self.gyration
    }
}

/// A drop at the moment when end a touches, with the limits of its simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    body: Body,
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

impl Scene {
    /// A body that touches with end a at the given speed and tilt, without spin. The ends' height gap is
    /// `length · sin(tilt)` in every model.
    ///
    /// Limits until set otherwise: no limit of time, 100 000 strikes.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1; [`Error::Quantity`] unless the speed is in [1e−30, 1e30] m/s, the
    /// tilt 0 or in [1e−60°, 90°), and gravity 0 or in [1e−60, 1e30] m/s².
    pub fn new(body: Body, e: f64, speed_m_s: f64, tilt_deg: f64, gravity_m_s2: f64) -> Result<Self, Error> {
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
            gap: body.length_m() * tilt.sin(),
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
    pub fn from_height(body: Body, e: f64, height_m: f64, tilt_deg: f64, gravity_m_s2: f64) -> Result<Self, Error> {
        within("height in m", height_m, 1e-30, 1e30, "in [1e-30, 1e30]")?;
        within("gravity in m/s²", gravity_m_s2, 1e-60, 1e30, "in [1e-60, 1e30] for a drop from a height")?;
        Self::new(body, e, (2.0 * gravity_m_s2 * height_m).sqrt(), tilt_deg, gravity_m_s2)
    }
    /// Already turning at the first touch, end b upward where positive.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the spin is finite and end a still approaches, at small tilt and at the scene's:
    /// above `−v0/L_a` (and, where a thick body's center is beyond end a, below v0 over the lever arm); its end speed
    /// at most 1e30 m/s.
    pub fn with_spin(mut self, spin_rad_s: f64) -> Result<Self, Error> {
        let far = 1e30 / self.body.length_m();
        let (sin, cos) = self.tilt.sin_cos();
        let ([x, _], _) = self.body.levers(sin, cos);
        self.spin = spin_rad_s + 0.0;
        // As it rounds: next to -speed/arm nothing may be left of the approach.
        let approaches = self.level_velocities()[0] <= -SLOWEST && x * spin_rad_s < self.speed;
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
    pub fn body(&self) -> Body {
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
    /// Vertical velocities of the ends at the first touch for these lever arms.
    pub(super) fn end_velocities(&self, levers: [f64; 2]) -> [f64; 2] {
        levers.map(|x| x * self.spin - self.speed)
    }
    /// The same at small tilt.
    pub(super) fn level_velocities(&self) -> [f64; 2] {
        let [a, b] = self.body.arm;
        self.end_velocities([-a, b])
    }
}

/// The slowest approach that a [`Start`](crate::Start) takes.
const SLOWEST: f64 = 1e-150;

fn within(name: &'static str, value: f64, lo: f64, hi: f64, allowed: &'static str) -> Result<(), Error> {
    if (lo..=hi).contains(&value) { Ok(()) } else { Err(Error::Quantity { name, value, allowed }) }
}
