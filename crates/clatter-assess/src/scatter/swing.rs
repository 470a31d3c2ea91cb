//! Free motion of a part on a suspension, and its peaks between velocity shocks: only `libm`, so that a sample gives the same
//! digits on any machine.

/// From here on a part hardly swings, and this free motion does not describe it.
pub(super) const LARGEST_DAMPING: f64 = 0.95;

/// Largest relative displacement and absolute acceleration of a part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Peaks {
    pub(super) displacement: f64,
    pub(super) acceleration: f64,
}

impl Peaks {
    pub(super) fn raise(&mut self, other: &Self) {
        self.displacement = self.displacement.max(other.displacement);
        self.acceleration = self.acceleration.max(other.acceleration);
    }
    pub(super) fn scaled(self, omega: f64) -> Self {
        Self { displacement: self.displacement / omega, acceleration: self.acceleration * omega }
    }
}

/// x = ωz and w = z′ + ζωz, both velocities.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    pub(super) x: f64,
    pub(super) w: f64,
}

/// A quantity of free motion, `of_x x + of_w w`.
#[derive(Debug, Clone, Copy)]
struct Row {
    of_x: f64,
    of_w: f64,
}

impl Row {
    fn of(self, m: Motion) -> f64 {
        self.of_x * m.x + self.of_w * m.w
    }
}

/// Free motion of a part with damping ratio ζ < 1: z = e^(−ζτ)(x cos βτ + w sin(βτ)/β)/ω, β = √(1 − ζ²).
#[derive(Debug, Clone, Copy)]
pub(super) struct Swing {
    zeta: f64,
    pub(super) beta: f64,
    /// β².
    p: f64,
    /// Derivatives by τ of x and of A/ω.
    slopes: [Row; 2],
    /// A/ω.
    acceleration: Row,
    /// Power series of e^(−ζτ) cos βτ and e^(−ζτ) sin(βτ)/β, from the highest power down.
    series: [[f64; TERMS]; 2],
}

const TERMS: usize = 13;
/// Up to this phase the series leaves less than 0.5¹³/13! = 2e−14.
const SMALL_PHASE: f64 = 0.5;

impl Swing {
    pub(super) fn new(zeta: f64) -> Self {
        let p = (1.0 - zeta) * (1.0 + zeta);
        // (−ζ + iβ)^k/k!, by real and imaginary part over β
        let (mut series, mut power, mut factorial) = ([[0.0; TERMS]; 2], [1.0, 0.0], 1.0);
        for k in 0..TERMS {
            for (part, value) in series.iter_mut().zip(power) {
                part[TERMS - 1 - k] = value / factorial;
            }
            power = [-zeta * power[0] - p * power[1], power[0] - zeta * power[1]];
            #[expect(clippy::cast_precision_loss, reason = "a small whole number")]
            let next = (k + 1) as f64;
            factorial *= next;
        }
        let square = zeta * zeta;
        Self {
            zeta,
            beta: p.sqrt(),
            p,
            slopes: [
                Row { of_x: -zeta, of_w: 1.0 },
                Row { of_x: zeta * (3.0 - 4.0 * square), of_w: 4.0 * square - 1.0 },
            ],
            acceleration: Row { of_x: 2.0 * square - 1.0, of_w: -2.0 * zeta },
            series,
        }
    }

    pub(super) fn acceleration(&self, m: Motion) -> f64 {
        self.acceleration.of(m)
    }

    /// What x, A/ω and z′ are at their turning points, but for the decay.
    pub(super) fn amplitude(&self, m: Motion) -> f64 {
        (m.w * m.w + self.p * m.x * m.x).sqrt()
    }

    #[inline]
    pub(super) fn after(&self, m: Motion, phase: f64) -> Motion {
        let [c, s] = if phase < SMALL_PHASE {
            self.series.map(|terms| terms.iter().fold(0.0, |sum, term| sum * phase + term))
        } else {
            let (sin, cos) = libm::sincos(self.beta * phase);
            let decay = libm::exp(-self.zeta * phase);
            [decay * cos, decay * sin / self.beta]
        };
        Motion { x: c * m.x + s * m.w, w: c * m.w - self.p * s * m.x }
    }

    /// Takes in the values between two shocks.
    #[inline]
    pub(super) fn note_between(&self, start: Motion, end: Motion, phase: f64, peaks: &mut Peaks) {
        let amplitude = self.amplitude(start);
        let swings = self.beta * phase >= std::f64::consts::PI;
        for (slope, peak) in self.slopes.iter().zip([&mut peaks.displacement, &mut peaks.acceleration]) {
            if amplitude > *peak && (swings || slope.of(start) * slope.of(end) < 0.0) {
                let tau = self.turn(*slope, start);
                if tau < phase {
                    *peak = peak.max(amplitude * libm::exp(-self.zeta * tau));
                }
            }
        }
        peaks.displacement = peaks.displacement.max(end.x.abs());
        peaks.acceleration = peaks.acceleration.max(self.acceleration(end).abs());
    }

    pub(super) fn note_ring_down(&self, m: Motion, peaks: &mut Peaks) {
        let amplitude = self.amplitude(m);
        for (slope, peak) in self.slopes.iter().zip([&mut peaks.displacement, &mut peaks.acceleration]) {
            if amplitude > *peak {
                *peak = peak.max(amplitude * libm::exp(-self.zeta * self.turn(*slope, m)));
            }
        }
    }

    /// When a slope vanishes first: it is e^(−ζτ)(r cos βτ + b sin(βτ)/β) with b = r′ + ζr.
    fn turn(&self, slope: Row, m: Motion) -> f64 {
        let r = slope.of(m);
        let bend = slope.of_x * m.w - slope.of_w * self.p * m.x;
        let angle = if r == 0.0 { std::f64::consts::PI } else { libm::atan2(self.beta * r.abs(), -bend * r.signum()) };
        angle / self.beta
    }
}
