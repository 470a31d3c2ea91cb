//! `clatter impacts`: the train of impacts of one bar or plate, its peak and what it amounts to.

mod plate;

use std::io::{self, Write};

use clatter::{Count, End, Impact, OffCenterBar, PeakImpact, Start, Summary};
use serde::{Serialize, Serializer};

use crate::inputs::{self, FallingBody, OffCenterArgs, RowFormat, Values, letter};
use crate::numbers::{Json, JsonCount, digits, figures, given};
use crate::{Failure, Streams, columns};

/// List the impacts of one drop and what they amount to
///
/// The bar falls with velocities VA and VB of its ends; end a strikes first, at time 0. The number of impacts is exact
/// up to 2^64, and like the rest of the summary it comes at once: no impact is followed for it. The one exception are
/// masses (--mass) so close to where the count changes that the rounding of their center of mass and radius of gyration
/// decides: the count is then that of the rounded bar, and "count_exact" is false.
///
/// A plate (--gyration-ratio=KX,KY) is followed impact by impact, the order of its corners exact: for as many impacts as
/// --limit asks, at least 1000. Where it has not ended by then, and two corners alternating for ever are not what it does,
/// "count" is how many were followed and "count_exact" is false. Two corners that come down at one instant are a tie: it
/// is told, and taken as a tilt that differs by next to nothing.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter impacts --q=0.5 --e=0.3                        a uniform bar in a moderately damped casing
  clatter impacts --q=0.5 --e=0.3 --at=0 --at=0.5        also the shocks of parts at these positions
  clatter impacts --q=0.5 --e=0.3 --velocity=-1,0.5      it turns as it falls
  clatter impacts --mass=2@-1:1 --mass=1@0.5 --e=0.3     a uniform bar with a battery halfway to end b
  clatter impacts --gyration-ratio=0.01 --e=0.3 --limit=20 --format=json
  clatter impacts --gyration-ratio=0.577,0.577 --e=0.3 --height-gap=2,1 --at=0,0
                                                         a uniform plate, b twice as high as d

'clatter --help' tells what q, e and the units are.")]
pub(crate) struct Args {
    #[command(flatten)]
    bar: OffCenterArgs,
    /// Velocities of ends a and b at first contact, upward positive, in v0; VA is negative: end a strikes; VA,VB,VD of three
    /// corners for a plate [default: -1 each]
    #[arg(long, value_name = "VA,VB", allow_hyphen_values = true, value_parser = inputs::velocities)]
    velocity: Option<Values<2, 3>>,
    /// Height of end b when end a first touches, in h0; 0 for a flat drop, whose impacts come all at once; HX,HY of corners b
    /// and d for a plate [default: 1 each]
    #[arg(long, value_name = "H0", allow_hyphen_values = true, value_parser = inputs::height_gaps)]
    height_gap: Option<Values<1, 2>>,
    /// Also give the velocity shocks at this position, in [-1, 1]: -1 is end a, 0 the middle, 1 end b; X,Y on a plate; may
    /// be given several times
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::positions)]
    at: Vec<Values<1, 2>>,
    /// List at most so many impacts
    #[arg(long, value_name = "N", default_value = "1000", allow_hyphen_values = true, value_parser = inputs::limit)]
    limit: usize,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

/// Everything that is shown of one drop; the impacts are made while they are written, so no list is too long.
struct Drop<'a> {
    bar: OffCenterBar,
    start: Start,
    summary: Summary,
    at: &'a [f64],
    limit: usize,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let bar = match self.bar.body()? {
            FallingBody::Bar(bar) => bar,
            FallingBody::Plate(plate) => return self.plate(&plate, streams),
        };
        let velocity = self.velocity.map_or(Ok([-1.0; 2]), |v| v.of_bar("--velocity"))?;
        let [gap] = self.height_gap.map_or(Ok([1.0]), |gap| gap.of_bar("--height-gap"))?;
        let at: Vec<f64> = self.at.iter().map(|s| s.of_bar("--at").map(|[s]| s)).collect::<Result<_, _>>()?;
        let start = Start::new(velocity, gap)?;
        let drop = Drop { bar, start, summary: bar.summary(&start), at: &at, limit: self.limit };
        match self.format {
            RowFormat::Table => {
                drop.table(streams.out).map_err(Failure::Answer)?;
                if let Some(warning) = drop.cut_short() {
                    streams.note("warning", warning);
                }
            }
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.long_json(&drop.answer())?,
        }
        self.bar.slips().for_each(|slip| streams.note("warning", slip));
        Ok(())
    }
}

