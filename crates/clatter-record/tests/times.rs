//! Even and uneven times, samples that are missing, levels that stray.

use std::fmt::Write as _;

use clatter_record::{At, Between, Finding, Options, Record, Units};
use clatter_shock::{DampingRatio, Frequencies, Quantity};

fn read(text: &str) -> Record {
    let options = Options { units: Some(Units::si()), ..Options::default() };
    Record::read(text.as_bytes(), &options, |_| ()).expect("a record")
}

/// A record in SI units of samples at these times, all zero but one.
fn at_times(times: impl IntoIterator<Item = String>) -> Record {
    let line = |(i, time)| format!("{time},{}\n", if i == 20 { 100 } else { 0 });
    read(&times.into_iter().enumerate().map(line).collect::<String>())
}

/// Line and samples missing there of each gap, and the usual step.
fn gaps(record: &Record) -> (Vec<(usize, f64)>, f64) {
    match &record.findings(10.0)[..] {
        [] => (vec![], 0.0),
        [Finding::Gaps { first, usual_s, count }] => {
            assert_eq!(first.len(), *count, "all are listed");
            let gap = |(at, gap_s): &(At, f64)| match at {
                At::Line(line) => (*line, (gap_s / usual_s).round() - 1.0),
                at @ At::Sample(_) => panic!("{at}"),
            };
            (first.iter().map(gap).collect(), *usual_s)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn missing_samples_are_found_by_line() {
    // From which on how many are left out of 0, 1, 2, …, and where that shows.
    for (missing, want) in [
        (&[(500, 1)][..], &[(501, 1.0)][..]),
        (&[(500, 2)], &[(501, 2.0)]),
        (&[(500, 6)], &[(501, 6.0)]),
        (&[(1, 1)], &[(2, 1.0)]),
        (&[(998, 1)], &[(999, 1.0)]),
        (&[(100, 10_000), (10_200, 1), (10_203, 3)], &[(101, 10_000.0), (201, 1.0), (203, 3.0)]),
        (&[], &[]),
    ] {
        let last = 1000 + missing.iter().map(|m: &(u32, u32)| m.1).sum::<u32>();
        let times = (0..last).filter(|i| !missing.iter().any(|(from, n)| (*from..from + n).contains(i)));
        let record = at_times(times.map(|i| format!("{:?}", 0.25 + 1e-4 * f64::from(i))));
        let (found, usual_s) = gaps(&record);
        assert_eq!(found, want, "{missing:?}");
        assert!(found.is_empty() || (usual_s / 1e-4 - 1.0).abs() < 1e-6, "{usual_s}");
        assert_eq!(record.step_s().is_some(), missing.is_empty(), "{missing:?}");
    }
}

#[test]
fn a_change_of_rate_is_no_missing_sample() {
    // Ten times as slow from the middle on, and steps that grow and shrink.
    let change = |i: u32| if i < 500 { 0.0 } else { 9.0 * f64::from(i - 500) };
    let record = at_times((0..1000).map(|i| format!("{:?}", 1e-4 * (f64::from(i) + change(i)))));
    assert_eq!(gaps(&record).0, []);
    let mut time = 0.0;
    let varied = (0..1000_u32).map(|i| {
        time += 1e-3 * (1.0 + 0.5 * f64::from(i % 7));
        format!("{time:?}")
    });
    assert_eq!(gaps(&at_times(varied)).0, []);
}

/// How a time is printed.
type Print = fn(f64) -> String;

/// 48 kHz in whole microseconds, rounded, cut off and with six digits: even as far as can be told.
#[test]
fn printed_digits_make_no_record_uneven() {
    let step = 1.0 / 48_000.0;
    let exact = |i: u32| 0.060_000_3 + f64::from(i) * step;
    let formats: [(&str, Print); 4] = [
        ("rounded", |t| format!("{t:.6}")),
        ("cut off", |t| format!("{:.6}", (t * 1e6).floor() * 1e-6)),
        ("without zeros", |t| format!("{t:.6}").trim_end_matches('0').to_owned()),
        ("six digits", |t| format!("{t:.5e}")),
    ];
    for (name, print) in formats {
        let record = at_times((0..20_000).map(|i| print(exact(i))));
        assert_eq!(gaps(&record).0, [], "{name}");
        let got = record.step_s().unwrap_or_else(|| panic!("{name}: uneven"));
        // One printed unit over the whole length.
        assert!((got / step - 1.0).abs() < 1e-5, "{name}: {got}");
        // One sample less is still seen, and a drift of the clock by more than its digits.
        let less = at_times((0..20_000).filter(|i| *i != 9000).map(|i| print(exact(i))));
        assert_eq!(gaps(&less).0, [(9001, 1.0)], "{name}");
        let bent = at_times((0..20_000).map(|i| print(exact(i) + 4e-5 * (f64::from(i) / 5000.0).sin())));
        assert_eq!((gaps(&bent).0, bent.step_s()), (vec![], None), "{name}");
    }
    // Digits no finer than the step tell nothing of rounding: a step of two is a sample that is missing.
    let coarse = at_times((0..200).filter(|i| *i != 77).map(|i| i.to_string()));
    assert_eq!(gaps(&coarse), (vec![(78, 1.0)], 1.0));
    let coarser = at_times((0..200).map(|i| (3 * i / 2).to_string()));
    // Every one and a half, cut to whole numbers.
    assert_eq!((gaps(&coarser).0, coarser.step_s()), (vec![], Some(1.5)));
}

#[test]
fn a_base_line_that_bows_and_comes_back_is_found() {
    use std::f64::consts::PI;
    // A half-sine of 2 % of the length, ringing after it, and noise of 1 %; 2001 samples.
    let shock = |x: f64| if (0.3..0.32).contains(&x) { (PI * (x - 0.3) / 0.02).sin() } else { 0.0 };
    let ringing = |x: f64| if x > 0.32 { 0.3 * (-8.0 * (x - 0.32)).exp() * (90.0 * (x - 0.32)).sin() } else { 0.0 };
    let noise = |i: u32| 0.01 * f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 32768.0 - 0.01;
    let of = |base: &dyn Fn(f64) -> f64| {
        let mut csv = String::new();
        for i in 0..=2000_u32 {
            let x = f64::from(i) / 2000.0;
            let a = 800.0 * (shock(x) + ringing(x) + noise(i) + base(x));
            writeln!(csv, "{},{a}", f64::from(i) / 8192.0).expect("a string");
        }
        read(&csv).findings(10.0)
    };
    assert_eq!(of(&|_| 0.0), []);
    for size in [0.04, 0.08, 0.2, -0.08] {
        let found = of(&|x| size * (PI * x).sin());
        // Cut in two by the shock, or one; its foot may be an offset.
        assert!(found.iter().any(|finding| matches!(finding, Finding::Drift { .. })), "{size}: {found:?}");
        assert!(found.len() <= 3, "{size}: {found:?}");
        for finding in found {
            let (Finding::Drift { change_m_s2, .. } | Finding::Offset { level_m_s2: change_m_s2, .. }) = finding else {
                panic!("{finding:?}")
            };
            assert!((0.2..1.1).contains(&(change_m_s2 / (800.0 * size))), "{size}: {change_m_s2}");
        }
    }
    // A level strays until the end, and an offset stands before.
    let steps = of(&|x| if x > 0.6 { 0.05 } else { 0.0 });
    assert!(
        matches!(&steps[..], [Finding::Drift { change_m_s2, .. }] if (change_m_s2 / 40.0 - 1.0).abs() < 0.1),
        "{steps:?}"
    );
}

#[test]
fn even_and_uneven_records_of_one_history_agree() {
    // One triangle, sampled evenly and at its corners alone.
    let mut even = String::new();
    for i in 0..=40_u32 {
        let a = 50.0 * (1.0 - (f64::from(i) - 20.0).abs() / 20.0);
        writeln!(even, "{},{a}", f64::from(i) / 4096.0).expect("a string");
    }
    let even = read(&even);
    let uneven = read(&format!("0,0\n{},50\n{},0\n{},0\n", 20.0 / 4096.0, 40.0 / 4096.0, 41.0 / 4096.0));
    assert!(even.step_s().is_some() && uneven.step_s().is_none(), "one of each");
    let frequencies = Frequencies::per_octave(1.0, 4000.0, 6.0).expect("frequencies");
    let damping = DampingRatio::new(0.05).expect("damping");
    let [a, b] = [&even, &uneven].map(|record| {
        let channel = &record.channels()[0];
        channel
            .spectrum(&frequencies, damping, Quantity::AbsoluteAcceleration, Between::Linear, |_| ())
            .expect("a spectrum")
    });
    for (i, (a, b)) in a.maximax.iter().zip(&b.maximax).enumerate() {
        // The same history but for rounding of the samples.
        assert!((a / b - 1.0).abs() < 1e-11, "{} Hz: {a} and {b}", frequencies.hz()[i]);
    }
}
