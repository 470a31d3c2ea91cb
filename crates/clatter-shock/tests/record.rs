//! Records: what is read, what is refused and by which line, what is reported.

use std::fmt::Write;

use clatter_shock::{DampingRatio, Error, Finding, Frequencies, Lines, Quantity, Record, Units, stream};

fn refusal(csv: &str, units: Option<Units>) -> String {
    Record::read(csv.as_bytes(), units).expect_err("a record that must be refused").to_string()
}

#[test]
fn bad_records_are_refused_by_line() {
    let si = Some(Units::SI);
    for (csv, message) in [
        ("", "the record has no samples; it needs two at least"),
        ("0,1\n", "the record has one sample; it needs two at least"),
        ("0,1\n1,inf\n", "line 2: acceleration inf is not finite"),
        ("0,1\n1,-1e101\n", "line 2: acceleration -1e101 is beyond 1e100 m/s²"),
        ("0,1\nnan,2\n", "line 2: time nan is not finite"),
        ("0,1\n\n# a note\n2,2\n1,3\n", "line 5: time 1.0 s does not come after 2.0 s, the line above"),
        ("0,1\n0,1\n", "line 2: time 0.0 s does not come after 0.0 s, the line above"),
        ("t,a\n0,1\nt,a\n", "line 3: \"t\" is not a number; a header may only be the first line"),
        ("t,a\nt,a\n", "line 2: \"t\" is not a number; a header may only be the first line"),
        ("0,1\n1\n", "line 2: \"1\" is not two columns, time and acceleration"),
        ("0,1\n1,\"1\n", "line 2: \"\\\"1\" is not a number; a header may only be the first line"),
        ("0;1\n1;1,5\n", "line 2: \"1,5\" has a decimal comma; write 1.5, with a point, in all lines"),
        ("0,5;1,5\n1;1\n", "line 1: \"0,5\" has a decimal comma; write 0.5, with a point, in all lines"),
        ("0\t1\n1\t1,5\n", "line 2: \"1,5\" has a decimal comma; write 1.5, with a point, in all lines"),
        ("0 1\n1 1,5e-3\n", "line 2: \"1,5e-3\" has a decimal comma; write 1.5e-3, with a point, in all lines"),
        ("0,1\n1,1.2.3\n", "line 2: \"1.2.3\" is not a number; a header may only be the first line"),
    ] {
        assert_eq!(refusal(csv, si), message, "{csv:?}");
    }
    let in_g = refusal("time [s],acceleration [g]\n0,1\n1,1e308\n", None);
    assert_eq!(in_g, "line 3: acceleration 1e308 is beyond the numbers in SI");
    let endless = "0,1\n".to_owned() + &"7".repeat(1 << 17);
    assert_eq!(refusal(&endless, si), "line 2: longer than 65536 bytes, where two columns should be");
    let binary = Record::read(&b"0,1\n\xff\xfe,1\n"[..], si).expect_err("no text");
    assert_eq!(binary.to_string(), "line 2: not text (UTF-8)");
    assert!(refusal("0,1\n1,2\n", None).starts_with("the units of the record are not named"));
    assert!(refusal("time,acceleration\n0,1\n", None).starts_with("the units of the record are not named"));
    assert_eq!(Units::named("h", "g"), Err(Error::Unit("h".to_owned())));
}

#[test]
fn headers_name_units() {
    for header in ["time [ms],acceleration [g]", "time_ms;accel_g", "t (ms)\ta (gn)", "\"time ms\",\"a g\""] {
        let separator = [',', ';', '\t'].into_iter().find(|&c| header.contains(c)).expect("separator");
        let csv = format!("{header}\n0{separator}1\n2{separator}3\n");
        let record = Record::read(csv.as_bytes(), None).unwrap_or_else(|e| panic!("{header}: {e}"));
        assert_eq!(record.points()[1], (2.0 * 1e-3, 3.0 * 9.80665), "{header}");
    }
    let record = Record::read("time_s,acceleration_m_s2\n0 , 1\n2 , 3\n".as_bytes(), None).expect("record");
    assert_eq!(record.points()[1], (2.0, 3.0));
}

#[test]
fn gaps_offsets_and_drift_are_found() {
    let mut csv = String::new();
    for i in 0..2000_u32 {
        let t = f64::from(i) * 1e-4 + if i >= 1500 { 0.01 } else { 0.0 };
        let a = 2.0 + if i == 700 { 100.0 } else { 0.0 } + f64::from(i) * 0.005;
        writeln!(csv, "{t:.4},{a}").expect("a string");
    }
    let record = Record::read(csv.as_bytes(), Some(Units::SI)).expect("record");
    let findings = &record.survey().findings;
    assert!(matches!(findings[0], Finding::Gap { line: 1501, .. }), "{findings:?}");
    assert!(matches!(findings[1], Finding::Offset { lines: (1, _), mean } if (mean - 2.0).abs() < 0.1), "{findings:?}");
    assert!(matches!(findings[2], Finding::Drift { change, .. } if (change - 9.9).abs() < 0.3), "{findings:?}");
    assert_eq!(findings.len(), 3, "{findings:?}");
    assert_eq!(record.survey().step, None, "a gap is not even");
}

