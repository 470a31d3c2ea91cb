//! The train of a clattering bar drives a component: velocity shocks at a position, and the three-way rule as a
//! spectrum.

use crate::impulse::Run;
use crate::{DampingRatio, Error, Response, Suspension, VelocityShock, VelocityShocks};
use clatter::{Bar, Count, End, Impact, Start};

/// The response of a component at a position of the bar to one clatter.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainResponse {
    /// Peaks, in the units of the bar's start: velocities in v0, times in h0/v0. Interval i begins with impact i + 1.
    pub response: Response,
    /// Velocity shocks at the position, as far as they were followed.
    pub shocks: VelocityShocks,
    /// Bound on the omitted rest of an endless (or very long) train: ωz and z′ are off by at most this, A/ω by at most
    /// max(1, 2ζ) times this. Zero where every impact was followed, and at the center at q = 1, which no shock reaches.
    pub omitted: f64,
}

/// The most impacts that are followed, whatever the bound: the rest is in `omitted`.
const MOST_IMPACTS: usize = 1 << 20;
/// The share of the largest shock below which the rest of an endless train no longer counts: far below one rounding.
const NEGLIGIBLE: f64 = f64::EPSILON / 256.0;

/// Returns the share of the velocity jump of the struck end that reaches a position: ((1−q) ∓ (1+q)s)/2 from a strike
/// at end a or b.
///
/// It is formed from 1 ∓ q, so that it does not cancel near the center of percussion more than the position itself
/// does.
fn share(q: f64, position: f64, end: End) -> f64 {
    let toward = match end {
        End::A => -position,
        End::B => position,
    };
    0.5 * ((1.0 - q) + (1.0 + q) * toward)
}

fn check_position(position: f64) -> Result<(), Error> {
    if (-1.0..=1.0).contains(&position) {
        return Ok(());
    }
    Err(Error::Quantity { name: "position", value: position, allowed: "in [-1, 1]; -1 is the end that strikes first" })
}

/// Returns the response of a component at `position` (−1 is the end that strikes first) to the whole clatter of a
/// symmetric bar.
///
/// Each impact n of [`Bar::train`] is a velocity shock there: the jump of the struck end times ((1−q) ∓ (1+q)s)/2
/// (Eq. 3 of the paper). `suspension` has its ω in units of v0/h0.
///
/// # Endless trains
///
/// They are followed until the sum of all later shocks, bounded by a geometric series, is below ε/256 of the largest.
/// Where the gaps shrink much faster than the shocks (q near 1), the rest falls, to the resolution of time, on one
/// instant: it acts there as the one change of velocity that brings the bar to rest. [`TrainResponse::omitted`] bounds
/// the error of both. At q = 1 the center alone has a limit: no impact moves it, and it stands still in a train of one
/// shock of size zero.
///
/// # Errors
///
/// [`Error::Quantity`] for a position outside [−1, 1]; [`Error::Bar`] for a bar that is not symmetric; [`Error::Unsettled`] for an endless train at q = 1 off center;
/// [`Error::Stop`] for a suspension with a stop: nothing bounds what the omitted shocks do there. The shocks of
/// [`shocks_at`] have a response to it.
///
/// # Examples
///
/// On a soft mount a clatter that ends at rest acts as one change of velocity, v0:
///
/// ```
/// # use clatter::{Bar, Start};
/// # use clatter_shock::{respond, DampingRatio, Suspension};
/// let bar = Bar::new(0.9, 0.2)?;
/// let soft = Suspension::new(1e-6, DampingRatio::new(0.0)?)?;
/// let at_end = respond(&bar, &Start::default(), 1.0, &soft)?;
/// let peak = at_end.response.pseudo_velocity().magnitude();
/// assert!((peak - 1.0).abs() < 1e-6);
/// assert!(at_end.omitted < 1e-17);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn respond(bar: &Bar, start: &Start, position: f64, suspension: &Suspension) -> Result<TrainResponse, Error> {
    suspension.refuse_stop("the response to an endless train")?;
    let (shocks, omitted) = shocks_at(bar, start, position, suspension.omega())?;
    let mut run = Run::new(suspension);
    for shock in shocks.as_slice() {
        run.shock(shock.time, shock.delta_v);
    }
    let response = run.finish(|i| shocks.as_slice()[i].time);
    Ok(TrainResponse { response, shocks, omitted })
}

