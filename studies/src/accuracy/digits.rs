//! A few numbers in full: exact, ours, and the result of plain f64 by a formula as it is printed.

use clatter::{Bar, Start};
use clatter_figures::raised;

use super::big::Big;
use super::part::{self, START};
use super::plain::{closed, recurrence};
use super::train::{Case, Exact, Found, Inertia, Row};
use crate::Error;

/// A number or a word.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Number(Big),
    Count(u64),
    Word(&'static str),
}

/// One line: the quantity, its plain formula, and the three values.
#[derive(Debug)]
pub(super) struct Line {
    pub(super) what: &'static str,
    pub(super) at: String,
    pub(super) formula: &'static str,
    pub(super) exact: Value,
    pub(super) ours: Value,
    pub(super) plain: Value,
}

fn number(v: f64) -> Value {
    match v {
        v if v.is_nan() => Value::Word("NaN"),
        v if v.is_infinite() => Value::Word("∞"),
        v => Value::Number(Big::from(v)),
    }
}

fn found(found: Found) -> Value {
    match found {
        Found::Impacts(n) => Value::Count(n),
        Found::Endless => Value::Word("endless"),
        Found::Open => Value::Word("open"),
        Found::Nothing => Value::Word("NaN"),
    }
}

/// Returns the text for a case.
pub(super) fn inputs(case: &Case) -> String {
    let given = match case.given {
        Inertia::Q(q) => format!("q = {}", short(q)),
        Inertia::K(k) => format!("k = {}", short(k)),
    };
    format!("{given}, e = {}", short(case.e))
}

