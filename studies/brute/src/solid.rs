//! One drop of a box in space, integrated in small steps in axes of the world: full rotation, gravity, forces at the eight corners, with
//! Coulomb friction that is cut back to its circle in each step.

use crate::flight::{Flight, Step, Until};
use crate::ground::{Contact, Ground, Law, Own, Phase, fine};
use crate::part::{Push, Shock, pulses};

/// A vector.
pub type Vector = [f64; 3];
type Matrix = [Vector; 3];

/// A box at the moment when its lowest corner touches the ground; SI units. Its axes run along
/// length, width and thickness.
#[derive(Debug, Clone, Copy)]
pub struct Solid {
    /// Length, width and thickness.
    pub sides: Vector,
    /// Center of mass from the middle.
    pub center: Vector,
    /// Radii of gyration about the three axes.
    pub radii: Vector,
    /// The mean of x y over its mass, about the center of mass.
    pub askew: f64,
    /// Restitution of the corners.
    pub e: f64,
    /// Law and time of a lone contact.
    pub contact: (Law, f64),
    /// Own contacts of the corners (−, −), (+, −), (+, +) and (−, +) of its bottom.
    pub own: [Own; 4],
    /// Speed of the center of mass.
    pub speed: f64,
    /// Angular velocity, in axes of the box.
    pub spin: Vector,
    /// Vertical in axes of the box.
    pub upward: Vector,
    /// Gravity.
    pub gravity: f64,
    /// Coefficient of friction of the ground.
    pub friction: f64,
}

/// Accelerations above free fall in a step, in axes of the box: at begin, middle and end, that of the center of mass
/// and its increase per meter along each axis.
#[derive(Debug, Clone, Copy)]
struct Moment {
    time: f64,
    length: f64,
    flying: bool,
    accelerations: [(Vector, Matrix); 3],
    /// Vertical in axes of the box.
    up: [Vector; 3],
}

/// A followed drop.
#[derive(Debug, Clone)]
pub struct Course {
    moments: Vec<Moment>,
    /// End of the integration.
    pub end: f64,
    at_rest: bool,
    gravity: f64,
    /// Vertical in axes of the box at the end.
    upward: Vector,
    /// Corners in the order of their first touches.
    pub order: Vec<usize>,
    /// Largest gain of energy, as a share of that of the drop: only the error of the integration.
    pub gain: f64,
}

/// Height and velocity of the center of mass, then the attitude (its rows: axes of the world in those of the box), then the angular
/// momentum in axes of the world, and the velocity of the center of mass along the ground.
type State = [f64; 16];

/// Stiffness of a contact along the ground over that across it.
const ALONG: f64 = 0.8;

/// Angle of rotation per step of free flight, in radians.
const TURN: f64 = 0.05;
/// The largest number of steps; a drop is followed no further.
const MOST_STEPS: usize = 400_000;
/// Height from which on a corner is down.
const DOWN: f64 = 1e-12;

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: Vector) -> Vector {
    let size = dot(a, a).sqrt();
    a.map(|x| x / size)
}

/// Returns a vector in axes of the world.
fn out(r: &Matrix, body: Vector) -> Vector {
    r.map(|row| dot(row, body))
}

/// Returns a vector in axes of the box.
fn back(r: &Matrix, world: Vector) -> Vector {
    std::array::from_fn(|j| r[0][j] * world[0] + r[1][j] * world[1] + r[2][j] * world[2])
}

struct Body {
    solid: Solid,
    corners: [Vector; 8],
    grounds: [Ground; 8],
    contacts: [Contact; 8],
    /// How far each corner that presses has been stretched along the ground.
    stretches: [[f64; 2]; 8],
}

