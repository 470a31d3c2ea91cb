//! A motion as rows over time, for drawing and for tables: every strike, and between strikes as many rows as the curves
//! need.
//!
//! A strike is two rows at one time, just before and just after it, so that no line drawn through the rows rounds a
//! corner. Between strikes an interval is halved until straight lines through the rows are good enough; where the
//! motion is straight, as without gravity, nothing is added.
//!
//! ```
//! use clatter_flight::{Profile, Model, Scene};
//! let scene = Scene::new(Profile::new(0.14, 0.04)?, 0.3, 4.43, 5.0, 9.81)?;
//! let motion = scene.fly(Model::Map)?;
//! let rows: Vec<_> = motion.rows().collect();
//! assert_eq!(rows.len(), 2 * motion.strikes.len() + 1); // straight lines, until it has bounced clear
//! assert_eq!(rows[0].velocity_m_s, [-4.43, -4.43]);
//! assert!((rows[1].velocity_m_s[0] - 0.3 * 4.43).abs() < 1e-15);
//! # Ok::<(), clatter_flight::Error>(())
//! ```

use crate::contact::{Phases, Planar};
use crate::motion::Course;
use crate::{Motion, Scene, Stop, Strike};

/// The body at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Time since the first touch.
    pub time_s: f64,
    /// Heights of ends a and b; negative where a compliant contact is compressed.
    pub height_m: [f64; 2],
    /// Vertical velocities of ends a and b.
    pub velocity_m_s: [f64; 2],
    /// Accelerations and forces of contacts that take time; none where impacts are instant.
    pub forces: Option<Forces>,
}

/// Accelerations and forces at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forces {
    /// Vertical accelerations of ends a and b, gravity included.
    pub acceleration_m_s2: [f64; 2],
    /// Forces of the ground on ends a and b over the mass of the body.
    pub force_per_mass_m_s2: [f64; 2],
}

impl Row {
    /// Returns the vertical velocity at position `s` in [−1, 1] along the body (−1 is end a).
    #[must_use]
    pub fn velocity_at(&self, s: f64) -> f64 {
        between(self.velocity_m_s, s)
    }
}

impl Forces {
    /// Returns the vertical acceleration at position `s` in [−1, 1] along the body (−1 is end a).
    #[must_use]
    pub fn acceleration_at(&self, s: f64) -> f64 {
        between(self.acceleration_m_s2, s)
    }
}

fn between([a, b]: [f64; 2], s: f64) -> f64 {
    0.5 * ((1.0 - s) * a + (1.0 + s) * b)
}

/// A straight line through two neighboring rows is off, in the middle between them, by at most this share of the larger
/// of the two ends' values there, for each of height, velocity, acceleration and force.
pub const STRAIGHT: f64 = 1.0 / 1000.0;

/// The most halvings of an interval: a kink ends in an interval this many powers of two shorter.
const HALVINGS: u32 = 12;

/// The least number of rows of a compliant contact, over the time that a lone one takes.
const PULSE: u32 = 16;

