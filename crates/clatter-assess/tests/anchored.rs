//! Signs, axes and places, each held to a case that is worked out here from the file's numbers alone.

use clatter_assess::{Part, Verdict, answer};
use clatter_flight::{Contact, Plate, PlateScene};
use clatter_product::{ContactLaw, Drop, Limit, LimitKind, Model, Place, ProductFile};

type Vector = [f64; 3];

const G: f64 = 9.806_65;

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Solves for the spin that a moment gives a body with these moments of inertia, by Cramer's rule.
fn turned(inertia: [Vector; 3], moment: Vector) -> Vector {
    let column = |k: usize| inertia.map(|row| row[k]);
    let [x, y, z] = [column(0), column(1), column(2)];
    let all = dot(x, cross(y, z));
    [dot(moment, cross(y, z)) / all, dot(x, cross(moment, z)) / all, dot(x, cross(y, moment)) / all]
}

fn read(text: &str) -> ProductFile {
    ProductFile::read(text, "anchored.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

/// The demand of each limit of the file, in its order.
fn demands(text: &str) -> Vec<f64> {
    let assessment = clatter_assess::assess(&read(text)).unwrap();
    assessment.components.iter().flat_map(|part| &part.limits).map(|limit| limit.demand.expect("an answer")).collect()
}

fn near(got: f64, want: f64, share: f64, what: &str) {
    assert!((got / want - 1.0).abs() < share, "{what}: {got}, not {want}");
}

/// A box of 120 mm × 70 mm × 24 mm: a case of 400 g all over it, a battery of 120 g off the middle above, a camera of 30 g below on the
/// other side. All three products of inertia count.
const MASSES: &str = r#"masses = [
  { mass = "400 g", from = ["-60 mm", "-35 mm"], to = ["60 mm", "35 mm"] },
  { mass = "120 g", position = ["20 mm", "-14 mm"], height = "9 mm" },
  { mass = "30 g", position = ["-45 mm", "20 mm"], height = "-10 mm" },
]"#;
const SIZE: Vector = [0.12, 0.07, 0.024];
const POINTS: [(f64, Vector); 2] = [(0.12, [0.02, -0.014, 0.009]), (0.03, [-0.045, 0.02, -0.01])];

/// The center of mass from the middle, and moments of inertia over the mass.
fn center_and_inertia() -> (Vector, [Vector; 3]) {
    let all = 0.4 + POINTS.iter().map(|(mass, _)| mass).sum::<f64>();
    let center: Vector = std::array::from_fn(|i| POINTS.iter().map(|(mass, at)| mass * at[i]).sum::<f64>() / all);
    let second = |i: usize, j: usize| {
        let case = if i == j { 0.4 * SIZE[i] * SIZE[i] / 12.0 } else { 0.0 };
        (case + POINTS.iter().map(|(mass, at)| mass * at[i] * at[j]).sum::<f64>()) / all - center[i] * center[j]
    };
    let trace = second(0, 0) + second(1, 1) + second(2, 2);
    let inertia =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { trace - second(i, i) } else { -second(i, j) }));
    (center, inertia)
}

