//! The statements the paper makes about its results, each measured.

use clatter::design::DESIGNS;
use clatter::{Axis, Bar, Count, End, Error, Map, Mass, Quantity, Start, Summary};

use crate::contour::{self, SafeZone};

/// The truth of a statement in the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// True as stated.
    Holds,
    /// True with the exception in the remark.
    InPart,
    /// Not true.
    Fails,
}

impl Verdict {
    /// Returns `Holds` if `all`, else `InPart` if `some`, else `Fails`.
    pub(crate) fn of(all: bool, some: bool) -> Self {
        match (all, some) {
            (true, _) => Self::Holds,
            (false, true) => Self::InPart,
            (false, false) => Self::Fails,
        }
    }
}

/// The kind of a measured figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number, in v₀, v₀/L, h₀/v₀ or none of these, as `what` says.
    Number,
    /// A whole number.
    Count,
    /// A part of a whole, 0 to 1: of the design plane, of the bar, of a line.
    Share,
}

/// One measured figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The measured quantity.
    pub what: &'static str,
    /// The figure.
    pub value: f64,
    /// Kind of the figure.
    pub kind: Kind,
    /// Bound on its error beyond rounding: 0 for closed forms, else that of the quadrature or the grid.
    pub error: f64,
}

/// One statement, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// Place of the statement in the paper.
    pub place: &'static str,
    /// The statement, in our words.
    pub statement: &'static str,
    /// The measured figures.
    pub measured: Vec<Measured>,
    /// The answer.
    pub verdict: Verdict,
    /// The exception, or the basis of the answer.
    pub remark: &'static str,
}

/// Points of a side of the grid on which monotonicity is measured.
const GRID: usize = 401;
/// A neighbor that differs by less than this part of itself is level: 1000 times the allowed error of a peak.
const LEVEL: f64 = 1e-10;

pub(crate) fn number(what: &'static str, value: f64) -> Measured {
    Measured { what, value, kind: Kind::Number, error: 0.0 }
}
pub(crate) fn count(what: &'static str, value: f64) -> Measured {
    Measured { what, value, kind: Kind::Count, error: 0.0 }
}
fn share(what: &'static str, value: f64, error: f64) -> Measured {
    Measured { what, value, kind: Kind::Share, error }
}
pub(crate) fn part(what: &'static str, value: f64) -> Measured {
    share(what, value, 0.0)
}
fn area(what: &'static str, integral: clatter::Integral) -> Measured {
    share(what, integral.value, integral.error)
}

/// Peak at the ends, count and final state over the unit square.
struct Plane {
    q: Axis,
    e: Axis,
    peak: Vec<f64>,
    impacts: Vec<f64>,
    duration: Vec<f64>,
}

/// The trend of a quantity from one grid point to the next along one axis.
struct Trend {
    /// Share of the steps that rise, and that fall.
    rises: f64,
    falls: f64,
}

impl Plane {
    fn compute() -> Result<Self, Error> {
        let (q, e) = (Axis::q(0.0, 1.0, GRID)?, Axis::e(0.0, 1.0, GRID)?);
        let map = |quantity| Ok::<_, Error>(Map::compute(quantity, q, e)?.values);
        Ok(Self {
            q,
            e,
            peak: map(Quantity::PeakEnd)?,
            impacts: map(Quantity::Impacts)?,
            duration: map(Quantity::Duration)?,
        })
    }

    /// Returns all (q, e, peak at the ends), e fastest.
    fn points(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        self.peak.iter().enumerate().map(|(i, &p)| (self.q.value(i / GRID), self.e.value(i % GRID), p))
    }

    /// Returns the safe zone of `threshold` over the plane, not clipped.
    fn zone(&self, threshold: f64) -> Vec<f64> {
        self.points().map(|(q, _, p)| (2.0 * threshold / p + q - 1.0) / (1.0 + q)).collect()
    }

    /// Returns the largest shock at the center over the plane; 0 at q = 1.
    fn center(&self) -> Vec<f64> {
        self.points().map(|(q, _, p)| if q < 1.0 { 0.5 * (1.0 - q) * p } else { 0.0 }).collect()
    }

    /// Returns the share of the steps along e.
    fn along_e(values: &[f64]) -> Trend {
        let steps = values.chunks(GRID).flat_map(|line| line.windows(2).map(|w| (w[0], w[1])));
        Trend::of(steps)
    }

