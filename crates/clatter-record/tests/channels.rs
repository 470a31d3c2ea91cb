//! Channels with times of their own: each keeps the rate and the start that its file gives it.

#![expect(clippy::cast_precision_loss, clippy::format_push_string, reason = "small numbers and texts")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use clatter_record::{Channel, Error, Finding, Options, Record, Units};

const G: f64 = 9.806_65;

fn read(bytes: impl AsRef<[u8]>, options: &Options) -> Result<Record, Error> {
    Record::read(bytes.as_ref(), options, |_| ())
}
fn own(text: &str) -> Record {
    read(text, &Options::default()).unwrap_or_else(|error| panic!("{error}: {text}"))
}
fn message(text: impl AsRef<[u8]>, options: &Options) -> String {
    read(text, options).expect_err("refused").to_string()
}
fn file(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)).expect(name)
}
fn si() -> Options {
    Options { units: Some(Units::si()), ..Options::default() }
}

/// Name, samples, first time, step in microseconds to the nearest, largest value over g.
fn told(channel: &Channel) -> (&str, usize, f64, Option<f64>, f64) {
    let times = channel.times();
    let largest = channel.values.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let round = |value: f64| (value * 1e6).round() / 1e6;
    (&channel.name, times.samples(), round(times.start_s()), times.step_s().map(|s| round(1e6 * s)), round(largest / G))
}

/// The formulas of `data/make.py`, and their largest values.
const A: f64 = 12.5;
const HALF_B: f64 = 96.0;

#[test]
fn containers_keep_the_times_of_each_channel() {
    let (fast, slow) = (Some(976.5625), Some(1953.125));
    let si = &Options { units: Some(Units::si()), ..Options::default() };
    for (name, options, expected) in [
        // In ms, from 250 ms on; and one that began half a second later.
        (
            "rates.tdms",
            &Options::default(),
            vec![("a", 40, 0.0, fast, A), ("b", 20, 0.25, slow, HALF_B), ("later", 40, 0.5, fast, A)],
        ),
        ("structs.mat", si, vec![("one.acc", 40, 0.0, fast, A / G), ("two.acc", 20, 0.0, slow, HALF_B / G)]),
    ] {
        let record = read(file(name), options).expect(name);
        let found: Vec<_> = record.channels().iter().map(told).collect();
        let rounded = |(name, n, start, step, most): (&'static str, _, _, _, f64)| {
            (name, n, start, step, (most * 1e6).round() / 1e6)
        };
        assert_eq!(found, expected.into_iter().map(rounded).collect::<Vec<_>>(), "{name}");
        assert_eq!(record.step_s(), None, "{name}");
        let message = record.one_time("a resultant").expect_err(name).to_string();
        assert!(message.starts_with("a resultant needs channels of one time: "), "{message}");
    }
    let spectrum = read(file("rates.tdms"), &Options::default()).expect("a record");
    let found: Vec<String> = spectrum.findings(10.0).iter().map(ToString::to_string).collect();
    assert_eq!(found[0], "nothing is made of \"spectrum\" (over an abscissa in Hz: it is no record over time)");
}

#[cfg(feature = "hdf5")]
#[test]
fn times_go_with_the_channels_of_their_numbers_and_groups() {
    let record = read(file("numbered.h5"), &si()).expect("a record");
    let found: Vec<_> =
        record.channels().iter().map(|channel| (told(channel).0, told(channel).1, told(channel).3)).collect();
    let slow = Some(1953.125);
    assert_eq!(found, [("acc1", 40, Some(976.5625)), ("acc2", 20, slow), ("run time/acc", 20, slow)]);
    // By the whole name as well.
    let one = Options { accelerations: vec!["run time/acc".parse().expect("a name")], ..si() };
    assert_eq!(read(file("numbered.h5"), &one).expect("a record").channels().len(), 1);
}

#[test]
fn raw_data_of_daqmx_are_those_that_were_scaled() {
    for name in ["daqmx.tdms", "daqmx_big.tdms"] {
        let record = read(file(name), &Options::default()).expect(name);
        let found: Vec<_> = record.channels().iter().map(told).collect();
        let fast = Some(976.5625);
        // The digital line has no unit of acceleration.
        assert_eq!(found, [("a", 40, 0.0, fast, A), ("c", 40, 0.0, fast, 4.0 * A)], "{name}");
    }
}

