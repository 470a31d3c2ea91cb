//! Boxes in space, beside an integration in axes of the world with small steps of one length, closed forms and laws.

use clatter_flight::{Block, BlockDrop, BlockFlight, Contact, ContactLaw, Stop};
use proptest::prelude::*;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A drop of a box in plain numbers.
#[derive(Debug, Clone)]
struct Case {
    size: Vector,
    center: Vector,
    gyration: Vector,
    /// ∫x y, ∫x z and ∫y z over the mass.
    products: Vector,
    /// Unit quaternion.
    turned: [f64; 4],
    spin: Vector,
    e: f64,
    time: f64,
    law: ContactLaw,
}

const SPEED: f64 = 3.0;
const GRAVITY: f64 = 9.80665;

impl Case {
    fn block(&self) -> Block {
        Block::new(self.size, self.center, self.gyration).unwrap().with_products_of_inertia(self.products).unwrap()
    }
    /// Moments of inertia over the mass.
    fn moments(&self) -> [Vector; 3] {
        let ([x, y, z], [xy, xz, yz]) = (self.gyration.map(|k| k * k), self.products);
        [[x, -xy, -xz], [-xy, y, -yz], [-xz, -yz, z]]
    }
    /// The angular momentum over the mass of a spin, in axes of the box.
    fn momentum(&self, spin: Vector) -> Vector {
        self.moments().map(|row| dot(row, spin))
    }
    /// The spin of an angular momentum, by Cramer's rule.
    fn spin_of(&self, momentum: Vector) -> Vector {
        let moments = self.moments();
        let det = |m: [Vector; 3]| dot(m[0], cross(m[1], m[2]));
        // Symmetric: a column in place of a row.
        std::array::from_fn(|i| {
            let mut with = moments;
            with[i] = momentum;
            det(with) / det(moments)
        })
    }
    fn drop(&self) -> BlockDrop {
        let drop = BlockDrop::new(self.block(), self.turned, SPEED, GRAVITY).unwrap();
        drop.with_spin(self.spin).unwrap_or(drop)
    }
    fn contact(&self) -> Contact {
        Contact::new(self.law, self.e, self.time).unwrap()
    }
    fn flight(&self, until: f64) -> BlockFlight {
        self.drop().with_time_limit_s(until).unwrap().contacts(&self.contact(), |_| ()).unwrap()
    }
}

prop_compose! {
    fn case()(
        size in prop::array::uniform3(0.01..0.2_f64),
        center in prop::array::uniform3(-0.15..0.15_f64),
        spread in prop::array::uniform3(0.3..1.0_f64),
        askew in prop::array::uniform3(-0.45..0.45_f64),
        turned in prop::array::uniform4(-1.0..1.0_f64),
        small in any::<bool>(),
        spin in prop::array::uniform3(-4.0..4.0_f64),
        e in 0.05..0.95_f64,
        time in 2e-3..2e-2_f64,
        dashpot in any::<bool>(),
    ) -> Case {
        // Moments of masses that are spread over a part of the box.
        let squares: Vector = std::array::from_fn(|i| spread[i] * size[i] * size[i] / 12.0);
        let gyration = std::array::from_fn(|i| (squares[(i + 1) % 3] + squares[(i + 2) % 3]).sqrt());
        let lean = |k: usize, i: usize, j: usize| askew[k] * (squares[i] * squares[j]).sqrt();
        let products = [lean(0, 0, 1), lean(1, 0, 2), lean(2, 1, 2)];
        let turned = if small { [1.0, 0.03 * turned[1], 0.03 * turned[2], 0.0] } else { turned };
        let length = turned.iter().map(|x| x * x).sum::<f64>().sqrt().max(0.1);
        let mut turned = turned.map(|x| x / length);
        turned[0] = (1.0 - turned[1..].iter().map(|x| x * x).sum::<f64>()).max(0.0).sqrt();
        let center = std::array::from_fn(|i| center[i] * size[i]);
        // Corners sink in little at any of these spins: far below a tenth of the largest size and a quarter of the smallest.
        let [least, most] = [f64::min, f64::max].map(|of| size.into_iter().reduce(of).unwrap());
        let time = (time * most).min(1e-3).min(0.03 * least);
        let law = if dashpot { ContactLaw::Dashpot } else { ContactLaw::Hysteretic };
        Case { size, center, gyration, products, turned, spin, e, time, law }
    }
}

