//! One shock as loggers, oscilloscopes, programs and field notes write it: read right, or refused with the reason.

#![expect(clippy::too_many_lines, reason = "tables of notations")]
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small numbers"
)]

use std::fmt::Write as _;

use clatter_record::{Options, Record};

const G: f64 = 9.806_65;
/// Samples of the shock, 0.1 ms apart.
const SAMPLES: usize = 80;

/// Sample `i` of the shock in g: a half-sine of 50 g and 2 ms, and one of −20 g and 1 ms after it.
fn shock(i: usize) -> f64 {
    let half_sine = |begin: usize, length: usize| (std::f64::consts::PI * (i - begin) as f64 / length as f64).sin();
    match i {
        20..=40 => 50.0 * half_sine(20, 20),
        50..=60 => -20.0 * half_sine(50, 10),
        _ => 0.0,
    }
}

/// A head, and a line of each sample from its number, its time in seconds and its acceleration in g.
fn text(head: &str, line: impl Fn(usize, f64, f64) -> String) -> String {
    let mut text = head.to_owned();
    for i in 0..SAMPLES {
        let time = i as f64 * 1e-4;
        // No negative zeros: no program prints them as such.
        let _ = writeln!(text, "{}", line(i, time, shock(i) + 0.0));
    }
    text
}

/// `time,acceleration` in s and g.
fn plain(head: &str) -> String {
    text(head, |_, t, a| format!("{t:.4},{a:.4}"))
}

/// The same with another separator.
fn by(separator: &str, head: &str) -> String {
    text(head, |_, t, a| format!("{t:.4}{separator}{a:.4}"))
}

/// With decimal commas.
fn commas(text: impl AsRef<str>) -> String {
    text.as_ref().replace('.', ",")
}

/// A time of day.
fn clock(t: f64) -> String {
    format!("12:00:{:07.4}", 1.0 + t)
}

