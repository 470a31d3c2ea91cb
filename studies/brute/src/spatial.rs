//! Random plates and boxes as products, and `clatter assess` beside random drops of them.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::io::Write;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::compare::{SLACK, answer, assess, held, with_room};
use crate::flight::Until;
use crate::ground::Law;
use crate::ground::Own;
use crate::hunt::values;
use crate::part::largest;
use crate::product::{Kind, Suspensions, stops_of};
use crate::random::{self, Random};
use crate::solid::{Solid, Vector, follow};

/// End of the drops.
const UNTIL: Until = Until { time: 0.3, quiet: 2e-2 };
/// Restitution, contact time, speed, tilt, direction, natural frequency, damping, spin, friction, and gap, contact time
/// and restitution of stops, from 0 to 1.
type Sample = [f64; 12];
/// Kinds of products in space.
pub const KINDS: [&str; 8] =
    ["plate", "box", "plate-own-contacts", "spin-plate", "spin-box", "box-own-contacts", "plate-stops", "box-stops"];
type Range = [f64; 2];

/// A part: its place from the center of mass, the axis of its motion (any for a hard one), and its suspension.
struct Part {
    place: Vector,
    axis: Option<usize>,
    suspension: Option<Suspensions>,
    kinds: Vec<Kind>,
}

/// A plate that falls at any tilt of a range, or a box that is turned away from its face, edge or corner.
struct Product {
    solid: Solid,
    law: Law,
    e: Range,
    time: Range,
    speed: Range,
    /// Tilt of a plate from flat, of a box from its attitude.
    tilt: Range,
    direction: Range,
    /// Spin about the axis of the tilt, positive where that grows.
    spin: Range,
    /// Coefficient of friction of a box.
    friction: Range,
    /// Vertical of a box on its face, edge or corner.
    upward: Vector,
    parts: Vec<Part>,
    text: String,
}

fn at(range: Range, share: f64) -> f64 {
    range[0] + (range[1] - range[0]) * share
}