/// The box in axes of the world: the places of its corners, momentum and angular momentum.
#[derive(Clone)]
struct World {
    height: f64,
    velocity: f64,
    /// Columns: the axes of the box in the world.
    axes: [Vector; 3],
    momentum: Vector,
}

/// A press as the brute force has it: corner, time, approach.
type Touch = (usize, f64, f64);

impl World {
    fn of(case: &Case) -> Self {
        let [w, x, y, z] = case.turned;
        let axes = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let spin = case.drop().spin_rad_s();
        let own = case.momentum(spin);
        let momentum = std::array::from_fn(|k| (0..3).map(|i| axes[i][k] * own[i]).sum());
        let corners = case.block().corners_m();
        let mut world = Self { height: 0.0, velocity: -SPEED, axes, momentum };
        world.height = -corners.map(|corner| world.arm(corner)[2]).into_iter().fold(f64::INFINITY, f64::min);
        world
    }
    /// Of a place in axes of the box, from the center of mass.
    fn arm(&self, place: Vector) -> Vector {
        std::array::from_fn(|k| (0..3).map(|i| self.axes[i][k] * place[i]).sum())
    }
    /// Spin in the world.
    fn spin(&self, case: &Case) -> Vector {
        self.arm(case.spin_of(self.axes.map(|axis| dot(axis, self.momentum))))
    }
    fn corner(&self, case: &Case, place: Vector) -> (f64, f64) {
        let arm = self.arm(place);
        (self.height + arm[2], self.velocity + cross(self.spin(case), arm)[2])
    }
    /// Derivatives for forces that depend on where the corners are.
    fn slope(&self, case: &Case, corners: &[Vector; 8], force: &impl Fn(usize, f64, f64) -> f64) -> Self {
        let (mut up, mut moment) = (-GRAVITY, [0.0; 3]);
        for (i, place) in corners.iter().enumerate() {
            let (height, velocity) = self.corner(case, *place);
            let own = force(i, height, velocity);
            up += own;
            let turned = cross(self.arm(*place), [0.0, 0.0, own]);
            moment = std::array::from_fn(|k| moment[k] + turned[k]);
        }
        let spin = self.spin(case);
        Self { height: self.velocity, velocity: up, axes: self.axes.map(|axis| cross(spin, axis)), momentum: moment }
    }
    fn plus(&self, h: f64, slope: &Self) -> Self {
        let add = |a: Vector, b: Vector| std::array::from_fn(|k| a[k] + h * b[k]);
        Self {
            height: self.height + h * slope.height,
            velocity: self.velocity + h * slope.velocity,
            axes: std::array::from_fn(|i| add(self.axes[i], slope.axes[i])),
            momentum: add(self.momentum, slope.momentum),
        }
    }
}

/// How a corner stands in the brute force.
#[derive(Clone, Copy, PartialEq)]
enum Line {
    Off,
    /// A dashpot that has let go while the corner is still below the ground.
    Slack,
    Virgin,
    /// Unloading from a depth.
    Back(f64),
}

/// One corner and the ground under it.
#[derive(Clone, Copy)]
struct Spring {
    line: Line,
    ground: f64,
    stiffness: f64,
}

/// The brute force: what does not change from step to step, and the corners.
struct Brute<'a> {
    case: &'a Case,
    corners: [Vector; 8],
    omega: f64,
    /// 2ζ/ω of a dashpot.
    delay: f64,
    springs: [Spring; 8],
}

