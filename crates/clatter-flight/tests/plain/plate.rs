//! A plate of small tilt whose corners press by one of the two contact laws, by classical Runge–Kutta steps: force and two moments,
//! three coordinates, forces straight from the laws, events bisected. It shares nothing with the library.

use clatter_flight::ContactLaw;

use super::{Part, Touch};

/// Height of the center of mass, slopes along x and y, and the rates of all three.
type State = [f64; 6];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Away,
    Load,
    Unload,
    /// Where the steeper line is upright: the corner stands still.
    Held,
    Gap,
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    at: [f64; 2],
    /// Height over the others, where the plate is level.
    over: f64,
    mode: Mode,
    stiffness: f64,
    /// Depths from which a press counts, and of its deepest.
    ground: f64,
    deepest: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct PlainPlate<const N: usize = 4> {
    corners: [Corner; N],
    gyration: [f64; 2],
    gravity: f64,
    law: ContactLaw,
    e: [f64; N],
    omega: [f64; N],
    theta: f64,
    state: State,
    pub(crate) time: f64,
    pub(crate) touches: Vec<Touch>,
    pub(crate) part: Option<Part>,
    /// Steps in one over the fastest rate.
    pub(crate) fine: f64,
}

/// What moves a plate.
#[derive(Clone, Copy)]
pub(crate) struct Drop {
    /// Distances of the edges from the center of mass, \[−x, +x, −y, +y\].
    pub(crate) edges: [f64; 4],
    pub(crate) gyration: [f64; 2],
    pub(crate) gaps: [f64; 2],
    /// Rates of the slopes along x and y as corner a touches.
    pub(crate) spin: [f64; 2],
    pub(crate) speed: f64,
    pub(crate) gravity: f64,
    pub(crate) law: ContactLaw,
    pub(crate) e: f64,
    pub(crate) time: f64,
}

/// Rate and damping ratio of a lone dashpot of this restitution that parts after a time of 1, by bisection of the damping ratio: it
/// parts as force and velocity of the free vibration have it.
fn dashpot(e: f64) -> (f64, f64) {
    // d = sin(νt)/ν e^(−ζt) with ω = 1; it parts where d + 2ζ d′ = 0, with d′ = −e.
    let parts = |zeta: f64| {
        let depth_and_rate = |t: f64| {
            let nu = (1.0 - zeta * zeta).abs().sqrt();
            if zeta < 1.0 {
                let (sin, cos) = (nu * t).sin_cos();
                let depth = (-zeta * t).exp() * sin / nu;
                [depth, (-zeta * t).exp() * cos - zeta * depth]
            } else {
                let [slow, fast] = [nu - zeta, -nu - zeta].map(|rate| (rate, (rate * t).exp() / (2.0 * nu)));
                [slow.1 - fast.1, slow.0 * slow.1 - fast.0 * fast.1]
            }
        };
        let rate = |t: f64| depth_and_rate(t)[1];
        let force = |t: f64| depth_and_rate(t)[0] + 2.0 * zeta * rate(t);
        let (mut lo, mut hi) = (0.0, 1e-3);
        while force(hi) > 0.0 {
            (lo, hi) = (hi, hi * 1.01);
        }
        for _ in 0..80 {
            let mid = 0.5 * (lo + hi);
            if force(mid) > 0.0 { lo = mid } else { hi = mid }
        }
        (hi, -rate(hi))
    };
    let (mut lo, mut hi) = (0.0, 20.0);
    for _ in 0..80 {
        let mid = 0.5 * (lo + hi);
        if parts(mid).1 > e { lo = mid } else { hi = mid }
    }
    (parts(lo).0, lo)
}

