//! The train at its extremes: this library and the plain ways compared with 512 digits of the same recurrence.

use clatter::accuracy::{APPROACH, Allowance, DURATION, DURATION_LONG, FINAL, JUMP, NEAR_ENDLESS, PEAK, SHORT, TIME};
use clatter::{Bar, Count, Start};

use super::big::{Big, off};
use super::plain::{closed, recurrence};
use crate::Error;

/// The inertia of a bar, by one of two ratios.
#[derive(Debug, Clone, Copy)]
pub(super) enum Inertia {
    /// Inertia ratio q.
    Q(f64),
    /// Gyration ratio k = ρ/L.
    K(f64),
}

/// A drop that is hard on digits.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) given: Inertia,
    pub(super) e: f64,
    pub(super) velocity: [f64; 2],
    pub(super) gap: f64,
    /// A start within 1e−9 of the edge of endless.
    edge: bool,
}

/// A number of impacts as found by some method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Found {
    Impacts(u64),
    Endless,
    /// Unknown after [`LONG`] steps.
    Open,
    /// No number as result.
    Nothing,
}

/// One strike: approach velocity, jump of the struck end, time.
pub(super) type Strike = [f64; 3];

/// The results of a method for a train.
#[derive(Debug, Clone)]
pub(super) struct Answer {
    pub(super) found: Found,
    pub(super) peak: f64,
    pub(super) strikes: Vec<Option<Strike>>,
    pub(super) last: Option<[f64; 2]>,
    pub(super) duration: f64,
}

/// The number of compared quantities, and of their errors.
pub(super) const QUANTITIES: usize = 6;

/// An allowance if there is one, and the largest error, if it was measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Comparison {
    pub(super) allowed: Option<Allowance>,
    pub(super) error: Option<f64>,
}

/// One method, compared with the exact values: peak, approach velocity, jump, time, final velocity, duration.
#[derive(Debug, Clone)]
pub(super) struct Way {
    pub(super) found: Found,
    pub(super) compared: [Comparison; QUANTITIES],
}

/// One case: the exact count, and the three methods.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) case: Case,
    pub(super) exact: Found,
    pub(super) ours: Way,
    pub(super) recurrence: Way,
    pub(super) closed: Way,
}

/// Steps of a plain loop.
pub(super) const LONG: u64 = 1_000_000;
/// The last strike that is compared of an endless train.
const FAR: u64 = 1000;

pub(super) fn cases() -> Vec<Case> {
    let at = |name, given, e| Case { name, given, e, velocity: [-1.0, -1.0], gap: 1.0, edge: false };
    let q = |name, q, e| at(name, Inertia::Q(q), e);
    let k = |name, k, e| at(name, Inertia::K(k), e);
    vec![
        q("ordinary", 0.5, 0.3),
        q("q → 1, endless", 1.0 - f64::EPSILON / 2.0, 0.5),
        q("q = 1", 1.0, 0.5),
        k("q → 1, given k", 1e-8, 1.0),
        q("e → 1", 0.9, 1.0 - f64::EPSILON / 2.0),
        q("e → 0", 0.5, 1e-300),
        q("e = 0", 0.5, 0.0),
        q("endless", 0.45, 0.04),
        q("one float below", 0.799_999_999_999_999_9, 0.25),
        q("one float beyond", 0.8, 0.25),
        q("thousands", 0.984_304_929_263_587, 0.7),
        q("beyond 2⁵³", 2.0 * 2f64.powi(-26) / (1.0 + f64::EPSILON), f64::EPSILON),
        q("tie", -0.5, 1.0),
        // v_a b₃ + v_b b₂ = 0 exactly
        Case { velocity: [-1.968_75, 2.875_976_562_5], ..q("tie of a start", 0.984_375, 1.0) },
        Case { velocity: [-1.0, 0.6], ..q("start that spins", 0.97, 0.3) },
        Case { velocity: [-1.0, 0.820_194_101_601_103_8], edge: true, ..q("one float spun out", 0.9, 0.25) },
        Case { gap: 0.0, ..q("flat drop", 0.73, 0.2) },
    ]
}

