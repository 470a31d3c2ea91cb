//! `clatter respond`: what one clatter does to one suspended component.

use std::io::{self, Write};

use clap::ValueHint;
use clatter::{Bar, Start};
use clatter_shock::{
    DampingRatio, Extreme, Extremes, ImpulseFactors, Rule, Suspension, TrainResponse, VelocityShocks, three_way_rule,
};
use serde::Serialize;

use crate::inputs::{self, BarArgs, DampingArgs, Format};
use crate::numbers::{Json, digits, figures, given};
use crate::output::{Kind, Target, buffered};
use crate::{Failure, Streams, output};

/// Tell what a clatter does to a component on its suspension
///
/// The component sits at position S of the bar and swings with the natural angular frequency W. Every impact is a
/// velocity shock there; the peaks that follow are exact, from turning points and never from samples, and the
/// ring-down is complete. Only W h0/v0 and the damping matter:
///
///   W h0/v0 small   the component is slower than the whole clatter and sees the net change of velocity
///   W h0/v0 large   it has calmed down before the next impact, and the largest shock decides; without
///                   damping it never does, and the shocks add up by phase
///   between         the impacts can fall into step with it: resonance
///
/// Peaks are given as velocities: W z, of the displacement z relative to the bar, and A/W, of the absolute
/// acceleration A. A single velocity shock of 1 makes both 1 if there is no damping.
///
/// `-o FILE` writes this rule as a curve over W h0/v0: .csv, .json, or .svg for a picture.
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter respond --q=0.73 --e=0.2 --at=1 --omega=3               a part at the end that strikes second
  clatter respond --q=0.73 --e=0.2 --at=0 --omega=3 --damping=0   in the middle, without damping
  clatter respond --q=0.5 --e=0.3 --at=1 --omega=1131 --velocity=-4.85,-4.85 --height-gap=0.005
                                    a board mode of 180 Hz in a phone dropped from 1.2 m, all in SI
  clatter respond --q=0.73 --e=0.2 --at=1 --omega=3 -o rule.svg   the three-way rule, drawn

'clatter --help' tells what q, e and the units are."
)]
pub(crate) struct Args {
    #[command(flatten)]
    bar: BarArgs,
    /// Position of the component, in [-1, 1]: -1 is the end that strikes first, 0 the center
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::position)]
    at: f64,
    /// Natural angular frequency of the component (2π times its frequency), in v0/h0
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = inputs::omega)]
    omega: f64,
    #[command(flatten)]
    damping: DampingArgs,
    /// Velocities of ends a and b at first contact, upward positive; VA is negative: end a strikes
    #[arg(long, value_name = "VA,VB", default_value = "-1,-1", allow_hyphen_values = true, value_parser = inputs::velocity)]
    velocity: [f64; 2],
    /// Height of end b when end a first touches; 0 for a flat drop, whose impacts come all at once
    #[arg(long, value_name = "H0", default_value = "1", allow_hyphen_values = true, value_parser = inputs::height_gap)]
    height_gap: f64,
    /// Also write the rule over W h0/v0 to this file, ending in .csv, .json or .svg
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Option<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

/// What is shown.
struct Shaken<'a> {
    args: &'a Args,
    bar: Bar,
    start: Start,
    suspension: Suspension,
    train: TrainResponse,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let (bar, start) = (self.bar.bar()?, Start::new(self.velocity, self.height_gap)?);
        let suspension = Suspension::new(self.omega, self.damping.ratio()?)?;
        let train = clatter_shock::respond(&bar, &start, self.at, &suspension)?;
        let shaken = Shaken { args: self, bar, start, suspension, train };
        if let Some(target) = &self.output {
            shaken.write_rule(target)?;
        }
        match self.format {
            Format::Table => shaken.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&shaken.answer()),
        }
    }
}

/// The least and the largest W h0/v0 that the rule is drawn over, unless the component lies beyond.
const DRAWN: [f64; 2] = [1e-2, 1e3];
/// Points of the rule to a decade, and in all.
const POINTS: [f64; 2] = [100.0, 4000.0];

