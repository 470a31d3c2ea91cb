//! A body that presses by one of the two contact laws, integrated by classical Runge–Kutta steps in exact geometry: the
//! center of mass, the angle and their rates are the state, forces come straight from the laws, events are bisected.

#![allow(dead_code, reason = "each test program uses its part")]

pub(crate) mod jumps;
pub(crate) mod plate;

use clatter_flight::ContactLaw;

/// Height and angle of the center of mass and their rates: y, v, φ, ω.
pub(crate) type State = [f64; 4];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Away,
    /// On the line from the ground.
    Load,
    /// On the steeper line below its deepest depth.
    Unload,
    /// Where the steeper line is vertical: the point stands still.
    Held,
    /// Below the ground without force.
    Gap,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    mode: Mode,
    stiffness: f64,
    /// Depth from which this contact counts: where its last press left the ground, 0 once it has been above it.
    ground: f64,
    /// Deepest below that.
    deepest: f64,
}

/// A touch: from above the ground, or a new press in the dent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub(crate) point: usize,
    pub(crate) time: f64,
    pub(crate) approach: f64,
}

/// A part on a spring and a damper at a place of the body, at rest in free fall before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) place: [f64; 2],
    pub(crate) omega: f64,
    pub(crate) zeta: f64,
    pub(crate) z: f64,
    pub(crate) v: f64,
    /// ω times its largest displacement, and the largest acceleration of spring and damper over ω.
    pub(crate) peaks: [f64; 2],
}