impl Drop<'_> {
    fn impacts(&self) -> impl Iterator<Item = Impact> {
        self.bar.train(&self.start).take(self.limit)
    }

    fn cut_short(&self) -> Option<String> {
        let listed = self.limit;
        let of = match self.summary.count {
            _ if listed == 0 => return None, // the summary alone was asked for
            Count::Finite(n) if u64::try_from(listed).is_ok_and(|listed| listed >= n) => return None,
            Count::Finite(n) => format!("{n} impacts"),
            Count::Huge(n) => format!("about {} impacts", figures(n)),
            Count::Endless => "endless impacts".to_owned(),
        };
        Some(format!("listed {listed} of {of}; --limit=N lists more"))
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let (Summary { count, duration, peak, final_velocity, net }, [va, vb]) = (self.summary, self.start.velocity());
        let (e, gap) = (given(self.bar.e()), given(self.start.height_gap()));
        let gyration = figures(self.bar.gyration_ratio());
        let symmetric = self.bar.is_symmetric();
        if symmetric {
            let q = given(self.bar.q());
            writeln!(out, "Bar with q = {q}, e = {e}; radius of gyration {gyration} of the half-length")?;
        } else {
            let (c, q) = (figures(self.bar.center_of_mass()), figures(self.bar.q()));
            let [qa, qb] = self.bar.inertia_ratios().map(figures);
            writeln!(
                out,
                "Bar with its center of mass at {c}, e = {e}; radius of gyration {gyration} of the half-length"
            )?;
            writeln!(out, "q = {qa} for strikes at end a, {qb} at end b; the clatter is that of q = {q}")?;
        }
        let (a, b) = (given(va), given(vb));
        writeln!(out, "End a strikes first, at {a} v0; end b comes with {b} v0 from {gap} h0\n")?;

        let impacts = match count {
            Count::Finite(n) => n.to_string(),
            Count::Huge(n) => figures(n),
            Count::Endless => "endless".to_owned(),
        };
        let line = |out: &mut dyn Write, name: &str, value: &str, unit: &str| {
            writeln!(out, "{}", format!("{name:<24}{value:>12} {unit}").trim_end())
        };
        let rounded = !matches!(count, Count::Huge(_)) && !self.bar.count_is_exact(&self.start);
        line(
            out,
            "Impacts",
            &impacts,
            if rounded { "of the rounded masses; the exact ones may have others" } else { "" },
        )?;
        let last = if count == Count::Endless { "Impacts tend to" } else { "Last impact at" };
        line(out, last, &figures(duration), "h0/v0")?;
        let holder = match peak.impact {
            PeakImpact::Number(1) => "v0      at impact 1, the first".to_owned(),
            PeakImpact::Number(n) => format!("v0      at impact {n}"),
            PeakImpact::Huge(n) => format!("v0      at about impact {}", figures(n)),
            PeakImpact::Limit => "v0      not reached: the impacts tend to it".to_owned(),
        };
        let center = if symmetric {
            line(out, "Largest shock, ends", &figures(peak.end), &holder)?;
            "               center"
        } else {
            let [a, b] = self.ends().map(figures);
            line(out, "Hardest strike", &figures(peak.end), &holder)?;
            line(out, "Largest shock, end a", &a, "v0")?;
            line(out, "               end b", &b, "v0")?;
            "       center of mass"
        };
        line(out, center, &figures(peak.center), "v0")?;
        line(out, "               turning", &figures(peak.angular), "v0/L")?;
        if let (Some(net), Some([a, b])) = (net, final_velocity) {
            line(out, "Net change,    end a", &figures(net.a), &format!("v0      leaving with {} v0", figures(a)))?;
            line(out, "               end b", &figures(net.b), &format!("v0      leaving with {} v0", figures(b)))?;
            line(out, center, &figures(net.center), "v0")?;
            line(out, "               turning", &figures(net.angular), "v0/L")?;
        } else {
            line(out, "Net change,    center", "0", "v0      the velocities of the ends do not settle")?;
        }
        #[expect(clippy::float_cmp, reason = "without spin is what was asked for, not what was come near to")]
        let without_spin = va == vb;
        if without_spin {
            let flat = (1.0 + self.bar.e()) * -va;
            line(out, "Without clatter", &figures(flat), "v0      everywhere: the flat impact that standards assume")?;
        }
        if self.limit == 0 {
            return Ok(());
        }
        let places = self.at.iter().map(|s| (format!("shock at {}", given(*s)), "v0"));
        let heads = [("time", "h0/v0"), ("approach", "v0"), ("shock at a", "v0"), ("shock at b", "v0")];
        let heads: Vec<_> = heads.map(|(name, unit)| (name.to_owned(), unit)).into_iter().chain(places).collect();
        writeln!(out)?;
        for (n, part) in columns::parts(14, &heads).into_iter().enumerate() {
            if n > 0 {
                writeln!(out)?;
            }
            let heads = &heads[part.clone()];
            columns::line(out, "   impact  end", heads, heads.iter().map(|(name, _)| name.as_str()))?;
            columns::line(out, "              ", heads, heads.iter().map(|(_, unit)| *unit))?;
            for impact in self.impacts() {
                let [a, b] = impact.delta_v;
                let first = format!("{:>9}  {:<3}", impact.number, letter(impact.end));
                let cells = [impact.time, impact.approach, a, b].into_iter().chain(self.shocks(&impact)).map(figures);
                columns::line(out, &first, heads, cells.skip(part.start))?;
            }
        }
        Ok(())
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "number,end,time,approach,delta_v_a,delta_v_b")?;
        for s in self.at {
            write!(out, ",delta_v_at_{}", digits(*s))?;
        }
        writeln!(out)?;
        for impact in self.impacts() {
            let [a, b] = impact.delta_v;
            write!(out, "{},{}", impact.number, letter(impact.end))?;
            for x in [impact.time, impact.approach, a, b].into_iter().chain(self.shocks(&impact)) {
                write!(out, ",{}", digits(x))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    /// Largest shock at each end, by its own strikes or those of the other.
    fn ends(&self) -> [f64; 2] {
        let shocks = self.bar.shocks(&self.start, End::A);
        [-1.0, 1.0].map(|s| shocks.at(s))
    }

    fn shocks(&self, impact: &Impact) -> impl Iterator<Item = f64> {
        self.at.iter().map(|&s| impact.delta_v_at(s))
    }

    fn answer(&self) -> Answer<'_> {
        let Summary { count, duration, peak, final_velocity, net } = self.summary;
        let symmetric = self.bar.is_symmetric();
        Answer {
            q: Json(self.bar.q()),
            center_of_mass: (!symmetric).then(|| Json(self.bar.center_of_mass())),
            inertia_ratios: (!symmetric).then(|| self.bar.inertia_ratios().map(Json)),
            gyration_ratio: Json(self.bar.gyration_ratio()),
            e: Json(self.bar.e()),
            velocity: self.start.velocity().map(Json),
            height_gap: Json(self.start.height_gap()),
            at: self.at.iter().copied().map(Json).collect(),
            count: JsonCount(count),
            count_exact: self.bar.count_is_exact(&self.start),
            duration: Json(duration),
            peak: PeakJson {
                end: Json(peak.end),
                impact: peak.impact,
                center: Json(peak.center),
                angular: Json(peak.angular),
                ends: (!symmetric).then(|| self.ends().map(Json)),
            },
            net: NetJson {
                a: net.map(|net| Json(net.a)),
                b: net.map(|net| Json(net.b)),
                center: Json(net.map_or(0.0, |net| net.center)),
                angular: net.map(|net| Json(net.angular)),
            },
            final_velocity: final_velocity.map(|velocity| velocity.map(Json)),
            impacts: List(self),
        }
    }
}

