//! Traps for plain floats: one test a trap, expected values derived on the spot in integers.
#![expect(clippy::float_cmp, reason = "exact answers are compared exactly")]
#![expect(clippy::cast_precision_loss, reason = "counts that are compared with floats")]

use clatter::accuracy::{APPROACH, DURATION, DURATION_LONG, PEAK, TIME};
use clatter::{Axis, Bar, Count, End, Extent, Map, PeakImpact, Quantity, Start};
use num_bigint::{BigInt, Sign};

fn bar(q: f64, e: f64) -> Bar {
    Bar::new(q, e).unwrap()
}

fn start(va: f64, vb: f64) -> Start {
    Start::new([va, vb], 1.0).unwrap()
}

fn close(got: f64, want: f64, error: f64) -> bool {
    (got - want).abs() <= error * want.abs()
}

/// Returns (m, x) with v = m 2^−x, x ≥ 0.
fn dyadic(v: f64) -> (BigInt, u64) {
    let bits = v.abs().to_bits();
    let (m, biased) = (bits & ((1 << 52) - 1), bits >> 52);
    let m = BigInt::from(if biased == 0 { m } else { m | 1 << 52 });
    let (m, x) = if biased > 1075 { (m << (biased - 1075), 0) } else { (m, 1075 - biased.max(1)) };
    (if v < 0.0 { -m } else { m }, x)
}

/// Returns n/d to the nearest float or its neighbor; within the range of floats.
fn ratio(n: &BigInt, d: &BigInt) -> f64 {
    let shift = 70 + i64::try_from(d.bits()).unwrap() - i64::try_from(n.bits()).unwrap();
    let whole = if shift >= 0 { (n << shift) / d } else { n / (d << -shift) };
    let size = whole.magnitude().iter_u64_digits().rev().fold(0.0, |v, digit| v * 2f64.powi(64) + digit as f64);
    let half = -shift / 2;
    let value = size * 2f64.powi(i32::try_from(half).unwrap()) * 2f64.powi(i32::try_from(-shift - half).unwrap());
    if whole.sign() == Sign::Minus { -value } else { value }
}

/// The recurrence in integers, `a_n` 2^{rn + s} and `b_n` 2^{r(n−1)}: no rounding at all.
struct Whole {
    p: BigInt,
    q: BigInt,
    r: u64,
    s: u64,
    a: [BigInt; 2],
    b: [BigInt; 2],
    n: u64,
}

impl Whole {
    fn new(q: f64, e: f64, va: f64, vb: f64) -> Self {
        let ((mq, x), (me, y)) = (dyadic(q), dyadic(e));
        let ((ma, xa), (mb, xb)) = (dyadic(va), dyadic(vb));
        let (p, r, s) = (mq * ((BigInt::from(1) << y) + &me), x + y, xa.max(xb));
        let (va, vb) = (ma << (s - xa), mb << (s - xb));
        let next = &p * &va + (vb << r);
        let q = me << (2 * r - y);
        Self { p, q, r, s, a: [va, next], b: [0.into(), 1.into()], n: 0 }
    }
    /// Goes on to strike n + 2.
    fn step(&mut self) {
        for pair in [&mut self.a, &mut self.b] {
            let next = &self.p * &pair[1] - &self.q * &pair[0];
            pair.swap(0, 1);
            pair[1] = next;
        }
        self.n += 1;
    }
    fn ended(&self) -> bool {
        self.a[0].sign() != Sign::Minus
    }
    /// Returns the approach velocity of strike n + 1.
    fn approach(&self) -> f64 {
        ratio(&self.a[0], &(BigInt::from(1) << (self.r * self.n + self.s)))
    }
    /// Returns the time of strike n + 1 at h0 = 1.
    fn time(&self) -> f64 {
        if self.n == 0 { 0.0 } else { ratio(&(&self.b[0] << (self.r + self.s)), &-&self.a[0]) }
    }
}

/// Bits after the point.
const POINT: u64 = 500;

fn fixed(v: f64) -> BigInt {
    let (m, x) = dyadic(v);
    (m << POINT) >> x
}

fn times(a: &BigInt, b: &BigInt) -> BigInt {
    (a * b) >> POINT
}

/// Returns atan(y/x) by its series, for 0 < y ≤ x/2.
fn atan(y: &BigInt, x: &BigInt) -> BigInt {
    let t = (y << POINT) / x;
    let square = times(&t, &t);
    let (mut power, mut sum, mut k) = (t, BigInt::from(0), 1_u32);
    while power.sign() != Sign::NoSign {
        let term: BigInt = &power / k;
        sum += if k % 4 == 1 { term } else { -term };
        (power, k) = (times(&power, &square), k + 2);
    }
    sum
}