impl Body {
    fn new(solid: &Solid) -> Self {
        let corner = |k: usize| -> Vector {
            std::array::from_fn(|i| {
                let sign = if k >> i & 1 == 1 { 0.5 } else { -0.5 };
                sign * solid.sides[i] - solid.center[i]
            })
        };
        Self {
            solid: *solid,
            corners: std::array::from_fn(corner),
            grounds: Ground::own(
                Some(solid.contact),
                solid.e,
                &std::array::from_fn::<Own, 8, _>(|k| solid.own[[0, 1, 3, 2][k & 3]]),
            ),
            contacts: [Contact::default(); 8],
            stretches: [[0.0; 2]; 8],
        }
    }

    fn start(&self) -> State {
        let up = unit(self.solid.upward);
        let mut first = [0.0; 3];
        first[(0..3).min_by(|&i, &j| up[i].abs().total_cmp(&up[j].abs())).unwrap_or(0)] = 1.0;
        let x = unit(cross(first, up));
        let y = cross(up, x);
        let lowest = self.corners.iter().map(|&c| dot(up, c)).fold(f64::INFINITY, f64::min);
        let mut s = [0.0; 16];
        (s[0], s[1]) = (-lowest, -self.solid.speed);
        for (i, x) in x.into_iter().chain(y).chain(up).enumerate() {
            s[2 + i] = x;
        }
        let ([a, b, c], [u, v, w], off) = (self.solid.radii.map(|k| k * k), self.solid.spin, -self.solid.askew);
        let momentum = out(&[x, y, up], [a * u + off * v, off * u + b * v, c * w]);
        s[11..14].copy_from_slice(&momentum);
        s
    }

    fn attitude(s: &State) -> Matrix {
        [[s[2], s[3], s[4]], [s[5], s[6], s[7]], [s[8], s[9], s[10]]]
    }

    /// Returns the attitude, and the angular velocity in axes of the world.
    fn turning(&self, s: &State) -> (Matrix, Vector) {
        let r = Self::attitude(s);
        let spin = back(&r, [s[11], s[12], s[13]]);
        (r, out(&r, self.over(spin)))
    }

    /// Returns a torque over the moments of inertia (over the mass), in axes of the box, by Gauss' elimination.
    fn over(&self, torque: Vector) -> Vector {
        let [a, b, c] = self.solid.radii.map(|k| k * k);
        let off = -self.solid.askew;
        let y = (torque[1] - off / a * torque[0]) / (b - off / a * off);
        [(torque[0] - off * y) / a, y, torque[2] / c]
    }

    /// Returns the angular acceleration by a torque in axes of the world.
    fn turned(&self, r: &Matrix, torque: Vector) -> Vector {
        let own = back(r, torque);
        out(r, self.over(own))
    }

    /// Returns height, velocity and mobility of a corner.
    fn corner(&self, k: usize, s: &State) -> (f64, f64, f64) {
        let (r, w) = self.turning(s);
        let arm = out(&r, self.corners[k]);
        let lever = [arm[1], -arm[0], 0.0];
        (s[0] + arm[2], s[1] + dot(w, lever), 1.0 + dot(lever, self.turned(&r, lever)))
    }

    fn force(&self, k: usize, s: &State) -> f64 {
        let c = &self.contacts[k];
        if c.phase == Phase::Free {
            return 0.0;
        }
        let (height, velocity, _) = self.corner(k, s);
        c.force(&self.grounds[k], height, velocity)
    }

    /// Returns the velocity of a corner along the ground.
    fn slides(&self, k: usize, s: &State) -> [f64; 2] {
        let (r, w) = self.turning(s);
        let moved = cross(w, out(&r, self.corners[k]));
        [s[14] + moved[0], s[15] + moved[1]]
    }

    /// Returns the stretch of a corner after a time from which on it moves as in this state, within its circle.
    fn stretched(&self, k: usize, s: &State, force: f64, time: f64) -> [f64; 2] {
        let (u, old) = (self.slides(k, s), self.stretches[k]);
        let on = [old[0] + time * u[0], old[1] + time * u[1]];
        let (size, most) =
            (on[0].hypot(on[1]), self.solid.friction * force.max(0.0) / (ALONG * self.contacts[k].stiffness));
        if size > most { on.map(|x| x * most / size) } else { on }
    }

