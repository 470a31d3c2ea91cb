//! Plates with contacts that take time: against drops that were integrated elsewhere from the laws and Newton's alone
//! (`data/contact-plate.json` hysteretic, `data/plate-contact.json` dashpots), against a plain integration of random ones, and by laws
//! that no contact may break.

use crate::plain::Part;
use crate::plain::plate::{Drop, PlainPlate};
use clatter::{Excitation, Section};
use clatter_flight::{Contact, ContactLaw, Model, Plate, PlateMotion, PlateScene, Profile, Scene, Stop, Strike};
use proptest::prelude::*;
use serde_json::Value;

const G: f64 = 9.80665;

fn number(of: &Value, name: &str) -> f64 {
    of[name].as_f64().unwrap_or_else(|| panic!("no number {name}"))
}

fn numbers<const N: usize>(of: &Value, name: &str) -> [f64; N] {
    std::array::from_fn(|i| of[name][i].as_f64().unwrap_or_else(|| panic!("no numbers {name}")))
}

/// Each case of a file.
fn cases(law: ContactLaw) -> Vec<(Value, Drop)> {
    let file = match law {
        ContactLaw::Hysteretic => include_str!("data/contact-plate.json"),
        ContactLaw::Dashpot => include_str!("data/plate-contact.json"),
    };
    let file: Value = serde_json::from_str(file).expect("the file of the drops");
    let drop = |case: &Value| Drop {
        edges: numbers(case, "reach_m"),
        gyration: numbers(case, "gyration_m"),
        gaps: numbers(case, "gaps_m"),
        spin: [0.0; 2],
        speed: number(case, "speed_m_s"),
        gravity: number(case, "gravity_m_s2"),
        law,
        e: number(case, "e"),
        time: number(case, "contact_time_s"),
    };
    file["cases"].as_array().expect("cases").iter().map(|case| (case.clone(), drop(case))).collect()
}

fn scene(drop: &Drop) -> PlateScene {
    let plate = Plate::new(drop.edges, drop.gyration).expect("a plate");
    let scene = PlateScene::new(plate, drop.speed, drop.gaps, drop.gravity).expect("a drop");
    scene.with_spin(drop.spin).expect("corner a comes down")
}

fn contact(drop: &Drop) -> Contact {
    Contact::new(drop.law, drop.e, drop.time).expect("a contact")
}

fn until(drop: &Drop, time_s: f64) -> PlateMotion {
    let scene = scene(drop).with_time_limit_s(time_s).expect("a limit");
    scene.contacts_until(&contact(drop), 1e-4, |_| false).expect("a flight")
}

/// Touches that graze are told apart by roundings alone.
fn grazes(approach: f64, drop: &Drop) -> bool {
    approach.abs() < 1e-3 * drop.speed
}

#[test]
fn drops_that_were_integrated_elsewhere_agree() {
    for law in ContactLaw::ALL {
        let (mut touches, mut states) = (0.0_f64, 0.0_f64);
        for (n, (case, drop)) in cases(law).into_iter().enumerate() {
            let flight = until(&drop, number(&case, "until_s"));
            let all = case["touches"].as_array().expect("touches");
            let want: Vec<_> = all.iter().filter(|touch| !grazes(number(touch, "approach_m_s"), &drop)).collect();
            let got: Vec<_> = flight.strikes.iter().filter(|s| !grazes(s.approach_m_s, &drop)).collect();
            assert!(got.len() >= want.len().min(6), "{law:?} {n}: {} touches, not {}", got.len(), want.len());
            for (k, (strike, want)) in got.iter().zip(want).take(6).enumerate() {
                assert_eq!(["a", "b", "c", "d"][strike.point], want["corner"], "{law:?} {n}, touch {k}");
                let (time, approach) = (number(want, "time_s"), number(want, "approach_m_s"));
                touches = touches.max((strike.time_s - time).abs() / time.max(drop.time));
                touches = touches.max((strike.approach_m_s - approach).abs() / drop.speed);
            }
            // Grazing touches multiply what the integration of the file gets wrong.
            if all.len() <= 9 {
                let now = flight.sample(number(&case, "until_s")).expect("contacts");
                let velocity: [f64; 4] = numbers(&case, "velocity_m_s");
                let off = (0..4).map(|i| (now.velocity_m_s[i] - velocity[i]).abs() / drop.speed).fold(0.0, f64::max);
                states = states.max(off);
            }
        }
        // Touches are told to some 1e-5 where they all but graze.
        assert!(touches < 2e-5 && states < 1e-10, "{law:?}: touches {touches:e}, states {states:e}");
    }
}