/// Returns the velocity shocks at a position, and a bound on the omitted ones (see [`respond`]) for components up to
/// the angular frequency `omega_max`.
///
/// # Errors
/// The errors of [`respond`].
pub fn shocks_at(bar: &Bar, start: &Start, position: f64, omega_max: f64) -> Result<(VelocityShocks, f64), Error> {
    check_position(position)?;
    let (q, e) = (bar.symmetric()?.q(), bar.e());
    let at_position = |i: &Impact| -(1.0 + e) * i.approach * share(q, position, i.end);
    if q >= 1.0 && position != 0.0 && bar.count(start) == Count::Endless {
        return Err(Error::Unsettled { position });
    }
    let largest_share = share(q, position.abs(), End::B);
    if largest_share <= 0.0 {
        // No impact moves this position: the first stands for all, which may be endless.
        let first = bar.train(start).next().map(|impact| VelocityShock { time: impact.time, delta_v: 0.0 });
        return Ok((VelocityShocks::new(first.into_iter().collect())?, 0.0));
    }
    // Roots of the recurrence of the approach speeds: ratios of neighbors tend to λ₊ without passing it.
    let t = q * (1.0 + e);
    let discriminant = t * t - 4.0 * e;
    let limit_ratio = 0.5 * (t + discriminant.max(0.0).sqrt());
    let mut list = Vec::new();
    let (mut largest, mut fastest) = (0.0_f64, 0.0_f64);
    let mut previous: Option<Impact> = None;
    let mut train = bar.train(start).peekable();
    let mut closing = 0;
    while let Some(mut impact) = train.next() {
        let delta_v = at_position(&impact);
        if let Some(before) = previous {
            // Strikes closer than the resolution of time may come out of order by a rounding.
            impact.time = impact.time.max(before.time);
        }
        list.push(VelocityShock { time: impact.time, delta_v });
        largest = largest.max(delta_v.abs());
        fastest = fastest.max(-impact.approach);
        let Some(before) = previous.replace(impact) else { continue };
        let ratio = impact.approach / before.approach;
        let bound = ratio.max(limit_ratio);
        let rest = if bound < 1.0 {
            -(1.0 + e) * impact.approach * largest_share * bound / (1.0 - bound)
        } else {
            f64::INFINITY
        };
        if rest <= NEGLIGIBLE * largest {
            return Ok((VelocityShocks::new(list)?, if train.peek().is_some() { rest } else { 0.0 }));
        }
        // Time has run out of digits while the speeds still fall, in constant proportion: two more strikes give both
        // states that the bar alternates between, then one jump brings it to rest.
        let resolution = 4.0 * f64::EPSILON * impact.time;
        let settled = (ratio - limit_ratio).abs() <= 1e-13 * limit_ratio && q < 1.0;
        if discriminant > 0.0 && settled && impact.time - before.time <= resolution {
            closing += 1;
        }
        if closing == 3
            && let Some(next) = train.peek()
        {
            let (struck, other) = (-e * impact.approach, next.approach);
            let toward = if impact.end == End::A { -position } else { position };
            let velocity = 0.5 * ((1.0 + toward) * struck + (1.0 - toward) * other);
            let shrink = e / (limit_ratio * limit_ratio);
            let window = omega_max * resolution / (1.0 - shrink);
            let last = VelocityShock { time: impact.time, delta_v: -velocity };
            return Ok((VelocityShocks::new(list)?.closed_by(last)?, 2.0 * window * -impact.approach));
        }
        if list.len() == MOST_IMPACTS {
            return Ok((VelocityShocks::new(list)?, if train.peek().is_some() { rest } else { 0.0 }));
        }
    }
    Ok((VelocityShocks::new(list)?, 0.0))
}

/// The peaks of a component at rest after one unit of velocity change: the factors that turn a shock into a peak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpulseFactors {
    /// Peak ω|z| / Δv.
    pub displacement: f64,
    /// Peak |A| / (ωΔv): 1 at ζ = 0, 0.931 at 0.05, 2ζ from ζ = ½ on.
    pub acceleration: f64,
}

impl ImpulseFactors {
    /// Returns the peaks ωz and A/ω of one shock of the velocity change `delta_v`, in its unit.
    ///
    /// ```
    /// # use clatter_shock::DampingRatio;
    /// assert_eq!(DampingRatio::new(0.0)?.impulse_factors().times(2.0).acceleration, 2.0);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn times(self, delta_v: f64) -> Self {
        Self { displacement: delta_v * self.displacement, acceleration: delta_v * self.acceleration }
    }
}

impl VelocityShocks {
    /// Returns the peaks ωz and A/ω of a component so soft that all shocks fall within a small part of its period (ω
    /// times the length of the train → 0): the net change of velocity times the impulse factors. The acceleration
    /// passes through the jumps 2ζΔv of the dashpot on the way, so that at strong damping the largest partial sum can
    /// stand above the net.
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, VelocityShock, VelocityShocks};
    /// let shock = |time, delta_v| VelocityShock { time, delta_v };
    /// let shocks = VelocityShocks::new(vec![shock(0.0, 2.0), shock(1.0, -0.5)])?;
    /// let undamped = DampingRatio::new(0.0)?;
    /// assert_eq!(shocks.soft_limit(undamped).displacement, 1.5); // the net change
    /// assert_eq!(shocks.stiff_limit(undamped), None); // shocks add up by phase for ever
    /// assert!(shocks.stiff_limit(DampingRatio::new(1e-9)?).is_some());
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn soft_limit(&self, damping: DampingRatio) -> ImpulseFactors {
        let net = damping.impulse_factors().times(self.net().abs());
        let jump = 2.0 * damping.get() * self.largest_partial_sum();
        ImpulseFactors { acceleration: net.acceleration.max(jump), ..net }
    }
    /// Returns the peaks ωz and A/ω of a component so stiff that it is at rest again before the next shock (ζω times
    /// each gap → ∞): the largest single shock times the impulse factors. `None` at ζ = 0, where nothing comes to rest.
    #[must_use]
    pub fn stiff_limit(&self, damping: DampingRatio) -> Option<ImpulseFactors> {
        (damping.get() > 0.0).then(|| damping.impulse_factors().times(self.largest()))
    }
}