/// As many samples as npTDMS reads of the same bytes, and the user is told.
#[test]
fn a_tdms_file_that_is_cut_short_is_read_to_its_end() {
    let whole = file("rates.tdms");
    let channels = |cut: usize| {
        let record = read(&whole[..whole.len() - cut], &Options::default()).expect("a record");
        let told = |finding: &Finding| matches!(finding, Finding::Note(note) if note.contains("ends within"));
        let notes = record.findings(10.0).iter().filter(|finding| told(finding)).count();
        (record.channels().iter().map(|channel| channel.values.len()).collect::<Vec<_>>(), notes)
    };
    assert_eq!(channels(0), (vec![40, 20, 40], 0));
    // The last channel, of the spectrum, has 40 values of 8 bytes.
    assert_eq!(channels(8), (vec![40, 20, 40], 1));
    assert_eq!(channels(8 * 40 + 12), (vec![40, 20, 38], 1));
    assert_eq!(channels(8 * 80 + 8), (vec![40, 19], 1));
    let raw = file("daqmx.tdms");
    let record = read(&raw[..raw.len() - 7], &Options::default()).expect("a record");
    assert_eq!(record.channels()[0].values.len(), 38);
}

#[test]
fn columns_of_times_in_text_go_with_the_channels_behind_them() {
    let mut text = "t1,a1,t2,a2\n".to_owned();
    for i in 0..60 {
        let second = if i < 30 { format!("{:.4},{}", f64::from(i) * 2e-4, -i) } else { ",".to_owned() };
        let _ = writeln!(text, "{:.4},{i},{second}", f64::from(i) * 1e-4);
    }
    let units = Options { units: Some("s,g".parse().expect("units")), ..Options::default() };
    let pairs = [("a1", 60, 0.0, Some(100.0), 59.0), ("a2", 30, 0.0, Some(200.0), 29.0)];
    let record = read(&text, &units).expect("a record");
    assert_eq!(record.channels().iter().map(told).collect::<Vec<_>>(), pairs);
    // In any order, by the numbers of their names.
    let turned: String = text.lines().fold(String::new(), |mut all, line| {
        let cells: Vec<&str> = line.split(',').collect();
        let _ = writeln!(all, "{},{},{},{}", cells[1], cells[3], cells[0], cells[2]);
        all
    });
    let record = read(&turned, &units).expect("a record");
    assert_eq!(record.channels().iter().map(told).collect::<Vec<_>>(), pairs);
    // One of them alone takes its own times.
    let second = Options { accelerations: vec!["a2".parse().expect("a name")], ..units.clone() };
    assert_eq!(told(&read(&text, &second).expect("a record").channels()[0]), pairs[1]);
    // The same times twice are one.
    let same = own("time [s],a [g],time [ms],b [g]\n0,0,0,0\n0.001,1,1,2\n0.002,0,2,0\n");
    assert_eq!((same.step_s(), same.channels().len()), (Some(1e-3), 2));
    // A rate stands in place of both; then a gap would move all behind it.
    let rate = Options { sample_rate_hz: Some(1e4), ..units };
    assert_eq!(read(&text, &rate).expect("a record").channels()[1].values.len(), 30);
    let gap = "t1,a1,t2,a2\n0,0,0,0\n1,1,,\n2,2,4,2\n3,3,6,3\n";
    assert!(message(gap, &rate).contains("line 3: nothing stands in the columns of a2"));
}

#[test]
fn conditioning_works_channel_by_channel() {
    let record = own("time [s],a [g],time 2 [s],b [g]\n0,0,1,0\n1,1,1.5,2\n2,2,2,4\n3,3,2.5,5\n4,4,3,6\n");
    let part = record.clone().window(1.0, 2.0).expect("a window");
    let found: Vec<_> =
        part.channels().iter().map(|channel| (channel.values.len(), channel.times().start_s())).collect();
    assert_eq!(found, [(2, 1.0), (3, 1.0)]);
    assert!(record.window(0.0, 1.2).expect_err("one sample of b").to_string().contains("1 samples"));
}

// LabVIEW ---------------------------------------------------------------------------------------------------------------------------

