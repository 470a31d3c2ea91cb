//! Whatever numbers come, the answer is whole or there is one message: never a panic, a NaN or a hang.

use clatter_cli::Exit;
use proptest::prelude::*;
use proptest::sample::select;

use crate::{clatter, warns_of_slips_alone};

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
    // A limit may be exceeded.
    let exceeds = outcome.exit == Exit::Unsafe && arguments[0] == "spectrum";
    if outcome.exit == Exit::Done || exceeds {
        let json: Result<serde_json::Value, _> = serde_json::from_str(&outcome.stdout);
        prop_assert!(json.is_ok(), "{arguments:?}: {}", outcome.stdout);
        prop_assert!(warns_of_slips_alone(&outcome.stderr), "{arguments:?}: {}", outcome.stderr);
    } else {
        prop_assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{:?}", arguments);
        prop_assert_eq!(outcome.stderr.matches("error: ").count(), 1, "{:?}: {}", arguments, outcome.stderr);
        prop_assert!(!outcome.stderr.contains("came out as not a number"), "{arguments:?}: {}", outcome.stderr);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

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
    fn off_center_bars_answer_any_numbers(
        k in number(), c in number(), e in number(), masses in proptest::collection::vec([number(), number()], 1..4), list in any::<bool>(),
    ) {
        let layout = if list {
            masses.iter().map(|[m, s]| format!("--mass={:?}@{s:?}", m.abs())).collect()
        } else {
            vec![format!("--gyration-ratio={k:?}"), format!("--center-of-mass={c:?}")]
        };
        for command in [&["impacts", "--limit=3"][..], &["zone", "--threshold=0.5", "--first=b"]] {
            let fixed = command.iter().chain(&["--format=json"]).map(|&argument| argument.to_owned()).collect::<Vec<_>>();
            is_answered(&[&fixed[..], &layout, &[format!("--e={e:?}")]].concat())?;
        }
    }

    #[test]
    fn zone_answers_any_numbers(by_k in any::<bool>(), inertia in number(), e in number(), threshold in number(), b in any::<bool>()) {
        let inertia = format!("--{}={inertia:?}", if by_k { "gyration-ratio" } else { "q" });
        let first = format!("--first={}", if b { "b" } else { "a" });
        let fixed = ["zone", "--format=json"].map(str::to_owned);
        is_answered(&[&fixed[..], &[inertia, format!("--e={e:?}"), format!("--threshold={threshold:?}"), first]].concat())?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Speeds and gravity as there are: a flight whose time has no digits left for a turn of the body is no subject.
    #[test]
    fn simulate_answers_any_numbers(
        model in select(vec!["map", "ballistic", "finite-tilt"]), length in number(), gyration in number(), c in number(),
        e in number(), speed in -6.0..4.0_f64, tilt in number(), gravity in prop_oneof![Just(0.0), 1e-3..1e3], spin in prop_oneof![Just(0.0), number()],
        limit in prop_oneof![Just(f64::INFINITY), number()],
    ) {
        let file = tempfile::Builder::new().suffix(".svg").tempfile().unwrap();
        let arguments = [
            "simulate".to_owned(),
            format!("--model={model}"),
            format!("--length-m={:?}", length.abs()),
            format!("--gyration-m={:?}", gyration.abs()),
            format!("--center-of-mass={c:?}"),
            format!("--e={:?}", e.abs()),
            format!("--speed-m-s={:?}", 10f64.powf(speed)),
            format!("--tilt-deg={:?}", tilt.abs()),
            format!("--gravity-m-s2={gravity:?}"),
            format!("--spin-rad-s={spin:?}"),
            format!("--time-limit-s={:?}", limit.abs()),
            "--impact-limit=30".to_owned(),
            "--format=json".to_owned(),
            format!("--output={}", file.path().display()),
        ];
        let outcome = clatter(&arguments);
        if outcome.exit == Exit::Done {
            let json: Result<serde_json::Value, _> = serde_json::from_str(&outcome.stdout);
            prop_assert!(json.is_ok(), "{arguments:?}: {}", outcome.stdout);
            let svg = std::fs::read_to_string(file.path()).unwrap();
            prop_assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN") && !svg.contains("inf "), "{arguments:?}: {svg}");
        } else {
            is_answered(&arguments)?;
        }
    }
}

/// A frequency, a damping ratio, a time: zero or more, over all of the floats, and what is none.
fn size() -> impl Strategy<Value = f64> {
    prop_oneof![3 => 0.0..=2.0, 3 => (-15.0..=15.0).prop_map(|x: f64| 10f64.powf(x)), 1 => number()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn respond_answers_any_numbers(
        by_k in any::<bool>(), inertia in number(), e in number(), vb in prop_oneof![1 => number(), 3 => Just(-1.0)],
        gap in prop_oneof![1 => number(), 3 => Just(1.0)], s in number(), omega in size(), zeta in size(),
    ) {
        let inertia = format!("--{}={inertia:?}", if by_k { "gyration-ratio" } else { "q" });
        let rest = [format!("--e={e:?}"), format!("--velocity=-1.0,{vb:?}"), format!("--height-gap={gap:?}"), format!("--at={s:?}")];
        let fixed = ["respond", "--format=json"].map(str::to_owned);
        let part = [format!("--omega={omega:?}"), format!("--damping={zeta:?}")];
        is_answered(&[&fixed[..], &[inertia], &rest, &part].concat())?;
    }

    /// Drops as there are, and what is none.
    #[test]
    fn respond_by_a_model_answers_any_numbers(
        model in select(vec!["map", "ballistic", "finite-tilt", "compliant"]), gyration in prop_oneof![3 => 0.1..=1.0_f64, 1 => number()],
        c in prop_oneof![3 => -0.3..=0.3_f64, 1 => number()], e in prop_oneof![3 => 0.0..=0.95_f64, 1 => number()], speed in -1.0..1.0_f64,
        tilt in prop_oneof![3 => 0.0..=30.0_f64, 1 => number()], gravity in prop_oneof![Just(0.0), Just(9.806_65)], at in number(),
        contact in prop_oneof![3 => -6.0..-2.5_f64, 1 => -12.0..3.0_f64], dashpot in any::<bool>(), held in any::<bool>(), omega in size(), zeta in size(),
    ) {
        let mut arguments = ["respond", "--length-m=0.14", "--format=json"].map(str::to_owned).to_vec();
        arguments.extend([
            format!("--model={model}"),
            format!("--gyration-m={:?}", 0.07 * gyration.abs()),
            format!("--center-of-mass={c:?}"),
            format!("--e={:?}", e.abs()),
            format!("--speed-m-s={:?}", 10f64.powf(speed)),
            format!("--tilt-deg={:?}", tilt.abs()),
            format!("--gravity-m-s2={gravity:?}"),
            format!("--at={at:?}"),
        ]);
        if model == "compliant" {
            arguments.push(format!("--contact-time-s={:?}", 10f64.powf(contact)));
            arguments.extend(dashpot.then(|| "--contact-law=dashpot".to_owned()));
        }
        if held {
            arguments.extend([format!("--omega={omega:?}"), format!("--damping={zeta:?}")]);
        }
        is_answered(&arguments)?;
    }

    #[test]
    fn spectrum_answers_any_numbers(
        shape in select(vec!["half-sine", "triangle", "initial-peak-sawtooth", "rectangle", "trapezoid:0.5"]),
        a in number(), duration in size(), starts in (size(), size()), hz in (size(), size()), zeta in size(),
        quantity in select(vec!["acceleration", "relative-displacement", "relative-velocity", "pseudo-velocity", "equivalent-static-acceleration"]),
        boundary in any::<bool>(), limit in size(),
    ) {
        let mut arguments = ["spectrum", "--format=json"].map(str::to_owned).to_vec();
        let (start, other) = starts;
        if boundary {
            arguments.push(format!("--pulse={shape},{a:?},{duration:?},{start:?}"));
            arguments.extend([format!("--frequency={:?}", hz.0), "--damage-boundary".to_owned()]);
        } else {
            arguments.push(format!("--pulse={shape},{a:?},{duration:?},{start:?},{other:?}"));
            arguments.extend([format!("--frequency={:?},{:?}", hz.0, hz.1), format!("--quantity={quantity}")]);
        }
        arguments.extend([format!("--damping={zeta:?}"), format!("--limit={limit:?}")]);
        is_answered(&arguments)?;
    }
}