/// N = ⌈(π − φ)/θ⌉ for `v_a` = `v_b` < 0 by 500-bit arithmetic, next to the endless curve where θ is small.
fn count_by_angles(q: f64, e: f64) -> u64 {
    let one = fixed(1.0);
    let t = times(&fixed(q), &(&one + fixed(e)));
    let d: BigInt = fixed(e) * 4 - times(&t, &t);
    let s = (d << POINT).sqrt();
    let pi: BigInt = (4 * atan(&one, &(5 * &one)) - atan(&one, &(239 * &one))) * 4;
    let quotient = ((pi - atan(&s, &(&t + 2 * &one))) << POINT) / atan(&s, &t);
    let whole: BigInt = (&quotient >> POINT) + 1;
    // 2^−300 is far more than a few roundings of 2^−500 become.
    let rest: BigInt = quotient - ((&whole - 1) << POINT);
    assert!(rest > fixed(2f64.powi(-300)) && rest < &one - fixed(2f64.powi(-300)), "no tie");
    u64::try_from(whole).unwrap()
}

/// Returns the count of a loop in plain floats, cut off after `limit`.
fn naive_count(q: f64, e: f64, limit: u64) -> Option<u64> {
    let (t, mut a, mut next) = (q * (1.0 + e), -1.0, -(q * (1.0 + e)) - 1.0);
    for n in 1..limit {
        if next >= 0.0 {
            return Some(n);
        }
        (a, next) = (next, t * next - e * a);
    }
    None
}

/// Checks an endless train whose plain recurrence underflows to zero and so "ends" after 469 impacts.
#[test]
fn underflow_below_one_half_ends_no_endless_train() {
    // q = 2√e/(1 + e) rounded up: T = 0.4 < ½.
    let (q, e) = (0.4 / 1.04 * (1.0 + f64::EPSILON), 0.04);
    assert_eq!(naive_count(q, e, 10_000), Some(469), "the trap");
    let endless = bar(q, e);
    assert_eq!(endless.count(&Start::default()), Count::Endless);
    let late = endless.train(&Start::default()).nth(1_000_000).unwrap();
    assert_eq!(late.number, 1_000_001, "it strikes on");
    let limit = endless.summary(&Start::default()).duration;
    assert!(close(late.time, limit, 1e-5) && late.time < limit, "{} tends to {limit}", late.time);
}

/// Checks an endless train whose plain recurrence sticks at the smallest float.
#[test]
fn underflow_from_one_half_on_sticks_at_no_subnormal() {
    // q = 2√e/(1 + e) rounded up: T = 0.6 ≥ ½.
    let (q, e) = (0.6 / 1.09 * (1.0 + f64::EPSILON), 0.09);
    let (t, mut a, mut next) = (q * (1.0 + e), -1.0, -(q * (1.0 + e)) - 1.0);
    for _ in 0..5000 {
        (a, next) = (next, t * next - e * a);
    }
    assert_eq!((a, next), (-5e-324, -5e-324), "the trap");
    let endless = bar(q, e);
    assert_eq!(endless.count(&Start::default()), Count::Endless);
    let late = endless.train(&Start::default()).nth(5000).unwrap();
    assert_eq!((late.approach, late.delta_v), (0.0, [0.0, 0.0]), "below the range of floats");
    assert!(late.time < endless.summary(&Start::default()).duration, "but on time: {}", late.time);
    assert_eq!(endless.summary(&Start::default()).final_velocity, Some([0.0, 0.0]));
}

/// D = 4e − T², plain or as (1 − q²)(1 + e)² − (1 − e)², has no digit right: the count would be off by tens of
/// millions.
#[test]
fn the_discriminant_does_not_cancel() {
    let (q, e) = (0.799_999_999_999_999_9_f64, 0.25_f64);
    let t = q * (1.0 + e);
    let plain = 4.0 * e - t * t;
    let other = (1.0 - q * q) * (1.0 + e) * (1.0 + e) - (1.0 - e) * (1.0 - e);
    let one = fixed(1.0);
    let t = times(&fixed(q), &(&one + fixed(e)));
    let truth = ratio(&(fixed(e) * 4 - times(&t, &t)), &one);
    assert!(close(truth, 1.67e-16, 0.01), "{truth:e}");
    assert!((plain / truth - 1.0).abs() > 0.3 && (other / truth - 1.0).abs() > 0.3, "{plain:e}, {other:e}: the trap");
    let want = count_by_angles(q, e);
    assert!(want > 200_000_000, "{want}");
    assert_eq!(bar(q, e).count(&Start::default()), Count::Finite(want));
}