    /// Returns the force of the ground on the mass, and its torque about the center of mass, a time after the begin of the step.
    fn pushed(&self, s: &State, time: f64) -> (Vector, Vector) {
        let r = Self::attitude(s);
        let (mut push, mut torque) = ([0.0; 3], [0.0; 3]);
        for k in 0..8 {
            let up = self.force(k, s);
            if up != 0.0 {
                let mut force = [0.0, 0.0, up];
                if self.solid.friction > 0.0 {
                    let [x, y] = self.stretched(k, s, up, time).map(|x| -ALONG * self.contacts[k].stiffness * x);
                    (force[0], force[1]) = (x, y);
                }
                let turns = cross(out(&r, self.corners[k]), force);
                (0..3).for_each(|i| {
                    push[i] += force[i];
                    torque[i] += turns[i];
                });
            }
        }
        (push, torque)
    }

    /// Keeps the stretches of corners that press, after a step to this state.
    fn stretch(&mut self, from: &State, to: &State, h: f64) {
        let middle: State = std::array::from_fn(|i| f64::midpoint(from[i], to[i]));
        self.stretches = std::array::from_fn(|k| {
            if self.contacts[k].phase == Phase::Free {
                [0.0; 2]
            } else {
                self.stretched(k, &middle, self.force(k, to), h)
            }
        });
    }

    fn rate(&self, s: &State, time: f64) -> State {
        let ((r, w), (push, torque)) = (self.turning(s), self.pushed(s, time));
        let mut rate = [0.0; 16];
        (rate[0], rate[1]) = (s[1], push[2] - self.solid.gravity);
        (rate[14], rate[15]) = (push[0], push[1]);
        for j in 0..3 {
            let turned = cross(w, [r[0][j], r[1][j], r[2][j]]);
            for i in 0..3 {
                rate[2 + 3 * i + j] = turned[i];
            }
        }
        rate[11..14].copy_from_slice(&torque);
        rate
    }

    /// Makes a step of Runge and Kutta.
    fn step(&self, s: &State, h: f64) -> State {
        let along = |rate: &State, h: f64| -> State { std::array::from_fn(|i| s[i] + h * rate[i]) };
        let k1 = self.rate(s, 0.0);
        let k2 = self.rate(&along(&k1, h / 2.0), h / 2.0);
        let k3 = self.rate(&along(&k2, h / 2.0), h / 2.0);
        let k4 = self.rate(&along(&k3, h), h);
        let mut next = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        Self::squared(&mut next);
        next
    }

    /// Makes the rows of the attitude orthonormal again.
    fn squared(s: &mut State) {
        let r = Self::attitude(s);
        let x = unit(r[0]);
        let z = unit(cross(x, r[1]));
        for (i, x) in x.into_iter().chain(cross(z, x)).chain(z).enumerate() {
            s[2 + i] = x;
        }
    }

    /// Returns the acceleration above free fall: of the center of mass, and its increase per meter along each axis of
    /// the box (its columns).
    fn accelerations(&self, s: &State, time: f64) -> (Vector, Matrix) {
        let ((r, w), (push, torque)) = (self.turning(s), self.pushed(s, time));
        let spun = cross(w, [s[11], s[12], s[13]]);
        let bend = self.turned(&r, std::array::from_fn(|i| torque[i] - spun[i]));
        let lift = std::array::from_fn(|j| {
            let axis = [r[0][j], r[1][j], r[2][j]];
            let (by_bend, by_turn) = (cross(bend, axis), cross(w, cross(w, axis)));
            back(&r, std::array::from_fn(|i| by_bend[i] + by_turn[i]))
        });
        (back(&r, push), lift)
    }

