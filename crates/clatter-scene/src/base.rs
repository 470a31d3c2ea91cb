//! One drop by one model of the bar, and what it does at a place of the product.

use clatter::End;
use clatter::flight::{Body, CompliantFlight, Flight, Model, Scene};
use clatter_shock::{Pulse, Pulses, Response, Shape, Suspension, VelocityShock, VelocityShocks};

use crate::{BarModel, Error, Product};

/// A single drop of a product.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleDrop {
    /// The end that touches first.
    pub first: End,
    /// Angle to the ground at the first touch, in rad.
    pub tilt_rad: f64,
    /// Speed at the first touch, in m/s.
    pub speed_m_s: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Gravity, in m/s².
    pub gravity_m_s2: f64,
}

/// What one drop does to a product: velocity shocks or whole pulses, at any place.
#[derive(Debug, Clone)]
pub struct Base {
    /// −1 where the product was turned around so that its end b touches first.
    turn: f64,
    length_m: f64,
    /// Contacts that follow one another without overlap: begin, and jumps of the velocities of both ends.
    shocks: Vec<(f64, [f64; 2])>,
    /// How long each takes, where that is modeled.
    contact_time_s: Option<f64>,
    /// Times and accelerations of both ends while they touch, relative to free fall.
    history: Vec<(f64, [f64; 2])>,
}

/// Strikes at the end of a drop that are all below this share of the largest are left out.
const WEAK: f64 = 2e-4;
/// The same of contacts that take time, each of which costs a hundred times as much.
const WEAK_CONTACT: f64 = 5e-3;
/// Samples of a contact. Straight lines between them lose (π/16)²/12 = 0.3 % of a half-sine, which is given back.
const SAMPLES: u32 = 16;

/// Strikes to be followed until they are weak: approach speeds fall by √e a strike or, in an endless train, by its root λ₊.
fn most_strikes(product: &Product, e: f64, weak: f64) -> usize {
    let t = product.inertia_ratio() * (1.0 + e);
    let root = 0.5 * (t + (t * t - 4.0 * e).max(0.0).sqrt());
    let strikes = (weak.ln() / root.max(e.sqrt()).clamp(1e-3, 0.985).ln()).ceil();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within [1, 600]")]
    let strikes = strikes as usize;
    8 + strikes
}

impl Base {
    /// Follows one drop.
    ///
    /// # Errors
    /// [`Error::Bar`] for a drop that the model does not take.
    pub fn new(product: &Product, drop: &SingleDrop, model: BarModel) -> Result<Self, Error> {
        let [a, b] = product.body.arms_m();
        let (body, turn) = match drop.first {
            End::A => (product.body, 1.0),
            End::B => (Body::off_center(b, a, product.body.gyration_m())?, -1.0),
        };
        let tilt_deg = drop.tilt_rad.to_degrees();
        let scene = Scene::new(body, drop.restitution, drop.speed_m_s, tilt_deg, drop.gravity_m_s2)?;
        let mut base =
            Self { turn, length_m: body.length_m(), shocks: Vec::new(), contact_time_s: None, history: Vec::new() };
        let limited = scene.with_impact_limit(most_strikes(product, drop.restitution, WEAK))?;
        match (model, product.contact_time_s) {
            (BarModel::Compliant, Some(time)) => {
                // Below 0.01 the contact law has no fit; the difference in rebound is as small.
                let e = drop.restitution.max(0.01);
                let scene = Scene::new(body, e, drop.speed_m_s, tilt_deg, drop.gravity_m_s2)?;
                base.follow(
                    &scene.with_impact_limit(most_strikes(product, e, WEAK_CONTACT))?.simulate_compliant(time)?,
                    drop.gravity_m_s2,
                    time,
                );
            }
            (BarModel::Map, time) => base.strikes(&limited.simulate(Model::Map), time),
            (BarModel::Ballistic, time) => base.strikes(&limited.simulate(Model::Ballistic), time),
            (BarModel::FiniteTilt | BarModel::Compliant, time) => {
                base.strikes(&limited.simulate(Model::FiniteTilt), time);
            }
        }
        Ok(base)
    }

    /// The same drop with the other end first, of a symmetric product.
    pub(crate) fn turned(&self) -> Self {
        Self { turn: -self.turn, ..self.clone() }
    }

    /// Leaves out what is weak at the end.
    fn cut(&mut self, weak: f64) {
        let size = |v: &[f64; 2]| v[0].abs().max(v[1].abs());
        let largest = self.shocks.iter().fold(0.0_f64, |most, (_, v)| most.max(size(v)));
        let kept = self.shocks.iter().rposition(|(_, v)| size(v) >= weak * largest).map_or(0, |last| last + 1);
        self.shocks.truncate(kept.max(1));
    }