/// Near q = 1 the rounded q holds few digits of 1 − q; k keeps them all.
#[test]
fn the_gyration_ratio_is_kept() {
    // Elastic: θ = 2 atan k and φ = θ/2, hence N = ⌈π/θ − ½⌉.
    for k in [3e-5_f64, 1e-7, 1e-8, 1e-9, 7.7e-12] {
        let quotient = std::f64::consts::PI / (2.0 * k.atan()) - 0.5;
        let rest = quotient.ceil() - quotient;
        let error = 8.0 * f64::EPSILON * quotient; // a few roundings
        assert!(rest > error && 1.0 - rest > error, "k = {k} decides");
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let want = Count::Finite(quotient.ceil() as u64);
        assert_eq!(Bar::from_gyration_ratio(k, 1.0).unwrap().count(&Start::default()), want, "k = {k}");
        let rounded = Bar::new((1.0 - k * k) / (1.0 + k * k), 1.0).unwrap();
        assert!(k > 1e-6 || rounded.count(&Start::default()) != want, "k = {k}: the trap");
    }
}

/// Compares every strike of a train of thousands with integers; the plain loop is far off at its end.
#[test]
fn strike_times_do_not_drift() {
    for (q, e, n) in [(0.984_304_929_263_587, 0.7, 2221), (0.999_671_114_885_08, 0.95, 7025)] {
        let (bar, one) = (bar(q, e), Start::default());
        assert_eq!(bar.count(&one), Count::Finite(n), "({q}, {e})");
        let mut exact = Whole::new(q, e, -1.0, -1.0);
        let (t, mut a, mut b) = (q * (1.0 + e), [-1.0, -q * (1.0 + e) - 1.0], [0.0, 1.0]);
        let mut drift = 0.0_f64;
        let mut train = bar.train(&one);
        while !exact.ended() {
            let impact = train.next().unwrap();
            // Divisions of long integers are what takes time: now and then, and all of the last.
            if exact.n.is_multiple_of(16) || exact.n + 16 > n {
                let (time, approach) = (exact.time(), exact.approach());
                assert!((impact.time - time).abs() <= TIME.error * time.max(1.0), "strike {}", impact.number);
                let scale = approach.abs().max(1.0);
                assert!((impact.approach - approach).abs() <= APPROACH.error * scale, "strike {}", impact.number);
                drift = drift.max((b[0] / -a[0] - time).abs() / time.max(1.0));
            }
            (a, b) = ([a[1], t * a[1] - e * a[0]], [b[1], t * b[1] - e * b[0]]);
            exact.step();
        }
        assert_eq!(exact.n, n, "integers end there too");
        assert!(train.next().is_none(), "and no more");
        assert!(drift > 10.0 * TIME.error, "the trap: {drift:e}");
    }
}

/// With q = 1 speeds rise to 2 v0/(1 − e), which no strike attains; strikes go on without end until h0/(2 v0).
#[test]
fn massless_ends_strike_for_ever_and_never_settle() {
    for e in [1e-3, 0.3, 0.999] {
        for bar in [bar(1.0, e), Bar::from_gyration_ratio(0.0, e).unwrap()] {
            let s = bar.summary(&Start::default());
            assert_eq!((s.count, s.peak.impact, s.peak.center), (Count::Endless, PeakImpact::Limit, 0.0), "e = {e}");
            assert!(close(s.peak.end, 2.0 * (1.0 + e) / (1.0 - e), PEAK.error), "e = {e}: {}", s.peak.end);
            assert!(close(s.duration, 0.5, DURATION.error), "e = {e}: {}", s.duration);
            assert_eq!((s.final_velocity, s.net), (None, None), "e = {e}");
            for impact in bar.train(&Start::default()).take(200) {
                // The roots are 1 and e.
                let n = i32::try_from(impact.number).unwrap() - 1;
                let want = (2.0 - (1.0 + e) * e.powi(n)) / (1.0 - e);
                // The formula cancels near e = 1, by 2/(1 − e) of some 2n roundings in its power.
                let error = APPROACH.error + f64::from(4 * n + 4) * f64::EPSILON * 2.0 / (1.0 - e);
                assert!((-impact.approach - want).abs() <= error * want, "e = {e}, strike {}", impact.number);
                assert_eq!(impact.delta_v_at(0.0), 0.0, "the center feels nothing");
            }
        }
    }
}

