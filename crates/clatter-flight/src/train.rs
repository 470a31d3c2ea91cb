//! The impacts of a drop of any body in order, until it rests or comes to a limit.

use clatter::{Error as Given, PlateImpact, PlateStart};

use crate::contact::{Pose, Press};
use crate::drop::{Drop, Engine};
use crate::{BlockFlight, BlockStrike, Error, Model, Motion, PlateMotion, PlateScene, Stop, Strike};

/// One impact of an end or a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact<'a> {
    /// The point that strikes, by its index in [`Drop::points`].
    pub point: usize,
    /// Time since the first touch.
    pub time_s: f64,
    /// Vertical velocity of the point just before; negative.
    pub approach_m_s: f64,
    /// Jumps of the vertical velocities of all points.
    pub delta_v_m_s: &'a [f64],
    /// Time of parting, where contacts take time; infinite where the point stays down.
    pub until_s: Option<f64>,
}

impl Impact<'_> {
    /// Returns the jump of the vertical velocity at a place, in half-sides from the middle along each side that the body has: linear
    /// along each, as `((1 − s) Δv_a + (1 + s) Δv_b)/2` of a bar.
    #[must_use]
    pub fn delta_v_at(&self, [x, y, z]: [f64; 3]) -> f64 {
        let between = |s: f64, from: f64, to: f64| 0.5 * ((1.0 - s) * from + (1.0 + s) * to);
        let level = |a: f64, b: f64, c: f64, d: f64| between(y, between(x, a, b), between(x, d, c));
        match *self.delta_v_m_s {
            [a, b] => between(x, a, b),
            [a, b, c, d] => level(a, b, c, d),
            [a, b, d, c, over_a, over_b, over_d, over_c] => {
                between(z, level(a, b, c, d), level(over_a, over_b, over_c, over_d))
            }
            _ => f64::NAN,
        }
    }
}

/// The motion of a box at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxEnd {
    /// Time since the first touch.
    pub time_s: f64,
    /// Velocity of the center of mass, along the axes of the world.
    pub velocity_m_s: [f64; 3],
    /// Spin, about the axes of the box.
    pub spin_rad_s: [f64; 3],
}

/// A drop, followed impact by impact: the whole impact train, or what a limit leaves of it.
///
/// # Examples
/// A bar of 140 mm that lands at 5°: its ends strike in turn until it rests.
/// ```
/// use clatter_flight::{Body, Drop, Model, Train};
/// let drop = Drop::new(Body::new(0.14, 0.0404)?, 4.43, 5_f64.to_radians(), 0.3);
/// let train = Train::new(&drop, Model::FiniteTilt, None, None)?;
/// let first: Vec<_> = train.impacts().take(2).map(|impact| drop.points()[impact.point]).collect();
/// assert_eq!((first, train.stop.reason()), (vec!["a", "b"], "at-rest"));
/// # Ok::<(), clatter_flight::Error>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Train {
    /// Why it ends.
    pub stop: Stop,
    /// What the energy of the body has changed by without reason, over that at the first touch; none of instant impacts.
    pub energy_error: Option<f64>,
    /// The time until which it was followed, where that was limited.
    pub time_limit_s: Option<f64>,
    /// Impacts followed at most.
    pub impact_limit: usize,
    course: Course,
}

#[derive(Debug, Clone)]
enum Course {
    Bar(Box<Motion>),
    Plate(Box<PlateMotion>),
    /// A plate by the map, which has straight lines between impacts.
    Map(Vec<PlateImpact>),
    Solid(Box<BlockFlight>),
}

/// Impacts followed at most unless more are asked for, and of a plate by the map, which may go on for ever.
const IMPACTS: usize = 100_000;
const IMPACTS_OF_MAP: usize = 1000;

/// Precision of contacts that take time.
const PRECISION: f64 = 1e-4;

