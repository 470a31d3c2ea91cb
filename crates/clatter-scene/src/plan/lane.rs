//! One bar, strike by strike, with as much physics as its lane keeps.
//!
//! Between strikes both ends follow parabolas. With real tilt the turning bends them by `−σ L ω² sin φ`: its mean over the flight,
//! the angle weighed as it acts on the height (⅔ at the beginning, ⅓ at the end) or on the velocity (evenly). A contact moves the bar as one
//! impulse at its centroid does: beside the jump Δv both ends are set back by Δv times that time.

use clatter::flight::Scene;

/// What all lanes share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) arm: [f64; 2],
    pub(super) gyration2: f64,
    pub(super) e: f64,
    /// Position of the component in [−1, 1].
    pub(super) position: f64,
}

impl Ends {
    pub(super) fn new(scene: &Scene, position: f64) -> Self {
        let body = scene.body();
        Self { arm: body.arms_m(), gyration2: body.gyration_m().powi(2), e: scene.e(), position }
    }
    pub(super) fn length(&self) -> f64 {
        self.arm[0] + self.arm[1]
    }
    /// Distance of the component from the center of mass, toward end b.
    pub(super) fn offset(&self) -> f64 {
        0.5 * ((1.0 + self.position) * self.arm[1] - (1.0 - self.position) * self.arm[0])
    }
    /// What the component gets of what both ends do.
    pub(super) fn at(&self, [a, b]: [f64; 2]) -> f64 {
        0.5 * ((1.0 - self.position) * a + (1.0 + self.position) * b)
    }
    /// Bound on the speed at the component: all energy in its motion, `√(2E (1 + x²/ρ²))`.
    pub(super) fn reach(&self, twice_energy: f64) -> f64 {
        let x = self.offset();
        let lever = if x == 0.0 { 1.0 } else { 1.0 + x * x / self.gyration2 };
        (twice_energy * lever).sqrt()
    }
    /// Inertia ratio of a strike at end i at an angle of this cos².
    pub(super) fn ratio(&self, i: usize, cos2: f64) -> f64 {
        let over = self.arm[0] * self.arm[1] * cos2 - self.gyration2;
        over / (self.arm[i] * self.arm[i] * cos2 + self.gyration2)
    }
}

/// The state of one lane just after a strike.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lane {
    height: [f64; 2],
    velocity: [f64; 2],
    gravity: f64,
    tilts: bool,
    /// Time from touch to centroid.
    delay: f64,
    /// An end that lies on the ground, and the other turns about it.
    down: Option<usize>,
}

/// An end whose bounces all end within this share of the time that the other needs to land is down at once.
const BRIEF: f64 = 0.05;

/// The next strike of a lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Next {
    pub(super) end: usize,
    /// Time since the last one.
    pub(super) after: f64,
    /// Downward accelerations that bring the ends there.
    fall: [f64; 2],
    /// Whether the bar turns upright or over before: what strikes then is not known from parabolas.
    pub(super) tumbles: bool,
}

impl Next {
    /// The first touch.
    pub(super) const FIRST: Self = Self { end: 0, after: 0.0, fall: [0.0; 2], tumbles: false };
}

/// Time until `h + v t − ½ g t²` comes to 0, the later root where it starts upward; 0 where it is below.
fn fall(h: f64, v: f64, g: f64) -> f64 {
    let square = v * v + 2.0 * g * h;
    if g <= 0.0 {
        return if v < 0.0 && square >= 0.0 { (2.0 * h / (square.sqrt() - v)).max(0.0) } else { f64::INFINITY };
    }
    let root = square.max(0.0).sqrt();
    if square < 0.0 {
        0.0
    } else if v >= 0.0 {
        (v + root) / g
    } else {
        (2.0 * h / (root - v)).max(0.0)
    }
}

