//! The ends of a bar and what a strike at one of them does to the other, which all lanes share.

use clatter::flight::Scene;

/// The ends of a bar, and what a component has of both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) arm: [f64; 2],
    /// 1/length.
    pub(super) over: f64,
    pub(super) gyration2: f64,
    pub(super) e: f64,
    /// Inertia ratios of strikes at both ends of a bar that lies flat.
    pub(super) flat: [f64; 2],
    /// (1 − e)/(1 + e) ρ²
    pub(super) loss: f64,
    /// 1 + x²/ρ² at the component.
    lever: f64,
    /// Shares that the component has of what both ends do.
    share: [f64; 2],
}

impl Ends {
    pub(super) fn new(scene: &Scene, position: f64) -> Self {
        let body = scene.body();
        let (arm, gyration2, e) = (body.arms_m(), body.gyration_m().powi(2), scene.e());
        let (over, loss) = (1.0 / (arm[0] + arm[1]), (1.0 - e) / (1.0 + e) * gyration2);
        let share = [0.5 * (1.0 - position), 0.5 * (1.0 + position)];
        let mut ends = Self { arm, over, gyration2, e, flat: [0.0; 2], loss, lever: 1.0, share };
        ends.flat = [ends.ratio(0, 1.0), ends.ratio(1, 1.0)];
        let x = ends.offset();
        if x != 0.0 {
            ends.lever += x * x / gyration2;
        }
        ends
    }
    /// Distance of the component from the center of mass, toward end b.
    pub(super) fn offset(&self) -> f64 {
        self.share[1] * self.arm[1] - self.share[0] * self.arm[0]
    }
    /// What the component gets of what both ends do.
    #[inline]
    pub(super) fn at(&self, (a, b): (f64, f64)) -> f64 {
        self.share[0] * a + self.share[1] * b
    }
    /// Bound on the speed at the component: all energy in its motion, `√(2E (1 + x²/ρ²))`.
    pub(super) fn reach(&self, twice_energy: f64) -> f64 {
        (twice_energy * self.lever).sqrt()
    }
    /// Inertia ratio of a strike at end i at an angle of this cos².
    pub(super) fn ratio(&self, i: usize, cos2: f64) -> f64 {
        let over = self.arm[0] * self.arm[1] * cos2 - self.gyration2;
        over / (self.arm[i] * self.arm[i] * cos2 + self.gyration2)
    }
}