/// A part as z″ + 2ζω z′ + ω² z = −a, by Runge and Kutta's fourth order through what a place feels: ω times the largest
/// displacement, and the largest acceleration of spring and damper over ω.
fn peaks(felt: &Excitation, (omega, zeta, until): (f64, f64, f64)) -> [f64; 2] {
    let (mut z, mut v, mut peaks) = (0.0_f64, 0.0_f64, [0.0_f64; 2]);
    for section in felt.sections().filter(|section| section.from <= until) {
        v -= section.delta_v;
        let fastest = section.sines.iter().fold(omega, |most, sine| most.max(sine.rate));
        let length = section.length.min(until - section.from);
        let steps = (length * fastest * 100.0).ceil().max(1.0);
        let h = length / steps;
        let rate =
            |t: f64, [z, v]: [f64; 2]| [v, -section.acceleration_at(t) - 2.0 * zeta * omega * v - omega * omega * z];
        let mut t = 0.0;
        while t < length - 0.5 * h {
            let at = |k: [f64; 2], h: f64| [z + h * k[0], v + h * k[1]];
            let a = rate(t, [z, v]);
            let b = rate(t + 0.5 * h, at(a, 0.5 * h));
            let c = rate(t + 0.5 * h, at(b, 0.5 * h));
            let d = rate(t + h, at(c, h));
            z += h / 6.0 * (a[0] + 2.0 * (b[0] + c[0]) + d[0]);
            v += h / 6.0 * (a[1] + 2.0 * (b[1] + c[1]) + d[1]);
            t += h;
            peaks[0] = peaks[0].max(omega * z.abs());
            peaks[1] = peaks[1].max((2.0 * zeta * v + omega * z).abs());
        }
    }
    peaks
}

/// The peaks of the files are the largest of their steps in time, and so up to 3e-3 low.
#[test]
fn a_part_feels_the_same() {
    for law in ContactLaw::ALL {
        for (n, (case, drop)) in cases(law).into_iter().enumerate() {
            let (part, until_s) = (&case["part"], number(&case, "until_s"));
            let (place, omega, zeta) = (numbers(part, "at_m"), number(part, "omega_rad_s"), number(part, "damping"));
            let flight = until(&drop, until_s);
            let mut felt = flight.felt(place);
            if let Stop::AtRest { time_s, .. } = flight.stop {
                // At rest it carries its weight.
                felt.push(Section { acceleration: [drop.gravity; 2], ..Section::shock(time_s, until_s, 0.0) });
            }
            let got = peaks(&felt, (omega, zeta, until_s));
            let mut plain = PlainPlate::new(&drop);
            plain.part = Some(Part { place, omega, zeta, z: 0.0, v: 0.0, peaks: [0.0; 2] });
            assert!(plain.run(until_s, 10_000_000), "{law:?} {n}");
            let fine = plain.part.expect("a part").peaks;
            let names = ["omega_peak_displacement", "peak_acceleration_over_omega"];
            for (k, name) in names.into_iter().enumerate() {
                let want = number(part, name);
                let (off, of_fine) = ((got[k] - want) / want, (got[k] - fine[k]) / fine[k]);
                assert!((-2e-4..3e-3).contains(&off), "{law:?} {n}: {name} {} {want}", got[k]);
                assert!(of_fine.abs() < 2e-4, "{law:?} {n}: {name} {} {}", got[k], fine[k]);
            }
        }
    }
}

