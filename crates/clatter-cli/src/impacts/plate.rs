//! The train of impacts of one plate.

use std::io::{self, Write};

use clatter::{Plate, PlateCount, PlateImpact, PlatePeak, PlateStart, PlateSummary};
use serde::{Serialize, Serializer};

use super::Args;
use crate::inputs::RowFormat;
use crate::numbers::{Json, digits, figures, given};
use crate::{Failure, Streams, columns};

/// Everything that is shown of one drop.
struct Drop {
    plate: Plate,
    start: PlateStart,
    summary: PlateSummary,
    at: Vec<[f64; 2]>,
    limit: usize,
}

/// So many impacts are followed at least for the summary.
const FOLLOWED: usize = 1000;
/// The order at a tie, in words.
const NUDGED: &str = "as if corner d were higher, or with HX = 0 corner b, by next to nothing";
const DIAGONAL: &str = "as if tilted along the diagonal by next to nothing";

impl Args {
    pub(super) fn plate(&self, plate: &Plate, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let velocity = self.velocity.map_or(Ok([-1.0; 3]), |v| v.of_plate("--velocity"))?;
        let gaps = self.height_gap.map_or(Ok([1.0; 2]), |gaps| gaps.of_plate("--height-gap"))?;
        let at = self.at.iter().map(|place| place.of_plate("--at")).collect::<Result<_, _>>()?;
        let start = PlateStart::new(velocity, gaps)?;
        let summary = plate.summary(&start, self.limit.max(FOLLOWED) as u64);
        let drop = Drop { plate: *plate, start, summary, at, limit: self.limit };
        match self.format {
            RowFormat::Table => {
                let tied = drop.table(streams.out).map_err(Failure::Answer)?;
                if tied {
                    streams.note(
                        "note",
                        format_args!("two corners come down at one instant; the order is {}", drop.order()),
                    );
                }
                if drop.falls_on() {
                    let what =
                        "a corner still comes down as the endless impacts end: its strikes are bounded, not followed";
                    streams.note("warning", what);
                }
                if let Some(warning) = drop.cut_short() {
                    streams.note("warning", warning);
                }
                Ok(())
            }
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.long_json(&drop.answer()),
        }
    }
}

impl Drop {
    fn impacts(&self) -> impl Iterator<Item = PlateImpact> {
        self.plate.train(&self.start).take(self.limit)
    }

    fn shocks(&self, impact: &PlateImpact) -> impl Iterator<Item = f64> {
        self.at.iter().map(|place| impact.delta_v_at(*place))
    }