    fn energy(&self, s: &State) -> f64 {
        let (_, w) = self.turning(s);
        let stored = |k: usize| {
            let (height, velocity, _) = self.corner(k, s);
            self.contacts[k].stored(&self.grounds[k], height, velocity)
        };
        let kinetic = 0.5 * (s[1] * s[1] + s[14] * s[14] + s[15] * s[15] + dot(w, [s[11], s[12], s[13]]));
        kinetic + self.solid.gravity * s[0] + (0..8).map(stored).sum::<f64>()
    }

    /// Returns a time in which no corner can come to the ground, in free flight.
    fn clear(&self, s: &State) -> f64 {
        let [a, b, c] = self.solid.radii.map(|k| k * k);
        // This is the square of the smallest radius of gyration.
        let least = (0.5 * (a + b) - (0.5 * (a - b)).hypot(self.solid.askew)).min(c);
        let fastest = dot([s[11], s[12], s[13]], [s[11], s[12], s[13]]).sqrt() / least;
        let one = |k: usize| {
            let (height, velocity, _) = self.corner(k, s);
            if velocity < 0.0 && height <= DOWN {
                return 0.0;
            }
            let reach = dot(self.corners[k], self.corners[k]).sqrt();
            // Turning accelerates a corner by the squared rate at most, and the change of the axis by as much again.
            let bend = self.solid.gravity + 2.0 * reach * fastest * fastest;
            let root = (velocity * velocity + 2.0 * bend * height.max(0.0)).sqrt();
            if velocity > 0.0 { (velocity + root) / bend } else { 2.0 * height.max(0.0) / (root - velocity) }
        };
        (0..8).map(one).fold(TURN / fastest, f64::min)
    }
}

/// Follows a drop.
#[must_use]
pub fn follow(solid: &Solid, until: Until) -> Course {
    let mut body = Body::new(solid);
    let mut s = body.start();
    let (mut moments, mut order) = (Vec::new(), Vec::new());
    let (mut time, mut gain, mut at_rest) = (0.0, 0.0_f64, false);
    let whole = 0.5 * solid.speed * solid.speed;
    let longest = solid.own.iter().map(|own| own.time.unwrap_or(solid.contact.1)).fold(0.0, f64::max);
    let mut moved = 0.0;
    let mut least = body.energy(&s);
    while time < until.time && moments.len() < MOST_STEPS {
        let mut over = [false; 8];
        let flying = body.contacts.iter().all(Contact::is_up);
        let (h, next) = if flying {
            let clear = body.clear(&s);
            over = std::array::from_fn(|k| {
                let (height, velocity, _) = body.corner(k, &s);
                height <= DOWN && velocity < 0.0
            });
            if over.contains(&true) {
                (0.0, s)
            } else {
                let h = clear.max(1e-12).min(until.time - time);
                (h, body.step(&s, h))
            }
        } else {
            let points: Vec<_> = (0..8)
                .map(|k| {
                    let (height, velocity, mobility) = body.corner(k, &s);
                    (body.contacts[k], body.grounds[k], height, velocity, mobility)
                })
                .collect();
            let room = |k: usize, s: &State| {
                let (height, velocity, _) = body.corner(k, s);
                body.contacts[k].room(&body.grounds[k], height, velocity)
            };
            let mut h = fine(&points, solid.gravity).min(until.time - time);
            let mut next = body.step(&s, h);
            if (0..8).any(|k| room(k, &next) < 0.0) {
                let (mut low, mut high) = (0.0, h);
                for _ in 0..44 {
                    h = f64::midpoint(low, high);
                    let next = body.step(&s, h);
                    if (0..8).any(|k| room(k, &next) < 0.0) { high = h } else { low = h }
                }
                h = high;
                next = body.step(&s, h);
                over = std::array::from_fn(|k| room(k, &next) < 0.0);
            }
            (h, next)
        };
        if h > 0.0 {
            let (from, to) = (body.rate(&s, 0.0), body.rate(&next, h));
            let middle: State = std::array::from_fn(|i| f64::midpoint(s[i], next[i]) + h / 8.0 * (from[i] - to[i]));
            let all = [(&s, 0.0), (&middle, h / 2.0), (&next, h)];
            let (accelerations, up) =
                (all.map(|(s, time)| body.accelerations(s, time)), all.map(|(s, _)| Body::attitude(s)[2]));
            let flying = body.contacts.iter().all(|contact| contact.phase == Phase::Free);
            moments.push(Moment { time, length: h, flying, accelerations, up });
        }
        body.stretch(&s, &next, h);
        (s, time) = (next, time + h);
        for k in (0..8).filter(|&k| over[k]) {
            let (height, _, mobility) = body.corner(k, &s);
            if body.contacts[k].advance(&body.grounds[k], height, mobility) {
                body.stretches[k] = [0.0; 2];
                if !order.contains(&k) {
                    order.push(k);
                }
            }
        }
        least = least.min(body.energy(&s));
        gain = gain.max((body.energy(&s) - least) / whole);
        let slow = until.quiet * solid.speed;
        let (_, w) = body.turning(&s);
        let slides = s[14] * s[14] + s[15] * s[15];
        let still = s[1] * s[1] + slides + dot(w, [s[11], s[12], s[13]]) < slow * slow;
        if !still {
            moved = time;
        }
        // At the crest of a flat landing it is still for a moment.
        let down = body.contacts.iter().filter(|c| c.phase != Phase::Free).count();
        if time - moved > longest && down > 2 {
            at_rest = true;
            break;
        }
    }
    let upward = Body::attitude(&s)[2];
    Course { moments, end: time, at_rest, gravity: solid.gravity, upward, order, gain }
}