/// The bottom of the box is off level by 35°, rising to 20° from the length, and turns on as it lands: the corner of end a in front at the
/// bottom touches alone and hard. A short contact gives a place along its axis (1 + e) times the approach, times what a push at the corner
/// does there over what it does at the corner.
#[test]
fn a_box_with_masses_askew_lands_as_its_file_says() {
    let (center, inertia) = center_and_inertia();
    let (tilt, direction) = (35_f64.to_radians(), 20_f64.to_radians());
    let up = [tilt.sin() * direction.cos(), tilt.sin() * direction.sin(), tilt.cos()];
    let corner: Vector = std::array::from_fn(|i| -0.5 * SIZE[i] - center[i]);
    let lever = cross(corner, up);
    let mobility = 1.0 + dot(lever, turned(inertia, lever));
    for spin in [12.0, 18.0] {
        // The side that is up goes on up.
        let about = [direction.sin() * spin, -direction.cos() * spin, 0.0];
        let approach = 3.0 - dot(up, cross(about, corner));
        assert!((approach - 3.0) * spin > 0.0, "{approach} at {spin}: the tilt grows");
        for (axis, along) in [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])] {
            let at: Vector = [-0.055, -0.03, 0.011];
            let place: Vector = std::array::from_fn(|i| at[i] - center[i]);
            let does = dot(along, up) + dot(cross(place, along), turned(inertia, lever));
            let want = 1.4 * approach * (does / mobility).abs();
            let text = format!(
                "[product]\nname = \"askew\"\nlength = \"120 mm\"\nwidth = \"70 mm\"\nthickness = \"24 mm\"\nfriction = 0\n{MASSES}\nrestitution = 0.4\n\
                 contact_time = \"0.02 ms\"\ncontact_law = \"hysteretic\"\n[drop]\nspeed = \"3 m/s\"\ntilt = \"35 deg\"\n\
                 direction = \"20 deg\"\nattitude_tolerance = \"0 deg\"\nspin = \"{spin} rad/s\"\n[[component]]\nname = \"part\"\n\
                 position = [\"-55 mm\", \"-30 mm\"]\nheight = \"11 mm\"\naxis = \"{axis}\"\nmount = \"hard\"\nvelocity_change_limit = \"9 m/s\"\n"
            );
            let file = read(&text);
            let drop = clatter_assess::assess(&file).unwrap().components[0].limits[0].worst_case.expect("a drop").drop;
            let block = drop.of_box().unwrap().unwrap().block();
            for (got, want) in block.center_of_mass_m().into_iter().zip(center) {
                assert!((got - want).abs() < 1e-12, "{got}, not {want}");
            }
            for (got, want) in block.turned_by(lever).into_iter().zip(turned(inertia, lever)) {
                near(got, want, 1e-9, "what the push turns");
            }
            let part = Part::at(file.components[0].inside.place([-0.055, -0.03]), None);
            let limit = Limit::new(LimitKind::VelocityChange, 9.0);
            let asked = answer(&drop, &part, &limit, Model::Compliant, 0.001).unwrap();
            // The contact lasts long enough to turn the box by some thousandths.
            if asked.impact == 1 {
                near(asked.value, want, 5e-3, &format!("along {axis} at {spin} rad/s"));
            } else {
                assert!(asked.value > want, "along {axis} at {spin} rad/s: {} below {want}", asked.value);
            }
            assert!(axis != "z" || asked.impact == 1, "{asked:?}");
        }
    }
}