/// The recurrence in 512 bits.
pub(super) struct Exact {
    q: Big,
    e: Big,
    t: Big,
    v: [Big; 2],
    gap: Big,
}

impl Exact {
    pub(super) fn new(case: &Case) -> Self {
        let one = Big::from(1.0);
        let q = match case.given {
            Inertia::Q(q) => Big::from(q),
            Inertia::K(k) => {
                let square = &Big::from(k) * &Big::from(k);
                &(&one - &square) / &(&one + &square)
            }
        };
        let e = Big::from(case.e);
        let t = &q * &(&one + &e);
        Self { q, e, t, v: case.velocity.map(Big::from), gap: Big::from(case.gap) }
    }
    /// Returns b_n and b_{n+1} by doubling: b_{2m} = b_m (2 b_{m+1} − T b_m), b_{2m+1} = b_{m+1}² − e b_m².
    fn companion(&self, n: u64) -> [Big; 2] {
        let (mut low, mut high) = (Big::zero(), Big::from(1.0));
        for bit in (0..u64::BITS - n.leading_zeros()).rev() {
            let even = &low * &(&high.scale(1) - &(&self.t * &low));
            let odd = &(&high * &high) - &(&self.e * &(&low * &low));
            (low, high) = if n >> bit & 1 == 0 {
                (even, odd)
            } else {
                let next = &(&self.t * &odd) - &(&self.e * &even);
                (odd, next)
            };
        }
        [low, high]
    }
    /// Returns a_n = v_a b_{n+1} + v_b b_n and b_n.
    fn term(&self, n: u64) -> [Big; 2] {
        let [b, next] = self.companion(n);
        [&(&self.v[0] * &next) + &(&self.v[1] * &b), b]
    }
    fn strikes(&self, n: u64) -> bool {
        self.term(n)[0].is_negative()
    }
    /// Returns 4e − T².
    pub(super) fn discriminant(&self) -> Big {
        &self.e.scale(2) - &(&self.t * &self.t)
    }
    /// Returns v_b − λ₊|v_a| for a real λ₊.
    fn beyond_edge(&self) -> Big {
        let root = &(&self.t + &(-&self.discriminant()).sqrt()).scale(-1);
        &self.v[1] + &(root * &self.v[0])
    }
    /// Returns the first n ≥ 1 with a_n ≥ 0. The first wave of negative velocities is no shorter than the positive one
    /// after it, so that doubling cannot step over that.
    fn count(&self) -> Found {
        if let Some(n) = (1..=2).find(|&n| !self.strikes(n)) {
            return Found::Impacts(n);
        }
        let real = self.discriminant().is_negative() || self.discriminant().is_zero();
        if self.e.is_zero() || real && (self.beyond_edge().is_negative() || self.beyond_edge().is_zero()) {
            return Found::Endless;
        }
        let (mut low, mut high) = (2, 4_u64);
        while self.strikes(high) {
            (low, high) = (high, 2 * high);
        }
        Found::Impacts(first(low, high, |n| !self.strikes(n)))
    }
    /// Returns (1 + e) max |a_n|: the velocities rise to their largest and fall.
    pub(super) fn peak(&self, count: Found) -> Big {
        let one = Big::from(1.0);
        let end = if let Found::Impacts(n) = count { n - 1 } else { FAR };
        let falls = |n: u64| !(&self.term(n + 1)[0] - &self.term(n)[0]).is_negative();
        let largest = if end > 0 && !falls(end - 1) { end } else { first_from(0, end, falls) };
        if largest == FAR && (&self.q - &one).is_zero() {
            // Massless ends: |a_n| → 2 v0/(1 − e).
            return &(&one + &self.e).scale(1) / &(&one - &self.e);
        }
        &(&one + &self.e) * &self.term(largest)[0].abs()
    }
    pub(super) fn time(&self, n: u64) -> Big {
        let [a, b] = self.term(n);
        &(&self.gap * &b) / &a.abs()
    }
    fn duration(&self, count: Found) -> Big {
        match count {
            Found::Impacts(n) => self.time(n - 1),
            _ if self.e.is_zero() => self.time(1),
            _ => &self.gap / &(-&self.beyond_edge()),
        }
    }
    fn last(&self, count: Found) -> [Big; 2] {
        let Found::Impacts(n) = count else { return [Big::zero(), Big::zero()] };
        let struck = &-&self.e * &self.term(n - 1)[0];
        let free = self.term(n)[0].clone();
        if n % 2 == 1 { [struck, free] } else { [free, struck] }
    }
}

