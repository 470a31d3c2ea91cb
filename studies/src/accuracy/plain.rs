//! The train in plain f64: the recurrence as a loop, and the closed form as it is printed.

use super::train::{Answer, Case, Found, Inertia, LONG};

/// Returns T in f64: from k through a rounded q.
fn plain_t(case: &Case) -> f64 {
    let q = match case.given {
        Inertia::Q(q) => q,
        Inertia::K(k) => (1.0 - k * k) / (1.0 + k * k),
    };
    q * (1.0 + case.e)
}

/// Runs the recurrence as it is printed, for a million steps.
pub(super) fn recurrence(case: &Case, list: &[u64]) -> Answer {
    let (t, e) = (plain_t(case), case.e);
    let [mut a, vb] = case.velocity;
    let (mut next, mut b, mut b_next) = (t * a + vb, 0.0, 1.0);
    let mut answer = Answer { found: Found::Open, peak: 0.0, strikes: Vec::new(), last: None, duration: f64::NAN };
    let mut looked = list.iter().copied().peekable();
    for n in 0..LONG {
        let time = case.gap * b / -a;
        answer.peak = answer.peak.max(-(1.0 + e) * a);
        answer.duration = time;
        if looked.next_if_eq(&n).is_some() {
            answer.strikes.push(Some([a, -(1.0 + e) * a, time]));
        }
        if next >= 0.0 {
            let (struck, free) = (-e * a, next);
            answer.found = Found::Impacts(n + 1);
            answer.last = Some(if n % 2 == 0 { [struck, free] } else { [free, struck] });
            break;
        }
        (a, next) = (next, t * next - e * a);
        (b, b_next) = (b_next, t * b_next - e * b);
    }
    answer.strikes.resize(list.len(), None);
    answer
}

/// Returns the closed form as it is printed: acos of T/(2√e), π − φ, plain powers.
pub(super) fn closed(case: &Case, list: &[u64]) -> Answer {
    use libm::{acos, atan2, ceil, exp, floor, log, pow, sin, sqrt};
    let (t, e, [va, vb]) = (plain_t(case), case.e, case.velocity);
    let c = t / (2.0 * sqrt(e));
    let theta = acos(c);
    let root = sqrt(t * t - 4.0 * e);
    let (small, large) = (0.5 * (t - root), 0.5 * (t + root));
    let of_large = (t * va + vb - small * va) / (large - small);
    let of_small = va - of_large;
    #[expect(clippy::cast_precision_loss, reason = "plain floats are what is tried")]
    let term = |n: u64| {
        let n = n as f64;
        if c < 1.0 {
            let u = |m: f64| sin((m + 1.0) * theta) / sin(theta);
            let a = exp(n / 2.0 * log(e)) * (va * u(n) + vb / sqrt(e) * u(n - 1.0));
            [a, exp((n - 1.0) / 2.0 * log(e)) * u(n - 1.0)]
        } else {
            let a = of_large * pow(large, n) + of_small * pow(small, n);
            [a, (pow(large, n) - pow(small, n)) / (large - small)]
        }
    };
    let phi = atan2(-va * sin(theta), -(va * c + vb / sqrt(e)));
    let count = if c < 1.0 {
        ceil((std::f64::consts::PI - phi) / theta)
    } else if vb <= large * -va {
        f64::INFINITY
    } else {
        ceil(log(-of_small / of_large) / log(large / small))
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count in [1, 2^63]")]
    let found = match count {
        n if n.is_infinite() && n > 0.0 => Found::Endless,
        n if (1.0..9e18).contains(&n) => Found::Impacts(n as u64),
        _ => Found::Nothing,
    };
    let end = match found {
        Found::Impacts(n) => n,
        Found::Endless => u64::MAX,
        _ => 0,
    };
    let at = if c < 1.0 {
        (atan2(2.0 * theta, -log(e)) - phi) / theta
    } else {
        log(-of_small * log(small) / (of_large * log(large))) / log(large / small)
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is the first impact")]
    let beside = [floor(at) as u64, ceil(at) as u64].map(|n| n.min(end.saturating_sub(1)));
    let strike = |n: u64| {
        let [a, b] = term(n);
        [a, -(1.0 + e) * a, case.gap * b / -a]
    };
    let last = match found {
        Found::Impacts(n) => {
            let (struck, free) = (-e * term(n - 1)[0], term(n)[0]);
            Some(if n % 2 == 1 { [struck, free] } else { [free, struck] })
        }
        Found::Endless => Some([0.0; 2]),
        _ => None,
    };
    Answer {
        found,
        peak: [0, beside[0], beside[1]].map(|n| strike(n)[1]).into_iter().fold(f64::NAN, f64::max),
        strikes: list.iter().map(|&n| (n < end).then(|| strike(n))).collect(),
        last,
        duration: match found {
            Found::Impacts(n) => strike(n - 1)[2],
            _ => case.gap / (large * -va - vb),
        },
    }
}