/// A plate of 160 mm × 80 mm, its corner a down, that turns on or back as it lands: the corner approaches by its arm times the spin faster or
/// slower.
#[test]
fn a_plate_that_turns_on_lands_harder() {
    for (direction, spin) in [(0.0_f64, 6.0), (0.7, 6.0), (0.7, -6.0)] {
        let want = 1.3 * (2.0 + spin * (0.08 * direction.cos() + 0.04 * direction.sin()));
        let text = format!(
            "[product]\nname = \"plate\"\nlength = \"160 mm\"\nwidth = \"80 mm\"\nradius_of_gyration = [\"50 mm\", \"25 mm\"]\nrestitution = 0.3\n\
             contact_time = \"0.05 ms\"\ncontact_law = \"hysteretic\"\n[drop]\nspeed = \"2 m/s\"\ntilt = \"8 deg\"\ndirection = \"{} deg\"\n\
             spin = \"{spin} rad/s\"\n[[component]]\nname = \"corner\"\nposition = [\"-80 mm\", \"-40 mm\"]\nmount = \"hard\"\n\
             velocity_change_limit = \"99 m/s\"\n",
            direction.to_degrees()
        );
        let drop =
            clatter_assess::assess(&read(&text)).unwrap().components[0].limits[0].worst_case.expect("a drop").drop;
        let limit = Limit::new(LimitKind::VelocityChange, 99.0);
        let part = Part::at(Place::flat([-0.08, -0.04]), None);
        let asked = answer(&drop, &part, &limit, Model::Compliant, 0.001).unwrap();
        if direction > 0.0 && spin > 0.0 {
            near(asked.value, want, 2e-3, "from a file");
        }
        // The same plate as it is given to `respond`.
        let plate = Plate::new([0.08, 0.08, 0.04, 0.04], [0.05, 0.025]).unwrap();
        let rise = 8_f64.to_radians().sin();
        let gaps = [0.16 * rise * direction.cos(), 0.08 * rise * direction.sin()];
        let scene = PlateScene::new(plate, 2.0, gaps, G).unwrap();
        let scene = scene.with_spin([spin * direction.cos(), spin * direction.sin()]).unwrap();
        let contact = Contact::new(ContactLaw::Hysteretic, 0.3, 5e-5).unwrap();
        let given = Drop {
            contact_time_s: Some(contact.time_s()),
            contact_law: contact.law(),
            ..Drop::of_plate(&scene, contact.restitution()).unwrap()
        };
        let same = answer(&given, &part, &limit, Model::Compliant, 0.001).unwrap();
        near(same.value, asked.value, 1e-9, "as it is given");
        near(given.spin_rad_s, spin, 1e-12, "its spin");
    }
}

/// One corner of a plate is far harder than the others. Whichever it is, the plate that is its mirror image, with its part, is asked for as much.
#[test]
fn a_plate_with_one_hard_corner_is_searched_all_around() {
    let of = |at: &str, [x, y]: [i32; 2]| {
        let text = format!(
            "[product]\nname = \"plate\"\nlength = \"160 mm\"\nwidth = \"90 mm\"\nradius_of_gyration = [\"46 mm\", \"26 mm\"]\nrestitution = 0.3\n\
             contact_time = \"1 ms\"\ncontact_law = \"hysteretic\"\ncontacts = [{{ at = \"{at}\", restitution = 0.3, contact_time = \"0.2 ms\" }}]\n\
             [drop]\nspeed = \"3 m/s\"\ntilt = [\"2 deg\", \"6 deg\"]\n[[component]]\nname = \"part\"\nposition = [\"{} mm\", \"{} mm\"]\n\
             mount = \"hard\"\nacceleration_limit = \"9000 gn\"\n",
            70 * x,
            38 * y
        );
        demands(&text)[0]
    };
    let all = [("a", [-1, -1]), ("b", [1, -1]), ("c", [1, 1]), ("d", [-1, 1])].map(|(at, side)| of(at, side));
    // A lone contact of 0.2 ms at its corner, felt near it, is a part of the worst.
    let mobility = 1.0 + (0.08_f64 / 0.046).powi(2) + (0.045_f64 / 0.026).powi(2);
    let there = (1.0 + 0.07 * 0.08 / 0.046_f64.powi(2) + 0.038 * 0.045 / 0.026_f64.powi(2)) / mobility;
    let lone = std::f64::consts::FRAC_PI_2 * 1.3 * 3.0 / 2e-4 * there;
    for demand in all {
        assert!(demand > 0.98 * lone, "{demand} is less than {lone}");
        near(demand, all[0], 0.02, "mirror images");
    }
}