/// With q = 1 and e = 0 the second strike attains the limit, and so do all later ones.
#[test]
fn massless_dead_ends_reach_the_limit_at_the_second_strike() {
    let s = bar(1.0, 0.0).summary(&Start::default());
    assert_eq!((s.count, s.duration), (Count::Endless, 0.5));
    assert_eq!((s.peak.end, s.peak.impact, s.peak.center), (2.0, PeakImpact::Number(2), 0.0));
    assert_eq!(s.final_velocity, None);
}

/// With q = e = 1 the peak grows without bound at the ends, and is 0 at the center, not 0 · ∞.
#[test]
fn massless_elastic_ends_have_an_infinite_peak_about_a_center_at_peace() {
    let bar = bar(1.0, 1.0);
    let s = bar.summary(&Start::default());
    assert_eq!((s.count, s.duration, s.final_velocity), (Count::Endless, 0.5, None));
    assert_eq!((s.peak.end, s.peak.center, s.peak.impact), (f64::INFINITY, 0.0, PeakImpact::Limit));
    assert_eq!(bar.shocks_either(&Start::default()).at(0.0), 0.0);
    for (impact, n) in bar.train(&Start::default()).zip(0..100) {
        // |a_n| = 1 + 2n at time n/(1 + 2n).
        let speed = f64::from(1 + 2 * n);
        assert!(close(-impact.approach, speed, APPROACH.error), "strike {}", n + 1);
        assert!((impact.time - f64::from(n) / speed).abs() <= TIME.error, "strike {}", n + 1);
    }
}

/// [−1, 1] at q = e = 1 turns to and fro about a still center for ever, one strike every h0/v0.
#[test]
fn a_turning_massless_bar_strikes_for_ever() {
    let (bar, turning) = (bar(1.0, 1.0), start(-1.0, 1.0));
    let s = bar.summary(&turning);
    assert_eq!((s.count, s.duration), (Count::Endless, f64::INFINITY));
    assert_eq!((s.peak.end, s.peak.impact, s.peak.center), (2.0, PeakImpact::Number(1), 0.0));
    assert_eq!(s.final_velocity, None, "it does not settle");
    for impact in bar.train(&turning).take(1000) {
        assert_eq!(impact.approach, -1.0, "strike {}", impact.number);
        assert!((impact.time - (impact.number - 1) as f64).abs() <= TIME.error * impact.time.max(1.0), "{impact:?}");
    }
    // With losses, it comes to rest about that center, in infinite time.
    let s = Bar::new(1.0, 0.5).unwrap().summary(&turning);
    assert_eq!((s.count, s.duration, s.final_velocity), (Count::Endless, f64::INFINITY, Some([0.0, 0.0])));
}

/// With e = 0 and q > 0 the train has no end; strike 2 and all later ones happen at one instant.
#[test]
fn dead_ends_strike_for_ever_at_one_instant() {
    for q in [0.5, 1e-9, 5e-324] {
        let bar = bar(q, 0.0);
        let s = bar.summary(&Start::default());
        assert_eq!((s.count, s.final_velocity), (Count::Endless, Some([0.0, 0.0])), "q = {q:e}");
        assert!(close(s.duration, 1.0 / (1.0 + q), DURATION.error), "q = {q:e}: {}", s.duration);
        for impact in bar.train(&Start::default()).skip(1).take(50) {
            assert_eq!(impact.time, s.duration, "q = {q:e}, strike {}", impact.number);
            let want = -(1.0 + q) * q.powi(i32::try_from(impact.number).unwrap() - 2);
            assert!((impact.approach - want).abs() <= APPROACH.error, "q = {q:e}, strike {}", impact.number);
        }
        // Far along in no time at all, to the last number there is.
        let far = bar.train(&Start::default()).nth(1_000_000_000_000).unwrap();
        assert_eq!((far.number, far.time), (1_000_000_000_001, s.duration), "q = {q:e}");
    }
    // T α is far below the range of floats, and yet end b comes down.
    assert_eq!(bar(5e-324, 0.0).count(&start(-1e-9, 0.0)), Count::Endless);
}