impl PlainPlate {
    pub(crate) fn new(drop: &Drop) -> Self {
        let [left, right, front, back] = drop.edges;
        let at = [[-left, -front], [right, -front], [right, back], [-left, back]];
        let (omega, theta) = match drop.law {
            ContactLaw::Hysteretic => (std::f64::consts::FRAC_PI_2 * (1.0 + drop.e) / drop.time, 0.0),
            ContactLaw::Dashpot => {
                let (phase, zeta) = dashpot(drop.e);
                (phase / drop.time, 2.0 * zeta * drop.time / phase)
            }
        };
        let slopes = [drop.gaps[0] / (left + right), drop.gaps[1] / (front + back)];
        let lowest = at.iter().map(|[x, y]| x * slopes[0] + y * slopes[1]).fold(f64::INFINITY, f64::min);
        let corner = |at| Corner { at, over: 0.0, mode: Mode::Away, stiffness: 0.0, ground: 0.0, deepest: 0.0 };
        let mut plate = Self {
            corners: at.map(corner),
            gyration: drop.gyration,
            gravity: drop.gravity,
            law: drop.law,
            e: [drop.e; 4],
            omega: [omega; 4],
            theta,
            state: [-lowest, slopes[0], slopes[1], -drop.speed, drop.spin[0], drop.spin[1]],
            time: 0.0,
            touches: Vec::new(),
            part: None,
            fine: 100.0,
        };
        let low: Vec<usize> =
            (0..4).filter(|&i| plate.height(&plate.state, i) <= 0.0 && plate.velocity(&plate.state, i) < 0.0).collect();
        for i in low {
            plate.touch(i);
        }
        plate
    }
    /// With hysteretic contacts of restitutions and times of their own.
    pub(crate) fn own(drop: &Drop, own: [(f64, f64); 4]) -> Self {
        let mut plate = Self::new(drop);
        plate.e = own.map(|(e, _)| e);
        plate.omega = own.map(|(e, time)| std::f64::consts::FRAC_PI_2 * (1.0 + e) / time);
        let low: Vec<usize> = plate.touches.drain(..).map(|touch| touch.point).collect();
        for i in low {
            plate.touch(i);
        }
        plate
    }
    /// On feet, which are its corners: with edges beyond them so far along x and along y, and so high over them; all have contacts of their
    /// own.
    pub(crate) fn on_feet(drop: &Drop, [x, y]: [f64; 2], height: f64, own: [(f64, f64); 8]) -> PlainPlate<8> {
        let Self { corners, gyration, gravity, law, e, omega, theta, state, touches, .. } = Self::new(drop);
        let edge = |corner: Corner| {
            let [a, b] = corner.at;
            Corner { at: [a + x.copysign(a), b + y.copysign(b)], over: height, mode: Mode::Away, ..corner }
        };
        let is_own = law == ContactLaw::Hysteretic;
        let omegas = own.map(|(e, time)| std::f64::consts::FRAC_PI_2 * (1.0 + e) / time);
        let mut plate = PlainPlate {
            corners: std::array::from_fn(|i| if i < 4 { corners[i] } else { edge(corners[i - 4]) }),
            gyration,
            gravity,
            law,
            e: if is_own { own.map(|(e, _)| e) } else { [e[0]; 8] },
            omega: if is_own { omegas } else { [omega[0]; 8] },
            theta,
            state,
            time: 0.0,
            touches: Vec::new(),
            part: None,
            fine: 100.0,
        };
        for touch in touches {
            plate.touch(touch.point);
        }
        plate
    }
}