fn round(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// Returns a mass distribution: its text in the file, its center, its radii of gyration along the length and the width,
/// and the mean of x y.
fn spread(r: &mut Random, sides: [f64; 2]) -> (String, [f64; 2], [f64; 2], f64) {
    if r.chance(0.5) {
        let [kx, ky] = sides.map(|side| round(side * r.within(0.22, 0.36)));
        let off = r.chance(0.5);
        let center = sides.map(|side| if off { round(side * r.within(-0.08, 0.08)) } else { 0.0 });
        let text = format!(
            "radius_of_gyration = [\"{kx} m\", \"{ky} m\"]\ncenter_of_mass = [\"{} m\", \"{} m\"]\n",
            center[0], center[1]
        );
        return (text, center, [kx, ky], 0.0);
    }
    // The masses are a case all over, and two parts that are small.
    let [half_x, half_y] = sides.map(|side| 0.5 * side);
    let mut text = format!(
        "masses = [{{ mass = \"1 kg\", from = [\"{} m\", \"{} m\"], to = [\"{half_x} m\", \"{half_y} m\"] }}",
        -half_x, -half_y
    );
    let small: Vec<(f64, [f64; 2])> =
        (0..2).map(|_| (round(r.within(0.05, 0.5)), sides.map(|side| round(side * r.within(-0.4, 0.4))))).collect();
    for (mass, [x, y]) in &small {
        let _ = write!(text, ", {{ mass = \"{mass} kg\", position = [\"{x} m\", \"{y} m\"] }}");
    }
    text.push_str("]\n");
    let all = 1.0 + small.iter().map(|(mass, _)| mass).sum::<f64>();
    let center = [0, 1].map(|i| small.iter().map(|(mass, at)| mass * at[i]).sum::<f64>() / all);
    let mean = |i: usize, j: usize| {
        let case = if i == j { sides[i] * sides[i] / 12.0 } else { 0.0 };
        (case + small.iter().map(|(mass, at)| mass * at[i] * at[j]).sum::<f64>()) / all - center[i] * center[j]
    };
    (text, center, [0, 1].map(|i| mean(i, i).sqrt()), mean(0, 1))
}

impl Product {
    /// Creates a random product and its file, its limits far above any demand.
    fn new(kind: &str, seed: u64) -> Self {
        let number = KINDS.iter().position(|&known| known == kind).unwrap_or(0);
        let r = &mut Random::new(seed.wrapping_mul(64).wrapping_add(number as u64));
        let (is_box, has_own) = (kind.contains("box"), kind.ends_with("own-contacts"));
        let length = round(r.log(0.08, 0.3));
        let width = round(length * r.within(0.3, 1.0));
        let thickness = round(length * if is_box { r.within(0.06, 0.4) } else { r.within(0.03, 0.1) });
        let kz = thickness / 12_f64.sqrt();
        let (mass, center, [kx, ky], askew) = spread(r, [length, width]);
        let e = round(r.within(0.05, 0.5));
        let e = [e, if r.chance(0.5) { round(e * r.within(1.05, 1.3)) } else { e }];
        let law = if r.chance(0.3) && !has_own { Law::Dashpot } else { Law::Hysteretic };
        let time = round(r.log(0.2, 2.0)) * 1e-3;
        let height = round(r.within(0.4, 1.5));
        let named = if law == Law::Dashpot { "dashpot" } else { "hysteretic" };
        let mut text = format!(
            "[product]\nname = \"{kind} {seed}\"\nlength = \"{length} m\"\nwidth = \"{width} m\"\nthickness = \"{thickness} m\"\n\
             {mass}restitution = [{}, {}]\ncontact_time = \"{time} s\"\ncontact_law = \"{named}\"\n",
            e[0], e[1]
        );
        let mut friction = [0.0; 2];
        if is_box {
            let least = if r.chance(0.3) { round(r.within(0.0, 0.5)) } else { 0.0 };
            friction = [least, if r.chance(0.2) { least } else { round(r.within(least, 1.0)) }];
            let _ = writeln!(text, "friction = [{}, {}]", friction[0], friction[1]);
        }
        let mut own = [Own::default(); 4];
        if has_own {
            let list = own_contacts(r, &mut own, time);
            let _ = writeln!(text, "contacts = [{list}]");
        }
        let _ = writeln!(text, "[drop]\nheight = \"{height} m\"");
        let (mut direction, mut upward) = ([0.0, TAU], [0.0, 0.0, 1.0]);
        let tilt: Range;
        if is_box {
            let faces = 1 + (r.unit() * 3.0) as usize;
            let names = [["end-a", "end-b"], ["front", "back"], ["bottom", "top"]];
            let mut axes = [0, 1, 2];
            axes.rotate_left((r.unit() * 3.0) as usize);
            let mut down = [0.0; 3];
            let mut said = Vec::new();
            for &axis in &axes[..faces] {
                let side = usize::from(r.chance(0.5));
                let sign = if side == 1 { 0.5 } else { -0.5 };
                down[axis] = sign * [length, width, thickness][axis] - [center[0], center[1], 0.0][axis];
                said.push(names[axis][side]);
            }
            upward = down.map(|x| -x);
            let tolerance = [round(r.within(0.2, 2.5)), round(r.within(0.5, 5.0))][usize::from(faces > 1)];
            tilt = [0.0, tolerance.to_radians()];
            let key = ["face", "edge", "corner"][faces - 1];
            let _ = writeln!(text, "{key} = \"{}\"\nattitude_tolerance = \"{tolerance} deg\"", said.join(" "));
        } else {
            let from = if r.chance(0.5) { 0.0 } else { round(r.within(0.2, 2.0)) };
            let to = round(r.within(3.0, 12.0));
            tilt = [from, to].map(f64::to_radians);
            let _ = writeln!(text, "tilt = [\"{from} deg\", \"{to} deg\"]");
            if r.chance(0.4) {
                let from = round(r.within(0.0, 300.0));
                direction = [from, from + 40.0].map(f64::to_radians);
                let _ = writeln!(text, "direction = [\"{from} deg\", \"{} deg\"]", from + 40.0);
            }
        }
        let mut solid = Solid {
            sides: [length, width, thickness],
            center: [center[0], center[1], 0.0],
            radii: [ky.hypot(kz), kx.hypot(kz), kx.hypot(ky)],
            askew,
            e: e[0],
            contact: (law, time),
            own,
            speed: 0.0,
            spin: [0.0; 3],
            upward,
            gravity: 9.806_65,
            friction: 0.0,
        };
        let speed = [(2.0 * solid.gravity * height).sqrt(); 2];
        let mut spin = [0.0; 2];
        if kind.starts_with("spin") {
            // The unit is the spin that would turn a corner up, for any corner.
            let far = (0..3).map(|i| 0.5 * solid.sides[i] + solid.center[i].abs()).map(|x| x * x).sum::<f64>().sqrt();
            let shares = [r.within(-0.9, 0.9), r.within(-0.9, 0.9)];
            let [low, high] =
                [shares[0].min(shares[1]), shares[0].max(shares[1])].map(|share| round(share * speed[0] / far));
            let _ = writeln!(text, "spin = [\"{low} rad/s\", \"{high} rad/s\"]");
            spin = [low, high];
        }
        let fall = kind.ends_with("-stops").then_some(speed[1]);
        let parts = (0..2).map(|n| part(r, n, &solid, is_box, fall, &mut text)).collect();
        if !is_box {
            // A plate lands on the corners of its bottom, even in deep dents: those of its top are out of reach.
            solid.sides[2] = length;
            solid.center[2] = 0.5 * (thickness - length);
        }
        Self { solid, law, e, time: [time; 2], speed, tilt, direction, spin, friction, upward, parts, text }
    }

    fn drop(&self, sample: &Sample) -> Solid {
        let (angle, direction) = (at(self.tilt, sample[3]), at(self.direction, sample[4]));
        // These are two axes across the vertical; for a plate the length and the width, so that it rises towards the
        // direction.
        let up = self.upward.map(|x| x / self.upward.iter().map(|x| x * x).sum::<f64>().sqrt());
        let first = if up[2] > 1.0 - 1e-12 { [1.0, 0.0, 0.0] } else { across(up) };
        let second = [
            up[1] * first[2] - up[2] * first[1],
            up[2] * first[0] - up[0] * first[2],
            up[0] * first[1] - up[1] * first[0],
        ];
        let off = |i: usize| direction.cos() * first[i] + direction.sin() * second[i];
        // Where the tilt grows, the vertical turns towards the direction in axes of the box.
        let [u, v, w] = [0, 1, 2].map(off);
        let about = [v * up[2] - w * up[1], w * up[0] - u * up[2], u * up[1] - v * up[0]];
        let spin = at(self.spin, sample[7]);
        Solid {
            e: at(self.e, sample[0]),
            contact: (self.law, at(self.time, sample[1])),
            speed: at(self.speed, sample[2]),
            spin: about.map(|x| spin * x),
            friction: at(self.friction, sample[8]),
            upward: std::array::from_fn(|i| angle.cos() * up[i] + angle.sin() * off(i)),
            ..self.solid
        }
    }
}

/// Returns own contacts at some corners of a plate, softer or harder, livelier or not.
fn own_contacts(r: &mut Random, own: &mut [Own; 4], time: f64) -> String {
    let first = (r.unit() * 4.0) as usize;
    let count = if r.chance(0.6) { 1 } else { 1 + (r.unit() * 4.0) as usize };
    let mut list = Vec::new();
    for k in (0..count).map(|k| (first + k) % 4) {
        let (e, time) = (round(r.within(0.02, 0.6)), round((time * r.log(0.25, 4.0)).min(2.5e-3)));
        let at = ["a", "b", "c", "d"][k];
        own[k] = match r.unit() {
            u if u < 0.25 => Own { e: Some(e), time: None },
            u if u < 0.5 => Own { e: None, time: Some(time) },
            _ => Own { e: Some(e), time: Some(time) },
        };
        let e = own[k].e.map_or(String::new(), |e| format!(", restitution = {e}"));
        let time = own[k].time.map_or(String::new(), |time| format!(", contact_time = \"{time} s\""));
        list.push(format!("{{ at = \"{at}\"{e}{time} }}"));
    }
    list.join(", ")
}

/// Returns an axis across another.
fn across(up: Vector) -> Vector {
    let axis = (0..3).min_by(|&i, &j| up[i].abs().total_cmp(&up[j].abs())).unwrap_or(0);
    let mut first = up.map(|x| -x * up[axis]);
    first[axis] += 1.0;
    let size = first.iter().map(|x| x * x).sum::<f64>().sqrt();
    first.map(|x| x / size)
}

/// Returns a part, and writes it; given the speed of the drop it may have stops.
fn part(r: &mut Random, n: usize, solid: &Solid, is_box: bool, fall: Option<f64>, text: &mut String) -> Part {
    let [x, y] = [0, 1].map(|i| round(solid.sides[i] * r.within(-0.45, 0.45)));
    let z = if is_box { round(solid.sides[2] * r.within(-0.4, 0.4)) } else { 0.0 };
    let _ = writeln!(text, "[[component]]\nname = \"part {n}\"\nposition = [\"{x} m\", \"{y} m\"]");
    let axis = if is_box { (r.unit() * 3.0) as usize } else { 2 };
    let mut part = Part {
        place: [x - solid.center[0], y - solid.center[1], z],
        axis: Some(axis),
        suspension: None,
        kinds: vec![Kind::Acceleration],
    };
    // Only hard parts and their velocity changes depend on the motion of a box across the blow.
    let is_hard = r.chance(match fall {
        Some(_) => 0.1,
        None if is_box => 0.5,
        None => 0.3,
    });
    let any = is_box && is_hard && r.chance(0.3);
    if is_box {
        let _ = writeln!(text, "height = \"{z} m\"\naxis = \"{}\"", if any { "any" } else { ["x", "y", "z"][axis] });
    }
    if any {
        part.axis = None;
    }
    if is_hard {
        text.push_str("mount = \"hard\"\nacceleration_limit = \"9e6 gn\"\nvelocity_change_limit = \"900 m/s\"\n");
        part.kinds.push(Kind::VelocityChange);
    } else {
        let frequency = round(r.log(20.0, 2000.0));
        let frequency = [frequency, if r.chance(0.5) { round(1.2 * frequency) } else { frequency }];
        let zeta = round(r.log(0.02, 0.3));
        let _ = writeln!(
            text,
            "natural_frequency = [\"{} Hz\", \"{} Hz\"]\ndamping_ratio = {zeta}\nacceleration_limit = \"9e6 gn\"\nrattle_space = \"90 m\"",
            frequency[0], frequency[1]
        );
        part.kinds.push(Kind::RattleSpace);
        let mut held = Suspensions { omega: frequency.map(|f| f * TAU), zeta: [zeta; 2], stop: None };
        if let Some(fall) = fall.filter(|_| r.chance(0.9)) {
            let line = random::stops(r, frequency[1], fall);
            held.stop = stops_of(&line);
            text.push_str(&line);
            text.push_str("stop_speed_limit = \"900 m/s\"\n");
            part.kinds.push(Kind::StopSpeed);
        }
        part.suspension = Some(held);
    }
    part
}

/// Returns the largest value of each limit among random drops, half of them close to the worst so far.
fn hunt(product: &Product, drops: usize, r: &mut Random) -> Vec<(usize, Kind, f64, Sample)> {
    let limits = product.parts.iter().enumerate().flat_map(|(n, part)| part.kinds.iter().map(move |&kind| (n, kind)));
    let mut best: Vec<(usize, Kind, f64, Sample)> = limits.map(|(n, kind)| (n, kind, -1.0, [0.5; 12])).collect();
    let mut reach = 0.1;
    for k in 0..drops {
        let spins = product.spin[1] > product.spin[0];
        let stops = product.parts.iter().any(|part| part.suspension.is_some_and(|of| of.stop.is_some()));
        let varies = |i: usize| (i != 7 || spins) && (i < 9 || stops);
        let mut sample: Sample = std::array::from_fn(|i| {
            let end = if i < 9 { 0.15 } else { 0.25 };
            match if varies(i) { r.unit() } else { 0.0 } {
                u if u < end => 0.0,
                u if u > 1.0 - end => 1.0,
                _ => r.unit(),
            }
        });
        // The direction is periodic.
        sample[4] = r.unit();
        if r.chance(0.3) {
            sample[3] *= sample[3];
        }
        if k > drops / 2 {
            let (_, _, _, near) = best[k % best.len()];
            let few = r.chance(0.5);
            sample = std::array::from_fn(|i| match near[i] {
                x if !varies(i) || few && r.chance(0.6) => x,
                x => (x + reach * r.normal()).clamp(0.0, 1.0),
            });
            reach = (reach * 0.995_f64).max(2e-3);
        }
        let course = follow(&product.drop(&sample), UNTIL);
        for (n, part) in product.parts.iter().enumerate() {
            let history = course.at(part.place, part.axis);
            let suspension = part.suspension.map(|of| of.at(sample[5], sample[6], &sample[9..]));
            let (shocks, kinds): (Vec<Kind>, Vec<Kind>) =
                part.kinds.iter().partition(|&&kind| kind == Kind::VelocityChange);
            let shocks = shocks.into_iter().map(|kind| (kind, largest(&course.shocks(part.place, part.axis))));
            for (kind, peak) in kinds.iter().copied().zip(values(&kinds, &history, 0.0, suspension)).chain(shocks) {
                let of = best.iter_mut().find(|of| of.0 == n && of.1 == kind);
                if let Some(of) = of.filter(|of| peak.value > of.2) {
                    (of.2, of.3) = (peak.value, sample);
                }
            }
        }
    }
    best
}

/// Returns the arguments for the same drop in clatter.
fn repeat(product: &Product, part: &Part, sample: &Sample) -> Vec<String> {
    let drop = product.drop(sample);
    let list = |values: Vector| values.map(|x| x.to_string()).join(",");
    let [x, y, z] = drop.upward;
    // This rotation brings the vertical of the box upright.
    let turn = if z > -1.0 + 1e-9 { [1.0 + z, y, -x, 0.0] } else { [0.0, 1.0, 0.0, 0.0] };
    let size = turn.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
    let place: Vector = std::array::from_fn(|i| part.place[i] + drop.center[i]);
    let mut args = vec![
        "respond".to_owned(),
        "--model=compliant".to_owned(),
        format!("--length-m={}", drop.sides[0]),
        format!("--width-m={}", drop.sides[1]),
        format!("--thickness-m={}", drop.sides[2]),
        format!("--gyration-m={}", list(drop.radii)),
        format!("--product-of-inertia-m2={}", drop.askew),
        format!("--center-of-mass-m={}", list(drop.center)),
        format!("--orientation={}", turn.map(|x| (x / size).to_string()).join(",")),
        format!("--e={}", drop.e),
        format!("--speed-m-s={}", drop.speed),
        format!("--spin-rad-s={}", list(drop.spin)),
        format!("--friction={}", drop.friction),
        format!("--contact-time-s={}", drop.contact.1),
        format!("--contact-law={}", if drop.contact.0 == Law::Dashpot { "dashpot" } else { "hysteretic" }),
        format!("--at-m={}", list(place)),
        format!("--axis={}", part.axis.map_or("any", |axis| ["x", "y", "z"][axis])),
    ];
    args.extend(part.suspension.iter().flat_map(|of| held(&of.at(sample[5], sample[6], &sample[9..]))));
    for (k, own) in drop.own.iter().enumerate().filter(|(_, own)| **own != Own::default()) {
        let (e, time) = (own.e.unwrap_or(drop.e), own.time.unwrap_or(drop.contact.1));
        args.push(format!("--contact={},{e},{time}", ["a", "b", "c", "d"][k]));
    }
    args
}

/// Compares products of a [kind](KINDS).
///
/// # Errors
/// Where the command does not run or writes fail.
pub fn compare(
    clatter: &Path,
    kind: &str,
    seeds: RangeInclusive<u64>,
    drops: usize,
    out: &mut dyn Write,
) -> Result<(), String> {
    let [mut limits, mut above, mut passed, mut broken, mut undecided, mut reached, mut unanswered, mut beyond] =
        [0; 8];
    for seed in seeds {
        let product = Product::new(kind, seed);
        let r = &mut Random::new(seed + 177);
        let text = with_room(&product.text, &assess(clatter, &product.text)?, r);
        let told = assess(clatter, &text)?;
        for (n, kind_of, found, sample) in hunt(&product, drops, r) {
            let name = (format!("part {n}"), kind_of.name().to_owned());
            let Some(claimed) = told.get(&name) else { return Err(format!("{kind} {seed}: {name:?} is not told")) };
            limits += 1;
            undecided += usize::from(claimed.verdict == "undecided");
            reached += usize::from(found > 0.95 * claimed.demand);
            passed += usize::from(found > 1.02 * claimed.demand);
            let most = claimed.demand * (1.0 + claimed.uncertainty);
            let is_broken = claimed.verdict == "safe" && found > claimed.allowed * (1.0 + SLACK);
            broken += usize::from(is_broken);
            let is_above = found > most * (1.0 + SLACK);
            unanswered += usize::from(claimed.demand.is_nan());
            above += usize::from(is_above);
            let is_beyond = claimed.is_beyond_bound(found);
            beyond += usize::from(is_beyond);
            let mut line = format!(
                "{kind} {seed}: part {n} {}: {found:.5e}, told {:.5e} + {:.1} % {}, allowed {:.5e}",
                kind_of.name(),
                claimed.demand,
                100.0 * claimed.uncertainty,
                claimed.verdict,
                claimed.allowed
            );
            if is_beyond {
                let _ = write!(line, ", ABOVE ITS BOUND of {:.5e}", claimed.bound);
            }
            if is_above || is_broken || found > 1.02 * claimed.demand {
                let args = repeat(&product, &product.parts[n], &sample);
                let same = answer(clatter, &args, kind_of);
                let _ = write!(
                    line,
                    "{}; the same drop by clatter {}\n  tilt {:.4} deg, direction {:.3} deg\n  clatter {}",
                    if is_broken {
                        ", NOT SAFE"
                    } else if is_above {
                        ", ABOVE"
                    } else {
                        ""
                    },
                    same.map_or("none".to_owned(), |same| format!(
                        "{same:.5e} ({:+.2} %)",
                        100.0 * (same / found - 1.0)
                    )),
                    at(product.tilt, sample[3]) * 180.0 / PI,
                    at(product.direction, sample[4]) * 180.0 / PI,
                    args.join(" ")
                );
            }
            writeln!(out, "{line}").and_then(|()| out.flush()).map_err(|error| error.to_string())?;
        }
    }
    writeln!(
        out,
        "== {kind}: {limits} limits; for {reached} a drop reaches 95 % of what was told, {passed} are passed by 2 %, {above} by more than \
         their uncertainty, {beyond} above their bound, {broken} were told safe and are exceeded; {undecided} undecided, {unanswered} not \
         answered"
    )
    .map_err(|error| error.to_string())
}

/// Returns a random product file of a [kind](KINDS).
#[must_use]
pub fn product(kind: &str, seed: u64) -> String {
    Product::new(kind, seed).text
}
