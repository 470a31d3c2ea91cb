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
        ("0,1\nnan,2\n", "line 2: time nan is not finite"),
        ("0,1\n\n# a note\n2,2\n1,3\n", "line 5: time 1.0 s does not come after 2.0 s, the line above"),
        ("0,1\n0,1\n", "line 2: time 0.0 s does not come after 0.0 s, the line above"),
        ("t,a\n0,1\nt,a\n", "line 3: \"t\" is not a number; a header may only be the first line"),
        ("t,a\nt,a\n", "line 2: \"t\" is not a number; a header may only be the first line"),
        ("0,1\n1\n", "line 2: \"1\" is not two columns, time and acceleration"),
        ("0,1\n1,\"1\n", "line 2: \"\\\"1\" is not a number; a header may only be the first line"),
        ("0,1\n1,1.2.3\n", "line 2: \"1.2.3\" is not a number; a header may only be the first line"),
    ] {
        assert_eq!(refusal(csv, si), message, "{csv:?}");
    }
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
