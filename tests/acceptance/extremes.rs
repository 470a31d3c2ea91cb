//! Whatever numbers come, the answer is whole or there is one message: never a panic, a NaN or a hang.

use clatter_cli::Exit;
use proptest::prelude::*;
use proptest::sample::select;

use crate::clatter;

/// Numbers where something ends: of the ranges, of the floats, of what a digit can tell.
const EDGES: [f64; 26] = [
    0.0,
    -0.0,
    5e-324,
    f64::MIN_POSITIVE,
    1e-150,
    f64::EPSILON,
    0.25,
    0.5,
    -0.5,
    0.799_999_999_999_999_9,
    1.0 - f64::EPSILON / 2.0,
    1.0,
    1.0 + f64::EPSILON,
    2.0,
    1e16,
    1e150,
    1e308,
    f64::INFINITY,
    f64::NAN,
    -1.0,
    -1.0 + f64::EPSILON / 2.0,
    -1e-150,
    -2.0,
    -1e150,
    -1e308,
    f64::NEG_INFINITY,
];

/// Any f64 at all, most of them where something ends or in the range that bars have.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => select(EDGES.as_slice()), 4 => -1.0..=1.0, 1 => any::<f64>()]
}

/// Either the whole answer in JSON that a strict reader takes, or one message.
fn is_answered(arguments: &[String]) -> Result<(), TestCaseError> {
    let outcome = clatter(arguments);
    if outcome.exit == Exit::Done {
        let json: Result<serde_json::Value, _> = serde_json::from_str(&outcome.stdout);
        prop_assert!(json.is_ok(), "{arguments:?}: {}", outcome.stdout);
        prop_assert_eq!(outcome.stderr, "");
    } else {
        prop_assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{:?}", arguments);
        prop_assert_eq!(outcome.stderr.matches("error: ").count(), 1, "{:?}: {}", arguments, outcome.stderr);
        prop_assert!(!outcome.stderr.contains("came out as not a number"), "{arguments:?}: {}", outcome.stderr);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn impacts_answers_any_numbers(
        by_k in any::<bool>(), inertia in number(), e in number(),
        va in prop_oneof![1 => number(), 3 => Just(-1.0)], vb in number(), gap in number(), s in number(),
    ) {
        let inertia = format!("--{}={inertia:?}", if by_k { "gyration-ratio" } else { "q" });
        let rest = [format!("--e={e:?}"), format!("--velocity={va:?},{vb:?}"), format!("--height-gap={gap:?}"), format!("--at={s:?}")];
        let fixed = ["impacts", "--limit=3", "--format=json"].map(str::to_owned);
        is_answered(&[&fixed[..], &[inertia], &rest].concat())?;
    }

    #[test]
    fn zone_answers_any_numbers(by_k in any::<bool>(), inertia in number(), e in number(), threshold in number(), b in any::<bool>()) {
        let inertia = format!("--{}={inertia:?}", if by_k { "gyration-ratio" } else { "q" });
        let first = format!("--first={}", if b { "b" } else { "a" });
        let fixed = ["zone", "--format=json"].map(str::to_owned);
        is_answered(&[&fixed[..], &[inertia, format!("--e={e:?}"), format!("--threshold={threshold:?}"), first]].concat())?;
    }
}
