//! Shock response spectra, the damage boundary and the three-way rule.

use std::f64::consts::TAU;

use clatter_shock::{
    DamageBoundary, LimitCurve, Margin, Quantity, RequiredSpectrum, Rule, STANDARD_GRAVITY_M_S2, Spectrum,
};

use crate::FigureError;
use crate::axis::{Axis, three, tick};
use crate::chart::{Axes, Chart};
use crate::paper::{Paper, SMALL};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, RUST, SAND, width};

const MAXIMAX: Ink = Ink::line(BLUES[2], 4.0);
const POSITIVE: Ink = Ink::line(BLUES[8], 1.1);
const NEGATIVE: Ink = Ink { dash: "4 2", ..POSITIVE };
const PRIMARY: Ink = Ink::line(RUST, 0.8);
const RESIDUAL: Ink = Ink { dash: "1.5 1.5", ..PRIMARY };
const REQUIRED: Ink = Ink { dash: "5 2", ..Ink::line("#8a6d1f", 1.4) };
const TOLERANCE: Ink = Ink { dash: "2 2", ..Ink::line("#8a6d1f", 0.8) };
const LIMIT: Ink = Ink { dash: "8 2 1.5 2", ..Ink::line(INK, 1.2) };
/// Lines of other spectra, in turn.
const OTHERS: [Ink; 6] = [
    Ink::line("#4c7a49", 1.2),
    Ink { dash: "6 2", ..Ink::line("#4c7a49", 1.2) },
    Ink::line(INK, 1.2),
    Ink { dash: "6 2", ..Ink::line(INK, 1.2) },
    Ink::line(GRAY, 1.2),
    Ink { dash: "6 2", ..Ink::line(GRAY, 1.2) },
];
/// Asymptotes and other guides.
pub const GUIDE: Ink = Ink { dash: "3 2.5", ..Ink::line(GRAY, 0.8) };
/// Lines of four-coordinate paper that run aslant.
const SLANT: Ink = Ink::line("#c6ced6", 0.4);

/// Returns the quantity and its unit, in figure markup.
fn title(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::AbsoluteAcceleration => "absolute acceleration, gn",
        Quantity::RelativeDisplacement => "relative displacement, m",
        Quantity::RelativeVelocity => "relative velocity, m/s",
        Quantity::PseudoVelocity => "pseudo-velocity, m/s",
        Quantity::EquivalentStaticAcceleration => "equivalent static acceleration, gn",
    }
}

/// Returns a spectrum in the unit of its title: accelerations in g.
fn shown(spectrum: &Spectrum) -> Spectrum {
    let mut shown = spectrum.clone();
    let factor = factor(spectrum.quantity);
    let all = [&mut shown.primary, &mut shown.residual, &mut shown.maximax, &mut shown.positive, &mut shown.negative];
    all.into_iter().flatten().for_each(|value| *value *= factor);
    shown
}

fn factor(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::AbsoluteAcceleration | Quantity::EquivalentStaticAcceleration => 1.0 / STANDARD_GRAVITY_M_S2,
        _ => 1.0,
    }
}

/// Returns frequencies in order, to draw a line through, with their values.
fn pairs<'a>(spectrum: &'a Spectrum, values: &'a [f64], order: &'a [usize]) -> impl Iterator<Item = (f64, f64)> + 'a {
    order.iter().map(|&i| (spectrum.frequency_hz[i], values[i]))
}

/// The curves that a spectrum is compared with.
#[derive(Debug, Clone, Copy, Default)]
pub struct Against<'a> {
    /// Limit that it may not exceed.
    pub limit: Option<&'a LimitCurve>,
    /// Spectrum that it has to reach, with its tolerance.
    pub required: Option<&'a RequiredSpectrum>,
}

