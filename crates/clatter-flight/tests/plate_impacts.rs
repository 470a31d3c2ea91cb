//! Plates by instant impacts with gravity: against a plain simulation of random ones, the map, the bar, contacts that take ever less time,
//! and laws that no impact may break.

use crate::plain::jumps::{Jump, Jumps};
use clatter_flight::{Contact, ContactLaw, Model, Plate, PlateMotion, PlateScene, Profile, Scene, Stop, Strike};
use proptest::prelude::*;

const G: f64 = 9.81;

prop_compose! {
    /// Plates of any mass, on any corner.
    fn scenes()(
        sides in [0.05..0.3_f64, 0.05..0.3_f64], middle in [0.2..0.8_f64, 0.2..0.8_f64], k in [0.1..0.8_f64, 0.1..0.8_f64],
        product in -0.9..0.9_f64, askew in any::<bool>(), speed in 0.2..4.0_f64, gaps in [0.0..0.02_f64, 0.0..0.02_f64],
        turn in [-1.0..1.0_f64, -1.0..1.0_f64], turns in any::<bool>(),
    ) -> PlateScene {
        let ([l, w], [x, y]) = (sides, middle);
        let gyration = [k[0] * l, k[1] * w];
        let plate = Plate::new([l * x, l * (1.0 - x), w * y, w * (1.0 - y)], gyration).expect("a plate");
        let product = if askew { product * gyration[0] * gyration[1] } else { 0.0 };
        let plate = plate.with_product_of_inertia(product).expect("a plate");
        let scene = PlateScene::new(plate, speed, gaps, G).expect("a drop");
        if !turns {
            return scene;
        }
        // Corner a keeps half of its speed.
        let spin = [0.25 * speed * turn[0] / (l * x), 0.25 * speed * turn[1] / (w * y)];
        scene.with_spin(spin).expect("corner a comes down")
    }
}

fn fly(scene: &PlateScene, e: f64) -> PlateMotion {
    scene.impacts_until(e, |_| false).expect("a motion")
}

/// Strikes are told apart by roundings below this share of the first speed.
const SMALL: f64 = 1e-6;

/// How many strikes of a drop agree with the plain simulation before roundings decide.
fn agreeing(scene: &PlateScene, e: f64) -> Result<usize, TestCaseError> {
    let motion = fly(scene, e);
    let (mut plain, speed) = (Jumps::new(scene, e), scene.speed_m_s());
    let small = |approach: f64| approach.abs() < SMALL * speed;
    let mut strikes = motion.strikes.iter().filter(|strike| !small(strike.approach_m_s)).peekable();
    let mut agreed = 0;
    for _ in 0..400 {
        let Some(jump) = plain.next(2e-4, 20_000) else { break };
        if jump.close || agreed == 25 {
            break;
        }
        if small(jump.approach) {
            continue;
        }
        let Some(strike) = strikes.next() else { return Err(TestCaseError::fail(format!("no strike for {jump:?}"))) };
        if small(0.9 * jump.approach) {
            // Whether it is small roundings tell.
            break;
        }
        hold(strike, &jump, speed)?;
        agreed += 1;
    }
    Ok(agreed)
}

fn hold(strike: &Strike<4>, jump: &Jump, speed: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(strike.point, jump.corner, "{:?} {:?}", strike, jump);
    let off = strike.delta_v_m_s.iter().zip(jump.delta_v).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    prop_assert!(off < 1e-4 * speed, "off by {:e}: {:?} {:?}", off, strike, jump);
    prop_assert!((strike.time_s - jump.time).abs() < 1e-4 * speed / G, "{:?} {:?}", strike, jump);
    Ok(())
}

