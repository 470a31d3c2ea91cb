//! The ground under one point of a body: a law of force, in phases.

/// Force of a contact over its depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Loads on one line and unloads on a steeper one; leaves a dent.
    Hysteretic,
    /// Spring and dashpot that never pull.
    Dashpot,
}

/// Restitution below which the unloading line of the hysteretic law is too steep to be stepped.
pub(crate) const LEAST_RESTITUTION: f64 = 0.01;
/// Angle of the fastest oscillation per step of time, in radians.
const FINE: f64 = 0.08;
/// The same while nothing but the weight is carried.
const COARSE: f64 = 0.5;

/// Restitution and contact time of one point, where it has its own.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Own {
    /// Restitution.
    pub e: Option<f64>,
    /// Time of a lone contact.
    pub time: Option<f64>,
}

/// The contact law of a point of a body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ground {
    is_hysteretic: bool,
    pub(crate) e: f64,
    /// Frequency and damping rate of a lone contact.
    pub(crate) omega: f64,
    damping: f64,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Phase {
    #[default]
    Free,
    /// Loading on the virgin line; the only phase of a dashpot.
    Load,
    /// Below the virgin line.
    Unload,
}

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Contact {
    pub(crate) phase: Phase,
    /// Height of the ground under this point: 0, or the bottom of its dent.
    pub(crate) ground: f64,
    pub(crate) stiffness: f64,
    pub(crate) dashpot: f64,
    /// Depth of the begin of the unloading line, and of its zero.
    deepest: f64,
    zero: f64,
}

impl Ground {
    /// Creates the ground of a law whose lone contact takes a time and has the restitution; without one, that of
    /// instant impacts.
    pub(crate) fn new(contact: Option<(Law, f64)>, e: f64) -> Self {
        let is_hysteretic = matches!(contact, Some((Law::Hysteretic, _)));
        let (omega, damping, e) = match contact {
            Some((Law::Hysteretic, time)) => {
                let e = e.max(LEAST_RESTITUTION);
                (std::f64::consts::FRAC_PI_2 * (1.0 + e) / time, 0.0, e)
            }
            Some((Law::Dashpot, time)) => {
                let (omega, zeta) = dashpot(e.max(LEAST_RESTITUTION));
                (omega / time, zeta * omega / time, e)
            }
            None => (0.0, 0.0, e),
        };
        Self { is_hysteretic, e, omega, damping }
    }

    /// Returns the grounds of points with their own contacts; the others have the given one.
    pub(crate) fn own<const N: usize>(contact: Option<(Law, f64)>, e: f64, own: &[Own; N]) -> [Self; N] {
        own.map(|own| {
            let contact = contact.map(|(law, time)| (law, own.time.unwrap_or(time)));
            Self::new(contact, own.e.unwrap_or(e))
        })
    }
}

/// A point on the ground with height, velocity and mobility.
pub(crate) type Point = (Contact, Ground, f64, f64, f64);

/// Returns a step of time that resolves the fastest oscillation of the pressing points.
pub(crate) fn fine(points: &[Point], gravity: f64) -> f64 {
    let (mut square, mut rate) = (0.0, 0.0);
    for (c, ground, _, _, mobility) in points {
        match c.phase {
            Phase::Free => {}
            Phase::Load => {
                square += c.stiffness * mobility;
                rate += c.dashpot * mobility;
            }
            Phase::Unload => square += c.stiffness * mobility / (ground.e * ground.e),
        }
    }
    let little = 10.0 * gravity;
    let weak = |(c, _, height, velocity, _): &Point| match c.phase {
        Phase::Free => true,
        Phase::Load => c.dashpot > 0.0 && c.stiffness * height.abs() + c.dashpot * velocity.abs() < little,
        Phase::Unload => c.stiffness * c.deepest < little,
    };
    let radians = if points.iter().all(weak) { COARSE } else { FINE };
    let omega = points.iter().map(|(_, ground, ..)| ground.omega).fold(0.0, f64::max);
    radians / f64::sqrt(square).max(rate).max(omega / 4.0)
}