impl<const N: usize> PlainPlate<N> {
    fn height(&self, s: &State, i: usize) -> f64 {
        s[0] + s[1] * self.corners[i].at[0] + s[2] * self.corners[i].at[1] + self.corners[i].over
    }
    fn velocity(&self, s: &State, i: usize) -> f64 {
        s[3] + s[4] * self.corners[i].at[0] + s[5] * self.corners[i].at[1]
    }
    pub(crate) fn heights(&self) -> [f64; N] {
        std::array::from_fn(|i| self.height(&self.state, i))
    }
    pub(crate) fn velocities(&self) -> [f64; N] {
        std::array::from_fn(|i| self.velocity(&self.state, i))
    }
    /// Of all corners; those that are held have what keeps them where they are.
    fn forces(&self, s: &State) -> [f64; N] {
        let mut forces: [f64; N] = std::array::from_fn(|i| self.pressed(s, i));
        let held: Vec<usize> = (0..N).filter(|&i| self.corners[i].mode == Mode::Held).collect();
        // Rows of (what a force at j does to i | what is missing), by Gauss.
        let moves = |f: &[f64; N], i: usize| {
            let [.., a, x, y] = self.rates_by(s, f);
            a + x * self.corners[i].at[0] + y * self.corners[i].at[1]
        };
        let unit = |j: usize| std::array::from_fn(|k| f64::from(u8::from(k == j)));
        let n = held.len().min(3);
        let mut rows: Vec<Vec<f64>> = held[..n]
            .iter()
            .map(|&i| {
                let by = |j: &usize| moves(&unit(*j), i) + self.gravity;
                held[..n].iter().map(by).chain([-moves(&forces, i)]).collect()
            })
            .collect();
        for p in 0..n {
            let pivot = rows[p].clone();
            for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != p) {
                let share = row[p] / pivot[p];
                row.iter_mut().zip(&pivot).for_each(|(of, from)| *of -= share * from);
            }
        }
        for (p, &i) in held[..n].iter().enumerate() {
            forces[i] = rows[p][n] / rows[p][p];
        }
        forces
    }
    /// Whether so many corners stand still that the plate does.
    pub(crate) fn lies_still(&self) -> bool {
        self.corners.iter().filter(|corner| corner.mode == Mode::Held).count() > 2
    }
    fn pressed(&self, s: &State, i: usize) -> f64 {
        let (corner, depth, sinking) = (&self.corners[i], -self.height(s, i), -self.velocity(s, i));
        match corner.mode {
            Mode::Load => corner.stiffness * (depth - corner.ground + self.theta * sinking),
            Mode::Unload => corner.stiffness / (self.e[i] * self.e[i]) * (depth - self.rest(i)),
            Mode::Away | Mode::Held | Mode::Gap => 0.0,
        }
    }
    /// Depth at which the steeper line has no force.
    fn rest(&self, i: usize) -> f64 {
        self.corners[i].ground + self.corners[i].deepest * (1.0 - self.e[i] * self.e[i])
    }
    fn rates(&self, s: &State) -> State {
        self.rates_by(s, &self.forces(s))
    }
    fn rates_by(&self, s: &State, forces: &[f64; N]) -> State {
        let (mut force, mut moments) = (0.0, [0.0; 2]);
        for (i, f) in forces.iter().enumerate() {
            force += f;
            moments[0] += f * self.corners[i].at[0];
            moments[1] += f * self.corners[i].at[1];
        }
        let turn = |k: usize| moments[k] / self.gyration[k].powi(2);
        [s[3], s[4], s[5], force - self.gravity, turn(0), turn(1)]
    }
    fn step(&self, s: &State, h: f64) -> State {
        let at = |k: &State, h: f64| std::array::from_fn(|n| s[n] + h * k[n]);
        let a = self.rates(s);
        let b = self.rates(&at(&a, 0.5 * h));
        let c = self.rates(&at(&b, 0.5 * h));
        let d = self.rates(&at(&c, h));
        std::array::from_fn(|n| s[n] + h / 6.0 * (a[n] + 2.0 * (b[n] + c[n]) + d[n]))
    }
    /// What may happen to a corner: negative once it has, and the mode then.
    fn events(&self, s: &State, i: usize) -> [(f64, Mode); 2] {
        let (h, v, corner) = (self.height(s, i), self.velocity(s, i), &self.corners[i]);
        let never = (1.0, Mode::Away);
        let press = -h - corner.ground - self.theta * v;
        match (corner.mode, self.law) {
            (Mode::Away, _) => [(h, Mode::Load), never],
            (Mode::Load, ContactLaw::Dashpot) => [(press, Mode::Gap), never],
            (Mode::Load, ContactLaw::Hysteretic) => {
                [(-v, if self.e[i] > 0.0 { Mode::Unload } else { Mode::Held }), never]
            }
            (Mode::Held, _) => {
                let force = self.forces(s)[i];
                [(force, Mode::Gap), (corner.stiffness * corner.deepest - force, Mode::Load)]
            }
            (Mode::Unload, _) => [(-h - self.rest(i), Mode::Gap), (corner.ground + corner.deepest + h, Mode::Load)],
            (Mode::Gap, ContactLaw::Dashpot) => [(-press, Mode::Load), (-h, Mode::Away)],
            (Mode::Gap, ContactLaw::Hysteretic) => [(self.rest(i) + h, Mode::Load), (-h, Mode::Away)],
        }
    }
    fn touch(&mut self, i: usize) {
        let dented = self.corners[i].mode == Mode::Gap;
        let ground = if dented && self.law == ContactLaw::Hysteretic { self.rest(i) } else { 0.0 };
        let [x, y] = self.corners[i].at;
        let lone = 1.0 + (x / self.gyration[0]).powi(2) + (y / self.gyration[1]).powi(2);
        let stiffness = self.omega[i].powi(2) / lone;
        self.corners[i] = Corner { mode: Mode::Load, stiffness, ground, deepest: 0.0, ..self.corners[i] };
        self.touches.push(Touch { point: i, time: self.time, approach: self.velocity(&self.state, i).min(0.0) });
    }
    fn happens(&mut self, i: usize, mode: Mode) {
        let from = self.corners[i].mode;
        if mode == Mode::Load && matches!(from, Mode::Away | Mode::Gap) {
            return self.touch(i);
        }
        if matches!(mode, Mode::Unload | Mode::Held) {
            self.corners[i].deepest = -self.height(&self.state, i) - self.corners[i].ground;
        }
        self.corners[i].mode = mode;
    }
    fn length(&self) -> f64 {
        let pressing = |corner: &Corner| matches!(corner.mode, Mode::Load | Mode::Unload | Mode::Held);
        let mut rate = 0.0_f64;
        for (i, corner) in self.corners.iter().enumerate().filter(|(_, corner)| pressing(corner)) {
            let lone = self.omega[i] * if corner.mode == Mode::Unload { 1.0 / self.e[i] } else { 1.0 };
            rate = rate.max(2.0 * lone).max(4.0 * self.theta * lone * lone);
        }
        if rate > 0.0 {
            return 1.0 / (self.fine * rate);
        }
        let close = (0..N)
            .map(|i| 0.3 * self.height(&self.state, i).abs() / (self.velocity(&self.state, i).abs() + 1e-9))
            .fold(f64::INFINITY, f64::min);
        close.clamp(0.01 / self.omega.into_iter().fold(0.0, f64::max), 1e-3)
    }
    fn advance(&mut self, until: f64) {
        let of_part = self.part.map_or(f64::INFINITY, |part| 0.02 / part.omega);
        let mut h = self.length().min(until - self.time).min(of_part);
        let now = self.state;
        let due = |s: &State| (0..N).any(|i| self.events(s, i).iter().any(|(g, _)| *g < 0.0));
        // A dip below the ground between two steps: to its lowest.
        for i in (0..N).filter(|&i| self.corners[i].mode == Mode::Away && self.velocity(&now, i) < 0.0) {
            let rate = |h: f64| self.velocity(&self.step(&now, h), i);
            if rate(h) > 0.0 {
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
        if due(&self.step(&now, h)) {
            let (mut lo, mut hi) = (0.0, h);
            for _ in 0..60 {
                let mid = 0.5 * (lo + hi);
                if due(&self.step(&now, mid)) { hi = mid } else { lo = mid }
            }
            h = hi;
        }
        if let Some(mut part) = self.part {
            let felt = |h: f64| {
                let [.., a, x, y] = self.rates(&self.step(&now, h));
                a + self.gravity + x * part.place[0] + y * part.place[1]
            };
            part.step([0.0, 0.5 * h, h].map(felt), h);
            self.part = Some(part);
        }
        self.state = self.step(&now, h);
        self.time += h;
        let due = |i: usize| self.events(&self.state, i).into_iter().find(|(g, _)| *g < 0.0).map(|(_, m)| (i, m));
        if let Some((i, mode)) = (0..N).find_map(due) {
            self.happens(i, mode);
        }
    }
    /// Goes on until this time, until it lies still, or so many steps.
    pub(crate) fn run(&mut self, until: f64, steps: usize) -> bool {
        for _ in 0..steps {
            if self.time >= until || self.lies_still() {
                return true;
            }
            self.advance(until);
        }
        false
    }
}