/// With e = 0 and q ≤ 0 there are two impacts.
#[test]
fn dead_ends_with_mass_beyond_them_strike_twice() {
    for q in [0.0, -0.0, -5e-324, -0.5, -0.999] {
        let s = bar(q, 0.0).summary(&Start::default());
        assert_eq!(s.count, Count::Finite(2), "q = {q:e}");
        // a_1 = −(1 + q), then end a leaves with −q a_1 … upwards.
        assert_eq!(s.final_velocity, Some([-q * (1.0 + q) + 0.0, 0.0]), "q = {q:e}");
        assert_eq!(bar(q, 0.0).train(&Start::default()).count(), 2, "q = {q:e}");
    }
}

/// At the last float before the endless curve the count is the exact integer, in constant time.
#[test]
fn counts_just_inside_the_endless_curve_are_exact() {
    let mut longest = 0;
    for e in [0.25, 0.3, 0.5, 0.01, 0.9] {
        let mut q: f64 = 2.0 * f64::sqrt(e) / (1.0 + e);
        while bar(q, e).count(&Start::default()) != Count::Endless {
            q = q.next_up();
        }
        for _ in 0..4 {
            q = q.next_down();
            if let Count::Finite(n) = bar(q, e).count(&Start::default()) {
                assert_eq!(n, count_by_angles(q, e), "({q}, {e})");
                longest = longest.max(n);
                let last = bar(q, e).train(&Start::default()).nth(usize::try_from(n - 1).unwrap()).unwrap();
                let duration = bar(q, e).summary(&Start::default()).duration;
                let allowed = TIME.error + DURATION_LONG.error;
                assert!(close(last.time, duration, allowed), "({q}, {e}): {} not {duration}", last.time);
            }
        }
    }
    assert!(longest > 100_000_000, "{longest}");
}

/// At an exact tie a velocity of exactly zero ends the train, with the strike before.
#[test]
fn ties_are_decided_not_guessed() {
    assert_eq!(bar(-0.5, 1.0).count(&Start::default()), Count::Finite(1), "(−½, 1)");
    assert_eq!(bar(-0.5, 1.0_f64.next_down()).count(&Start::default()), Count::Finite(2), "a little below");
    assert_eq!(bar((-0.5_f64).next_down(), 1.0).count(&Start::default()), Count::Finite(1), "a little beyond");
    assert_eq!(bar(0.0, 0.0).count(&Start::default()), Count::Finite(2), "(0, 0)");
    // q = ½, e = 1: T = 1, θ = π/3, and [−1, 0] runs −1, −1, 0.
    let (uniform, tied) = (bar(0.5, 1.0), start(-1.0, 0.0));
    assert_eq!(uniform.count(&tied), Count::Finite(2));
    assert_eq!(uniform.summary(&tied).final_velocity, Some([0.0, 1.0]));
    // a_2 = v_b: the smallest push down makes it strike once more, the smallest push up does not.
    assert_eq!(uniform.count(&start(-1.0, -5e-324)), Count::Finite(3), "pushed down");
    assert_eq!(uniform.count(&start(-1.0, 5e-324)), Count::Finite(2), "pushed up");
    // Every tie of short trains on a coarse grid, and its neighbors.
    let mut ties = 0;
    for i in -31..32 {
        for j in 1..=32 {
            let (q, e) = (f64::from(i) / 32.0, f64::from(j) / 32.0);
            let mut unit = Whole::new(q, e, -1.0, 0.0);
            for _ in 0..4 {
                unit.step();
                // v_b with −U_{n+1} + v_b U_n = 0, where it is a float: b[1]/b[0] = 2^r U_{n+1}/U_n.
                let scaled = BigInt::from(1) << unit.r;
                if unit.b[0].sign() != Sign::Plus {
                    continue;
                }
                let vb = ratio(&unit.b[1], &(&unit.b[0] * scaled));
                for vb in [vb.next_down(), vb, vb.next_up()] {
                    let mut exact = Whole::new(q, e, -1.0, vb);
                    exact.step();
                    while !exact.ended() && exact.n < 40 {
                        exact.step();
                    }
                    ties += u32::from(exact.a[0].sign() == Sign::NoSign);
                    if exact.n < 40 {
                        assert_eq!(bar(q, e).count(&start(-1.0, vb)), Count::Finite(exact.n), "({q}, {e}), {vb}");
                    }
                }
            }
        }
    }
    assert!(ties > 100, "{ties} exact ties");
}

