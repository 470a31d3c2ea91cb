//! Text as loggers and programs write it: read right, or refused with the reason.

#![expect(clippy::format_collect, clippy::format_push_string, reason = "small texts")]
#![expect(clippy::cast_precision_loss, clippy::float_cmp, reason = "small numbers, and those that are exact")]

use std::fs;
use std::path::Path;

use clatter_record::{Finding, Options, Record, Units};

const G: f64 = 9.806_65;

fn file(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn read(text: impl AsRef<[u8]>) -> Result<Record, String> {
    with(text, &Options::default())
}

fn with(text: impl AsRef<[u8]>, options: &Options) -> Result<Record, String> {
    Record::read(text.as_ref(), options, |_| ()).map_err(|error| error.to_string())
}

fn samples(record: &Record) -> usize {
    record.channels()[0].values.len()
}

fn si() -> Options {
    Options { units: Some(Units::si()), ..Options::default() }
}

/// Sample `i` of the shock that most files hold: a half-sine of 50 g and 2 ms from 5 ms on, ten samples a millisecond.
fn half_sine(i: u32) -> f64 {
    if (50..=70).contains(&i) { 50.0 * G * (std::f64::consts::PI * f64::from(i - 50) / 20.0).sin() } else { 0.0 }
}

/// Every file that holds the shock, in whatever notation, is the shock: its times, and its values to the digits that it prints.
#[test]
fn one_shock_in_many_notations() {
    let names = [
        "base.csv",
        "b_pandas.csv",
        "h_clock.csv",
        "h_comment_units.csv",
        "h_epochms.csv",
        "h_epochns.csv",
        "h_fixedwidth.txt",
        "h_footer.csv",
        "h_fortran.csv",
        "h_iso.csv",
        "h_labview.lvm",
        "h_leadcomma.csv",
        "h_phyphox.csv",
        "h_quoted.csv",
        "h_slash.txt",
        "h_space_thousand.csv",
        "h_swapped.csv",
        "h_units_gs.csv",
        "h_units_ins2.csv",
        "h_units_mg.csv",
        "h_units_millig.csv",
        "h_units_min.csv",
        "h_units_mmss.csv",
        "h_units_mps2.csv",
        "h_units_ms2sup.csv",
        "h_units_msec.csv",
        "h_units_mss.csv",
        "h_units_ns.csv",
        "h_units_sec.csv",
        "h_units_words.csv",
        "h_units_x1000.csv",
    ];
    for name in names {
        let record = read(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(record.channels()[0].values.len(), 300, "{name}");
        assert_eq!(record.step_s().map(f64::to_bits), Some(1e-4_f64.to_bits()), "{name}");
        let channel = record.channels().last().expect("a channel");
        // Factors are rounded to seven digits. In thousands of m/s² the last digit is 1e-3 m/s², of g 1e-5; of D+02 g it is 1e-3.
        let printed = if ["h_units_x1000.csv", "h_fortran.csv"].contains(&name) { 0.5e-3 } else { 2e-5 };
        for (i, value) in (0..).zip(&channel.values) {
            assert!(
                (value - half_sine(i)).abs() <= printed + 1e-7 * half_sine(i),
                "{name}, sample {i}: {value}, not {}",
                half_sine(i)
            );
        }
        let expected = usize::from(name == "h_footer.csv");
        assert_eq!(record.findings(10.0).len(), expected, "{name}: {:?}", record.findings(10.0));
    }
    assert_eq!(read(file("h_phyphox.csv")).expect("a record").channels().len(), 4);
}

#[test]
fn files_that_are_refused_with_the_reason() {
    for (name, reason) in [
        ("h_blankcell.csv", "line 302: nothing stands in column 2 (acceleration)"),
        ("h_nanlast.csv", "line 302: NaN in column 2 (acceleration) is no finite number"),
        (
            "h_dup.csv",
            "270 of 300 times are those of the sample before: they are printed in steps of 1e-3 s, too coarse for samples so \
             close; give the sample rate",
        ),
        (
            "tests_caps.csv",
            "no column is a time: the columns are 1 (test), 2 (level), 3 (damaged); name one by its number, or give the sample \
             rate",
        ),
        ("unit_grams.csv", "no column is an acceleration: the columns are 1 (time [s]), 2 (mass [g])"),
        (
            "unit_velocity_as_time.csv",
            "no column is a time: the columns are 1 (Velocity [m/s]), 2 (Acceleration [g]); name one by its number, or give the \
             sample rate",
        ),
    ] {
        assert_eq!(read(file(name)).expect_err(name), reason, "{name}");
    }
    // A list that was told goes on.
    let skipped = with(file("h_nanlast.csv"), &Options { skip_bad: true, ..Options::default() }).expect("the rest");
    assert_eq!((samples(&skipped), skipped.step_s()), (300, Some(1e-4)));
    assert!(matches!(&skipped.findings(10.0)[..], [Finding::Skipped(bad)] if bad.count == 1));
    let rate = Options { sample_rate_hz: Some(10_000.0), ..Options::default() };
    assert_eq!(with(file("h_dup.csv"), &rate).expect("a rate in place of times").step_s(), Some(1e-4));
}

#[test]
fn times_printed_in_two_ways_are_the_same() {
    let [exact, single] = ["time_exact.csv", "time_float32.csv"].map(|name| read(file(name)).expect(name));
    assert_eq!(exact.step_s(), Some(1.0 / 51_200.0));
    assert_eq!(exact.step_s(), single.step_s());
    assert_eq!(exact.channels()[0].values, single.channels()[0].values);
}

#[test]
fn small_files() {
    for (name, largest) in [("quoted_comma_header.csv", G), ("sep_line.csv", G)] {
        let record = read(file(name)).expect(name);
        assert_eq!((record.step_s(), record.channels()[0].values[1]), (Some(1e-3), largest), "{name}");
    }
    let axes = read(file("h_3axis.csv")).expect("three channels");
    let names: Vec<_> = axes.channels().iter().map(|channel| (channel.name.as_str(), channel.unit.as_str())).collect();
    assert_eq!(names, [("ax", "g"), ("ay", "g"), ("az", "g")]);
    // The sensor lies still at first: 1 g on the vertical axis.
    assert!(axes.findings(10.0).iter().any(
        |finding| matches!(finding, Finding::Offset { channel, level_m_s2, .. } if channel == "az" && (level_m_s2 / G - 1.0).abs() < 1e-12)
    ));
}

/// Separators, decimal commas, headings, encodings, line ends: three samples, 1 ms apart, of 0, 1.5 and −2 m/s².
#[test]
fn notations() {
    let latin: Vec<u8> = "t [s];a [m/s²]\n0;0\n0,001;1,5\n0,002;-2\n".chars().map(|c| c as u8).collect();
    let utf16 = |text: &str, bytes: fn(u16) -> [u8; 2], mark: bool| {
        let mark = if mark { "\u{feff}" } else { "" };
        format!("{mark}{text}").encode_utf16().flat_map(bytes).collect::<Vec<u8>>()
    };
    let plain = "t [s],a [m/s2]\n0,0\n0.001,1.5\n0.002,-2\n";
    // Without a mark, it takes some text to tell.
    let long = format!("a line that says what follows, with nothing in it but letters\n{plain}");
    let cases: Vec<(&str, Vec<u8>)> = vec![
        ("plain", plain.into()),
        ("BOM", format!("\u{feff}{plain}").into()),
        ("CRLF", plain.replace('\n', "\r\n").into()),
        ("CR", plain.replace('\n', "\r").into()),
        ("no end of the last line", plain.trim_end().into()),
        ("Latin-1", latin),
        ("UTF-16, little", utf16(plain, u16::to_le_bytes, true)),
        ("UTF-16, big", utf16(plain, u16::to_be_bytes, true)),
        ("UTF-16 without a mark", utf16(&long, u16::to_le_bytes, false)),
        ("tabs", plain.replace(',', "\t").into()),
        ("blanks", "  t [s]   a [m/s2]\n 0 0\n 0.001   1.5\n 0.002 -2\n".into()),
        ("decimal commas, tabs", "t [s]\ta [m/s2]\n0\t0\n0,001\t1,5\n0,002\t-2\n".into()),
        ("decimal commas, blanks", "t [s] a [m/s2]\n0 0\n0,001 1,5\n0,002 -2\n".into()),
        ("bars", plain.replace(',', " | ").into()),
        ("separators at the ends", "t [s],a [m/s2],\n0,0,\n0.001,1.5,\n0.002,-2,\n".into()),
        ("units below", "t,a\ns,m/s2\n0,0\n0.001,1.5\n0.002,-2\n".into()),
        ("units below, in brackets", "Time;Acceleration\n[s];[m/s^2]\n0;0\n0.001;1.5\n0.002;-2\n".into()),
        ("title above", format!("Drop 5 of 12, phone B\n\nrate, 1 kHz\n{plain}").into()),
        ("comments", format!("# logger 3\n# serial, 12, 5\n{plain}# done\n").into()),
        ("heading in a comment", format!("# {plain}").into()),
        ("heading in a comment, blanks", "% time [s]  acc [m/s2]\n0 0\n0.001 1.5\n0.002 -2\n".into()),
        ("an index", "sample,t [s],a [m/s2]\n1,0,0\n2,0.001,1.5\n3,0.002,-2\n".into()),
        ("time last", "acc_m_s2,time_s\n0,0\n1.5,0.001\n-2,0.002\n".into()),
        ("plus and exponents", "t [ms],a [mm/s2]\n+0,0e0\n1.0E+00,+1.5e3\n2,-2000.\n".into()),
        ("time of day", "time,a [m/s2]\n23:59:59.999,0\n24:00:00.000,1.5\n0:00:00.001,-2\n".into()),
        ("a column of words", "state,t [s],a [m/s2]\nidle,0,0\nidle,0.001,1.5\nhit,0.002,-2\n".into()),
        ("empty lines", plain.replace('\n', "\n\n").into()),
        ("German", "Zeit [ms];Beschleunigung [m/s²]\n0;0\n1;1,5\n2;-2\n".into()),
    ];
    for (name, text) in cases {
        let record = read(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(record.channels().len(), 1, "{name}");
        assert_eq!(record.channels()[0].values, [0.0, 1.5, -2.0], "{name}");
        assert_eq!(record.step_s(), Some(1e-3), "{name}");
    }
}

#[test]
fn by_place_and_by_the_caller() {
    let two = "0,0\n0.001,1.5\n0.002,-2\n";
    assert!(read(two).expect_err("no units").contains("the unit of column 1, the time, is not named"));
    assert_eq!(with(two, &si()).expect("units").channels()[0].values, [0.0, 1.5, -2.0]);
    let numbered = "1,0,7\n2,0.5,8\n3,1,9\n";
    let record = with(numbered, &si()).expect("an index");
    assert_eq!((record.step_s(), record.channels().len()), (Some(0.5), 1), "a running number is no time beside one");
    let one = Options { sample_rate_hz: Some(1e3), ..si() };
    assert_eq!(with("0\n1.5\n-2\n", &one).expect("one column").step_s(), Some(1e-3));
    assert!(with("0\n1.5\n-2\n", &si()).expect_err("no rate").contains("give the sample rate"));
    let words = with(",0\n:,0.003\n", &si()).expect_err("times alone");
    assert!(words.contains("no column is an acceleration: the columns are 1, 2"), "{words}");
    let many = "t [s],x [g],y [g],x2 [mV]\n0,1,2,3\n1,4,5,6\n";
    let record = read(many).expect("two channels");
    assert!(matches!(&record.findings(10.0)[0], Finding::LeftOut(columns) if columns[..] == ["4 (x2 [mV])"]));
    let pick = |column: &str| Options { accelerations: vec![column.parse().expect("a column")], ..Options::default() };
    assert_eq!(with(many, &pick("y")).expect("by name").channels()[0].values, [2.0 * G, 5.0 * G]);
    assert_eq!(with(many, &pick("3")).expect("by number").channels()[0].values, [2.0 * G, 5.0 * G]);
    assert_eq!(
        with(many, &pick("z")).expect_err("none"),
        "there is no column 'z' for the acceleration; there are 1 (t [s]), 2 (x [g]), 3 (y [g]), 4 (x2 [mV])"
    );
    assert!(with(many, &pick("x2")).expect_err("a voltage").contains("in mV, a voltage"));
    let time = Options { time: Some("2".parse().expect("a column")), ..Options::default() };
    assert!(
        with(many, &time).expect_err("no time").contains("column 2 (x [g]) is in g, an acceleration, and not the time")
    );
}

#[test]
fn units_count_as_a_whole() {
    let of = |unit: &str| read(format!("t [s],a [{unit}]\n0,1\n1,2\n"));
    assert_eq!(of("x1000 m/s^2").expect("a factor").channels()[0].values, [1e3, 2e3]);
    for (unit, reason) in [
        ("deka g", "'deka g' is no unit of acceleration that is known"),
        ("100 mV/g", "is in 100 mV/g, the sensitivity of a sensor, and not the acceleration"),
        ("kg", "is in kg, a mass"),
        ("m/s2/Hz", "is no unit of acceleration that is known"),
    ] {
        assert!(of(unit).expect_err(unit).contains(reason), "{unit}: {:?}", of(unit));
    }
    let given = Options { units: Some("ms,g".parse().expect("units")), ..Options::default() };
    let other = with("t [s],a [m/s2]\n0,1\n1,2\n", &given).expect_err("not the same");
    assert_eq!(other, "column 1 (t [s]) is in s by its heading, and in ms by the units given");
    assert!(with("t [ms],a [g]\n0,1\n1,2\n", &given).is_ok(), "the same");
    assert!("ms,volt".parse::<Units>().expect_err("a voltage").to_string().contains("voltage"));
}

#[test]
fn faults_by_line_ten_of_them_and_the_number_of_the_rest() {
    let mut text = "t [s],a [g]\n".to_owned();
    for i in 0..100 {
        text.push_str(&if i % 5 == 2 { format!("{i},x{i}\n") } else { format!("{i},1\n") });
    }
    let error = read(&text).expect_err("twenty faults");
    assert!(error.starts_with("line 4: 'x2' in column 2 (a) is not a number\nline 9: 'x7'"), "{error}");
    assert!(error.ends_with("\nand 10 more") && error.lines().count() == 11, "{error}");
    let skip = Options { skip_bad: true, ..Options::default() };
    assert_eq!(samples(&with(&text, &skip).expect("the rest")), 80);
    for (text, reason) in [
        ("t [s],a [g]\n0,\n1,1\n2,1\n", "line 2: nothing stands in column 2 (a)"),
        ("t [s],a [g]\n0,bad\n1,1\n2,1\n", "line 2: 'bad' in column 2 (a) is not a number"),
        ("t [s],a [g]\n0,1\n1\n2,1\n", "line 3: 1 has 1 of 2 columns"),
        ("t [s],a [g]\n0,1\nend\n1,1\n2,1\n", "line 3: 'end' is no line of numbers"),
        ("t [s],a [g]\n0,1\n1,2,3\n2,1\n", "line 3: '1,2,3' has 3 columns, and the lines above have 2"),
        ("t [s],a [g]\n0,1\n1,1e999\n2,1\n", "line 3: 1e999 in column 2 (a) is beyond 1e100 m/s²"),
        ("t [s],a [g]\n0,1\n1,1\n1e308,1\n", "line 4: the time, 1e308 s after the first one, is beyond 1e100 s"),
        ("t [s],a [g]\n1e-300,1\n2e-300,2\n3e-300,3\n", "time between samples (s) = 1e-300 is not at least 1e-100"),
        (
            "t [s],a [g]\n0,1\n2,1\n1.5,1\n3,1\n",
            "line 4: time 1.5 s does not come after 2.0 s, that of the sample before",
        ),
        ("t [s],a [g]\n0,1\n", "a record needs 2 samples at least; the record has 1"),
        ("", "the file is empty"),
        ("t [s],a [g]\n", "no line of numbers is found in the first 2 lines"),
    ] {
        assert_eq!(read(text).expect_err(text), reason, "{text:?}");
    }
}

/// Any other text than one of columns ends with a message, and soon.
#[test]
fn what_is_no_text_of_columns() {
    assert!(read(vec![b'x'; 3 << 20]).expect_err("one long line").contains("longer than"));
    let mut long = b"t [s],a [g]\n0,1\n1,1\n".to_vec();
    long.extend(vec![b'1'; 3 << 20]);
    assert!(read(long).expect_err("a long line below").contains("longer than"));
    // A heading of a quarter of a megabyte is looked at once, not from each of its blanks on.
    let heading = format!("t [s],{}\n0,1\n1,1\n2,1\n", "a ".repeat(100_000));
    let record = read(&heading).expect_err("no unit");
    assert!(record.len() < 1000, "{}", record.len());
    let wide: String = ["t [s]", "0", "1", "2"].map(|cell| cell.to_owned() + &",b".repeat(20_000) + "\n").concat();
    assert!(read(&wide).expect_err("no acceleration").contains(" and 19981 more"));
    let few = Options { most_values: 1000, ..si() };
    let endless = std::io::Read::chain(&b"0,0\n"[..], std::io::repeat(b'1'));
    assert!(Record::read(endless, &few, |_| ()).is_err());
    let rows: String = (0..2000).map(|i| format!("{i},1\n")).collect();
    assert_eq!(
        with(rows, &few).expect_err("too many"),
        "the record has more than 1000 numbers: take a part of it, or fewer channels"
    );
}

#[test]
fn findings_of_text() {
    let with_gap: String = (0..100).filter(|i| *i != 40).map(|i| format!("{i},0\n")).collect();
    let found = with(with_gap, &si()).expect("a record").findings(10.0);
    assert!(
        matches!(&found[..], [Finding::Gaps { first, count: 1, usual_s }] if first[0].0.to_string() == "line 41" && *usual_s == 1.0),
        "{found:?}"
    );
    // Jitter of a quarter of a step on either side is no gap.
    let mut state = 1_u64;
    let jittered: String = (0..2000)
        .map(|i| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            format!("{:.6},0\n", f64::from(i) + 0.5 * ((state >> 40) as f64 / f64::from(1 << 24) - 0.5))
        })
        .collect();
    let record = with(jittered, &si()).expect("a record");
    assert_eq!((record.step_s(), record.findings(10.0)), (None, vec![]));
    // A shock in the first samples of a record is no drift.
    let early: String = (0..1000)
        .map(|i| {
            format!("{i}e-4,{:.3}\n", if i < 20 { (std::f64::consts::PI * f64::from(i) / 20.0).sin() } else { 0.0 })
        })
        .collect();
    assert_eq!(with(early, &si()).expect("a record").findings(10.0), []);
}

/// An offset of half a percent of the peak is told where it changes the spectrum.
#[test]
fn small_offsets_are_told_where_they_count() {
    let text = |offset: f64| -> String {
        (0..2000)
            .map(|i| {
                format!(
                    "{i}e-4,{:.6}\n",
                    offset
                        + if (1000..1020).contains(&i) {
                            100.0 * (std::f64::consts::PI * f64::from(i - 1000) / 20.0).sin()
                        } else {
                            0.0
                        }
                )
            })
            .collect()
    };
    let found = |offset: f64, hz: f64| with(text(offset), &si()).expect("a record").findings(hz);
    let offset = found(0.5, 10.0);
    // 1 m/s² of 2π · 10 Hz · 0.127 m/s.
    assert!(matches!(&offset[..], [Finding::Offset { share, .. }] if (share - 0.125).abs() < 0.01), "{offset:?}");
    assert_eq!(found(0.5, 1000.0), [], "and not where they don't");
    assert_eq!(found(0.0, 10.0), []);
}

#[test]
fn clipping_is_told_and_coarse_steps_are_not() {
    let text = |a: &dyn Fn(f64) -> f64| -> String {
        (0..400)
            .map(|i| {
                format!(
                    "{i}e-4,{:.4}\n",
                    a(if (100..200).contains(&i) {
                        (std::f64::consts::PI * f64::from(i - 100) / 100.0).sin()
                    } else {
                        0.0
                    })
                )
            })
            .collect()
    };
    let found = |a: &dyn Fn(f64) -> f64| with(text(a), &si()).expect("a record").findings(10.0);
    let clipped = found(&|a| (100.0 * a).min(80.0));
    assert!(matches!(&clipped[..], [Finding::Clipped { samples: 41, value_m_s2: 80.0, .. }]), "{clipped:?}");
    assert_eq!(found(&|a| (20.0 * a).round()), [], "a converter of a few steps");
    // In the second of two channels too.
    let whole = text(&|a| 100.0 * a);
    let clipped = text(&|a| (100.0 * a).min(80.0));
    let column = |line: &str| line.split_once(',').expect("a comma").1.to_owned();
    let both: String =
        whole.lines().zip(clipped.lines()).map(|(one, two)| format!("{one},{}\n", column(two))).collect();
    let found = with(format!("time,ax,ay\n{both}"), &si()).expect("a record").findings(10.0);
    assert!(matches!(&found[..], [Finding::Clipped { channel, samples: 41, .. }] if channel == "ay"), "{found:?}");
}

/// A clock without dates goes round at midnight, as often as it is passed; with dates it does not.
#[test]
fn clocks_over_midnight() {
    let clock = |i: u32| {
        let minutes = 23 * 60 + 20 * i;
        format!("{:02}:{:02}:00,{i}", minutes / 60 % 24, minutes % 60)
    };
    let lines: String = (0..160).map(|i| clock(i) + "\n").collect();
    let record = read(format!("time,a [g]\n{lines}")).expect("over three midnights");
    assert_eq!((record.step_s(), record.times()[0].duration_s()), (Some(1200.0), 159.0 * 1200.0));
    let dated = "date,time,a [g]\n2023-12-31,23:59:59.5,0\n2024-01-01,00:00:00.0,1\n2024-01-01,00:00:00.5,0\n";
    assert_eq!(read(dated).expect("over new year").step_s(), Some(0.5));
    let gap = "date,time,a [g]\n2023-12-31,23:59:59.5,0\n2024-01-03,00:00:00.0,1\n2024-01-03,00:00:00.5,0\n";
    assert_eq!(read(gap).expect("two days on").times()[0].duration_s(), 2.0 * 86_400.0 + 1.0);
    let back = "time,a [g]\n2023-01-02 23:59:59,0\n2023-01-01 00:00:00,1\n2023-01-01 00:00:01,0\n";
    assert!(read(back).expect_err("a day back").contains("does not come after"), "with a date there is no going round");
}

/// Where day and month may be either the date does not count, and must stay the same.
#[test]
fn dates_of_either_order() {
    let of = |dates: [&str; 3]| {
        read(format!("time,a [g]\n{} 10:00:00,0\n{} 10:00:01,1\n{} 10:00:02,0\n", dates[0], dates[1], dates[2]))
    };
    let record = of(["5/4/2023"; 3]).expect("one day");
    assert_eq!((record.step_s(), record.times()[0].start_s()), (Some(1.0), 36_000.0));
    let changed = of(["5/4/2023", "5/4/2023", "6/4/2023"]).expect_err("another date");
    assert!(
        changed.contains("day and month of '6/4/2023', and of '5/4/2023' above, may be the one or the other"),
        "{changed}"
    );
    let day_first = of(["13/4/2023", "13/4/2023", "14/4/2023"]).expect("days first");
    assert_eq!(day_first.times()[0].duration_s(), 86_402.0);
}

/// A rate in the head, or given, beside times that say another one.
#[test]
fn rates_against_times() {
    let times = |step: f64, missing: u32| -> String {
        (0..100)
            .filter(|i| missing == 0 || i % missing != missing - 1)
            .map(|i| format!("{:.4},{}\n", f64::from(i) * step, i % 7))
            .collect()
    };
    let told = |head: &str, step| read(format!("{head}\ntime [s],a [g]\n{}", times(step, 0))).expect("a record");
    let rates = |record: &Record| {
        record.findings(10.0).iter().filter(|finding| matches!(finding, Finding::Rate { .. })).count()
    };
    assert_eq!((rates(&told("Sample rate: 1000 Hz", 1e-3)), rates(&told("Sample rate: 2000 Hz", 1e-3))), (0, 1));
    assert!(
        told("fs = 2 kHz", 1e-3).findings(10.0)[0]
            .to_string()
            .starts_with("the rate of line 1, 2000 Hz, is not that of the times, 1000 Hz")
    );
    let given = |text: &str| with(text, &Options { sample_rate_hz: Some(1e3), ..Options::default() });
    assert_eq!(rates(&given(&format!("time [s],a [g]\n{}", times(2e-3, 0))).expect("told")), 1);
    let missing = given(&format!("time [s],a [g]\n{}", times(1e-3, 10))).expect_err("every tenth is missing");
    assert!(missing.contains("samples are missing"), "{missing}");
    let gaps = read(format!("time [s],a [g]\n{}", times(1e-3, 10))).expect("told").findings(10.0);
    assert!(matches!(gaps[0], Finding::Gaps { count: 9, .. }), "{gaps:?}");
}

/// Every line and every column is something.
#[test]
fn the_account_closes() {
    let text = "# drop 5\nlogger 3\n\ntime [s],a [g],U [V],n,state\n0,0,5,1,idle\n1,x,5,2,idle\n# here\n\n2,9,5,3,hit\n3,0,5,4,hit\nend\n";
    let record = with(text, &Options { skip_bad: true, ..Options::default() }).expect("a record");
    let account = record.account().expect("a text");
    let lines = account.lines;
    assert_eq!((lines.all, lines.heading, lines.rows, lines.bad), (11, 3, 3, 1));
    assert_eq!((lines.empty, lines.comments, lines.below, lines.missing()), (2, 1, 1, 0));
    let taken: Vec<_> = account.columns.iter().map(|(_, what)| what.as_str()).collect();
    assert_eq!(taken, ["time", "acceleration", "a voltage", "number of the row", "words"]);
    assert_eq!(
        account.to_string(),
        "11 lines: 3 heading, 3 rows, 1 not used, 2 empty, 1 comments, 1 text below; columns 1 (time [s]): time, 2 (a [g]): acceleration, \
         3 (U [V]): a voltage, 4 (n): number of the row, 5 (state): words"
    );
}

/// Rows are counted in whole numbers.
#[test]
fn what_rises_without_whole_numbers_is_no_number_of_the_row() {
    let taken = |samples: [&str; 3]| {
        let rows: String = (0..3).zip(samples).map(|(i, n)| format!("{i},{n},{i}\n")).collect();
        let record = read(format!("time [s],Sample,Ax [m/s2]\n{rows}")).expect("a record");
        record.account().expect("a text").columns[1].1.clone()
    };
    assert_eq!(taken(["1", "2", "3"]), "number of the row");
    assert_eq!(taken(["0.5", "1.25", "3.5"]), "no acceleration by its name");
}

/// Counts of a file are no acceleration, whatever unit is given for them.
#[test]
fn counts_of_a_converter() {
    let text =
        |rest: i32| -> String { (0..40).map(|i| format!("{i},{}\n", if i == 20 { 9000 } else { rest })).collect() };
    let of = |rest: i32| {
        with(
            format!("t,az\n{}", text(rest)),
            &Options { units: Some("ms,g".parse().expect("units")), ..Options::default() },
        )
    };
    assert!(of(2048).expect_err("2048 g at rest").contains("counts of a converter"));
    assert!(of(1).is_ok(), "1 g at rest");
    // A volt in place of a g of sensitivity.
    let volts = Options { sensitivity_v_s2_m: clatter_record::sensitivity("100mV/g").ok(), ..Options::default() };
    let record = with("t [s],ch1 [mV]\n0,0\n1,500\n2,0\n", &volts).expect("a voltage");
    assert!((record.channels()[0].values[1] / (5.0 * G) - 1.0).abs() < 1e-12);
    assert!(
        with("t [s],ch1 [g]\n0,0\n1,500\n2,0\n", &volts)
            .expect_err("no voltage")
            .contains("a sensitivity is for volts")
    );
}

/// LabVIEW without a column of times: those of X0 and Delta_X.
#[test]
fn labview_starts_at_its_x0() {
    let text = "LabVIEW Measurement\t\nWriter_Version\t2\nX_Columns\tNo\n***End_of_Header***\t\n\t\nChannels\t1\t\n\
                Y_Unit_Label\tg\t\nX_Dimension\tTime\t\nX0\t-0.25\t\nDelta_X\t5E-5\t\n***End_of_Header***\t\t\n\
                X_Value\tAcceleration\tComment\n\t100.0\n"
        .to_owned()
        + &"\t0.0\n".repeat(30);
    let record = read(text).expect("a record");
    assert_eq!((record.times()[0].start_s(), record.step_s()), (-0.25, Some(5e-5)));
}

/// The channels of a record, each with its largest value in m/s², or why it is refused.
fn peaks(text: &str, options: &Options) -> Result<Vec<(String, f64)>, String> {
    let largest =
        |channel: &clatter_record::Channel| channel.values.iter().fold(0.0_f64, |most, value| most.max(*value));
    let record = with(text, options)?;
    Ok(record.channels().iter().map(|channel| (channel.name.clone(), largest(channel))).collect())
}

/// Headings in which a number, a word or a count of columns is easily taken for what it is not.
#[test]
fn what_is_easily_misread() {
    const G: f64 = 9.806_65;
    let own = |text: &str| peaks(text, &Options::default());
    let given = |text: &str, units: &str| {
        peaks(text, &Options { units: Some(units.parse().expect(units)), ..Options::default() })
    };
    let close = |found: Result<Vec<(String, f64)>, String>, expected: &[(&str, f64)]| {
        let found = found.expect("a record");
        let same = found.len() == expected.len()
            && found.iter().zip(expected).all(|(f, e)| f.0 == e.0 && (f.1 - e.1).abs() <= 1e-9 * e.1);
        assert!(same, "{found:?} is not {expected:?}");
    };
    // Numbers of channels are no factors, nor are ranges of sensors.
    let two = "Time s,Channel 1 g,Channel 2 g\n0,0,0\n0.001,100,100\n0.002,0,0\n";
    close(own(two), &[("Channel 1", 100.0 * G), ("Channel 2", 100.0 * G)]);
    let ranged = "time [s],X (100g)\n0,0\n0.001,50\n0.002,0\n";
    assert!(own(ranged).expect_err("a range").contains("its number may be a range"));
    close(given(ranged, "s,g"), &[("X", 50.0 * G)]);
    for heading in ["adxl375_200g", "acc 16g", "Acc (500 g)", "accel_mV_per_g"] {
        let text = format!("time [s],{heading}\n0,0\n0.001,50\n0.002,0\n");
        assert!(own(&text).is_err(), "{heading}: {:?}", own(&text));
    }
    close(own("time [s],Acc [x10^3 m/s2]\n0,0\n0.001,50\n0.002,0\n"), &[("Acc", 50e3)]);
    // A slow channel leaves cells empty, and the separator stays.
    let slow = "Time (s)\tEvent\tAcc (g)\n0\t\t0\n0.001\t\t100\n0.002\t\t0\n";
    close(own(slow), &[("Acc", 100.0 * G)]);
    let last = "Time [s],Acc [g],Temp [C]\n0,50,21.5\n0.001,100,\n0.002,0,\n0.003,0,\n0.004,0,\n";
    close(own(last), &[("Acc", 100.0 * G)]);
    assert_eq!(samples(&read(last).expect("a record")), 5);
    let labview = "LabVIEW Measurement\t\nWriter_Version\t2\nX_Columns\tNo\n***End_of_Header***\t\n\t\nChannels\t1\t\n\
                   Y_Unit_Label\tg\t\nX_Dimension\tTime\t\nX0\t0.0\t\nDelta_X\t5E-5\t\n***End_of_Header***\t\t\n\
                   X_Value\tAcceleration\tComment\n\t100.0\n"
        .to_owned()
        + &"\t0.0\n".repeat(30);
    close(own(&labview), &[("Acceleration", 100.0 * G)]);
    assert!((read(&labview).expect("a record").step_s().expect("even") - 5e-5).abs() < 1e-15);
    close(own("t,g\ns,m/s2\n0,0\n0.001,100\n0.002,0\n"), &[("g", 100.0)]);
    // A clock is in seconds whatever stands above it.
    let clock = "Time (ms),a (g)\n00:00:00.000,0\n00:00:00.001,100\n00:00:00.002,0\n";
    assert!((read(clock).expect("a record").step_s().expect("even") - 1e-3).abs() < 1e-12);
    // Names of other columns than there are.
    for (text, reason) in [
        ("Time [s],Temp, board [C],Acc top [m/s2],Acc low [g]\n0,21,1,1\n0.001,21,980,10\n", "names 5 columns"),
        (
            "Time (us),Acc (g)\n0,0,000\n50,98,500\n100,100,000\n",
            "line 1 names 2 columns, and the lines of numbers below have 3",
        ),
        (
            "Time (s),Time slow (s),Acc fast (g),Acc slow (g)\n0,0,0,0\n0.001,0.002,1,1\n0.002,0.004,0,0\n",
            "runs at another rate",
        ),
        (
            "Time (s);Acc (g)\n0;0\n0.001;9.9E37\n0.002;0\n",
            "line 3: 9.9E37 in column 2 (Acc) is what instruments write for no value",
        ),
    ] {
        let found = own(text).expect_err(text);
        assert!(found.contains(reason), "{text}: {found}");
        assert!(given(text, "s,g").is_err(), "{text}: units given do not mend it");
    }
    let twice = "Time,Acc (g)\ns,m/s2\n0,0\n0.001,100\n0.002,0\n";
    assert!(own(twice).expect_err("two units").contains("Acc [g] is in m/s2 by the line of units"));
    // Blocks in other units do not go on.
    let blocks = "Time (s),Acc (g)\n0,0\n0.001,100\nTime (s),Acc (m/s2)\n0.002,980\n0.003,0\n";
    let skip = Options { skip_bad: true, ..Options::default() };
    assert!(peaks(blocks, &skip).expect_err("two units").contains("line 4 begins a second block, in other units"));
    close(peaks(&blocks.replace("m/s2", "g"), &skip), &[("Acc", 980.0 * G)]);
    // These are no accelerations, though they begin like one or are in such a unit.
    let phone = "timestamp,accuracy,x,y,z\n0,3,0,0,1\n1,3,0,0,9\n2,3,0,0,1\n";
    close(given(phone, "ms,m/s2"), &[("x", 0.0), ("y", 0.0), ("z", 9.0)]);
    let compass = "Time [ms],AccX [mg],MagX [mG]\n0,0,410\n1,100,410\n2,0,410\n";
    close(own(compass), &[("AccX", 0.1 * G)]);
    let gyro = "t_ms,x,y,z,gx,gy,gz\n0,0,0,1,120,0,0\n1,0,0,9,120,0,0\n2,0,0,1,120,0,0\n";
    close(given(gyro, "ms,g"), &[("x", 0.0), ("y", 0.0), ("z", 9.0 * G)]);
    // A running number is no time.
    assert!(given("Frame,Acc (g)\n1,0\n2,100\n3,0\n", "s,g").is_err());
    // A unit that is in brackets itself.
    close(own("Time,Acc\nms,m/(s^2)\n0,0\n1,980\n2,0\n"), &[("Acc", 980.0)]);
}

/// A file that ends anywhere in its heading, or after it, is read or refused.
#[test]
fn files_may_end_anywhere() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
    let folders = [cases.join("field"), cases];
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).expect("a folder"));
    let files = files.map(|entry| entry.expect("a file").path()).filter(|path| path.is_file());
    let (mut refused, mut kept) = (0_u32, 0_u32);
    for path in files {
        let whole = fs::read(&path).expect("a file");
        for end in 0..whole.len().min(600) {
            *(if with(&whole[..end], &si()).is_ok() { &mut kept } else { &mut refused }) += 1;
        }
    }
    // Both ways were gone.
    assert!(refused > 10_000 && kept > 1000, "{refused} refused, {kept} read");
}
