//! A plate that falls almost level on its four corners: by instant impacts, or with contacts that take time.

use clatter::Error as Given;

use crate::Error;
use crate::contact::{Allowed, Contact, Level, Run, alike, check_shortest};
use crate::flight::Log;
use crate::motion::{Ahead, FeetMotion, PlateMotion};
use crate::scene::{SLOWEST, within};

/// A rigid rectangular plate, its center of mass anywhere between the edges.
///
/// Positions x, y are in m from the center of mass. The corners are a (−x, −y), b (+x, −y), c (+x, +y) and d (−x, +y); a is the one
/// that touches first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    edges: [f64; 4],
    gyration: [f64; 2],
    product: f64,
    /// C⁻¹ of the second moments of the mass: of x, of y and of both.
    inverse: [f64; 3],
}

impl Plate {
    /// From the distances of the edges from the center of mass, \[−x, +x, −y, +y\], and the radii of gyration k_x, k_y, of the mass
    /// along x and along y.
    ///
    /// # Errors
    /// [`Error::Quantity`](clatter::Error::Quantity) unless the distances are in [1e−31, 1e30] m and opposite ones at most in the
    /// ratio 10⁶, and each radius of gyration is between 10⁻¹² and 10⁶ times the side along it.
    ///
    /// # Examples
    /// ```
    /// use clatter_flight::Plate;
    /// let side = [0.15, 0.07];
    /// let uniform = Plate::new([0.075, 0.075, 0.035, 0.035], side.map(|l| l / 12_f64.sqrt()))?;
    /// assert_eq!(uniform.sides_m(), side);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn new(edges_m: [f64; 4], gyration_m: [f64; 2]) -> Result<Self, Given> {
        for distance in edges_m {
            within("distance of an edge in m", distance, 1e-31, 1e30, "in [1e-31, 1e30]")?;
        }
        let [left, right, front, back] = edges_m;
        for ratio in [left / right, front / back] {
            within("ratio of the distances of two edges", ratio, 1e-6, 1e6, "in [1e-6, 1e6]")?;
        }
        let plate = Self { edges: edges_m, gyration: gyration_m, product: 0.0, inverse: inverse(gyration_m, 0.0) };
        let names = ["radius of gyration along x in m", "radius of gyration along y in m"];
        for ((name, k), side) in names.into_iter().zip(gyration_m).zip(plate.sides_m()) {
            within(name, k, 1e-12 * side, 1e6 * side, "between 1e-12 and 1e6 times the side along it")?;
        }
        Ok(plate)
    }
    /// The same with mass that is not even about the axes: ∫x y dm/m about the center of mass, 0 unless given.
    ///
    /// # Errors
    /// [`Error::Quantity`](clatter::Error::Quantity) unless it is within 0.99 k_x k_y: at k_x k_y all mass lies on one line.
    pub fn with_product_of_inertia(self, product_m2: f64) -> Result<Self, Given> {
        let [kx, ky] = self.gyration;
        let most = 0.99 * kx * ky;
        within("product of inertia over the mass in m²", product_m2, -most, most, "within 0.99 k_x k_y")?;
        Ok(Self { product: product_m2 + 0.0, inverse: inverse(self.gyration, product_m2), ..self })
    }
    /// ∫x y dm/m about the center of mass.
    #[must_use]
    pub fn product_of_inertia_m2(&self) -> f64 {
        self.product
    }
    /// What a force of 1 over the mass at x, y does to the slopes along x and y: C⁻¹ of the second moments
    /// C = [k_x², ∫xy dm/m; ∫xy dm/m, k_y²].
    pub(crate) fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [xx, yy, xy] = self.inverse;
        [x * xx + y * xy, y * yy + x * xy]
    }
    /// Distances of the edges from the center of mass, \[−x, +x, −y, +y\].
    #[must_use]
    pub fn edges_m(&self) -> [f64; 4] {
        self.edges
    }
    /// Length along x and width along y.
    #[must_use]
    pub fn sides_m(&self) -> [f64; 2] {
        let [left, right, front, back] = self.edges;
        [left + right, front + back]
    }
    /// Radii of gyration k_x and k_y.
    #[must_use]
    pub fn gyration_m(&self) -> [f64; 2] {
        self.gyration
    }
    /// Corners a, b, c and d, from the center of mass.
    #[must_use]
    pub fn corners_m(&self) -> [[f64; 2]; 4] {
        let [left, right, front, back] = self.edges;
        [[-left, -front], [right, -front], [right, back], [-left, back]]
    }
    /// The line of percussion of a corner, 0 to 3 for a to d, from edge to edge in m from the center of mass: no strike of the corner
    /// changes the velocity of the places on it. None where it passes beside the plate.
    ///
    /// # Panics
    /// Beyond the fourth corner.
    ///
    /// # Examples
    /// Where 1 + x x_a/k_x² + y y_a/k_y² = 0, of a uniform plate 1 − 50 x − 100 y in meters:
    /// ```
    /// use clatter_flight::Plate;
    /// let plate = Plate::new([0.06, 0.06, 0.03, 0.03], [0.12, 0.06].map(|side| side / 12_f64.sqrt()))?;
    /// let ends = plate.percussion(0).unwrap();
    /// let expected = [[0.06, -0.02], [-0.04, 0.03]];
    /// assert!(ends.iter().flatten().zip(expected.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-15), "{ends:?}");
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn percussion(&self, corner: usize) -> Option<[[f64; 2]; 2]> {
        let corners = self.corners_m();
        let [along, across] = self.turned(corners[corner]);
        let felt = corners.map(|[x, y]| 1.0 + x * along + y * across);
        let cut = |k: usize| {
            let (one, next) = (k, (k + 1) % 4);
            let share = felt[one] / (felt[one] - felt[next]);
            let at = |i: usize| corners[one][i] + share * (corners[next][i] - corners[one][i]);
            ((felt[one] < 0.0) != (felt[next] < 0.0)).then(|| [at(0), at(1)])
        };
        let mut cuts = (0..4).filter_map(cut);
        cuts.next().zip(cuts.next()).map(<[_; 2]>::from)
    }
    /// Where a place in half-sides from the middle is, as positions of [`clatter::Plate`] are: in m from the center of mass.
    #[must_use]
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, right, front, back] = self.edges;
        [0.5 * ((1.0 + x) * right - (1.0 - x) * left), 0.5 * ((1.0 + y) * back - (1.0 - y) * front)]
    }
}