    /// Returns the share of the steps along q, where `within` holds at both ends.
    fn along_q(values: &[f64], within: impl Fn(f64) -> bool) -> Trend {
        let steps = values.iter().zip(values.iter().skip(GRID)).map(|(a, b)| (*a, *b));
        Trend::of(steps.filter(|(a, b)| within(*a) && within(*b)))
    }
}

impl Trend {
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    fn of(steps: impl Iterator<Item = (f64, f64)>) -> Self {
        let (mut rises, mut falls, mut all) = (0usize, 0usize, 0usize);
        for (a, b) in steps {
            let level = LEVEL * a.abs().min(b.abs()).max(LEVEL);
            rises += usize::from(b > a + level);
            falls += usize::from(b < a - level);
            all += 1;
        }
        let all = all.max(1) as f64;
        Self { rises: rises as f64 / all, falls: falls as f64 / all }
    }
}

fn summary(q: f64, e: f64) -> Result<Summary, Error> {
    Ok(Bar::new(q, e)?.summary(&Start::default()))
}

fn zone(design: [f64; 2], threshold: f64) -> Result<f64, Error> {
    let [q, e] = design;
    Ok(Bar::new(q, e)?.shocks_either(&Start::default()).safe_zone(threshold).s)
}

pub(crate) fn smallest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the point where a condition that is false at `a` and true at `b` turns, to the last bit.
pub(crate) fn turn(mut a: f64, mut b: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while (b - a).abs() > f64::EPSILON * b.abs().max(a.abs()) {
        let middle = 0.5 * (a + b);
        *(if holds(middle) { &mut b } else { &mut a }) = middle;
    }
    b
}

/// Returns every statement of the paper about these results, measured; for q and e in [0, 1] unless the claim says
/// otherwise.
///
/// Areas are exact where a closed form exists, else by quadrature along exact curves. Monotonicity is measured
/// step by step on a 401 × 401 grid; there, "share" counts steps.
///
/// ```
/// use clatter_studies::paper::{Verdict, claims};
/// let fails: Vec<_> = claims()?.into_iter().filter(|claim| claim.verdict == Verdict::Fails).collect();
/// assert_eq!(fails[0].place, "Fig. 5"); // three eighths of the plane, not half
/// # Ok::<(), clatter::Error>(())
/// ```
///
/// # Errors
/// None in practice: all bars are valid. [`Error::TooLarge`] without memory for the grid.
pub fn claims() -> Result<Vec<Claim>, Error> {
    let plane = Plane::compute()?;
    let groups =
        [counts(&plane)?, percussion()?, peaks(&plane)?, half(&plane), one(&plane), two(&plane), designs(&plane)?];
    Ok(groups.into_iter().flatten().collect())
}