impl Part {
    /// A step with these accelerations of the place above free fall at its begin, middle and end.
    fn step(&mut self, [a0, a1, a2]: [f64; 3], h: f64) {
        let rate = |a: f64, [z, v]: [f64; 2]| [v, -a - 2.0 * self.zeta * self.omega * v - self.omega * self.omega * z];
        let at = |k: [f64; 2], h: f64| [self.z + h * k[0], self.v + h * k[1]];
        let a = rate(a0, [self.z, self.v]);
        let b = rate(a1, at(a, 0.5 * h));
        let c = rate(a1, at(b, 0.5 * h));
        let d = rate(a2, at(c, h));
        self.z += h / 6.0 * (a[0] + 2.0 * (b[0] + c[0]) + d[0]);
        self.v += h / 6.0 * (a[1] + 2.0 * (b[1] + c[1]) + d[1]);
        self.peaks[0] = self.peaks[0].max(self.omega * self.z.abs());
        self.peaks[1] = self.peaks[1].max((2.0 * self.zeta * self.v + self.omega * self.z).abs());
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Plain {
    points: Vec<[f64; 2]>,
    gyration: f64,
    gravity: f64,
    law: ContactLaw,
    /// Of each point its restitution and the rate of a lone contact, and θ of dashpots.
    e: Vec<f64>,
    omega: Vec<f64>,
    theta: f64,
    touching: Vec<Point>,
    pub(crate) state: State,
    pub(crate) time: f64,
    pub(crate) touches: Vec<Touch>,
    /// Largest turn in one flight, in rad, and the angle at which the present one began.
    pub(crate) turned: f64,
    left: f64,
    /// Steps in one over the fastest rate.
    pub(crate) fine: f64,
    pub(crate) part: Option<Part>,
}

/// ωτ and ζ of a dashpot with restitution e: a lone contact of rate 1 is integrated until its force is zero.
fn dashpot(e: f64) -> (f64, f64) {
    let lone = |zeta: f64| {
        let rate = |[z, v]: [f64; 2]| [v, -z - 2.0 * zeta * v];
        let step = |s: [f64; 2], h: f64| {
            let at = |k: [f64; 2], h: f64| [s[0] + h * k[0], s[1] + h * k[1]];
            let a = rate(s);
            let b = rate(at(a, 0.5 * h));
            let c = rate(at(b, 0.5 * h));
            let d = rate(at(c, h));
            [0, 1].map(|n| s[n] + h / 6.0 * (a[n] + 2.0 * (b[n] + c[n]) + d[n]))
        };
        let (mut s, mut t, h) = ([0.0, 1.0], 0.0, 2e-3 / (1.0 + zeta));
        while step(s, h)[0] + 2.0 * zeta * step(s, h)[1] > 0.0 {
            s = step(s, h);
            t += h;
        }
        let (mut lo, mut hi) = (0.0, h);
        for _ in 0..60 {
            let mid = 0.5 * (lo + hi);
            let m = step(s, mid);
            if m[0] + 2.0 * zeta * m[1] > 0.0 { lo = mid } else { hi = mid }
        }
        (t + hi, -step(s, hi)[1])
    };
    let (mut lo, mut hi) = (0.0, 20.0);
    for _ in 0..50 {
        let mid = 0.5 * (lo + hi);
        if lone(mid).1 > e { lo = mid } else { hi = mid }
    }
    (lone(lo).0, lo)
}

impl Plain {
    /// The body as the lowest point touches.
    pub(crate) fn new(
        points: &[[f64; 2]],
        gyration: f64,
        gravity: f64,
        (law, e, time): (ContactLaw, f64, f64),
    ) -> Self {
        let (omega, theta) = match law {
            ContactLaw::Hysteretic => (0.5 * std::f64::consts::PI * (1.0 + e) / time, 0.0),
            ContactLaw::Dashpot => {
                let (turn, zeta) = if e < 1.0 { dashpot(e) } else { (std::f64::consts::PI, 0.0) };
                (turn / time, 2.0 * zeta * time / turn)
            }
        };
        let away = Point { mode: Mode::Away, stiffness: 0.0, ground: 0.0, deepest: 0.0 };
        Self {
            points: points.to_vec(),
            gyration,
            gravity,
            law,
            e: vec![e; points.len()],
            omega: vec![omega; points.len()],
            theta,
            touching: vec![away; points.len()],
            state: [0.0; 4],
            time: 0.0,
            touches: Vec::new(),
            turned: 0.0,
            left: 0.0,
            fine: 100.0,
            part: None,
        }
    }
    /// With hysteretic contacts of restitutions and times of their own.
    pub(crate) fn with_own(mut self, own: &[(f64, f64)]) -> Self {
        self.e = own.iter().map(|(e, _)| *e).collect();
        self.omega = own.iter().map(|(e, time)| 0.5 * std::f64::consts::PI * (1.0 + e) / time).collect();
        self
    }
    fn fastest(&self) -> f64 {
        self.omega.iter().fold(0.0, |most, omega| most.max(*omega))
    }
    pub(crate) fn start(mut self, speed: f64, tilt: f64, spin: f64) -> Self {
        self.state = [0.0, -speed, tilt, spin];
        self.left = tilt;
        let heights: Vec<f64> = (0..self.points.len()).map(|i| self.height(&self.state, i)).collect();
        let first = (0..heights.len()).fold(0, |low, i| if heights[i] < heights[low] { i } else { low });
        self.state[0] = -heights[first];
        self.touch(first);
        self
    }
    fn lever(&self, s: &State, i: usize) -> f64 {
        let [x, z] = self.points[i];
        x * s[2].cos() - z * s[2].sin()
    }
    pub(crate) fn height(&self, s: &State, i: usize) -> f64 {
        let [x, z] = self.points[i];
        s[0] + x * s[2].sin() + z * s[2].cos()
    }
    pub(crate) fn velocity(&self, s: &State, i: usize) -> f64 {
        s[1] + self.lever(s, i) * s[3]
    }
    /// Depth at which the steeper line of a point has no force, and that of its deepest.
    fn plastic(&self, i: usize) -> f64 {
        self.touching[i].ground + self.touching[i].deepest * (1.0 - self.e[i] * self.e[i])
    }
    fn crest(&self, i: usize) -> f64 {
        self.touching[i].ground + self.touching[i].deepest
    }
    /// Forces on all points over the mass.
    pub(crate) fn forces(&self, s: &State) -> Vec<f64> {
        let mut forces: Vec<f64> = (0..self.points.len())
            .map(|i| {
                let (d, rate, k) = (-self.height(s, i), -self.velocity(s, i), self.touching[i].stiffness);
                match self.touching[i].mode {
                    Mode::Load => k * (d - self.touching[i].ground + self.theta * rate),
                    Mode::Unload => k / (self.e[i] * self.e[i]) * (d - self.plastic(i)),
                    Mode::Away | Mode::Gap | Mode::Held => 0.0,
                }
            })
            .collect();
        let held: Vec<usize> = (0..self.points.len()).filter(|&i| self.touching[i].mode == Mode::Held).collect();
        // The forces that keep the held points where they are.
        let pull = |forces: &[f64], i: usize| -self.acceleration(s, forces, i);
        let share = |i: usize, j: usize| 1.0 + self.lever(s, i) * self.lever(s, j) / self.gyration.powi(2);
        match *held.as_slice() {
            [i] => forces[i] = pull(&forces, i) / share(i, i),
            [i, j] => {
                let (a, b) = (pull(&forces, i), pull(&forces, j));
                let both = share(i, i) * share(j, j) - share(i, j).powi(2);
                forces[i] = (a * share(j, j) - b * share(i, j)) / both;
                forces[j] = (b * share(i, i) - a * share(i, j)) / both;
            }
            _ => {}
        }
        forces
    }
    /// Vertical acceleration of a point under these forces.
    fn acceleration(&self, s: &State, forces: &[f64], i: usize) -> f64 {
        let [x, z] = self.points[i];
        let over = x * s[2].sin() + z * s[2].cos();
        let [_, a, _, turning] = self.rates(s, forces);
        a + self.lever(s, i) * turning - s[3] * s[3] * over
    }
    /// Vertical velocity of a place on the body.
    pub(crate) fn velocity_of(&self, [x, z]: [f64; 2]) -> f64 {
        let (sin, cos) = self.state[2].sin_cos();
        self.state[1] + (x * cos - z * sin) * self.state[3]
    }
    /// Acceleration above free fall of a place on the body.
    pub(crate) fn felt(&self, s: &State, [x, z]: [f64; 2]) -> f64 {
        let (sin, cos) = s[2].sin_cos();
        let [_, a, _, turning] = self.rates(s, &self.forces(s));
        a + self.gravity + (x * cos - z * sin) * turning - s[3] * s[3] * (x * sin + z * cos)
    }
    pub(crate) fn rates(&self, s: &State, forces: &[f64]) -> State {
        let force: f64 = forces.iter().sum();
        let moment: f64 = forces.iter().enumerate().map(|(i, f)| f * self.lever(s, i)).sum();
        [s[1], force - self.gravity, s[3], moment / self.gyration.powi(2)]
    }
    /// The state a step later, by Runge and Kutta's fourth order.
    pub(crate) fn step(&self, s: &State, h: f64) -> State {
        let rate = |s: &State| self.rates(s, &self.forces(s));
        let at = |k: &State, h: f64| std::array::from_fn(|n| s[n] + h * k[n]);
        let a = rate(s);
        let b = rate(&at(&a, 0.5 * h));
        let c = rate(&at(&b, 0.5 * h));
        let d = rate(&at(&c, h));
        std::array::from_fn(|n| s[n] + h / 6.0 * (a[n] + 2.0 * (b[n] + c[n]) + d[n]))
    }
    /// What may happen to a point: positive until it does, and the mode then.
    fn events(&self, s: &State, i: usize) -> [(f64, Mode); 2] {
        let (h, v) = (self.height(s, i), self.velocity(s, i));
        let press = -h - self.theta * v;
        let never = (1.0, Mode::Away);
        let p = self.touching[i];
        let dashpot = self.law == ContactLaw::Dashpot;
        match p.mode {
            Mode::Away => [(h, Mode::Load), never],
            Mode::Load if dashpot => [(press, Mode::Gap), never],
            Mode::Load => [(-v, if self.e[i] > 0.0 { Mode::Unload } else { Mode::Held }), never],
            Mode::Unload => [(-h - self.plastic(i), Mode::Gap), (self.crest(i) + h, Mode::Load)],
            Mode::Held => {
                let force = self.forces(s)[i];
                [(force, Mode::Gap), (p.stiffness * p.deepest - force, Mode::Load)]
            }
            Mode::Gap if dashpot => [(-press, Mode::Load), (-h, Mode::Away)],
            Mode::Gap => [(self.plastic(i) + h, Mode::Load), (-h, Mode::Away)],
        }
    }
    fn touch(&mut self, i: usize) {
        let mu = 1.0 + (self.lever(&self.state, i) / self.gyration).powi(2);
        let dented = self.touching[i].mode == Mode::Gap;
        // A dashpot that has parted presses again from the ground, as stiff as before.
        self.touching[i] = match self.law {
            ContactLaw::Dashpot if dented => Point { mode: Mode::Load, ..self.touching[i] },
            _ => {
                let ground = if dented { self.plastic(i) } else { 0.0 };
                Point { mode: Mode::Load, stiffness: self.omega[i].powi(2) / mu, ground, deepest: 0.0 }
            }
        };
        // A dashpot may press again as it rises ever more slowly.
        self.touches.push(Touch { point: i, time: self.time, approach: self.velocity(&self.state, i).min(0.0) });
    }
    fn happens(&mut self, i: usize, mode: Mode) {
        if mode == Mode::Load && matches!(self.touching[i].mode, Mode::Away | Mode::Gap) {
            self.touch(i);
            return;
        }
        if matches!(mode, Mode::Unload | Mode::Held) && self.touching[i].mode == Mode::Load {
            self.touching[i].deepest = -self.height(&self.state, i) - self.touching[i].ground;
        }
        self.touching[i].mode = mode;
    }
    /// Whether any point presses.
    pub(crate) fn presses(&self) -> bool {
        self.touching.iter().any(|p| !matches!(p.mode, Mode::Away | Mode::Gap))
    }
    /// Whether this point has not risen above the ground since it touched.
    pub(crate) fn is_down(&self, i: usize) -> bool {
        self.touching[i].mode != Mode::Away
    }
    /// Whether this point presses.
    pub(crate) fn is_pressing(&self, i: usize) -> bool {
        !matches!(self.touching[i].mode, Mode::Away | Mode::Gap)
    }
    /// Whether two points stand still under the body, as they do after contacts without restitution.
    pub(crate) fn lies_still(&self) -> bool {
        self.touching.iter().filter(|p| p.mode == Mode::Held).count() > 1
    }
    /// A step short enough for the forces, or for the flight.
    fn length(&self) -> f64 {
        let s = &self.state;
        let size = self.points.iter().fold(0.0_f64, |m, [x, z]| m.max(x.hypot(*z)));
        let turn = 0.01 / (s[3].abs() + 1e-9);
        if !self.presses() {
            let close = (0..self.points.len())
                .map(|i| 0.3 * self.height(s, i).abs() / (self.velocity(s, i).abs() + 1e-9))
                .fold(f64::INFINITY, f64::min);
            return close.clamp(0.01 / self.fastest(), turn.min(0.01 * (size / self.gravity.max(1e-9)).sqrt()));
        }
        let mu = 1.0 + (size / self.gyration).powi(2);
        let stiffest = self
            .touching
            .iter()
            .zip(&self.e)
            .fold(0.0_f64, |m, (p, e)| m.max(p.stiffness * if p.mode == Mode::Unload { e.powi(-2) } else { 1.0 }));
        let rate = (2.0 * stiffest * mu).sqrt();
        (1.0 / (self.fine * rate.max(self.theta * rate * rate))).min(turn)
    }
    /// Goes on until an event, at most a step; then for `until` at most.
    fn advance(&mut self, until: f64) {
        let h = self
            .length()
            .min(until - self.time)
            .min(self.part.map_or(f64::INFINITY, |part| 0.02 / (part.omega * (1.0 + 0.3 * part.zeta))));
        let n = self.points.len();
        let now = self.state;
        let due = |s: &State| (0..n).any(|i| self.events(s, i).iter().any(|(g, _)| *g <= 0.0));
        let mut h = h;
        // A dip below the ground between two steps.
        for i in (0..n).filter(|&i| self.touching[i].mode == Mode::Away) {
            let rate = |h: f64| self.velocity(&self.step(&now, h), i);
            if self.velocity(&now, i) < 0.0 && rate(h) > 0.0 {
                let (mut lo, mut hi) = (0.0, h);
                for _ in 0..60 {
                    let mid = 0.5 * (lo + hi);
                    if rate(mid) < 0.0 { lo = mid } else { hi = mid }
                }
                if self.height(&self.step(&now, hi), i) < 0.0 {
                    h = hi;
                }
            }
        }
        let end = self.step(&now, h);
        if !due(&end) {
            self.carry(&now, h);
            self.state = end;
            self.time += h;
            return;
        }
        let (mut lo, mut hi) = (0.0, h);
        for _ in 0..60 {
            let mid = 0.5 * (lo + hi);
            if due(&self.step(&now, mid)) { hi = mid } else { lo = mid }
        }
        self.carry(&now, hi);
        self.state = self.step(&now, hi);
        self.time += hi;
        let found =
            (0..n).find_map(|i| self.events(&self.state, i).into_iter().find(|(g, _)| *g <= 0.0).map(|(_, m)| (i, m)));
        if let Some((i, mode)) = found {
            self.happens(i, mode);
        }
    }
    fn carry(&mut self, from: &State, h: f64) {
        if let Some(part) = self.part {
            let felt = |h: f64| self.felt(&self.step(from, h), part.place);
            let felt = [0.0, 0.5 * h, h].map(felt);
            if let Some(part) = &mut self.part {
                part.step(felt, h);
            }
        }
    }
    /// Goes on until so many touches, this time, or so many steps.
    pub(crate) fn run(&mut self, touches: usize, until: f64, steps: usize) -> bool {
        for _ in 0..steps {
            if self.touches.len() >= touches || self.time >= until {
                return true;
            }
            self.advance(until);
            if self.presses() {
                self.left = self.state[2];
            }
            self.turned = self.turned.max((self.state[2] - self.left).abs());
        }
        false
    }
}