/// A record in SI units of samples at these times, all zero but one.
fn at_times(times: impl IntoIterator<Item = String>) -> Record {
    let line = |(i, time)| format!("{time},{}\n", if i == 20 { 100 } else { 0 });
    let csv: String = times.into_iter().enumerate().map(line).collect();
    Record::read(csv.as_bytes(), Some(Units::SI)).expect("a record")
}

/// Line, samples missing there and the usual step of each gap.
fn gaps(record: &Record) -> Vec<(usize, f64, f64)> {
    let gap = |finding: &Finding| match finding {
        Finding::Gap { line, seconds, usual } => (*line, (seconds / usual).round() - 1.0, *usual),
        other => panic!("{other:?}"),
    };
    record.survey().findings.iter().map(gap).collect()
}

#[test]
fn missing_samples_are_found_by_line() {
    // From which on how many are left out of 0, 1, 2, …, and where that shows.
    for (missing, want) in [
        (&[(500, 1)][..], &[(501, 1.0)][..]),
        (&[(500, 2)], &[(501, 2.0)]),
        (&[(500, 6)], &[(501, 6.0)]),
        (&[(1, 1)], &[(2, 1.0)]),
        (&[(2, 1)], &[(3, 1.0)]),
        (&[(998, 1)], &[(999, 1.0)]),
        // After a long gap the usual step is still the usual step.
        (&[(100, 10_000), (10_200, 1), (10_203, 3)], &[(101, 10_000.0), (201, 1.0), (203, 3.0)]),
        (&[], &[]),
    ] {
        let last = 1000 + missing.iter().map(|m: &(u32, u32)| m.1).sum::<u32>();
        let times = (0..last).filter(|i| !missing.iter().any(|(from, n)| (*from..from + n).contains(i)));
        let record = at_times(times.map(|i| format!("{:?}", 0.25 + 1e-4 * f64::from(i))));
        let found = gaps(&record);
        assert_eq!(found.iter().map(|g| (g.0, g.1)).collect::<Vec<_>>(), want, "{missing:?}");
        assert!(found.iter().all(|g| (g.2 / 1e-4 - 1.0).abs() < 1e-6), "{found:?}");
        assert_eq!(record.survey().step.is_some(), missing.is_empty(), "{missing:?}");
    }
}

#[test]
fn a_change_of_rate_is_no_missing_sample() {
    // Ten times as slow from the middle on, in between, and steps that grow and shrink.
    let change = |i: u32| if i < 500 { 0.0 } else { 9.0 * f64::from(i - 500) };
    let record = at_times((0..1000).map(|i| format!("{:?}", 1e-4 * (f64::from(i) + change(i)))));
    assert_eq!(gaps(&record).len(), 0, "{:?}", gaps(&record));
    let mut time = 0.0;
    let varied = (0..1000_u32).map(|i| {
        time += 1e-3 * (1.0 + 0.5 * f64::from(i % 7));
        format!("{time:?}")
    });
    assert_eq!(gaps(&at_times(varied)), []);
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
        let survey = record.survey();
        assert_eq!(gaps(&record), [], "{name}");
        let got = survey.step.unwrap_or_else(|| panic!("{name}: uneven"));
        // One printed unit over the whole length.
        assert!((got / step - 1.0).abs() < 1e-5, "{name}: {got}");
        // One sample less is still seen, and a drift of the clock by more than its digits.
        let less = at_times((0..20_000).filter(|i| *i != 9000).map(|i| print(exact(i))));
        assert_eq!(gaps(&less).iter().map(|g| (g.0, g.1)).collect::<Vec<_>>(), [(9001, 1.0)], "{name}");
        let bent = at_times((0..20_000).map(|i| print(exact(i) + 4e-5 * (f64::from(i) / 5000.0).sin())));
        assert_eq!((gaps(&bent), bent.survey().step), (vec![], None), "{name}");
    }
    // Digits no finer than the step tell nothing of rounding: a step of two is a sample that is missing.
    let coarse = at_times((0..200).filter(|i| *i != 77).map(|i| i.to_string()));
    assert_eq!(gaps(&coarse), [(78, 1.0, 1.0)]);
    let coarser = at_times((0..200).map(|i| (3 * i / 2).to_string()));
    assert_eq!((gaps(&coarser), coarser.survey().step), (vec![], None));
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
        Record::read(csv.as_bytes(), Some(Units::SI)).expect("record").survey().findings.clone()
    };
    assert_eq!(of(&|_| 0.0), []);
    for size in [0.04, 0.08, 0.2, -0.08] {
        let found = of(&|x| size * (PI * x).sin());
        // Cut in two by the shock, or one.
        assert!(!found.is_empty() && found.len() <= 2, "{size}: {found:?}");
        for finding in found {
            let Finding::Drift { lines: (a, b), change } = finding else { panic!("{finding:?}") };
            assert!(b - a >= 500 && (0.4..1.1).contains(&(change / (800.0 * size))), "{size}: {a} to {b}, {change}");
        }
    }
}