impl<'a> Against<'a> {
    /// Returns its curves with their names; both edges of the tolerance have one name.
    fn curves(self) -> Vec<(&'a LimitCurve, Ink<'static>, Option<&'static str>)> {
        let mut curves = Vec::new();
        if let Some(required) = self.required {
            curves.push((required.curve(), REQUIRED, Some("required")));
            let (lowest, highest) = required.band();
            let edges = [Some(lowest).filter(|lowest| *lowest != required.curve()), highest];
            for (n, edge) in edges.into_iter().flatten().enumerate() {
                curves.push((edge, TOLERANCE, (n == 0).then_some("tolerance")));
            }
        }
        curves.extend(self.limit.map(|limit| (limit, LIMIT, Some("limit"))));
        curves
    }
}

/// Draws a shock response spectrum on log-log paper, with a limit and the least margin if there is one; the
/// pseudo-velocity is drawn on four-coordinate paper, whose diagonals are relative displacement and acceleration.
///
/// ```
/// use clatter_shock::{DampingRatio, Frequencies, Quantity, VelocityShock, VelocityShocks};
/// let shock = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v: 2.0 }])?;
/// let frequencies = Frequencies::per_octave(10.0, 1000.0, 12.0)?;
/// let spectrum = shock.spectrum(&frequencies, DampingRatio::new(0.05)?, Quantity::PseudoVelocity);
/// assert!(clatter_figures::spectrum(&spectrum, clatter_figures::Against::default())?.contains("pseudo-velocity"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn spectrum(s: &Spectrum, against: Against<'_>) -> Result<String, FigureError> {
    draw(s, None, against, &[], false)
}

/// Draws several spectra of one quantity by their maximax, each with its name; the margin is the least of all.
pub fn spectra(all: &[(&Spectrum, &str)], against: Against<'_>) -> Result<String, FigureError> {
    let least = |spectrum: &Spectrum| {
        let margins = against.limit.map(|limit| limit.margins(spectrum)).unwrap_or_default();
        LimitCurve::worst(&margins).and_then(|i| margins[i]).map_or(f64::INFINITY, |margin| margin.decibel())
    };
    let worst = (0..all.len()).min_by(|a, b| least(all[*a].0).total_cmp(&least(all[*b].0)));
    let Some(worst) = worst else { return Err(FigureError("there is no spectrum".to_owned())) };
    let others: Vec<_> = all.iter().enumerate().filter(|(i, _)| *i != worst).map(|(_, other)| *other).collect();
    draw(all[worst].0, Some(all[worst].1), against, &others, false)
}

/// Draws a spectrum and another one of the same quantity by its maximax, with its name: half as wide as a page.
pub fn spectrum_compared(s: &Spectrum, other: &Spectrum, name: &str) -> Result<String, FigureError> {
    draw(s, None, Against::default(), &[(other, name)], true)
}

/// Draws two spectra of one quantity by their maximax, each with its name: half as wide as a page.
pub fn two(one: (&Spectrum, &str), other: (&Spectrum, &str)) -> Result<String, FigureError> {
    draw(one.0, Some(one.1), Against::default(), &[other], true)
}

