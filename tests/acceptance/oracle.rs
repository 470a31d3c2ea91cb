//! The command against `crates/clatter/tests/data/clatter.json`.

use clatter::accuracy;
use serde_json::Value;

use crate::answer;
use crate::cases::{Case, cases, decimal};

/// Of the peaks derived from the one at the ends, relative to that: two roundings more than [`accuracy::PEAK`] allow.
const DERIVED_PEAK: f64 = 1e-12;
/// Of the safe zone, relative to the larger of it and 1: [`accuracy::PEAK`] over 1 + q, which is not small here.
const ZONE: f64 = 1e-12;

fn inertia(case: &Case) -> String {
    match (case.q, case.k) {
        (Some(q), _) => format!("--q={q:?}"),
        (None, k) => format!("--gyration-ratio={:?}", k.unwrap()),
    }
}

fn inertia_ratio(case: &Case) -> f64 {
    case.q.unwrap_or_else(|| {
        let k = case.k.unwrap();
        (1.0 - k * k) / (1.0 + k * k)
    })
}

fn impacts(case: &Case) -> Value {
    answer([
        "impacts",
        &inertia(case),
        &format!("--e={:?}", case.e),
        &format!("--velocity={:?},{:?}", case.va, case.vb),
        "--height-gap=1",
        "--limit=10",
    ])
}

#[expect(clippy::float_cmp, reason = "the inputs of the oracle are exact")]
fn falls_flat(case: &Case) -> bool {
    [case.va, case.vb] == [-1.0, -1.0]
}

/// Runs `check` on every case; it returns what is off.
fn for_every_case(check: impl Fn(&Case) -> Vec<Option<String>>) {
    let (cases, mut off) = (cases(), Vec::new());
    for case in &cases {
        let wrong: Vec<_> = check(case).into_iter().flatten().collect();
        if !wrong.is_empty() {
            let Case { name, e, va, vb, .. } = case;
            off.push(format!("{name} {} --e={e:?} --velocity={va:?},{vb:?}: {}", inertia(case), wrong.join("; ")));
        }
    }
    assert!(off.is_empty(), "{} of {} cases are off:\n{}", off.len(), cases.len(), off.join("\n"));
}

/// What is off about a number that must lie within `allowed` times `scale` of `want`.
fn off(name: &str, got: &Value, want: f64, allowed: f64, scale: f64) -> Option<String> {
    let close = got.as_f64().is_some_and(|got| (got - want).abs() <= allowed * scale);
    (!close).then(|| format!("{name} is {got}, not {want:?} (allowed {allowed:e} of {scale:e})"))
}

/// What is off about a value that must be exactly so.
fn differs(name: &str, got: &Value, want: impl Into<Value>) -> Option<String> {
    let want = want.into();
    (*got != want).then(|| format!("{name} is {got}, not {want}"))
}

#[test]
fn the_count_is_exact() {
    for_every_case(|case| {
        let got = impacts(case);
        let want = case.count().map_or(Value::from("endless"), Value::from);
        vec![differs("count", &got["count"], want), differs("count_exact", &got["count_exact"], true)]
    });
}

#[test]
fn the_peak_and_the_impact_that_holds_it_are_right() {
    for_every_case(|case| {
        let (got, peak) = (&impacts(case)["peak"], decimal(&case.peak_end_dv));
        let mut wrong = if peak.is_infinite() {
            vec![differs("peak.end", &got["end"], "infinite"), differs("peak.center", &got["center"], 0.0)]
        } else {
            let q = inertia_ratio(case);
            vec![
                off("peak.end", &got["end"], peak, accuracy::PEAK.error, peak),
                off("peak.center", &got["center"], 0.5 * (1.0 - q) * peak, DERIVED_PEAK, peak),
                off("peak.angular", &got["angular"], 0.5 * (1.0 + q) * peak, DERIVED_PEAK, peak),
            ]
        };
        if case.is_short() {
            wrong.push(differs("peak.impact", &got["impact"], case.peak_index.clone()));
        }
        wrong
    });
}

#[test]
fn the_duration_is_right_also_where_the_train_is_endless() {
    for_every_case(|case| {
        let (got, want) = (impacts(case), decimal(&case.duration));
        let allowed = match (case.is_at_the_edge(), case.is_short()) {
            (true, _) => accuracy::NEAR_ENDLESS.error,
            (false, true) => accuracy::DURATION.error,
            (false, false) => accuracy::DURATION_LONG.error,
        };
        vec![if want.is_infinite() {
            differs("duration", &got["duration"], "infinite")
        } else {
            off("duration", &got["duration"], want, allowed, want.max(1.0))
        }]
    });
}

