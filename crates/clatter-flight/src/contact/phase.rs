//! A phase: the same points press all along it, each on one straight line of its contact law, or one of them lies.
//!
//! With the lever arms x and the heights over the center of mass of one moment within the phase, ω the spin there,
//!
//! ```text
//! h_i″ = −g − ω² over_i + Σ_j M_ij F_j,    M_ij = 1 + x_i x_j/ρ²,    F_j = −k_j (h_j − zero_j + θ h_j′)
//! ```
//!
//! For the points that press, q = √k (h − zero) has the symmetric stiffness √k_i M_ij √k_j; its modes are damped in
//! proportion to their stiffness. Heights, forces, and what they do to the center of mass and to the angle are sums of
//! these modes. At the end of the phase the pose follows in exact geometry.
//!
//! # A point that lies
//! It stays where it is: its force is the one that makes its acceleration 0,
//!
//! ```text
//! F_l = (g + ω² over_l − Σ_j M_lj F_j)/M_ll
//! ```
//!
//! so that for all other points M_ij is less by M_il M_lj/M_ll, and g + ω² over_i by M_il/M_ll of that of the point.

use super::Sample;
use super::eigen::eigen;
use super::mode::{Mode, Motion};
use super::pose::{Levers, Pose};
use super::touch::Watch;

/// The straight line of the force on a point that presses: `F = k (zero − h − θ h′)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) stiffness: f64,
    pub(super) zero: f64,
}

/// How the ground carries a point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Hold {
    /// Not at all.
    No,
    /// On a line of its law.
    On(Line),
    /// It lies.
    Lies,
}

/// Vibrations within this share of the depth at rest do not count.
const STILL: f64 = 1e-6;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Phase<const N: usize> {
    pub(crate) start: Pose<N>,
    /// Where the lever arms are taken.
    pub(crate) halfway: Pose<N>,
    pub(super) lines: [Option<Line>; N],
    /// The point that lies.
    pub(crate) lies: Option<usize>,
    x: [f64; N],
    /// Downward accelerations without contact: gravity and turning.
    fall: [f64; N],
    height: [f64; N],
    velocity: [f64; N],
    pub(crate) delay: f64,
    count: usize,
    modes: [Mode; N],
    /// √k of each line.
    root: [f64; N],
    /// Modes in the points that press: q_i = idle_i + Σ_m shape_im z_m.
    shape: [[f64; N]; N],
    /// What does not move, where more points press than the body has ways to move.
    idle: [f64; N],
    /// What each mode's press does to each point.
    felt: [[f64; N]; N],
}

/// What the ground has done since a phase began: ∫F dt and ∬F dt² of each point, per mass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pushes<const N: usize> {
    pub(super) impulse: [f64; N],
    pub(super) path: [f64; N],
}