/// Returns the claims about Fig. 2.
fn counts(plane: &Plane) -> Result<Vec<Claim>, Error> {
    let at = |n| contour::area_up_to(n).value;
    let shares = [at(2), at(3) - at(2), at(4) - at(3), at(5) - at(4)];
    let endless = std::f64::consts::PI - 3.0;
    let fewest = smallest(plane.impacts.iter().copied());
    let outside = if summary(-0.5, 1.0)?.count == Count::Finite(1) { 1.0 } else { 2.0 };
    let (with_q, with_e) = (Plane::along_q(&plane.impacts, |_| true), Plane::along_e(&plane.impacts));

    let fits = |q: f64, e: f64, n: u64| summary(q, e).is_ok_and(|s| matches!(s.count, Count::Finite(m) if m <= n));
    let uniform_three = turn(0.0, 1.0, |e| fits(0.5, e, 3));
    let reference = summary(0.5, 0.3)?.count;

    let mut off = 0.0f64;
    for point in &contour::endless(64)[1..64] {
        let endless = |q: f64| summary(q, point.e).is_ok_and(|s| s.count == Count::Endless);
        off = off.max((turn(0.0, 1.0, endless) - point.q).abs());
    }

    let resting = plane.impacts.iter().zip(&plane.duration).filter(|(n, _)| n.is_infinite()).map(|(_, t)| *t);
    let longest = largest(resting);
    let unsettled = summary(1.0, 0.3)?.final_velocity.is_none();
    let rest = summary(0.9, 0.1)?.final_velocity == Some([0.0, 0.0]);
    Ok(vec![
        Claim {
            place: "Fig. 2",
            statement: "A clatter has two impacts or more.",
            measured: vec![count("fewest, 0 ≤ q ≤ 1", fewest), count("at (−0.5, 1)", outside)],
            verdict: Verdict::of(fewest >= 2.0 && outside >= 2.0, fewest >= 2.0),
            remark: "True for q ≥ 0. With mass beyond the ends, q ≤ −1/(1 + e), a single impact ends it.",
        },
        Claim {
            place: "Fig. 2",
            statement: "High restitution and high moment of inertia give the fewest impacts.",
            measured: vec![
                part("plane with two", shares[0]),
                part("steps in q that lose an impact", with_q.falls),
                part("steps in e that gain one", with_e.rises),
            ],
            verdict: Verdict::of(with_q.falls == 0.0 && with_e.rises == 0.0, with_e.rises < 0.01),
            remark: "Where q = 0 there are two whatever the restitution.",
        },
        Claim {
            place: "Fig. 2",
            statement: "The region of three impacts dominates.",
            measured: vec![
                area("three", clatter::Integral { value: shares[1], error: contour::area_up_to(3).error }),
                part("two", shares[0]),
                part("four", shares[2]),
                part("five", shares[3]),
                part("endless", endless),
            ],
            verdict: Verdict::of(shares[1] > 0.5, largest([shares[0], shares[2], shares[3], endless]) < shares[1]),
            remark: "It is the largest region but not the greater part of the plane.",
        },
        Claim {
            place: "Fig. 2",
            statement: "The three-impact region holds the usual, nearly uniform mass distributions.",
            measured: vec![
                part("line q = 0.5 with three", 1.0 - uniform_three),
                number("three from e", uniform_three),
                count(
                    "at (0.5, 0.3)",
                    match reference {
                        Count::Finite(4) => 4.0,
                        _ => f64::NAN,
                    },
                ),
            ],
            verdict: Verdict::of(uniform_three <= 0.3, uniform_three < 1.0),
            remark: "For the bouncier ones only: the paper's own reference design has four impacts.",
        },
        Claim {
            place: "Fig. 2",
            statement: "The endless region is bounded by q = 2√e/(1 + e).",
            measured: vec![number("largest distance in q at 63 points", off)],
            verdict: Verdict::of(off < 4.0 * f64::EPSILON, false),
            remark: "To the last digit; the curve itself is endless.",
        },
        Claim {
            place: "Fig. 2",
            statement: "Endless clatter takes a significant part of the plane.",
            measured: vec![part("area, π − 3", endless)],
            verdict: Verdict::of(endless > 0.1, endless > 0.01),
            remark: "About one seventh.",
        },
        Claim {
            place: "Fig. 2",
            statement: "Endless trains end within finite time and the bar stays down.",
            measured: vec![number("longest, in h₀/v₀", longest)],
            verdict: Verdict::of(longest.is_finite() && rest && !unsettled, longest.is_finite() && rest),
            remark: "At q = 1 alone the time is finite but the massless ends do not come to rest.",
        },
    ])
}

