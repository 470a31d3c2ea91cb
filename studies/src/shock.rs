//! The effect of the clatter on a suspended part: the data of the shock report, and its files.

use std::f64::consts::TAU;

use crate::figures::rules::{self, BarRules};
use crate::suspended::{
    GainMap, Holders, OMEGAS, ShapeFigures, SuspendedZones, Worst, amplification, half_sine_train, omegas,
    rule_either_end, worst,
};
use clatter::design::DESIGNS;
use clatter::{Bar, Start};
use clatter_figures::draw::RUST;
use clatter_figures::{boundary, spectrum_compared};
use clatter_report::File;
use clatter_shock::{
    DamageBoundary, DampingRatio, EquivalentPulse, Frequencies, Limit, Margin, Pulse, Pulses, Quantity, Response, Rule,
    STANDARD_GRAVITY_M_S2, Shape, ShockTable, Spectrum, Suspension, VelocityShock, VelocityShocks,
};
use serde_json::{Value, json};

use crate::Error;
use crate::files::decimals;
use crate::files::pretty;

/// All data of the report.
#[derive(Debug)]
pub(crate) struct Data {
    bars: [BarRules; 4],
    worst: [Worst; 4],
    damping: Vec<(f64, Rule)>,
    gain: GainMap,
    holders: [Holders; 2],
    zones: [[SuspendedZones; 3]; 4],
    shapes: Vec<Figures>,
    phone: Phone,
}

/// One pulse shape: its name, its curve without damping, its numbers without and with damping.
#[derive(Debug)]
struct Figures {
    name: &'static str,
    curve: Vec<(f64, f64)>,
    undamped: ShapeFigures,
    damped: ShapeFigures,
}

/// A drop in SI units, and its effect on a board at the end that strikes second.
#[derive(Debug)]
struct Phone {
    train: Vec<Pulse>,
    single: Pulse,
    acceleration: [Spectrum; 2],
    velocity: [Spectrum; 2],
    response: Response,
    margin: Margin,
    alone: Margin,
    boundary: DamageBoundary,
    curve: Vec<(f64, f64)>,
    equivalent: Option<EquivalentPulse>,
    boards: Vec<Board>,
    models: Models,
}

/// The estimates of simpler models for the same drop, as spectra of the acceleration at the frequencies of the train's.
#[derive(Debug)]
struct Models {
    net: Vec<f64>,
    largest: Vec<f64>,
    alone: Vec<f64>,
    shocks: Vec<f64>,
}

impl Models {
    fn new(train: &[Pulse], frequencies: &Frequencies, damping: DampingRatio) -> Result<Self, Error> {
        let shock = |p: &Pulse| VelocityShock { time: p.start, delta_v: p.velocity_change() };
        let shocks = VelocityShocks::new(train.iter().map(shock).collect())?;
        let one = |delta_v: f64| {
            let peak = damping.impulse_factors().times(delta_v).acceleration;
            frequencies.hz().iter().map(|hz| TAU * hz * peak).collect()
        };
        let of = |pulses: &[Pulse]| {
            let pulses = Pulses::new(pulses)?;
            Ok::<_, Error>(pulses.spectrum(frequencies, damping, Quantity::AbsoluteAcceleration).maximax)
        };
        let mut alone = vec![0.0; frequencies.hz().len()];
        for pulse in train {
            alone = of(&[*pulse])?.iter().zip(&alone).map(|(a, b): (&f64, &f64)| a.max(*b)).collect();
        }
        Ok(Self {
            net: one(shocks.net().abs()),
            largest: one(shocks.largest()),
            alone,
            shocks: shocks.spectrum(frequencies, damping, Quantity::AbsoluteAcceleration).maximax,
        })
    }

    /// Returns the largest frequency up to which a model stays within `share` of the train.
    fn good_to(model: &[f64], train: &Spectrum, share: f64) -> f64 {
        let off = |(estimate, peak): (&f64, &f64)| (estimate / peak - 1.0).abs() <= share;
        let good = model.iter().zip(&train.maximax).take_while(|pair| off(*pair)).count();
        good.checked_sub(1).map_or(f64::NAN, |last| train.frequency_hz[last])
    }
}