/// Plates of any inertia that a product has, off center or not, tilted in any direction, also along an edge or the diagonal.
fn any_drop(e: impl Strategy<Value = f64>) -> impl Strategy<Value = Drop> {
    let off = || prop_oneof![Just(0.0), -0.4..0.4_f64];
    let gap = || prop_oneof![Just(0.0), (-6.0..-1.2_f64).prop_map(|x| 10f64.powf(x)), 0.01..0.1_f64];
    let gaps = prop_oneof![(gap(), gap()), gap().prop_map(|gap| (gap, gap))];
    // Over what takes away half of the approach of corner a.
    let turn = || prop_oneof![Just(0.0), -0.95..2.0_f64];
    let size = (0.025..0.14_f64, prop_oneof![Just(1.0), 0.2..2.0_f64], off(), off());
    let inertia = (0.35..1.2_f64, 0.35..1.2_f64);
    let law = prop::sample::select(&ContactLaw::ALL[..]);
    (size, inertia, gaps, (turn(), turn()), law, e, 0.5..5.0_f64, 1e-4..1.5e-3_f64).prop_map(
        |((half, aspect, off_x, off_y), (kx, ky), (hx, hy), (tx, ty), law, e, speed, time)| {
            let (a, b) = (half, half * aspect);
            let edges = [a * (1.0 + off_x), a * (1.0 - off_x), b * (1.0 + off_y), b * (1.0 - off_y)];
            let spin = [0.5 * tx * speed / edges[0], 0.5 * ty * speed / edges[2]];
            let reach = edges[0].max(edges[1]).hypot(edges[2].max(edges[3]));
            Drop {
                edges,
                spin,
                gyration: [kx * a, ky * b],
                gaps: [hx * 2.0 * a, hy * 2.0 * b],
                speed,
                gravity: G,
                law,
                e,
                time: time.min(0.19 * 2.0 * a.max(b) / (speed + reach * spin[0].hypot(spin[1]))),
            }
        },
    )
}

impl std::fmt::Debug for Drop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { edges, gyration, gaps, spin, speed, law, e, time, .. } = self;
        write!(f, "{edges:?} {gyration:?} {gaps:?} {spin:?} {speed} m/s {law:?} e={e} {time} s")
    }
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(600))]

    /// A random plate over six contact times and what its corners need to come down, until it rests, a corner lies, or touches so slowly that its
    /// weight does as much: from there on it chatters in its dent, and where it is in that decides when another one comes down.
    #[test]
    fn random_plates_move_as_newton_has_it(drop in any_drop(0.05..=1.0_f64)) {
        let until_s = 6.0 * drop.time + 2.0 * (drop.gaps[0] + drop.gaps[1]) / drop.speed;
        let flight = until(&drop, until_s);
        let slow = |strike: &&Strike<4>| strike.approach_m_s.abs() < SLOW * G * drop.time;
        let until_s = flight.strikes.iter().find(slow).map_or(until_s, |strike| until_s.min(strike.time_s));
        let until_s = 0.999 * until_s.min(first_lies(&flight)).min(flight.stop.time_s());
        let run = |faster: f64| {
            let mut plain = PlainPlate::new(&Drop { speed: drop.speed * (1.0 + faster), ..drop });
            prop_assume!(plain.run(until_s, 3_000_000)); // else it chatters without end
            Ok(plain)
        };
        // What the drop multiplies a small change by: where that is much, corners all but miss the ground or one another.
        let (plain, shaken) = (run(0.0)?, run(1e-7)?);
        let fast = |a: [f64; 4], b: [f64; 4]| (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) / drop.speed;
        let times = (fast(plain.velocities(), shaken.velocities()) / 1e-7).max(1.0);
        let now = flight.sample(until_s).expect("contacts");
        let off = fast(now.velocity_m_s, plain.velocities());
        prop_assert!(times > 1e3 || off < 1e-8 * times, "{off:e}, {times}-fold of {drop:?}");
        let high = (0..4).map(|i| (now.height_m[i] - plain.heights()[i]).abs()).fold(0.0, f64::max);
        prop_assert!(times > 1e3 || high <= 1e-8 * times * drop.speed * until_s, "{high:e}, {times}-fold of {drop:?}");
    }
}