/// Returns the first n in (low, high] for which `is` holds; it holds at `high`, and at every number after one for which
/// it holds.
fn first(mut low: u64, mut high: u64, is: impl Fn(u64) -> bool) -> u64 {
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is(middle) { high = middle } else { low = middle }
    }
    high
}

/// Returns the same in [low, high].
fn first_from(low: u64, high: u64, is: impl Fn(u64) -> bool) -> u64 {
    if is(low) { low } else { first(low, high, is) }
}

/// Returns the strikes that are compared: the first ten, the last ten, some between.
fn compared_strikes(count: Found) -> Vec<u64> {
    let end = if let Found::Impacts(n) = count { n } else { FAR };
    let mut list: Vec<u64> = (0..end.min(10)).chain(end.saturating_sub(10)..end).collect();
    let mut n = 10;
    while n < end {
        list.push(n);
        n = n * 7 / 3;
    }
    list.sort_unstable();
    list.dedup();
    list
}

fn ours(case: &Case, list: &[u64]) -> Result<Answer, Error> {
    let bar = match case.given {
        Inertia::Q(q) => Bar::new(q, case.e)?,
        Inertia::K(k) => Bar::from_gyration_ratio(k, case.e)?,
    };
    let start = Start::new(case.velocity, case.gap)?;
    let s = bar.summary(&start);
    let strike = |&n: &u64| {
        let i = bar.train(&start).nth(usize::try_from(n).ok()?)?;
        Some([i.approach, i.delta_v[usize::from(n % 2 == 1)], i.time])
    };
    Ok(Answer {
        found: match s.count {
            Count::Finite(n) => Found::Impacts(n),
            Count::Endless => Found::Endless,
            Count::Huge(_) => Found::Nothing,
        },
        peak: s.peak.end,
        strikes: list.iter().map(strike).collect(),
        last: s.final_velocity,
        duration: s.duration,
    })
}

/// Returns the largest of some errors; infinite if one is no number.
fn largest(errors: impl Iterator<Item = f64>) -> Option<f64> {
    errors.map(|x| if x.is_nan() { f64::INFINITY } else { x }).reduce(f64::max)
}