impl Shaken<'_> {
    fn damping(&self) -> DampingRatio {
        self.suspension.damping()
    }

    fn shocks(&self) -> &VelocityShocks {
        &self.train.shocks
    }

    /// The speed of the end that strikes first.
    fn v0(&self) -> f64 {
        -self.start.velocity()[0]
    }

    /// W h0/v0.
    fn ratio(&self) -> f64 {
        self.args.omega * self.start.height_gap() / self.v0()
    }

    /// The clatter-free impact: all of the bar stops or rebounds at once, without spin.
    fn flat(&self) -> f64 {
        (1.0 + self.bar.e()) * self.v0()
    }

    fn impulse(&self, delta_v: f64) -> ImpulseFactors {
        self.damping().impulse_factors().times(delta_v)
    }

    /// Peak acceleration over that of one shock of 2 v0.
    fn gain(&self) -> f64 {
        let peak = self.train.response.acceleration_over_omega().magnitude();
        peak / self.impulse(2.0 * self.v0()).acceleration
    }

    fn write_rule(&self, target: &Target) -> Result<(), Failure> {
        let ratio = self.ratio();
        if ratio == 0.0 {
            return Err(Failure::Usage("a flat drop has no rule over W h0/v0; give a --height-gap above 0"));
        }
        let (low, high) = (DRAWN[0].min(0.1 * ratio).max(1e-300), DRAWN[1].max(10.0 * ratio).min(1e300));
        let steps = (POINTS[0] * (high / low).log10()).ceil().min(POINTS[1]);
        let mut omegas = Vec::new();
        let mut i = 0.0;
        while i <= steps {
            omegas.push(low * (high / low).powf(i / steps));
            i += 1.0;
        }
        let rule = three_way_rule(&self.bar, &self.start, self.args.at, self.damping(), &omegas)?;
        let response = &self.train.response;
        output::replace(&target.path, |file| match target.kind {
            Kind::Csv => buffered(file, |out| csv(&rule, out)),
            Kind::Svg => {
                let v = self.v0();
                let peak = response.acceleration_over_omega().magnitude() / v;
                file.write_all(clatter_report::rule_svg(&rule, [ratio, peak]).as_bytes())
            }
            Kind::Json | Kind::Npy => buffered(file, |out| Ok(serde_json::to_writer(out, &RuleJson::new(&rule))?)),
        })
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let (q, e, at) = (given(self.bar.q()), given(self.bar.e()), given(self.args.at));
        let (omega, zeta) = (given(self.args.omega), given(self.damping().get()));
        writeln!(out, "Component at {at} of a bar with q = {q}, e = {e}; W = {omega} v0/h0, damping ratio {zeta}")?;
        let [va, vb] = self.start.velocity().map(given);
        let gap = given(self.start.height_gap());
        writeln!(out, "End a strikes first, at {va} v0; end b comes with {vb} v0 from {gap} h0\n")?;
        writeln!(out, "{:<34}{:>12} {:>13}", "Peak", "v0", "when, h0/v0")?;
        let response = &self.train.response;
        let z = response.pseudo_velocity();
        let (v, a) = (response.relative_velocity, response.acceleration_over_omega());
        for (name, extremes) in
            [("relative displacement, W z", z), ("relative velocity", v), ("absolute acceleration, A/W", a)]
        {
            let peak = extremes.peak();
            let size = figures(peak.value.abs());
            writeln!(out, "  {name:<32}{size:>12} {:>13}  {}", figures(peak.time), self.holder(peak))?;
        }
        writeln!(out, "\n{:<34}{:>12} {:>13} {:>13}", "A shock at this position", "shock, v0", "W z, v0", "A/W, v0")?;
        let shocks = self.shocks();
        let mut row = |name: &str, shock: Option<f64>, peaks: Option<ImpulseFactors>| {
            let show = |x: Option<f64>| x.map_or("-".to_owned(), figures);
            let (z, a) = (show(peaks.map(|p| p.displacement)), show(peaks.map(|p| p.acceleration)));
            writeln!(out, "  {name:<32}{:>12} {z:>13} {a:>13}", show(shock))
        };
        row("of the net change (W h0/v0 -> 0)", Some(shocks.net().abs()), Some(shocks.soft_limit(self.damping())))?;
        row("the largest (W h0/v0 -> infinity)", Some(shocks.largest()), shocks.stiff_limit(self.damping()))?;
        row("without clatter, (1 + e) v0", Some(self.flat()), Some(self.impulse(self.flat())))?;
        row("as standards assume, 2 v0", Some(2.0 * self.v0()), Some(self.impulse(2.0 * self.v0())))?;
        writeln!(
            out,
            "\nW h0/v0 = {}; acceleration over that of the standards' shock: {}",
            figures(self.ratio()),
            figures(self.gain())
        )?;
        if self.train.omitted > 0.0 {
            writeln!(
                out,
                "The impacts never end; what was left out changes W z by {} v0 at most",
                figures(self.train.omitted)
            )?;
        }
        Ok(())
    }

    /// Which impact the peak follows, in words.
    fn holder(&self, peak: Extreme) -> String {
        if peak.value.abs() <= 0.0 {
            return "no impact is felt here".to_owned();
        }
        let number = peak.interval + 1;
        let count = self.shocks().as_slice().len();
        if number == count { format!("after impact {number}, the last") } else { format!("after impact {number}") }
    }

    fn answer(&self) -> Answer {
        let response = &self.train.response;
        let (shocks, omega) = (self.shocks(), self.args.omega);
        let acceleration = response.acceleration_over_omega();
        Answer {
            q: Json(self.bar.q()),
            gyration_ratio: Json(self.bar.gyration_ratio()),
            e: Json(self.bar.e()),
            velocity: self.start.velocity().map(Json),
            height_gap: Json(self.start.height_gap()),
            at: Json(self.args.at),
            omega: Json(omega),
            damping: Json(self.damping().get()),
            omega_peak_relative_displacement: Json(response.pseudo_velocity().magnitude()),
            peak_absolute_acceleration_over_omega: Json(acceleration.magnitude()),
            time_of_peak: Json(acceleration.peak().time),
            peaks: PeaksJson {
                omega_relative_displacement: ExtremesJson::new(response.pseudo_velocity()),
                relative_velocity: ExtremesJson::new(response.relative_velocity),
                absolute_acceleration_over_omega: ExtremesJson::new(acceleration),
            },
            shocks: ShocksJson {
                count: shocks.as_slice().len(),
                net: Json(shocks.net()),
                largest: Json(shocks.largest()),
                omitted: Json(self.train.omitted),
            },
            soft: shocks.soft_limit(self.damping()).into(),
            stiff: shocks.stiff_limit(self.damping()).map(Into::into),
            clatter_free: self.impulse(self.flat()).into(),
            standard: self.impulse(2.0 * self.v0()).into(),
            gain: Json(self.gain()),
        }
    }
}

