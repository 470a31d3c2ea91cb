//! `clatter respond`: what one clatter does to one suspended component.

use std::io::{self, Write};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter::flight::{Scene, Stop};
use clatter::{Bar, End, Mass, Start};
use clatter_scene::{BarModel, Base, Law, Product, SingleDrop, Spread};
use clatter_shock::{
    DampingRatio, EquivalentPulse, Extreme, Extremes, Frequencies, ImpulseFactors, Pulses, Response, Rule,
    STANDARD_GRAVITY_M_S2, ShockTable, Suspension, VelocityShock, VelocityShocks, three_way_rule,
};
use serde::Serialize;

use crate::drop_args::{DropArgs, ModelName, Motion};
use crate::inputs::{self, DampingArgs, Format};
use crate::numbers::{Json, digits, figures, given};
use crate::output::{Kind, Target, buffered};
use crate::{Failure, Streams, excitation, lists, output};

/// Tell what a clatter does to a component on its suspension
///
/// The component sits at position S of the bar and swings with the natural angular frequency W. Every
/// impact is a velocity shock there; the peaks that follow are exact, from turning points and never
/// from samples, and the ring-down is complete. Only W h0/v0 and the damping matter:
///
///   W h0/v0 small   the component is slower than the whole clatter and sees the net change of
///                   velocity
///   W h0/v0 large   it has calmed down before the next impact, and the largest shock decides;
///                   without damping it never does, and the shocks add up by phase
///   between         the impacts can fall into step with it: resonance
///
/// Peaks are given as velocities: W z, of the displacement z relative to the bar, and A/W, of the
/// absolute acceleration A. A single velocity shock of 1 makes both 1 if there is no damping.
///
/// `-o FILE` writes this rule as a curve over W h0/v0: .csv, .json, or .svg for a picture.
///
/// What shakes the component is the clatter of the paper's bar, from --q and --e. Or it is
///
///   --model         a drop in SI units, followed by any of the models of `clatter simulate` and with
///                   its options: with gravity, real tilt, an off-center mass; W is then in rad/s.
///                   For compliant its pulses count, not only their velocity changes, to 1e-3 or so
///                   and until contacts are weak, as in `clatter assess`
///   --shocks-file   velocity shocks from a file in SI units, of any number, with the columns time_s
///                   and delta_v_m_s
///   --pulses-file   pulses, with the columns shape, amplitude_m_s2, duration_s and start_s; shapes
///                   as in `clatter spectrum --help`; they may overlap
///
/// --equivalent-pulse names the half-sine of a shock table that does the same to the component, in
/// acceleration and in relative displacement to 1 %, or says that there is none. For that everything
/// has to be in SI units, --velocity and --height-gap too.
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
  clatter respond --model=finite-tilt --length-m=0.14 --gyration-m=0.04 --e=0.3 --height-m=1.2 \\
      --tilt-deg=5 --at=1 --omega=1131 --equivalent-pulse         the same board, with gravity
  clatter respond --shocks-file=shocks.csv --omega=1131

