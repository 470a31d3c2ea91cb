//! A box with its contacts: forces at its corners, and the accelerations by them.

use super::{Block, times};

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// Numbers of a state without friction: height and vertical velocity of the center of mass, vertical, spin.
pub(super) const SMOOTH: usize = 8;
/// With friction, behind them: the velocity along both axes of the ground, the first of these axes in axes of the box, and the stretch of
/// each corner along both.
pub(super) const ROUGH: usize = 29;
const STRETCHES: usize = 13;

/// Stiffness of a contact along the ground over the one across it, of two spheres: 2 (1 − ν)/(2 − ν), for Poisson's ratio ν = 0.3 (Mindlin 1949).
const MINDLIN: f64 = 0.8;
/// The direction of a slipping stretch turns towards that of the velocity at most so fast, over the frequency of the contact. It does so within
/// a way of μ F/(κ k), which is too short to be followed in steps that the force needs where F or μ is small: there the force is small too.
const TURNS: f64 = 10.0;

/// State of the contact of a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hold {
    Up,
    Loads,
    /// Unloading from the largest depth.
    Unloads(f64),
    /// Contact of a dashpot that would pull.
    Slack,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) hold: Hold,
    /// Height of the ground of this corner: 0, or the bottom of its dent.
    pub(super) ground: f64,
    /// Stiffness of loading over the mass, and the angular frequency of the contact.
    pub(super) stiffness: f64,
    pub(super) frequency: f64,
    /// True while it slips along the ground, false while it sticks.
    pub(super) slips: bool,
    /// Index of its press, from 0.
    pub(super) strike: usize,
}

impl Corner {
    /// Returns whether the ground presses on it.
    pub(super) fn bears(&self) -> bool {
        !matches!(self.hold, Hold::Up | Hold::Slack)
    }
}

/// A box with its contacts.
#[derive(Debug, Clone, Copy)]
pub(super) struct System {
    pub(super) corners: [[f64; 3]; 8],
    /// The box.
    pub(super) block: Block,
    pub(super) gravity: f64,
    /// Coefficient of friction; 0 in states of [`SMOOTH`] numbers.
    pub(super) friction: f64,
    /// How deep corners sink in, about.
    pub(super) depth: f64,
    /// θ of dashpots, and e² of the hysteretic contact of each corner.
    pub(super) delay: f64,
    pub(super) loss: [f64; 8],
    pub(super) holds: [Corner; 8],
}

/// Moment of a force of 1 on each corner, and the angular acceleration by it.
pub(super) struct Turns {
    pub(super) arms: [[f64; 3]; 8],
    turned: [[f64; 3]; 8],
}

impl Turns {
    /// Returns the acceleration of one corner by a force of 1 over the mass on another.
    pub(super) fn coupling(&self, i: usize, j: usize) -> f64 {
        1.0 + dot(self.arms[i], self.turned[j])
    }
}

/// Forces of the ground over the mass, upward and along both axes of the ground, and their moment about the center of mass.
pub(super) struct Load {
    pub(super) up: f64,
    along: [f64; 2],
    pub(super) moment: [f64; 3],
}

impl Load {
    /// Returns the force in axes of the box.
    pub(super) fn force<const N: usize>(&self, y: &[f64; N]) -> [f64; 3] {
        let upward = parts(y).2.map(|n| self.up * n);
        if N == SMOOTH {
            return upward;
        }
        let along = in_box(y, self.along);
        std::array::from_fn(|axis| upward[axis] + along[axis])
    }
}

/// Friction at a corner.
pub(super) struct Grip {
    /// Its force over the mass, along both axes of the ground.
    pub(super) force: [f64; 2],
    /// The velocity of the corner along them.
    pub(super) slides: [f64; 2],
    /// The rate of the stretch along them; of a corner that slips, of its direction.
    pub(super) stretches: [f64; 2],
    /// The length of the stretch, that at which it slips, and the velocity of the corner along it.
    stretch: f64,
    limit: f64,
    along: f64,
}

pub(super) fn parts<const N: usize>(y: &[f64; N]) -> (f64, f64, [f64; 3], [f64; 3]) {
    (y[0], y[1], [y[2], y[3], y[4]], [y[5], y[6], y[7]])
}

/// Returns both axes of the ground in axes of the box, of a state with friction.
pub(super) fn ground<const N: usize>(y: &[f64; N]) -> [[f64; 3]; 2] {
    let along = [y[10], y[11], y[12]];
    [along, cross(parts(y).2, along)]
}