/// A touch is slow below so many times what its weight does to a corner in a contact time.
const SLOW: f64 = 4.0;

/// When a corner is laid down first.
fn first_lies(flight: &PlateMotion) -> f64 {
    let lies = |t: &f64| {
        let now = flight.sample(*t).expect("contacts");
        (0..4).any(|i| now.force_per_mass_m_s2[i] > 0.0 && now.acceleration_m_s2[i] == 0.0)
    };
    flight.phases_s().find(lies).unwrap_or(f64::INFINITY)
}

/// Velocity of the center of mass and the rates of both slopes.
fn motion(plate: &Plate, velocity: [f64; 4]) -> [f64; 3] {
    let ([a, b, _, d], [length, width], [left, _, front, _]) = (velocity, plate.sides_m(), plate.edges_m());
    let [x, y] = [(b - a) / length, (d - a) / width];
    [a + left * x + front * y, x, y]
}

fn energy(drop: &Drop, height: [f64; 4], velocity: [f64; 4]) -> f64 {
    let plate = scene(drop).plate();
    let ([v, x, y], [kx, ky]) = (motion(&plate, velocity), drop.gyration);
    let [height, ..] = motion(&plate, height);
    0.5 * (v * v + (kx * x).powi(2) + (ky * y).powi(2)) + drop.gravity * height
}

fn any_e() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0_f64, 0.0..0.1_f64]
}