/// Peak accelerations of one board at the same place: by the train, by its hardest impact alone, by one half-sine of
/// 2 v0.
#[derive(Debug)]
struct Board {
    hz: f64,
    train: f64,
    alone: f64,
    single: f64,
}

impl Board {
    fn new(hz: f64, damping: DampingRatio, train: &[Pulse], single: Pulse) -> Result<Self, Error> {
        let board = Suspension::from_hz(hz, damping)?;
        let peak =
            |pulses: &[Pulse]| Ok::<_, Error>(Pulses::new(pulses)?.respond(&board).absolute_acceleration.magnitude());
        let mut alone = 0.0_f64;
        for pulse in train {
            alone = alone.max(peak(&[*pulse])?);
        }
        Ok(Self { hz, train: peak(train)?, alone, single: peak(&[single])? })
    }
}

/// Damping of every part unless stated otherwise: Q = 10.
const ZETA: f64 = 0.05;
/// Distances from the center: end, quarter point, center.
const PLACES: [f64; 3] = [1.0, 0.5, 0.0];
const THRESHOLDS: [f64; 3] = [0.5, 1.0, 2.0];
/// Values of Ω to an octave: of curves, of searches for a peak, of planes.
const CURVE: u16 = 40;
const SEARCH: u16 = 60;
/// Without damping the peaks are as narrow as the train is long, in Ω: finer steps, and not so far.
const FINE: u16 = 240;
const FINE_TO: f64 = 100.0;
const PLANE: u16 = 10;
const GAIN_CELLS: usize = 40;
const ROWS: usize = 100;

const SHAPES: [(&str, Shape); 7] = [
    ("half-sine", Shape::HalfSine),
    ("haversine", Shape::Haversine),
    ("triangle", Shape::Triangle),
    ("initial-peak sawtooth", Shape::InitialPeakSawtooth),
    ("terminal-peak sawtooth", Shape::TerminalPeakSawtooth),
    ("rectangle", Shape::Rectangle),
    ("trapezoid, ramps 10 %", Shape::Trapezoid { ramp: 0.1 }),
];

/// The drop: the second design from 1.2 m, 140 mm long, tilted so that one end is 20 mm higher; contacts of 0.4 ms.
const PHONE: [f64; 2] = DESIGNS[1];
const SPEED_M_S: f64 = 4.851;
const GAP_M: f64 = 0.02;
const CONTACT_S: f64 = 4e-4;
/// The board at the end that strikes second: its mode and its limit.
const BOARD_HZ: f64 = 230.0;
const BOARD_LIMIT_G: f64 = 1600.0;
/// Modes of boards in products of this size, and beyond.
const MODES_HZ: [f64; 6] = [50.0, 110.0, 180.0, BOARD_HZ, 440.0, 1000.0];

impl Phone {
    fn compute(damping: DampingRatio) -> Result<Self, Error> {
        let bar = Bar::new(PHONE[0], PHONE[1])?;
        let train = half_sine_train(&bar, &Start::new([-SPEED_M_S, -SPEED_M_S], GAP_M)?, 1.0, CONTACT_S)?;
        let single = Pulse {
            shape: Shape::HalfSine,
            amplitude: 2.0 * SPEED_M_S / (Shape::HalfSine.area() * CONTACT_S),
            duration: CONTACT_S,
            start: 0.0,
        };
        let (pulses, alone) = (Pulses::new(&train)?, Pulses::new(&[single])?);
        let frequencies = Frequencies::per_octave(10.0, 10_000.0, 48.0)?;
        let pair = |quantity| [&pulses, &alone].map(|p| p.spectrum(&frequencies, damping, quantity));
        let board = Suspension::from_hz(BOARD_HZ, damping)?;
        let limit = Limit::Acceleration(BOARD_LIMIT_G * STANDARD_GRAVITY_M_S2);
        let response = pulses.respond(&board);
        let this = Board::new(BOARD_HZ, damping, &train, single)?;
        let margin = limit.margin(&response)?;
        let boards = MODES_HZ.map(|hz| Board::new(hz, damping, &train, single));
        let boundary = DamageBoundary::new(board, limit, Shape::HalfSine)?;
        let table = ShockTable { shortest: 2e-4, longest: 2e-2, acceleration: 5e4, velocity_change: 20.0 };
        Ok(Self {
            acceleration: pair(Quantity::AbsoluteAcceleration),
            velocity: pair(Quantity::PseudoVelocity),
            alone: Margin { demand: this.alone, ..margin },
            margin,
            models: Models::new(&train, &frequencies, damping)?,
            boards: boards.into_iter().collect::<Result<_, _>>()?,
            curve: boundary.curve(200)?,
            boundary,
            equivalent: table.equivalent_half_sine(&board, &response, 0.01).ok(),
            train,
            single,
            response,
        })
    }
}