'clatter --help' tells what q, e and the units are."
)]
pub(crate) struct Args {
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = inputs::restitution, required_unless_present_any = FILES, requires = "inertia")]
    e: Option<f64>,
    /// Position of the component, in [-1, 1]: -1 is end a, which strikes first, 0 the middle, 1 end b
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::position, required_unless_present_any = FILES)]
    at: Option<f64>,
    /// Natural angular frequency of the component (2π times its frequency), in v0/h0; in rad/s with --model or a file
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = inputs::omega)]
    omega: f64,
    #[command(flatten)]
    damping: DampingArgs,
    /// Velocities of ends a and b at first contact, upward positive; VA is negative: end a strikes
    #[arg(long, value_name = "VA,VB", default_value = "-1,-1", allow_hyphen_values = true, value_parser = inputs::velocity, conflicts_with = "model")]
    velocity: [f64; 2],
    /// Height of end b when end a first touches; 0 for a flat drop, whose impacts come all at once
    #[arg(long, value_name = "H0", default_value = "1", allow_hyphen_values = true, value_parser = inputs::height_gap, conflicts_with = "model")]
    height_gap: f64,
    /// Follow a drop in SI units by this model
    #[arg(long, value_enum, requires = "fall")]
    model: Option<ModelName>,
    #[command(flatten)]
    drop: DropArgs,
    /// Velocity shocks instead of a clatter: a CSV file with the columns time_s and delta_v_m_s, in order of time
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER)]
    shocks_file: Option<PathBuf>,
    /// Pulses instead of a clatter: a CSV file with the columns shape, amplitude_m_s2, duration_s and start_s
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER, conflicts_with = "shocks_file")]
    pulses_file: Option<PathBuf>,
    /// Also give the half-sine of a shock table that does the same to the component, or that there is none; in SI units
    /// alone
    #[arg(long)]
    equivalent_pulse: bool,
    /// What the shock table can do: its shortest and longest half-sine in ms, its highest acceleration in g, its
    /// largest velocity change in m/s
    #[arg(long, value_name = "MS:MS,G,M_S", default_value = "0.2:20,5000,20", allow_hyphen_values = true, value_parser = excitation::shock_table, requires = "equivalent_pulse")]
    shock_table: ShockTable,
    /// Also write the rule over W h0/v0 to this file, ending in .csv, .json or .svg
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target, conflicts_with_all = ["model", "shocks_file", "pulses_file"])]
    output: Option<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// What stands in place of a clatter, and what says a clatter.
const FILES: [&str; 2] = ["shocks_file", "pulses_file"];
const CLATTER: [&str; 9] = ["q", "gyration_ratio", "gyration_m", "mass", "e", "at", "velocity", "height_gap", "model"];

/// How the mass lies.
#[derive(Debug, clap::Args)]
#[group(id = "inertia", multiple = false)]
struct Inertia {
    /// Inertia ratio (L² - ρ²)/(L² + ρ²), in (-1, 1]: 0.5 for evenly spread mass, 1 for all mass at the center
    #[arg(long, value_name = "Q", allow_hyphen_values = true, value_parser = inputs::inertia_ratio, conflicts_with = "model")]
    q: Option<f64>,
    /// Instead of q: ρ/L, radius of gyration over half-length, exact also where q is within rounding of 1
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = inputs::gyration_ratio, conflicts_with = "model")]
    gyration_ratio: Option<f64>,
    /// Instead of q, with --model: radius of gyration about the center of mass, in m; length/√12 for evenly spread mass
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::number, requires = "model")]
    gyration_m: Option<f64>,
    /// Instead of q: a mass M in any unit at position S, or spread evenly from S to T, in half-lengths from the middle;
    /// given once for each piece, like --mass=2@-1:1 --mass=1@0.5; symmetric unless with --model
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = inputs::mass)]
    mass: Vec<Mass>,
}