impl Motion {
    /// Returns both ends at a time since the first touch, just after the events at that time; beyond the end of the
    /// motion the body stays at rest, or goes on as it was.
    ///
    /// # Accuracy
    /// For instant impacts it is exact in flight, and to 1e−9 of the length while the body turns about an end that
    /// lies.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Row {
        match &self.course {
            Course::Impacts(scene) => {
                let (height_m, velocity_m_s) = self.ends_of_impacts(scene, time_s);
                Row { time_s, height_m, velocity_m_s, forces: None }
            }
            Course::Contacts(phases) => {
                let sample = phases.sample(time_s);
                let forces = Forces {
                    acceleration_m_s2: sample.acceleration_m_s2,
                    force_per_mass_m_s2: sample.force_per_mass_m_s2,
                };
                Row { time_s, height_m: sample.height_m, velocity_m_s: sample.velocity_m_s, forces: Some(forces) }
            }
        }
    }

    /// Returns the rows of the motion.
    ///
    /// They go on until the body lies still or the limit is reached. After a body has bounced clear they continue for a
    /// seventh of the whole time, after one has come to rest on its springs for two contact times. A touch of contacts
    /// that take time is two rows at one time too, because a dashpot's force begins with a jump.
    ///
    /// # Accuracy
    /// At a strike it is that of the model, between strikes that of [`at`](Self::at). Straight lines between the rows
    /// keep [`STRAIGHT`].
    #[must_use]
    pub fn rows(&self) -> Box<dyn Iterator<Item = Row> + '_> {
        match &self.course {
            Course::Impacts(scene) => Box::new(self.rows_of_impacts(scene)),
            Course::Contacts(phases) => Box::new(self.rows_of_contacts(phases)),
        }
    }

    fn rows_of_impacts(&self, scene: &Scene) -> impl Iterator<Item = Row> + '_ {
        let at = |time_s: f64| self.at(time_s);
        let end = at(self.drawn_until_s(scene));
        let strikes = &self.strikes;
        let first = strikes.iter().take(1).map(before);
        first.chain(strikes.iter().enumerate().flat_map(move |(i, strike)| {
            let from = after(strike);
            let to = strikes.get(i + 1).map_or(end, before);
            let mut rows = vec![from];
            let inside = |t: &f64| from.time_s < *t && *t < to.time_s;
            let past = self.pivots.partition_point(|p| p.until_s <= from.time_s);
            let pivots = self.pivots[past..].iter().take_while(|p| p.from_s < to.time_s);
            let mut last = from;
            for knot in pivots.flat_map(|p| [p.from_s, p.until_s]).filter(inside).map(at) {
                refine(&last, &knot, &at, HALVINGS, &mut rows);
                rows.push(knot);
                last = knot;
            }
            refine(&last, &to, &at, HALVINGS, &mut rows);
            rows.push(to);
            rows
        }))
    }

    /// Returns the end of the rows of instant impacts.
    fn drawn_until_s(&self, scene: &Scene) -> f64 {
        match self.stop {
            // A seventh more; where all strikes fall on one instant, the time of a fall through the gap or the length.
            Stop::BouncedClear { time_s } if time_s > 0.0 => time_s * (8.0 / 7.0),
            Stop::BouncedClear { .. } => {
                let gap = scene.height_gap_m();
                (if gap > 0.0 { gap } else { scene.body().length_m() }) / scene.speed_m_s()
            }
            stop => stop.time_s(),
        }
    }

    fn rows_of_contacts(&self, phases: &Phases<2, Planar<2>>) -> impl Iterator<Item = Row> + '_ {
        let at = |time_s: f64| self.at(time_s);
        let contact_time_s = phases.longest_s();
        let end = self.stop.time_s()
            + match self.stop {
                Stop::AtRest { .. } => 2.0 * contact_time_s,
                Stop::BouncedClear { time_s } => (time_s / 7.0).max(contact_time_s),
                _ => 0.0,
            };
        let mut knots = vec![0.0, end];
        for (strike, press) in self.strikes.iter().zip(&self.presses) {
            let step = phases.contacts[strike.point].time_s() / f64::from(PULSE);
            for from in [press.from_s, press.until_s].into_iter().filter(|t| t.is_finite()) {
                knots.extend((0..=PULSE).map(|k| from + f64::from(k) * step));
            }
        }
        knots.extend(self.phases_s());
        knots.retain(|t| (0.0..=end).contains(t));
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let mut touches = self.strikes.iter().map(|s| s.time_s).peekable();
        let mut last: Option<Row> = None;
        knots.into_iter().flat_map(move |t| {
            let mut rows = Vec::new();
            let touch = touches.next_if(|touch| *touch <= t).is_some();
            while touches.next_if(|touch| *touch <= t).is_some() {}
            let row = at(t);
            if let Some(from) = last {
                let to = if touch { Row { time_s: t, ..at(t.next_down()) } } else { row };
                refine(&from, &to, &at, HALVINGS, &mut rows);
                rows.extend(touch.then_some(to));
            }
            rows.push(row);
            last = Some(row);
            rows
        })
    }
}

fn before(strike: &Strike) -> Row {
    let velocity_m_s = [0, 1].map(|i| strike.velocity_m_s[i] - strike.delta_v_m_s[i]);
    Row { velocity_m_s, ..after(strike) }
}

fn after(strike: &Strike) -> Row {
    let (time_s, height_m, velocity_m_s) = (strike.time_s, strike.height_m, strike.velocity_m_s);
    Row { time_s, height_m, velocity_m_s, forces: None }
}

/// Adds rows between two others, so that straight lines through all of them are good to [`STRAIGHT`].
fn refine(from: &Row, to: &Row, at: &impl Fn(f64) -> Row, halvings: u32, rows: &mut Vec<Row>) {
    let middle = 0.5 * (from.time_s + to.time_s);
    if halvings == 0 || middle <= from.time_s || middle >= to.time_s {
        return;
    }
    let middle = at(middle);
    if straight(from, &middle, to) {
        return;
    }
    refine(from, &middle, at, halvings - 1, rows);
    rows.push(middle);
    refine(&middle, to, at, halvings - 1, rows);
}

fn straight(from: &Row, middle: &Row, to: &Row) -> bool {
    let near = |a: [f64; 2], m: [f64; 2], b: [f64; 2]| {
        let largest = [a, m, b].into_iter().flatten().fold(0.0, |large: f64, x| large.max(x.abs()));
        (0..2).all(|i| (m[i] - 0.5 * (a[i] + b[i])).abs() <= STRAIGHT * largest)
    };
    let pressed = match (&from.forces, &middle.forces, &to.forces) {
        (Some(a), Some(m), Some(b)) => {
            near(a.acceleration_m_s2, m.acceleration_m_s2, b.acceleration_m_s2)
                && near(a.force_per_mass_m_s2, m.force_per_mass_m_s2, b.force_per_mass_m_s2)
        }
        _ => true,
    };
    pressed
        && near(from.height_m, middle.height_m, to.height_m)
        && near(from.velocity_m_s, middle.velocity_m_s, to.velocity_m_s)
}