    fn strikes(&mut self, flight: &Flight, contact_time_s: Option<f64>) {
        self.contact_time_s = contact_time_s;
        // Strikes closer than the resolution of time may come out of order by a rounding.
        let mut last = 0.0_f64;
        self.shocks = flight
            .strikes
            .iter()
            .map(|s| {
                last = last.max(s.time_s);
                (last, s.delta_v_m_s)
            })
            .collect();
        self.cut(WEAK);
    }

    /// Contacts of a compliant flight: those that overlap in time are one shock.
    fn follow(&mut self, flight: &CompliantFlight, gravity_m_s2: f64, contact_time_s: f64) {
        let end = flight.flight.stop.time_s();
        let mut contacts: Vec<[f64; 2]> = Vec::new();
        for (strike, pulse) in flight.flight.strikes.iter().zip(&flight.pulses) {
            // One that never ends is the weight of the product at rest.
            let until = pulse.until_s.min(end.max(pulse.from_s)).min(pulse.from_s + 8.0 * contact_time_s);
            match (contacts.last_mut(), self.shocks.last_mut()) {
                (Some(contact), Some((_, delta_v))) if pulse.from_s < contact[1] => {
                    contact[1] = contact[1].max(until);
                    delta_v[0] += strike.delta_v_m_s[0];
                    delta_v[1] += strike.delta_v_m_s[1];
                }
                _ => {
                    contacts.push([pulse.from_s, until]);
                    self.shocks.push((strike.time_s, strike.delta_v_m_s));
                }
            }
        }
        self.cut(WEAK_CONTACT);
        for (&[from, until], (_, delta_v)) in contacts.iter().zip(&self.shocks) {
            // Touches and partings within are corners of the history, a touch with a dashpot a jump.
            let inside = |t: &f64| *t > from && *t < until;
            let mut cuts: Vec<f64> = flight.pulses.iter().flat_map(|p| [p.from_s, p.until_s]).filter(inside).collect();
            cuts.sort_by(f64::total_cmp);
            cuts.push(until);
            let begin = self.history.len();
            self.history.push((from, [0.0; 2]));
            let mut start = from;
            for cut in cuts {
                let pieces = if cut - start < 0.5 * contact_time_s { SAMPLES / 2 } else { SAMPLES };
                for i in 0..=pieces {
                    // Just inside both ends of the piece.
                    let share = (f64::from(i) / f64::from(pieces)).clamp(1e-6, 1.0 - 1e-6);
                    let a = flight.sample(start + share * (cut - start)).acceleration_m_s2;
                    let time = start + f64::from(i) / f64::from(pieces) * (cut - start);
                    self.history.push((time, a.map(|a| a + gravity_m_s2)));
                }
                start = cut;
            }
            self.history.push((until, [0.0; 2]));
            // What straight lines have lost of the velocity change.
            for end in 0..2 {
                let points = &mut self.history[begin..];
                let area: f64 = points.windows(2).map(|w| 0.5 * (w[1].0 - w[0].0) * (w[0].1[end] + w[1].1[end])).sum();
                let factor = delta_v[end] / area;
                if (0.98..=1.02).contains(&factor) {
                    for (_, a) in points.iter_mut() {
                        a[end] *= factor;
                    }
                }
            }
        }
    }

    /// What a place gets of what both ends do.
    fn at(&self, position_m: f64, [a, b]: [f64; 2]) -> f64 {
        let s = self.turn * 2.0 * position_m / self.length_m;
        0.5 * ((1.0 - s) * a + (1.0 + s) * b)
    }

    /// The velocity shocks at a place.
    ///
    /// # Errors
    /// None for a drop that was followed.
    pub fn shocks_at(&self, position_m: f64) -> Result<VelocityShocks, Error> {
        let shocks = self.shocks.iter().map(|&(time, v)| VelocityShock { time, delta_v: self.at(position_m, v) });
        Ok(VelocityShocks::new(shocks.collect())?)
    }

    /// The largest single velocity shock at a place: its size, its number from 0, and when.
    #[must_use]
    pub fn largest_shock(&self, position_m: f64) -> (f64, usize, f64) {
        self.largest(|v| self.at(position_m, v))
    }

    /// The largest single change of angular velocity, in rad/s.
    #[must_use]
    pub fn largest_turn(&self) -> (f64, usize, f64) {
        self.largest(|[a, b]| (b - a) / self.length_m)
    }