/// A file of two channels at 10 kHz: its heading, and the rows of a segment from `x0` on.
fn labview(x_columns: &str, point: char, segments: &[(f64, usize)]) -> String {
    let comma = |text: String| text.replace('.', &point.to_string());
    let mut text = format!(
        "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t{point}\nX_Columns\t{x_columns}\nTime_Pref\tRelative\n\
         ***End_of_Header***\t\n"
    );
    let multi = x_columns == "Multi";
    let wide = |name: &str, values: [String; 2]| {
        if multi {
            format!("{name}\t{}\t\t{}\t\n", values[0], values[1])
        } else {
            format!("{name}\t{}\t{}\n", values[0], values[1])
        }
    };
    let both = |name: &str, value: &str| wide(name, [value.to_owned(), value.to_owned()]);
    for (x0, rows) in segments {
        text += "\t\n";
        text += "Channels\t2\t\t\t\n";
        text += &both("Samples", &rows.to_string());
        text += &both("Date", "2024/01/02");
        text += &both("Time", &comma("10:00:00.7271890640258789063".to_owned()));
        text += &both("Y_Unit_Label", "g");
        text += &both("X0", &comma(format!("{x0:?}E+0")));
        text += &both("Delta_X", &comma("1.0E-4".to_owned()));
        text += "***End_of_Header***\t\t\t\t\n";
        text += if multi { "X_Value\tax (raw)\tX_Value\tay\tComment\n" } else { "X_Value\tax (raw)\tay\tComment\n" };
        for i in 0..*rows {
            let time = comma(format!("{:.6}", x0 + 1e-4 * i as f64));
            let [one, other] = [i as f64, -2.0 * i as f64].map(|a| comma(format!("{a:.6}")));
            text += &match x_columns {
                "No" => format!("\t{one}\t{other}\n"),
                "One" => format!("{time}\t{one}\t{other}\n"),
                _ => format!("{time}\t{one}\t{time}\t{other}\n"),
            };
        }
    }
    text
}

#[test]
fn labview_measurements_by_their_headings() {
    for x_columns in ["No", "One", "Multi"] {
        for point in ['.', ','] {
            for rows in [2, 3, 10, 300] {
                let record = own(&labview(x_columns, point, &[(0.0, rows)]));
                let last = (rows - 1) as f64;
                let step = Some(100.0);
                let expected = [("ax (raw)", rows, 0.0, step, last), ("ay", rows, 0.0, step, 2.0 * last)];
                assert_eq!(
                    record.channels().iter().map(told).collect::<Vec<_>>(),
                    expected,
                    "{x_columns}, {point}, {rows}"
                );
            }
        }
    }
}

#[test]
fn segments_are_records_unless_they_go_on() {
    for x_columns in ["No", "One", "Multi"] {
        // From 10 ms on 20 more: no sample is missing.
        let record = own(&labview(x_columns, ',', &[(0.0, 100), (0.01, 20)]));
        assert_eq!((told(&record.channels()[1]).1, record.step_s()), (120, Some(1e-4)), "{x_columns}");
        let apart = labview(x_columns, '.', &[(0.0, 100), (0.5, 20)]);
        let refused = message(&apart, &Options::default());
        assert!(
            refused.starts_with("the file holds 2 records that do not follow one on another: 100 rows"),
            "{refused}"
        );
        let second = read(&apart, &Options { record: Some(2), ..Options::default() }).expect("a record");
        assert_eq!((told(&second.channels()[0]).1, second.channels()[0].times().start_s()), (20, 0.5), "{x_columns}");
        assert_eq!(
            message(&apart, &Options { record: Some(3), ..Options::default() }),
            "there is no record 3 in the file: there are 2 records"
        );
    }
    let text = "t [s],a [g]\n0,0\n1,1\n";
    assert!(message(text, &Options { record: Some(2), ..Options::default() }).contains("there is one record"));
}

#[test]
fn samples_that_a_heading_tells_of_are_there() {
    let whole = labview("No", '.', &[(0.0, 100)]);
    let cut: String = whole.split_inclusive('\n').take(80).collect();
    assert!(message(&cut, &Options::default()).contains("the record ends after 64 of the 100 samples"));
    let options = Options { skip_bad: true, ..Options::default() };
    assert_eq!(read(&cut, &options).expect("a record").channels()[0].values.len(), 64);
    // Rows that no heading tells of: as many records, or refused.
    let twice = whole.clone() + &"\t1.0\t2.0\n".repeat(100);
    assert!(message(&twice, &Options::default()).contains("the file holds 2 records"));
    let more = whole + &"\t1.0\t2.0\n".repeat(30);
    assert!(message(&more, &Options::default()).contains("130 rows stand where Samples says 100"));
}

#[test]
fn labview_channels_of_two_rates() {
    let text = labview("No", '.', &[(0.0, 50)]).replace("Delta_X\t1.0E-4\t1.0E-4", "Delta_X\t1.0E-4\t2.0E-4");
    let steps: Vec<_> = own(&text).channels().iter().map(|channel| channel.times().step_s()).collect();
    assert_eq!(steps, [Some(1e-4), Some(2e-4)]);
    // One began a quarter of a second after the other.
    let time = "10:00:00.7271890640258789063";
    let text = text.replace(&format!("{time}\t{time}"), &format!("{time}\t10:00:00.9771890640258789063"));
    let start_s = own(&text).channels()[1].times().start_s();
    assert!((start_s - 0.25).abs() < 1e-6, "{start_s}");
}