impl Inertia {
    /// The paper's bar.
    fn bar(&self, e: f64) -> Result<Bar, clatter::Error> {
        match (self.q, self.gyration_ratio) {
            (_, Some(k)) => Bar::from_gyration_ratio(k, e),
            (Some(q), None) => Bar::new(q, e),
            // clap requires one of the three.
            (None, None) => Bar::from_masses(2.0, &self.mass, e),
        }
    }
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

/// What shakes the component.
enum Driven<'a> {
    Bar { bar: Bar, start: Start },
    Drop { model: ModelName, scene: Scene, stop: Stop },
    Shocks(&'a Path),
    Pulses(&'a Path),
}

/// What is shown.
struct Shaken<'a> {
    args: &'a Args,
    driven: Driven<'a>,
    suspension: Suspension,
    response: Response,
    /// Velocity changes at the place.
    shocks: VelocityShocks,
    /// Whether they take time.
    pulses: bool,
    /// Bound on what an endless train leaves out, where there is one.
    omitted: Option<f64>,
    equivalent: Option<Result<EquivalentPulse, String>>,
}

/// Angular frequencies whose squares, and times between, are floats beside the pulses', in rad/s.
const SWINGS: RangeInclusive<f64> = 1e-100..=1e100;
/// Mismatch of the relative displacement that an equivalent pulse may have.
const EQUIVALENT: f64 = 0.01;

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let shaken = self.shaken()?;
        if let Some(target) = &self.output {
            shaken.write_rule(target)?;
        }
        match self.format {
            Format::Table => shaken.table(streams.out).map_err(Failure::Answer)?,
            Format::Json => streams.json(&shaken.answer())?,
        }
        if let Driven::Drop { stop: Stop::ImpactLimit { .. } | Stop::TimeLimit { .. }, .. } = shaken.driven {
            streams.note("warning", "the motion was left at its limit; later impacts are not in the answer");
        }
        Ok(())
    }

    /// What clap requires unless there is a file.
    fn e(&self) -> f64 {
        self.e.unwrap_or(f64::NAN)
    }
    fn position(&self) -> f64 {
        self.at.unwrap_or(f64::NAN)
    }

    fn shaken(&self) -> Result<Shaken<'_>, Failure> {
        let suspension = Suspension::new(self.omega, self.damping.ratio()?)?;
        let (driven, response, shocks, omitted) = if let Some(path) = &self.shocks_file {
            let shocks = VelocityShocks::new(lists::shocks(path)?)?;
            (Driven::Shocks(path), shocks.respond(&suspension), shocks, Some(0.0))
        } else if let Some(path) = &self.pulses_file {
            let mut list = lists::pulses(path)?;
            if !SWINGS.contains(&self.omega) {
                let what = format!("--omega {:?} rad/s is not in [1e-100, 1e100], which pulses take", self.omega);
                return Err(Failure::Pulses(what));
            }
            let hz = Frequencies::list(vec![suspension.omega() / std::f64::consts::TAU])?;
            excitation::check_periods(&list, &hz).map_err(Failure::Pulses)?;
            let response = Pulses::new(&list)?.respond(&suspension);
            list.sort_by(|a, b| a.start.total_cmp(&b.start));
            let shock = |p: &clatter_shock::Pulse| VelocityShock { time: p.start, delta_v: p.velocity_change() };
            let shocks = VelocityShocks::new(list.iter().map(shock).collect())?;
            (Driven::Pulses(path), response, shocks, Some(0.0))
        } else if let Some(model) = self.model {
            self.drop(model, &suspension)?
        } else {
            let (bar, start) = (self.inertia.bar(self.e())?, Start::new(self.velocity, self.height_gap)?);
            if self.equivalent_pulse && start == Start::default() {
                return Err(Failure::Usage(
                    "--equivalent-pulse needs SI units: --velocity in m/s and --height-gap in m, --model, or a file",
                ));
            }
            let train = clatter_shock::respond(&bar, &start, self.position(), &suspension)?;
            (Driven::Bar { bar, start }, train.response, train.shocks, Some(train.omitted))
        };
        let pulses = matches!(driven, Driven::Pulses(_) | Driven::Drop { model: ModelName::Compliant, .. });
        let equivalent = if !self.equivalent_pulse {
            None
        } else if response.absolute_acceleration.magnitude() <= 0.0 {
            Some(Err("nothing is felt here, which no pulse does".to_owned()))
        } else {
            match self.shock_table.equivalent_half_sine(&suspension, &response, EQUIVALENT) {
                Err(none @ clatter_shock::Error::NoEquivalent { .. }) => Some(Err(none.to_string())),
                answer => Some(Ok(answer?)),
            }
        };
        Ok(Shaken { args: self, driven, suspension, response, shocks, pulses, omitted, equivalent })
    }

    /// A drop in SI units.
    fn drop(
        &self,
        model: ModelName,
        suspension: &Suspension,
    ) -> Result<(Driven<'_>, Response, VelocityShocks, Option<f64>), Failure> {
        let (e, s) = (self.e(), self.position());
        let (_, body) = self.drop.body(self.inertia.gyration_m, &self.inertia.mass, e)?;
        let scene = self.drop.scene(body, e)?;
        let motion = self.drop.motion(model, &scene)?;
        let stop = motion.flight().stop;
        let strikes = motion.flight().strikes.iter();
        let shocks = strikes.map(|strike| VelocityShock { time: strike.time_s, delta_v: strike.delta_v_at(s) });
        let shocks = VelocityShocks::new(shocks.collect())?;
        let omitted = matches!(stop, Stop::BouncedClear { .. }).then_some(0.0);
        let response = match motion {
            Motion::Instant(..) => shocks.respond(suspension),
            Motion::Compliant(..) if scene.spin_rad_s() != 0.0 || self.drop.is_cut_short() => {
                return Err(Failure::Usage(
                    "respond takes --spin-rad-s, --time-limit-s and --impact-limit with the models of instant impacts alone",
                ));
            }
            Motion::Compliant(contact_time_s, _) => {
                let product = Product {
                    name: String::new(),
                    body,
                    mass_kg: None,
                    restitution: Spread::new(e, e, Law::Value)?,
                    contact_time_s: Some(contact_time_s),
                };
                let drop = SingleDrop {
                    first: End::A,
                    tilt_rad: scene.tilt_rad(),
                    speed_m_s: scene.speed_m_s(),
                    restitution: e,
                    gravity_m_s2: scene.gravity_m_s2(),
                };
                let base = Base::new(&product, &drop, BarModel::Compliant)?;
                base.respond(0.5 * s * body.length_m(), suspension, true)?
            }
        };
        Ok((Driven::Drop { model, scene, stop }, response, shocks, omitted))
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

    /// The speed and the height that a clatter begins with: of the end that strikes first, and of the other one.
    fn start(&self) -> Option<[f64; 2]> {
        match &self.driven {
            Driven::Bar { start, .. } => Some([-start.velocity()[0], start.height_gap()]),
            Driven::Drop { scene, .. } => {
                let turning = scene.body().arms_m()[0] * scene.tilt_rad().cos() * scene.spin_rad_s();
                Some([scene.speed_m_s() + turning, scene.height_gap_m()])
            }
            Driven::Shocks(_) | Driven::Pulses(_) => None,
        }
    }

    /// W h0/v0.
    fn ratio(&self) -> Option<f64> {
        self.start().map(|[v0, h0]| self.args.omega * h0 / v0)
    }

    /// The clatter-free impact: all of the bar stops or rebounds at once, without spin; and what standards assume.
    fn clatter_free(&self) -> Option<[f64; 2]> {
        self.start().map(|[v0, _]| [(1.0 + self.args.e()) * v0, 2.0 * v0])
    }

    /// Peaks of a component so stiff that it has calmed down before the next shock; pulses it follows.
    fn stiff(&self) -> Option<ImpulseFactors> {
        self.shocks.stiff_limit(self.damping()).filter(|_| !self.pulses)
    }

    fn impulse(&self, delta_v: f64) -> ImpulseFactors {
        self.damping().impulse_factors().times(delta_v)
    }

    /// Peak acceleration over that of one shock of 2 v0.
    fn gain(&self) -> Option<f64> {
        let peak = self.response.acceleration_over_omega().magnitude();
        self.clatter_free().map(|[_, standard]| peak / self.impulse(standard).acceleration)
    }

    fn write_rule(&self, target: &Target) -> Result<(), Failure> {
        let (Driven::Bar { bar, start }, Some(ratio)) = (&self.driven, self.ratio()) else { return Ok(()) };
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
        let rule = three_way_rule(bar, start, self.args.position(), self.damping(), &omegas)?;
        let response = &self.response;
        output::replace(&target.path, |file| match target.kind {
            Kind::Csv => buffered(file, |out| csv(&rule, out)),
            Kind::Svg => {
                let peak = response.acceleration_over_omega().magnitude() / -start.velocity()[0];
                file.write_all(clatter_report::rule_svg(&rule, [ratio, peak]).as_bytes())
            }
            Kind::Json | Kind::Npy => buffered(file, |out| Ok(serde_json::to_writer(out, &RuleJson::new(&rule))?)),
        })
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (omega, zeta) = (given(self.args.omega), given(self.damping().get()));
        let at = given(self.args.position());
        match &self.driven {
            Driven::Bar { bar, start } => {
                let (q, e) = (given(bar.q()), given(bar.e()));
                writeln!(
                    out,
                    "Component at {at} of a bar with q = {q}, e = {e}; W = {omega} v0/h0, damping ratio {zeta}"
                )?;
                let [va, vb] = start.velocity().map(given);
                let gap = given(start.height_gap());
                writeln!(out, "End a strikes first, at {va} v0; end b comes with {vb} v0 from {gap} h0\n")
            }
            Driven::Drop { model, scene, stop } => {
                let (name, e) = (model.name(), given(scene.e()));
                let (length, speed) =
                    (given(scene.body().length_m()), figures(self.start().map_or(f64::NAN, |[v0, _]| v0)));
                let tilt = given(self.args.drop.tilt_deg());
                writeln!(
                    out,
                    "Component at {at} of a body of {length} m, e = {e}; W = {omega} rad/s, damping ratio {zeta}"
                )?;
                let (reason, time) = (stop.reason(), figures(stop.time_s()));
                writeln!(
                    out,
                    "Model {name}: end a strikes first, at {speed} m/s, tilt {tilt} degrees; {reason} at {time} s\n"
                )
            }
            Driven::Shocks(path) | Driven::Pulses(path) => {
                let kind = if self.pulses { "pulses" } else { "velocity shocks" };
                let (path, count) = (path.display(), self.shocks.as_slice().len());
                writeln!(out, "Component of W = {omega} rad/s, damping ratio {zeta}")?;
                writeln!(out, "{path}: {count} {kind}\n")
            }
        }
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let [speed, time] = if matches!(self.driven, Driven::Bar { .. }) { ["v0", "h0/v0"] } else { ["m/s", "s"] };
        let (when, shock) = (format!("when, {time}"), format!("shock, {speed}"));
        writeln!(out, "{:<34}{speed:>12} {when:>13}", "Peak")?;
        let z = self.response.pseudo_velocity();
        let (v, a) = (self.response.relative_velocity, self.response.acceleration_over_omega());
        for (name, extremes) in
            [("relative displacement, W z", z), ("relative velocity", v), ("absolute acceleration, A/W", a)]
        {
            let peak = extremes.peak();
            let size = figures(peak.value.abs());
            writeln!(out, "  {name:<32}{size:>12} {:>13}  {}", figures(peak.time), self.holder(peak))?;
        }
        let (wz, aw) = (format!("W z, {speed}"), format!("A/W, {speed}"));
        writeln!(out, "\n{:<34}{shock:>12} {wz:>13} {aw:>13}", "A shock at this position")?;
        let shocks = &self.shocks;
        let mut row = |name: &str, shock: Option<f64>, peaks: Option<ImpulseFactors>| {
            let show = |x: Option<f64>| x.map_or("-".to_owned(), figures);
            let (z, a) = (show(peaks.map(|p| p.displacement)), show(peaks.map(|p| p.acceleration)));
            writeln!(out, "  {name:<32}{:>12} {z:>13} {a:>13}", show(shock))
        };
        row("of the net change (W h0/v0 -> 0)", Some(shocks.net().abs()), Some(shocks.soft_limit(self.damping())))?;
        row("the largest (W h0/v0 -> infinity)", Some(shocks.largest()), self.stiff())?;
        if let Some([flat, standard]) = self.clatter_free() {
            row("without clatter, (1 + e) v0", Some(flat), Some(self.impulse(flat)))?;
            row("as standards assume, 2 v0", Some(standard), Some(self.impulse(standard)))?;
        }
        if let (Some(ratio), Some(gain)) = (self.ratio(), self.gain()) {
            let (ratio, gain) = (figures(ratio), figures(gain));
            writeln!(out, "\nW h0/v0 = {ratio}; acceleration over that of the standards' shock: {gain}")?;
        }
        if let Some(omitted) = self.omitted.filter(|omitted| *omitted > 0.0) {
            writeln!(out, "The impacts never end; what was left out changes W z by {} v0 at most", figures(omitted))?;
        }
        match &self.equivalent {
            None => Ok(()),
            Some(Err(none)) => writeln!(out, "\nShock table: {none}"),
            Some(Ok(EquivalentPulse { pulse, displacement_mismatch })) => {
                let (g, ms) = (figures(pulse.amplitude / STANDARD_GRAVITY_M_S2), figures(1e3 * pulse.duration));
                let velocity = figures(pulse.velocity_change());
                let off = figures(100.0 * displacement_mismatch);
                writeln!(
                    out,
                    "\nShock table: a half-sine of {g} g and {ms} ms (velocity change {velocity} m/s) gives the component the\n\
                     same acceleration, and a relative displacement that differs by {off} %"
                )
            }
        }
    }

    /// Number of the impact, shock or pulse that an extreme follows.
    fn number(&self, extreme: Extreme) -> usize {
        if self.pulses {
            return self.shocks.as_slice().partition_point(|shock| shock.time <= extreme.time).max(1);
        }
        extreme.interval + 1
    }

    /// The same in words.
    fn holder(&self, peak: Extreme) -> String {
        if peak.value.abs() <= 0.0 {
            return "no impact is felt here".to_owned();
        }
        let what = match &self.driven {
            Driven::Bar { .. } | Driven::Drop { .. } => "impact",
            Driven::Shocks(_) => "shock",
            Driven::Pulses(_) => "the start of pulse",
        };
        let number = self.number(peak);
        let last = if number == self.shocks.as_slice().len() { ", the last" } else { "" };
        format!("after {what} {number}{last}")
    }

    fn answer(&self) -> Answer<'_> {
        let (shocks, omega) = (&self.shocks, self.args.omega);
        let acceleration = self.response.acceleration_over_omega();
        let extremes = |extremes: Extremes| ExtremesJson::new(extremes, |extreme| self.number(extreme));
        let at_once = self.clatter_free();
        Answer {
            driven: DrivenJson::new(&self.driven),
            at: self.args.at.map(Json),
            omega: Json(omega),
            damping: Json(self.damping().get()),
            omega_peak_relative_displacement: Json(self.response.pseudo_velocity().magnitude()),
            peak_absolute_acceleration_over_omega: Json(acceleration.magnitude()),
            time_of_peak: Json(acceleration.peak().time),
            peaks: PeaksJson {
                omega_relative_displacement: extremes(self.response.pseudo_velocity()),
                relative_velocity: extremes(self.response.relative_velocity),
                absolute_acceleration_over_omega: extremes(acceleration),
            },
            shocks: ShocksJson {
                count: shocks.as_slice().len(),
                net: Json(shocks.net()),
                largest: Json(shocks.largest()),
                omitted: self.omitted.map(Json),
            },
            soft: shocks.soft_limit(self.damping()).into(),
            stiff: self.stiff().map(Into::into),
            clatter_free: at_once.map(|[flat, _]| self.impulse(flat).into()),
            standard: at_once.map(|[_, standard]| self.impulse(standard).into()),
            gain: self.gain().map(Json),
            equivalent_pulse: self.equivalent.as_ref().map(EquivalentJson::new),
            no_equivalent_pulse: self.equivalent.as_ref().and_then(|e| e.as_ref().err().cloned()),
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
struct Answer<'a> {
    #[serde(flatten)]
    driven: DrivenJson<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<Json>,
    omega: Json,
    damping: Json,
    omega_peak_relative_displacement: Json,
    peak_absolute_acceleration_over_omega: Json,
    /// Of the absolute acceleration; the other times are below `peaks`.
    time_of_peak: Json,
    peaks: PeaksJson,
    shocks: ShocksJson,
    soft: FactorsJson,
    /// Null without damping, and for pulses.
    stiff: Option<FactorsJson>,
    /// These three of clatters alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    clatter_free: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    standard: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gain: Option<Json>,
    /// Where it is asked for; null, with the reason, where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    equivalent_pulse: Option<EquivalentJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_equivalent_pulse: Option<String>,
}

/// What shakes the component.
#[derive(Serialize)]
#[serde(untagged)]
enum DrivenJson<'a> {
    Bar {
        q: Json,
        gyration_ratio: Json,
        e: Json,
        velocity: [Json; 2],
        height_gap: Json,
    },
    Drop {
        model: &'static str,
        length_m: Json,
        gyration_m: Json,
        inertia_ratios: [Json; 2],
        e: Json,
        speed_m_s: Json,
        height_gap_m: Json,
        gravity_m_s2: Json,
        stop: &'static str,
        stop_s: Json,
    },
    File {
        file: &'a Path,
    },
}