impl<const N: usize> Phase<N> {
    /// From a pose, with the lever arms of `halfway`.
    pub(super) fn new(start: Pose<N>, halfway: &Pose<N>, holds: [Hold; N], delay: f64) -> Self {
        let Levers { x, over } = halfway.levers();
        let fall = over.map(|h| start.gravity + halfway.spin * halfway.spin * h);
        let (height, velocity) = start.points();
        let lines = holds.map(|hold| if let Hold::On(line) = hold { Some(line) } else { None });
        let mut phase = Self {
            start,
            halfway: *halfway,
            lines,
            lies: holds.iter().position(|hold| matches!(hold, Hold::Lies)),
            x,
            fall,
            height,
            velocity,
            delay,
            count: 0,
            modes: [Mode::default(); N],
            root: lines.map(|line| line.map_or(0.0, |line| line.stiffness.sqrt())),
            shape: [[0.0; N]; N],
            idle: [0.0; N],
            felt: [[0.0; N]; N],
        };
        if let Some(l) = phase.lies {
            phase.fall = std::array::from_fn(|i| if i == l { 0.0 } else { fall[i] - phase.carried(x[i], l) * fall[l] });
            phase.fall[l] = fall[l];
        }
        phase.find_modes();
        phase
    }
    /// A phase in which nothing touches.
    pub(super) fn free(start: Pose<N>) -> Self {
        let none = [0.0; N];
        let (height, velocity) = start.points();
        Self {
            start,
            halfway: start,
            lines: [None; N],
            lies: None,
            x: none,
            fall: none,
            height,
            velocity,
            delay: 0.0,
            count: 0,
            modes: [Mode::default(); N],
            root: none,
            shape: [[0.0; N]; N],
            idle: none,
            felt: [[0.0; N]; N],
        }
    }
    fn find_modes(&mut self) {
        let (lines, height, velocity, fall) = (self.lines, self.height, self.velocity, self.fall);
        let mut stiffness = [[0.0; N]; N];
        for i in (0..N).filter(|&i| lines[i].is_some()) {
            for j in (0..=i).filter(|&j| lines[j].is_some()) {
                stiffness[i][j] = self.root[i] * self.share(self.x[i], j) * self.root[j];
                stiffness[j][i] = stiffness[i][j];
            }
        }
        let (lambda, shape) = eigen(stiffness);
        let largest = lambda.iter().fold(0.0_f64, |most, l| most.max(*l));
        for k in 0..N {
            let sum = |of: &dyn Fn(usize) -> f64| -> f64 { (0..N).map(|i| shape[i][k] * self.root[i] * of(i)).sum() };
            let z = sum(&|i| height[i] - lines[i].map_or(0.0, |line| line.zero));
            if lambda[k] <= 1e-14 * largest {
                for (idle, of_point) in self.idle.iter_mut().zip(&shape) {
                    *idle += of_point[k] * z;
                }
                continue;
            }
            let m = self.count;
            self.modes[m] = Mode::new(lambda[k], self.delay, -sum(&|i| fall[i]), z, sum(&|i| velocity[i]));
            for (own, of_point) in self.shape.iter_mut().zip(&shape) {
                own[m] = of_point[k];
            }
            self.count += 1;
        }
        self.felt = self.x.map(|x| self.felt_at(x));
    }
    pub(crate) fn is_free(&self) -> bool {
        self.count == 0 && self.lies.is_none()
    }
    /// Whether nothing vibrates.
    pub(super) fn is_still(&self) -> bool {
        self.modes().iter().all(|mode| mode.bounds()[0] <= STILL * mode.rest().abs())
    }
    /// What a force at point i does to a place at lever arm x, where nothing lies.
    fn raw(&self, x: f64, i: usize) -> f64 {
        1.0 + x * self.x[i] / self.start.rho2
    }
    /// What moves a place at lever arm x as the point l that lies is pushed, over what moves that point.
    fn carried(&self, x: f64, l: usize) -> f64 {
        self.raw(x, l) / self.raw(self.x[l], l)
    }
    /// What a force at point i does to a place at lever arm x.
    fn share(&self, x: f64, i: usize) -> f64 {
        self.raw(x, i) - self.lies.map_or(0.0, |l| self.carried(x, l) * self.raw(self.x[l], i))
    }
    /// Acceleration of a place at lever arm x by each mode's press: `Σ_m of[m] (z_m + θ z_m′)`.
    pub(crate) fn felt_at(&self, x: f64) -> [f64; N] {
        let mut felt = [0.0; N];
        for i in (0..N).filter(|&i| self.lines[i].is_some()) {
            let share = self.share(x, i) * self.root[i];
            for (m, felt) in felt.iter_mut().enumerate().take(self.count) {
                *felt -= share * self.shape[i][m];
            }
        }
        felt
    }
    /// Acceleration above free fall of a place at x, z on the body, besides that by the modes.
    pub(crate) fn steady_at(&self, [x, z]: [f64; 2]) -> f64 {
        let (sin, cos) = self.halfway.tilt.sin_cos();
        let lever = x * cos - z * sin;
        let turning = -self.halfway.spin * self.halfway.spin * (x * sin + z * cos);
        turning + self.lies.map_or(0.0, |l| self.carried(lever, l) * self.fall[l])
    }
    /// Angular acceleration by each mode's press, and besides: what a lever arm adds, which is 0 where both sides press alike.
    pub(crate) fn turned_by(&self) -> ([f64; N], f64) {
        let of_force = |i: usize| self.x[i] / self.start.rho2;
        let carried = |l: usize| of_force(l) / self.raw(self.x[l], l);
        let mut turned = [0.0; N];
        for i in (0..N).filter(|&i| self.lines[i].is_some()) {
            let share = of_force(i) - self.lies.map_or(0.0, |l| carried(l) * self.raw(self.x[l], i));
            for (m, turned) in turned.iter_mut().enumerate().take(self.count) {
                *turned -= share * self.root[i] * self.shape[i][m];
            }
        }
        (turned, self.lies.map_or(0.0, |l| carried(l) * self.fall[l]))
    }
    /// The modes that are there.
    pub(crate) fn modes(&self) -> &[Mode] {
        &self.modes[..self.count]
    }
    pub(crate) fn motions(&self, t: f64) -> [Motion; N] {
        let mut motions = [[0.0; 4]; N];
        for (mode, motion) in self.modes().iter().zip(&mut motions) {
            *motion = mode.at(t);
        }
        motions
    }
    /// Height of point i at time t and its first three derivatives, by the lever arms of the phase.
    pub(super) fn point(&self, i: usize, t: f64, motions: &[Motion; N]) -> [f64; 4] {
        if let Some(line) = self.lines[i] {
            let of = |n: usize| (0..self.count).map(|m| self.shape[i][m] * motions[m][n]).sum::<f64>() / self.root[i];
            return [line.zero + self.idle[i] / self.root[i] + of(0), of(1), of(2), of(3)];
        }
        if self.lies == Some(i) {
            return [self.height[i], 0.0, 0.0, 0.0];
        }
        let felt = self.felt[i];
        let mut h = [
            self.height[i] + t * (self.velocity[i] - 0.5 * t * self.fall[i]),
            self.velocity[i] - t * self.fall[i],
            -self.fall[i],
            0.0,
        ];
        for (m, mode) in self.modes().iter().enumerate() {
            let [impulse, path] = mode.pressed(t, &motions[m]);
            h[0] += felt[m] * path;
            h[1] += felt[m] * impulse;
            h[2] += felt[m] * mode.press(&motions[m]);
            h[3] += felt[m] * (motions[m][1] + self.delay * motions[m][2]);
        }
        h
    }
    /// Height and velocity of a point as the phase begins; none for one that lies.
    pub(super) fn begins(&self, i: usize) -> Option<[f64; 2]> {
        (self.lies != Some(i)).then_some([self.height[i], self.velocity[i]])
    }
    /// Height of a point, or force on one that lies, at time t and the first three derivatives.
    pub(super) fn watched(&self, i: usize, t: f64) -> [f64; 4] {
        if self.is_free() {
            return self.start.flying(i, t);
        }
        let motions = self.motions(t);
        if self.lies == Some(i) { self.reaction(i, &motions) } else { self.point(i, t, &motions) }
    }
    /// When a watch on a point that presses falls to zero, where there is a closed form: none where it never does.
    #[expect(clippy::option_option, reason = "no closed form, or never")]
    pub(super) fn falls(&self, i: usize, watch: &Watch) -> Option<Option<f64>> {
        let line = self.lines[i]?;
        if self.count != 1 || !self.modes[0].is_undamped() || self.idle[i] != 0.0 {
            return None;
        }
        let by = self.shape[i][0] / self.root[i];
        let offset = watch.offset + watch.of_height * line.zero;
        Some(self.modes[0].falls(offset, watch.of_height * by, watch.of_velocity * by))
    }
    /// Bounds of the second, third and fourth derivative of the height of point i, all through the phase.
    pub(super) fn bounds(&self, i: usize, modes: &[[f64; 4]; N]) -> [f64; 3] {
        if self.lines[i].is_some() {
            let by = |n: usize| (0..self.count).map(|m| self.shape[i][m].abs() * modes[m][n]).sum::<f64>();
            return [1, 2, 3].map(|n| by(n) / self.root[i]);
        }
        let felt = self.felt[i];
        // The press of a mode is (load − z″)/λ.
        let steady = -self.fall[i] + self.modes().iter().zip(felt).map(|(mode, felt)| felt * mode.rest()).sum::<f64>();
        let by = |n: usize| (0..self.count).map(|m| felt[m].abs() * modes[m][n] / self.modes[m].lambda()).sum::<f64>();
        [steady.abs() + by(1), by(2), by(3)]
    }
    pub(super) fn mode_bounds(&self) -> [[f64; 4]; N] {
        let mut bounds = [[0.0; 4]; N];
        for (mode, bounds) in self.modes().iter().zip(&mut bounds) {
            *bounds = mode.bounds();
        }
        bounds
    }
    /// Where point i would rest on its line, and how far it swings about that at most.
    pub(super) fn swing(&self, i: usize, modes: &[[f64; 4]; N]) -> Option<[f64; 2]> {
        let line = self.lines[i]?;
        let each = |of: &dyn Fn(usize) -> f64| (0..self.count).map(of).sum::<f64>() / self.root[i];
        let rest = line.zero + self.idle[i] / self.root[i] + each(&|m| self.shape[i][m] * self.modes[m].rest());
        Some([rest, each(&|m| self.shape[i][m].abs() * modes[m][0])])
    }
    /// What moves point l, which lies, by each mode's press.
    fn reaction_by(&self, l: usize) -> [f64; N] {
        let mut by = [0.0; N];
        for i in (0..N).filter(|&i| self.lines[i].is_some()) {
            let share = self.raw(self.x[l], i) * self.root[i] / self.raw(self.x[l], l);
            for (m, by) in by.iter_mut().enumerate().take(self.count) {
                *by += share * self.shape[i][m];
            }
        }
        by
    }
    /// Force per mass on point l, which lies, and its first three derivatives; no damping. Where it alone presses, turning is
    /// that of the begin: it parts when its force has fallen to zero, and not when it is about to.
    pub(super) fn reaction(&self, l: usize, motions: &[Motion; N]) -> [f64; 4] {
        let by = self.reaction_by(l);
        let of = |n: usize| (0..self.count).map(|m| by[m] * motions[m][n]).sum::<f64>();
        let idle = |i: usize| self.raw(self.x[l], i) * self.root[i] * self.idle[i];
        let fall = if self.count == 0 { self.start.fall(l) } else { self.fall[l] };
        let without = (fall + (0..N).map(idle).sum::<f64>()) / self.raw(self.x[l], l);
        [without + of(0), of(1), of(2), of(3)]
    }
    /// Bounds of its second, third and fourth derivative.
    pub(super) fn reaction_bounds(&self, l: usize, modes: &[[f64; 4]; N]) -> [f64; 3] {
        let by = self.reaction_by(l);
        [1, 2, 3].map(|n| (0..self.count).map(|m| by[m].abs() * modes[m][n]).sum())
    }
    /// Forces of the ground on all points over the mass.
    pub(super) fn forces(&self, motions: &[Motion; N]) -> [f64; N] {
        std::array::from_fn(|i| {
            if self.lies == Some(i) {
                return self.reaction(i, motions)[0].max(0.0);
            }
            let press = |m: usize| self.shape[i][m] * self.modes[m].press(&motions[m]);
            (-self.root[i] * (self.idle[i] + (0..self.count).map(press).sum::<f64>())).max(0.0)
        })
    }
    pub(super) fn pushes(&self, t: f64, motions: &[Motion; N]) -> Pushes<N> {
        let mut pushes = Pushes { impulse: [0.0; N], path: [0.0; N] };
        for i in (0..N).filter(|&i| self.lines[i].is_some()) {
            pushes.impulse[i] = -self.root[i] * self.idle[i] * t;
            pushes.path[i] = 0.5 * t * pushes.impulse[i];
        }
        for (m, mode) in self.modes().iter().enumerate() {
            let [impulse, path] = mode.pressed(t, &motions[m]);
            for i in (0..N).filter(|&i| self.lines[i].is_some()) {
                let of = -self.root[i] * self.shape[i][m];
                pushes.impulse[i] += of * impulse;
                pushes.path[i] += of * path;
            }
        }
        if let Some(l) = self.lies {
            let own = self.raw(self.x[l], l);
            let others = |of: &[f64; N]| (0..N).map(|i| self.raw(self.x[l], i) * of[i]).sum::<f64>();
            let impulse = (self.fall[l] * t - others(&pushes.impulse)) / own;
            let path = (0.5 * self.fall[l] * t * t - others(&pushes.path)) / own;
            (pushes.impulse[l], pushes.path[l]) = (impulse, path);
        }
        pushes
    }
    /// The pose at time t in exact geometry.
    pub(super) fn pose(&self, t: f64, pushes: &Pushes<N>) -> Pose<N> {
        let mut pose = self.start.flown(t);
        let rho2 = self.start.rho2;
        for i in 0..N {
            pose.y += pushes.path[i];
            pose.v += pushes.impulse[i];
            pose.tilt += self.x[i] * pushes.path[i] / rho2;
            pose.spin += self.x[i] * pushes.impulse[i] / rho2;
        }
        pose
    }
    /// What impulses at point i do to the velocities of all points.
    pub(super) fn jumps(&self, i: usize, impulse: f64) -> [f64; N] {
        self.x.map(|x| self.raw(x, i) * impulse)
    }
    /// By how much more than a rounding a point that presses is not where its line has it, as the velocity that this is worth
    /// to its vibration.
    pub(super) fn mismatch(&self, t: f64, motions: &[Motion; N], end: &Pose<N>, rounding: f64) -> f64 {
        let (height, _) = end.points();
        let off = |i: usize| {
            let rate = self.root[i] * self.raw(self.x[i], i).sqrt();
            let gap = || ((height[i] - self.point(i, t, motions)[0]).abs() - rounding).max(0.0);
            if self.lines[i].is_some() { rate * gap() } else { 0.0 }
        };
        (0..N).map(off).fold(0.0, f64::max)
    }
    /// The largest change of velocity of a point by what has pressed on it.
    pub(super) fn pushed(&self, pushes: &Pushes<N>) -> f64 {
        (0..N).map(|i| self.raw(self.x[i], i) * pushes.impulse[i].abs()).fold(0.0, f64::max)
    }
    /// A pose in which the point that lies is where it was and stands still, and the impulse for that: kept lever arms have moved it
    /// a little.
    pub(super) fn held(&self, l: usize, pose: &Pose<N>) -> (Pose<N>, f64) {
        let x = pose.levers().x[l];
        let pose = pose.moved(self.height[l] - pose.points().0[l], x);
        let x = pose.levers().x[l];
        let impulse = -(pose.v + x * pose.spin) / (1.0 + x * x / pose.rho2);
        (pose.pushed(impulse, x), impulse)
    }
    pub(crate) fn sample(&self, t: f64) -> Sample<N> {
        let motions = self.motions(t);
        let free = self.is_free();
        let mut pose = if free { self.start.flown(t) } else { self.pose(t, &self.pushes(t, &motions)) };
        if let Some(l) = self.lies {
            pose = self.held(l, &pose).0;
        }
        let (height_m, velocity_m_s) = pose.points();
        let acceleration = |i| if free { self.start.flying(i, t)[2] } else { self.point(i, t, &motions)[2] };
        Sample {
            height_m,
            velocity_m_s,
            acceleration_m_s2: std::array::from_fn(acceleration),
            force_per_mass_m_s2: self.forces(&motions),
            tilt_rad: pose.tilt,
            spin_rad_s: pose.spin,
        }
    }
    /// What its dashpots have taken until time t, per mass.
    pub(super) fn taken(&self, motions: &[Motion; N]) -> f64 {
        self.modes().iter().zip(motions).map(|(mode, motion)| mode.taken(motion)).sum()
    }
    /// Energy of the springs per mass, for these heights of the points that press.
    pub(super) fn springs(&self, height: &[f64; N]) -> f64 {
        let one = |i: usize| self.lines[i].map_or(0.0, |line| line.stiffness * (line.zero - height[i]).powi(2));
        0.5 * (0..N).map(one).sum::<f64>()
    }
}
