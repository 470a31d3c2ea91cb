//! This module is `clatter impacts`: it shows the train of impacts of one bar or plate, its peak and its totals.

mod plate;

use std::io::{self, Write};

use clatter::{Count, PeakImpact, Start};
use clatter_answer::impacts::{self, Answer, Impact, Question};

use crate::inputs::{self, FallingBody, OffCenterArgs, RowFormat, Values};
use crate::numbers::{digits, figures, given};
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

/// A drop and what it amounts to.
struct Drop<'a> {
    question: &'a Question,
    answer: Answer<'a>,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let bar = match self.bar.body()? {
            FallingBody::Bar(bar) => bar,
            FallingBody::Plate(plate) => return self.plate(&plate, streams),
        };
        let velocity = self.velocity.map_or(Ok([-1.0; 2]), |v| v.of_bar("--velocity"))?;
        let [gap] = self.height_gap.map_or(Ok([1.0]), |gap| gap.of_bar("--height-gap"))?;
        let at = self.at.iter().map(|s| s.of_bar("--at").map(|[s]| s)).collect::<Result<_, _>>()?;
        let mut question = Question::new(bar, Start::new(velocity, gap)?);
        (question.at, question.limit) = (at, self.limit);
        let drop = Drop { question: &question, answer: impacts::answer(&question)? };
        match self.format {
            RowFormat::Table => {
                drop.table(streams.out).map_err(Failure::Answer)?;
                if let Some(warning) = drop.cut_short() {
                    streams.note("warning", warning);
                }
            }
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.long_json(&drop.answer)?,
        }
        self.bar.slips().for_each(|slip| streams.note("warning", slip));
        Ok(())
    }
}

impl Drop<'_> {
    fn cut_short(&self) -> Option<String> {
        let listed = self.question.limit;
        let of = match self.answer.count.0 {
            _ if listed == 0 => return None, // the summary alone was asked for
            Count::Finite(n) if u64::try_from(listed).is_ok_and(|listed| listed >= n) => return None,
            Count::Finite(n) => format!("{n} impacts"),
            Count::Huge(n) => format!("about {} impacts", figures(n)),
            Count::Endless => "endless impacts".to_owned(),
        };
        Some(format!("listed {listed} of {of}; --limit=N lists more"))
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let Question { bar, start, at, limit, .. } = self.question;
        let Answer { peak, net, final_velocity, .. } = &self.answer;
        let (count, [va, vb]) = (self.answer.count.0, start.velocity());
        let (e, gap) = (given(bar.e()), given(start.height_gap()));
        let gyration = figures(bar.gyration_ratio());
        let symmetric = bar.is_symmetric();
        if symmetric {
            let q = given(bar.q());
            writeln!(out, "Bar with q = {q}, e = {e}; radius of gyration {gyration} of the half-length")?;
        } else {
            let (c, q) = (figures(bar.center_of_mass()), figures(bar.q()));
            let [qa, qb] = bar.inertia_ratios().map(figures);
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
        let rounded = !matches!(count, Count::Huge(_)) && !self.answer.count_exact;
        line(
            out,
            "Impacts",
            &impacts,
            if rounded { "of the rounded masses; the exact ones may have others" } else { "" },
        )?;
        let last = if count == Count::Endless { "Impacts tend to" } else { "Last impact at" };
        line(out, last, &figures(self.answer.duration.0), "h0/v0")?;
        let holder = match peak.impact {
            PeakImpact::Number(1) => "v0      at impact 1, the first".to_owned(),
            PeakImpact::Number(n) => format!("v0      at impact {n}"),
            PeakImpact::Huge(n) => format!("v0      at about impact {}", figures(n)),
            PeakImpact::Limit => "v0      not reached: the impacts tend to it".to_owned(),
        };
        let center = if let Some([a, b]) = peak.ends {
            line(out, "Hardest strike", &figures(peak.end.0), &holder)?;
            line(out, "Largest shock, end a", &figures(a.0), "v0")?;
            line(out, "               end b", &figures(b.0), "v0")?;
            "       center of mass"
        } else {
            line(out, "Largest shock, ends", &figures(peak.end.0), &holder)?;
            "               center"
        };
        line(out, center, &figures(peak.center.0), "v0")?;
        line(out, "               turning", &figures(peak.angular.0), "v0/L")?;
        if let (Some(net_a), Some(net_b), Some(angular), Some([a, b])) = (net.a, net.b, net.angular, final_velocity) {
            line(out, "Net change,    end a", &figures(net_a.0), &format!("v0      leaving with {} v0", figures(a.0)))?;
            line(out, "               end b", &figures(net_b.0), &format!("v0      leaving with {} v0", figures(b.0)))?;
            line(out, center, &figures(net.center.0), "v0")?;
            line(out, "               turning", &figures(angular.0), "v0/L")?;
        } else {
            line(out, "Net change,    center", "0", "v0      the velocities of the ends do not settle")?;
        }
        #[expect(clippy::float_cmp, reason = "without spin is what was asked for, not what was come near to")]
        let without_spin = va == vb;
        if without_spin {
            let flat = (1.0 + bar.e()) * -va;
            line(out, "Without clatter", &figures(flat), "v0      everywhere: the flat impact that standards assume")?;
        }
        if *limit == 0 {
            return Ok(());
        }
        let places = at.iter().map(|s| (format!("shock at {}", given(*s)), "v0"));
        let heads = [("time", "h0/v0"), ("approach", "v0"), ("shock at a", "v0"), ("shock at b", "v0")];
        let heads: Vec<_> = heads.map(|(name, unit)| (name.to_owned(), unit)).into_iter().chain(places).collect();
        writeln!(out)?;
        columns::rows(out, "   impact  end", &heads, || {
            let numbers = |impact: &Impact| numbers(impact).map(figures).collect();
            self.answer
                .impacts
                .iter()
                .map(move |impact| (format!("{:>9}  {:<3}", impact.number, impact.end), numbers(&impact)))
        })
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "number,end,time,approach,delta_v_a,delta_v_b")?;
        for s in &self.question.at {
            write!(out, ",delta_v_at_{}", digits(*s))?;
        }
        writeln!(out)?;
        for impact in self.answer.impacts.iter() {
            write!(out, "{},{}", impact.number, impact.end)?;
            for x in numbers(&impact) {
                write!(out, ",{}", digits(x))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}

/// Writes one of the totals.
fn line(out: &mut dyn Write, name: &str, value: &str, unit: &str) -> io::Result<()> {
    writeln!(out, "{}", format!("{name:<24}{value:>12} {unit}").trim_end())
}

/// Returns the numbers of an impact that are shown, column by column.
fn numbers(impact: &Impact) -> impl Iterator<Item = f64> {
    let Impact { time, approach, delta_v: [a, b], delta_v_at, .. } = impact;
    [time, approach, a, b].into_iter().chain(delta_v_at).map(|x| x.0)
}