    fn largest(&self, of: impl Fn([f64; 2]) -> f64) -> (f64, usize, f64) {
        let mut largest = (0.0, 0, 0.0);
        for (n, &(time, v)) in self.shocks.iter().enumerate() {
            let size = of(v).abs();
            if size > largest.0 {
                largest = (size, n, time);
            }
        }
        largest
    }

    /// Peaks of a suspended part at a place: to pulses where the model gives them, to half-sines of the contact time where
    /// `pulses` asks for them, else to velocity shocks.
    ///
    /// # Errors
    /// None for a drop that was followed.
    pub fn respond(&self, position_m: f64, suspension: &Suspension, pulses: bool) -> Result<Response, Error> {
        if !self.history.is_empty() {
            let history: Vec<_> = self.history.iter().map(|&(time, a)| (time, self.at(position_m, a))).collect();
            return Ok(Pulses::piecewise_linear(&history)?.respond(suspension));
        }
        match self.contact_time_s.filter(|_| pulses) {
            Some(duration) => {
                let pulse = |&(start, v): &(f64, [f64; 2])| {
                    let amplitude = self.at(position_m, v) / (Shape::HalfSine.area() * duration);
                    Pulse { shape: Shape::HalfSine, amplitude, duration, start }
                };
                let pulses: Vec<_> = self.shocks.iter().map(pulse).collect();
                Ok(Pulses::new(&pulses)?.respond(suspension))
            }
            None => Ok(self.shocks_at(position_m)?.respond(suspension)),
        }
    }

    /// The largest acceleration of the product itself at a place, its number and time: of the history, or of half-sines of the
    /// contact time; `None` where no contact time is known.
    #[must_use]
    pub fn largest_acceleration(&self, position_m: f64) -> Option<(f64, usize, f64)> {
        if self.history.is_empty() {
            let (v, n, time) = self.largest_shock(position_m);
            return self.contact_time_s.map(|t| (v / (Shape::HalfSine.area() * t), n, time + 0.5 * t));
        }
        let mut largest = (0.0, 0, 0.0);
        for &(time, a) in &self.history {
            let size = self.at(position_m, a).abs();
            if size > largest.0 {
                largest = (size, self.contact_before(time), time);
            }
        }
        Some(largest)
    }

    /// When the contacts begin.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> {
        self.shocks.iter().map(|s| s.0)
    }

    /// Times and velocity shocks at a place.
    pub(crate) fn shocks_of(&self, position_m: f64) -> impl Iterator<Item = (f64, f64)> {
        self.shocks.iter().map(move |&(time, v)| (time, self.at(position_m, v)))
    }

    /// Times and changes of angular velocity.
    pub(crate) fn turns(&self) -> impl Iterator<Item = (f64, f64)> {
        self.shocks.iter().map(|&(time, [a, b])| (time, self.turn * (b - a) / self.length_m))
    }

    /// Time and acceleration of the product at a place, of half-sines where the model has no pulses of its own; to be drawn.
    pub(crate) fn acceleration_at(&self, position_m: f64) -> Vec<(f64, f64)> {
        if !self.history.is_empty() {
            return self.history.iter().map(|&(time, a)| (time, self.at(position_m, a))).collect();
        }
        let Some(duration) = self.contact_time_s else { return self.shocks_of(position_m).collect() };
        let sine = |(start, v): (f64, f64)| {
            let amplitude = v / (Shape::HalfSine.area() * duration);
            (0..=SAMPLES).map(move |i| {
                let share = f64::from(i) / f64::from(SAMPLES);
                (start + share * duration, amplitude * libm::sin(std::f64::consts::PI * share))
            })
        };
        self.shocks_of(position_m).flat_map(sine).collect()
    }

    /// Velocity shocks at a place in order of time; pulses are cut into slices of one area each, to be drawn.
    pub(crate) fn slices_at(&self, position_m: f64, pulses: bool) -> Vec<(f64, f64)> {
        if !pulses {
            return self.shocks_of(position_m).collect();
        }
        let history = self.acceleration_at(position_m);
        let slice = |pair: &[(f64, f64)]| {
            let [(from, a), (to, b)] = *pair else { return (0.0, 0.0) };
            (0.5 * (from + to), 0.5 * (a + b) * (to - from))
        };
        let mut slices: Vec<_> = history.windows(2).map(slice).filter(|s| s.1 != 0.0).collect();
        slices.sort_by(|a, b| a.0.total_cmp(&b.0));
        slices
    }

    /// Number, from 0, of the last contact that began by `time`.
    #[must_use]
    pub fn contact_before(&self, time: f64) -> usize {
        self.shocks.partition_point(|(from, _)| *from <= time).saturating_sub(1)
    }
}