proptest! {
    #![proptest_config(config(500))]

    /// Every press is an impulse at its corner: it changes both angular momenta by its lever arms. While nothing presses there is no
    /// more energy than before, and a flight ends.
    #[test]
    fn momenta_add_up_and_energy_never_grows(drop in any_drop(any_e())) {
        // What loses little goes on; what loses more may chatter for thousands of touches before it rests.
        let most = if drop.e > 0.9 { 200 } else { 20_000 };
        let flight = scene(&drop).with_impact_limit(most).contacts_until(&contact(&drop), 1e-4, |_| false).expect("a flight");
        prop_assert!(matches!(flight.stop, Stop::AtRest { .. }) || drop.e > 0.9, "{:?} {drop:?}", flight.stop);
        // Some 1e-13 a strike.
        prop_assert!(flight.energy_error < 1e-8, "{:e} {drop:?}", flight.energy_error);
        let plate = scene(&drop).plate();
        let [kx, ky] = drop.gyration;
        for strike in &flight.strikes {
            let ([v, x, y], at) = (motion(&plate, strike.delta_v_m_s), plate.corners_m()[strike.point]);
            let off = (kx * kx * x - at[0] * v).abs().max((ky * ky * y - at[1] * v).abs());
            let size = drop.speed * (drop.edges[0] + drop.edges[1] + drop.edges[2] + drop.edges[3]);
            prop_assert!(off <= 1e-12 * size, "{off:e} {strike:?} {drop:?}");
        }
        let begins = plate.corners_m().map(|[x, y]| x * drop.spin[0] + y * drop.spin[1] - drop.speed);
        let mut held = energy(&drop, [0.0, drop.gaps[0], drop.gaps[0] + drop.gaps[1], drop.gaps[1]], begins);
        let first = held;
        for (k, t) in flight.phases_s().enumerate() {
            let now = flight.sample(t).expect("contacts");
            // Springs of dashpots that have parted below the ground still hold what they give back.
            let holds = drop.law == ContactLaw::Dashpot && now.height_m.iter().any(|h| *h < 0.0);
            if !holds && now.force_per_mass_m_s2.iter().all(|force| *force == 0.0) {
                let now = energy(&drop, now.height_m, now.velocity_m_s);
                prop_assert!(now <= held + 1e-9 * first, "phase {k}: {now} after {held} {drop:?}");
                held = now;
            }
        }
    }

    /// Masses askew couple both slopes: a press changes the angular momenta k_x² x + c y and c x + k_y² y by its lever arms, in phases that
    /// keep the energy.
    #[test]
    fn momenta_add_up_with_masses_askew(drop in any_drop(any_e()), askew in -0.8..0.8_f64) {
        let ([kx, ky], plain) = (drop.gyration, scene(&drop).plate());
        let c = askew * kx * ky;
        let plate = plain.with_product_of_inertia(c).expect("a plate");
        let scene = PlateScene::new(plate, drop.speed, drop.gaps, drop.gravity).expect("a drop").with_impact_limit(500);
        let scene = scene.with_spin(drop.spin).expect("corner a comes down");
        let flight = scene.contacts_until(&contact(&drop), 1e-4, |_| false).expect("a flight");
        prop_assert!(flight.energy_error < 1e-8, "{:e} {askew} {drop:?}", flight.energy_error);
        for strike in &flight.strikes {
            let ([v, x, y], at) = (motion(&plate, strike.delta_v_m_s), plate.corners_m()[strike.point]);
            let off = (kx * kx * x + c * y - at[0] * v).abs().max((ky * ky * y + c * x - at[1] * v).abs());
            let size = drop.speed * drop.edges.iter().sum::<f64>();
            prop_assert!(off <= 1e-11 * size, "{off:e} {strike:?} {askew} {drop:?}");
        }
    }

    /// At rest the forces carry the weight about the center of mass, and all strikes together have stopped the drop.
    #[test]
    fn at_rest_the_weight_is_carried(drop in any_drop(0.0..0.8_f64)) {
        let flight = scene(&drop).contacts_until(&contact(&drop), 1e-4, |_| false).expect("a flight");
        let Stop::AtRest { time_s, shock_bound_m_s, .. } = flight.stop else { return Err(TestCaseError::fail(format!("{:?} {drop:?}", flight.stop))) };
        let forces = flight.sample(2.0 * time_s).expect("contacts").force_per_mass_m_s2;
        let corners = scene(&drop).plate().corners_m();
        let sum = |of: fn(&[f64; 2]) -> f64| -> f64 { corners.iter().zip(forces).map(|(corner, force)| of(corner) * force).sum() };
        let size = drop.edges.iter().sum::<f64>();
        prop_assert!((sum(|_| 1.0) / G - 1.0).abs() < 1e-12, "{forces:?}");
        prop_assert!(sum(|c| c[0]).abs().max(sum(|c| c[1]).abs()) < 1e-12 * G * size, "{forces:?}");
        prop_assert!(forces.iter().all(|force| *force >= 0.0), "{forces:?}");
        let plate = scene(&drop).plate();
        let stopped: f64 = flight.strikes.iter().map(|strike| motion(&plate, strike.delta_v_m_s)[0]).sum();
        let fallen = drop.speed + G * time_s;
        prop_assert!((stopped - fallen).abs() < 2.0 * shock_bound_m_s + 1e-9 * fallen, "{stopped} {fallen} {drop:?}");
    }

    /// Later strikes stay below what is said ahead of them.
    #[test]
    fn what_is_said_ahead_holds(drop in any_drop(0.0..0.95_f64)) {
        let mut asked = Vec::new();
        let flight = scene(&drop).contacts_until(&contact(&drop), 1e-4, |ahead| {
            asked.push(*ahead);
            false
        });
        let flight = flight.expect("a flight");
        for ahead in &asked {
            for strike in flight.strikes.iter().filter(|strike| strike.time_s >= ahead.time_s) {
                let most = 0.5 * ahead.most_m_s * (1.0 + 1e-9);
                prop_assert!(-strike.approach_m_s <= most, "{strike:?} after {ahead:?} {drop:?}");
            }
        }
    }

    /// What a place feels is how its velocity changes, gravity apart.
    #[test]
    fn what_is_felt_adds_up(drop in any_drop(0.0..0.9_f64), x in -1.0..1.0_f64, y in -1.0..1.0_f64) {
        let flight = scene(&drop).contacts_until(&contact(&drop), 1e-3, |_| false).expect("a flight");
        let (plate, end_s) = (scene(&drop).plate(), flight.stop.time_s());
        let sum = |felt: &Excitation| -> f64 { felt.sections().map(|section| section.velocity_after(section.length)).sum() };
        let place = plate.place([x, y]);
        let [v, by_x, by_y] = motion(&plate, flight.sample(end_s).expect("contacts").velocity_m_s);
        let (by_x, by_y) = (by_x - drop.spin[0], by_y - drop.spin[1]);
        let changed = v + by_x * place[0] + by_y * place[1] + drop.speed + G * end_s;
        let felt = sum(&flight.felt(place));
        prop_assert!((felt - changed).abs() < 1e-9 * (drop.speed + G * end_s), "{felt} {changed} {drop:?}");
        let turned = [sum(&flight.turned([1.0, 0.0])), sum(&flight.turned([0.0, 1.0]))];
        let size = drop.speed / drop.gyration[0].min(drop.gyration[1]);
        prop_assert!((turned[0] - by_x).abs().max((turned[1] - by_y).abs()) < 1e-9 * size, "{turned:?} {by_x} {by_y}");
    }

    /// Seen in a mirror, and with its axes exchanged, a plate does the same; mirrored it is another corner that touches first, so that the
    /// mirror is that of the diagonal for a plate with its axes exchanged.
    #[test]
    fn axes_may_be_exchanged(drop in any_drop(0.05..1.0_f64)) {
        let [a, b, c, d] = drop.edges;
        let [kx, ky] = drop.gyration;
        let ([hx, hy], [sx, sy]) = (drop.gaps, drop.spin);
        let other = Drop { edges: [c, d, a, b], gyration: [ky, kx], gaps: [hy, hx], spin: [sy, sx], ..drop };
        let until_s = 4.0 * drop.time + (hx + hy) / drop.speed;
        let (one, other) = (until(&drop, until_s), until(&other, until_s));
        let big = |flight: &PlateMotion| -> Vec<Strike<4>> { flight.strikes.iter().filter(|s| !grazes(s.approach_m_s, &drop)).copied().collect() };
        let (one, other) = (big(&one), big(&other));
        prop_assert_eq!(one.len(), other.len(), "{:?}", drop);
        // Corners that touch at one instant come in their own order.
        let at = |strikes: &[Strike<4>], point: usize| -> Vec<[f64; 2]> { strikes.iter().filter(|s| s.point == point).map(|s| [s.time_s, s.approach_m_s]).collect() };
        for (point, exchanged) in [(0, 0), (1, 3), (2, 2), (3, 1)] {
            let (one, other) = (at(&one, point), at(&other, exchanged));
            prop_assert_eq!(one.len(), other.len(), "{:?}", drop);
            for ([t, v], [t2, v2]) in one.into_iter().zip(other) {
                prop_assert!((t - t2).abs() < 1e-7 * until_s && (v - v2).abs() < 1e-7 * drop.speed, "{t} {t2} {v} {v2} {drop:?}");
            }
        }
    }
}

