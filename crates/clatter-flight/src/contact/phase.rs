//! A phase: the same points press all along it, each on one straight line of its contact law, or one of them lies.
//!
//! The lever arms of one moment within the phase give the coupling of the points and the acceleration with which each
//! falls:
//!
//! ```text
//! h_i″ = −fall_i + Σ_j M_ij F_j,    F_j = −k_j (h_j − zero_j + θ h_j′)
//! ```
//!
//! For the points that press, q = √k (h − zero) has the symmetric stiffness √k_i M_ij √k_j; its modes are damped in
//! proportion to their stiffness. Heights, forces, and their effects on the center of mass and on the angle are sums of
//! these modes. At the end of the phase the pose follows in exact geometry.
//!
//! # Points that lie
//! A point that lies stays where it is: its force is the one that makes its acceleration 0,
//!
//! ```text
//! F_l = (fall_l − Σ_j M_lj F_j)/M_ll
//! ```
//!
//! so that for all other points M_ij is less by M_il M_lj/M_ll, and fall_i by M_il/M_ll times that of the point;
//! several lying points are eliminated one after the other.

use super::Sample;
use super::eigen::eigen;
use super::mode::{Mode, Motion};
use super::pose::{Pose, Pushes, moves_freely, solve};
use super::touch::Watch;

/// The straight line of the force on a point that presses: `F = k (zero − h − θ h′)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) stiffness: f64,
    pub(super) zero: f64,
}

/// State of the contact of a point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Hold {
    /// No contact.
    No,
    /// A point on a line of its law.
    On(Line),
    /// A point that lies.
    Lies,
}

/// Share of the depth at rest below which a vibration does not count.
const STILL: f64 = 1e-6;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Phase<P: Pose<N>, const N: usize> {
    pub(crate) start: P,
    /// Lever arms at the pose that stands for the phase.
    pub(crate) arms: P::Arms,
    pub(super) lines: [Option<Line>; N],
    /// The points that lie.
    pub(crate) lies: [bool; N],
    /// M_ij by these lever arms; zero in a free phase.
    coupling: [[f64; N]; N],
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
    /// Part of q that does not move, where more points press than the body has degrees of freedom.
    idle: [f64; N],
    /// Acceleration of each point by the press of each mode.
    by_press: [[f64; N]; N],
}