/// The same of a bar whose ends differ: the hard end is searched first as well.
#[test]
fn a_bar_with_one_hard_end_is_searched_from_both() {
    let of = |at: &str, x: i32| {
        demands(&format!(
            "[product]\nname = \"bar\"\nlength = \"160 mm\"\nradius_of_gyration = \"46 mm\"\nrestitution = 0.3\ncontact_time = \"1 ms\"\n\
             contact_law = \"hysteretic\"\ncontacts = [{{ at = \"{at}\", restitution = 0.3, contact_time = \"0.2 ms\" }}]\n[drop]\nspeed = \"3 m/s\"\n\
             tilt = [\"2 deg\", \"6 deg\"]\n[[component]]\nname = \"part\"\nposition = \"{x} mm\"\nmount = \"hard\"\nacceleration_limit = \"9000 gn\"\n"
        ))[0]
    };
    let [a, b] = [of("a", -70), of("b", 70)];
    let mobility = 1.0 + (0.08_f64 / 0.046).powi(2);
    let lone = std::f64::consts::FRAC_PI_2 * 1.3 * 3.0 / 2e-4 * (1.0 + 0.07 * 0.08 / 0.046_f64.powi(2)) / mobility;
    assert!(a > 0.98 * lone && b > 0.98 * lone, "{a}, {b} and {lone}");
    near(a, b, 0.01, "mirror images");
}

/// The part reaches its stop in the second drop of the list alone: what it stands is not known, whatever the first drop says.
#[test]
fn a_stop_that_is_reached_in_a_later_drop_counts() {
    let text = r#"
[product]
name = "bar"
length = "150 mm"
radius_of_gyration = "43 mm"
restitution = 0.3
contact_time = "0.5 ms"
contact_law = "hysteretic"
[[drop]]
speed = "1 m/s"
tilt = "4 deg"
[[drop]]
speed = "4 m/s"
tilt = "4 deg"
[[component]]
name = "part"
position = "20 mm"
natural_frequency = "60 Hz"
damping_ratio = 0.1
acceleration_limit = "3000 gn"
rattle_space = "6 mm"
"#;
    let assessment = clatter_assess::assess(&read(text)).unwrap();
    let limits = &assessment.components[0].limits;
    let verdicts: Vec<Verdict> = limits.iter().map(|limit| limit.verdict).collect();
    assert_eq!(verdicts, [Verdict::Undecided, Verdict::Unsafe]);
    let of_drops = |k: usize| assessment.landings[k].limits.iter().map(|limit| limit.verdict).collect::<Vec<_>>();
    assert_eq!((of_drops(0), of_drops(1)), (vec![Verdict::Safe; 2], vec![Verdict::Undecided, Verdict::Unsafe]));
}

/// Energy bounds the change of velocity of a place: twice √(2E (1 + x²/ρ²)) and g for as long as a contact lasts. 2E is that of the fall,
/// of the spin and of the height over the ground.
#[test]
fn the_energy_of_a_bar_is_that_of_its_fall_its_spin_and_its_height() {
    let of = |spin: &str, feet: &str| {
        let text = format!(
            "[product]\nname = \"bar\"\nlength = \"150 mm\"\nradius_of_gyration = \"43 mm\"\nrestitution = 0.3\ncontact_time = \"0.5 ms\"\n\
             contact_law = \"hysteretic\"\n{feet}\n[drop]\nspeed = \"3 m/s\"\ntilt = \"4 deg\"\n{spin}\n[[component]]\nname = \"part\"\n\
             position = \"20 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"99 m/s\"\n"
        );
        let limit = clatter_assess::assess(&read(&text)).unwrap().components[0].limits[0].clone();
        (limit.bound.expect("a bound"), limit.demand.expect("an answer"))
    };
    let bound = |spin: f64| {
        let energy = 9.0 + (0.043 * spin).powi(2) + 2.0 * G * 0.075 * 4_f64.to_radians().sin();
        2.0 * (energy * (1.0 + (0.02_f64 / 0.043).powi(2))).sqrt() + G * 5e-4
    };
    near(of("", "").0, bound(0.0), 1e-9, "without spin");
    near(of("spin = \"25 rad/s\"", "").0, bound(25.0), 1e-9, "with spin");
    let (told, demand) = of("", "feet_inset = \"15 mm\"\nfeet_height = \"9 mm\"");
    assert!(told >= bound(0.0) * (1.0 - 1e-9) && told > demand, "on feet: {told}");
}