/// C⁻¹ of the second moments of a mass with these radii of gyration and product of inertia.
fn inverse(gyration: [f64; 2], product: f64) -> [f64; 3] {
    let [xx, yy] = gyration.map(|k| k * k);
    let left = 1.0 - product / xx * product / yy;
    [1.0 / (xx * left), 1.0 / (yy * left), -product / xx / yy / left + 0.0]
}

/// A drop of a plate at the moment when corner a touches.
///
/// # Validity
/// Small tilt: lever arms are those of a level plate. Hard, level ground without friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateScene {
    plate: Plate,
    speed: f64,
    gaps: [f64; 2],
    spin: [f64; 2],
    gravity: f64,
    thickness: f64,
    time_limit: f64,
    impact_limit: usize,
}

impl PlateScene {
    /// A plate that comes down at this speed without turning, with corner b and d so high as a touches; c is as high as both together.
    ///
    /// No limit of time until set otherwise, and 100 000 strikes.
    ///
    /// # Errors
    /// [`Error::Quantity`](clatter::Error::Quantity) unless the speed is in [1e−30, 1e30] m/s, gaps are 0 or more and at most the side
    /// along which they open, and gravity is 0 or in [1e−60, 1e30] m/s².
    pub fn new(plate: Plate, speed_m_s: f64, gaps_m: [f64; 2], gravity_m_s2: f64) -> Result<Self, Given> {
        within("speed in m/s", speed_m_s, 1e-30, 1e30, "in [1e-30, 1e30]")?;
        for ((name, gap), side) in
            ["height of corner b in m", "height of corner d in m"].into_iter().zip(gaps_m).zip(plate.sides_m())
        {
            within(name, gap, 0.0, side, "from 0 to the side along which it rises")?;
        }
        if gravity_m_s2 != 0.0 {
            within("gravity in m/s²", gravity_m_s2, 1e-60, 1e30, "0 or in [1e-60, 1e30]")?;
        }
        Ok(Self {
            plate,
            speed: speed_m_s,
            gaps: gaps_m.map(|gap| gap + 0.0),
            spin: [0.0; 2],
            gravity: gravity_m_s2 + 0.0,
            thickness: 0.0,
            time_limit: f64::INFINITY,
            impact_limit: 100_000,
        })
    }
    /// Already turning at the first touch: rates of the slopes along x and along y, corner b and corner d upward where positive.
    ///
    /// # Errors
    /// [`Error::Quantity`](clatter::Error::Quantity) unless both are finite, corner a still approaches, and no corner is faster than
    /// 1e30 m/s.
    pub fn with_spin(mut self, spin_rad_s: [f64; 2]) -> Result<Self, Given> {
        self.spin = spin_rad_s.map(|spin| spin + 0.0);
        let velocities = self.corner_velocities();
        // As it rounds: where all of the speed is turned away nothing may be left of the approach.
        if !(velocities[0] <= -SLOWEST && velocities.iter().all(|v| v.abs() <= 1e30)) {
            let [x, y] = spin_rad_s;
            let value = if x < y || x.is_nan() { x } else { y };
            let allowed = "such that corner a approaches, and no corner is faster than 1e30 m/s";
            return Err(Given::Quantity { name: "spin in rad/s", value, allowed });
        }
        Ok(self)
    }
    /// So thick, by which corners may sink in; else that is not known.
    pub(crate) fn with_thickness(self, thickness_m: f64) -> Self {
        Self { thickness: thickness_m, ..self }
    }
    /// Vertical velocities of the corners at the first touch.
    #[must_use]
    pub fn corner_velocities(&self) -> [f64; 4] {
        self.plate.corners_m().map(|[x, y]| x * self.spin[0] + y * self.spin[1] - self.speed)
    }
    /// Rates of the slopes along x and along y at the first touch.
    #[must_use]
    pub fn spin_rad_s(&self) -> [f64; 2] {
        self.spin
    }
    /// No strike after this time since the first touch.
    ///
    /// # Errors
    /// [`Error::Quantity`](clatter::Error::Quantity) unless positive; infinity is no limit.
    pub fn with_time_limit_s(mut self, time_s: f64) -> Result<Self, Given> {
        if time_s > 0.0 {
            self.time_limit = time_s;
            Ok(self)
        } else {
            Err(Given::Quantity { name: "time limit in s", value: time_s, allowed: "positive" })
        }
    }
    /// No more strikes than this.
    #[must_use]
    pub fn with_impact_limit(mut self, impacts: usize) -> Self {
        self.impact_limit = impacts;
        self
    }
    /// The plate.
    #[must_use]
    pub fn plate(&self) -> Plate {
        self.plate
    }
    /// Speed of the center of mass at the first touch, downward.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        self.speed
    }
    /// Heights of corners b and d when a touches.
    #[must_use]
    pub fn gaps_m(&self) -> [f64; 2] {
        self.gaps
    }
    /// Acceleration of gravity.
    #[must_use]
    pub fn gravity_m_s2(&self) -> f64 {
        self.gravity
    }
    /// No strike is after this time; infinite where there is no limit.
    #[must_use]
    pub fn time_limit_s(&self) -> f64 {
        self.time_limit
    }
    /// Strikes followed at most.
    #[must_use]
    pub fn impact_limit(&self) -> usize {
        self.impact_limit
    }

    /// The motion with contacts that take time to a precision, as far as it is needed: as
    /// [`Scene::contacts_until`](crate::Scene::contacts_until).
    ///
    /// # Accuracy
    /// Lever arms do not change, so that a phase is exact; what is slower than `precision` is laid down.
    ///
    /// # Errors
    /// [`Error::Given`] unless the precision is in [1e−8, 0.1]; [`Error::Bound`] unless each radius of gyration is at least 0.05 of the
    /// side along it, and the contact time is so short that no corner sinks in by more than half of the longer side, or than the
    /// thickness if that is more, at most 0.1 √(longer side/gravity), and at least 1e−10 of the longer side over the speed; [`Error::Energy`] where the motion does not keep its energy.
    ///
    /// # Examples
    /// A plate that lands flat is pressed at all corners along one half-sine, and rises with the restitution.
    /// ```
    /// use clatter_flight::{Contact, ContactLaw, Plate, PlateScene};
    /// let scene = PlateScene::new(Plate::new([0.07, 0.07, 0.035, 0.035], [0.04, 0.02])?, 2.0, [0.0; 2], 0.0)?;
    /// let motion = scene.contacts_until(&Contact::new(ContactLaw::Hysteretic, 0.5, 1e-3)?, 1e-4, |_| false)?;
    /// assert_eq!(motion.strikes.len(), 4);
    /// assert!(motion.strikes.iter().all(|strike| (strike.velocity_m_s[0] - 1.0).abs() < 1e-12));
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    pub fn contacts_until(
        &self,
        contact: &Contact,
        precision: f64,
        enough: impl FnMut(&Ahead<4>) -> bool,
    ) -> Result<PlateMotion, Error> {
        self.own_contacts_until(&[*contact; 4], precision, enough)
    }

    /// The same with a contact of its own at each corner, a to d.
    ///
    /// # Errors
    /// As [`contacts_until`](Self::contacts_until), by each of the contacts; [`Error::Laws`] unless all are hysteretic, where they differ.
    pub fn own_contacts_until(
        &self,
        contacts: &[Contact; 4],
        precision: f64,
        mut enough: impl FnMut(&Ahead<4>) -> bool,
    ) -> Result<PlateMotion, Error> {
        within("precision", precision, 1e-8, 0.1, "in [1e-8, 0.1]")?;
        alike(contacts)?;
        contacts.iter().try_for_each(|contact| self.check(contact))?;
        self.allowed().followed(contacts, |contacts, deepest_m| {
            let log = Log::new(self.time_limit, self.impact_limit);
            Run::new(Level::start(self), log, contacts, precision, deepest_m).run(&mut enough)
        })
    }

    /// The same of a plate whose corners are feet: the bottom over them, so high, reaches so far beyond them along x and along y. Its four
    /// corners are points 4 to 7 of the motion, over a to d, with contacts of their own.
    ///
    /// # Errors
    /// [`Error::Given`] unless height and distances are in [0, 1e30] m, not all of them 0; else as
    /// [`own_contacts_until`](Self::own_contacts_until).
    ///
    /// # Examples
    /// Tilted across its width, a plate lands on feet a and b; the edge beyond them, 0.1 mm higher then, comes down as they sink in.
    /// ```
    /// use clatter_flight::{Contact, ContactLaw, Plate, PlateScene};
    /// let scene = PlateScene::new(Plate::new([0.07, 0.07, 0.02, 0.02], [0.04, 0.02])?, 2.0, [0.0, 0.01], 0.0)?;
    /// let contacts = [Contact::new(ContactLaw::Hysteretic, 0.5, 3e-4)?; 8];
    /// let motion = scene.on_feet_until([0.0, 0.02], 5.1e-3, &contacts, 1e-4, |_| false)?;
    /// assert_eq!([0, 1, 2, 3].map(|k| motion.strikes[k].point), [0, 1, 4, 5]);
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    pub fn on_feet_until(
        &self,
        beyond_m: [f64; 2],
        height_m: f64,
        contacts: &[Contact; 8],
        precision: f64,
        mut enough: impl FnMut(&Ahead<8>) -> bool,
    ) -> Result<FeetMotion, Error> {
        within("precision", precision, 1e-8, 0.1, "in [1e-8, 0.1]")?;
        let [x, y] = beyond_m;
        for (name, value) in [("height over the feet in m", height_m), ("distance beyond the feet in m", x.min(y))] {
            within(name, value, 0.0, 1e30, "in [0, 1e30]")?;
        }
        within("height and distance from the feet in m", height_m + x + y, SLOWEST, 1e30, "not 0, and up to 1e30")?;
        alike(contacts)?;
        contacts.iter().try_for_each(|contact| self.check(contact))?;
        let feet = self.plate.corners_m();
        let edges = feet.map(|[a, b]| [a + x.copysign(a), b + y.copysign(b)]);
        let points = std::array::from_fn(|i| if i < 4 { feet[i] } else { edges[i - 4] });
        let over = std::array::from_fn(|i| if i < 4 { 0.0 } else { height_m });
        self.allowed().followed(contacts, |contacts, deepest_m| {
            let log = Log::new(self.time_limit, self.impact_limit);
            Run::new(Level::on(self, points, over), log, contacts, precision, deepest_m).run(&mut enough)
        })
    }

    fn check(&self, contact: &Contact) -> Result<(), Error> {
        // What is told as the bound is allowed.
        let beyond = 1.0 + 1e-12;
        let sides = self.plate.sides_m();
        for (value, side) in self.plate.gyration.into_iter().zip(sides) {
            if value * beyond < 0.05 * side {
                let (name, bound) = ("radius of gyration", 0.05 * side);
                let reason = "0.05 of the side along it for contacts that take time";
                return Err(Error::Bound { name, value, bound, most: false, unit: "m", reason });
            }
        }
        let reason = "1e-10 longer side/speed, so that the corners sink in at all";
        check_shortest(contact.time_s(), 1e-10 * sides[0].max(sides[1]) / self.speed, reason)
    }

    /// Returns how deep corners may sink in.
    fn allowed(&self) -> Allowed {
        let [length, width] = self.plate.sides_m();
        let reasons = [
            "so that corners sink in by half of the longer side at most",
            "so that corners sink in by the thickness at most",
            "a tenth of sqrt(longer side/gravity), so that the corners sink in little by the weight alone",
        ];
        Allowed::new(length.max(width), self.thickness, self.gravity, reasons)
    }
}