impl Brute<'_> {
    fn force(&self, i: usize, height: f64, velocity: f64) -> f64 {
        let Spring { line, ground, stiffness } = self.springs[i];
        let (depth, e2) = (ground - height, self.case.e * self.case.e);
        match line {
            Line::Off | Line::Slack => 0.0,
            Line::Virgin => stiffness * (depth - self.delay * velocity),
            Line::Back(deepest) => stiffness / e2 * (depth - deepest * (1.0 - e2)),
        }
    }
    /// How a corner goes on if it stands on a line no longer.
    fn next(&self, i: usize, world: &World) -> Option<Line> {
        let (height, velocity) = world.corner(self.case, self.corners[i]);
        let Spring { line, ground, .. } = self.springs[i];
        let (depth, e2) = (ground - height, self.case.e * self.case.e);
        let pushes = depth - self.delay * velocity > 0.0;
        match line {
            Line::Off => (depth >= 0.0 && velocity < 0.0).then_some(Line::Virgin),
            Line::Slack if depth <= 0.0 => Some(Line::Off),
            Line::Slack => pushes.then_some(Line::Virgin),
            Line::Virgin if self.delay > 0.0 => (!pushes).then_some(if depth > 0.0 { Line::Slack } else { Line::Off }),
            Line::Virgin => (velocity >= 0.0).then_some(Line::Back(depth)),
            Line::Back(deepest) if depth > deepest => Some(Line::Virgin),
            Line::Back(deepest) => (depth <= deepest * (1.0 - e2)).then_some(Line::Off),
        }
    }
    /// One of Runge and Kutta's classical steps.
    fn step(&self, world: &World, h: f64) -> World {
        let slope = |world: &World| {
            world.slope(self.case, &self.corners, &|i, height, velocity| self.force(i, height, velocity))
        };
        let k1 = slope(world);
        let k2 = slope(&world.plus(0.5 * h, &k1));
        let k3 = slope(&world.plus(0.5 * h, &k2));
        let k4 = slope(&world.plus(h, &k3));
        world.plus(h / 6.0, &k1).plus(h / 3.0, &k2).plus(h / 3.0, &k3).plus(h / 6.0, &k4)
    }
    /// Puts a corner on its next line; the velocity of one that touches.
    fn changes(&mut self, i: usize, world: &World, line: Line) -> Option<f64> {
        let (_, velocity) = world.corner(self.case, self.corners[i]);
        let before = self.springs[i].line;
        if let (Line::Back(deepest), Line::Off) = (before, line) {
            self.springs[i].ground -= deepest * (1.0 - self.case.e * self.case.e);
        }
        self.springs[i].line = line;
        let touches = line == Line::Virgin && matches!(before, Line::Off | Line::Slack);
        if !touches {
            return None;
        }
        let turned = cross(world.arm(self.corners[i]), [0.0, 0.0, 1.0]);
        let turned = world.axes.map(|axis| dot(axis, turned));
        let own = 1.0 + dot(turned, self.case.spin_of(turned));
        self.springs[i].stiffness = self.omega * self.omega / own;
        Some(velocity)
    }
    /// A corner that is above the ground leaves its dent behind.
    fn leaves(&mut self, world: &World) {
        for i in 0..8 {
            if world.corner(self.case, self.corners[i]).0 > 0.0 {
                self.springs[i].ground = 0.0;
            }
        }
    }
}

/// Touches until a time: steps of a thousandth of a contact while one presses or is near, more in flight; each ends at the first event
/// in it, which halving it finds.
fn brute(case: &Case, until: f64) -> (Vec<Touch>, World) {
    let contact = case.contact();
    let omega = contact.frequency_rad_s();
    let delay = if case.law == ContactLaw::Dashpot { 2.0 * contact.damping_ratio() / omega } else { 0.0 };
    let spring = Spring { line: Line::Off, ground: 0.0, stiffness: 0.0 };
    let mut brute = Brute { case, corners: case.block().corners_m(), omega, delay, springs: [spring; 8] };
    let (mut world, mut touches, mut time) = (World::of(case), Vec::new(), 0.0);
    // The lowest corner of the start, which roundings may leave a little above the ground.
    world.height -= 1e-15;
    loop {
        for i in 0..8 {
            if let Some(line) = brute.next(i, &world)
                && let Some(velocity) = brute.changes(i, &world, line)
            {
                touches.push((i, time, velocity));
            }
        }
        brute.leaves(&world);
        if time >= until {
            return (touches, world);
        }
        // In flight as long a step as no corner can come down in.
        let pressed = brute.springs.iter().any(|spring| spring.line != Line::Off);
        let spin = world.spin(case);
        let fall = SPEED + world.velocity.abs() + 0.4 * dot(spin, spin).sqrt();
        let heights = (0..8).map(|i| world.corner(case, brute.corners[i]).0 - brute.springs[i].ground);
        let near = 0.3 * heights.fold(f64::INFINITY, f64::min).max(0.0) / fall;
        let fine = 1e-3 * case.time * case.e.clamp(0.1, 1.0);
        let h = if pressed { fine } else { near.clamp(fine, 0.1 * case.time) }.min(until - time).max(1e-12);
        let happened = |h: f64| {
            let next = brute.step(&world, h);
            (0..8).any(|i| brute.next(i, &next).is_some())
        };
        let mut share = h;
        if happened(h) {
            let mut before = 0.0;
            for _ in 0..40 {
                let middle = 0.5 * (before + share);
                *(if happened(middle) { &mut share } else { &mut before }) = middle;
            }
        }
        world = brute.step(&world, share);
        time += share;
    }
}