/// Returns the stretch of a corner, of a state with friction; of one that slips its direction, as long as [`System::depth`].
pub(super) fn stretch<const N: usize>(y: &[f64; N], corner: usize) -> [f64; 2] {
    [y[STRETCHES + 2 * corner], y[STRETCHES + 2 * corner + 1]]
}

pub(super) fn set_stretch<const N: usize>(y: &mut [f64; N], corner: usize, [a, b]: [f64; 2]) {
    (y[STRETCHES + 2 * corner], y[STRETCHES + 2 * corner + 1]) = (a, b);
}

impl System {
    /// Returns the height and vertical velocity of a place from the center of mass.
    #[inline]
    pub(super) fn place<const N: usize>(y: &[f64; N], place: [f64; 3]) -> (f64, f64) {
        let (z, v, n, spin) = parts(y);
        (z + dot(n, place), v + dot(n, cross(spin, place)))
    }
    pub(super) fn force<const N: usize>(&self, corner: usize, y: &[f64; N]) -> f64 {
        if self.holds[corner].bears() { self.press(corner, Self::place(y, self.corners[corner])) } else { 0.0 }
    }
    #[inline]
    pub(super) fn press(&self, corner: usize, (height, velocity): (f64, f64)) -> f64 {
        let (Corner { hold, ground, stiffness, .. }, loss) = (self.holds[corner], self.loss[corner]);
        let depth = ground - height;
        match hold {
            Hold::Unloads(deepest) => stiffness / loss * (depth - deepest * (1.0 - loss)),
            _ => stiffness * (depth - self.delay * velocity),
        }
    }
    /// Returns the stretch at which a corner slips over its force.
    fn slip(&self, corner: usize) -> f64 {
        self.friction / (MINDLIN * self.holds[corner].stiffness)
    }
    /// Returns whether a corner that touches slips at once, at these velocities along the ground and down.
    pub(super) fn slips_at_once(&self, slides: [f64; 2], approach: f64) -> bool {
        // Dashpots press with a force from the start.
        self.delay == 0.0 && MINDLIN * length(slides) > self.friction * approach.abs()
    }
    /// Returns the velocity of a place along both axes of the ground.
    pub(super) fn slides<const N: usize>(y: &[f64; N], place: [f64; 3]) -> [f64; 2] {
        let moved = cross(parts(y).3, place);
        let [along, across] = ground(y);
        [y[8] + dot(along, moved), y[9] + dot(across, moved)]
    }
    /// Returns the friction of a corner that is pressed with a force, of a state with friction.
    ///
    /// It is −κ k s of a stretch s from the touch on, ds/dt = u, the velocity along the ground, up to μ F; from there s stays on the circle
    /// of r = μ F/(κ k), of what would take it outside without the part outward: its direction turns towards that of u by u/r.
    pub(super) fn grip<const N: usize>(&self, corner: usize, y: &[f64; N], force: f64) -> Grip {
        let (slides, stretch) = (Self::slides(y, self.corners[corner]), stretch(y, corner));
        let Corner { stiffness, frequency, slips, .. } = self.holds[corner];
        let (size, limit) = (length(stretch), self.slip(corner) * force.max(0.0));
        let towards = if size > 0.0 { stretch.map(|s| s / size) } else { [0.0; 2] };
        let along = slides[0] * towards[0] + slides[1] * towards[1];
        let stretches = if slips {
            let radius = limit.max(length(slides) / (TURNS * frequency)).max(f64::MIN_POSITIVE);
            [0, 1].map(|k| self.depth / radius * (slides[k] - along * towards[k]))
        } else {
            slides
        };
        let stretch = if slips { limit } else { size };
        Grip {
            force: towards.map(|part| -MINDLIN * stiffness * stretch * part),
            slides,
            stretches,
            stretch,
            limit,
            along,
        }
    }
    /// Returns how fast the force on a corner grows.
    fn grows<const N: usize>(&self, corner: usize, y: &[f64; N]) -> f64 {
        let Corner { hold, stiffness, .. } = self.holds[corner];
        let (_, velocity) = Self::place(y, self.corners[corner]);
        match hold {
            Hold::Unloads(_) => -stiffness / self.loss[corner] * velocity,
            _ if self.delay == 0.0 => -stiffness * velocity,
            _ => {
                let ((_, _, n, spin), (_, rises, _, spun)) = (parts(y), parts(&self.slope(y)));
                let around = cross(spin, cross(spin, self.corners[corner]));
                let turned = cross(spun, self.corners[corner]);
                let acceleration = rises + dot(n, [0, 1, 2].map(|k| around[k] + turned[k]));
                -stiffness * (velocity + self.delay * acceleration)
            }
        }
    }
    /// Returns whether the ground presses on a corner.
    pub(super) fn presses(&self) -> bool {
        self.holds.iter().any(Corner::bears)
    }
    /// Returns the force over the mass, and moment over the mass.
    pub(super) fn load<const N: usize>(&self, y: &[f64; N]) -> Load {
        self.loaded(y, |_, _| ())
    }
    /// Returns the same; `each` is called with the friction of every corner that bears.
    #[inline]
    fn loaded<const N: usize>(&self, y: &[f64; N], mut each: impl FnMut(usize, &Grip)) -> Load {
        let (_, _, n, _) = parts(y);
        let mut load = Load { up: 0.0, along: [0.0; 2], moment: [0.0; 3] };
        for (i, corner) in self.corners.iter().enumerate().filter(|(i, _)| self.holds[*i].bears()) {
            let own = self.press(i, Self::place(y, *corner));
            if own != 0.0 {
                let arm = cross(*corner, n);
                load.up += own;
                (0..3).for_each(|axis| load.moment[axis] += own * arm[axis]);
            }
            if N == ROUGH {
                let grip = self.grip(i, y, own);
                let moment = cross(*corner, in_box(y, grip.force));
                each(i, &grip);
                (0..2).for_each(|axis| load.along[axis] += grip.force[axis]);
                (0..3).for_each(|axis| load.moment[axis] += moment[axis]);
            }
        }
        load
    }
    /// Returns the angular acceleration.
    pub(super) fn turning(&self, spin: [f64; 3], moment: [f64; 3]) -> [f64; 3] {
        let gyration = cross(spin, times(&self.block.inertia, spin));
        times(&self.block.inverse, std::array::from_fn(|axis| moment[axis] - gyration[axis]))
    }
    pub(super) fn slope<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let (_, v, n, spin) = parts(y);
        let mut slope = [0.0; N];
        let Load { up, along, moment } = self.loaded(y, |i, grip| set_stretch(&mut slope, i, grip.stretches));
        let (turn, spun) = (cross(n, spin), self.turning(spin, moment));
        let smooth = [v, up - self.gravity, turn[0], turn[1], turn[2], spun[0], spun[1], spun[2]];
        slope[..SMOOTH].copy_from_slice(&smooth);
        if N == ROUGH {
            slope[8..10].copy_from_slice(&along);
            slope[10..13].copy_from_slice(&cross(ground(y)[0], spin));
        }
        slope
    }
    /// Returns the effect of a vertical force on each corner on the rotation of the box.
    pub(super) fn turns(&self, n: [f64; 3]) -> Turns {
        let arms = self.corners.map(|corner| cross(corner, n));
        Turns { arms, turned: arms.map(|arm| times(&self.block.inverse, arm)) }
    }
    /// Returns the height at which a corner parts from the ground, from its present depth.
    pub(super) fn dent<const N: usize>(&self, i: usize, y: &[f64; N]) -> f64 {
        let Corner { hold, ground, .. } = self.holds[i];
        let deepest = match hold {
            Hold::Up | Hold::Slack => 0.0,
            Hold::Loads => (ground - Self::place(y, self.corners[i]).0).max(0.0),
            Hold::Unloads(deepest) => deepest,
        };
        ground - deepest * (1.0 - self.loss[i])
    }
    /// Returns the kinetic and potential energy over the mass.
    pub(super) fn energy<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let (z, v, _, spin) = parts(y);
        let along = if N == ROUGH { y[8] * y[8] + y[9] * y[9] } else { 0.0 };
        0.5 * (v * v + along + dot(spin, times(&self.block.inertia, spin))) + self.gravity * z
    }
    /// Returns the energy that pressed corners may give back, over the mass.
    pub(super) fn stored<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let one = |i: usize| {
            let Corner { hold, ground, stiffness, .. } = self.holds[i];
            let (depth, loss) = (ground - Self::place(y, self.corners[i]).0, self.loss[i]);
            match hold {
                Hold::Up | Hold::Slack => 0.0,
                Hold::Loads => 0.5 * loss * stiffness * depth * depth,
                Hold::Unloads(deepest) => 0.5 * stiffness / loss * (depth - deepest * (1.0 - loss)).powi(2),
            }
        };
        let stretched = |i: usize| {
            let stretch = self.grip(i, y, self.force(i, y)).stretch;
            0.5 * MINDLIN * self.holds[i].stiffness * stretch * stretch
        };
        let bears = (0..8).filter(|i| N == ROUGH && self.holds[*i].bears());
        let of_friction = bears.map(stretched).sum::<f64>();
        (0..8).map(one).sum::<f64>() + of_friction
    }
    /// Returns whether a corner is up all along a step from y within which the numbers change by `reach` at most, with
    /// a margin for roundings.
    pub(super) fn stays_up<const N: usize>(&self, i: usize, y: &[f64; N], reach: &[f64; N]) -> bool {
        let (Corner { hold, ground, .. }, corner) = (self.holds[i], self.corners[i]);
        let falls = reach[0] + dot([reach[2], reach[3], reach[4]], corner.map(f64::abs));
        hold == Hold::Up && ground == 0.0 && y[0] + dot([y[2], y[3], y[4]], corner) > falls * (1.0 + 1e-6)
    }
    /// Returns whether a corner has come to its next event.
    pub(super) fn has_happened<const N: usize>(&self, i: usize, y: &[f64; N]) -> bool {
        self.has_turned(i, y) || N == ROUGH && self.holds[i].bears() && self.changes_grip(i, y)
    }
    /// Returns whether a corner that has come to its next event touches.
    pub(super) fn lands<const N: usize>(&self, i: usize, y: &[f64; N]) -> bool {
        let Corner { hold, ground, .. } = self.holds[i];
        hold == Hold::Up && Self::place(y, self.corners[i]).0 < ground
    }
    /// Returns whether a corner has touched, parted, or come to its lowest.
    pub(super) fn has_turned<const N: usize>(&self, i: usize, y: &[f64; N]) -> bool {
        let Corner { hold, ground, .. } = self.holds[i];
        // Most corners are up, most of the time.
        if hold == Hold::Up && ground == 0.0 && y[0] + dot([y[2], y[3], y[4]], self.corners[i]) >= 0.0 {
            return false;
        }
        let motion @ (height, velocity) = Self::place(y, self.corners[i]);
        let depth = ground - height;
        match hold {
            Hold::Up => depth > 0.0 && velocity < 0.0 || ground < 0.0 && height > 0.0,
            Hold::Loads if self.delay > 0.0 => self.press(i, motion) <= 0.0,
            Hold::Loads => velocity >= 0.0,
            Hold::Unloads(deepest) => depth <= deepest * (1.0 - self.loss[i]) || depth > deepest && velocity < 0.0,
            Hold::Slack => depth <= 0.0 || self.press(i, motion) > 0.0,
        }
    }
    /// Returns whether a corner that sticks begins to slip, or one that slips sticks.
    pub(super) fn changes_grip<const N: usize>(&self, i: usize, y: &[f64; N]) -> bool {
        let grip = self.grip(i, y, self.force(i, y));
        // By more than roundings, as a corner at rest may lie just there.
        let is_beyond = grip.stretch > grip.limit * (1.0 + 1e-7);
        let slips = self.holds[i].slips;
        if !slips && !is_beyond {
            return false;
        }
        let grows_outward = grip.along > self.slip(i) * self.grows(i, y);
        slips != grows_outward
    }
    /// Lets a corner slip in the direction of its stretch, of its velocity where it has none yet, or keeps its length where it slips already.
    pub(super) fn slides_on<const N: usize>(&mut self, i: usize, y: &mut [f64; N]) {
        self.holds[i].slips = true;
        let (now, slides) = (stretch(y, i), Self::slides(y, self.corners[i]));
        let of = if length(now) > 0.0 { now } else { slides };
        let size = length(of);
        set_stretch(y, i, if size > 0.0 { of.map(|part| self.depth * part / size) } else { of });
    }
    /// Lets a corner that slips stick with the stretch that it has.
    pub(super) fn sticks<const N: usize>(&mut self, i: usize, y: &mut [f64; N]) {
        let limit = self.slip(i) * self.force(i, y).max(0.0);
        self.holds[i].slips = false;
        set_stretch(y, i, stretch(y, i).map(|part| part * limit / self.depth));
    }
}

/// Returns a force along the ground in axes of the box.
pub(super) fn in_box<const N: usize>(y: &[f64; N], [a, b]: [f64; 2]) -> [f64; 3] {
    let [along, across] = ground(y);
    std::array::from_fn(|axis| a * along[axis] + b * across[axis])
}
