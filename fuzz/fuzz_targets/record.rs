//! A measured record of any kind is read, or its fault is told; what is read can be used.

#![no_main]

use clatter_record::{Baseline, Options, Pass, Record, Units, read_limit};
use clatter_shock::{Search, find_shocks, fit_pulses};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let most_values = 100_000;
    for (units, full_scale_m_s2) in [(None, None), (Some(Units::si()), None), (None, Some(500.0))] {
        let skip_bad = units.is_some();
        let options = Options { units, skip_bad, most_values, full_scale_m_s2, ..Options::default() };
        let Ok(mut record) = Record::read(bytes, &options, |_| ()) else { continue };
        for channel in record.channels() {
            let times: Vec<f64> = channel.times().times_s().collect();
            assert!(times.windows(2).all(|pair| pair[0] <= pair[1]) && times.len() >= 2);
            assert!(channel.values.len() == times.len());
        }
        assert!(record.channels().iter().flat_map(|channel| &channel.values).all(|a| a.abs() <= 1e100));
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
});