/// The touches, one by one, and the motion at the end. One that is hardly a touch may be one more or less, and two that come at once are
/// in no order: what follows them is not compared.
fn agrees(case: &Case) -> Result<(), TestCaseError> {
    let until = 0.02;
    let (touches, world) = brute(case, until);
    let flight = case.flight(until);
    let is_light = |approach: f64| approach.abs() < LIGHT * SPEED;
    let mut compared = 0;
    for (n, (&(corner, time, approach), strike)) in touches.iter().zip(&flight.strikes).enumerate() {
        let is_tied = touches.get(n + 1).is_some_and(|next| next.1 - time < LIGHT * case.time);
        if n == COMPARED || is_light(approach) || is_light(strike.approach_m_s) || is_tied {
            break;
        }
        prop_assert_eq!(corner, strike.corner, "touch {} of {:?}: {:?}", n + 1, case, touches);
        let late = (time - strike.time_s).abs();
        prop_assert!(late < OFF * (case.time + time), "touch {}: {time} {} {case:?}", n + 1, strike.time_s);
        let off = (approach - strike.approach_m_s).abs();
        prop_assert!(off < OFF * SPEED, "touch {}: {approach} {} {case:?}", n + 1, strike.approach_m_s);
        compared += 1;
    }
    if compared == touches.len() && compared == flight.strikes.len() {
        let off = (world.velocity - flight.center_m_s).abs();
        // What is left of the motion of a box at rest is bounded.
        let left = if let Stop::AtRest { shock_bound_m_s, .. } = flight.stop { shock_bound_m_s } else { 0.0 };
        prop_assert!(off < OFF * SPEED + left, "{off} {:?} {case:?}", flight.stop);
    }
    Ok(())
}