fn csv(rule: &Rule, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "omega,displacement,acceleration,gain")?;
    rule.points.iter().try_for_each(|p| {
        let [w, z, a, gain] = [p.omega, p.displacement, p.acceleration, p.gain].map(digits);
        writeln!(out, "{w},{z},{a},{gain}")
    })
}

#[derive(Serialize)]
struct Answer {
    q: Json,
    gyration_ratio: Json,
    e: Json,
    velocity: [Json; 2],
    height_gap: Json,
    at: Json,
    omega: Json,
    damping: Json,
    omega_peak_relative_displacement: Json,
    peak_absolute_acceleration_over_omega: Json,
    /// Of the absolute acceleration; the other times are below `peaks`.
    time_of_peak: Json,
    peaks: PeaksJson,
    shocks: ShocksJson,
    soft: FactorsJson,
    /// Null without damping.
    stiff: Option<FactorsJson>,
    clatter_free: FactorsJson,
    standard: FactorsJson,
    gain: Json,
}

#[derive(Serialize)]
struct PeaksJson {
    omega_relative_displacement: ExtremesJson,
    relative_velocity: ExtremesJson,
    absolute_acceleration_over_omega: ExtremesJson,
}

#[derive(Serialize)]
struct ExtremesJson {
    positive: ExtremeJson,
    negative: ExtremeJson,
}

#[derive(Serialize)]
struct ExtremeJson {
    value: Json,
    time: Json,
    after_impact: usize,
}

impl ExtremesJson {
    fn new(extremes: Extremes) -> Self {
        let extreme =
            |e: Extreme| ExtremeJson { value: Json(e.value), time: Json(e.time), after_impact: e.interval + 1 };
        Self { positive: extreme(extremes.positive), negative: extreme(extremes.negative) }
    }
}

#[derive(Serialize)]
struct ShocksJson {
    count: usize,
    net: Json,
    largest: Json,
    omitted: Json,
}

#[derive(Serialize)]
struct FactorsJson {
    omega_peak_relative_displacement: Json,
    peak_absolute_acceleration_over_omega: Json,
}

impl From<ImpulseFactors> for FactorsJson {
    fn from(factors: ImpulseFactors) -> Self {
        Self {
            omega_peak_relative_displacement: Json(factors.displacement),
            peak_absolute_acceleration_over_omega: Json(factors.acceleration),
        }
    }
}

#[derive(Serialize)]
struct RuleJson {
    omega: Vec<Json>,
    displacement: Vec<Json>,
    acceleration: Vec<Json>,
    gain: Vec<Json>,
    soft: FactorsJson,
    stiff: Option<FactorsJson>,
    standard: FactorsJson,
}

impl RuleJson {
    fn new(rule: &Rule) -> Self {
        let all = |of: fn(&clatter_shock::RulePoint) -> f64| rule.points.iter().map(|p| Json(of(p))).collect();
        Self {
            omega: all(|p| p.omega),
            displacement: all(|p| p.displacement),
            acceleration: all(|p| p.acceleration),
            gain: all(|p| p.gain),
            soft: rule.soft.into(),
            stiff: rule.stiff.map(Into::into),
            standard: rule.standard.into(),
        }
    }
}