impl DampingRatio {
    /// Returns the peak of one velocity shock: ω|z|/Δv = e^(−ζ acos ζ/β) for ζ < 1, and |A|/(ωΔv).
    ///
    /// ```
    /// # use clatter_shock::DampingRatio;
    /// let factors = DampingRatio::new(0.05)?.impulse_factors();
    /// assert!((factors.acceleration - 0.931).abs() < 5e-4);
    /// assert_eq!(DampingRatio::new(3.0)?.impulse_factors().acceleration, 6.0);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn impulse_factors(self) -> ImpulseFactors {
        let mut run = Run::new(&Suspension::unit(self));
        run.shock(0.0, 1.0);
        let response = run.finish(|_| 0.0);
        ImpulseFactors {
            displacement: response.relative_displacement.magnitude(),
            acceleration: response.absolute_acceleration.magnitude(),
        }
    }
}

/// The paper's three-way rule as one spectrum over Ω = ω h0/v0 (section 4 of the paper: net change, resonance, largest
/// shock).
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// One point for each given Ω.
    pub points: Vec<RulePoint>,
    /// Limit for Ω → 0: the net change of velocity times the impulse factors. The acceleration passes through the jumps
    /// 2ζΔv of the dashpot on the way, so that at strong damping the largest partial sum of the shocks can stand above
    /// the net.
    pub soft: ImpulseFactors,
    /// Limit for ζΩ → ∞: the largest single shock times the impulse factors. The last strikes of an endless train come
    /// within any period, so that its peaks approach the limit only like a small power of 1/Ω. `None` at ζ = 0, where
    /// shocks add up by phase for ever.
    pub stiff: Option<ImpulseFactors>,
    /// The assumption of standards: one shock of 2 v0, times the impulse factors.
    pub standard: ImpulseFactors,
    /// Bound on the omitted rest of an endless train, over all points.
    pub omitted: f64,
}

/// Peaks of one component, in v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RulePoint {
    /// Ω = ω h0/v0.
    pub omega: f64,
    /// Peak of ω|z|/v0.
    pub displacement: f64,
    /// Peak of |A|/(ω v0).
    pub acceleration: f64,
    /// Peak |A| over that of one shock of 2 v0, the clatter-free impact that drop standards assume.
    pub gain: f64,
}

/// Returns the rule for a bar, a position and a damping ratio, at the given Ω. v0 is the speed of the end that strikes
/// first.
///
/// # Errors
/// The errors of [`respond`]; [`Error::Entry`] for an Ω that is not finite and positive; [`Error::Quantity`] for a flat
/// drop (no Ω).
pub fn three_way_rule(
    bar: &Bar,
    start: &Start,
    position: f64,
    damping: DampingRatio,
    omegas: &[f64],
) -> Result<Rule, Error> {
    let (v0, h0) = (-start.velocity()[0], start.height_gap());
    crate::error::positive("height gap", h0)?;
    for (i, &value) in omegas.iter().enumerate() {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::Entry {
                list: "frequencies",
                entry: i + 1,
                name: "omega h0/v0",
                value,
                allowed: "finite and > 0",
            });
        }
    }
    let highest = omegas.iter().fold(0.0_f64, |m, &w| m.max(w));
    let (shocks, omitted) = shocks_at(bar, start, position, highest * v0 / h0)?;
    let standard = damping.impulse_factors().times(2.0);
    let mut points = Vec::with_capacity(omegas.len());
    for &omega in omegas {
        let suspension = Suspension::new(omega * v0 / h0, damping)?;
        let response = shocks.respond(&suspension);
        let acceleration = response.acceleration_over_omega().magnitude() / v0;
        points.push(RulePoint {
            omega,
            displacement: response.pseudo_velocity().magnitude() / v0,
            acceleration,
            gain: acceleration / standard.acceleration,
        });
    }
    Ok(Rule {
        points,
        soft: shocks.soft_limit(damping).times(v0.recip()),
        stiff: shocks.stiff_limit(damping).map(|limit| limit.times(v0.recip())),
        standard,
        omitted: omitted / v0,
    })
}