/// Twice the kinetic energy per mass and that of height, by the slopes and the middle of the center of mass.
fn energy(scene: &PlateScene, strike: &Strike<4>) -> f64 {
    let plate = scene.plate();
    let ([length, width], [left, _, front, _]) = (plate.sides_m(), plate.edges_m());
    let of = |[a, b, _, d]: [f64; 4]| {
        let [x, y] = [(b - a) / length, (d - a) / width];
        [a + left * x + front * y, x, y]
    };
    let ([v, x, y], [height, ..]) = (of(strike.velocity_m_s), of(strike.height_m));
    let ([kx, ky], c) = (plate.gyration_m(), plate.product_of_inertia_m2());
    v * v + (kx * x).powi(2) + (ky * y).powi(2) + 2.0 * c * x * y + 2.0 * scene.gravity_m_s2() * height
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// Strike by strike a plate does what small time steps of Newton's laws tell.
    #[test]
    fn random_plates_agree_with_small_steps(scene in scenes(), e in 0.0..0.95_f64) {
        agreeing(&scene, e)?;
    }

    /// With next to no gravity, and with none, a plate has the train of the map.
    #[test]
    fn without_gravity_it_is_the_map(scene in scenes(), e in prop_oneof![0.0..0.1_f64, 0.0..=1.0_f64], flat in any::<bool>()) {
        let (plate, spin) = (scene.plate(), scene.spin_rad_s());
        let ([left, right, front, back], [kx, ky]) = (plate.edges_m(), plate.gyration_m());
        let ([x, y], gaps) = ([0.5 * (left + right), 0.5 * (front + back)], if flat { [0.0; 2] } else { scene.gaps_m() });
        let even = Plate::new([left, right, front, back], [kx, ky]).expect("a plate");
        let center = [(left - right) / (2.0 * x), (front - back) / (2.0 * y)];
        let map = clatter::Plate::off_center([kx / x, ky / y], center, e).expect("a plate");
        for gravity in [0.0, 1e-40] {
            let drop = PlateScene::new(even, scene.speed_m_s(), gaps, gravity).and_then(|drop| drop.with_spin(spin)).expect("a drop");
            let [a, b, _, d] = drop.corner_velocities();
            let motion = fly(&drop.with_impact_limit(100), e);
            let start = clatter::PlateStart::new([a, b, d], gaps).expect("a start");
            let train: Vec<_> = map.train(&start).take(100).collect();
            // What comes later roundings may put in another order.
            let told = train.iter().take_while(|impact| -impact.approach > 1e-3 * scene.speed_m_s()).take(30);
            for (k, impact) in told.enumerate() {
                prop_assert!(k < motion.strikes.len(), "strike {} of {}", k, train.len());
                let strike = &motion.strikes[k];
                prop_assert_eq!(strike.point, impact.corner as usize, "strike {}: {:?} {:?}", k, strike, impact);
                let off = (0..4).map(|i| (strike.delta_v_m_s[i] - impact.delta_v[i]).abs()).fold(0.0, f64::max);
                prop_assert!(off < 1e-11 * scene.speed_m_s(), "strike {}: off by {:e}", k, off);
                let late = (strike.time_s - impact.time).abs();
                prop_assert!(late <= 1e-9 * impact.time.max((gaps[0] + gaps[1]) / scene.speed_m_s()), "strike {}: {:e}", k, late);
            }
        }
    }

    /// No strike and no flight gives energy, elastic ones keep it; and until rest the ground has taken the momentum of the fall, felt
    /// strike by strike at the center of mass and at a corner alike.
    #[test]
    fn energy_and_momentum_are_those_of_newton(scene in scenes(), e in prop_oneof![Just(0.0), 0.0..0.5_f64, Just(1.0)]) {
        let motion = fly(&scene.with_impact_limit(if e < 1.0 { 100_000 } else { 2000 }), e);
        let mut last = f64::INFINITY;
        for strike in &motion.strikes {
            let now = energy(&scene, strike);
            prop_assert!(now <= last * (1.0 + 1e-13) + 1e-15, "{now} after {last}: {strike:?}");
            last = now;
        }
        // Between two strikes the body is sampled from the one to the other.
        for two in motion.strikes.windows(2).take(30).filter(|two| two[1].time_s > two[0].time_s) {
            let [after, before] = [two[0].time_s, two[1].time_s.next_down()].map(|time_s| motion.sample(time_s).expect("a plate").velocity_m_s);
            for i in 0..4 {
                let off = [after[i] - two[0].velocity_m_s[i], before[i] + two[1].delta_v_m_s[i] - two[1].velocity_m_s[i]];
                prop_assert!(off.iter().all(|v| v.abs() < 1e-12 * scene.speed_m_s().max(1.0)), "{off:?} between {two:?}");
            }
        }
        if e < 1.0 {
            prop_assert!(matches!(motion.stop, Stop::AtRest { shock_bound_m_s, .. } if shock_bound_m_s <= f64::EPSILON * motion.largest_m_s()), "{:?}", motion.stop);
            let end = motion.stop.time_s();
            for (place, speed) in [([0.0; 2], scene.speed_m_s()), (scene.plate().corners_m()[2], -scene.corner_velocities()[2])] {
                let gained: f64 = motion.felt(place).sections().map(|section| section.velocity_after(section.length)).sum();
                prop_assert!((gained - speed - G * end).abs() < 1e-12 * (speed.abs() + G * end) + 1e-12, "{gained} of {}", speed + G * end);
            }
        } else {
            let first = energy(&scene, &motion.strikes[0]);
            prop_assert!((last / first - 1.0).abs() < 1e-11, "{last} of {first}");
            prop_assert!(matches!(motion.stop, Stop::ImpactLimit { .. }), "{:?}", motion.stop);
        }
    }

    /// Nothing that comes after a motion is left changes a velocity by more than is told; and what is told as the motion is asked.
    #[test]
    fn later_strikes_stay_below_what_is_told(scene in scenes(), e in 0.0..=1.0_f64, share in 0.0..1.0_f64) {
        let whole = fly(&scene.with_impact_limit(400), e);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a share of some strikes")]
        let left = 1 + (share * (whole.strikes.len() - 1) as f64) as usize;
        let motion = scene.impacts_until(e, |ahead| ahead.struck.iter().sum::<usize>() == left).expect("a motion");
        prop_assert_eq!(&motion.strikes[..], &whole.strikes[..left]);
        let later = whole.strikes[left..].iter().flat_map(|strike| strike.delta_v_m_s).fold(0.0, |most: f64, v| most.max(v.abs()));
        prop_assert!(later <= motion.later_m_s * (1.0 + 1e-12), "{later} of {}", motion.later_m_s);
    }

    /// Contacts that take ever less time tend to it, as long as their touches lie apart: what is off shrinks with the contact time.
    #[test]
    fn short_contacts_tend_to_it(scene in scenes(), e in 0.2..0.9_f64) {
        let motion = fly(&scene.with_impact_limit(6), e);
        let length = scene.plate().sides_m().into_iter().fold(0.0, f64::max);
        let time = 1e-5 * length / scene.speed_m_s();
        let apart = |of: &[Strike<4>]| of.windows(2).take_while(|two| two[1].time_s - two[0].time_s > 100.0 * time).count();
        let many = apart(&motion.strikes);
        let off = |time_s: f64| {
            let contact = Contact::new(ContactLaw::Hysteretic, e, time_s).expect("a contact");
            let many_s = motion.strikes[many].time_s + 50.0 * time;
            let pressed = scene.with_time_limit_s(many_s).expect("a limit").contacts_until(&contact, 1e-8, |_| false).expect("a motion");
            let pairs = pressed.strikes.iter().zip(&motion.strikes).take(many);
            let alike = pairs.clone().all(|(a, b)| a.point == b.point) && pressed.strikes.len() >= many;
            let off = pairs.flat_map(|(a, b)| a.delta_v_m_s.into_iter().zip(b.delta_v_m_s)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (alike, off / scene.speed_m_s())
        };
        let [(_, coarse), (alike, fine)] = [time, 0.1 * time].map(off);
        // Else a corner that is hardly off the ground touches meanwhile.
        prop_assume!(coarse < 1e-2);
        prop_assert!(alike && fine <= 0.2 * coarse + 1e-6, "{many} strikes: {coarse:e}, then {fine:e}");
    }
}

/// A plate that can turn along its length alone is the bar: both corners of an edge move as one, whichever of them strikes.
#[test]
fn a_plate_that_turns_one_way_is_the_bar() {
    for (left, gyration, e, tilt, gravity) in
        [(0.07, 0.04, 0.5, 3.0, G), (0.05, 0.06, 0.3, 5.0, G), (0.09, 0.03, 0.0, 1.0, 30.0), (0.07, 0.2, 0.8, 2.0, 1.0)]
    {
        let body = Profile::off_center(left, 0.14 - left, gyration).expect("a body");
        let bar = Scene::new(body, e, 2.0, tilt, gravity).expect("a drop");
        let gap = bar.height_gap_m();
        // A radius of gyration a million times the width: its turns across are a part in 10¹² of those along.
        let plate = Plate::new([left, 0.14 - left, 0.03, 0.03], [gyration, 6e4]).expect("a plate");
        let bar = bar.fly(Model::Ballistic).expect("a motion");
        let motion = fly(&PlateScene::new(plate, 2.0, [gap, 0.0], gravity).expect("a drop"), e);
        // What is off, a part in 10¹² at first, grows from strike to strike.
        let told = |strike: &f64| *strike < -1e-5;
        let bar: Vec<_> = bar.strikes.iter().filter(|strike| told(&strike.approach_m_s)).take(60).collect();
        let plate: Vec<_> = motion.strikes.iter().filter(|strike| told(&strike.approach_m_s)).take(60).collect();
        assert_eq!(bar.len(), plate.len(), "{left}");
        for (one, two) in bar.iter().zip(&plate) {
            assert_eq!(one.point, [0, 1, 1, 0][two.point], "{one:?} {two:?}");
            let ends = [[0, 3], [1, 2]];
            let off = (0..2).flat_map(|i| ends[i].map(|k| (two.delta_v_m_s[k] - one.delta_v_m_s[i]).abs()));
            assert!(off.fold(0.0, f64::max) < 1e-8, "{one:?} {two:?}");
            assert!((one.time_s - two.time_s).abs() < 1e-9, "{one:?} {two:?}");
        }
    }
}

/// A square that falls along its diagonal is the bar between a and c, until b and d come down.
#[test]
fn a_square_along_its_diagonal_is_the_bar() {
    let (half, gyration, gap) = (0.05, 0.03, 4e-3);
    let reach = half * 2.0_f64.sqrt();
    let tilt = (2.0 * gap / (2.0 * reach)).asin().to_degrees();
    for e in [0.2, 0.5, 0.9] {
        let bar = Scene::new(Profile::new(2.0 * reach, gyration).expect("a body"), e, 1.5, tilt, G).expect("a drop");
        let bar = bar.fly(Model::Ballistic).expect("a motion");
        let scene = PlateScene::new(Plate::new([half; 4], [gyration; 2]).expect("a plate"), 1.5, [gap; 2], G);
        let motion = fly(&scene.expect("a drop"), e);
        let along = motion.strikes.iter().take(30).take_while(|strike| strike.point % 2 == 0).count();
        assert!(along >= 2, "{along}");
        for (one, two) in bar.strikes.iter().zip(&motion.strikes[..along]) {
            assert_eq!(2 * one.point, two.point, "{one:?} {two:?}");
            let off = (0..2).map(|i| (two.delta_v_m_s[2 * i] - one.delta_v_m_s[i]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-12 && (one.time_s - two.time_s).abs() < 1e-12, "{one:?} {two:?}");
        }
    }
}

/// A plate of any proportions and any drop has an answer of finite numbers, in time that a limit of strikes bounds.
#[test]
fn every_corner_gives_an_answer() {
    let mut drops = 0;
    for (length, width) in [(0.14, 0.07), (1e6, 1.0), (1e-24, 1e-24), (1e29, 1e23)] {
        for gyration in [[2e-12, 2e-12], [0.3, 0.3], [9e5, 9e5], [2e-12, 9e5]] {
            for middle in [0.5, 1e-6, 0.1] {
                for (e, gravity) in
                    [0.0, 1e-300, 0.5, 0.999, 1.0].into_iter().flat_map(|e| [0.0, 1e-60, G, 1e30].map(|g| (e, g)))
                {
                    for (tilt, speed) in [[0.0; 2], [1e-3, 0.0], [0.0, 1e-3], [1e-9, 1e-2], [1.0, 1.0]]
                        .into_iter()
                        .flat_map(|t| [1e-30, 3.0, 1e30].map(|v| (t, v)))
                    {
                        let edges = [length * middle, length * (1.0 - middle), width * 0.5, width * 0.5];
                        let plate = Plate::new(edges, [gyration[0] * length, gyration[1] * width]).expect("a plate");
                        let scene = PlateScene::new(plate, speed, [tilt[0] * length, tilt[1] * width], gravity)
                            .expect("a drop");
                        let motion = fly(&scene.with_impact_limit(150), e);
                        let said = || format!("{scene:?} e {e}");
                        let mut last = 0.0;
                        for s in &motion.strikes {
                            let numbers = [s.delta_v_m_s, s.height_m, s.velocity_m_s].concat();
                            assert!(numbers.iter().all(|x| x.is_finite()) && s.approach_m_s < 0.0, "{}: {s:?}", said());
                            assert!(s.time_s >= last && s.height_m.iter().all(|h| *h >= 0.0), "{}: {s:?}", said());
                            last = s.time_s;
                        }
                        assert!(
                            motion.stop.time_s() >= last && motion.later_m_s >= 0.0,
                            "{}: {:?}",
                            said(),
                            motion.stop
                        );
                        let now = motion.sample(motion.stop.time_s()).expect("a plate");
                        assert!(now.velocity_m_s.iter().all(|v| v.is_finite()), "{}: {now:?}", said());
                        drops += 1;
                    }
                }
            }
        }
    }
    assert_eq!(drops, 14_400);
}