/// Returns every number on the page of [`Report::Shock`](crate::Report::Shock), as it is printed: the file
/// `shock.json`.
///
/// # Errors
/// None in practice: all cases are valid.
pub fn shock_numbers() -> Result<String, Error> {
    pretty(&Data::compute()?.numbers())
}

impl Data {
    /// Computes everything.
    pub(crate) fn compute() -> Result<Self, Error> {
        let damping = DampingRatio::new(ZETA)?;
        let undamped = DampingRatio::new(0.0)?;
        let bar = |[q, e]: [f64; 2]| Bar::new(q, e);
        let grid = omegas(CURVE);
        let rules = |design| {
            let bar = bar(design)?;
            let [end, quarter, center] = PLACES.map(|s| rule_either_end(&bar, s, damping, &grid));
            Ok::<_, Error>(BarRules { design, rules: [end?, quarter?, center?] })
        };
        let zones = |design| {
            let bar = bar(design)?;
            let [a, b, c] = THRESHOLDS.map(|x| SuspendedZones::compute(&bar, x, damping, 2 * PLANE));
            Ok::<_, Error>([a?, b?, c?])
        };
        let holders = |design| Ok::<_, Error>(Holders::compute(&bar(design)?, damping, 2 * PLANE, ROWS)?);
        let fine: Vec<f64> = omegas(FINE).into_iter().filter(|omega| *omega <= FINE_TO).collect();
        let of_ratio = |zeta: f64| {
            let rule = rule_either_end(&bar(PHONE)?, 1.0, DampingRatio::new(zeta)?, &fine)?;
            Ok::<_, Error>((zeta, rule))
        };
        let shape = |(name, shape): (&'static str, Shape)| {
            let at = |k: u16| 0.1 * 100f64.powf(f64::from(k) / 400.0);
            let point = |k| Ok((at(k), amplification(shape, undamped, at(k))?));
            Ok::<_, Error>(Figures {
                name,
                curve: (0..=400).map(point).collect::<Result<_, clatter_shock::Error>>()?,
                undamped: ShapeFigures::new(shape, undamped)?,
                damped: ShapeFigures::new(shape, damping)?,
            })
        };
        let worst = |design| Ok::<_, Error>(worst(&bar(design)?, damping, SEARCH)?);
        Ok(Self {
            bars: each(rules)?,
            worst: each(worst)?,
            damping: [0.0, ZETA, 0.2, 1.0].into_iter().map(of_ratio).collect::<Result<_, _>>()?,
            gain: GainMap::compute(damping, GAIN_CELLS, PLANE)?,
            holders: [holders(DESIGNS[0])?, holders(DESIGNS[1])?],
            zones: each(zones)?,
            shapes: SHAPES.into_iter().map(shape).collect::<Result<_, _>>()?,
            phone: Phone::compute(damping)?,
        })
    }