/// A plate that lands on edges is the bar along it. With β = 1 + α two corners at once are as stiff as the contact of a bar's end with
/// the same time alone.
#[test]
fn a_plate_that_lands_on_edges_is_a_bar() {
    for law in ContactLaw::ALL {
        for (e, k) in [(0.3, 0.577), (0.7, 0.8), (0.1, 0.5), (1.0, 0.6), (0.05, 0.7)] {
            let (half, depth, tilt, speed) = (0.07, 0.035, 1e-4_f64, 3.0);
            let gyration = [half * k, depth / (1.0 + (1.0_f64 / k).powi(2)).sqrt()];
            let (edges, gaps) = ([half, half, depth, depth], [2.0 * half * tilt, 0.0]);
            let drop = Drop { edges, gyration, gaps, spin: [0.0; 2], speed, gravity: G, law, e, time: 2e-4 };
            let until_s = 3.0 * drop.time;
            let plate = until(&drop, until_s);
            let body = Profile::new(2.0 * half, gyration[0]).unwrap();
            let bar = Scene::new(body, e, speed, tilt.asin().to_degrees(), G).unwrap();
            let bar = bar.with_time_limit_s(until_s).unwrap().fly(Model::Contacts(contact(&drop))).unwrap();
            for k in 0..60 {
                let t = until_s * f64::from(k) / 60.0;
                let (plate, bar) = (plate.sample(t).expect("contacts"), bar.sample(t).expect("contacts"));
                for (corner, end) in [(0, 0), (3, 0), (1, 1), (2, 1)] {
                    // The bar turns by up to 1e-2 in that time, and its lever arms by the square of that.
                    let off = (plate.velocity_m_s[corner] - bar.velocity_m_s[end]).abs();
                    assert!(off < 3e-4 * speed, "{law:?} e = {e} at {t}: corner {corner} {off:e}");
                }
            }
            let order: Vec<usize> = plate.strikes.iter().take(4).map(|strike| strike.point).collect();
            assert!(order == [0, 3, 1, 2] && bar.strikes.len() >= 2, "{order:?}");
        }
    }
}