/// Touches slower than this share of the drop, and those that follow one another within this share of a contact.
const LIGHT: f64 = 1e-3;
/// So many touches are compared: each multiplies what those before it got wrong.
const COMPARED: usize = 8;
/// What both may differ by: steps are wrong by 1e−8, and each of eight strikes multiplies that by a few.
const OFF: f64 = 1e-5;

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn boxes_move_as_an_integration_in_axes_of_the_world_has_it(case in case()) {
        agrees(&case)?;
    }

    /// Vertical forces turn nothing about the vertical, and the ground gives no energy.
    #[test]
    fn momentum_about_the_vertical_is_kept_and_energy_is_not_made(case in case()) {
        let (drop, flight) = (case.drop(), case.flight(0.05));
        let about = |n: Vector, spin: Vector| dot(n, case.momentum(spin));
        let turning = |spin: Vector| dot(spin, case.momentum(spin));
        let before = about(drop.upward(), drop.spin_rad_s());
        let after = about(flight.upward, flight.spin_rad_s);
        let scale = case.gyration.iter().fold(0.0_f64, |most, k| most.max(*k)) * SPEED;
        prop_assert!((before - after).abs() < 1e-6 * scale, "{before} {after}");
        let lowest = case.block().corners_m().map(|corner| dot(drop.upward(), corner)).into_iter().fold(f64::INFINITY, f64::min);
        let opened = 0.5 * (SPEED * SPEED + turning(drop.spin_rad_s())) - GRAVITY * lowest;
        let left = 0.5 * (flight.center_m_s.powi(2) + turning(flight.spin_rad_s)) + GRAVITY * flight.center_m;
        prop_assert!(left < opened * (1.0 + 1e-6), "{left} {opened}");
        prop_assert!(flight.energy_error < 1e-4, "{}", flight.energy_error);
    }

    /// The mirror image of a drop is the drop of the mirror image.
    #[test]
    fn a_mirrored_box_strikes_with_mirrored_corners(case in case()) {
        let [w, x, y, z] = case.turned;
        let mut mirrored = case.clone();
        mirrored.center[0] = -mirrored.center[0];
        let [xy, xz, yz] = case.products;
        mirrored.products = [-xy, -xz, yz];
        // A mirror across x: a turn keeps its part along x and changes the sign of those along y and z.
        mirrored.turned = [w, x, -y, -z];
        mirrored.spin = [case.spin[0], -case.spin[1], -case.spin[2]];
        let (own, other) = (case.flight(0.01), mirrored.flight(0.01));
        for (own, other) in own.strikes.iter().zip(&other.strikes).take(4) {
            if own.approach_m_s.abs() < 0.02 * SPEED {
                break;
            }
            prop_assert_eq!(own.corner ^ 1, other.corner);
            prop_assert!((own.approach_m_s - other.approach_m_s).abs() < 1e-6 * SPEED);
        }
    }

    /// What is felt at any place adds up to its change of velocity, gravity aside: of the vertical part, in the world.
    #[test]
    fn what_is_felt_adds_up(case in case(), place in prop::array::uniform3(-0.1..0.1_f64)) {
        let (mut sum, mut begin, mut now, mut time) = (0.0, None, 0.0, 0.0);
        let upward = |step: &clatter_flight::BlockStep<'_>, share: f64| -> Vector {
            // The vertical by how high the axes of the box point.
            let at = |axis: usize| {
                let mut place = [0.0; 3];
                place[axis] = 1.0;
                step.place_m(place, share).0 - step.place_m([0.0; 3], share).0
            };
            [at(0), at(1), at(2)]
        };
        case.drop().with_time_limit_s(0.02).unwrap().contacts(&case.contact(), |step| {
            begin.get_or_insert(step.place_m(place, 0.0).1);
            for (share, weight) in [(0.0, 1.0), (0.25, 4.0), (0.5, 2.0), (0.75, 4.0), (1.0, 1.0)] {
                sum += weight / 12.0 * step.length_s * dot(upward(step, share), step.felt_m_s2(place, share));
            }
            (now, time) = (step.place_m(place, 1.0).1, step.from_s + step.length_s);
        }).unwrap();
        let change = now - begin.unwrap() + GRAVITY * time;
        prop_assert!((sum - change).abs() < 1e-4 * SPEED, "{sum} {change}");
    }
}

const EVEN: Case = Case {
    size: [0.12, 0.06, 0.02],
    center: [0.0; 3],
    gyration: [0.018_257, 0.035_119, 0.038_730],
    products: [0.0; 3],
    turned: [1.0, 0.0, 0.0, 0.0],
    spin: [0.0; 3],
    e: 0.5,
    time: 4e-4,
    law: ContactLaw::Hysteretic,
};

/// Four corners press at once along the line of one, each with the stiffness of a lone contact, ω₁²/μ: together 4 ω₁²/μ.
#[test]
fn a_flat_drop_presses_as_four_springs() {
    let flight = EVEN.flight(1e-2);
    assert_eq!(flight.strikes.len(), 4);
    let [x, y, _] = EVEN.gyration;
    let own = 1.0 + (0.03 / x).powi(2) + (0.06 / y).powi(2);
    for strike in &flight.strikes {
        let lasts = EVEN.time * (own / 4.0).sqrt();
        // Gravity works on meanwhile: by g τ over the speed, some thousandths.
        assert!((strike.until_s / lasts - 1.0).abs() < 2e-3, "{} {lasts}", strike.until_s);
        let quarter = 0.25 * 1.5 * SPEED;
        assert!((strike.delta_v_m_s[strike.corner] / own - quarter).abs() < 5e-3 * SPEED);
    }
    // All four share: the velocity of the body changes by (1 + e) v.
    let sum: f64 = flight.strikes.iter().map(|strike| strike.delta_v_m_s[0]).sum();
    assert!((sum - 1.5 * SPEED).abs() < 5e-3 * SPEED, "{sum}");
}