impl Contact {
    /// Returns whether the point is up, without a dent or a pressed dashpot.
    pub(crate) fn is_up(&self) -> bool {
        self.phase == Phase::Free && self.ground == 0.0 && self.dashpot == 0.0
    }

    /// Returns the force per mass, on the line of the present phase.
    pub(crate) fn force(&self, ground: &Ground, height: f64, velocity: f64) -> f64 {
        let depth = self.ground - height;
        match self.phase {
            Phase::Free => 0.0,
            Phase::Load => self.stiffness * depth - self.dashpot * velocity,
            Phase::Unload => self.stiffness / (ground.e * ground.e) * (depth - self.zero),
        }
    }

    /// Returns the energy per mass in the spring; that of a dashpot is kept until its point is up.
    pub(crate) fn stored(&self, ground: &Ground, height: f64, velocity: f64) -> f64 {
        let force = self.force(ground, height, velocity);
        match self.phase {
            _ if self.dashpot > 0.0 => self.stiffness * height.powi(2) / 2.0,
            Phase::Free => 0.0,
            _ => force * force * ground.e * ground.e / (2.0 * self.stiffness),
        }
    }

    /// Returns a value that is positive within a phase, and negative when it is over.
    pub(crate) fn room(&self, ground: &Ground, height: f64, velocity: f64) -> f64 {
        match self.phase {
            // After parting below the ground it presses again when spring and dashpot together push.
            Phase::Free if self.dashpot > 0.0 => (self.stiffness * height + self.dashpot * velocity).min(-height),
            Phase::Free if self.ground < 0.0 => (height - self.ground).min(-height),
            Phase::Free => height,
            Phase::Load if ground.is_hysteretic => -velocity,
            Phase::Load => self.force(ground, height, velocity),
            Phase::Unload => (self.ground - height - self.zero).min(self.deepest - (self.ground - height)),
        }
    }

    /// Begins the next phase, for a point that an impulse of 1 over the mass moves by `mobility`, and returns whether
    /// it is a touch.
    pub(crate) fn advance(&mut self, ground: &Ground, height: f64, mobility: f64) -> bool {
        match self.phase {
            Phase::Free if height >= 0.0 && (self.ground < 0.0 || self.dashpot > 0.0) => {
                (self.ground, self.dashpot) = (0.0, 0.0);
            }
            Phase::Free => {
                self.phase = Phase::Load;
                if self.dashpot == 0.0 {
                    self.stiffness = ground.omega * ground.omega / mobility;
                    self.dashpot = 2.0 * ground.damping / mobility;
                }
                return true;
            }
            Phase::Load if ground.is_hysteretic => {
                self.deepest = self.ground - height;
                self.zero = self.deepest * (1.0 - ground.e * ground.e);
                self.phase = Phase::Unload;
            }
            Phase::Load => self.phase = Phase::Free,
            Phase::Unload if self.ground - height < self.zero => {
                self.phase = Phase::Free;
                self.ground = height;
            }
            Phase::Unload => self.phase = Phase::Load,
        }
        false
    }
}

/// Returns frequency and damping ratio of spring and dashpot that touch for a time of 1 and part, where they would
/// pull, with restitution e.
fn dashpot(e: f64) -> (f64, f64) {
    // This is the time to the end of the push, in units of 1/ω; the restitution is then exp(−ζ ω t).
    let time = |zeta: f64| {
        let d = (1.0 - zeta * zeta).abs();
        match zeta {
            z if d < 1e-9 => 2.0 * z,
            z if z < 1.0 => 2.0 * z.acos() / d.sqrt(),
            z => 2.0 * z.acosh() / d.sqrt(),
        }
    };
    let (mut low, mut high) = (0.0_f64, 1e6_f64);
    for _ in 0..200 {
        let mid = if high > 2.0 { (low.max(1e-3) * high).sqrt() } else { f64::midpoint(low, high) };
        if (-mid * time(mid)).exp() > e { low = mid } else { high = mid }
    }
    (time(low), low)
}