    fn order(&self) -> &'static str {
        if self.start.gaps().iter().all(|gap| *gap == 0.0) { DIAGONAL } else { NUDGED }
    }

    /// Whether a corner is still to come down after an endless train.
    fn falls_on(&self) -> bool {
        let endless = self.summary.count == PlateCount::Endless;
        endless && self.summary.final_velocity.is_some_and(|velocities| velocities.iter().any(|v| *v < 0.0))
    }

    fn cut_short(&self) -> Option<String> {
        let listed = self.limit;
        let of = match self.summary.count {
            _ if listed == 0 => return None, // the summary alone was asked for
            PlateCount::Finite(n) if u64::try_from(listed).is_ok_and(|listed| listed >= n) => return None,
            PlateCount::Finite(n) => format!("{n} impacts"),
            PlateCount::Endless => "endless impacts".to_owned(),
            PlateCount::MoreThan(n) => format!("more than {n} impacts"),
            _ => return None,
        };
        Some(format!("listed at most {listed} of {of}; --limit=N lists more"))
    }

    /// Whether there was a tie among the impacts listed.
    fn table(&self, out: &mut dyn Write) -> io::Result<bool> {
        let PlateSummary { count, duration, peak, final_velocity, .. } = self.summary;
        let ([kx, ky], [sx, sy]) = (self.plate.gyration_ratios().map(given), self.plate.center_of_mass());
        let center = if self.plate.is_centered() {
            String::new()
        } else {
            format!(", center of mass {},{}", given(sx), given(sy))
        };
        writeln!(out, "Plate with gyration ratios {kx},{ky}{center}, e = {}", given(self.plate.e()))?;
        let ([a, b, c, d], [hx, hy]) = (self.start.velocities().map(given), self.start.gaps().map(given));
        writeln!(
            out,
            "Corner a strikes first, at {a} v0; b comes with {b} v0 from {hx} h0, d with {d} v0 from {hy} h0, c with {c} v0\n"
        )?;
        let line = |out: &mut dyn Write, name: &str, value: &str, unit: &str| {
            writeln!(out, "{}", format!("{name:<24}{value:>12} {unit}").trim_end())
        };
        let (impacts, last) = match count {
            PlateCount::Finite(n) => (n.to_string(), "Last impact at"),
            PlateCount::Endless => ("endless".to_owned(), "Impacts tend to"),
            PlateCount::MoreThan(n) => (format!("more than {n}"), "Followed until"),
            _ => (String::new(), ""),
        };
        line(out, "Impacts", &impacts, "")?;
        line(out, last, &figures(duration), "h0/v0")?;
        let holder = format!("v0      at impact {}, corner {}", peak.impact, peak.struck.letter());
        line(out, "Largest shock, corner", &figures(peak.corner), &holder)?;
        line(out, "       center of mass", &figures(peak.center), "v0")?;
        if peak.later > 0.0 {
            line(out, "Later ones up to", &figures(peak.later), "v0      a bound of what was not followed")?;
        }
        if let Some(velocities) = final_velocity {
            let names =
                ["Leaving,     corner a", "                    b", "                    c", "                    d"];
            for (name, v) in names.into_iter().zip(velocities) {
                line(out, name, &figures(v), "v0")?;
            }
        }
        if self.limit == 0 {
            return Ok(false);
        }
        let places = self.at.iter().map(|[x, y]| (format!("shock at {},{}", given(*x), given(*y)), "v0"));
        let heads = [
            ("time", "h0/v0"),
            ("approach", "v0"),
            ("shock at a", "v0"),
            ("at b", "v0"),
            ("at c", "v0"),
            ("at d", "v0"),
        ];
        let heads: Vec<_> = heads.map(|(name, unit)| (name.to_owned(), unit)).into_iter().chain(places).collect();
        writeln!(out)?;
        columns::line(out, "   impact  corner", &heads, heads.iter().map(|(name, _)| name.as_str()))?;
        columns::line(out, "                 ", &heads, heads.iter().map(|(_, unit)| *unit))?;
        let mut tied = false;
        for impact in self.impacts() {
            tied |= impact.tie;
            let name = format!("{}{}", impact.corner.letter(), if impact.tie { " tie" } else { "" });
            let first = format!("{:>9}  {name:<6}", impact.number);
            let cells = [impact.time, impact.approach].into_iter().chain(impact.delta_v).chain(self.shocks(&impact));
            columns::line(out, &first, &heads, cells.map(figures))?;
        }
        Ok(tied)
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "number,corner,time,approach,delta_v_a,delta_v_b,delta_v_c,delta_v_d,tie")?;
        for [x, y] in &self.at {
            write!(out, ",delta_v_at_{}_{}", digits(*x), digits(*y))?;
        }
        writeln!(out)?;
        for impact in self.impacts() {
            write!(out, "{},{}", impact.number, impact.corner.letter())?;
            for x in [impact.time, impact.approach].into_iter().chain(impact.delta_v) {
                write!(out, ",{}", digits(x))?;
            }
            write!(out, ",{}", impact.tie)?;
            for x in self.shocks(&impact) {
                write!(out, ",{}", digits(x))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn answer(&self) -> Answer<'_> {
        let PlateSummary { count, duration, peak, final_velocity, .. } = self.summary;
        let PlatePeak { corner, impact, struck, center, later, .. } = peak;
        Answer {
            gyration_ratio: self.plate.gyration_ratios().map(Json),
            center_of_mass: self.plate.center_of_mass().map(Json),
            e: Json(self.plate.e()),
            velocity: self.start.velocities().map(Json),
            height_gap: self.start.gaps().map(Json),
            at: self.at.iter().map(|place| place.map(Json)).collect(),
            count: CountJson(count),
            count_exact: !matches!(count, PlateCount::MoreThan(_)),
            duration: Json(duration),
            peak: PeakJson {
                corner: Json(corner),
                impact,
                struck: struck.letter(),
                center: Json(center),
                later: Json(later),
            },
            final_velocity: final_velocity.map(|velocities| velocities.map(Json)),
            impacts: List(self),
        }
    }
}

#[derive(Serialize)]
struct Answer<'a> {
    gyration_ratio: [Json; 2],
    center_of_mass: [Json; 2],
    e: Json,
    /// Of corners a, b, c and d.
    velocity: [Json; 4],
    height_gap: [Json; 2],
    at: Vec<[Json; 2]>,
    count: CountJson,
    /// Whether `count` is the whole count, not just what was followed.
    count_exact: bool,
    duration: Json,
    peak: PeakJson,
    /// Null where the train was not followed to its end.
    #[serde(rename = "final")]
    final_velocity: Option<[Json; 4]>,
    impacts: List<'a>,
}

struct CountJson(PlateCount);

impl Serialize for CountJson {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            PlateCount::Finite(n) | PlateCount::MoreThan(n) => serializer.serialize_u64(n),
            _ => serializer.serialize_str("endless"),
        }
    }
}

#[derive(Serialize)]
struct PeakJson {
    corner: Json,
    impact: u64,
    struck: char,
    center: Json,
    /// What no impact that was not followed exceeds.
    later: Json,
}

#[derive(Serialize)]
struct ImpactJson {
    number: u64,
    corner: char,
    time: Json,
    approach: Json,
    delta_v: [Json; 4],
    delta_v_at: Vec<Json>,
    tie: bool,
    /// At a tie: how the order was taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    order: Option<&'static str>,
}

/// The impacts of a drop, written as they come.
struct List<'a>(&'a Drop);

impl Serialize for List<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.impacts().map(|impact| ImpactJson {
            number: impact.number,
            corner: impact.corner.letter(),
            time: Json(impact.time),
            approach: Json(impact.approach),
            delta_v: impact.delta_v.map(Json),
            delta_v_at: self.0.shocks(&impact).map(Json).collect(),
            tie: impact.tie,
            order: impact.tie.then(|| self.0.order()),
        }))
    }
}