#[test]
fn columns_that_are_not_read_are_told() {
    let findings = |csv: &str| {
        let record = Record::read(csv.as_bytes(), Some(Units::SI)).expect("record");
        record.survey().findings.iter().map(Finding::to_string).collect::<Vec<_>>()
    };
    let named = "line 2: time is taken from column 1 (time), acceleration from column 2 (ax), nothing from column 3 (ay); \
                 for another, put it second";
    assert_eq!(findings("time,ax,ay\n0,0,3\n1,0,4\n"), [named]);
    let unnamed = "line 3: time is taken from column 1, acceleration from column 2, nothing from column 3, 4; \
                   for another, put it second";
    assert_eq!(findings("0;0\n1;0;;\n2;0;5;6\n"), [unnamed], "a separator at the end of a line is no column");
}

#[test]
fn even_and_uneven_records_of_one_history_agree() {
    // One triangle, sampled evenly and at its corners alone.
    let mut even = String::new();
    for i in 0..=40_u32 {
        let a = 50.0 * (1.0 - (f64::from(i) - 20.0).abs() / 20.0);
        writeln!(even, "{},{a}", f64::from(i) / 4096.0).expect("a string");
    }
    let corners = format!("0,0\n{},50\n{},0\n", 20.0 / 4096.0, 40.0 / 4096.0);
    let (even, uneven) = (
        Record::read(even.as_bytes(), Some(Units::SI)).expect("even"),
        Record::read(corners.as_bytes(), Some(Units::SI)).expect("corners"),
    );
    assert!(even.survey().step.is_some(), "even");
    let frequencies = Frequencies::per_octave(1.0, 4000.0, 6.0).expect("frequencies");
    let damping = DampingRatio::new(0.05).expect("damping");
    let (a, b) = (
        even.spectrum(&frequencies, damping, Quantity::AbsoluteAcceleration),
        uneven.spectrum(&frequencies, damping, Quantity::AbsoluteAcceleration),
    );
    for (i, (a, b)) in a.maximax.iter().zip(&b.maximax).enumerate() {
        // The same history but for rounding of the samples.
        assert!((a / b - 1.0).abs() < 1e-11, "{} Hz: {a} and {b}", frequencies.hz()[i]);
    }
}

#[test]
fn streaming_gives_the_same_spectrum() {
    let mut csv = String::new();
    for i in 0..50_000_u32 {
        writeln!(csv, "{},{}", f64::from(i) * 1e-3, (f64::from(i) * 0.1).sin()).expect("a string");
    }
    let record = Record::read(csv.as_bytes(), Some(Units::SI)).expect("record");
    let frequencies = Frequencies::list(vec![1.0, 15.9, 200.0]).expect("frequencies");
    let damping = DampingRatio::new(0.02).expect("damping");
    let lines = Lines::new(csv.as_bytes(), Some(Units::SI));
    let mut told = 0;
    let got =
        stream(lines, record.survey(), &frequencies, damping, Quantity::PseudoVelocity, |b| told = b).expect("stream");
    assert_eq!(told, csv.len() as u64);
    let want = record.spectrum(&frequencies, damping, Quantity::PseudoVelocity);
    for (got, want) in got.maximax.iter().zip(&want.maximax) {
        // Peaks between samples come from Newton's iteration, which may begin elsewhere.
        assert!((got / want - 1.0).abs() < 1e-14, "{got} and {want}");
    }
}

#[test]
fn an_uneven_record_streams_to_the_very_same_spectrum() {
    // Longer than two pieces, with steps that grow and shrink.
    let (mut csv, mut time) = (String::from("time [s],acceleration [m/s2]\n"), 0.0);
    for i in 0..40_000_u32 {
        writeln!(csv, "{time:?},{:?}", (f64::from(i) * 0.1).sin()).expect("a string");
        time += 1e-3 * (1.0 + 0.5 * f64::from(i % 7));
    }
    let record = Record::read(csv.as_bytes(), None).expect("record");
    assert_eq!(record.survey().step, None, "uneven");
    let frequencies = Frequencies::list(vec![0.01, 5.0, 300.0]).expect("frequencies");
    let damping = DampingRatio::new(0.02).expect("damping");
    for quantity in [Quantity::AbsoluteAcceleration, Quantity::EquivalentStaticAcceleration, Quantity::PseudoVelocity] {
        let (lines, mut told) = (Lines::new(csv.as_bytes(), None), 0);
        let got = stream(lines, record.survey(), &frequencies, damping, quantity, |b| told = b).expect("stream");
        assert_eq!(told, csv.len() as u64);
        assert_eq!(got, record.spectrum(&frequencies, damping, quantity), "the same steps in the same order");
    }
}