/// Checks more impacts than f64 has integers: e = 2⁻⁵², q = 2√e/(1 + e).
#[test]
fn counts_beyond_2_to_the_53_are_exact() {
    let e = 2f64.powi(-52);
    let q = 2.0 * 2f64.powi(-26) / (1.0 + e);
    let n = count_by_angles(q, e);
    assert!(n > 1 << 53, "{n}");
    assert_eq!(bar(q, e).count(&Start::default()), Count::Finite(n));
}

/// Beyond 2⁶⁴ the count is a float that says so: elastic, N = ⌈π/(2 atan k) − ½⌉.
#[test]
fn counts_beyond_2_to_the_64_say_so() {
    for k in [1e-20_f64, 1e-32, 1e-35] {
        let s = Bar::from_gyration_ratio(k, 1.0).unwrap().summary(&Start::default());
        let Count::Huge(n) = s.count else { panic!("k = {k}: {:?}", s.count) };
        assert!(close(n, std::f64::consts::FRAC_PI_2 / k, 8.0 * f64::EPSILON), "k = {k}: {n:e}");
        // Turning about the center, a quarter turn less: ψ = π/2 for a start that does not move the center.
        let Count::Huge(n) = Bar::from_gyration_ratio(k, 1.0).unwrap().count(&start(-1.0, 1.0)) else {
            panic!("k = {k}")
        };
        assert!(close(n, std::f64::consts::FRAC_PI_4 / k, 8.0 * f64::EPSILON), "k = {k}, turning: {n:e}");
    }
}

/// In a flat drop all strikes happen at one instant, in order.
#[test]
fn a_flat_drop_strikes_in_order_at_one_instant() {
    let flat = Start::new([-1.0, -1.0], 0.0).unwrap();
    for (q, e) in [(0.5, 0.3), (0.73, 0.2), (0.9, 0.5), (-0.5, 0.5), (0.5, 0.0), (1.0, 0.5), (1.0, 1.0)] {
        let tilted = bar(q, e).train(&Start::default());
        for (impact, same) in bar(q, e).train(&flat).zip(tilted).take(100) {
            assert_eq!(impact.time, 0.0, "({q}, {e}), strike {}", impact.number);
            assert_eq!((impact.end, impact.delta_v), (same.end, same.delta_v), "({q}, {e})");
        }
        let (s, same) = (bar(q, e).summary(&flat), bar(q, e).summary(&Start::default()));
        assert_eq!((s.duration, s.count, s.peak, s.net), (0.0, same.count, same.peak, same.net), "({q}, {e})");
    }
}

/// Checks drops with end b at rest or on its way up at first contact.
#[test]
fn an_end_that_rises_at_first_contact() {
    // T = 0.65: at rest it is thrown down; from v_b = 0.65 on it is not.
    let reference = bar(0.5, 0.3);
    assert_eq!(reference.count(&start(-1.0, 0.65)), Count::Finite(1), "a_1 = 0 or a rounding above");
    assert_eq!(reference.count(&start(-1.0, 0.66)), Count::Finite(1));
    for vb in [0.0, -0.0, 0.3, 0.6, 0.64, 0.649_999] {
        let mut exact = Whole::new(0.5, 0.3, -1.0, vb);
        exact.step();
        while !exact.ended() {
            exact.step();
        }
        assert_eq!(reference.count(&start(-1.0, vb)), Count::Finite(exact.n), "v_b = {vb}");
    }
    // So fast a spin that even a bar of the endless region leaves: v_b > λ₊ = (T + √(T² − 4e))/2.
    let inside = bar(0.9, 0.3);
    assert_eq!(inside.count(&Start::default()), Count::Endless);
    let plus = 0.5 * (1.17 + f64::sqrt(1.17 * 1.17 - 1.2));
    assert_eq!(inside.count(&start(-1.0, plus * (1.0 - 1e-9))), Count::Endless);
    assert!(matches!(inside.count(&start(-1.0, plus * (1.0 + 1e-9))), Count::Finite(_)), "it leaves");
}