/// Returns the claims of sections 3 and 5: centers of percussion and the shocks along the bar.
fn percussion() -> Result<Vec<Claim>, Error> {
    let q = |masses: &[Mass]| Bar::from_masses(1.0, masses, 0.3).map(|bar| bar.q());
    let mass = |position_m| Mass::Point { mass_kg: 1.0, position_m };
    let (ends, point) = (q(&[mass(-0.5), mass(0.5)])?, q(&[mass(0.0)])?);
    let uniform = q(&[Mass::Slab { mass_kg: 1.0, from_m: -0.5, to_m: 0.5 }])?;
    let (mut still, mut moved, mut linear, mut safest) = (0.0f64, 0.0f64, 0.0f64, Vec::new());
    for [q, e] in DESIGNS {
        let bar = Bar::new(q, e)?;
        let start = Start::default();
        let train: Vec<_> = bar.train(&start).collect();
        let cp = bar.percussion(End::A);
        let peak = |end: End, s: f64| largest(train.iter().filter(|i| i.end == end).map(|i| i.delta_v_at(s).abs()));
        still = still.max(peak(End::A, cp));
        moved = moved.max(largest([peak(End::B, cp), peak(End::A, -cp)]) / bar.summary(&start).peak.center);
        for k in 0..=8u8 {
            let s = f64::from(k) / 8.0;
            let either = largest([End::A, End::B].map(|end| peak(end, s).max(peak(end, -s))));
            linear = linear.max((either - bar.shocks_either(&start).at(s)).abs());
        }
        // both straight lines |Δv| over s, from odd and from even impacts, cross where the larger is least
        let (odd, even) = (peak(End::A, -1.0), peak(End::B, 1.0));
        safest.push(bar.percussion(End::A) * (odd - even) / (odd + even));
    }
    Ok(vec![
        Claim {
            place: "Sect. 3",
            statement: "Mass at the ends, a uniform bar and mass at the center have q = 0, 0.5 and 1.",
            measured: vec![
                number("q of equal masses at the ends", ends),
                number("q of a uniform slab", uniform),
                number("q of a mass at the center", point),
            ],
            verdict: Verdict::of(ends == 0.0 && (uniform - 0.5).abs() <= f64::EPSILON && point >= 1.0, false),
            remark: "",
        },
        Claim {
            place: "Sect. 5",
            statement: "An impact leaves its center of percussion unshaken; one at the other end shakes it well.",
            measured: vec![
                number("largest at Rₐ from end a, in v₀", still),
                number("from the other end, over the center's", moved),
            ],
            verdict: Verdict::of(still < 1e-14 && moved > 1.5, still < 1e-14),
            remark: "The other end's impacts shake it with (1 − q) times the peak, twice what the center gets.",
        },
        Claim {
            place: "Sect. 5",
            statement: "Shocks are greatest at the ends, least at the center and linear between.",
            measured: vec![number("largest departure of Eq. 4 from the trains, in v₀", linear)],
            verdict: Verdict::of(linear < 1e-13, false),
            remark: "If either end may strike first.",
        },
        Claim {
            place: "Sect. 5",
            statement: "The center is the safest place.",
            measured: vec![
                number("safest s if end a strikes first, (0.5, 0.3)", safest[0]),
                number("the same, (0.73, 0.2)", safest[1]),
            ],
            verdict: Verdict::of(safest.iter().all(|s| s.abs() < 1e-9), true),
            remark: "If either end may strike first. If the first end is known, a place beside the center is safer.",
        },
    ])
}