/// Draws one spectrum, or with a name its maximax alone, and others.
fn draw(
    s: &Spectrum,
    name: Option<&str>,
    against: Against<'_>,
    others: &[(&Spectrum, &str)],
    small: bool,
) -> Result<String, FigureError> {
    let mut order: Vec<usize> = (0..s.frequency_hz.len()).collect();
    order.sort_by(|a, b| s.frequency_hz[*a].total_cmp(&s.frequency_hz[*b]));
    let factor = factor(s.quantity);
    let mut margins = against.limit.map(|limit| limit.margins(s)).unwrap_or_default();
    let edges = against.curves();
    for margin in margins.iter_mut().flatten() {
        (margin.demand, margin.allowed) = (factor * margin.demand, factor * margin.allowed);
    }
    let own = shown(s);
    let (s, others) = (&own, others.iter().map(|(other, name)| (shown(other), *name)).collect::<Vec<_>>());
    let at = |(curve, ..): &(&LimitCurve, Ink, _)| {
        own.frequency_hz.iter().filter_map(|hz| Some(factor * curve.at(*hz)?)).collect::<Vec<_>>()
    };
    let allowed: Vec<f64> = edges.iter().flat_map(at).collect();
    let x = Axis::log_over(s.frequency_hz.iter().copied(), 600.0, "natural frequency, Hz");
    let x = match (order.first(), order.last()) {
        // the ends of a range are the ends of the paper
        (Some(&a), Some(&b)) if s.frequency_hz[b] > 3.0 * s.frequency_hz[a] => {
            Axis { low: s.frequency_hz[a], high: s.frequency_hz[b], ..x }
        }
        _ => x,
    };
    let beside = others.iter().flat_map(|(other, _)| other.maximax.iter().copied());
    let y =
        Axis::log_over(s.maximax.iter().copied().chain(allowed.iter().copied()).chain(beside), 5.0, title(s.quantity));
    let four = s.quantity == Quantity::PseudoVelocity;
    let room = if small { [172.0, 146.0] } else { [300.0, 230.0] };
    let (x, y, size) = if four { squared(x, y, room) } else { (x, y, room) };
    let axes = Axes { corner: if small { [40.0, 8.0] } else { [52.0, 12.0] }, size, x, y };
    let (right, bottom) = (axes.corner[0] + axes.size[0], axes.corner[1] + axes.size[1]);
    let mut paper = if small { Paper::new(226.0, bottom + 62.0) } else { Paper::new(right + 132.0, bottom + 30.0) };
    let axes = axes.on(&mut paper, if small { 31.0 } else { 38.0 });
    if four {
        let drawn = order.iter().flat_map(|&i| {
            let allowed = margins.get(i).copied().flatten().map_or(f64::NAN, |m| m.allowed);
            [s.maximax[i], s.positive[i], s.negative[i], s.residual[i], allowed].map(|v| axes.at(s.frequency_hz[i], v))
        });
        let beside =
            others.iter().flat_map(|(o, _)| o.frequency_hz.iter().zip(&o.maximax).map(|(f, v)| axes.at(*f, *v)));
        slants(&mut paper, &axes, &drawn.chain(beside).collect::<Vec<_>>());
    }
    let all = [
        (MAXIMAX, "maximax", &s.maximax),
        (PRIMARY, "primary", &s.primary),
        (RESIDUAL, "residual", &s.residual),
        (POSITIVE, "positive", &s.positive),
        (NEGATIVE, "negative", &s.negative),
    ];
    let curves = match name {
        Some(name) => &[(POSITIVE, name, &s.maximax)][..],
        None => &all[..],
    };
    for (ink, _, values) in curves {
        axes.curve(&mut paper, pairs(s, values, &order), *ink);
        if let [one] = order[..] {
            axes.mark(&mut paper, s.frequency_hz[one], values[one], ink.stroke);
        }
    }
    let mut lines: Vec<(Ink, &str)> = curves.iter().map(|(ink, name, _)| (*ink, *name)).collect();
    for ((other, name), ink) in others.iter().zip(OTHERS.into_iter().cycle()) {
        let mut order: Vec<usize> = (0..other.frequency_hz.len()).collect();
        order.sort_by(|a, b| other.frequency_hz[*a].total_cmp(&other.frequency_hz[*b]));
        axes.curve(&mut paper, pairs(other, &other.maximax, &order), ink);
        if let [one] = order[..] {
            axes.mark(&mut paper, other.frequency_hz[one], other.maximax[one], ink.stroke);
        }
        lines.push((ink, *name));
    }
    let worst = LimitCurve::worst(&margins).and_then(|i| Some((s.frequency_hz[i], margins[i]?)));
    for (curve, ink, name) in edges {
        axes.curve(&mut paper, curve.corners(x.low, x.high).into_iter().map(|p| (p.0, factor * p.1)), ink);
        lines.extend(name.map(|name| (ink, name)));
    }
    axes.border(&mut paper);
    if small {
        for (pair, x) in lines.chunks(2).zip([6.0, 78.0, 148.0]) {
            paper.key([x, bottom + 41.0], pair);
        }
        return paper.finish(&format!("Shock response spectrum: {}", title(s.quantity)));
    }
    let mut down = paper.key([right + 12.0, 20.0], &lines);
    if let Some((hz, margin)) = worst {
        least_margin(&mut paper, &axes, [right + 12.0, down + 4.0], hz, margin);
        down += 26.0;
    }
    let zeta = s.damping.get();
    let note_at = |paper: &mut Paper, k: f64, text: &str| paper.note([right + 12.0, down + 4.0 + 11.0 * k], text);
    if others.iter().all(|(other, _)| other.damping == s.damping) {
        note_at(&mut paper, 0.0, &format!("damping ratio {}", three(zeta)));
    }
    if four {
        note_at(&mut paper, 1.6, "aslant upward: relative");
        note_at(&mut paper, 2.6, "displacement; downward:");
        note_at(&mut paper, 3.6, "acceleration");
    }
    paper.finish(&format!("Shock response spectrum: {}", title(s.quantity)))
}