impl<P: Pose<N>, const N: usize> Phase<P, N> {
    /// Creates the phase from a pose, with the lever arms of `halfway`.
    pub(super) fn new(start: P, halfway: &P, holds: [Hold; N], delay: f64) -> Self {
        let arms = halfway.arms();
        let coupling = std::array::from_fn(|i| std::array::from_fn(|j| halfway.coupling(&arms, i.max(j), i.min(j))));
        let fall = halfway.falls(&arms);
        let (height, velocity) = start.points();
        let lines = holds.map(|hold| if let Hold::On(line) = hold { Some(line) } else { None });
        let mut phase = Self {
            start,
            arms,
            lines,
            lies: holds.map(|hold| matches!(hold, Hold::Lies)),
            coupling,
            fall,
            height,
            velocity,
            delay,
            count: 0,
            modes: [Mode::default(); N],
            root: lines.map(|line| line.map_or(0.0, |line| line.stiffness.sqrt())),
            shape: [[0.0; N]; N],
            idle: [0.0; N],
            by_press: [[0.0; N]; N],
        };
        if phase.lies.contains(&true) {
            let reduced = |i: usize| if phase.lies[i] { fall[i] } else { fall[i] - phase.steady(&coupling[i]) };
            phase.fall = std::array::from_fn(reduced);
        }
        phase.find_modes();
        phase
    }
    /// Creates a phase without contact.
    pub(super) fn free(start: P) -> Self {
        let (none, arms) = ([0.0; N], start.arms());
        let (height, velocity) = start.points_by(&arms);
        Self {
            start,
            arms,
            lines: [None; N],
            lies: [false; N],
            coupling: [none; N],
            fall: none,
            height,
            velocity,
            delay: 0.0,
            count: 0,
            modes: [Mode::default(); N],
            root: none,
            shape: [[0.0; N]; N],
            idle: none,
            by_press: [[0.0; N]; N],
        }
    }
    fn find_modes(&mut self) {
        let (lines, height, velocity, fall) = (self.lines, self.height, self.velocity, self.fall);
        let mut stiffness = [[0.0; N]; N];
        for i in (0..N).filter(|&i| lines[i].is_some()) {
            let (share, _) = self.reduced(&self.coupling[i]);
            for j in (0..=i).filter(|&j| lines[j].is_some()) {
                stiffness[i][j] = self.root[i] * share[j] * self.root[j];
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
        self.by_press = self.coupling.map(|of_point| self.by_modes(&of_point));
    }
    /// Returns whether a point presses.
    pub(crate) fn presses(&self, i: usize) -> bool {
        self.lines[i].is_some() || self.lies[i]
    }
    pub(crate) fn is_free(&self) -> bool {
        self.count == 0 && !self.lies.contains(&true)
    }
    /// Returns whether nothing vibrates.
    pub(super) fn is_still(&self) -> bool {
        self.modes().iter().all(|mode| mode.bounds()[0] <= STILL * mode.rest().abs())
    }
    /// Returns the effects of forces at the points on a quantity, each with the lying points holding against it; and
    /// the acceleration of the quantity by these points as they carry themselves. Where nothing lies, the effects are
    /// those given.
    fn reduced(&self, of: &[f64; N]) -> ([f64; N], f64) {
        if self.lies.contains(&true) { self.reduced_by(of, N) } else { (*of, 0.0) }
    }
    /// Returns the same with the lying points before `end` alone.
    fn reduced_by(&self, of: &[f64; N], end: usize) -> ([f64; N], f64) {
        let (mut of, mut steady) = (*of, 0.0);
        for l in (0..end).filter(|&l| self.lies[l]) {
            let first = !self.lies[..l].contains(&true);
            let (row, carried) = if first { (self.coupling[l], 0.0) } else { self.reduced_by(&self.coupling[l], l) };
            if moves_freely(row[l], self.coupling[l][l]) {
                let share = of[l] / row[l];
                of = std::array::from_fn(|i| of[i] - share * row[i]);
                steady += share * (self.fall[l] - carried);
            }
        }
        (of, steady)
    }
    /// Returns the acceleration of a quantity by each mode's press, `Σ_m by_press[m] (z_m + θ z_m′)`, from the effects
    /// on it of forces at the points.
    pub(crate) fn by_modes(&self, of: &[f64; N]) -> [f64; N] {
        let mut by_press = [0.0; N];
        if self.count == 0 {
            return by_press;
        }
        let (share, _) = self.reduced(of);
        for i in (0..N).filter(|&i| self.lines[i].is_some()) {
            let share = share[i] * self.root[i];
            for (m, by_press) in by_press.iter_mut().enumerate().take(self.count) {
                *by_press -= share * self.shape[i][m];
            }
        }
        by_press
    }
    /// Returns the other part of its acceleration above free fall: that by the points that lie.
    pub(crate) fn steady(&self, of: &[f64; N]) -> f64 {
        self.reduced(of).1
    }
    /// Returns the modes of the phase.
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
    /// Returns the height of point i at time t and its first three derivatives, by the lever arms of the phase.
    pub(super) fn point(&self, i: usize, t: f64, motions: &[Motion; N]) -> [f64; 4] {
        if let Some(line) = self.lines[i] {
            let of = |n: usize| (0..self.count).map(|m| self.shape[i][m] * motions[m][n]).sum::<f64>() / self.root[i];
            return [line.zero + self.idle[i] / self.root[i] + of(0), of(1), of(2), of(3)];
        }
        if self.lies[i] {
            return [self.height[i], 0.0, 0.0, 0.0];
        }
        let by_press = self.by_press[i];
        let mut h = [
            self.height[i] + t * (self.velocity[i] - 0.5 * t * self.fall[i]),
            self.velocity[i] - t * self.fall[i],
            -self.fall[i],
            0.0,
        ];
        for (m, mode) in self.modes().iter().enumerate() {
            let [impulse, path] = mode.pressed(t, &motions[m]);
            h[0] += by_press[m] * path;
            h[1] += by_press[m] * impulse;
            h[2] += by_press[m] * mode.press(&motions[m]);
            h[3] += by_press[m] * (motions[m][1] + self.delay * motions[m][2]);
        }
        h
    }
    /// Returns height and velocity of a point at the begin of the phase; `None` for one that lies.
    pub(super) fn begins(&self, i: usize) -> Option<[f64; 2]> {
        (!self.lies[i]).then_some([self.height[i], self.velocity[i]])
    }
    /// Returns the height of a point, or the force on one that lies, at time t and the first three derivatives.
    pub(super) fn watched(&self, i: usize, t: f64) -> [f64; 4] {
        if self.is_free() {
            return self.start.flying(i, t);
        }
        let motions = self.motions(t);
        if self.lies[i] { self.reaction(i, &motions) } else { self.point(i, t, &motions) }
    }
    /// Returns the time at which a watch on a point that presses falls to zero, where there is a closed form:
    /// `Some(None)` if it never does.
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
    /// Returns bounds of the second, third and fourth derivative of the height of point i, all through the phase.
    pub(super) fn bounds(&self, i: usize, modes: &[[f64; 4]; N]) -> [f64; 3] {
        if self.lines[i].is_some() {
            let by = |n: usize| (0..self.count).map(|m| self.shape[i][m].abs() * modes[m][n]).sum::<f64>();
            return [1, 2, 3].map(|n| by(n) / self.root[i]);
        }
        let by_press = self.by_press[i];
        // The press of a mode is (load − z″)/λ.
        let steady = -self.fall[i]
            + self.modes().iter().zip(by_press).map(|(mode, by_press)| by_press * mode.rest()).sum::<f64>();
        let by =
            |n: usize| (0..self.count).map(|m| by_press[m].abs() * modes[m][n] / self.modes[m].lambda()).sum::<f64>();
        [steady.abs() + by(1), by(2), by(3)]
    }
    pub(super) fn mode_bounds(&self) -> [[f64; 4]; N] {
        let mut bounds = [[0.0; 4]; N];
        for (mode, bounds) in self.modes().iter().zip(&mut bounds) {
            *bounds = mode.bounds();
        }
        bounds
    }
    /// Returns the height at which point i would rest on its line, and the amplitude of its swing about that.
    pub(super) fn swing(&self, i: usize, modes: &[[f64; 4]; N]) -> Option<[f64; 2]> {
        let line = self.lines[i]?;
        let each = |of: &dyn Fn(usize) -> f64| (0..self.count).map(of).sum::<f64>() / self.root[i];
        let rest = line.zero + self.idle[i] / self.root[i] + each(&|m| self.shape[i][m] * self.modes[m].rest());
        Some([rest, each(&|m| self.shape[i][m].abs() * modes[m][0])])
    }
    /// Returns the forces per mass at the lying points that give them these accelerations.
    fn moving(&self, b: [f64; N]) -> [f64; N] {
        solve(|i, j| self.coupling[i][j], &self.lies, b)
    }
    /// Returns the force on point l, which lies, by each mode's motion.
    fn reaction_by(&self, l: usize) -> [f64; N] {
        let mut by = [0.0; N];
        for i in (0..N).filter(|&i| self.lines[i].is_some()) {
            let share = self.moving(self.coupling[i].map(|of| of * self.root[i]))[l];
            for (m, by) in by.iter_mut().enumerate().take(self.count) {
                *by += share * self.shape[i][m];
            }
        }
        by
    }
    /// Returns the force per mass on point l, which lies, and its first three derivatives; without damping. Where lying
    /// points press alone, the turning is that of the begin: a point parts when its force has fallen to zero, and not
    /// before.
    pub(super) fn reaction(&self, l: usize, motions: &[Motion; N]) -> [f64; 4] {
        let by = self.reaction_by(l);
        let of = |n: usize| (0..self.count).map(|m| by[m] * motions[m][n]).sum::<f64>();
        let fall = |l: usize| if self.count == 0 { self.start.fall(l) } else { self.fall[l] };
        let idle = |l: usize, i: usize| self.coupling[l][i] * self.root[i] * self.idle[i];
        let without = self.moving(std::array::from_fn(|l| {
            if self.lies[l] { fall(l) + (0..N).map(|i| idle(l, i)).sum::<f64>() } else { 0.0 }
        }));
        [without[l] + of(0), of(1), of(2), of(3)]
    }
    /// Returns bounds of the second, third and fourth derivative of that force.
    pub(super) fn reaction_bounds(&self, l: usize, modes: &[[f64; 4]; N]) -> [f64; 3] {
        let by = self.reaction_by(l);
        [1, 2, 3].map(|n| (0..self.count).map(|m| by[m].abs() * modes[m][n]).sum())
    }
    /// Returns the forces of the ground on all points over the mass.
    pub(super) fn forces(&self, motions: &[Motion; N]) -> [f64; N] {
        std::array::from_fn(|i| {
            if self.lies[i] {
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
        if self.lies.contains(&true) {
            let others = |l: usize, of: &[f64; N]| (0..N).map(|i| self.coupling[l][i] * of[i]).sum::<f64>();
            let impulse = self.moving(std::array::from_fn(|l| self.fall[l] * t - others(l, &pushes.impulse)));
            let path = self.moving(std::array::from_fn(|l| 0.5 * self.fall[l] * t * t - others(l, &pushes.path)));
            for l in (0..N).filter(|&l| self.lies[l]) {
                (pushes.impulse[l], pushes.path[l]) = (impulse[l], path[l]);
            }
        }
        pushes
    }
    /// Returns the pose at time t in exact geometry.
    pub(super) fn pose(&self, t: f64, pushes: &Pushes<N>) -> P {
        self.start.after(t, &self.arms, pushes)
    }
    /// Returns the changes of the velocities of all points by an impulse at point i.
    pub(super) fn jumps(&self, i: usize, impulse: f64) -> [f64; N] {
        self.coupling[i].map(|share| share * impulse)
    }
    /// Returns the distance of a pressing point from the height by its line, beyond a rounding, as the equivalent
    /// velocity of its vibration.
    pub(super) fn mismatch(&self, t: f64, motions: &[Motion; N], end: &P, rounding: f64) -> f64 {
        let (height, _) = end.points();
        let off = |i: usize| {
            let rate = self.root[i] * self.coupling[i][i].sqrt();
            let gap = || ((height[i] - self.point(i, t, motions)[0]).abs() - rounding).max(0.0);
            if self.lines[i].is_some() { rate * gap() } else { 0.0 }
        };
        (0..N).map(off).fold(0.0, f64::max)
    }
    /// Returns the largest change of velocity of a point by its own impulse so far.
    pub(super) fn pushed(&self, pushes: &Pushes<N>) -> f64 {
        (0..N).map(|i| self.coupling[i][i] * pushes.impulse[i].abs()).fold(0.0, f64::max)
    }
    /// Returns a pose in which the lying points are where they were and stand still, and the impulses for that:
    /// constant lever arms have moved them a little.
    pub(super) fn held(&self, pose: &P) -> (P, [f64; N]) {
        let none = [0.0; N];
        let by = |pose: &P, arms: &P::Arms, b: [f64; N]| solve(|i, j| pose.coupling(arms, i, j), &self.lies, b);
        let arms = pose.arms();
        let (height, _) = pose.points_by(&arms);
        let path = by(pose, &arms, std::array::from_fn(|i| self.height[i] - height[i]));
        let pose = pose.after(0.0, &arms, &Pushes { impulse: none, path });
        let arms = pose.arms();
        let impulse = by(&pose, &arms, pose.points_by(&arms).1.map(|velocity| -velocity));
        (pose.after(0.0, &arms, &Pushes { impulse, path: none }), impulse)
    }
    pub(crate) fn sample(&self, t: f64) -> Sample<N> {
        let motions = self.motions(t);
        let free = self.is_free();
        let mut pose = if free { self.start.flown(t) } else { self.pose(t, &self.pushes(t, &motions)) };
        if self.lies.contains(&true) {
            pose = self.held(&pose).0;
        }
        let (height_m, velocity_m_s) = pose.points();
        let [tilt_rad, spin_rad_s] = pose.angles();
        let acceleration = |i| if free { self.start.flying(i, t)[2] } else { self.point(i, t, &motions)[2] };
        Sample {
            height_m,
            velocity_m_s,
            acceleration_m_s2: std::array::from_fn(acceleration),
            force_per_mass_m_s2: self.forces(&motions),
            tilt_rad,
            spin_rad_s,
        }
    }
    /// Returns the energy that its dashpots have taken until time t, per mass.
    pub(super) fn taken(&self, motions: &[Motion; N]) -> f64 {
        self.modes().iter().zip(motions).map(|(mode, motion)| mode.taken(motion)).sum()
    }
    /// Returns the energy of the springs per mass, for these heights of the points that press.
    pub(super) fn springs(&self, height: &[f64; N]) -> f64 {
        let one = |i: usize| self.lines[i].map_or(0.0, |line| line.stiffness * (line.zero - height[i]).powi(2));
        0.5 * (0..N).map(one).sum::<f64>()
    }
}