#[derive(Serialize)]
struct Answer<'a> {
    /// Of the symmetric bar with this clatter.
    q: Json,
    /// Only where it is not the middle; so too the two below.
    #[serde(skip_serializing_if = "Option::is_none")]
    center_of_mass: Option<Json>,
    /// For strikes at end a and end b.
    #[serde(skip_serializing_if = "Option::is_none")]
    inertia_ratios: Option<[Json; 2]>,
    gyration_ratio: Json,
    e: Json,
    velocity: [Json; 2],
    height_gap: Json,
    at: Vec<Json>,
    count: JsonCount,
    count_exact: bool,
    duration: Json,
    peak: PeakJson,
    net: NetJson,
    #[serde(rename = "final")]
    final_velocity: Option<[Json; 2]>,
    impacts: List<'a>,
}

#[derive(Serialize)]
struct PeakJson {
    end: Json,
    #[serde(serialize_with = "peak_impact")]
    impact: PeakImpact,
    center: Json,
    angular: Json,
    /// Largest shock of ends a and b, whichever is struck.
    #[serde(skip_serializing_if = "Option::is_none")]
    ends: Option<[Json; 2]>,
}

#[derive(Serialize)]
struct NetJson {
    a: Option<Json>,
    b: Option<Json>,
    center: Json,
    angular: Option<Json>,
}

#[derive(Serialize)]
struct ImpactJson {
    number: u64,
    end: &'static str,
    time: Json,
    approach: Json,
    delta_v: [Json; 2],
    delta_v_at: Vec<Json>,
}

fn peak_impact<S: Serializer>(impact: &PeakImpact, serializer: S) -> Result<S::Ok, S::Error> {
    match *impact {
        PeakImpact::Number(n) => serializer.serialize_u64(n),
        PeakImpact::Huge(n) => serializer.serialize_f64(n),
        PeakImpact::Limit => serializer.serialize_str("limit"),
    }
}

/// The impacts of a drop, written as they come.
struct List<'a>(&'a Drop<'a>);

impl Serialize for List<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.impacts().map(|impact| ImpactJson {
            number: impact.number,
            end: letter(impact.end),
            time: Json(impact.time),
            approach: Json(impact.approach),
            delta_v: impact.delta_v.map(Json),
            delta_v_at: self.0.shocks(&impact).map(Json).collect(),
        }))
    }
}
