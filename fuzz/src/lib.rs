//! Checks of input from outside: it is read, or refused with its fault, and the result of reading can be used. The fuzz
//! targets call these, and so do the acceptance tests, with randomly torn inputs.

use std::fs;

use clatter_cli::{Exit, Streams, run};
use clatter_record::{Baseline, Options, Pass, Record, Units, read_limit};
use clatter_shock::{Search, find_shocks, fit_pulses};

/// Commands that answer at once.
const COMMANDS: [&str; 6] = ["zone", "impacts", "atlas", "respond", "simulate", "spectrum"];
/// Options that write files, or ask for work without end.
const LEFT_OUT: [&str; 4] = ["-o", "--output", "--limit", "--impact-limit"];

/// Runs a command line, its arguments line by line.
///
/// # Panics
/// If it ends in another way than with an answer or a refusal in plain text.
pub fn arguments(text: &str) {
    let arguments: Vec<&str> = text.lines().collect();
    let named = arguments.first().is_some_and(|first| COMMANDS.contains(first));
    // Standard input may have no end.
    let waits = arguments.iter().any(|argument| *argument == "-" || argument.ends_with("=-"));
    if !named || waits || arguments.iter().any(|argument| LEFT_OUT.iter().any(|option| argument.starts_with(option))) {
        return;
    }
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let mut streams = Streams { out: &mut out, err: &mut err, interactive: false };
    let exit = run(std::iter::once("clatter").chain(arguments), &mut streams);
    assert!(matches!(exit, Exit::Done | Exit::BadInput), "{text:?}: {exit:?}");
    let shown = String::from_utf8(err).expect("text");
    assert!(shown.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}: {shown:?}");
}

/// Reads a list of velocity shocks, of pulses or of shock tests, as the command does.
///
/// # Panics
/// If neither an answer nor a refusal comes.
pub fn list(bytes: &[u8]) {
    let dir = tempfile::tempdir().expect("a directory");
    let file = dir.path().join("list.csv");
    fs::write(&file, bytes).expect("a file");
    let file = file.display();
    for option in ["--shocks-file", "--pulses-file"] {
        let arguments = ["clatter", "respond", "--omega=100", "--damping=0.05", &format!("{option}={file}")];
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let exit = run(arguments, &mut Streams { out: &mut out, err: &mut err, interactive: false });
        assert_eq!(exit == Exit::Done, !out.is_empty(), "{}", String::from_utf8_lossy(&err));
    }
}

/// Reads a measured record of any kind.
///
/// # Panics
/// If the values are out of order, or more than allowed.
pub fn record(bytes: &[u8]) {
    let most_values = 100_000;
    for (units, full_scale_m_s2) in [(None, None), (Some(Units::si()), None), (None, Some(500.0))] {
        let skip_bad = units.is_some();
        let options = Options { units, skip_bad, most_values, full_scale_m_s2, ..Options::default() };
        let Ok(mut record) = Record::read(bytes, &options, |_| ()) else { continue };
        for channel in record.channels() {
            let times: Vec<f64> = channel.times().times_s().collect();
            assert!(times.windows(2).all(|pair| pair[0] <= pair[1]) && times.len() >= 2, "times of {}", times.len());
            assert_eq!(channel.values.len(), times.len());
        }
        assert!(record.channels().iter().flat_map(|channel| &channel.values).all(|a| a.abs() <= 1e100), "a value");
        let _ = record.findings(10.0).iter().map(ToString::to_string).collect::<Vec<_>>();
        let _ = record.without_baseline(Baseline::Linear).map(|_| record.filter(Pass::Low, 100.0, 2));
        let channel = &record.channels()[0];
        if let Some(step_s) = channel.times().step_s() {
            let values = &channel.values;
            let _ = find_shocks(values, step_s, &Search { threshold_m_s2: None, quiet_s: 0.01 });
            let _ = fit_pulses(values, step_s);
        }
    }
    let _ = read_limit(bytes);
}