    /// Returns figures as SVG, numbers as JSON.
    pub(crate) fn files(&self) -> Result<Vec<File>, Error> {
        let amplifications: Vec<_> = self.shapes.iter().map(|s| (s.name, s.curve.clone())).collect();
        let p = &self.phone;
        let name = "2 *v*_0 at once";
        let mut marks: Vec<([f64; 2], &str, &'static str)> = Vec::new();
        let at = |pulse: &Pulse| [pulse.velocity_change().abs(), pulse.amplitude.abs()];
        let hardest = p.train.iter().max_by(|a, b| a.amplitude.abs().total_cmp(&b.amplitude.abs()));
        if let Some(hardest) = hardest {
            marks.push((at(hardest), "hardest impact", "#ffffff"));
        }
        if let Some(equivalent) = &p.equivalent {
            marks.push((at(&equivalent.pulse), "equivalent half-sine", RUST));
        }
        Ok(vec![
            ("shock-rules.svg", rules::rules(&self.bars)?),
            ("shock-damping.svg", rules::damping(&self.damping)?),
            ("shock-gain.svg", rules::gain(&self.gain, &DESIGNS)?),
            ("shock-impact-1.svg", rules::holders(&self.holders[0], DESIGNS[0])?),
            ("shock-impact-2.svg", rules::holders(&self.holders[1], DESIGNS[1])?),
            ("shock-zones-1.svg", rules::zones(&self.zones[0], DESIGNS[0])?),
            ("shock-zones-2.svg", rules::zones(&self.zones[1], DESIGNS[1])?),
            ("shock-spectrum.svg", spectrum_compared(&p.acceleration[0], &p.acceleration[1], name)?),
            ("shock-velocity.svg", spectrum_compared(&p.velocity[0], &p.velocity[1], name)?),
            ("shock-pulses.svg", rules::amplifications(&amplifications)?),
            ("shock-models.svg", rules::models(&p.models())?),
            ("shock-boundary.svg", boundary((&p.boundary).into(), &p.curve, &marks, [230.0, 160.0])?),
            ("shock.json", pretty(&self.numbers())?),
        ])
    }

    /// Returns every number on the page.
    fn numbers(&self) -> Value {
        let bars = self.bars.iter().zip(&self.worst).map(|(bar, worst)| {
            let unit = 0.5 * bar.rules[0].standard.acceleration;
            let limits = bar.rules.iter().map(|rule| {
                json!({
                    "net": shown(rule.soft.acceleration / unit, 3),
                    "largest": shown(rule.stiff.map_or(f64::NAN, |s| s.acceleration) / unit, 3),
                })
            });
            json!({
                "q": bar.design[0], "e": bar.design[1],
                "places": limits.collect::<Vec<_>>(),
                "peak": shown(2.0 * worst.gain, 3),
                "gain": shown(worst.gain, 3),
                "gain_over_flat": shown(worst.gain_over_flat, 3),
                "omega": shown(worst.omega, 1),
                "over_largest": shown(100.0 * (over_largest(bar, worst) - 1.0), 0),
            })
        });
        let zones = self.zones.iter().zip(DESIGNS).flat_map(|(zones, [q, e])| {
            zones.iter().map(move |z| {
                json!({
                    "q": q, "e": e, "threshold": z.threshold,
                    "paper": zone(z.paper), "smallest": zone(z.smallest.0), "omega": shown(z.smallest.1, 2),
                    "softest": zone(z.zones.first().copied().flatten()),
                    "unsafe": shown(100.0 * z.share_unsafe, 0),
                })
            })
        });
        let shapes = self.shapes.iter().map(|s| {
            let of =
                |f: &ShapeFigures| json!([shown(f.amplification, 6), shown(f.frequency_duration, 5), shown(f.knee, 6)]);
            json!({ "name": s.name, "undamped": of(&s.undamped), "damped": of(&s.damped) })
        });
        let most_over_largest =
            self.bars.iter().zip(&self.worst).map(|(bar, worst)| over_largest(bar, worst)).fold(0.0_f64, f64::max);
        json!({
            "damping": ZETA,
            "omegas": OMEGAS,
            "bars": bars.collect::<Vec<_>>(),
            "most_over_largest": shown(100.0 * (most_over_largest - 1.0), 0),
            "undamped_peak": shown(self.damping.first().map_or(f64::NAN, |(_, rule)| highest(rule)), 2),
            "share_above": shown(100.0 * self.gain.share_above_1, 0),
            "share_of_shocks_above": shown(100.0 * self.gain.share_of_shocks_above_1, 0),
            "first": self.holders.iter().map(|h| shown(100.0 * h.share_of_first, 0)).collect::<Vec<_>>(),
            "zones": zones.collect::<Vec<_>>(),
            "shapes": shapes.collect::<Vec<_>>(),
            "phone": self.phone.numbers(),
        })
    }
}

impl Phone {
    /// Returns the estimates of simpler models, over the peak of the train of pulses.
    fn models(&self) -> [(&'static str, Vec<(f64, f64)>); 4] {
        let [train, _] = &self.acceleration;
        let over = |model: &[f64]| {
            let ratios = model.iter().zip(&train.maximax).map(|(estimate, peak)| estimate / peak);
            train.frequency_hz.iter().copied().zip(ratios).collect()
        };
        [
            ("net change of velocity", over(&self.models.net)),
            ("largest velocity shock", over(&self.models.largest)),
            ("hardest pulse alone", over(&self.models.alone)),
            ("train of velocity shocks", over(&self.models.shocks)),
        ]
    }

    fn numbers(&self) -> Value {
        let g = |a: f64| shown(a / STANDARD_GRAVITY_M_S2, 0);
        let overlaps = self.train.windows(2).filter(|w| w[1].start < w[0].start + w[0].duration).count();
        let times = |ratio: f64| shown(ratio, 2);
        let boards = self.boards.iter().map(|b| {
            json!({
                "hz": shown(b.hz, 0), "omega": shown(TAU * b.hz * GAP_M / SPEED_M_S, 2),
                "train": g(b.train), "alone": g(b.alone), "single": g(b.single),
                "over_alone": times(b.train / b.alone), "over_single": times(b.train / b.single),
            })
        });
        let [train, single] = &self.acceleration;
        let over = train.maximax.iter().zip(&single.maximax).map(|(t, s)| t / s);
        let most = train.frequency_hz.iter().copied().zip(over.clone()).max_by(|a, b| a.1.total_cmp(&b.1));
        let (most_hz, most) = most.unwrap_or((f64::NAN, f64::NAN));
        json!({
            "boards": boards.collect::<Vec<_>>(),
            "net_good_to_hz": shown(Models::good_to(&self.models.net, &self.acceleration[0], 0.05), 0),
            "shocks_good_to_hz": shown(Models::good_to(&self.models.shocks, &self.acceleration[0], 0.05), 0),
            "most_over_single": times(most), "most_over_single_hz": shown(most_hz, 0),
            "softest_over_single": times(over.clone().next().unwrap_or(f64::NAN)),
            "q": PHONE[0], "e": PHONE[1], "speed": SPEED_M_S, "gap_mm": shown(1e3 * GAP_M, 0),
            "contact_ms": shown(1e3 * CONTACT_S, 1), "board_hz": shown(BOARD_HZ, 0), "limit_g": shown(BOARD_LIMIT_G, 0),
            "impacts": self.train.len(), "overlaps": overlaps,
            "peak_g": g(self.margin.demand), "margin_db": shown(self.margin.decibel(), 2),
            "alone_g": g(self.alone.demand), "alone_db": shown(self.alone.decibel(), 2),
            "rattle_mm": shown(1e3 * self.response.relative_displacement.magnitude(), 2),
            "single_g": g(self.single.amplitude),
            "critical_velocity": shown(self.boundary.critical_velocity_change(), 2),
            "critical_g": g(self.boundary.critical_acceleration()),
            "equivalent": self.equivalent.map(|e| json!({
                "g": g(e.pulse.amplitude), "ms": shown(1e3 * e.pulse.duration, 2),
                "velocity": shown(e.pulse.velocity_change(), 2),
            })),
        })
    }
}

/// Returns one result for each design of the paper's table.
fn each<T>(of: impl Fn([f64; 2]) -> Result<T, Error>) -> Result<[T; 4], Error> {
    let [a, b, c, d] = DESIGNS.map(of);
    Ok([a?, b?, c?, d?])
}

/// Returns the worst peak over that of the largest single shock at the end.
fn over_largest(bar: &BarRules, worst: &Worst) -> f64 {
    bar.rules[0].stiff.map_or(f64::NAN, |stiff| worst.acceleration / stiff.acceleration)
}

/// Returns the largest peak over that of one shock of v0.
fn highest(rule: &Rule) -> f64 {
    rule.points.iter().map(|p| 2.0 * p.gain).fold(0.0, f64::max)
}

/// Returns a number with so many decimals, or the sign of infinity.
fn shown(value: f64, digits: usize) -> String {
    if value.is_infinite() { "∞".to_owned() } else { decimals(value, digits) }
}

/// Returns a zone in per cent, or `none`.
fn zone(s: Option<f64>) -> String {
    s.map_or("none".to_owned(), |s| shown(100.0 * s, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_stay_within_their_frame() {
        let files = Data::compute().unwrap().files().unwrap();
        crate::frame::stay_within_their_frame(&files);
    }
}