/// Returns the claims of section 5, Figs. 3 and 4.
fn peaks(plane: &Plane) -> Result<Vec<Claim>, Error> {
    let center = plane.center();
    let (end_q, end_e) = (Plane::along_q(&plane.peak, |_| true), Plane::along_e(&plane.peak));
    let (mid_q, mid_e) = (Plane::along_q(&center, |_| true), Plane::along_e(&center));
    let ratio = |q: f64| summary(q, 0.3).map(|s| s.peak.center / s.peak.end);
    let (sharpest, negative) = (ratio(0.0)?, ratio(-0.5)?);
    let top = largest(center.iter().copied());
    let over_flat = largest(plane.points().zip(&center).map(|((_, e, _), c)| c / (1.0 + e)));
    let under_flat = smallest(plane.points().map(|(_, e, p)| p / (1.0 + e)));

    // one-sided slopes of the peak along e = 1 where impact 2 hands over to impact 3
    let crease = std::f64::consts::FRAC_1_SQRT_2;
    let slope = |a: f64, b: f64| Ok::<_, Error>((summary(b, 1.0)?.peak.end - summary(a, 1.0)?.peak.end) / (b - a));
    let bend = slope(crease + 1e-9, crease + 1e-6)? / slope(crease - 1e-6, crease - 1e-9)?;
    let (far, near) = (summary(0.9, 0.3)?.peak, summary(0.1, 0.3)?.peak);
    Ok(vec![
        Claim {
            place: "Sects. 1, 5",
            statement: "Clatter shakes parts more, and others less, than a clatter-free impact would.",
            measured: vec![
                number("least at the ends, over (1 + e) v₀", under_flat),
                number("most at the center, over (1 + e) v₀", over_flat),
            ],
            verdict: Verdict::of(under_flat >= 1.0 && over_flat < 1.0, true),
            remark: "Everywhere: the ends never get less (equal at q = 0), the center never more than 9/16 of it.",
        },
        Claim {
            place: "Sect. 5",
            statement: "The center's shock is at most half of the largest.",
            measured: vec![number("ratio at q = 0", sharpest), number("ratio at q = −0.5", negative)],
            verdict: Verdict::of(negative <= 0.5, sharpest <= 0.5),
            remark: "True for q ≥ 0. With mass beyond the ends it is more.",
        },
        Claim {
            place: "Fig. 4",
            statement: "At the ends the shock grows with q and with e.",
            measured: vec![part("steps in q that fall", end_q.falls), part("steps in e that fall", end_e.falls)],
            verdict: Verdict::of(end_q.falls + end_e.falls == 0.0, true),
            remark: "In q it follows from the recurrence: each ratio of neighbors grows with T = q(1 + e).",
        },
        Claim {
            place: "Fig. 4",
            statement: "At the center it does not.",
            measured: vec![
                part("steps in q that rise", mid_q.rises),
                part("steps in q that fall", mid_q.falls),
                number("largest, in v₀", top),
            ],
            verdict: Verdict::of(mid_q.rises > 0.0 && mid_q.falls > 0.0, false),
            remark: "It rises up to q = e/(2(1 + e)), area (1 − ln 2)/2 of the plane, and is largest at (0.25, 1).",
        },
        Claim {
            place: "Figs. 3, 4",
            statement: "Ends, quarter points, center and rotation: every shock falls as e falls.",
            measured: vec![part("steps of e against it, ends", end_e.falls), part("center", mid_e.falls)],
            verdict: Verdict::of(end_e.falls + mid_e.falls == 0.0, end_e.falls < 0.5),
            remark: "One fact, not four: at fixed q they differ by constant factors.",
        },
        Claim {
            place: "Fig. 4",
            statement: "The surfaces are fairly smooth except near q = 1.",
            measured: vec![number("crease at e = 1, q", crease), number("slope beyond it over slope before", bend)],
            verdict: Verdict::of(bend < 1.1, true),
            remark: "A crease runs along q = 1/√(1 + e), where the third impact becomes the worst.",
        },
        Claim {
            place: "Fig. 4",
            statement: "Single shocks lie well above and well below 2 v₀.",
            measured: vec![
                part("plane with the ends above, ln 2", std::f64::consts::LN_2),
                area("plane with the quarter points above", complement(SafeZone::new(2.0).area(0.5))),
                number("largest at the center, in v₀", top),
            ],
            verdict: Verdict::of(top < 2.0, true),
            remark: "The ends range from 1 to infinity, the center from 0 to 9/8.",
        },
        Claim {
            place: "Fig. 4",
            statement: "High q spares the center at the cost of the ends.",
            measured: vec![
                number("center at (0.1, 0.3), in v₀", near.center),
                number("center at (0.9, 0.3)", far.center),
                number("end at (0.1, 0.3)", near.end),
                number("end at (0.9, 0.3)", far.end),
            ],
            verdict: Verdict::of(far.center < near.center && far.end > near.end, false),
            remark: "The ends get 2/(1 − q) times what the center gets.",
        },
    ])
}

/// Returns the rest of the design plane.
fn complement(integral: clatter::Integral) -> clatter::Integral {
    clatter::Integral { value: 1.0 - integral.value, ..integral }
}

/// Returns the lowest q and e from which the zone shrinks with q although it exists.
fn shrinking(plane: &Plane, zone: &[f64]) -> [f64; 2] {
    let steps = zone.iter().zip(zone.iter().skip(GRID)).zip(plane.points());
    let shrinks = steps.filter(|((a, b), _)| **a > 0.0 && **b > 0.0 && **b < **a * (1.0 - LEVEL));
    shrinks.fold([1.0, 1.0], |[q, e], (_, (q1, e1, _))| [q.min(q1), e.min(e1)])
}