impl<'a> DrivenJson<'a> {
    fn new(driven: &Driven<'a>) -> Self {
        match driven {
            Driven::Bar { bar, start } => Self::Bar {
                q: Json(bar.q()),
                gyration_ratio: Json(bar.gyration_ratio()),
                e: Json(bar.e()),
                velocity: start.velocity().map(Json),
                height_gap: Json(start.height_gap()),
            },
            Driven::Drop { model, scene, stop } => Self::Drop {
                model: model.name(),
                length_m: Json(scene.body().length_m()),
                gyration_m: Json(scene.body().gyration_m()),
                inertia_ratios: scene.body().inertia_ratios().map(Json),
                e: Json(scene.e()),
                speed_m_s: Json(scene.speed_m_s()),
                height_gap_m: Json(scene.height_gap_m()),
                gravity_m_s2: Json(scene.gravity_m_s2()),
                stop: stop.reason(),
                stop_s: Json(stop.time_s()),
            },
            Driven::Shocks(file) | Driven::Pulses(file) => Self::File { file },
        }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum EquivalentJson {
    /// Null.
    None,
    HalfSine {
        shape: &'static str,
        acceleration_m_s2: Json,
        acceleration_g: Json,
        duration_s: Json,
        velocity_change_m_s: Json,
        /// Its relative displacement over that of the component, less 1.
        displacement_mismatch: Json,
    },
}

impl EquivalentJson {
    fn new(equivalent: &Result<EquivalentPulse, String>) -> Self {
        let Ok(EquivalentPulse { pulse, displacement_mismatch }) = equivalent else { return Self::None };
        Self::HalfSine {
            shape: "half-sine",
            acceleration_m_s2: Json(pulse.amplitude),
            acceleration_g: Json(pulse.amplitude / STANDARD_GRAVITY_M_S2),
            duration_s: Json(pulse.duration),
            velocity_change_m_s: Json(pulse.velocity_change()),
            displacement_mismatch: Json(*displacement_mismatch),
        }
    }
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
    fn new(extremes: Extremes, number: impl Fn(Extreme) -> usize) -> Self {
        let extreme = |e: Extreme| ExtremeJson { value: Json(e.value), time: Json(e.time), after_impact: number(e) };
        Self { positive: extreme(extremes.positive), negative: extreme(extremes.negative) }
    }
}

#[derive(Serialize)]
struct ShocksJson {
    count: usize,
    net: Json,
    largest: Json,
    /// Null where a motion ends at rest, after shocks below 2^-52 of the largest, or at a limit.
    omitted: Option<Json>,
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