/// Each corner of a flat, centered plate presses as long as four springs at its corners take.
#[test]
fn a_flat_plate_rises_with_the_restitution() {
    for law in ContactLaw::ALL {
        for e in [0.2, 0.5, 1.0] {
            let drop = Drop {
                edges: [0.07, 0.07, 0.035, 0.035],
                gyration: [0.04, 0.02],
                gaps: [0.0; 2],
                spin: [0.0; 2],
                speed: 2.0,
                gravity: 0.0,
                law,
                e,
                time: 1e-3,
            };
            let flight = scene(&drop).contacts_until(&contact(&drop), 1e-4, |_| false).expect("a flight");
            let weight = 1.0 + (7.0_f64 / 4.0).powi(2) + (3.5_f64 / 2.0).powi(2);
            assert!(matches!(flight.stop, Stop::BouncedClear { .. }), "{law:?} {e}");
            assert_eq!(flight.presses.len(), 4, "{law:?} {e}");
            for (strike, press) in flight.strikes.iter().zip(&flight.presses) {
                if law == ContactLaw::Hysteretic {
                    assert!(
                        (press.until_s / (drop.time * (0.25 * weight).sqrt()) - 1.0).abs() < 1e-12,
                        "{e}: {press:?}"
                    );
                    assert!(strike.velocity_m_s.iter().all(|v| (v / (2.0 * e) - 1.0).abs() < 1e-12), "{e}: {strike:?}");
                } else {
                    // The damping ratio of four dashpots at once differs from that of a lone one.
                    assert!(strike.velocity_m_s.iter().all(|v| (v - strike.velocity_m_s[0]).abs() < 1e-12), "{e}");
                }
            }
        }
    }
}