/// Contacts that lose nothing keep the energy of the drop, in rising, turning and height alike: all of it is left.
#[test]
fn what_is_left_of_an_elastic_drop_is_all_of_it() {
    let case = Case { e: 1.0, center: [0.01, -0.005, 0.002], ..EVEN };
    for (tilt, direction) in [(0.1, 0.3), (0.8, 2.0), (1.5, 4.0)] {
        let drop = BlockDrop::tilted(case.block(), tilt, direction, SPEED, GRAVITY).unwrap();
        let lowest =
            case.block().corners_m().map(|corner| dot(drop.upward(), corner)).into_iter().reduce(f64::min).unwrap();
        let flight = drop.with_time_limit_s(0.01).unwrap().contacts(&case.contact(), |_| ()).unwrap();
        assert!(flight.strikes.iter().all(|strike| strike.until_s < 0.01), "in flight");
        // Over where it lies lowest: 8 mm of its top below the center of mass.
        let all = (SPEED * SPEED + 2.0 * GRAVITY * (-lowest - 0.008)).sqrt();
        assert!((flight.left_m_s / all - 1.0).abs() < 1e-6, "{tilt}: {} of {all}", flight.left_m_s);
    }
}

/// A box comes to rest on a face: on the one that it stands on where it stands steadily, on a broad one where it falls over.
#[test]
fn a_box_comes_to_rest_on_the_face_under_its_center() {
    for (degrees, height) in [(0.0_f64, 0.06), (20.0, 0.06), (80.0, 0.01)] {
        // Upright: the long axis is the vertical; slow, so that it does not jump over an edge.
        let half = 0.5 * (90.0 - degrees).to_radians();
        let case = Case { size: [0.12, 0.06, 0.05], turned: [half.cos(), 0.0, half.sin(), 0.0], e: 0.1, ..EVEN };
        let drop = BlockDrop::new(case.block(), case.turned, if degrees < 30.0 { 0.05 } else { 1.0 }, GRAVITY).unwrap();
        let flight = drop.contacts(&case.contact(), |_| ()).unwrap();
        let Stop::AtRest { shock_bound_m_s, .. } = flight.stop else { panic!("{degrees}: {:?}", flight.stop) };
        assert!(shock_bound_m_s < 0.05, "{shock_bound_m_s}");
        let height = if height < 0.05 { 0.025 } else { height };
        assert!((flight.center_m - height).abs() < 1e-3, "{degrees}: {}", flight.center_m);
    }
}

/// A turn about the vertical goes on for ever and keeps no box from coming to rest.
#[test]
fn a_box_that_turns_about_the_vertical_comes_to_rest() {
    let case = Case { turned: [0.999_949_998_75, 0.01, 0.0, 0.0], spin: [0.5, 0.5, 4.0], ..EVEN };
    let flight = case.drop().contacts(&case.contact(), |_| ()).unwrap();
    assert!(matches!(flight.stop, Stop::AtRest { time_s, .. } if time_s < 2.0), "{:?}", flight.stop);
    assert!((flight.spin_rad_s[2] - 4.0).abs() < 0.2, "{:?}", flight.spin_rad_s);
    // At a corner it is felt as an acceleration towards the middle, and the weight with it.
    let felt = flight.at_rest_m_s2([0.06, 0.0, 0.0], GRAVITY);
    let turn = flight.spin_rad_s[2].powi(2) * 0.06;
    assert!((felt[0] + turn).abs() < 0.05 * turn && (felt[2] - GRAVITY).abs() < 0.01 * GRAVITY, "{felt:?}");
}

#[test]
fn what_is_no_box_is_refused() {
    let of = |size, center, gyration| Block::new(size, center, gyration).expect_err("no box").to_string();
    let ([size, gyration], zero) = ([EVEN.size, EVEN.gyration], [0.0; 3]);
    let leaning = |products| EVEN.block().with_products_of_inertia(products).expect_err("no body").to_string();
    for (said, error) in [
        ("size of the box in m", of([0.12, 0.0, 0.02], zero, gyration)),
        ("size of the box in m", of([0.12, 1e-5, 0.02], zero, gyration)),
        ("size of the box in m", of([0.12, f64::NAN, 0.02], zero, gyration)),
        ("center of mass", of(size, [0.0, 0.031, 0.0], gyration)),
        ("no body has such moments", of(size, zero, [0.018, 0.035, 0.08])),
        ("radius of gyration", of(size, zero, [0.018, 0.035, 1e-4])),
        ("within 0.99 of both radii of gyration of the mass", leaning([7e-4, 0.0, 0.0])),
        ("product of inertia over the mass in m²", leaning([f64::NAN, 0.0, 0.0])),
        ("such that a body has them", leaning([5e-4, -1.6e-4, 8e-5])),
    ] {
        assert!(error.contains(said), "{error}");
    }
    let drop = |turned| BlockDrop::new(EVEN.block(), turned, SPEED, GRAVITY);
    assert!(drop([1.0, 1.0, 0.0, 0.0]).unwrap_err().to_string().contains("unit quaternion"));
    let spun = drop(EVEN.turned).unwrap().with_spin([0.0, 1e4, 0.0]);
    assert!(spun.is_ok(), "one end still comes down: {spun:?}");
    let up = BlockDrop::tilted(EVEN.block(), 0.1, 0.0, SPEED, GRAVITY).unwrap().with_spin([0.0, 200.0, 0.0]);
    assert!(up.unwrap_err().to_string().contains("does not land"));
    let long = Contact::new(ContactLaw::Hysteretic, 0.5, 2e-2).unwrap();
    let error = drop(EVEN.turned).unwrap().contacts(&long, |_| ()).unwrap_err().to_string();
    assert!(error.contains("contact time 20 ms: at most 1") && error.contains("smallest size"), "{error}");
}