/// Draws an arrow from the spectrum to its limit where the margin is least, with the margin.
fn least_margin(paper: &mut Paper, axes: &Chart<'_>, [x, y]: Pt, hz: f64, margin: Margin) {
    let (from, to) = (axes.at(hz, margin.demand), axes.at(hz, margin.allowed));
    if from.iter().chain(&to).all(|c| c.is_finite()) && (from[1] - to[1]).abs() > 6.0 {
        paper.arrow(from, to, if margin.is_safe() { INK } else { RUST }, 0.9);
    }
    let db = margin.decibel();
    let db = format!("{db:+.*} dB", if db.abs() < 1.0 { 2 } else { 1 }).replace('-', "−");
    paper.note([x, y], &format!("least margin {db}"));
    paper.note([x, y + 11.0], &format!("at {} Hz", three(hz)));
}

/// Returns axes whose decades are of one length, so that the other two coordinates run at 45°.
fn squared<'a>(x: Axis<'a>, y: Axis<'a>, room: Pt) -> (Axis<'a>, Axis<'a>, Pt) {
    let wide = (x.high / x.low).log10();
    // a decade of room for the labels at the top, and no strip of paper
    let (low, high) = (y.low, y.high * 10f64.powf(0.3));
    let tall = (high / low).log10();
    let need = (room[1] / room[0] * wide - tall).max(0.0);
    let (low, high) = (low * 10f64.powf(-0.6 * need), high * 10f64.powf(0.4 * need));
    let tall = (high / low).log10();
    let decade = (room[0] / wide).min(1.2 * room[1] / tall);
    (x, Axis { low, high, ..y }, [decade * wide, decade * tall])
}