impl Lane {
    /// The scene at its first touch, without gravity; the cosine of its tilt counts where it spins.
    pub(super) fn start(scene: &Scene, cos: f64) -> Self {
        let [a, b] = scene.body().arms_m();
        let (spin, speed) = (scene.spin_rad_s(), scene.speed_m_s());
        Self {
            height: [0.0, scene.height_gap_m()],
            velocity: [-speed - a * cos * spin, -speed + b * cos * spin],
            gravity: 0.0,
            tilts: false,
            delay: 0.0,
            down: None,
        }
    }
    /// A body in flight with these heights and velocities of its ends.
    pub(super) fn of(height: [f64; 2], velocity: [f64; 2], gravity: f64) -> Self {
        Self { height, velocity, gravity, tilts: false, delay: 0.0, down: None }
    }
    pub(super) fn with_gravity(self, gravity: f64) -> Self {
        Self { gravity, ..self }
    }
    pub(super) fn with_tilt(self) -> Self {
        Self { tilts: true, ..self }
    }
    pub(super) fn with_delay(self, delay: f64) -> Self {
        Self { delay, ..self }
    }
    /// Upward bend of the parabola of end i while the sine of the angle is `sin`.
    fn bend(&self, ends: &Ends, i: usize, sin: f64) -> f64 {
        let spin = (self.velocity[1] - self.velocity[0]) / ends.length();
        let arm = if i == 0 { -ends.arm[0] } else { ends.arm[1] };
        arm * spin * spin * sin
    }
    /// Sine of the angle now and after a time.
    fn sines(&self, ends: &Ends, after: f64) -> (f64, f64) {
        let sin = (self.height[1] - self.height[0]) / ends.length();
        (sin, sin + after * (self.velocity[1] - self.velocity[0]) / ends.length())
    }
    /// The next strike; `None` if nothing falls.
    pub(super) fn next(&self, ends: &Ends) -> Option<Next> {
        let g = self.gravity;
        if let Some(i) = self.down {
            let j = 1 - i;
            let turning = g * (1.0 + ends.ratio(i, 1.0));
            let after = fall(self.height[j], self.velocity[j], turning);
            let mut fall = [0.0; 2];
            fall[j] = turning;
            return (after < f64::INFINITY).then_some(Next { end: j, after, fall, tumbles: false });
        }
        let lands = |i: usize, down: f64| fall(self.height[i], self.velocity[i], down);
        let mut times = [lands(0, g), lands(1, g)];
        let mut down = [g; 2];
        let first = times[0].min(times[1]);
        if self.tilts && first < f64::INFINITY {
            let (from, to) = self.sines(ends, first);
            let sin = (2.0 * from + to) / 3.0;
            down = [g + self.bend(ends, 0, sin), g + self.bend(ends, 1, sin)];
            times = [lands(0, down[0]), lands(1, down[1])];
        }
        let end = usize::from(times[1] < times[0]);
        let tumbles = self.tilts && self.sines(ends, times[end]).1.abs() > 1.0;
        (times[end] < f64::INFINITY).then_some(Next { end, after: times[end], fall: down, tumbles })
    }
    /// Flies and strikes; returns the velocity shocks of both ends.
    pub(super) fn strike(&mut self, ends: &Ends, next: &Next) -> [f64; 2] {
        let (i, t) = (next.end, next.after);
        if self.down.take().is_some() {
            self.velocity[i] -= t * next.fall[i];
        } else {
            let (from, to) = self.sines(ends, t);
            let sin = 0.5 * (from + to);
            let swept = if self.tilts { [self.bend(ends, 0, sin), self.bend(ends, 1, sin)] } else { [0.0; 2] };
            for (k, swept) in swept.into_iter().enumerate() {
                self.height[k] += t * (self.velocity[k] - 0.5 * next.fall[k] * t);
                self.velocity[k] -= t * (self.gravity + swept);
            }
        }
        self.height[i] = 0.0;
        let sin = if self.tilts { (self.height[1 - i] / ends.length()).clamp(-0.9, 0.9) } else { 0.0 };
        let ratio = ends.ratio(i, (1.0 - sin) * (1.0 + sin));
        let jump = -(1.0 + ends.e) * self.velocity[i].min(0.0);
        let mut delta_v = [-ratio * jump; 2];
        delta_v[i] = jump;
        for (k, jump) in delta_v.into_iter().enumerate() {
            self.height[k] -= jump * self.delay;
            self.velocity[k] += jump;
        }
        self.settle(ends, i, ratio);
        delta_v
    }
    /// Lets end i lie where it would bounce ever less for a short while: bounces of w, e w, … last 2S/g in all, S = w/(1 − e).
    fn settle(&mut self, ends: &Ends, i: usize, ratio: f64) {
        let (j, w) = (1 - i, self.velocity[i]);
        let sum = w / (1.0 - ends.e);
        let lasts = 2.0 * sum / self.gravity;
        if self.height[j] > 0.0 && w >= 0.0 && lasts < BRIEF * fall(self.height[j], self.velocity[j], self.gravity) {
            self.height[j] += lasts * (self.velocity[j] - sum);
            self.velocity[j] -= (2.0 + ratio * (1.0 + ends.e)) * sum;
            (self.height[i], self.velocity[i], self.down) = (0.0, 0.0, Some(i));
        }
    }
    /// Whether one end lies on the ground.
    pub(super) fn is_down(&self) -> bool {
        self.down.is_some()
    }
    /// Twice the energy over the mass.
    pub(super) fn twice_energy(&self, ends: &Ends) -> f64 {
        let [a, b] = ends.arm;
        let length = ends.length();
        let center = (b * self.velocity[0] + a * self.velocity[1]) / length;
        let spin = (self.velocity[1] - self.velocity[0]) / length;
        let height = ((b * self.height[0] + a * self.height[1]) / length).max(0.0);
        center * center + ends.gyration2 * spin * spin + 2.0 * self.gravity * height
    }
    /// Bound on the speed at the component from here on.
    pub(super) fn reach(&self, ends: &Ends) -> f64 {
        ends.reach(self.twice_energy(ends))
    }
}
