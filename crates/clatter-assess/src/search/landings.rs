//! What a product may ask for as it lands again.
//!
//! After it bounced clear how it comes down hangs on every digit of its drop. So it is not followed: a later landing is one in any posture,
//! with any part of the energy left in fall, spin and slide. The worst of those, with all of the energy that any drop of the ranges leaves,
//! stands for every landing that follows, as each leaves less to the next; several in step with a part that hardly forgets would add up, of
//! which the tests found none. It depends on the product and the part alone, and is searched once.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::OnceLock;
use std::sync::atomic::AtomicUsize;

use super::budgets::{CLOSER, LANDING_REACH, LANDING_TRIES, LANDINGS};
use super::found::Candidates;
use super::grid::halton;
use super::ranges::{AXES, CONTACT, Coordinates, Ranges};
use super::{Task, Work, rough_to_rad_s};
use crate::Accuracy;
use crate::assess::{COVERAGE_WHERE_ROUGH, ranges_of};
use crate::engine::PlaceHistory;
use crate::model::follow;
use clatter::End;
use clatter_flight::{Drop, Followed, Until};
use clatter_product::{Error, Limit, Listed, ProductFile};

/// Numbers from 0 to 1 that say how a body lands again: two of its posture, two of the axis of its spin, and how its energy is shared.
const POSTURE: usize = 6;
/// The axes of Halton's sequence that these take, which no input of the ranges has here.
const OF_POSTURE: [usize; POSTURE] = [0, 1, 4, 7, 8, 10];
/// Landings of a bar or of a plate flat on the bottom.
const FLAT_ON_BOTTOM: u32 = 2;
/// Landings of a box flat on a face, and then those on a face of which one edge rests and the other slaps down, as of a box that topples.
const FLAT: u32 = 60;
const ON_FACES: u32 = FLAT + 48;
/// A landing: its posture, and the shares along the axes of the ranges.
type Landing = ([f64; POSTURE], [f64; AXES]);

/// Returns a direction in space of two numbers from 0 to 1.
fn direction([z, turn]: [f64; 2]) -> [f64; 3] {
    let z = 2.0 * z - 1.0;
    let ((sin, cos), across) = (libm::sincos(TAU * turn), (1.0 - z * z).max(0.0).sqrt());
    [across * cos, across * sin, z]
}

/// Returns landing k of a bar or of a plate near level: flat first, as lively as may be with the shortest and the longest contact; then level
/// in one of three, and anywhere.
fn tilted_landing(k: u32) -> Landing {
    if k < FLAT_ON_BOTTOM {
        let mut shares = [1.0; AXES];
        shares[CONTACT] = f64::from(k);
        return ([0.0; POSTURE], shares);
    }
    let (mut posture, shares) = anywhere(k);
    if k.is_multiple_of(3) {
        posture[0] = 0.0;
    }
    (posture, shares)
}

/// Returns landing k of a box: flat on each face first, without and with a slide in four directions, as lively as may be with the shortest and
/// the longest contact; then turning about each edge of each face; then anywhere.
fn landing(k: u32) -> Landing {
    if k < FLAT {
        let mut shares = [1.0; AXES];
        shares[CONTACT] = f64::from(k / 30);
        let slide = k / 6 % 5;
        return ([0.0, 0.0, 0.5, 0.25 * f64::from(slide), 0.0, if slide > 0 { 0.5 } else { 0.0 }], shares);
    }
    if k < ON_FACES {
        let n = k - FLAT;
        let (axis, back) = ((k / 2 + 1 + n / 6 % 2) % 3, f64::from(n / 12 % 2));
        let [z, turn] = match axis {
            0 => [0.5, 0.5 * back],
            1 => [0.5, 0.25 + 0.5 * back],
            _ => [1.0 - back, 0.0],
        };
        let mut shares = [1.0; AXES];
        shares[CONTACT] = f64::from(n / 24);
        // A thin body that turns about one of its edges has a quarter of its energy in its spin.
        return ([0.0, 0.0, z, turn, 0.5, 0.0], shares);
    }
    anywhere(k)
}

