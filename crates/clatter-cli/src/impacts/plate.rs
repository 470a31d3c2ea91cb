//! This module shows the train of impacts of one plate.

use std::io::{self, Write};

use clatter::{Plate, PlateCount, PlateStart};
use clatter_answer::impacts::plate::{self, Answer, Impact, Question};

use super::{Args, line};
use crate::inputs::RowFormat;
use crate::numbers::{digits, figures, given};
use crate::{Failure, Streams, columns};

/// A drop and what it amounts to.
struct Drop<'a> {
    question: &'a Question,
    answer: Answer<'a>,
}

impl Args {
    pub(super) fn plate(&self, plate: &Plate, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let velocity = self.velocity.map_or(Ok([-1.0; 3]), |v| v.of_plate("--velocity"))?;
        let gaps = self.height_gap.map_or(Ok([1.0; 2]), |gaps| gaps.of_plate("--height-gap"))?;
        let at = self.at.iter().map(|place| place.of_plate("--at")).collect::<Result<_, _>>()?;
        let mut question = Question::new(*plate, PlateStart::new(velocity, gaps)?);
        (question.at, question.limit) = (at, self.limit);
        let drop = Drop { question: &question, answer: plate::answer(&question)? };
        match self.format {
            RowFormat::Table => {
                let tied = drop.table(streams.out).map_err(Failure::Answer)?;
                if let Some(order) = tied {
                    streams.note("note", format_args!("two corners come down at one instant; the order is {order}"));
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
            RowFormat::Json => streams.long_json(&drop.answer),
        }
    }
}

impl Drop<'_> {
    /// Returns whether a corner is still to come down after an endless train.
    fn falls_on(&self) -> bool {
        let endless = self.answer.count == PlateCount::Endless;
        endless && self.answer.final_velocity.is_some_and(|velocities| velocities.iter().any(|v| v.0 < 0.0))
    }

    fn cut_short(&self) -> Option<String> {
        let listed = self.question.limit;
        let of = match self.answer.count {
            _ if listed == 0 => return None, // the summary alone was asked for
            PlateCount::Finite(n) if u64::try_from(listed).is_ok_and(|listed| listed >= n) => return None,
            PlateCount::Finite(n) => format!("{n} impacts"),
            PlateCount::Endless => "endless impacts".to_owned(),
            PlateCount::MoreThan(n) => format!("more than {n} impacts"),
            _ => return None,
        };
        Some(format!("listed at most {listed} of {of}; --limit=N lists more"))
    }

    /// Writes the table, and returns how the order of a tie was taken, where there was one among the impacts shown.
    fn table(&self, out: &mut dyn Write) -> io::Result<Option<&'static str>> {
        let Question { plate, start, at, limit, .. } = self.question;
        let Answer { count, duration, peak, final_velocity, .. } = &self.answer;
        let ([kx, ky], [sx, sy]) = (plate.gyration_ratios().map(given), plate.center_of_mass());
        let center =
            if plate.is_centered() { String::new() } else { format!(", center of mass {},{}", given(sx), given(sy)) };
        writeln!(out, "Plate with gyration ratios {kx},{ky}{center}, e = {}", given(plate.e()))?;
        let ([a, b, c, d], [hx, hy]) = (start.velocities().map(given), start.gaps().map(given));
        writeln!(
            out,
            "Corner a strikes first, at {a} v0; b comes with {b} v0 from {hx} h0, d with {d} v0 from {hy} h0, c with {c} v0\n"
        )?;
        let (impacts, last) = match count {
            PlateCount::Finite(n) => (n.to_string(), "Last impact at"),
            PlateCount::Endless => ("endless".to_owned(), "Impacts tend to"),
            PlateCount::MoreThan(n) => (format!("more than {n}"), "Followed until"),
            _ => (String::new(), ""),
        };
        line(out, "Impacts", &impacts, "")?;
        line(out, last, &figures(duration.0), "h0/v0")?;
        let holder = format!("v0      at impact {}, corner {}", peak.impact, peak.struck);
        line(out, "Largest shock, corner", &figures(peak.corner.0), &holder)?;
        line(out, "       center of mass", &figures(peak.center.0), "v0")?;
        if peak.later.0 > 0.0 {
            line(out, "Later ones up to", &figures(peak.later.0), "v0      a bound of what was not followed")?;
        }
        if let Some(velocities) = final_velocity {
            let names =
                ["Leaving,     corner a", "                    b", "                    c", "                    d"];
            for (name, v) in names.into_iter().zip(velocities) {
                line(out, name, &figures(v.0), "v0")?;
            }
        }
        if *limit == 0 {
            return Ok(None);
        }
        let places = at.iter().map(|[x, y]| (format!("shock at {},{}", given(*x), given(*y)), "v0"));
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
        let mut tied = None;
        for impact in self.answer.impacts.iter() {
            tied = tied.or(impact.order);
            let name = format!("{}{}", impact.corner, if impact.tie { " tie" } else { "" });
            let first = format!("{:>9}  {name:<6}", impact.number);
            let [own, places] = numbers(&impact);
            columns::line(out, &first, &heads, own.into_iter().chain(places).map(figures))?;
        }
        Ok(tied)
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "number,corner,time,approach,delta_v_a,delta_v_b,delta_v_c,delta_v_d,tie")?;
        for [x, y] in &self.question.at {
            write!(out, ",delta_v_at_{}_{}", digits(*x), digits(*y))?;
        }
        writeln!(out)?;
        for impact in self.answer.impacts.iter() {
            let [own, places] = numbers(&impact);
            write!(out, "{},{}", impact.number, impact.corner)?;
            own.into_iter().try_for_each(|x| write!(out, ",{}", digits(x)))?;
            write!(out, ",{}", impact.tie)?;
            places.into_iter().try_for_each(|x| write!(out, ",{}", digits(x)))?;
            writeln!(out)?;
        }
        Ok(())
    }
}

/// Returns the numbers of an impact that are shown, column by column: of the impact itself, and at the requested places.
fn numbers(impact: &Impact) -> [Vec<f64>; 2] {
    let Impact { time, approach, delta_v: [a, b, c, d], delta_v_at, .. } = impact;
    [vec![time.0, approach.0, a.0, b.0, c.0, d.0], delta_v_at.iter().map(|x| x.0).collect()]
}