/// Draws lines of equal displacement and equal acceleration, a decade apart, with their values, clear of the points
/// `drawn`.
fn slants(paper: &mut Paper, axes: &Chart<'_>, drawn: &[Pt]) {
    let (x, y) = (axes.x, axes.y);
    let line = |paper: &mut Paper, at: &dyn Fn(f64) -> f64| {
        axes.curve(paper, [(x.low, at(x.low)), (x.high, at(x.high))].into_iter(), SLANT);
    };
    let decades = |low: f64, high: f64| {
        let first = low.log10().ceil();
        let every = ((high / low).log10() / 12.0).ceil().max(1.0);
        let mut exponent = (first / every).ceil() * every;
        std::iter::from_fn(move || {
            let value = 10f64.powf(exponent);
            exponent += every;
            (value <= high).then_some(value)
        })
    };
    // Labels stand at the upper ends of the displacements and the lower ends of the accelerations: never at one place.
    let turn = (axes.size[1] / (y.high / y.low).log10()).atan2(axes.size[0] / (x.high / x.low).log10()).to_degrees();
    let mut taken: Vec<(Pt, f64)> = Vec::new();
    let mut label = |paper: &mut Paper, hz: f64, v: f64, text: &str, turn: f64| {
        let [px, py] = axes.at(hz, v);
        let (sin, cos) = turn.to_radians().sin_cos();
        let half = 0.5 * width(text, 7.0) + 1.0;
        // back from the end of the line, until no curve runs through
        let center = |steps: u8| {
            let along = half + 4.0 + 8.0 * f64::from(steps);
            [px - along * cos, py - along * sin]
        };
        let clear = |[cx, cy]: Pt| {
            let inside = cx > axes.corner[0] + half
                && (axes.corner[1] + half..axes.corner[1] + axes.size[1] - half).contains(&cy);
            let apart = |(p, other): &(Pt, f64)| (p[0] - cx).hypot(p[1] - cy) > half.max(*other) + 5.0;
            inside
                && taken.iter().all(apart)
                && drawn.iter().all(|p| (p[0] - cx).hypot(p[1] - cy) > half + 2.0 || p[0].is_nan() || p[1].is_nan())
        };
        let Some([cx, cy]) = (0..12).map(center).find(|c| clear(*c)) else { return };
        taken.push(([cx, cy], half));
        let corner = |a: f64, b: f64| [cx + a * cos - b * sin, cy + a * sin + b * cos];
        paper.path(
            &[corner(-half, -3.5), corner(half, -3.5), corner(half, 3.5), corner(-half, 3.5)],
            true,
            Ink::fill("#ffffff"),
        );
        paper.text(corner(0.0, 2.3), text, Label { size: 7.0, turn, color: GRAY, ..LABEL });
    };
    let inset = 1.02;
    for d in decades(y.low / (TAU * x.high), y.high / (TAU * x.low)) {
        line(paper, &|hz| TAU * hz * d);
        let hz = (y.high / (TAU * d)).min(x.high);
        if hz > x.low * 2.5 && TAU * hz * d > y.low * 2.5 {
            label(paper, hz / inset, TAU * hz * d / inset, &length(d), -turn);
        }
    }
    for g in decades(y.low * TAU * x.low / STANDARD_GRAVITY_M_S2, y.high * TAU * x.high / STANDARD_GRAVITY_M_S2) {
        let a = g * STANDARD_GRAVITY_M_S2;
        line(paper, &|hz| a / (TAU * hz));
        let hz = (a / (TAU * y.low)).min(x.high);
        if hz > x.low * 2.5 && a / (TAU * hz) < y.high / 2.5 {
            label(paper, hz / inset, a / (TAU * hz) * inset, &format!("{} g", tick(g)), turn);
        }
    }
}