#[test]
fn the_velocities_at_the_end_and_their_net_change_are_right() {
    for_every_case(|case| {
        let got = impacts(case);
        let Some(last) = case.last() else {
            let net = &got["net"];
            return vec![
                differs("final", &got["final"], Value::Null),
                differs("net.a", &net["a"], Value::Null),
                differs("net.b", &net["b"], Value::Null),
                differs("net.center", &net["center"], 0.0),
                differs("net.angular", &net["angular"], Value::Null),
            ];
        };
        if !case.is_short() {
            return vec![];
        }
        let allowed = if case.is_at_the_edge() { accuracy::NEAR_ENDLESS.error } else { accuracy::FINAL.error };
        let larger = last[0].abs().max(last[1].abs());
        let [da, db] = [last[0] - case.va, last[1] - case.vb];
        vec![
            off("final[0]", &got["final"][0], last[0], allowed, larger),
            off("final[1]", &got["final"][1], last[1], allowed, larger),
            off("net.a", &got["net"]["a"], da, allowed, larger.max(case.va.abs())),
            off("net.b", &got["net"]["b"], db, allowed, larger.max(case.vb.abs())),
            off("net.center", &got["net"]["center"], 0.5 * (da + db), allowed, 1.0),
            off("net.angular", &got["net"]["angular"], 0.5 * (db - da), allowed, 1.0),
        ]
    });
}

#[test]
fn the_first_impacts_are_right_one_by_one() {
    for_every_case(|case| {
        let (answer, q) = (impacts(case), inertia_ratio(case));
        let Value::Array(listed) = &answer["impacts"] else { return vec![Some("no list of impacts".to_owned())] };
        let expected = case.count().map_or(10, |n| n.min(10));
        let mut wrong = vec![differs("number of impacts listed", &Value::from(listed.len()), expected)];
        let allowed_time = if case.is_at_the_edge() { accuracy::NEAR_ENDLESS.error } else { accuracy::TIME.error };
        for (i, (got, (approach, time))) in listed.iter().zip(case.approach.iter().zip(&case.times)).enumerate() {
            let (approach, time) = (decimal(approach), decimal(time));
            let scale = approach.abs().max(case.va.abs());
            let (hit, far) = (-(1.0 + case.e) * approach, q * (1.0 + case.e) * approach);
            let (end, [a, b]) = if i % 2 == 0 { ("a", [hit, far]) } else { ("b", [far, hit]) };
            wrong.extend([
                differs("number", &got["number"], i + 1),
                differs("end", &got["end"], end),
                off("approach", &got["approach"], approach, accuracy::APPROACH.error, scale),
                off("time", &got["time"], time, allowed_time, time.max(1.0)),
                off("delta_v[0]", &got["delta_v"][0], a, accuracy::JUMP.error, 2.0 * scale),
                off("delta_v[1]", &got["delta_v"][1], b, accuracy::JUMP.error, 2.0 * scale),
            ]);
        }
        wrong
    });
}

#[test]
fn the_safe_zone_is_right_and_says_what_it_means() {
    for_every_case(|case| {
        let peak = decimal(&case.peak_end_dv);
        // The command takes bars without spin alone; without a finite peak there is no zone to compare.
        if !falls_flat(case) || peak.is_infinite() {
            return vec![];
        }
        let thresholds = [0.5, 1.0, 2.0];
        let flags = thresholds.map(|threshold| format!("--threshold={threshold:?}"));
        let arguments = ["zone".to_owned(), inertia(case), format!("--e={:?}", case.e)];
        let got = answer(arguments.into_iter().chain(flags));
        let q = inertia_ratio(case);
        let mut wrong = Vec::new();
        for (i, threshold) in thresholds.into_iter().enumerate() {
            let (got, s) = (&got["zones"][i], (2.0 * threshold / peak + q - 1.0) / (1.0 + q));
            let extent = if s < 0.0 {
                "none"
            } else if s < 1.0 {
                "part"
            } else {
                "whole"
            };
            wrong.push(differs("threshold", &got["threshold"], threshold));
            wrong.push(off("s", &got["s"], s, ZONE, s.abs().max(1.0)));
            // On the border itself a rounding decides between two right answers.
            if s.abs().min((s - 1.0).abs()) > 1e-9 {
                wrong.push(differs("extent", &got["extent"], extent));
            }
        }
        wrong
    });
}