/// The largest shock may come first or far along.
#[test]
fn the_peak_is_at_the_first_impact_or_far_along() {
    assert_eq!(bar(-0.2, 0.5).peak(&Start::default()).impact, PeakImpact::Number(1));
    for (q, e, far) in [(0.9, 0.9, 3), (0.999, 0.999, 30), (0.999_99, 0.999_99, 300)] {
        let mut exact = Whole::new(q, e, -1.0, -1.0);
        // |a_n| rises to the peak, then falls: a_n as integers of one more factor 2^r.
        while (&exact.a[0] << exact.r) > exact.a[1] {
            exact.step();
        }
        let peak = bar(q, e).peak(&Start::default());
        assert_eq!(peak.impact, PeakImpact::Number(exact.n + 1), "({q}, {e})");
        assert!(close(peak.end, (1.0 + e) * -exact.approach(), PEAK.error), "({q}, {e}): {}", peak.end);
        assert!(exact.n >= far, "({q}, {e}): far along, {}", exact.n);
    }
}

/// Eq. 5 below 0 and beyond 1 are answers, not errors: Table 1's first column.
#[test]
fn a_safe_zone_may_be_negative_or_beyond_the_bar() {
    let zone = |q, e, threshold| bar(q, e).shocks_either(&Start::default()).safe_zone(threshold);
    // Peak (1.3)(1.65) = 2.145: s = (2/2.145 · 0.5 − 0.5)/1.5.
    let none = zone(0.5, 0.3, 0.5);
    assert!((none.s - (1.0 / 2.145 - 0.5) / 1.5).abs() < 1e-12 && none.s < 0.0, "{}", none.s);
    assert_eq!(none.extent, Extent::None);
    // Peak 1.1 · (1 + 0.627) = 1.7897: s = (4/1.7897 − 0.43)/1.57.
    let whole = zone(0.57, 0.1, 2.0);
    assert!((whole.s - (4.0 / 1.7897 - 0.43) / 1.57).abs() < 1e-12 && whole.s > 1.0, "{}", whole.s);
    assert_eq!(whole.extent, Extent::Whole);
    assert_eq!(zone(0.5, 0.3, 1.0).extent, Extent::Part);
    // No number is no zone.
    assert_eq!(zone(0.5, 0.3, f64::NAN).extent, Extent::None);
    assert_eq!(bar(0.5, 0.3).shocks(&Start::default(), End::A).safe_interval(f64::NAN), None);
}

/// Table 1 prints 90.9 % for 90.987 %, 0 % for −2.25 % and 100 % for 114.97 %.
#[test]
fn table_1_was_truncated_in_one_cell_and_clipped_in_two() {
    let percent = |q, e, threshold| 100.0 * bar(q, e).shocks_either(&Start::default()).safe_zone(threshold).s;
    for (got, want, digits) in [
        (percent(0.5, 0.3, 2.0), 90.987, 5e-4),
        (percent(0.5, 0.3, 0.5), -2.25, 5e-3),
        (percent(0.57, 0.1, 2.0), 114.97, 5e-3),
    ] {
        assert!((got - want).abs() <= digits, "{got} not {want}");
    }
    for ((q, e), n) in [((0.5, 0.3), 4), ((0.73, 0.2), 16), ((0.67, 0.15), 31), ((0.57, 0.1), 24)] {
        assert_eq!(bar(q, e).count(&Start::default()), Count::Finite(n), "({q}, {e})");
    }
}

/// Next to e = 0 the amplitude that the train would have had before its first strike may be no float.
#[test]
fn an_amplitude_out_of_range_gives_approaches_within() {
    let train = bar(5e-324, 5e-324).train(&start(-1.0, -1e150));
    let approaches: Vec<_> = train.map(|impact| impact.approach).collect();
    assert!(approaches.len() == 3, "{approaches:?}");
    for (got, want) in approaches.into_iter().zip([-1.0, -1e150, -1e150 * 5e-324]) {
        assert!(close(got, want, APPROACH.error), "{got:e}, not {want:e}");
    }
}