/// Returns a float in as few characters as define it: next to 1 by its distance, else in its shortest form.
fn short(v: f64) -> String {
    let off = 1.0 - v;
    if off > 0.0 && off <= 4.0 * f64::EPSILON {
        return format!("1 − 2{}", raised(&off.log2().round().to_string()));
    }
    if v != 0.0 && !(1e-3..1e4).contains(&v.abs()) {
        let (mantissa, exponent) = libm::frexp(v);
        if (mantissa - 0.5).abs() < f64::EPSILON {
            return format!("2{}", raised(&(exponent - 1).to_string()));
        }
        let text = format!("{v:e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let power = format!("10{}", raised(exponent));
        return if digits == "1" { power } else { format!("{digits}·{power}") };
    }
    v.to_string().replace('-', "−")
}

/// Returns the text for a case with its start.
fn inputs_with_start(case: &Case) -> String {
    let [a, b] = case.velocity;
    #[expect(clippy::float_cmp, reason = "the default, to the bit")]
    let plain = a == -1.0 && b == -1.0;
    let start = if plain { String::new() } else { format!(", v = [{}, {}]", short(a), short(b)) };
    inputs(case) + &start
}

/// Returns the lines about trains.
fn trains(rows: &[Row]) -> Result<Vec<Line>, Error> {
    const RECURRENCE: &str = "aₙ₊₁ = T aₙ − e aₙ₋₁";
    const CLOSED: &str = "⌈(π − φ)/acos(T/2√e)⌉";
    let mut lines = Vec::new();
    let of = |name: &str| rows.iter().find(|row| row.case.name == name);
    let mut count = |name, formula, by_recurrence: bool| {
        if let Some(row) = of(name) {
            let plain = if by_recurrence { &row.recurrence } else { &row.closed };
            lines.push(Line {
                what: "number of impacts",
                at: inputs_with_start(&row.case),
                formula,
                exact: found(row.exact),
                ours: found(row.ours.found),
                plain: found(plain.found),
            });
        }
    };
    count("endless", RECURRENCE, true);
    count("one float below", CLOSED, false);
    count("q → 1, given k", CLOSED, false);
    count("beyond 2⁵³", CLOSED, false);
    count("tie of a start", CLOSED, false);
    if let Some(row) = of("q → 1, given k")
        && let Inertia::K(k) = row.case.given
    {
        let peak = Bar::from_gyration_ratio(k, row.case.e)?.summary(&Start::default()).peak;
        let square = &Big::from(k) * &Big::from(k);
        let share = &square / &(&Big::from(1.0) + &square);
        let q = (1.0 - k * k) / (1.0 + k * k);
        lines.push(Line {
            what: "largest shock of the center",
            at: inputs(&row.case),
            formula: "(1 − q)/2 · Δvₘₐₓ",
            exact: Value::Number(&share * &Exact::new(&row.case).peak(row.exact)),
            ours: number(peak.center),
            plain: number((1.0 - q) / 2.0 * peak.end),
        });
    }
    if let Some(row) = of("thousands")
        && let Found::Impacts(n) = row.exact
    {
        let Inertia::Q(q) = row.case.given else { return Ok(lines) };
        let time = Bar::new(q, row.case.e)?.summary(&Start::default()).duration;
        lines.push(Line {
            what: "time of the last impact",
            at: inputs(&row.case),
            formula: RECURRENCE,
            exact: Value::Number(Exact::new(&row.case).time(n - 1)),
            ours: number(time),
            plain: number(recurrence(&row.case, &[]).duration),
        });
    }
    if let Some(row) = of("one float spun out")
        && let Found::Impacts(n) = row.exact
    {
        let Inertia::Q(q) = row.case.given else { return Ok(lines) };
        let start = Start::new(row.case.velocity, row.case.gap)?;
        lines.push(Line {
            what: "time of the last impact",
            at: inputs_with_start(&row.case),
            formula: "h₀ bₙ/|A λ₊ⁿ + B λ₋ⁿ|",
            exact: Value::Number(Exact::new(&row.case).time(n - 1)),
            ours: number(Bar::new(q, row.case.e)?.summary(&start).duration),
            plain: number(closed(&row.case, &[]).duration),
        });
    }
    Ok(lines)
}

/// Returns the lines about a suspended part.
fn parts() -> Result<Vec<Line>, Error> {
    let mut lines = Vec::new();
    let mut free = |what, zeta: f64, name: &str, (at, omega, t): (&str, f64, f64), formula| {
        let ([x, _], _) = part::free_exact(zeta, omega, t);
        let after = part::mount(omega, zeta)?.free(START, t);
        lines.push(Line {
            what,
            at: format!("ζ = {name}, ωt = {at}"),
            formula,
            exact: Value::Number(x),
            ours: number(omega * after.displacement),
            plain: number(part::free_plain(zeta, omega, t)[0]),
        });
        Ok::<_, Error>(())
    };
    free("free motion, ωz", 1.0 + f64::EPSILON, "1 + 2⁻⁵²", ("1", 2.0, 0.5), "A e^(−sτ) + B e^(−rτ)")?;
    free("free motion, ωz", 50.0, "50", ("512", 2.0, 256.0), "s = ζ − √(ζ² − 1)")?;
    free("free motion, ωz", 0.0, "0", part::FREE_AT[5], "x₀ cos ωt + y₀ sin ωt")?;
    for (name, omega) in [part::PULSE_AT[2], part::PULSE_AT[3]] {
        lines.push(Line {
            what: "end of a half-sine, ωz",
            at: format!("ζ = 0, ωD = {name}"),
            formula: "(sin ωt − (ω/ν) sin νt)/(ω² − ν²)",
            exact: Value::Number(part::pulse_exact(0.0, omega)[0].clone()),
            ours: number(part::pulse_ours(0.0, omega)?[0]),
            plain: number(part::pulse_plain(0.0, omega)[0]),
        });
    }
    let samples = part::record();
    for (name, share) in [part::RECORD_AT[0], part::RECORD_AT[2]] {
        lines.push(Line {
            what: "record, peak |A|/ω",
            at: format!("ζ = 0.05, f/fₛ = {name}"),
            formula: "b₀ = 1 − e^(−ζωT) sin K/K, …",
            exact: Value::Number(part::record_exact(0.05, share, &samples)),
            ours: number(part::record_ours(0.05, share, &samples)?),
            plain: number(part::record_plain(0.05, share, &samples)),
        });
    }
    Ok(lines)
}

pub(super) fn lines(rows: &[Row]) -> Result<Vec<Line>, Error> {
    let mut lines = trains(rows)?;
    lines.extend(parts()?);
    Ok(lines)
}