/// Returns a power of ten in meters, with a prefix where there is one.
fn length(m: f64) -> String {
    for (unit, name) in [(1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")] {
        let v = m / unit;
        if (0.999..1001.0).contains(&v) {
            return format!("{} {name}", tick(v.round()));
        }
    }
    format!("{} m", tick(m))
}

/// Draws a damage boundary: acceleration over velocity change, log-log, `curve` from
/// [`clatter_shock::DamageBoundary::curve`] and a shock at (velocity change, acceleration) on it.
pub fn damage_boundary(critical: Critical, curve: &[(f64, f64)], shock: [f64; 2]) -> Result<String, FigureError> {
    boundary(critical, curve, &[(shock, "this shock", RUST)], [330.0, 230.0])
}

/// The critical values of a damage boundary.
#[derive(Debug, Clone, Copy)]
pub struct Critical {
    /// Critical velocity change, in m/s.
    pub velocity_change: f64,
    /// Critical acceleration, in m/s².
    pub acceleration: f64,
    /// Velocity change in m/s from which on the acceleration alone decides; infinite if there is none.
    pub knee: f64,
}

impl From<&DamageBoundary> for Critical {
    fn from(b: &DamageBoundary) -> Self {
        Self {
            velocity_change: b.critical_velocity_change(),
            acceleration: b.critical_acceleration(),
            knee: b.knee_velocity_change(),
        }
    }
}

/// Draws a damage boundary with any pulses, (velocity change, acceleration), name and color, in a frame of any size.
pub fn boundary(
    critical: Critical,
    curve: &[(f64, f64)],
    pulses: &[([f64; 2], &str, &'static str)],
    size: Pt,
) -> Result<String, FigureError> {
    let Critical { velocity_change: v, acceleration, knee } = critical;
    let in_g = |a: f64| a / STANDARD_GRAVITY_M_S2;
    let a = in_g(acceleration);
    let curve: Vec<(f64, f64)> = curve.iter().map(|p| (p.0, in_g(p.1))).collect();
    let pulses: Vec<_> = pulses.iter().map(|([v, a], name, color)| ([*v, in_g(*a)], *name, *color)).collect();
    let last = curve.last().map_or(v, |p| p.0);
    // Without a knee the boundary falls for ever, and the paper ends with the curve.
    let drawn = |k: usize| pulses.iter().map(move |(at, ..)| at[k]).filter(|x| *x > 0.0 && x.is_finite());
    let least = |k: usize, other: f64| drawn(k).fold(other, |m, x| m.min(0.5 * x));
    let most = |k: usize, other: f64| drawn(k).fold(other, |m, x| m.max(2.0 * x));
    let right = if knee.is_finite() { most(0, 4.0 * knee) } else { last };
    let axes = Axes {
        corner: [52.0, 12.0],
        size,
        x: Axis::log(least(0, v / 5.0), right, "velocity change of the base, m/s"),
        y: Axis::log(least(1, a / 5.0), most(1, 30.0 * a), "peak acceleration of the base, gn"),
    };
    let mut paper = Paper::new(size[0] + 66.0, size[1] + 42.0);
    let axes = axes.on(&mut paper, 38.0);
    // damage: above and to the right of the boundary
    let mut edge: Vec<(f64, f64)> = curve.iter().copied().filter(|p| p.1 <= axes.y.high).collect();
    edge.insert(0, (edge.first().map_or(v, |p| p.0), axes.y.high));
    edge.push((axes.x.high, if knee.is_finite() { a } else { edge.last().map_or(a, |p| p.1) }));
    let mut region: Vec<Pt> = edge.iter().map(|p| axes.at(p.0, p.1)).collect();
    region.push(axes.at(axes.x.high, axes.y.high));
    paper.path(&region, true, Ink::fill(SAND));
    axes.curve(&mut paper, [(v, axes.y.low), (v, axes.y.high)].into_iter(), GUIDE);
    axes.level(&mut paper, a, GUIDE);
    axes.curve(&mut paper, edge.into_iter(), Ink::line(INK, 1.6));
    let word = |paper: &mut Paper, [x, y]: Pt, lines: &[&str]| {
        for (line, dy) in lines.iter().zip([0.0, 10.0, 20.0]) {
            paper.text([x, y + dy], line, LABEL);
        }
    };
    let ([left, top], [wide, high]) = (axes.corner, axes.size);
    let [vx, ay] = axes.at(v, a);
    if vx - left > 60.0 {
        word(&mut paper, [0.5 * (left + vx), top + 0.1 * high], &["no damage:", "too little", "velocity"]);
    }
    word(&mut paper, [0.5 * (vx + left + wide), ay + 0.5 * (top + high - ay)], &["no damage: too little acceleration"]);
    word(&mut paper, [vx + 0.6 * (left + wide - vx), top + 0.3 * (ay - top)], &["damage"]);
    let small = Label { color: GRAY, ..SMALL };
    paper.text([left + 4.0, ay - 3.0], &format!("critical {} gn", three(a)), Label { anchor: Anchor::Start, ..small });
    paper.text(
        [vx + 3.0, top + high - 4.0],
        &format!("critical {} m/s", three(v)),
        Label { anchor: Anchor::Start, ..small },
    );
    for (at, name, color) in &pulses {
        axes.mark(&mut paper, at[0], at[1], color);
        let [x, y] = axes.at(at[0], at[1]);
        if !(x.is_finite() && y.is_finite()) {
            continue;
        }
        // above the point, and away from the boundary
        let room = x > vx && x + width(name, LABEL.size) + 8.0 < left + wide;
        let (dx, anchor) = if room { (3.0, Anchor::Start) } else { (-3.0, Anchor::End) };
        let color = if *color == "#ffffff" { INK } else { color };
        paper.text([x + dx, y - 6.0], name, Label { anchor, color, ..LABEL });
    }
    axes.border(&mut paper);
    paper.finish("Damage boundary: peak acceleration over velocity change of the base")
}

/// Draws the three-way rule as one spectrum over ω h0/v0 with its asymptotes, and a component at (ω h0/v0, |A|/(ω v0))
/// on it.
pub fn rule(rule: &Rule, component: [f64; 2]) -> Result<String, FigureError> {
    let high = |of: fn(&clatter_shock::RulePoint) -> f64| rule.points.iter().map(of).fold(0.0_f64, f64::max);
    let top = high(|p| p.acceleration).max(high(|p| p.displacement)).max(rule.standard.acceleration);
    let (first, last) = (rule.points.first(), rule.points.last());
    let axes = Axes {
        corner: [40.0, 12.0],
        size: [330.0, 220.0],
        x: Axis::log(first.map_or(0.1, |p| p.omega), last.map_or(10.0, |p| p.omega), "*Ω* = *ωh*_0/*v*_0"),
        y: Axis::linear(0.0, 1.08 * top, "peak, in *v*_0"),
    };
    let right = axes.corner[0] + axes.size[0];
    let mut paper = Paper::new(right + 142.0, 262.0);
    let axes = axes.on(&mut paper, 26.0);
    let (acceleration, displacement) = (Ink::line(BLUES[8], 1.3), Ink { dash: "4 2", ..Ink::line(RUST, 0.9) });
    let standard = Ink { dash: "8 2 1.5 2", ..Ink::line(INK, 0.9) };
    axes.level(&mut paper, rule.soft.acceleration, GUIDE);
    if let Some(stiff) = rule.stiff {
        axes.level(&mut paper, stiff.acceleration, Ink { dash: "1.5 2", ..GUIDE });
    }
    axes.level(&mut paper, rule.standard.acceleration, standard);
    axes.curve(&mut paper, rule.points.iter().map(|p| (p.omega, p.displacement)), displacement);
    axes.curve(&mut paper, rule.points.iter().map(|p| (p.omega, p.acceleration)), acceleration);
    axes.mark(&mut paper, component[0], component[1], RUST);
    let mut lines = vec![
        (acceleration, "*A*/*ω*, acceleration"),
        (displacement, "*ωz*, displacement"),
        (GUIDE, "net change alone"),
    ];
    if rule.stiff.is_some() {
        lines.push((Ink { dash: "1.5 2", ..GUIDE }, "largest shock alone"));
    }
    lines.push((standard, "one shock of 2 *v*_0"));
    let down = paper.key([right + 12.0, 20.0], &lines);
    paper.circle([right + 21.0, down - 2.8], 2.6, Ink { stroke: INK, width: 0.8, ..Ink::fill(RUST) });
    paper.text([right + 35.0, down], "this component", Label { anchor: Anchor::Start, ..SMALL });
    axes.border(&mut paper);
    paper.finish("Three-way rule: peak of a component over its natural frequency")
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_shock::{DampingRatio, Frequencies, VelocityShock, VelocityShocks};

    /// Without damping the pseudo-velocity is that of the shock at any frequency: 2 m/s is half of 4 m/s, by 6 dB, and 1 m/s by 12.
    #[test]
    fn of_several_spectra_the_least_margin_is_told() {
        let of = |delta_v| {
            let shock = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v }]).unwrap();
            let frequencies = Frequencies::per_octave(10.0, 1000.0, 3.0).unwrap();
            shock.spectrum(&frequencies, DampingRatio::new(0.0).unwrap(), Quantity::PseudoVelocity)
        };
        let (weak, hard, limit) = (of(1.0), of(2.0), LimitCurve::constant(4.0).unwrap());
        let against = Against { limit: Some(&limit), required: None };
        for all in [[(&weak, "weak"), (&hard, "hard")], [(&hard, "hard"), (&weak, "weak")]] {
            let drawn = spectra(&all, against).unwrap();
            assert!(drawn.contains("least margin +6.0 dB"), "{drawn}");
        }
    }
}
