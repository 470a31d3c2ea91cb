//! Plans: the study that holds the estimates, their limits, and what they say where nothing is good enough.

mod plan_study;

use clatter::flight::{Body, Scene};
use clatter_scene::plan::{BarRung, ComponentRung, FIRST_STRIKES, Pair, Plan, Quantity, STRIKES, Setup, Warning};
use clatter_shock::{DampingRatio, Suspension};
use plan_study::{QUANTITIES, Random, TOLERANCES, study, worth};

/// A phone lands at 5° from a meter, its part near the end that touches first.
fn setup(tilt_deg: f64, gravity: f64, contact_s: Option<f64>, hz: f64) -> Setup {
    let body = Body::new(0.14, 0.14 / 12.0_f64.sqrt()).expect("as the test has it");
    let scene = Scene::new(body, 0.3, 4.43, tilt_deg, gravity).expect("as the test has it");
    let part =
        Suspension::from_hz(hz, DampingRatio::new(0.05).expect("as the test has it")).expect("as the test has it");
    Setup::new(scene, contact_s, -0.9, part).expect("as the test has it")
}

/// Some scenes of the study, the same each time; the example draws fresh ones.
#[test]
fn plans_of_random_scenes_are_good_enough() {
    let scenes = if cfg!(debug_assertions) { 60 } else { 400 };
    let (outcomes, refused) = study(1, scenes);
    assert!(refused < scenes / 20, "{refused} refused");
    for (k, tolerance) in TOLERANCES.iter().enumerate() {
        let w = worth(outcomes.iter(), k);
        assert!(w.scenes > 2 * scenes, "{w:?}");
        assert!(w.within >= 0.995, "tolerance {tolerance}: {w:?}");
        for o in &outcomes {
            let (run, warned) = (o.run(o.plans[k].pair), o.plans[k].warning.is_some());
            let what = format!("scene {}, {:?} within {tolerance}, {run:?}: {:?}", o.scene, o.quantity, o.setup);
            assert!(warned || o.planned(k).error <= 3.0 * tolerance, "{what}");
            assert!(run.estimate >= 0.0, "{what}");
            assert!(warned || o.plans[k].estimate.error <= *tolerance, "{what}");
        }
        // In an optimized build alone costs mean something.
        if !cfg!(debug_assertions) {
            assert!(w.of_highest < 0.6, "tolerance {tolerance}: {w:?}");
            // Of 10 % it hangs on few scenes, and the study reports it.
            assert!(k < 1 || w.over_oracle <= 2.0, "tolerance {tolerance}: {w:?}");
        }
        // Some scene must need contacts, and some get less.
        assert!(w.needed > 0.05 && w.given < 0.97, "tolerance {tolerance}: {w:?}");
    }
    // What a search passes over because of the bound: one scene in a thousand may reach more, by more than 1 %. Of
    // 8900, none does.
    let above = outcomes.iter().filter(|o| o.truth > 1.01 * o.setup.forecast(o.quantity).at_most()).count();
    assert!(1000 * above <= outcomes.len(), "{above} of {} reach more than the bound", outcomes.len());
}

/// A train so short that it ends, in half of its strikes, long before the part swings out: its peak stands after all
/// that were followed.
#[test]
fn a_bound_holds_what_rings_after_the_strikes_followed() {
    let body = Body::off_center(0.0816, 0.0684, 0.03).unwrap();
    let scene = Scene::new(body, 0.095, 4.46, 13.98, 9.81).unwrap();
    let part = Suspension::from_hz(158.0, DampingRatio::new(0.0).unwrap()).unwrap();
    let setup = Setup::new(scene, None, -0.548, part).unwrap();
    let pair = Pair { bar: BarRung::FiniteTilt, component: ComponentRung::ImpulseTrain };
    let reached = setup.demand(pair, Quantity::PeakAcceleration, f64::INFINITY).unwrap();
    let at_most = setup.forecast(Quantity::PeakAcceleration).at_most();
    assert!(reached <= at_most && at_most < 2.0 * reached, "{reached} {at_most}");
}

/// One drop of a component: length and gyration in m, e, speed in m/s, tilt in degrees; contact time in s, position, ω
/// in rad/s, ζ.
fn drop_of([length, gyration, e, speed, tilt_deg]: [f64; 5], [contact, position, omega, zeta]: [f64; 4]) -> Setup {
    let body = Body::new(length, gyration).expect("as the test has it");
    let scene = Scene::new(body, e, speed, tilt_deg, 9.81).expect("as the test has it");
    let part = Suspension::new(omega, DampingRatio::new(zeta).expect("as the test has it"));
    Setup::new(scene, Some(contact), position, part.expect("as the test has it")).expect("as the test has it")
}

/// Error of a pair against the highest one until rest in fine pieces.
fn off(setup: &Setup, pair: Pair, quantity: Quantity, until_s: f64) -> f64 {
    let truth = setup.demand_fine(Pair::HIGHEST, quantity, f64::INFINITY, 384).expect("as the test has it");
    (setup.demand(pair, quantity, until_s).expect("as the test has it") / truth - 1.0).abs()
}