#[test]
fn bad_plates_are_refused_with_the_value() {
    let text = |result: Result<Plate, clatter::Error>| result.unwrap_err().to_string();
    assert!(text(Plate::new([0.1, 0.1, 0.0, 0.1], [0.05; 2])).contains("distance of an edge in m = 0"));
    assert!(text(Plate::new([0.1, f64::NAN, 0.1, 0.1], [0.05; 2])).contains("NaN"));
    assert!(text(Plate::new([0.1, 1e-8, 0.1, 0.1], [0.05; 2])).contains("ratio"));
    assert!(text(Plate::new([0.1; 4], [0.05, -1.0])).contains("along y"));
    let plate = Plate::new([0.1; 4], [0.05; 2]).unwrap();
    for gaps in [[-1e-3, 0.0], [0.3, 0.0], [f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert!(PlateScene::new(plate, 1.0, gaps, G).unwrap_err().to_string().contains("height of corner"), "{gaps:?}");
    }
    let scene = PlateScene::new(plate, 1.0, [1e-3; 2], G).unwrap();
    for time in [1e-12, 0.05] {
        let error = scene
            .contacts_until(&Contact::new(ContactLaw::Hysteretic, 0.3, time).unwrap(), 1e-4, |_| false)
            .unwrap_err()
            .to_string();
        assert!(error.contains("contact time"), "{error}");
    }
    let thin = Plate::new([0.1; 4], [0.05, 0.009]).unwrap();
    let scene = PlateScene::new(thin, 1.0, [1e-3; 2], G).unwrap();
    let error = scene
        .contacts_until(&Contact::new(ContactLaw::Hysteretic, 0.3, 1e-3).unwrap(), 1e-4, |_| false)
        .unwrap_err()
        .to_string();
    assert!(error.contains("radius of gyration 9 mm"), "{error}");
}

proptest! {
    #![proptest_config(config(40))]

    /// Without restitution a corner stays where it has loaded, until it is pulled up or pushed on by more than it has borne; three hold
    /// the plate.
    #[test]
    fn dead_corners_hold_the_plate(drop in any_drop(Just(0.0))) {
        let drop = Drop { law: ContactLaw::Hysteretic, ..drop };
        // Where corners let go at one instant their order decides.
        prop_assume!(drop.gaps.iter().all(|gap| *gap > 0.0));
        let until_s = 6.0 * drop.time + 2.0 * (drop.gaps[0] + drop.gaps[1]) / drop.speed;
        let run_in_steps = |faster: f64, until_s: f64, fine: f64| {
            let mut plain = PlainPlate::new(&Drop { speed: drop.speed * (1.0 + faster), ..drop });
            plain.fine = fine;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "100 or 1000")]
            let steps = fine as usize * 1000;
            prop_assume!(plain.run(until_s, steps)); // else it chatters without end
            Ok(plain)
        };
        let run = |faster: f64, until_s: f64| run_in_steps(faster, until_s, 100.0);
        // Until it lies still, or so nearly that the flight says it rests.
        let rests = until(&drop, until_s).stop.time_s();
        let until_s = until_s.min(0.999 * rests).min(0.999 * run(0.0, until_s)?.time);
        let (plain, shaken) = (run(0.0, until_s)?, run(1e-7, until_s)?);
        let fast = |a: [f64; 4], b: [f64; 4]| (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) / drop.speed;
        let times = (fast(plain.velocities(), shaken.velocities()) / 1e-7).max(1.0);
        let moved = until(&drop, until_s);
        prop_assume!(moved.strikes.iter().all(|strike| !grazes(strike.approach_m_s, &drop)));
        let moved = moved.sample(until_s).expect("contacts");
        let off = |plain: &PlainPlate| fast(moved.velocity_m_s, plain.velocities());
        let is_near = |off: f64| times > 1e3 || off < 1e-6 * times;
        if !is_near(off(&plain)) {
            // What grazes, or lets go within a step of another, the integration sees in small steps alone.
            let off = off(&run_in_steps(0.0, until_s, 1000.0)?);
            prop_assert!(is_near(off), "{off:e}, {times}-fold of {drop:?}");
        }
    }
}

/// What lands on an edge of a plate that is even across stays even, whatever the law and the restitution.
#[test]
fn an_even_drop_stays_even() {
    for law in ContactLaw::ALL {
        for e in [0.0, 0.05, 0.3, 0.9] {
            let edges = [0.157, 0.087, 0.122, 0.122];
            let (gyration, gaps) = ([0.069, 0.093], [6e-3, 0.0]);
            let drop = Drop { edges, gyration, gaps, spin: [0.0; 2], speed: 2.0, gravity: G, law, e, time: 1e-3 };
            let until_s = 6e-3;
            let flight = until(&drop, until_s);
            for k in 0..60 {
                let [a, b, c, d] = flight.sample(until_s * f64::from(k) / 60.0).expect("contacts").velocity_m_s;
                assert!((a - d).abs().max((b - c).abs()) < 1e-9, "{law:?} e = {e}, {k}: {a} {d}, {b} {c}");
            }
        }
    }
}

/// Masses on one line, k_x k_y, would have no inertia across it; nearly so many are taken.
#[test]
fn masses_nearly_on_one_line_are_taken() {
    let plate = Plate::new([0.07, 0.07, 0.03, 0.03], [0.04, 0.02]).unwrap();
    for (share, taken) in [(0.985, true), (-0.985, true), (0.995, false), (-0.995, false), (f64::NAN, false)] {
        assert_eq!(plate.with_product_of_inertia(share * 0.04 * 0.02).is_ok(), taken, "{share}");
    }
}
