//! The summary and the train against exact rational arithmetic (212 cases, 25 digits).
#![expect(clippy::float_cmp, reason = "exact answers are compared exactly")]

use crate::cases::{cases, decimal};
use clatter::accuracy::{APPROACH, Allowance, DURATION, DURATION_LONG, FINAL, JUMP, NEAR_ENDLESS, PEAK, TIME};
use clatter::{Bar, Count, End, PeakImpact, Start};

/// Largest error seen of a quantity, over the allowed one.
#[derive(Default)]
struct Worst(Vec<(&'static str, &'static str, f64, f64, String)>);

impl Worst {
    fn hold(&mut self, case: &str, what: &Allowance, got: f64, want: f64, scale: f64) {
        let error = if got == want { 0.0 } else { (got - want).abs() / scale };
        assert!(error <= what.error, "{case}: {} is {got:e}, not {want:e}: off by {error:.2e}", what.quantity);
        match self.0.iter_mut().find(|w| w.0 == what.quantity && w.1 == what.range) {
            Some(w) if w.2 >= error => {}
            Some(w) => (w.2, w.4) = (error, case.to_owned()),
            None => self.0.push((what.quantity, what.range, error, what.error, case.to_owned())),
        }
    }
}

#[test]
fn every_case_of_the_oracle_is_within_the_allowed_errors() {
    let mut worst = Worst::default();
    for c in &cases() {
        let name = &c.name;
        let bar = match (c.q, c.k) {
            (Some(q), _) => Bar::new(q, c.e),
            (_, Some(k)) => Bar::from_gyration_ratio(k, c.e),
            _ => panic!("{name}: neither q nor k"),
        }
        .unwrap();
        let start = Start::new([c.va, c.vb], 1.0).unwrap();
        let s = bar.summary(&start);
        let count = c.count();
        assert_eq!(s.count, count.map_or(Count::Endless, Count::Finite), "{name}: count");
        assert_eq!(bar.count(&start), s.count, "{name}: count alone");
        assert_eq!(bar.peak(&start), s.peak, "{name}: peak alone");

        let peak = decimal(&c.peak_end_dv);
        worst.hold(name, &PEAK, s.peak.end, peak, peak);
        let index = c.peak_index.as_u64().map_or(PeakImpact::Limit, PeakImpact::Number);
        assert_eq!(s.peak.impact, index, "{name}: impact of the peak");

        let (edge, long) = (c.is_at_the_edge(), !c.is_short());
        let allowed = if edge {
            &NEAR_ENDLESS
        } else if long {
            &DURATION_LONG
        } else {
            &DURATION
        };
        let duration = decimal(&c.duration);
        worst.hold(name, allowed, s.duration, duration, duration.max(1.0));

        match (c.last(), s.final_velocity) {
            (None, got) => assert_eq!(got, None, "{name}: no final velocity"),
            (Some(want), Some(got)) if !long => {
                let size = want[0].abs().max(want[1].abs());
                for (g, w) in got.iter().zip(&want) {
                    worst.hold(name, if edge { &NEAR_ENDLESS } else { &FINAL }, *g, *w, size);
                }
            }
            (_, got) => assert!(got.is_some(), "{name}: a final velocity"),
        }

        let n = count.unwrap_or(u64::MAX).min(10);
        let impacts: Vec<_> = bar.train(&start).take(usize::try_from(n).unwrap()).collect();
        assert_eq!(impacts.len() as u64, n, "{name}: impacts listed");
        for (i, (got, (a, t))) in impacts.iter().zip(c.approach.iter().zip(&c.times)).enumerate() {
            let (a, t) = (decimal(a), decimal(t));
            assert_eq!((got.number, got.end), (i as u64 + 1, End::striking(i as u64 + 1)), "{name}: order");
            let size = a.abs().max(c.va.abs());
            worst.hold(name, &APPROACH, got.approach, a, size);
            worst.hold(name, if edge { &NEAR_ENDLESS } else { &TIME }, got.time, t, t.max(1.0));
            let jumps = [-(1.0 + c.e) * a, bar.q() * (1.0 + c.e) * a];
            let jumps = if i % 2 == 0 { jumps } else { [jumps[1], jumps[0]] };
            for (g, w) in got.delta_v.iter().zip(jumps) {
                worst.hold(name, &JUMP, *g, w, 2.0 * size);
            }
        }
    }
    for (quantity, range, error, allowed, case) in &worst.0 {
        eprintln!("{quantity:20} {range:45} {error:.1e} of {allowed:.0e} ({case})");
    }
}