/// Impacts are followed until nothing later counts, which leaves out most of them and changes nothing.
#[test]
fn impacts_are_followed_until_nothing_higher_comes() {
    let mut random = Random(3);
    let (mut strikes, mut until_rest) = (0, 0);
    for scene in 0..if cfg!(debug_assertions) { 50 } else { 500 } {
        let setup = random.setup();
        for quantity in QUANTITIES {
            let rigid = |pair: &&Pair| matches!(pair.bar, BarRung::Ballistic | BarRung::FiniteTilt);
            for &pair in Pair::planned(quantity).iter().filter(rigid) {
                let answer = setup.answer(pair, quantity, f64::INFINITY).unwrap();
                let whole = setup.answer_fine(pair, quantity, f64::INFINITY, 34).unwrap();
                let off = (answer.value / whole.value - 1.0).abs();
                // Roundings.
                assert!(off < 1e-9, "scene {scene}, {quantity:?}, {pair:?}: {off}");
                (strikes, until_rest) = (strikes + answer.strikes, until_rest + whole.strikes);
            }
        }
    }
    assert!(5 * strikes < until_rest, "{strikes} of {until_rest}");
}

/// What made the highest pair stop before the peak, or miss it between its pieces.
#[test]
fn contacts_are_followed_until_nothing_higher_comes() {
    let mut wrong = Vec::new();
    for (what, drop, part) in [
        (
            "the last contact never parts, and has the largest shock",
            [0.38, 0.1735, 0.0114, 3.32, 17.4],
            [4.75e-4, 0.085, 5245.0, 0.644],
        ),
        (
            "one end lies down for long, and the other lands at the end of it",
            [0.32, 0.1082, 0.0161, 0.7076, 26.1],
            [6.57e-5, -0.449, 350.5, 0.158],
        ),
        (
            "the bar whirls, and its energy does not show at its ends",
            [0.0966, 0.0203, 0.9285, 4.7217, 0.3376],
            [1.642e-4, 0.6414, 3099.0, 0.0887],
        ),
        (
            "the velocity turns within two contacts, on a dashpot",
            [0.335, 0.0492, 0.0496, 0.483, 8.21],
            [1.32e-4, -0.988, 181.0, 0.995],
        ),
        (
            "the shocks of two light ends nearly cancel, and a strong dashpot follows what is left",
            [0.0606, 0.004_952, 0.0751, 0.7332, 0.321],
            [8.714e-4, -0.8663, 1208.6, 1.3648],
        ),
        (
            "a stiff part does not ring up over several shocks as impulses would have it",
            [0.279_172_2, 0.075_485_6, 0.759_571_3, 6.545_272_1, 8.237_057],
            [9.961_482e-4, -0.588_980_7, 19703.218, 0.001_524_9],
        ),
        (
            "two contacts that overlap push a stiff part less than they do in all",
            [0.142_056_97, 0.029_657_31, 0.432_293_32, 6.537_003_2, 0.638_540_86],
            [5.881_171_4e-4, -0.158_927_81, 60857.75, 0.100_430_78],
        ),
        (
            "a bar that whirls is upright as it leaves",
            [0.089_997_689, 0.025_864_439, 0.937_817_89, 4.206_042_15, 7.249_865],
            [8.635_154_2e-4, 0.024_916_288, 86848.236, 0.668_557_84],
        ),
        (
            "contacts that overlap are no impulse as they begin, and ring on with what rang before",
            [0.107_335_955, 0.037_323_263, 0.060_094_468, 1.190_725_83, 3.291_325_05],
            [2.020_465_81e-4, -0.233_070_02, 2677.1261, 0.001_752_153],
        ),
        (
            "what rang before takes from a shock",
            [0.359_280_525, 0.076_936_503, 0.911_128_892, 2.341_633_467, 0.577_432_01],
            [4.314_880_81e-4, -0.521_142_36, 2824.3871, 0.055_760_375],
        ),
        (
            "a part that is neither soft nor stiff rings less than after impulses",
            [0.244_546_963, 0.049_858_8, 0.845_847_798, 3.432_622_979, 18.707_240_65],
            [1.002_746_11e-3, -0.050_575_38, 5137.3586, 0.022_478_831],
        ),
        (
            "pulses that begin at once leave a stiff part ringing",
            [0.130_125_508, 0.083_574_002, 0.085_820_129, 7.018_211_724, 2.317_575_71],
            [5.498_231_51e-4, -0.349_781_34, 63798.4342, 0.001_224_843],
        ),
        (
            "strikes at both ends push to and fro, and a part rings up later than at first",
            [
                0.126_960_398_337_568_2,
                0.012_869_136_985_177_781,
                0.918_792_503_087_231_7,
                5.584_800_703_201_203_5,
                0.486_724_975_445_558_7,
            ],
            [2.984_385_372_117_191e-4, 0.727_534_386_609_809_6, 1_143.347_551_198_577_5, 0.038_573_652_623_337],
        ),
    ] {
        let setup = drop_of(drop, part);
        for quantity in QUANTITIES {
            let error = off(&setup, Pair::HIGHEST, quantity, f64::INFINITY);
            if error > 1e-3 {
                wrong.push(format!("{what}: {quantity:?} off by {error:e}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// What estimates once did not know, a drop and a part for which it counts, and the quantity.
const BENT: &[(&str, [f64; 5], [f64; 4], Quantity)] = &[
    (
        "the angle turns far between two strikes",
        [0.1488, 0.0653, 0.307, 2.82, 25.3],
        [6.72e-5, 0.639, 21857.0, 0.0571],
        Quantity::VelocityShock,
    ),
    (
        "later strikes are mistimed by more than the component turns",
        [0.1788, 0.0932, 0.6646, 2.382, 0.144],
        [5e-5, -0.853, 324.0, 0.0081],
        Quantity::PeakAcceleration,
    ),
    (
        "the other end lifts a contact that has not done all it would",
        [0.057_874, 0.031_35, 0.0297, 4.87, 0.684],
        [3.822e-4, -0.905, 219.8, 0.777],
        Quantity::RattleSpace,
    ),
    (
        "two later contacts just part, and pulses of real tilt would overlap",
        [0.0695, 0.016_425, 0.7751, 0.6516, 1.434],
        [1.974e-4, -0.9795, 846.0, 0.5933],
        Quantity::PeakAcceleration,
    ),
    (
        "a contact turns the bar, and lever arms with it",
        [0.088_26, 0.030_67, 0.3865, 7.339, 14.246],
        [3.167e-4, 0.6507, 738.9, 0.0502],
        Quantity::VelocityShock,
    ),
    (
        "an end has parted and is still below the ground when the other strikes",
        [0.2, 0.096, 0.097, 5.613, 0.416],
        [2.17e-4, 0.0239, 262.0, 1.0646],
        Quantity::PeakAcceleration,
    ),
    (
        "the second strike cuts the peak off, and is delayed",
        [0.0882, 0.0254, 0.597, 1.5, 0.917],
        [7.58e-5, -0.679, 1925.0, 0.0746],
        Quantity::PeakAcceleration,
    ),
    (
        "a pulse ends after the top of a peak that stands at the shock",
        [0.2384, 0.1593, 0.404, 1.285, 8.61],
        [2.49e-4, 0.173, 1689.0, 0.5007],
        Quantity::PeakAcceleration,
    ),
    (
        "contacts carry the weight, which moves later strikes",
        [0.1936, 0.1267, 0.827, 0.937, 4.17],
        [7.08e-4, -0.534, 93.14, 0.8546],
        Quantity::PeakAcceleration,
    ),
    (
        "a pulse flattens the first peak below the next, where contacts overlap",
        [0.0722, 0.03334, 0.0204, 6.97, 0.237],
        [5.66e-5, -0.939, 391.0, 1.395],
        Quantity::PeakAcceleration,
    ),
    (
        "impacts follow one another at one instant, on a dashpot",
        [0.206_021_4, 0.033_844_95, 0.030_809_16, 0.452_345, 9.325_547],
        [5.314_298e-5, -0.915_098_1, 286.287_5, 0.655_576_9],
        Quantity::PeakAcceleration,
    ),
    (
        "the map has them one after the other",
        [0.125_306, 0.014_247_89, 0.010_958_12, 0.638_530_8, 1.950_523],
        [7.662_626e-5, -0.884_170_4, 159.213_3, 1.639_19],
        Quantity::PeakAcceleration,
    ),
    (
        "pulses overlap in the train of impacts alone",
        [0.080_035_57, 0.016_749_24, 0.768_584_6, 4.199_18, 1.181_047],
        [8.138_199e-5, 0.872_665, 851.883_4, 0.695_459_6],
        Quantity::PeakAcceleration,
    ),
    (
        "an end lies on a contact that has not done all",
        [0.191_905_3, 0.086_161_94, 0.010_707_05, 4.610_76, 0.136_276_3],
        [2.778_523e-4, -0.211_791_1, 405.659_4, 1.605_227],
        Quantity::VelocityShock,
    ),
    (
        "a contact that is pushed pushes back",
        [0.080_322_97, 0.025_200_96, 0.235_020_6, 6.507_128, 7.331_395],
        [4.266_093e-4, -0.339_581_5, 46.232_92, 0.632_569],
        Quantity::PeakAcceleration,
    ),
    (
        "what can come is little for a while, and more again",
        [0.202_476_4, 0.097_597_98, 0.776_103_4, 2.555_518, 0.420_907_1],
        [1.044_759e-4, 0.761_916_4, 49.567_15, 0.021_573_26],
        Quantity::RattleSpace,
    ),
    (
        "many shocks add up before the bar rests",
        [0.323_457_6, 0.165_597_9, 0.925_243_4, 1.679_904, 0.258_850_1],
        [1.912_254e-4, 0.241_953_8, 34.249_03, 0.005_512_234],
        Quantity::RattleSpace,
    ),
    (
        "the weight comes last",
        [0.269_162_6, 0.134_370_4, 0.182_624, 1.368_594, 0.121_821_9],
        [6.083_021e-5, 0.456_648_7, 91.654_13, 0.013_096_47],
        Quantity::RattleSpace,
    ),
    (
        "an end lies down for some time, while the component swings",
        [0.238_445_7, 0.155_901_7, 0.294_132_9, 2.459_169, 0.930_542_3],
        [1.193_48e-4, -0.928_265_7, 736.134_3, 0.001_069_466],
        Quantity::RattleSpace,
    ),
    (
        "parabolas have the third strike where the second is",
        [0.359_417_3, 0.122_875, 0.022_311_04, 4.021_834, 16.261_99],
        [5.613_145e-5, -0.083_905_14, 29_719.94, 0.663_831_6],
        Quantity::PeakAcceleration,
    ),
    (
        "the mean bend has it fall without a speed",
        [0.083_227_81, 0.052_253_98, 0.741_282_8, 4.759_853, 23.866_51],
        [1.845_034e-4, -0.694_618_9, 4_775.259, 1.159_283],
        Quantity::VelocityShock,
    ),
    (
        "far turns keep all of the energy",
        [0.268_488_5, 0.134_650_9, 0.896_137_6, 5.489_828, 1.177_428],
        [3.476_791e-4, 0.889_039, 96_645.12, 1.956_811],
        Quantity::VelocityShock,
    ),
    (
        "the fourth strike overlaps the third, with which a first look ends",
        [0.150_856_06, 0.035_320_11, 0.198_856_4, 3.328_328, 6.519_036],
        [2.703_635e-4, -0.805_987_2, 1_825.352, 1.084_062],
        Quantity::VelocityShock,
    ),
    (
        "the same, by more",
        [0.053_546_2, 0.013_932_52, 0.081_955_23, 1.317_248, 3.363_063],
        [1.024_774e-4, -0.108_793_8, 83_999.69, 1.904_634],
        Quantity::VelocityShock,
    ),
    (
        "the next pulse begins before the peak, and later for contacts that are delayed",
        [0.180_498_8, 0.057_554_15, 0.331_609, 3.496_429, 0.507_307_3],
        [1.117_814e-4, -0.737_818_4, 3_013.942, 0.235_159_4],
        Quantity::PeakAcceleration,
    ),
];

#[test]
fn estimates_know_what_bends_a_peak() {
    let mut wrong = Vec::new();
    for &(what, drop, part, quantity) in BENT {
        let setup = drop_of(drop, part);
        for tolerance in TOLERANCES {
            let looks = [FIRST_STRIKES, 3, STRIKES].map(|most| setup.plan_from(quantity, tolerance, most));
            for plan in looks.into_iter().chain([setup.forecast(quantity).plan(tolerance)]) {
                let error = off(&setup, plan.pair, quantity, plan.until_s);
                if plan.warning.is_some() || error > 1.5 * tolerance {
                    wrong.push(format!("{what}: {:?} off by {error:e}, {:?}", plan.pair, plan.warning));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A strong dashpot sees the force of a contact, not its impulse: taken for one, the peak so far was too high, and what
/// came later was left out, 4 % of the acceleration.
#[test]
fn a_strong_dashpot_is_followed_as_far_as_the_tolerance_asks() {
    let setup = drop_of(
        [0.062_605_38, 0.010_315_23, 0.598_546_6, 3.024_465, 0.375_962_6],
        [7.370_628e-5, 0.575_127_5, 2_027.599, 1.525_084],
    );
    for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace] {
        let truth = setup.demand_fine(Pair::HIGHEST, quantity, f64::INFINITY, 384).expect("as the test has it");
        for tolerance in TOLERANCES {
            let plan = setup.plan_from(quantity, tolerance, STRIKES);
            assert_eq!(plan.pair, Pair::HIGHEST, "{quantity:?}");
            let error = (plan.run(&setup).expect("as the test has it") / truth - 1.0).abs();
            assert!(error <= 0.1 * tolerance, "{quantity:?} within {tolerance}: {error:e}");
        }
    }
}

/// What strikes a bar that turns over about an end that lies is not foreseen, and neither estimates nor the bound of a
/// search count on it: this one turns by 51° when its end comes to lie, and fast enough to go over.
#[test]
fn a_bar_that_turns_over_about_an_end_is_left_open() {
    let setup = drop_of(
        [0.102_322_4, 0.060_076_75, 0.051_055_03, 7.543_365, 1.323_241],
        [2.108_509e-4, -0.381_200_5, 38.904_68, 0.002_397_897],
    );
    let pair = Pair { bar: BarRung::FiniteTilt, component: ComponentRung::ImpulseTrain };
    for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace] {
        let forecast = setup.forecast(quantity);
        let (estimate, error) = (forecast.pair(pair).error, off(&setup, pair, quantity, f64::INFINITY));
        assert!(error > 0.01 && estimate > error, "{quantity:?}: {estimate:e} {error:e}");
        let truth = setup.demand(Pair::HIGHEST, quantity, f64::INFINITY).expect("as the test has it");
        assert!(forecast.at_most() > truth, "{quantity:?}: {} {truth}", forecast.at_most());
        assert!(!setup.plan(quantity, 0.01).is_open(), "{quantity:?}");
    }
}

/// Where an error is allowed, strikes are left out that may raise the answer: seldom by more than a tolerance of 10 %, and
/// by less than 21 % then, as the docs have it of thirty times as many scenes; never by one of 5 %. Some are.
#[test]
fn strikes_left_out_count_by_no_more_than_stated() {
    let mut random = Random(29);
    let scenes = if cfg!(debug_assertions) { 60 } else { 600 };
    for (tolerance, most) in [(0.1, 0.21), (0.05, 0.05), (0.01, 0.01)] {
        let (mut all, mut beyond, mut some) = (0, 0, 0);
        for _ in 0..scenes {
            let setup = random.setup();
            for quantity in QUANTITIES {
                for pair in [Pair::HIGHEST, Pair { bar: BarRung::FiniteTilt, ..Pair::HIGHEST }] {
                    let pair = if quantity == Quantity::VelocityShock && pair != Pair::HIGHEST {
                        Pair { component: ComponentRung::LargestShock, ..pair }
                    } else {
                        pair
                    };
                    let plan = Plan { pair, until_s: f64::INFINITY, ..setup.plan(quantity, tolerance) };
                    // Some are refused by the model of contacts.
                    let Ok(short) = plan.run(&setup) else { continue };
                    let whole = setup.demand_fine(pair, quantity, f64::INFINITY, plan.pieces()).expect("as before");
                    let off = (short / whole - 1.0).abs();
                    assert!(off <= most, "{off} at {tolerance}: {pair:?} {quantity:?} {setup:?}");
                    all += 1;
                    beyond += i32::from(off > tolerance);
                    some += i32::from(off > 1e-6);
                }
            }
        }
        assert!(250 * beyond <= all && (tolerance < 0.1 || some > 0), "{tolerance}: {beyond}, {some} of {all}");
    }
}

/// A plan from no more strikes than it hangs on is that of all strikes but in two cases: it has a bound in place of
/// what later ones do, and chooses a cheaper pair (69 of 36 000), or it takes the highest where real tilt is off by the
/// strikes so far, which later ones mend (227). A first look leaves 8785 open, and has the same pair for all others.
#[test]
fn a_plan_needs_no_more_strikes_than_it_hangs_on() {
    let mut random = Random(11);
    let [mut all, mut open, mut cheaper, mut missed, mut moved] = [0; 5];
    for _ in 0..4000 {
        let setup = random.setup();
        for quantity in QUANTITIES {
            let forecast = setup.forecast(quantity);
            for tolerance in TOLERANCES {
                let (whole, plan) = (forecast.plan(tolerance), setup.plan_from(quantity, tolerance, STRIKES));
                let first = setup.plan(quantity, tolerance);
                let what = format!("{quantity:?} within {tolerance}: {first:?}, {plan:?}, {:?}, {setup:?}", whole.pair);
                all += 1;
                assert!(!plan.is_open(), "{what}");
                if plan.pair != whole.pair {
                    let highest = plan.pair == Pair::HIGHEST;
                    (missed, cheaper) = (missed + i32::from(highest), cheaper + i32::from(!highest));
                }
                if first.is_open() {
                    open += 1;
                    let serves = first.estimate.error <= tolerance;
                    assert!(serves || first.warning.is_some(), "{what}");
                    assert!(first.until_s == f64::INFINITY && first.forecast != plan.forecast, "{what}");
                } else {
                    moved += i32::from(first.pair != plan.pair);
                }
            }
        }
    }
    let counts = format!("of {all}: {cheaper} cheaper, {missed} missed, {open} open, {moved} moved");
    assert!(400 * cheaper < all && 100 * missed < all && moved == 0, "{counts}");
    assert!(10 * open > all && 3 * open < all, "{counts}");
}

/// No pair that is within the tolerance, with its pulses in pieces, is modeled as cheaper than the one chosen.
#[test]
fn the_cheapest_pair_that_serves_is_chosen() {
    let mut random = Random(17);
    let mut chosen = 0;
    for _ in 0..1000 {
        let setup = random.setup();
        for quantity in QUANTITIES {
            for forecast in [setup.forecast(quantity), setup.plan(quantity, 0.01).forecast] {
                for tolerance in TOLERANCES {
                    let plan = forecast.plan(tolerance);
                    let serving = Pair::planned(quantity).iter().filter(|pair| {
                        let pulses = pair.component == ComponentRung::PulseTrain;
                        forecast.pair(**pair).error <= if pulses { 0.9 } else { 1.0 } * tolerance
                    });
                    let least =
                        serving.map(|&pair| forecast.cost_ns(pair, plan.pieces())).fold(f64::INFINITY, f64::min);
                    assert!(plan.cost_ns() <= least, "{quantity:?} within {tolerance}: {plan:?} {setup:?}");
                    chosen += i32::from(plan.pair != Pair::HIGHEST);
                }
            }
        }
    }
    assert!(chosen > 1000, "{chosen}");
}

/// A velocity shock is one of the bar: whatever part is at its place, estimates of it are the same.
#[test]
fn estimates_of_velocity_shocks_know_no_part() {
    let mut random = Random(5);
    for _ in 0..500 {
        let setup = random.setup();
        let [mine, other] = [*setup.suspension(), *random.setup().suspension()].map(|part| {
            let setup = Setup::new(*setup.scene(), setup.contact_time_s(), setup.position(), part);
            setup.expect("as the test has it").forecast(Quantity::VelocityShock)
        });
        for rung in BarRung::ALL {
            let [mine, other] = [mine, other].map(|forecast| forecast.bar(rung));
            assert!(mine == other, "{rung:?}: {mine:?} {other:?} {setup:?}");
        }
    }
}

/// The cost model ranks pairs as they are, on the average over scenes.
#[test]
fn modeled_costs_have_the_ratios_of_measured_ones() {
    let (outcomes, _) = study(2, if cfg!(debug_assertions) { 10 } else { 100 });
    let cheap = Pair { bar: BarRung::Map, component: ComponentRung::ImpulseTrain };
    let ratio = |of: fn(&plan_study::Run) -> f64| -> f64 {
        let scenes = outcomes.iter().filter(|o| o.quantity == Quantity::RattleSpace);
        let logs: Vec<f64> = scenes.map(|o| (of(o.run(Pair::HIGHEST)) / of(o.run(cheap))).ln()).collect();
        (logs.iter().sum::<f64>() / f64::from(u32::try_from(logs.len()).expect("a few"))).exp()
    };
    let (modeled, measured) = (ratio(|r| r.with[1].modeled_ns), ratio(|r| r.with[1].seconds));
    // A debug build slows both alike, within this.
    assert!(modeled / measured < 5.0 && measured / modeled < 5.0, "modeled {modeled}, measured {measured}");
}

/// Parabolas, lever arms and delays go to nothing in proportion to their groups.
#[test]
fn estimates_fall_with_their_groups() {
    let of = |s: &Setup, rung| s.forecast(Quantity::PeakAcceleration).bar(rung).error;
    let order = |coarse: f64, fine: f64, factor: f64| (coarse / fine).ln() / factor.ln();
    // A bar that clatters to rest, so that nothing comes back; contacts too short to count.
    let gravity = |g| {
        let resting = Body::new(0.14, 0.0277).expect("as the test has it");
        let scene = Scene::new(resting, 0.1, 4.43, 0.01, g).expect("as the test has it");
        let part = Suspension::from_hz(1e6, DampingRatio::new(0.5).expect("as the test has it"));
        let part = part.expect("as the test has it");
        of(&Setup::new(scene, Some(1e-12), -0.9, part).expect("as the test has it"), BarRung::Map)
    };
    let o = order(gravity(98.1), gravity(9.81), 10.0);
    assert!((o - 1.0).abs() < 0.2, "gravity: order {o}");
    let tilt = |deg| setup(deg, 0.0, Some(1e-9), 200.0).forecast(Quantity::VelocityShock).bar(BarRung::Ballistic).error;
    let o = order(tilt(2.0), tilt(1.0), 2.0);
    assert!((o - 2.0).abs() < 0.2, "tilt: order {o}");
    let contact = |s| of(&setup(0.5, 0.0, Some(s), 200.0), BarRung::FiniteTilt);
    let o = order(contact(1e-7), contact(1e-8), 10.0);
    assert!((o - 1.0).abs() < 0.2, "contact: order {o}");
    let pulse =
        |s| setup(5.0, 9.81, Some(s), 200.0).forecast(Quantity::RattleSpace).component(ComponentRung::ImpulseTrain);
    let o = order(pulse(1e-4).error, pulse(1e-5).error, 10.0);
    assert!((o - 2.0).abs() < 0.2, "pulse: order {o}");
}

#[test]
fn a_plan_costs_less_where_less_is_asked() {
    let forecast = setup(5.0, 9.81, Some(2e-4), 150.0).forecast(Quantity::RattleSpace);
    let costs = [0.3, 0.1, 0.03, 0.01, 1e-3, 1e-5].map(|tolerance| forecast.plan(tolerance).cost_ns());
    assert!(costs.windows(2).all(|w| w[0] <= w[1]), "{costs:?}");
    assert!(costs[0] < costs[5], "{costs:?}");
    let pieces = [0.1, 0.01, 1e-3].map(|tolerance| forecast.plan(tolerance).pieces());
    assert!(pieces[0] < pieces[1] && pieces[1] < pieces[2], "{pieces:?}");
    assert_eq!(forecast.plan(1e-9).pair, Pair::HIGHEST);
    assert!(forecast.plan(1e-9).estimate.is_bound);
}

/// The pieces of pulses, of contacts and of lone ones, take a tenth of the tolerance: fewer than 1 in 100 random cases
/// take more, none all of it.
#[test]
fn pulses_are_cut_as_finely_as_the_tolerance_asks() {
    let parabolas = Pair { bar: BarRung::Ballistic, component: ComponentRung::PulseTrain };
    let mut random = Random(20_261_122);
    let (mut cases, mut beyond) = (0, 0);
    for _ in 0..100 {
        let setup = random.setup();
        for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace] {
            let forecast = setup.forecast(quantity);
            for pair in [Pair::HIGHEST, parabolas] {
                let Ok(fine) = setup.demand_fine(pair, quantity, forecast.until_s, 384) else { continue };
                for tolerance in TOLERANCES {
                    let pieces = forecast.plan(tolerance).pieces();
                    let cut = setup.demand_fine(pair, quantity, forecast.until_s, pieces).expect("as in fine pieces");
                    let off = (cut / fine - 1.0).abs();
                    assert!(off <= tolerance, "{setup:?}: {quantity:?} off by {off} in {pieces} pieces");
                    cases += 1;
                    beyond += usize::from(off > 0.1 * tolerance);
                }
            }
        }
    }
    assert!(cases > 1000 && 100 * beyond < cases, "{beyond} of {cases}");
}

/// What answers state of the pieces of contacts: 1 in 1000 is more than 1e-4 off. Of 1200 that is 1.2; more than 5 are
/// so in one draw of 700.
#[test]
fn answers_are_cut_as_finely_as_stated() {
    let mut random = Random(20_261_123);
    let (mut cases, mut beyond) = (0, 0);
    for _ in 0..600 {
        let setup = random.setup();
        for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace] {
            let Ok(fine) = setup.demand_fine(Pair::HIGHEST, quantity, f64::INFINITY, 384) else { continue };
            let cut = setup.demand_fine(Pair::HIGHEST, quantity, f64::INFINITY, 34).expect("as in fine pieces");
            cases += 1;
            beyond += usize::from((cut / fine - 1.0).abs() > 1e-4);
        }
    }
    assert!(cases > 1100 && beyond <= 5, "{beyond} of {cases}");
}

/// A plan does not name contacts where their model refuses the scene: light ends, thick bodies, long contacts, ends
/// that spin fast.
#[test]
fn contacts_are_planned_where_they_can_be_followed() {
    let mut random = Random(11);
    let mut log = |lo: f64, hi: f64| lo * (hi / lo).powf(random.unit());
    let mut counts = [0; 2];
    for k in 0..2000 {
        let body = Body::new(0.1, log(2e-3, 0.1)).expect("as the test has it");
        let body = if k % 5 == 0 { body.with_thickness(0.01).expect("as the test has it") } else { body };
        let scene = Scene::new(body, log(5e-3, 1.0), log(0.1, 7.0), log(0.01, 40.0), 9.81).expect("as the test has it");
        let spin = if k % 3 == 0 { log(0.1, 300.0) } else { 0.0 };
        let scene = scene.with_spin(spin).and_then(|scene| scene.with_impact_limit(1)).expect("as the test has it");
        let (part, contact) = (Suspension::from_hz(100.0, DampingRatio::new(0.1).expect("in range")), log(1e-5, 1e-1));
        let setup = Setup::new(scene, Some(contact), 0.3, part.expect("in range")).expect("as the test has it");
        let follows = scene.simulate_compliant(contact).is_ok();
        let planned = setup.forecast(Quantity::RattleSpace).pair(Pair::HIGHEST).error == 0.0;
        assert_eq!(planned, follows, "{setup:?}");
        counts[usize::from(follows)] += 1;
    }
    assert!(counts.iter().all(|&n| n > 200), "{counts:?}");
}

#[test]
fn an_unknown_contact_time_is_a_condition() {
    let unknown = setup(5.0, 9.81, None, 100.0);
    let plan = unknown.forecast(Quantity::PeakAcceleration).plan(0.05);
    assert_eq!(plan.pair.component, ComponentRung::ImpulseTrain, "{plan:?}");
    let Some(Warning::ContactTimeUnknown { longest_s }) = plan.warning else { panic!("{plan:?}") };
    assert!(longest_s > 1e-5 && longest_s < 1e-2, "{longest_s}");
    // Within the condition the plan holds.
    let known = setup(5.0, 9.81, Some(0.5 * longest_s), 100.0);
    let truth = known.demand_fine(Pair::HIGHEST, plan.quantity(), f64::INFINITY, 128).expect("as the test has it");
    let planned = plan.run(&unknown).expect("as the test has it");
    assert!((planned / truth - 1.0).abs() < 0.05, "{planned} {truth}");
    assert!(plan.warning.is_some_and(|w| w.to_string().contains("no contact time is known")));
    let refused = unknown.demand(Pair::HIGHEST, Quantity::PeakAcceleration, f64::INFINITY).unwrap_err().to_string();
    assert!(refused.contains("contact time"), "{refused}");
}

#[test]
fn overlapping_contacts_get_the_compliant_bar_or_a_warning() {
    let flat = setup(0.05, 9.81, Some(5e-4), 500.0);
    let plan = flat.forecast(Quantity::PeakAcceleration).plan(0.01);
    assert_eq!(plan.pair, Pair::HIGHEST);
    assert!(plan.warning.is_none() && plan.reason().to_string().contains("contacts overlap"), "{}", plan.reason());
    // e = 0 has no contact to model.
    let body = Body::new(0.14, 0.05).expect("as the test has it");
    let scene = Scene::new(body, 0.0, 4.43, 0.05, 9.81).expect("as the test has it");
    let part =
        Suspension::from_hz(500.0, DampingRatio::new(0.05).expect("as the test has it")).expect("as the test has it");
    let dead = Setup::new(scene, Some(5e-4), 0.2, part).expect("as the test has it");
    let plan = dead.forecast(Quantity::PeakAcceleration).plan(0.01);
    assert!(matches!(plan.warning, Some(Warning::ToleranceNotReached { .. })), "{plan:?}");
}

/// Whatever a scene may be: no panic, no NaN, a pair that runs or says why not.
#[test]
fn extremes_get_a_plan() {
    let mut runs = 0;
    for (length, gyration) in [(0.14, 0.04), (0.14, 0.0), (1e-30, 1e-30), (1e20, 1e21), (0.14, 1.0)] {
        for e in [0.0, 0.01, 0.5, 1.0] {
            for (speed, tilt, gravity) in
                [(4.43, 0.0, 9.81), (4.43, 5.0, 0.0), (1e-20, 89.0, 1e-30), (1e20, 1e-20, 9.81)]
            {
                let body = Body::new(length, gyration).expect("as the test has it");
                let scene = Scene::new(body, e, speed, tilt, gravity).expect("as the test has it");
                for (zeta, omega) in [(0.0, 1e-6), (1.0, 1e3), (50.0, 1e9)] {
                    let part = Suspension::new(omega, DampingRatio::new(zeta).expect("as the test has it"));
                    let part = part.expect("as the test has it");
                    for contact in [None, Some(1e-12), Some(1e-3), Some(1e3)] {
                        let setup = Setup::new(scene, contact, 1.0, part).expect("as the test has it");
                        for quantity in QUANTITIES {
                            let plan = setup.forecast(quantity).plan(0.01);
                            assert!(!plan.estimate.error.is_nan() && plan.cost_ns() > 0.0, "{setup:?} {plan:?}");
                            assert!(!plan.reason().to_string().is_empty());
                            runs += 1;
                        }
                    }
                }
            }
        }
    }
    assert_eq!(runs, 5 * 4 * 4 * 3 * 4 * 3);
}

/// Bodies lighter at their ends, and restitutions lower and higher, than contacts take: they lie down and land like
/// others.
#[test]
fn any_body_gets_a_plan() {
    let mut random = Random(9);
    let mut log = |lo: f64, hi: f64| lo * (hi / lo).powf(random.unit());
    for k in 0..4000 {
        let (gyration, e) = (log(1e-4, 0.3), if k % 2 == 0 { log(1e-4, 1.0) } else { 1.0 - log(1e-6, 0.3) });
        let drop = [0.1, gyration, e, log(0.1, 7.0), log(0.01, 40.0)];
        let setup = drop_of(drop, [log(1e-6, 1e-2), 0.7, log(10.0, 1e5), log(1e-3, 2.0)]);
        for quantity in QUANTITIES {
            for forecast in [setup.forecast(quantity), setup.plan(quantity, 0.01).forecast] {
                assert!(forecast.pair(Pair::planned(quantity)[0]).error >= 0.0, "{forecast:?} {setup:?}");
                assert!(forecast.peak >= 0.0 && forecast.until_s > 0.0, "{forecast:?} {setup:?}");
            }
        }
    }
}

#[test]
fn what_is_no_setup_is_refused_with_its_value() {
    let setup = Random(3).setup();
    let part =
        Suspension::from_hz(50.0, DampingRatio::new(0.1).expect("as the test has it")).expect("as the test has it");
    for (position, contact) in [(1.5, None), (f64::NAN, None), (0.0, Some(0.0)), (0.0, Some(f64::NAN))] {
        let text = Setup::new(*setup.scene(), contact, position, part).unwrap_err().to_string();
        let value = if contact.is_some() { contact.unwrap_or(0.0) } else { position };
        assert!(text.contains(&format!("{value:?}")), "{text}");
    }
}

/// A flat drop strikes everywhere at the first touch, where any model is good enough and need not be followed further.
#[test]
fn a_flat_drop_is_planned_and_run() {
    for contact_s in [None, Some(1e-4)] {
        let setup = setup(0.0, 9.81, contact_s, 10.0);
        for quantity in QUANTITIES {
            for tolerance in TOLERANCES {
                let plan = setup.forecast(quantity).plan(tolerance);
                let demand = plan.run(&setup).expect("as the test has it");
                assert!(demand > 0.0 && demand < f64::INFINITY, "{contact_s:?} {quantity:?} {tolerance}: {demand}");
            }
        }
    }
}

/// Both ends land within 1 % of one another: the slow one first, whose shock rings on when the fast one strikes. The
/// bend of its flight, of another time than that of the fast end, had it land after that: 0.45 % off where 0.04 % were
/// foreseen.
#[test]
fn two_ends_that_land_together_are_told_apart() {
    let setup = drop_of(
        [
            0.228_341_630_916_273_94,
            0.149_949_455_523_050_95,
            0.015_728_160_710_842_192,
            4.003_267_837_128_914,
            14.138_843,
        ],
        [5.880_439_458_170_122e-5, 0.646_784_797_035_285_4, 2_425.456_591_086_882, 0.835_646_038_496_948_3],
    );
    for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace] {
        let plan = setup.forecast(quantity).plan(0.001);
        assert!(off(&setup, plan.pair, quantity, plan.until_s) <= 0.001, "{quantity:?}: {:?}", plan.pair);
    }
}
