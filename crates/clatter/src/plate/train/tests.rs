use super::later::Exact;
use super::*;
use proptest::prelude::*;

fn cases() -> impl Strategy<Value = (Plate, PlateStart)> {
    let plate = ([0.1..1.2_f64, 0.1..1.2_f64], [-0.5..0.5_f64, -0.5..0.5_f64], 0.02..=1.0_f64);
    let start = ([-1.5..0.2_f64, -1.5..0.2_f64], [0.05..1.0_f64, 0.05..1.0_f64]);
    (plate, start).prop_map(|((k, s, e), ([b, d], gaps))| {
        (Plate::off_center(k, s, e).unwrap(), PlateStart::new([-1.0, b, d], gaps).unwrap())
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Plain floats, double-double and whole numbers lead to the same impacts.
    #[test]
    fn all_digits_lead_to_the_same_train((plate, start) in cases()) {
        let plain = plate.train(&start);
        let mut wide = plain.clone();
        wide.steps.next = Next::Doubt;
        let mut exact = Exact::new(&plate, &start);
        let mut word = Vec::new();
        for (n, impact) in plain.take(30).enumerate() {
            let more = wide.next();
            prop_assert!(more.is_some(), "impact {} is not there with more digits", n + 1);
            let more = more.unwrap();
            prop_assert_eq!((impact.number, impact.corner, impact.tie), (more.number, more.corner, more.tie));
            prop_assert!((impact.approach - more.approach).abs() <= 1e-11, "{impact:?}, not {more:?}");
            prop_assert!((impact.time - more.time).abs() <= 1e-10 * more.time.max(1.0), "{impact:?}, not {more:?}");
            if n > 0 {
                let found = exact.next(word.last().map(|j| usize::from(*j)));
                prop_assert_eq!(found.corner, Some(impact.corner as usize), "impact {} in whole numbers", n + 1);
            }
            word.push(impact.corner as u8);
            prop_assert!(exact.follow(&word));
        }
    }

    /// No value of a corner is off by more than the bound says, far beyond where it is used.
    #[test]
    fn roundings_stay_within_their_bound((plate, start) in cases()) {
        let mut plain = plate.train(&start);
        let mut wide = plain.clone();
        wide.steps.next = Next::Doubt;
        while let Some(impact) = plain.next().filter(|impact| impact.number <= 60) {
            let same = wide.next().map(|more| more.corner) == Some(impact.corner);
            prop_assert!(same, "impact {}", impact.number);
            if plain.later.is_some() {
                break;
            }
            let [dv, dp] = plain.steps.spread.after(plain.steps.strikes);
            let later = wide.later.as_ref().unwrap();
            for i in 0..4 {
                let [v, p] = [later.v[i].middle.hi, later.p[i].middle.hi];
                prop_assert!((plain.steps.v[i] - v).abs() <= dv, "velocity {v} off by more than {dv:e}");
                prop_assert!((plain.steps.p[i] - p).abs() <= dp, "intercept {p} off by more than {dp:e}");
            }
        }
    }
}

/// A train that needs more digits than allowed is given up, and reports it.
#[test]
fn a_train_of_too_many_digits_is_given_up() {
    let plate = Plate::off_center([0.3, 0.8], [0.1, -0.1], 1e-300).unwrap();
    let mut train = plate.train(&PlateStart::level([0.45, 0.65]).unwrap());
    let listed = train.by_ref().take(5000).count();
    assert!(train.undecided() && listed < 5000, "{listed}");
}

/// An edge that chatters without end shrinks beyond double-double numbers: whole numbers renew them.
#[test]
fn whole_numbers_carry_an_endless_train_on() {
    let plate = Plate::off_center([0.3, 0.8], [0.1, -0.1], 0.08).unwrap();
    let start = PlateStart::level([0.45, 0.65]).unwrap();
    let mut train = plate.train(&start);
    let impacts: Vec<_> = train.by_ref().take(250).collect();
    assert_eq!(impacts.len(), 250);
    assert!(train.later.as_ref().is_some_and(|later| later.is_exact()), "no whole number was needed");
    assert!(impacts.iter().all(|impact| impact.approach < 0.0), "every corner comes down");
    let ratio = |n: usize| impacts[n].approach / impacts[n - 2].approach;
    assert!((ratio(249) / ratio(201) - 1.0).abs() < 1e-12, "a decay: {} and {}", ratio(201), ratio(249));
}