/// Returns the claims about Fig. 5.
fn half(plane: &Plane) -> Vec<Claim> {
    let covered = SafeZone::new(0.5).area(0.0);
    let zone = plane.zone(0.5);
    let trend = Plane::along_q(&zone, |s| s > 0.0);
    let in_e = [0.5, 1.0, 2.0].map(|threshold| Plane::along_e(&plane.zone(threshold)).rises);
    let in_q = [0.5, 1.0, 2.0].map(|threshold| Plane::along_q(&plane.zone(threshold), |s| s > 0.0).rises);
    let [q, e] = shrinking(plane, &zone);
    vec![
        Claim {
            place: "Fig. 5",
            statement: "About half of the plane has a zone within v₀/2.",
            measured: vec![area("plane with a zone", covered)],
            verdict: Verdict::of((covered.value - 0.5).abs() <= 0.05, (covered.value - 0.5).abs() <= 0.1),
            remark: "It is three eighths.",
        },
        Claim {
            place: "Fig. 5",
            statement: "Where there is a v₀/2 zone, a larger q only widens it.",
            measured: vec![part("steps in q that narrow it", trend.falls), number("from q", q), number("from e", e)],
            verdict: Verdict::of(trend.falls == 0.0, trend.falls < 0.5),
            remark: "Not close to q = 1, where the peak at the ends grows faster than its share at the center falls.",
        },
        Claim {
            place: "Figs. 5–7",
            statement: "At fixed q every zone widens as e falls.",
            measured: vec![part("steps in e against it, v₀/2", in_e[0]), part("v₀", in_e[1]), part("2 v₀", in_e[2])],
            verdict: Verdict::of(in_e.iter().all(|share| *share <= 0.0), in_e.iter().all(|share| *share < 0.5)),
            remark: "It follows from the peak at the ends, which rises with e.",
        },
        Claim {
            place: "Figs. 5–7",
            statement: "The three thresholds differ in what q does to the zone.",
            measured: vec![part("steps in q that widen it, v₀/2", in_q[0]), part("v₀", in_q[1]), part("2 v₀", in_q[2])],
            verdict: Verdict::of(in_q[0] > 0.9 && in_q[1] > 0.1 && in_q[1] < 0.9 && in_q[2] < 0.1, in_q[0] > in_q[2]),
            remark: "",
        },
    ]
}

/// Returns the claims about Fig. 6.
fn one(plane: &Plane) -> Vec<Claim> {
    let bare = complement(SafeZone::new(1.0).area(0.0));
    let curve = SafeZone::new(1.0).curve(0.0, 1e-4);
    let points = || curve.iter().flatten();
    let (highest, lowest) = (largest(points().map(|p| p.q)), smallest(points().map(|p| p.e)));
    let zone = plane.zone(1.0);
    let trend = Plane::along_q(&zone, |s| s > 0.0);
    let flat = zone.iter().zip(zone.iter().skip(GRID)).filter(|(a, b)| **a > 0.0 && **b > 0.0);
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    let flat = {
        let slopes: Vec<_> = flat.map(|(a, b)| (b - a) * (GRID - 1) as f64).collect();
        slopes.iter().filter(|slope| slope.abs() < 0.1).count() as f64 / slopes.len() as f64
    };
    vec![
        Claim {
            place: "Fig. 6",
            statement: "All but a small region at low q and high e has a zone within v₀.",
            measured: vec![area("plane without", bare), number("reaching up to q", highest), number("from e", lowest)],
            verdict: Verdict::of(bare.value < 0.1 && highest <= 0.5 && lowest >= 0.5, bare.value < 0.5),
            remark: "Bounded by q = (e ± √(e² + 4e − 4))/(2(1 + e)), from e = 2√2 − 2 on.",
        },
        Claim {
            place: "Fig. 6",
            statement: "In q the v₀ zone is not monotonic: it can grow either way.",
            measured: vec![part("steps in q that widen it", trend.rises), part("that narrow it", trend.falls)],
            verdict: Verdict::of(trend.rises > 0.01 && trend.falls > 0.01, false),
            remark: "",
        },
        Claim {
            place: "Fig. 6",
            statement: "In places q has no appreciable effect on it.",
            measured: vec![part("steps at a rate of less than 1 % of the bar per 0.1 in q", flat)],
            verdict: Verdict::of(flat > 0.01, false),
            remark: "",
        },
    ]
}

/// Returns the claims about Fig. 7.
fn two(plane: &Plane) -> Vec<Claim> {
    let zone = plane.zone(2.0);
    let least = smallest(zone.iter().copied());
    let inner = smallest(zone.iter().take(zone.len() - 1).copied());
    let trend = Plane::along_q(&zone, |_| true);
    vec![
        Claim {
            place: "Fig. 7",
            statement: "Every design has a zone within 2 v₀.",
            measured: vec![
                number("least s", least),
                number("least s elsewhere on the grid", inner),
                area("plane where the whole bar is within", SafeZone::new(2.0).area(1.0)),
            ],
            verdict: Verdict::of(least >= 0.0 && inner > 0.0, inner > 0.0),
            remark: "The zone shrinks to the center itself in the corner q = e = 1.",
        },
        Claim {
            place: "Fig. 7",
            statement: "The 2 v₀ zone widens as q falls.",
            measured: vec![part("steps in q against it", trend.rises)],
            verdict: Verdict::of(trend.rises == 0.0, trend.rises < 0.5),
            remark: "",
        },
    ]
}