/// Returns landing k of those anywhere; a third falls without spin and slide, of a box on each face in turn.
fn anywhere(k: u32) -> Landing {
    let at = |n: usize| halton(n, k + 1);
    let share = |axis: usize| (2.0 * halton(axis, k + 1) - 0.5).clamp(0.0, 1.0);
    let mut posture = OF_POSTURE.map(at);
    if (k / 6).is_multiple_of(3) {
        (posture[4], posture[5]) = (0.0, 0.0);
    }
    (posture, std::array::from_fn(share))
}

/// Returns a landing next to another: try t of a climb, ever closer.
fn next_to((posture, shares): &Landing, t: u32) -> Landing {
    let reach = LANDING_REACH * libm::pow(CLOSER, f64::from(t) / f64::from(LANDING_TRIES));
    let step = |axis: usize| reach * (2.0 * halton(axis, t) - 1.0);
    let posture = std::array::from_fn(|n| {
        let moved = posture[n] + step(OF_POSTURE[n]);
        // Directions go on beyond a whole turn.
        if n == 1 || n == 3 { moved.rem_euclid(1.0) } else { moved.clamp(0.0, 1.0) }
    });
    (posture, std::array::from_fn(|axis| (shares[axis] + step(axis)).clamp(0.0, 1.0)))
}

/// Energies over the mass at which landings are searched: 2^−24 m²/s² to 2^24.
const LEVELS: f64 = 24.0;
/// All of them.
const MOST_LEVELS: usize = 49;

/// The worst landings of a product by one contact law, at each energy that was needed.
#[derive(Debug)]
pub(crate) struct LaterLandings {
    of: [OnceLock<Result<Vec<f64>, Error>>; MOST_LEVELS],
}

impl Default for LaterLandings {
    fn default() -> Self {
        Self { of: std::array::from_fn(|_| OnceLock::new()) }
    }
}

/// Returns the first of these drops with a gravity, of which alone later landings depend.
pub(crate) fn with_gravity(listed: &[Listed], gravity_m_s2: f64) -> usize {
    let same = |one: &Listed| one.drop.gravity_m_s2.to_bits() == gravity_m_s2.to_bits();
    listed.iter().position(same).unwrap_or_default()
}

/// What drops of a box may ask for as it lands again, by its own contact law.
#[derive(Debug)]
pub(crate) struct Landings {
    file: ProductFile,
    /// One for each drop, of which the first with the same gravity counts.
    known: Vec<LaterLandings>,
}

impl Landings {
    /// Returns those of a product; none of one that is no box.
    pub(crate) fn of(file: &ProductFile) -> Option<Self> {
        let known = || file.landings.iter().map(|_| LaterLandings::default()).collect();
        file.is_box().then(|| Self { file: file.clone(), known: known() })
    }
    /// Returns the largest value of each limit of each component, as a share of its least allowed value, in any landing with at most this
    /// energy over the mass and this gravity.
    pub(crate) fn worst(&self, energy_m2_s2: f64, gravity_m_s2: f64) -> Result<Vec<Vec<f64>>, Error> {
        let listed = self.file.listed();
        let number = with_gravity(&listed, gravity_m_s2);
        let ranges = ranges_of(&self.file, &listed[number].drop, listed[number].base, &Accuracy::default());
        let of = |component| Limit::of(component).into_iter().map(move |limit| Task { component, limit });
        let tasks: Vec<Task<'_>> = self.file.components.iter().flat_map(of).collect();
        let work = Work { watch: &|_, _| true, done: AtomicUsize::new(0), all: 1 };
        let mut all = ranges.later_landings(&self.known[number], &tasks, energy_m2_s2, &work)?.into_iter();
        Ok(self.file.components.iter().map(|component| all.by_ref().take(of(component).count()).collect()).collect())
    }
}