// Ends ------------------------------------------------------------------------------------------------------------------------------

#[test]
fn a_file_that_ends_inside_a_number_is_told() {
    let rows = |print: &dyn Fn(f64) -> String| {
        (0..30).fold("t [s],a [g]\n".to_owned(), |mut text, i| {
            let _ = writeln!(text, "{:.4},{}", f64::from(i) * 1e-3, print(f64::from(i) + 123.25));
            text
        })
    };
    let [decimals, power, whole] =
        [rows(&|a| format!("{a:.3}")), rows(&|a| format!("{a:.3E}").replace('E', "E+0")), rows(&|a| format!("{a:.0}"))];
    for (text, cut) in [(&decimals, 2), (&decimals, 5), (&power, 2), (&power, 5), (&whole, 2)] {
        let torn = &text[..text.len() - cut];
        let message = message(torn, &Options::default());
        assert!(message.starts_with("line 31: the file ends within this line, and '"), "{message}");
        let options = Options { skip_bad: true, ..Options::default() };
        assert_eq!(read(torn, &options).expect("a record").channels()[0].values.len(), 29);
    }
    // Without the end of the line alone all is there, and numbers of any number of digits are none that are cut.
    for text in [&decimals, &power, &whole] {
        assert_eq!(own(&text[..text.len() - 1]).channels()[0].values.len(), 30);
    }
    let shortest = "t [s],a [g]\n0,0.125\n0.001,3\n0.002,0.5\n0.003,4.25\n0.004,2";
    assert_eq!(own(shortest).channels()[0].values.len(), 5);
}

// Units -----------------------------------------------------------------------------------------------------------------------------

#[test]
fn floats_of_sound_take_a_full_scale_or_a_unit() {
    let full = Options { full_scale_m_s2: Some(100.0 * G), ..Options::default() };
    for name in ["f32.wav", "f64.wav"] {
        assert!((told(&read(file(name), &full).expect(name).channels()[0]).4 - 100.0 * A).abs() < 1e-9, "{name}");
        let unit = Options { units: Some("s,g".parse().expect("units")), ..Options::default() };
        assert!((told(&read(file(name), &unit).expect(name).channels()[0]).4 - A).abs() < 1e-9, "{name}");
    }
    // A channel with a unit has no full scale; one that counts in shares of it has no unit.
    assert!(message("t [s],a [g]\n0,0\n1,1\n", &full).contains("full scale"));
    assert!(message(file("i32.wav"), &Options { units: Some(Units::si()), ..full }).contains("full scale"));
}

/// A file is opened by its name; one that is not there is named.
#[test]
fn a_file_is_opened_by_its_name() {
    let path = std::env::temp_dir().join(format!("clatter-record-{}.csv", std::process::id()));
    fs::write(&path, "t [s],up [m/s2]\n2.0000,0\n2.0010,-30\n2.0020,30\n2.0030,0\n").expect("a file");
    let record = Record::open(&path);
    fs::remove_file(&path).expect("the file");
    let record = record.expect("a record");
    // The first of two samples of the same size, at the time that the file has.
    assert_eq!(record.channel("up").map(Channel::peak), Some((2.001, -30.0)));
    assert!(record.channel("down").is_none());
    let error = Record::open(&path).expect_err("no file").to_string();
    assert!(error.contains(&path.display().to_string()), "{error}");
}

/// Channels of the same rate and length that begin at other times were not sampled together.
#[test]
fn channels_that_begin_otherwise_have_other_times() {
    let text = |begins_s: f64| {
        (0..50).fold("t1 [s],a1 [g],t2 [s],a2 [g]\n".to_owned(), |text, i| {
            let t = f64::from(i) * 1e-3;
            text + &format!("{t:.4},{i},{:.4},{}\n", begins_s + t, 2 * i)
        })
    };
    let [together, apart] = [0.0, 0.25].map(|begins_s| own(&text(begins_s)));
    assert_eq!([together.times().len(), apart.times().len()], [1, 2]);
    assert!(apart.one_time("a resultant").is_err() && together.one_time("a resultant").is_ok());
    let starts: Vec<f64> = apart.times().iter().map(|times| times.start_s()).collect();
    assert_eq!(starts, [0.0, 0.25]);
}