/// Returns the claims of section 6, Table 1 and the summation.
fn designs(plane: &Plane) -> Result<Vec<Claim>, Error> {
    let [reference, first, second, third] = DESIGNS;
    let half = [zone(reference, 0.5)?, zone(first, 0.5)?, zone(second, 0.5)?, zone(third, 0.5)?];
    let two = [zone(reference, 2.0)?, zone(first, 2.0)?, zone(second, 2.0)?, zone(third, 2.0)?];
    let peak = |[q, e]: [f64; 2]| Ok::<_, Error>(summary(q, e)?.peak.end);
    let ends = [peak(first)?, peak(second)?, peak(third)?];
    let percent = |s: f64| (100.0 * s).round();
    let shared = (0..4).flat_map(|i| (0..i).map(move |j| (DESIGNS[i], DESIGNS[j])));
    let shared: f64 =
        shared.map(|([q, e], [p, f])| f64::from(u8::from((q - p).abs() < 1e-9 || (e - f).abs() < 1e-9))).sum();
    // a uniform bar with a share m of its mass moved to the center has k² = (1 − m)/3
    let moved = |[q, _]: [f64; 2]| 1.0 - 3.0 * (1.0 - q) / (1.0 + q);
    let widest = largest(plane.zone(0.5));
    let corner = zone([1.0, 0.0], 0.5)?;
    let wide = Plane::along_q(&plane.zone(2.0), |_| true);
    Ok(vec![
        Claim {
            place: "Table 1",
            statement: "The uniform reference has no zone within v₀/2.",
            measured: vec![number("s", half[0])],
            verdict: Verdict::of(half[0] < 0.0, false),
            remark: "Printed as 0 %.",
        },
        Claim {
            place: "Table 1",
            statement: "The suggested designs have a zone of roughly 10 % within v₀/2, and substantially all of the bar within 2 v₀.",
            measured: vec![
                part("least zone within v₀/2", smallest(half[1..].iter().copied())),
                part("greatest", largest(half[1..].iter().copied())),
                part("least zone within 2 v₀", smallest(two[1..].iter().copied())),
            ],
            verdict: Verdict::of(
                half[1..].iter().all(|s| (0.075..0.125).contains(s)) && two[1..].iter().all(|s| *s > 0.85),
                half[1..].iter().all(|s| *s > 0.0),
            ),
            remark: "",
        },
        Claim {
            place: "Sect. 6",
            statement: "(0.73, 0.2) and (0.67, 0.15) give a zone of 10 % within v₀/2.",
            measured: vec![part("s, (0.73, 0.2)", half[1]), part("s, (0.67, 0.15)", half[2])],
            verdict: Verdict::of(
                half[1] >= 0.1 && half[2] >= 0.1,
                percent(half[1]) >= 10.0 && percent(half[2]) >= 10.0,
            ),
            remark: "The second only when rounded to whole per cent.",
        },
        Claim {
            place: "Sect. 6",
            statement: "Their ends see only slightly more than 2 v₀, on a small part of the bar.",
            measured: vec![
                number("end, (0.73, 0.2), in v₀", ends[0]),
                part("bar beyond 2 v₀", 1.0 - two[1]),
                number("end, (0.67, 0.15), in v₀", ends[1]),
                part("bar beyond 2 v₀", 1.0 - two[2]),
            ],
            verdict: Verdict::of(ends[0] < 2.1 && ends[1] < 2.1, ends[1] < 2.1),
            remark: "Slight for the second; for the first one eighth more, on one eighth of the bar.",
        },
        Claim {
            place: "Sect. 6",
            statement: "(0.57, 0.1) has a somewhat smaller zone and nowhere more than 2 v₀.",
            measured: vec![part("s", half[3]), number("end, in v₀", ends[2])],
            verdict: Verdict::of(half[3] > 0.0 && half[3] < half[2].min(half[1]) && ends[2] <= 2.0, ends[2] <= 2.0),
            remark: "",
        },
        Claim {
            place: "Sect. 6",
            statement: "The suggested designs show the effects of e and of q independently.",
            measured: vec![count("pairs of the four that share q or e", shared)],
            verdict: Verdict::of(shared >= 2.0, shared >= 1.0),
            remark: "No two share either: every step changes both.",
        },
        Claim {
            place: "Sect. 6",
            statement: "A large q is hardly feasible in a densely packed product.",
            measured: vec![
                part("mass a uniform bar must move to its center for q = 0.57", moved(third)),
                part("for q = 0.67", moved(second)),
                part("for q = 0.73", moved(first)),
            ],
            verdict: Verdict::of(moved(first) > 0.5, true),
            remark: "The highest suggested q takes more than half of all mass.",
        },
        Claim {
            place: "Sect. 7",
            statement: "Low moment of inertia and low restitution make a significant safe zone at the center.",
            measured: vec![part("widest within v₀/2", widest), part("at q = 1, e = 0", corner)],
            verdict: Verdict::of(widest > 0.1 && (widest - corner).abs() < 1e-12, widest > 0.1),
            remark: "A quarter of the bar is the most that any design can have.",
        },
        Claim {
            place: "Sect. 7",
            statement: "Low moment of inertia makes a product more rugged.",
            measured: vec![
                part("steps in q that narrow the 2 v₀ zone", wide.falls),
                part("plane with a v₀/2 zone", SafeZone::new(0.5).area(0.0).value),
            ],
            verdict: Verdict::of(wide.falls == 0.0, true),
            remark: "For parts near the center. Every increase of q shakes the ends more.",
        },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_claim_is_measured() {
        let claims = claims().unwrap();
        for claim in &claims {
            assert!(!claim.measured.is_empty(), "{}", claim.statement);
            for m in &claim.measured {
                assert!(m.value.is_finite() && m.error.is_finite() && m.error < 1e-9, "{}: {m:?}", claim.statement);
                assert!(m.kind != Kind::Share || (0.0..=1.0).contains(&m.value), "{}: {m:?}", claim.statement);
            }
            assert!(claim.verdict == Verdict::Holds || !claim.remark.is_empty(), "where not: {}", claim.statement);
        }
        let mut statements: Vec<_> = claims.iter().map(|c| c.statement).collect();
        statements.sort_unstable();
        statements.dedup();
        assert_eq!(statements.len(), claims.len(), "a statement stands twice");
    }

    #[test]
    fn measured_figures_have_their_closed_forms() {
        let claims = claims().unwrap();
        let find = |what: &str| {
            let mut all = claims.iter().flat_map(|c| &c.measured).filter(|m| m.what == what);
            all.next().unwrap_or_else(|| panic!("nothing is called {what}")).value
        };
        // up to q = 1/√(1 + e) the second impact is the worst: peak (1 + e)(1 + q (1 + e))
        let center = |q: f64, e: f64| 0.5 * (1.0 - q) * (1.0 + e) * (1.0 + q * (1.0 + e));
        assert!((find("largest, in v₀") - center(0.25, 1.0)).abs() < 1e-15, "9/8");
        assert!((find("slope beyond it over slope before") - (8f64.sqrt() + 1.0)).abs() < 1e-4, "2T + 1 at T = √2");
        // three impacts from a_3 = T³ + T² − 2eT − e = 0 on, with T = (1 + e)/2
        let a3 = |e: f64| {
            let t = 0.5 * (1.0 + e);
            t * t * t + t * t - 2.0 * e * t - e
        };
        assert!(a3(find("three from e")).abs() < 1e-14, "{}", find("three from e"));
        // the plane is shared out
        let shares: f64 = ["plane with two", "three", "four", "five", "endless"].into_iter().map(find).sum();
        let more = 4.0 - std::f64::consts::PI - contour::area_up_to(5).value;
        assert!((shares + more - 1.0).abs() < 1e-14, "{shares} and {more}");
    }

    #[test]
    fn a_trend_counts_rises_and_falls_and_not_rounding() {
        let trend = Trend::of([(1.0, 2.0), (2.0, 2.0 + 1e-13), (2.0, 1.0), (1.0, f64::INFINITY)].into_iter());
        assert_eq!(format!("{:?}", [trend.rises, trend.falls]), "[0.5, 0.25]");
    }

    #[test]
    fn a_turn_is_found_to_the_last_bit() {
        let third = 1.0 / 3.0;
        assert_eq!(turn(0.0, 1.0, |x| x >= third).to_bits(), third.to_bits());
    }
}