/// The record that is to be read.
enum Want {
    /// The shock, in so many channels, the last of which has it whole.
    Shock(usize),
    /// The shock, of another step in seconds.
    Every(f64),
    /// The shock in other units: times this.
    Times(f64),
    /// Refused, with these words.
    Refused(&'static str),
}
use Want::{Every, Refused, Shock, Times};

fn options(given: &str) -> Options {
    let mut options = Options::default();
    for (key, value) in given.split_whitespace().filter_map(|word| word.split_once('=')) {
        match key {
            "units" => options.units = Some(value.parse().expect(value)),
            "rate" => options.sample_rate_hz = Some(value.parse().expect(value)),
            "acceleration" => options.accelerations.push(value.parse().expect(value)),
            "sensitivity" => options.sensitivity_v_s2_m = Some(clatter_record::sensitivity(value).expect(value)),
            "sensor" => options.sensor = Some(value.to_owned()),
            "record" => options.record = Some(value.parse().expect(value)),
            _ => panic!("{key}"),
        }
    }
    options
}

/// Returns what is wrong with how a text is read, if anything.
fn fault(bytes: &[u8], given: &str, want: &Want) -> Option<String> {
    let record = match (Record::read(bytes, &options(given), |_| ()), want) {
        (Err(error), Refused(words)) => {
            let error = error.to_string();
            return (!error.contains(words)).then(|| format!("refused with other words: {error}"));
        }
        (Err(error), _) => return Some(format!("refused: {error}")),
        (Ok(record), Refused(_)) => {
            let channel = record.channels().last().expect("a channel");
            return Some(format!("read: {:?} {:?}", channel.name, record.step_s()));
        }
        (Ok(record), _) => record,
    };
    let (channels, step_s, size) = match *want {
        Every(step_s) => (1, step_s, 1.0),
        Times(size) => (1, 1e-4, size),
        Shock(channels) => (channels, 1e-4, 1.0),
        Refused(_) => unreachable!(),
    };
    let channel = record.channels().last().expect("a channel");
    let of = |best: fn(f64, f64) -> f64| channel.values.iter().copied().fold(0.0, best);
    // Five digits at least are printed.
    let close = |got: f64, want: f64| (got / want - 1.0).abs() < 1e-5;
    let got = (
        record.channels().len(),
        record.channels()[0].values.len(),
        of(f64::max) / (size * G),
        of(f64::min) / (size * G),
    );
    let is_right = got.0 == channels
        && got.1 == SAMPLES
        && close(got.2, 50.0)
        && close(got.3, -20.0)
        && record.step_s().is_some_and(|got| close(got, step_s));
    (!is_right)
        .then(|| format!("{channels} channels, {SAMPLES} samples, step {step_s} wanted; {got:?} {:?}", record.step_s()))
}

/// Fails with every notation that is not read as it should be.
fn all_right(cases: Vec<(&str, impl AsRef<[u8]>, &str, Want)>) {
    let count = cases.len();
    let (mut faults, mut wrong) = (String::new(), 0);
    for (name, text, given, want) in cases {
        if let Some(fault) = fault(text.as_ref(), given, &want) {
            let _ = writeln!(faults, "{name}: {fault}");
            wrong += 1;
        }
    }
    assert!(faults.is_empty(), "{wrong} of {count} are wrong:\n{faults}");
}

#[test]
fn heads_of_loggers_and_programs() {
    let stamp = |t: f64| format!("2023-05-01 {}", clock(t));
    all_right(vec![
        (
            "Campbell TOA5",
            text(
                "\"TOA5\",\"CR6\",\"CR6\",\"4312\",\"CR6.Std.10.02\",\"CPU:drop.CR6\",\"55124\",\"Shock\"\n\
                 \"TIMESTAMP\",\"RECORD\",\"AccZ\"\n\"TS\",\"RN\",\"g\"\n\"\",\"\",\"Smp\"\n",
                |i, t, a| format!("\"{}\",{i},{a:.4}", stamp(t)),
            ),
            "",
            Shock(1),
        ),
        (
            "DIAdem, ASCII",
            commas(by(";", "DIAdem-Export\nDatei: Falltest_05\nKanalname: Zeit; Beschl_Z\n\nZeit;Beschl_Z\ns;g\n")),
            "",
            Shock(1),
        ),
        (
            "catman, ASCII",
            commas(by(
                "\t",
                "HBM catman AP 5.2\nDatei: C:\\Daten\\Fall_05.bin\nT0 = 01.05.2023 12:00:00\nKanalanzahl=2\nKanallänge=80\n\
                 Zeit  1 - schnelle Rate [s]\tMX410_CH_1 Beschl [g]\n",
            )),
            "",
            Shock(1),
        ),
        (
            "catman, names, units and settings below one another",
            commas(by(
                "\t",
                "Zeit  1 - Standardmessrate\tMX840A_0_1\nSamplerate: 10000 Hz\tSamplerate: 10000 Hz\ns\tg\n\
                 Min: 0,0000\tMin: -20,0000\n",
            )),
            "",
            Shock(1),
        ),
        (
            "R, write.csv",
            text("\"\",\"time_s\",\"acc_g\"\n", |i, t, a| format!("\"{}\",{t:.4},{a:.4}", i + 1)),
            "",
            Shock(1),
        ),
        (
            "R, write.table: a name less than columns",
            text("\"time_s\" \"acc_g\"\n", |i, t, a| format!("\"{}\" {t:.4} {a:.4}", i + 1)),
            "",
            Shock(1),
        ),
        (
            "R, row names of letters",
            text("\"time [s]\",\"acc [g]\"\n", |i, t, a| format!("\"s{}\",{t:.4},{a:.4}", i + 1)),
            "",
            Shock(1),
        ),
        (
            "Rigol DS1000Z",
            text("X,CH1,Start,Increment,\nSequence,Volt,-2.000000e-03,1.000000e-04\n", |i, _, a| {
                format!("{i},{:.4e},,", 0.1 * a)
            }),
            "sensitivity=100mV/g",
            Shock(1),
        ),
        (
            "Rigol without what a volt is",
            text("X,CH1,Start,Increment,\nSequence,Volt,-2.000000e-03,1.000000e-04\n", |i, _, a| {
                format!("{i},{:.4e},,", 0.1 * a)
            }),
            "",
            Refused("a voltage"),
        ),
        (
            "Tektronix TDS",
            text("", |i, t, a| {
                let keys = [
                    "Record Length,8.000000e+01",
                    "Sample Interval,1.000000e-04",
                    "Trigger Point,2.000000000000e+01",
                    ",",
                    ",",
                    ",",
                    "Source,CH1",
                    "Vertical Units,V",
                    "Vertical Scale,5.000000e-01",
                    "Vertical Offset,0.000000e+00",
                    "Horizontal Units,s",
                    "Horizontal Scale,1.000000e-03",
                    "Pt Fmt,Y",
                    "Yzero,0.000000e+00",
                    "Probe Atten,1.000000e+00",
                ];
                format!("{},,{:.7},{:.5},", keys.get(i).unwrap_or(&","), t - 2e-3, 0.1 * a)
            }),
            "sensitivity=100mV/g",
            Shock(1),
        ),
        (
            "Tektronix MSO",
            text(
                "Model,MSO24\nFirmware Version,1.28\n\nWaveform Type,ANALOG\nPoint Format,Y\nHorizontal Units,s\n\
                 Horizontal Scale,0.001\nHorizontal Delay,0\nSample Interval,1e-04\nRecord Length,80\nGating,0.0% to 100.0%\n\
                 Probe Attenuation,1\nVertical Units,V\nVertical Offset,0\nVertical Scale,1\nVertical Position,0\n,\n,\nLabel,\n\
                 TIME,CH1\n",
                |_, t, a| format!("{:.6e},{:.5}", t - 2e-3, 0.1 * a),
            ),
            "sensitivity=100mV/g",
            Shock(1),
        ),
        (
            "Keysight",
            text("x-axis,1\nsecond,Volt\n", |_, t, a| format!("{:.6E},{:.5E}", t - 2e-3, 0.1 * a)),
            "sensitivity=100mV/g",
            Shock(1),
        ),
        (
            "LeCroy",
            text(
                "LECROYWS3054,22101,Waveform\nSegments,1,SegmentSize,80\nSegment,TrigTime,TimeSinceSegment1\n\
                 #1,01-May-2023 12:00:00,0\nTime,Ampl\n",
                |_, t, a| format!("{:.5e},{:.5}", t - 2e-3, 0.1 * a),
            ),
            "sensitivity=100mV/g",
            Shock(1),
        ),
        (
            "PicoScope",
            text("Time,Channel A\n(ms),(mV)\n\n", |_, t, a| format!("{:.4},{:.4}", 1e3 * t, 10.0 * a)),
            "sensitivity=10mV/g",
            Shock(1),
        ),
        (
            "Shimmer",
            text("\"sep=\t\"\nShimmer_Timestamp_Unix_CAL\tShimmer_Accel_WR_Z_CAL\nms\tm/(s^2)*\t\n", |_, t, a| {
                format!("{:.1}\t{:.6}\t", 1_682_942_400_000.0 + 1e3 * t, G * a)
            }),
            "",
            Shock(1),
        ),
        (
            "psql",
            format!(
                "{}(80 rows)\n\n",
                text("  t_s   |  a_g\n--------+---------\n", |_, t, a| format!(" {t:.4} | {a:.4}"))
            ),
            "",
            Shock(1),
        ),
        ("a name with a line break", plain("\"Time\n[s]\",\"Acceleration, top\n[g]\"\n"), "", Shock(1)),
        ("ISO 80000", by("\t", "t/s\ta/g\n"), "", Shock(1)),
        ("units by 'in'", by(";", "Zeit in s;Beschleunigung in g\n"), "", Shock(1)),
        ("French", commas(by(";", "Temps (s);Accélération (g)\n")), "", Shock(1)),
        ("Spanish", by("\t", "Tiempo (s)\tAceleración Z (g)\n"), "", Shock(1)),
        (
            "Blackbox",
            text("loopIteration,time (us),accSmooth[0] (g),gyroADC[0],motor[0],vbatLatest (V)\n", |i, t, a| {
                format!("{i},{:.0},{a:.4},-3,1180,16.4", 1e6 * t)
            }),
            "",
            Shock(1),
        ),
        (
            "a rate in the head, one column",
            text("Sample rate: 10000 Hz\nAcceleration [g]\n", |_, _, a| format!("{a:.4}")),
            "",
            Shock(1),
        ),
        (
            "a rate in a comment, three columns",
            text("# Sampling frequency (Hz): 10000\n# x [g], y [g], z [g]\n", |_, _, a| format!("0.1,0.2,{a:.4}")),
            "",
            Shock(3),
        ),
        (
            "NI, a line of settings in between",
            text("Title,Drop 5\nOperator,K. M.,\nDate,2023-05-01\nSerial,10021,\nTime [s],Acc [g]\n", |_, t, a| {
                format!("{t:.4},{a:.4}")
            }),
            "",
            Shock(1),
        ),
    ]);
}

#[test]
fn units_factors_and_remarks() {
    let of = |heading: &str| plain(&format!("time [s],{heading}\n"));
    let scaled = |heading: &str, size: f64| {
        text(&format!("time [s],{heading}\n"), move |_, t, a| format!("{t:.4},{:.6}", a * size))
    };
    all_right(vec![
        ("a factor behind the bracket", scaled("acc [g] x1000", 1e-3), "", Shock(1)),
        ("a factor before the bracket", scaled("acc ×10³ [m/s²]", G * 1e-3), "", Shock(1)),
        ("a factor in a bracket of its own", scaled("acc [m/s2] (x10)", G * 0.1), "", Shock(1)),
        ("a divisor", of("acc [m/s²]/9.80665"), "", Shock(1)),
        ("a divisor by blanks", of("acc [m/s²] / 9.80665"), "", Shock(1)),
        ("a power of ten", scaled("acc [10^-3 g]", 1e3), "", Shock(1)),
        ("an axis behind the unit", of("acc [g] x"), "", Shock(1)),
        ("an exponent of the whole", of("acc [g]^2"), "", Refused("")),
        ("a division in brackets", of("acc [g] (/1000)"), "", Refused("")),
        ("a power behind the bracket", of("acc [g] e-3"), "", Refused("")),
        (
            "a function among channels, units given",
            text("time,acc,acc^2\n", |_, t, a| format!("{t:.4},{a:.4},{:.4}", a * a)),
            "units=s,g",
            Shock(1),
        ),
        ("units in a line of the head", plain("Units: g\nTime unit: s\ntime,acceleration\n"), "", Shock(1)),
        ("seconds since something", plain("time (s since trigger),acceleration [g]\n"), "", Shock(1)),
        ("a remark before the unit", of("az (raw) [g]"), "", Shock(1)),
        ("a remark behind the unit", of("\"Beschleunigung [g] (gefiltert, CFC 1000)\""), "", Shock(1)),
        ("a trigger that is a remark", of("Response (Trigger) [g]"), "", Shock(1)),
        ("a mass that is a place", of("Mass 2 top [m/s2]"), "", Times(1.0 / G)),
        ("a speed that is a test", of("Drop speed test a [g]"), "", Shock(1)),
        ("two units in two brackets", of("a [g] (m/s2)"), "", Refused("")),
        ("gal", scaled("acc (gal)", 100.0 * G), "", Shock(1)),
        ("cm/s/s", scaled("acc (cm/s/s)", 100.0 * G), "", Shock(1)),
        ("m/(s*s)", scaled("acc [m/(s*s)]", G), "", Shock(1)),
        ("m/(s·s)", scaled("acc [m/(s·s)]", G), "", Shock(1)),
        ("metre per second squared", scaled("acc [metre per second squared]", G), "", Shock(1)),
        ("micro-g", scaled("acc [µg]", 1e6), "", Shock(1)),
        ("log10", of("log10 acceleration [g]"), "", Refused("")),
        ("a square", of("acc^2 [g^2]"), "", Refused("")),
        ("a density", of("acc PSD [g^2/Hz]"), "", Refused("")),
        ("a density by its name alone", of("PSD acc [g]"), "", Refused("")),
        ("units in cells", text("time,acceleration\n", |_, t, a| format!("{:.1} ms,{a:.4} g", 1e3 * t)), "", Shock(1)),
        ("units in cells, close", text("time;acceleration\n", |_, t, a| format!("{t:.4}s;{a:.4}g")), "", Shock(1)),
        (
            "other units in cells than above",
            text("time [s],acceleration [m/s2]\n", |_, t, a| format!("{t:.4},{a:.4} g")),
            "",
            Refused(""),
        ),
        (
            "another unit in one cell",
            plain("time,acceleration [g]\n").replace("0.0010,0.0000", "0.0010,0.0000 V"),
            "units=s,g",
            Refused("line 12"),
        ),
        (
            "a factor on the time",
            text("time [s] x1000,acc [g]\n", |_, t, a| format!("{:.7},{a:.4}", 1e-3 * t)),
            "",
            Shock(1),
        ),
        (
            "three axes by compass",
            text("time [s],N [g],E [g],Z [g]\n", |_, t, a| format!("{t:.4},0,0,{a:.4}")),
            "",
            Shock(3),
        ),
        (
            "three axes by compass, units given",
            text("time,N,E,Z\n", |_, t, a| format!("{t:.4},0,0,{a:.4}")),
            "units=s,g",
            Shock(3),
        ),
        (
            "columns that are no accelerations, units given",
            text("time,x,roll,battery,motor,loopIteration\n", |i, t, a| format!("{t:.4},{a:.4},1.5,3.7,1200,{i}")),
            "units=s,g",
            Shock(1),
        ),
        (
            "columns of a controller, units given",
            text("t,gyro_x,pitch,yaw,rssi,setpoint,heading,lat,lon,altitude,throttle,current,ch_top\n", |_, t, a| {
                format!("{t:.4},1,2,3,4,5,6,7,8,9,10,11,{a:.4}")
            }),
            "units=s,g",
            Shock(1),
        ),
    ]);
}

#[test]
fn numbers() {
    let in_mm = |print: &dyn Fn(f64) -> String, head: &str, separator: &str| {
        text(head, |_, t, a| format!("{t:.4}{separator}{}", print(a * 1000.0)))
    };
    // 49 391.0 as 49,391.0.
    let grouped = |value: f64, group: &str, point: &str, decimals: usize| {
        let plain = format!("{:.decimals$}", value.abs());
        let (whole, fraction) = plain.split_once('.').unwrap_or((&plain, ""));
        let (before, after) = whole.split_at(whole.len().saturating_sub(3));
        let sign = if value < 0.0 { "-" } else { "" };
        let whole = if before.is_empty() { after.to_owned() } else { format!("{before}{group}{after}") };
        if decimals == 0 { format!("{sign}{whole}") } else { format!("{sign}{whole}{point}{fraction}") }
    };
    all_right(vec![
        (
            "1,500.0 in quotes",
            in_mm(&|v| format!("\"{}\"", grouped(v, ",", ".", 1)), "t [s],a [mg]\n", ","),
            "",
            Shock(1),
        ),
        ("1.500,0", commas(by(";", "")), "units=s,g", Shock(1)),
        (
            "1.500,0 beside 0,0001",
            text("t [s];a [mg]\n", |_, t, a| {
                format!("{};{}", format!("{t:.4}").replace('.', ","), grouped(1000.0 * a, ".", ",", 1))
            }),
            "",
            Shock(1),
        ),
        ("1’500", in_mm(&|v| grouped(v, "’", ".", 1), "t [s];a [mg]\n", ";"), "", Shock(1)),
        (
            "1.500 beside 704, and 50.000",
            text("t [us];a [mg]\n", |i, _, a| format!("{};{}", 100 * i, grouped(1000.0 * a, ".", ",", 0))),
            "",
            Shock(1),
        ),
        (
            "1,500 beside 704, and 50,000",
            text("t [us];a [mg]\n", |i, _, a| format!("{};{}", 100 * i, grouped(1000.0 * a, ",", ".", 0))),
            "",
            Shock(1),
        ),
        (
            "1.391 beside 704, and none ends in 0",
            text("t [us];a [mg]\n", |i, _, a| {
                format!(
                    "{};{}",
                    100 * i,
                    grouped(
                        (500.0 * a).round()
                            + if a.abs() > 1.0 && (500.0 * a).round() % 10.0 == 0.0 { 1.0 } else { 0.0 },
                        ".",
                        ",",
                        0
                    )
                )
            }),
            "",
            Refused("between thousands"),
        ),
        ("a minus sign of U+2212", plain("t [s],a [g]\n").replace(",-", ",\u{2212}"), "", Shock(1)),
        ("an en dash for a minus", plain("t [s],a [g]\n").replace(",-", ",–"), "", Shock(1)),
        (
            "decimal commas in quotes",
            text("\"t [s]\",\"a [g]\"\n", |_, t, a| format!("\"{t:.4}\",\"{a:.4}\"").replace('.', ",")),
            "",
            Shock(1),
        ),
        (
            "decimal commas without quotes",
            text("t [s],a [g]\n", |_, t, a| format!("{t:.4},{a:.4}").replace('.', ",")),
            "",
            Refused(""),
        ),
        (
            "three digits of an exponent",
            text("t [s] a [g]\n", |_, t, a| {
                format!("{t:.4} {}", format!("{a:.6e}").replace('e', "e+00").replace("+00-", "-00"))
            }),
            "",
            Shock(1),
        ),
        ("#N/A", plain("t [s],a [g]\n").replace("0.0010,0.0000", "0.0010,#N/A"), "", Refused("line 12")),
        (
            "over the range",
            plain("t [s],a [g]\n").replace("0.0010,0.0000", "0.0010,OVER"),
            "",
            Refused("OVER in column 2"),
        ),
        (
            "hexadecimal",
            text("t [s],a [g]\n", |_, t, a| format!("{t:.4},0x{:04X}", (a.abs() * 100.0) as u32)),
            "",
            Refused(""),
        ),
        ("no end of the last line", plain("t [s],a [g]\n").trim_end().to_owned(), "", Shock(1)),
    ]);
}

#[test]
fn times() {
    let of = |head: &str, print: &dyn Fn(f64) -> String| text(head, |_, t, a| format!("{};{a:.4}", print(t)));
    let half = |t: f64| format!("{}:{:07.4}", if t < 2e-3 { "11:59" } else { "12:00" }, (60.0 - 2e-3 + t) % 60.0);
    all_right(vec![
        ("PM", of("time;a [g]\n", &|t| format!("{} PM", clock(t))), "", Shock(1)),
        (
            "AM to PM",
            of("time;a [g]\n", &|t| format!("{} {}", half(t), if t < 2e-3 { "AM" } else { "PM" })),
            "",
            Shock(1),
        ),
        ("a.m., close", of("time;a [g]\n", &|t| format!("{}am", clock(t))), "", Shock(1)),
        (
            "a colon before milliseconds",
            text("time;a [g]\n", |i, _, a| format!("12:00:01:{i:03};{a:.4}")),
            "",
            Every(1e-3),
        ),
        ("dd.mm.yyyy", of("Datum/Zeit;a [g]\n", &|t| format!("01.05.2023 {}", clock(t))), "", Shock(1)),
        (
            "dd.mm.yyyy, decimal commas",
            commas(of("Zeit;a [g]\n", &clock)).replace("12:", "31.05.2023 12:"),
            "",
            Shock(1),
        ),
        ("m/d/yyyy", of("Timestamp;a [g]\n", &|t| format!("5/13/2023 {}", clock(t))), "", Shock(1)),
        ("m/d/yyyy PM", of("Timestamp;a [g]\n", &|t| format!("5/13/2023 {} PM", clock(t))), "", Shock(1)),
        ("d/m/yyyy", of("Timestamp;a [g]\n", &|t| format!("13/05/2023 {}", clock(t))), "", Shock(1)),
        ("13-May-2023", of("Timestamp;a [g]\n", &|t| format!("13-May-2023 {}", clock(t))), "", Shock(1)),
        ("a date of its own", of("Date;Time;a [g]\n", &|t| format!("13/05/2023;{}", clock(t))), "", Shock(1)),
        ("hours beyond 24", of("Time;a [g]\n", &|t| format!("124:00:{t:07.4}")), "", Shock(1)),
        ("minutes and seconds", of("Time;a [g]\n", &|t| format!("05:{t:07.4}")), "", Shock(1)),
        ("no time of day", of("Time;a [g]\n", &|t| format!("{} noon", clock(t))), "", Refused("noon")),
        (
            "coarse milliseconds of 800 Hz",
            text("t [ms];a [g]\n", |i, _, a| format!("{};{a:.4}", 5 * i / 4)),
            "",
            Every(1.25e-3),
        ),
        (
            "coarse milliseconds of 800 Hz, rounded",
            text("t [ms];a [g]\n", |i, _, a| format!("{};{a:.4}", (5 * i + 2) / 4)),
            "",
            Every(1.25e-3),
        ),
        (
            "coarse hundredths of 60 Hz",
            text("t [s];a [g]\n", |i, _, a| format!("{:.2};{a:.4}", (100 * i / 60) as f64 / 100.0)),
            "",
            Every(1.0 / 60.0),
        ),
        (
            "a clock in whole milliseconds of 800 Hz",
            text("t;a [g]\n", |i, _, a| format!("12:00:01.{:03};{a:.4}", 5 * i / 4)),
            "",
            Every(1.25e-3),
        ),
        (
            "a doubled line",
            plain("t [s],a [g]\n").replace("0.0010,0.0000\n", "0.0010,0.0000\n0.0010,0.0000\n"),
            "",
            Refused("line 13"),
        ),
        ("days", of("t [d];a [g]\n", &|t| format!("{:.12}", t / 86_400.0)), "", Shock(1)),
    ]);
}

#[test]
fn lines_that_fit_no_block() {
    let head = "time [s],acc [g]\n";
    let lines = plain(head);
    let many = |values: usize, head: &str| {
        let mut text = head.to_owned();
        for i in 0..SAMPLES {
            let _ = write!(text, " {:13.6E}{}", shock(i), if i % values == values - 1 { "\n" } else { "" });
        }
        text
    };
    all_right(vec![
        ("a table above", format!("Calibration\n1,0.0100\n2,0.0101\n\n{lines}"), "", Refused("line 2")),
        ("a table above, passed over", format!("Calibration\n1,0.0100\n2,0.0101\n\n{lines}"), "record=2", Shock(1)),
        ("a table below", format!("{lines}\nPeaks\n1,0.0030,50.0\n2,0.0055,-20.0\n"), "", Refused("line 8")),
        (
            "a table below, of as many columns",
            format!("{lines}\nfrequency [Hz],level\n10,50.0\n20,-20.0\n"),
            "",
            Refused("line"),
        ),
        ("another record below", format!("{lines}\n{lines}"), "", Refused("line 83 begins another record")),
        ("the second of two records", format!("{}\n{lines}", lines.replace("0.", "7.")), "record=2", Shock(1)),
        ("the third of two records", format!("{lines}\n{lines}"), "record=3", Refused("there are 2 records")),
        ("statistics above", format!("Max,50.0\nMin,-20.0\n{lines}"), "", Shock(1)),
        ("statistics below", format!("{lines}\nMax,50.0\nMin,-20.0\n"), "", Shock(1)),
        ("statistics above, in a line of numbers", format!("50.0,-20.0\n{lines}"), "", Refused("line 1")),
        ("rows of another separator", format!("{lines}0.0080;0.5\n0.0081;0.5\n"), "", Refused("line 82")),
        ("rows of another separator above", format!("0.0080;0.5\n0.0081;0.5\n{lines}"), "", Refused("line")),
        (
            "rows with decimal commas",
            format!("{}0,0080;0,5\n0,0081;0,5\n", by(";", "t [s];a [g]\n")),
            "",
            Refused("line 82"),
        ),
        ("rows of fewer cells", format!("{lines}0.0080\n"), "", Refused("line 82")),
        ("a count above", format!("80\n{lines}"), "", Shock(1)),
        ("eight values a line", many(8, ""), "units=s,g", Refused("")),
        ("eight values a line, a rate", many(8, ""), "units=g rate=10000", Refused("")),
        (
            "PEER",
            many(
                5,
                "PEER NGA STRONG MOTION DATABASE RECORD\nDrop table, 5/1/2023, Lab 4, 180\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=     80, DT=   .0001 SEC\n",
            ),
            "",
            Shock(1),
        ),
        (
            "PEER of another count",
            many(
                5,
                "PEER NGA STRONG MOTION DATABASE RECORD\nDrop table, 5/1/2023, Lab 4, 180\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=     90, DT=   .0001 SEC\n",
            ),
            "",
            Refused("90"),
        ),
        (
            "sensors in turns",
            text("time [s],sensor,value [g]\n", |_, t, a| format!("{t:.4},ACC,{a:.4}\n{t:.4},GYR,{:.4}", 7.0)),
            "",
            Refused("sensor"),
        ),
        (
            "nodes in turns by number",
            text("id,time [s],acc [g]\n", |_, t, a| format!("1,{t:.4},{a:.4}\n2,{t:.4},{:.4}", 7.0)),
            "",
            Refused("--sensor"),
        ),
        (
            "axes in turns",
            text("time [s],axis,acc [g]\n", |_, t, a| format!("{t:.4},x,{:.4}\n{t:.4},z,{a:.4}", 7.0)),
            "sensor=z",
            Shock(1),
        ),
        (
            "sensors one after another",
            format!(
                "{}{}",
                text("time [s],sensor,acc [g]\n", |_, t, a| format!("{t:.4},A,{a:.4}")),
                text("", |_, t, _| format!("{:.4},B,7.0", t + 0.008))
            ),
            "",
            Refused("come in turns"),
        ),
        (
            "a name less than columns, and no names of rows",
            text("time [ms],acc [g]\n", |i, t, a| format!("{i},{t:.4},{a:.4}")),
            "",
            Refused("names 2 columns"),
        ),
        (
            "sensors in turns, one taken",
            text("time [s],sensor,value [g]\n", |_, t, a| format!("{t:.4},ACC,{a:.4}\n{t:.4},GYR,{:.4}", 7.0)),
            "sensor=ACC",
            Shock(1),
        ),
        (
            "sensors in turns, without names",
            text("", |_, t, a| format!("ACC,{t:.4},{a:.4}\nGYR,{t:.4},{:.4}", 7.0)),
            "units=s,g",
            Refused("ACC"),
        ),
        (
            "an event noted in some lines",
            text("time [s],acc [g],event\n", |i, t, a| {
                format!("{t:.4},{a:.4},{}", if i == 30 { "impact" } else { "" })
            }),
            "",
            Shock(1),
        ),
        (
            "a name, a unit and a value a line",
            text("time [s],value,unit\n", |_, t, a| format!("{t:.4},{a:.4},g")),
            "",
            Shock(1),
        ),
    ]);
}

#[test]
fn encodings_of_the_far_east() {
    let japanese = b"\x8e\x9e\x8a\xd4[s],\x89\xc1\x91\xac\x93x[G]\n";
    let chinese = b"\xca\xb1\xbc\xe4(s),\xbc\xd3\xcb\xd9\xb6\xc8(g)\n";
    let with = |head: &[u8]| [head, plain("").as_bytes()].concat();
    all_right(vec![("Shift-JIS", with(japanese), "", Shock(1)), ("GBK", with(chinese), "", Shock(1))]);
}