impl Ranges<'_> {
    /// Returns the drop of a landing with so much energy; none that is out of its reach.
    fn lands_again(&self, k: u32, (posture, shares): &Landing, energy_m2_s2: f64) -> Option<Drop> {
        let place = Coordinates { first: End::A, flat: false, mirrored: [false; 2], at_m: [0.0; 2], shares: *shares };
        let [z, turn, axis_z, axis_turn, spin, slide] = *posture;
        let up = if k < ON_FACES || k.is_multiple_of(2) {
            // Off a face, most of them by little.
            let (number, side) = if k < ON_FACES { (k / 2, k) } else { (k / 2, k / 18) };
            let (face, side) = ((number % 3) as usize, if side.is_multiple_of(2) { 1.0 } else { -1.0 });
            let off = OFF_FACE * z * z;
            let ((sin, cos), (s, c)) = (libm::sincos(off), libm::sincos(TAU * turn));
            let mut up = [0.0; 3];
            (up[face], up[(face + 1) % 3], up[(face + 2) % 3]) = (side * cos, sin * c, sin * s);
            up
        } else {
            direction([z, turn])
        };
        let drop = self.single(&place);
        if !drop.is_solid() {
            if k < FLAT_ON_BOTTOM {
                return drop.flattened().landing_tilted(0.0, drop.direction_rad, energy_m2_s2, 0.0, 0.0);
            }
            let wide = drop.body.is_wide();
            let steepest = if wide { OFF_FACE } else { FRAC_PI_2 * (1.0 - 1e-9) };
            let towards = if wide { TAU * turn } else { Drop::towards(if turn < 0.5 { End::A } else { End::B }) };
            return drop.landing_tilted(steepest * z * z, towards, energy_m2_s2, spin * spin, TAU * axis_turn);
        }
        let slide = if drop.friction > 0.0 { slide * slide } else { 0.0 };
        let spin = spin * spin * (1.0 - slide);
        // The slide goes where the axis of the spin points.
        let shares = [1.0 - spin - slide, spin, slide];
        drop.landing(up, direction([axis_z, axis_turn]), energy_m2_s2, shares, TAU * axis_turn)
    }

    /// Returns the largest utilization of each task in any landing with this energy over the mass. One after the other, as others wait for it.
    fn worst_landings(&self, tasks: &[Task<'_>], energy_m2_s2: f64, work: &Work<'_>) -> Result<Vec<f64>, Error> {
        // Where one of them is not answered, the worst of all is not known.
        let follow = |k: u32, landing: &Landing| {
            let Some(drop) = self.lands_again(k, landing, energy_m2_s2) else { return Ok(None) };
            let contact_s = drop.contact_times_s().map_or(0.0, |[_, longest]| longest);
            let lands_s = 2.0 * (drop.gap_m() / (2.0 * energy_m2_s2).sqrt() + contact_s);
            let until = if drop.is_solid() { Until::LandsAfter(lands_s) } else { Until::Lands };
            let followed = follow(&drop, self.model, self.tolerance.max(0.02), until)?;
            if followed.is_given_up() { Err(Error::Unfinished) } else { Ok(Some(followed)) }
        };
        let landing = if self.base.is_some() { landing } else { tilted_landing };
        let mut worst: Vec<(f64, u32, Landing)> = vec![(0.0, 0, landing(0)); tasks.len()];
        for k in 0..LANDINGS {
            work.go_on(0)?;
            let landing = landing(k);
            let Some(followed) = follow(k, &landing)? else { continue };
            for (task, worst) in tasks.iter().zip(&mut worst) {
                let asked = self.in_landing(task, &landing, &followed, k)?;
                if asked > worst.0 {
                    *worst = (asked, k, landing);
                }
            }
        }
        for (task, (most, k, best)) in tasks.iter().zip(&mut worst) {
            for t in 1..=LANDING_TRIES {
                work.go_on(0)?;
                let next = next_to(best, t);
                let Some(followed) = follow(*k, &next)? else { continue };
                let asked = self.in_landing(task, &next, &followed, *k)?;
                if asked > *most {
                    (*most, *best) = (asked, next);
                }
            }
        }
        Ok(worst.into_iter().map(|(most, ..)| most).collect())
    }

    /// Returns the largest utilization of each task in any landing with at most this energy over the mass.
    fn later_landings(
        &self,
        known: &LaterLandings,
        tasks: &[Task<'_>],
        energy_m2_s2: f64,
        work: &Work<'_>,
    ) -> Result<Vec<f64>, Error> {
        let level = libm::log2(energy_m2_s2).ceil().clamp(-LEVELS, LEVELS);
        let whole = libm::exp2(level);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let of = known.of[(level + LEVELS) as usize].get_or_init(|| self.worst_landings(tasks, whole, work));
        match of {
            // Speeds, and so what they do, grow as the root of the energy, and a little faster, as some of it lifts the body.
            Ok(worst) => Ok(worst.iter().map(|worst| worst * (energy_m2_s2 / whole).sqrt()).collect()),
            Err(Error::Stopped) => Err(Error::Stopped),
            // What sinks in too deep with so much energy may not with this.
            Err(_) => self.worst_landings(tasks, energy_m2_s2, work),
        }
    }

    /// Returns the utilization of each task that later landings may ask for: what its parts still ring with and the worst landing with the
    /// energy that is left, and no more than all of that energy at once does; 0 where that is no more than the worst that was found.
    pub(super) fn land_again(
        &self,
        all: &Candidates,
        landings: &LaterLandings,
        tasks: &[Task<'_>],
        work: &Work<'_>,
    ) -> Vec<f64> {
        let best = all.best();
        let above = |n: usize, later: f64| if later > best[n] { later } else { 0.0 };
        let by_energy: Vec<f64> = all.later.iter().enumerate().map(|(n, later)| above(n, later.most)).collect();
        // On feet a body may land on an edge beyond them, which is not among the landings.
        let on_feet = self.product.body.feet.is_some();
        if on_feet || by_energy.iter().all(|most| *most == 0.0) || all.energy_m2_s2 == f64::INFINITY {
            return by_energy;
        }
        let searched = match self.later_landings(landings, tasks, all.energy_m2_s2, work) {
            Ok(searched) => searched,
            Err(Error::Stopped) => return vec![f64::INFINITY; tasks.len()],
            Err(_) => return by_energy,
        };
        let of_one = |(n, most): (usize, f64)| {
            let sum = self.in_swing(&tasks[n], all.later[n].rings + searched[n]);
            above(n, most.min((1.0 + COVERAGE_WHERE_ROUGH) * sum))
        };
        by_energy.into_iter().enumerate().map(of_one).collect()
    }

    /// Returns the utilization of a task in a landing, wherever its part may be; of a part with stops the amplitude of its swing.
    fn in_landing(&self, task: &Task<'_>, (_, shares): &Landing, followed: &Followed, k: u32) -> Result<f64, Error> {
        let mut most = 0.0_f64;
        for at_m in task.component.places_m() {
            let place = Coordinates { first: End::A, flat: false, mirrored: [false; 2], at_m, shares: *shares };
            let felt = PlaceHistory::rough(followed, task.place(at_m), rough_to_rad_s(task.component))?;
            if task.hits_stops() {
                // Its stops change that together with what it rings with before.
                most = most.max(Self::swing(task, &place, &felt, k)?);
                continue;
            }
            let asked = self.most(task, &place, &felt, k, Self::frequencies(task, &followed.drop), most)?;
            most = asked.map_or(most, |asked| asked.answer.utilization());
        }
        Ok(most)
    }
}

/// Postures off a face lie within this angle of it: an eighth of a turn.
const OFF_FACE: f64 = TAU / 8.0;

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::*;
    use clatter_product::ContactLaw;

    /// Returns a number from 0 to 1.
    fn random(n: u32, of: u32) -> f64 {
        (0.618_033_988_749_895 * f64::from(n * 37 + of * 101 + n * of) + 0.1 * f64::from(of)).fract()
    }

    /// A box with three parts, of any shape, that lands on a face, an edge or a corner.
    fn product(n: u32) -> ProductFile {
        let x = |of: u32| random(n, of);
        let [length, width] = [120.0 + 100.0 * x(1), 60.0 + 50.0 * x(2)];
        let thickness = 12.0 + 50.0 * x(3);
        let on =
            ["face = \"end-a\"", "face = \"bottom\"", "edge = \"bottom front\"", "corner = \"bottom front end-a\""];
        let mut text = format!(
            "product = {{ name = \"box\", length = \"{length} mm\", width = \"{width} mm\", thickness = \"{thickness} mm\", radius_of_gyration = \
             [\"{} mm\", \"{} mm\"], restitution = {}, contact_time = \"{} ms\", contact_law = \"hysteretic\" }}\n[[drop]]\nheight = \"1 m\"\n{}\n",
            length * (0.25 + 0.05 * x(4)),
            width * (0.25 + 0.05 * x(5)),
            0.1 + 0.5 * x(6),
            0.4 + x(7),
            on[(n % 4) as usize]
        );
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let of = u32::try_from(k).unwrap();
            let mount = if (n + of).is_multiple_of(3) {
                "mount = \"hard\"\nacceleration_limit = \"1000 gn\"".to_owned()
            } else {
                format!(
                    "natural_frequency = \"{} Hz\"\ndamping_ratio = {}\nrattle_space = \"10 mm\"",
                    40.0 + 300.0 * x(8 + of),
                    0.03 + 0.15 * x(11 + of)
                )
            };
            let [along, across] = [x(14 + of) - 0.5, x(17 + of) - 0.5].map(|share| 0.9 * share);
            write!(
                text,
                "[[component]]\nname = \"{axis}\"\nposition = [\"{} mm\", \"{} mm\"]\naxis = \"{axis}\"\n{mount}\n",
                along * length,
                across * width
            )
            .unwrap();
        }
        ProductFile::read(&text, "box.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
    }

    /// A bar or a plate with three parts, of any shape.
    fn near_level(n: u32) -> ProductFile {
        let x = |of: u32| random(n, of);
        let [length, width] = [120.0 + 100.0 * x(1), 60.0 + 50.0 * x(2)];
        let wide = n.is_multiple_of(2);
        let of_width = if wide {
            format!(", width = \"{width} mm\", thickness = \"{} mm\"", 6.0 + 6.0 * x(3))
        } else {
            String::new()
        };
        let gyration = [length * (0.25 + 0.05 * x(4)), width * (0.25 + 0.05 * x(5))];
        let gyration = if wide {
            format!("[\"{} mm\", \"{} mm\"]", gyration[0], gyration[1])
        } else {
            format!("\"{} mm\"", gyration[0])
        };
        let mut text = format!(
            "product = {{ name = \"near level\", length = \"{length} mm\"{of_width}, radius_of_gyration = {gyration}, restitution = {}, \
             contact_time = \"{} ms\", contact_law = \"hysteretic\" }}\ndrop = {{ height = \"1 m\", tilt = [\"0.5 deg\", \"{} deg\"] }}\n",
            0.2 + 0.6 * x(6),
            0.3 + x(7),
            3.0 + 5.0 * x(20)
        );
        for k in 0..3 {
            let mount = if (n + k).is_multiple_of(3) {
                "mount = \"hard\"\nacceleration_limit = \"1000 gn\"".to_owned()
            } else {
                let [hz, damping] = [40.0 + 300.0 * x(8 + k), 0.003 + 0.15 * x(11 + k)];
                format!("natural_frequency = \"{hz} Hz\"\ndamping_ratio = {damping}\nrattle_space = \"10 mm\"")
            };
            let [along, across] = [x(14 + k) - 0.5, x(17 + k) - 0.5].map(|share| 0.9 * share);
            let at = if wide {
                format!("[\"{} mm\", \"{} mm\"]", along * length, across * width)
            } else {
                format!("\"{} mm\"", along * length)
            };
            write!(text, "[[component]]\nname = \"{k}\"\nposition = {at}\n{mount}\n").unwrap();
        }
        ProductFile::read(&text, "near-level.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
    }

    /// Follows drops of a product until it lies: how many parts there are, how many of them are asked for more, as it lands again, than is told,
    /// and how many for half as much.
    fn compare(file: &ProductFile, n: u32, drops: u32) -> [usize; 3] {
        let [mut all, mut more, mut near] = [0; 3];
        let listed = file.listed();
        let ranges = ranges_of(file, &listed[0].drop, listed[0].base, &Accuracy::default());
        let ranges = Ranges { law: ContactLaw::Hysteretic, ..ranges };
        let tasks: Vec<Task<'_>> =
            file.components.iter().map(|component| Task { component, limit: Limit::of(component).remove(0) }).collect();
        let work = Work { watch: &|_, _| true, done: AtomicUsize::new(0), all: 1 };
        let known = LaterLandings::default();
        for k in 1..=drops {
            let place = ranges.spread_out(k);
            let drop = ranges.single(&place);
            let [early, over] = [Until::Lands, Until::Over].map(|until| follow(&drop, ranges.model, 0.02, until));
            let (Ok(early), Ok(over)) = (early, over) else { continue };
            if !early.is_early() {
                continue;
            }
            let landings = ranges.later_landings(&known, &tasks, early.energy_m2_s2(), &work).unwrap();
            for (task, landing) in tasks.iter().zip(landings) {
                let at_m = task.component.places_m()[0];
                let place = Coordinates { at_m, ..place };
                let part = Ranges::part(task, &place).unwrap();
                let felt = |followed| PlaceHistory::new(followed, task.place(at_m)).unwrap();
                let asked =
                    |followed| felt(followed).answer_or_nothing(&task.limit, part.as_ref()).unwrap().utilization();
                let [first, whole] = [&early, &over].map(asked);
                let told = first.max(landing + felt(&early).rings(&task.limit, part.as_ref()));
                all += 1;
                near += usize::from(whole > 0.5 * told && whole > first);
                more += usize::from(whole > told);
                let name = &task.component.name;
                assert!(whole <= (1.0 + COVERAGE_WHERE_ROUGH) * told, "{n}, {k}, {name}: {whole} of {told}");
            }
        }
        [all, more, near]
    }

    /// Adds up what products tell.
    fn sum(of: impl Iterator<Item = [usize; 3]>) -> [usize; 3] {
        of.fold([0; 3], |all, one| [0, 1, 2].map(|k| all[k] + one[k]))
    }

    /// Of 4320 of 60 such products it was 12 that are asked for more, by 10 % at most and once by 42 %, of a demand of 2 % of the limit.
    #[test]
    fn boxes_land_again_as_hard_as_the_worst_of_any() {
        let [all, more, near] = sum((0..8).map(|n| compare(&product(n), n, 16)));
        assert!(100 * more <= all && near >= 10, "{more} of {all} ask for more, {near} for half as much as is told");
    }

    /// The same of bars and of plates near level: of 9600 of 200 products it was none.
    #[test]
    fn bars_and_plates_land_again_as_hard_as_the_worst_of_any() {
        let [all, more, near] = sum((0..16).map(|n| compare(&near_level(n), n, 16)));
        assert!(100 * more <= all && near >= 10, "{more} of {all} ask for more, {near} for half as much as is told");
    }
}