fn compare(case: &Case, exact: &Exact, count: Found, list: &[u64], answer: &Answer) -> Way {
    let first = &exact.v[0].abs();
    let unit = &exact.gap / first;
    let long = matches!(count, Found::Impacts(n) if n > SHORT);
    let near = |allowed| if case.edge { NEAR_ENDLESS } else { allowed };
    let peak = exact.peak(count);
    let duration = exact.duration(count);
    let ends = exact.last(count);
    let size = ends[0].abs().max(&ends[1].abs());
    let mut errors = [const { Vec::new() }; 3];
    for (&n, strike) in list.iter().zip(&answer.strikes) {
        // A loop that was stopped has not reached the others.
        let Some([approach, jump, time]) = *strike else {
            if answer.found != Found::Open {
                for list in &mut errors {
                    list.push(f64::INFINITY);
                }
            }
            continue;
        };
        let [a, b] = exact.term(n);
        let t = &(&exact.gap * &b) / &a.abs();
        let larger = a.abs().max(first);
        errors[0].push(off(approach, &a, &larger));
        errors[1].push(off(jump, &-&(&(&Big::from(1.0) + &exact.e) * &a), &larger.scale(1)));
        errors[2].push(off(time, &t, &t.max(&unit)));
    }
    let settles = count != Found::Endless || !(&exact.q - &Big::from(1.0)).is_zero();
    // For a long train they are below the range of floats.
    let last = answer.last.filter(|_| settles && (size.is_zero() || size.to_f64() > f64::MIN_POSITIVE));
    let of_ends = last.map(|last| off(last[0], &ends[0], &size).max(off(last[1], &ends[1], &size)));
    // A loop that was stopped may not have reached the peak.
    let of_peak = (answer.found != Found::Open || count == Found::Endless).then(|| off(answer.peak, &peak, &peak));
    let of_duration = (answer.found != Found::Open).then(|| off(answer.duration, &duration, &duration.max(&unit)));
    let [approach, jump, time] = errors.map(|list| largest(list.into_iter()));
    let row = |allowed, error| Comparison { allowed, error };
    Way {
        found: answer.found,
        compared: [
            row(Some(PEAK), of_peak),
            row(Some(APPROACH), approach),
            row(Some(JUMP), jump),
            row(Some(near(TIME)), time),
            row((!long).then_some(near(FINAL)), of_ends),
            row(Some(near(if long { DURATION_LONG } else { DURATION })), of_duration),
        ],
    }
}

impl Row {
    pub(super) fn new(case: &Case) -> Result<Self, Error> {
        let exact = Exact::new(case);
        let count = exact.count();
        let list = compared_strikes(count);
        let way = |answer: &Answer| compare(case, &exact, count, &list, answer);
        Ok(Self {
            case: case.clone(),
            exact: count,
            ours: way(&ours(case, &list)?),
            recurrence: way(&recurrence(case, &list)),
            closed: way(&closed(case, &list)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// The reference itself is checked: 512 digits against exact rational arithmetic, 24 digits of it.
    #[test]
    fn exact_values_are_those_of_rational_arithmetic() {
        let oracle: Value =
            serde_json::from_str(include_str!("../../../crates/clatter/tests/data/clatter.json")).unwrap();
        let cases = oracle["cases"].as_array().unwrap();
        assert_eq!(cases.len(), 212, "the oracle is whole");
        for c in cases {
            let name = c["case"].as_str().unwrap();
            let number = |key: &str| c[key].as_f64().unwrap();
            let given = c["q"].as_f64().map_or_else(|| Inertia::K(number("k")), Inertia::Q);
            let (e, velocity) = (number("e"), [number("va"), number("vb")]);
            if name == "all-mass-at-center-5" {
                continue; // (1, 1): an infinite peak
            }
            let case = Case { name: "", given, e, velocity, gap: 1.0, edge: false };
            let exact = Exact::new(&case);
            let count = exact.count();
            assert_eq!(count, c["impacts"].as_u64().map_or(Found::Endless, Found::Impacts), "{name}: count");
            let close = |got: &Big, want: &Value, what: &str| {
                let want: f64 = want.as_str().unwrap().parse().unwrap();
                let off = (got.to_f64() - want).abs();
                assert!(off <= f64::EPSILON * want.abs(), "{name}: {what} {:e}, not {want:e}", got.to_f64());
            };
            close(&exact.peak(count), &c["peak_end_dv"], "peak");
            close(&exact.duration(count), &c["duration"], "duration");
            for (n, (a, t)) in c["approach"].as_array().unwrap().iter().zip(c["times"].as_array().unwrap()).enumerate()
            {
                let n = n as u64;
                close(&exact.term(n)[0], a, "approach");
                close(&exact.time(n), t, "time");
            }
            if let (Found::Impacts(_), Some(ends)) = (count, c["final"].as_array()) {
                for (got, want) in exact.last(count).iter().zip(ends) {
                    close(got, want, "final velocity");
                }
            }
        }
    }
}