impl Course {
    /// Returns the history of a place from the center of mass along an axis of the box, or of its magnitude.
    #[must_use]
    pub fn at(&self, place: Vector, axis: Option<usize>) -> Flight {
        let seen = |acceleration: &(Vector, Matrix)| size(there(acceleration, place), axis);
        let step = |moment: &Moment| Step {
            time: moment.time,
            length: moment.length,
            flying: moment.flying,
            push: [0, 1, 2].map(|j| seen(&moment.accelerations[j])),
            lift: [0.0; 3],
            turn: [0.0; 3],
        };
        let along = axis.map_or(1.0, |axis| self.upward[axis]);
        Flight {
            steps: self.moments.iter().map(step).collect(),
            end: self.end,
            at_rest: self.at_rest,
            gravity: self.gravity * along,
            ..Flight::default()
        }
    }

    /// Returns the shocks of a place from the center of mass along an axis of the box, or along any: velocities change
    /// by the acceleration above free fall, less gravity, which has its share along each axis.
    #[must_use]
    pub fn shocks(&self, place: Vector, axis: Option<usize>) -> Vec<Shock> {
        let push = |moment: &Moment| {
            let acceleration: [Vector; 3] = [0, 1, 2].map(|j| there(&moment.accelerations[j], place));
            let moved = [0, 1, 2].map(|i| {
                let counts = axis.is_none_or(|axis| axis == i);
                [0, 1, 2].map(|j| if counts { acceleration[j][i] - self.gravity * moment.up[j][i] } else { 0.0 })
            });
            Push {
                time: moment.time,
                length: moment.length,
                acceleration: acceleration.map(|acceleration| size(acceleration, axis)),
                moved,
            }
        };
        let pushes: Vec<Push> = self.moments.iter().filter(|moment| !moment.flying).map(push).collect();
        pulses(&pushes, 2.0 * self.gravity)
    }
}

/// Returns the acceleration above free fall at a place.
fn there((center, lift): &(Vector, Matrix), place: Vector) -> Vector {
    std::array::from_fn(|i| center[i] + place[0] * lift[0][i] + place[1] * lift[1][i] + place[2] * lift[2][i])
}

/// Returns the component along an axis, or the magnitude.
fn size(acceleration: Vector, axis: Option<usize>) -> f64 {
    axis.map_or_else(|| dot(acceleration, acceleration).sqrt(), |axis| acceleration[axis])
}