/// Velocities and heights whose squares leave the range of floats decide as well as any others.
#[test]
fn tiny_and_huge_velocities_and_heights_lose_no_digit() {
    // Next to the endless curve, where no plain step will do, far from it, and as a sweep; powers of two change no
    // digit.
    for (bar, vb) in [
        (Bar::new(2.086e-4, 1.1e-8).unwrap(), 0.0),
        (Bar::new(0.9978, 1.0).unwrap(), -1.0),
        (Bar::new(3.721_162_980_538_931_4e-8, 3.461_763_481_933_760_5e-16).unwrap(), 0.0),
        (
            Bar::from_gyration_ratio(0.015_380_505_952_165_578, 0.940_327_673_422_922_1).unwrap(),
            0.969_705_833_333_333_3,
        ),
        (Bar::from_gyration_ratio(2.4e-31, 0.367_775_275_916_264_24).unwrap(), 1.0),
    ] {
        let one = bar.summary(&start(-1.0, vb));
        for (x, y) in [(-498, 0), (-340, 0), (400, 0), (498, 0), (0, -498), (0, 498)] {
            let (unit, height) = (2f64.powi(x), 2f64.powi(y));
            let scaled = Start::new([-unit, vb * unit], height).unwrap();
            let s = bar.summary(&scaled);
            assert_eq!((s.count, s.peak.impact), (one.count, one.peak.impact), "2^{x}, {bar:?}");
            assert!(close(s.peak.end, one.peak.end * unit, PEAK.error), "2^{x}: peak");
            let limit = one.duration / unit;
            assert!(
                close(s.duration / height, limit, DURATION_LONG.error) || limit > 1e307,
                "2^{x}: {:e} not {limit:e}",
                s.duration
            );
            for (got, want) in bar.train(&scaled).zip(bar.train(&start(-1.0, vb))).take(40) {
                assert!(close(got.approach, want.approach * unit, APPROACH.error), "2^{x}: strike {}", got.number);
                let time = want.time / unit;
                assert!(
                    close(got.time / height, time, 2.0 * TIME.error) || time > 1e307,
                    "2^{x}: strike {}",
                    got.number
                );
            }
        }
    }
}

/// A start that leaves at once needs no search, though the decay is so slow that its rate is below 10⁻¹⁵⁰.
#[test]
fn a_start_that_leaves_at_once_beside_the_slowest_decay() {
    let bar = bar(2.983_336_292_480_083e-154, f64::MIN_POSITIVE);
    assert_eq!(bar.count(&start(-1.0, 1e-80)), Count::Finite(1));
    assert_eq!(bar.count(&start(-1.0, 1e-200)), Count::Endless);
}

/// The train ends with the last number there is, and gets there at once.
#[test]
fn the_last_impact_that_has_a_number() {
    let last = usize::try_from(u64::MAX - 1).unwrap();
    for (q, e) in [(0.73, 0.1), (0.5, 0.0), (1.0, 0.0), (1.0, 0.5), (1.0, 1.0)] {
        let mut train = bar(q, e).train(&Start::default());
        assert_eq!(train.nth(last).unwrap().number, u64::MAX, "({q}, {e})");
        assert_eq!(train.next(), None, "({q}, {e})");
        assert_eq!(bar(q, e).train(&Start::default()).nth(usize::MAX), None, "({q}, {e})");
    }
    assert_eq!(bar(0.5, 0.3).train(&Start::default()).nth(usize::MAX), None);
}

/// Checks that a map is nowhere NaN, corners of the plane included.
#[test]
fn maps_have_an_answer_at_every_corner() {
    let (q, e) = (Axis::q((-1.0_f64).next_up(), 1.0, 3).unwrap(), Axis::e(0.0, 1.0, 3).unwrap());
    for quantity in [
        Quantity::Impacts,
        Quantity::PeakEnd,
        Quantity::PeakCenter,
        Quantity::PeakAngular,
        Quantity::NetCenter,
        Quantity::Duration,
        Quantity::Zone(1.0),
    ] {
        let map = Map::compute(quantity, q, e).unwrap();
        assert!(map.values.iter().all(|v| !v.is_nan()), "{quantity:?}: {:?}", map.values);
    }
}

/// Next to q = e = 1 velocities rise far above the first one and come down again; what the angle of a late strike is
/// off by counts with the full height. Values of the recurrence in 600 bits.
#[test]
fn late_strikes_next_to_both_limits_keep_their_digits() {
    for (q, e, vb, number, approach) in [
        (0.999_999_984_604_142_2, 0.999_999_999_930_908_9, -0.665_549_294_653_355, 17_903, -1.154_192_970_588_862_5),
        (0.999_999_947_038_309_4, 0.999_999_999_999_572_8, -2.795_569_806_807_307, 9653, -2.090_877_330_817_728_7),
        (0.999_999_933_703_344_2, 0.999_999_999_211_875_7, -1.0, 8627, -2.162_631_372_661_775_3),
    ] {
        let bar = Bar::new(q, e).unwrap();
        let start = Start::new([-1.0, vb], 1.0).unwrap();
        let impact = bar.train(&start).find(|impact| impact.number == number).unwrap();
        let off = (impact.approach - approach).abs() / approach.abs();
        assert!(off <= APPROACH.error, "strike {number} at q = {q}: {off:e}");
    }
}