/// Soft contacts under a thin box: its corners would be pressed through the ground.
#[test]
fn a_thin_box_on_soft_contacts_is_refused() {
    let of = |thickness, time| {
        let thin = Case { size: [0.12, 0.06, thickness], time, ..EVEN };
        let drop = BlockDrop::tilted(thin.block(), 0.05, 0.0, SPEED, GRAVITY).unwrap();
        drop.contacts(&thin.contact(), |_| ())
    };
    let error = of(5e-4, 3e-3).unwrap_err().to_string();
    assert!(
        error.contains("contact time 3 ms: at most 0.") && error.contains("sink in by the smallest size"),
        "{error}"
    );
    // What is told leads to contacts that are short enough.
    let mut time = 3e-3;
    for _ in 0..5 {
        let Err(error) = of(5e-4, time) else { break };
        let told =
            error.to_string().split("at most ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap();
        time = 1e-3 * told;
    }
    assert!(of(5e-4, time).is_ok() && time > 2e-5, "{time}");
}

/// A dashpot jumps, so that it needs no rebound of the ground; a hysteretic contact without any would unload at once.
#[test]
fn the_least_restitution_is_that_of_hysteretic_contacts_alone() {
    let up = |law| {
        let drop = BlockDrop::tilted(EVEN.block(), 0.0, 0.0, SPEED, 0.0).unwrap();
        drop.contacts(&Contact::new(law, 0.0, 4e-4).unwrap(), |_| ()).unwrap().center_m_s / SPEED
    };
    assert!(
        (up(ContactLaw::Hysteretic) - clatter_flight::LEAST_OF_BLOCKS).abs() < 1e-6,
        "{}",
        up(ContactLaw::Hysteretic)
    );
    // Four corners at once are damped by a little less than one: the product goes up with some thousandths.
    assert!(up(ContactLaw::Dashpot) < 0.5 * clatter_flight::LEAST_OF_BLOCKS, "{}", up(ContactLaw::Dashpot));
}

/// Contacts that take time die away and never end: nothing bounds the time.
#[test]
fn rest_is_not_bounded_in_time() {
    let Stop::AtRest { time_bound_s, .. } = EVEN.flight(2.0).stop else { panic!("at rest") };
    assert!(time_bound_s.is_infinite(), "{time_bound_s}");
}

/// Left where a quarter of its largest approach is enough: whatever it does from there on, no press changes a corner's velocity by more.
#[test]
fn what_follows_a_box_that_is_left_is_as_small_as_was_asked() {
    let case = Case { turned: [0.96, 0.28, 0.0, 0.0], e: 0.3, ..EVEN };
    let share = 0.25;
    let left = case.drop().with_enough(share).contacts(&case.contact(), |_| ()).unwrap();
    let Stop::Enough { time_s } = left.stop else { panic!("{:?}", left.stop) };
    let whole = case.flight(10.0);
    let fastest = whole.strikes.iter().map(|strike| -strike.approach_m_s).fold(0.0, f64::max);
    let later: Vec<_> = whole.strikes.iter().filter(|strike| strike.time_s > time_s).collect();
    assert!(!later.is_empty() && matches!(whole.stop, Stop::AtRest { .. }), "{:?}", whole.stop);
    for strike in later {
        assert!(strike.delta_v_m_s.iter().all(|v| v.abs() <= share * fastest), "{strike:?}");
    }
}