impl Train {
    /// Follows a drop by a model, until a time and for so many impacts at most: 100 000 unless given, of a plate by the map 1000.
    ///
    /// Points and sides count from what touches first: end a or corner a. Feet are taken for the ends or corners, and all contacts for
    /// alike.
    ///
    /// # Errors
    /// [`Error::Instant`] for a plate at real tilt and for a box, without contacts that take time; [`Error::Given`] for a plate by the
    /// map whose mass lies askew, for a limit that is none, and for a drop that none is; others for contacts that the body does not allow.
    pub fn new(
        drop: &Drop,
        model: Model,
        time_limit_s: Option<f64>,
        impact_limit: Option<usize>,
    ) -> Result<Self, Error> {
        let is_mapped = drop.engine() == Engine::Level && model == Model::Map;
        let most = impact_limit.unwrap_or(if is_mapped { IMPACTS_OF_MAP } else { IMPACTS });
        let until_s = time_limit_s.unwrap_or(f64::INFINITY);
        let (course, stop, energy_error) = match (drop.engine(), model, drop.of_level()?) {
            (Engine::Planar, model, _) => {
                let scene = drop.scene()?.with_impact_limit(most)?.with_time_limit_s(until_s)?;
                of_motion(scene.fly(model)?, Course::Bar)
            }
            (Engine::Level, model, Some(scene)) => {
                plate(&scene.with_impact_limit(most).with_time_limit_s(until_s)?, model, drop.restitution)?
            }
            (Engine::Solid, Model::Contacts(contact), _) => {
                let block = drop.block_drop()?.with_impact_limit(most).with_time_limit_s(until_s)?;
                let flight = block.contacts(&contact, |_| ())?;
                let (stop, energy_error) = (flight.stop, Some(flight.energy_error));
                (Course::Solid(Box::new(flight)), stop, energy_error)
            }
            _ => return Err(Error::Instant),
        };
        let time_limit_s = time_limit_s.filter(|limit_s| limit_s.is_finite());
        Ok(Self { stop, energy_error, time_limit_s, impact_limit: most, course })
    }
    /// Returns the number of impacts.
    #[must_use]
    pub fn count(&self) -> usize {
        match &self.course {
            Course::Bar(motion) => motion.strikes.len(),
            Course::Plate(motion) => motion.strikes.len(),
            Course::Map(impacts) => impacts.len(),
            Course::Solid(flight) => flight.strikes.len(),
        }
    }
    /// Returns the impacts from the first on.
    pub fn impacts(&self) -> impl Iterator<Item = Impact<'_>> {
        (0..self.count()).map(|k| match &self.course {
            Course::Bar(motion) => of_strike(&motion.strikes[k], motion.presses.get(k)),
            Course::Plate(motion) => of_strike(&motion.strikes[k], motion.presses.get(k)),
            Course::Map(impacts) => {
                let PlateImpact { corner, time, approach, delta_v, .. } = &impacts[k];
                let point = *corner as usize;
                Impact { point, time_s: *time, approach_m_s: *approach, delta_v_m_s: delta_v, until_s: None }
            }
            Course::Solid(flight) => {
                let BlockStrike { corner, time_s, until_s, approach_m_s, delta_v_m_s, .. } = &flight.strikes[k];
                let (point, until_s) = (*corner, Some(*until_s));
                Impact { point, time_s: *time_s, approach_m_s: *approach_m_s, delta_v_m_s, until_s }
            }
        })
    }
    /// Returns how a box moves where it ends; none of other bodies.
    #[must_use]
    pub fn end(&self) -> Option<BoxEnd> {
        let Course::Solid(flight) = &self.course else { return None };
        let ([x, y], z) = (flight.along_m_s, flight.center_m_s);
        Some(BoxEnd { time_s: flight.stop.time_s(), velocity_m_s: [x, y, z], spin_rad_s: flight.spin_rad_s })
    }
    /// Returns the whole motion of a bar; none of other bodies.
    #[must_use]
    pub fn motion(&self) -> Option<&Motion> {
        if let Course::Bar(motion) = &self.course { Some(motion) } else { None }
    }
}

fn of_strike<'a, const N: usize>(strike: &'a Strike<N>, press: Option<&Press>) -> Impact<'a> {
    let Strike { point, time_s, approach_m_s, delta_v_m_s, .. } = strike;
    let until_s = press.map(|press| press.until_s);
    Impact { point: *point, time_s: *time_s, approach_m_s: *approach_m_s, delta_v_m_s, until_s }
}

/// A motion, why it ends, and its error.
type Followed = (Course, Stop, Option<f64>);

fn of_motion<const N: usize, P: Pose<N>>(motion: Motion<N, P>, course: fn(Box<Motion<N, P>>) -> Course) -> Followed {
    let (stop, energy_error) = (motion.stop, motion.contact().map(|_| motion.energy_error));
    (course(Box::new(motion)), stop, energy_error)
}

fn plate(scene: &PlateScene, model: Model, restitution: f64) -> Result<Followed, Error> {
    let motion = match model {
        Model::Map => return by_map(scene, restitution),
        Model::Ballistic => scene.impacts_until(restitution, |_| false)?,
        Model::Contacts(contact) => scene.contacts_until(&contact, PRECISION, |_| false)?,
        Model::FiniteTilt => return Err(Error::Instant),
    };
    Ok(of_motion(motion, Course::Plate))
}

/// Follows a plate without gravity: straight lines and impulses.
fn by_map(scene: &PlateScene, restitution: f64) -> Result<Followed, Error> {
    let (plate, value) = (scene.plate(), scene.plate().product_of_inertia_m2());
    if value != 0.0 {
        let (name, allowed) = ("product of inertia over the mass in m²", "0 for the map");
        return Err(Given::Quantity { name, value, allowed }.into());
    }
    let ([left, right, front, back], [length, width], [kx, ky]) =
        (plate.edges_m(), plate.sides_m(), plate.gyration_m());
    let center = [(left - right) / length, (front - back) / width];
    let plate = clatter::Plate::off_center([kx / (0.5 * length), ky / (0.5 * width)], center, restitution)?;
    let [a, b, _, d] = scene.corner_velocities();
    let start = PlateStart::new([a, b, d], scene.gaps_m())?;
    let mut impacts: Vec<PlateImpact> = Vec::new();
    let mut train = plate.train(&start);
    let stop = loop {
        let time_s = impacts.last().map_or(0.0, |last| last.time);
        let Some(impact) = train.next() else { break Stop::BouncedClear { time_s } };
        if impact.time > scene.time_limit_s() {
            break Stop::TimeLimit { time_s: scene.time_limit_s() };
        }
        if impacts.len() == scene.impact_limit() {
            break Stop::ImpactLimit { time_s };
        }
        impacts.push(impact);
    };
    Ok((Course::Map(impacts), stop, None))
}
