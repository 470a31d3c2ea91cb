//! This module writes a spectrum as a table and as CSV.

use std::io::{self, Write};

use clatter_answer::shape_name;
use clatter_answer::spectrum::{Measured, Part, largest, outermost};
use clatter_product::units::ACCELERATION;
use clatter_record::Channel;
use clatter_shock::{Deviation, EnvelopingPulse, LimitCurve, Margin, Spectrum};

use super::{Computed, boundary};
use crate::columns::Table;
use crate::numbers::{digits, figures, given};
use crate::quantities::Show;
use crate::text;

impl Computed<'_> {
    fn show(&self) -> Show {
        self.args.show(self.limit.as_ref())
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        for (i, part) in self.answer.parts.iter().enumerate() {
            self.heading(part, out)?;
            if i == 0 {
                self.about_excitation(out)?;
            }
            if let Some(margins) = &part.margins {
                self.worst(&part.spectrum, margins, out)?;
            }
            if let Some(deviations) = &part.deviations {
                self.reached(part, deviations, out)?;
            }
            if let Some(enveloping) = &part.enveloping {
                self.enveloped(enveloping, out)?;
            }
            if self.args.output.is_none() && self.answer.parts.len() == 1 {
                self.rows(part, out)?;
            }
        }
        if self.args.output.is_none() && self.answer.parts.len() > 1 {
            self.side_by_side(out)?;
        }
        match &self.args.output {
            Some(target) => {
                let count: usize = self.answer.parts.iter().map(|part| part.spectrum.frequency_hz.len()).sum();
                writeln!(out, "{}: {count} frequencies", text::path(&target.path))
            }
            None => Ok(()),
        }
    }

    fn heading(&self, part: &Part, out: &mut dyn Write) -> io::Result<()> {
        let ([name, _], unit, zeta) = (self.args.quantity.name(), self.show().name(), part.spectrum.damping.get());
        let (name, ratio, q) = (name.replace('-', " "), given(zeta), figures(0.5 / zeta));
        let of = part.name.as_ref().map(|of| format!(" of {of}")).unwrap_or_default();
        let stop = self.answer.question.stop.map_or(String::new(), |stop| {
            let (gap, time) = (figures(1e3 * stop.gap()), figures(1e3 * stop.contact_time()));
            format!("; stops at {gap} mm with contacts of {time} ms, e = {}", given(stop.restitution()))
        });
        writeln!(out, "Shock response spectrum{of}: {name} in {unit}, damping ratio {ratio} (Q = {q}){stop}")
    }

    fn about_excitation(&self, out: &mut dyn Write) -> io::Result<()> {
        let records = self.answer.question.records();
        for Measured { file, record, .. } in records {
            let file = if records.len() > 1 { format!("{}: ", text::path(file.as_ref())) } else { String::new() };
            let several = record.times().len() > 1;
            // Channels with times of their own have a line each.
            let mut told: Vec<&[Channel]> = if several { record.channels().chunks(1).collect() } else { Vec::new() };
            if !several {
                told.push(record.channels());
            }
            for channels in told {
                let times = channels[0].times();
                let steps =
                    times.step_s().map_or("uneven in time".to_owned(), |step| format!("every {} s", figures(step)));
                let (from, to) = (figures(times.start_s()), figures(times.start_s() + times.duration_s()));
                let name = if several { format!("{}: ", text::visible(&channels[0].name)) } else { String::new() };
                let (n, most) = (times.samples(), figures(channels.iter().map(largest).fold(0.0, f64::max)));
                writeln!(out, "{file}{name}{n} samples from {from} to {to} s, {steps}; largest {most} m/s2")?;
            }
        }
        let Some(boundary) = &self.answer.boundary else { return Ok(()) };
        let acceleration = self.args.quantity.dimension().name == ACCELERATION.name;
        let own = self.show().unit.filter(|_| acceleration);
        let pulse = self.args.excitation.pulse.iter().find_map(|pulse| pulse.unit);
        let unit = if self.args.output_units.is_some() { own } else { own.or(pulse) };
        boundary::table(boundary, Show { unit, name: "m/s2" }, out)
    }

    fn rows(&self, part: &Part, out: &mut dyn Write) -> io::Result<()> {
        let Part { spectrum, margins, deviations, .. } = part;
        let (show, hz) = (self.show(), Show { unit: self.unit, name: "Hz" });
        let unit = show.name();
        let mut heads = vec!["frequency", "primary", "residual", "maximax", "positive", "negative", "time of peak"];
        let mut units = vec![hz.name(), unit, unit, unit, unit, unit, "s"];
        for (name, _) in [("margin", margins.is_some()), ("deviation", deviations.is_some())].iter().filter(|of| of.1) {
            heads.push(name);
            units.push("dB");
        }
        let mut rows: Vec<Vec<String>> = [heads, units].map(|row| row.into_iter().map(str::to_owned).collect()).into();
        let db = |value: Option<f64>| value.map_or("-".to_owned(), figures);
        for i in 0..spectrum.frequency_hz.len() {
            let [frequency, values @ ..] = row(spectrum, i);
            let mut cells = vec![hz.figures(frequency)];
            cells.extend(values.map(|x| show.figures(x)));
            let time = spectrum.time_of_peak_s[i];
            cells.push(if time.is_nan() { "-".to_owned() } else { figures(time) });
            cells.extend(margins.as_ref().map(|margins| db(margins[i].map(|m| m.decibel()))));
            cells.extend(deviations.as_ref().map(|off| db(off[i].map(|of| of.decibel()))));
            rows.push(cells);
        }
        writeln!(out)?;
        Table { keys: 1, headings: 2, texts: 0, last_is_text: false, least: 10, rows }.write(out)
    }

    /// Writes the maximax of several spectra, one column each.
    fn side_by_side(&self, out: &mut dyn Write) -> io::Result<()> {
        let (show, hz) = (self.show(), Show { unit: self.unit, name: "Hz" });
        let names = self.answer.parts.iter().map(|part| self.name(part));
        let units = self.answer.parts.iter().map(|_| show.name().to_owned());
        let mut rows: Vec<Vec<String>> = vec![
            std::iter::once("frequency".to_owned()).chain(names).collect(),
            std::iter::once(hz.name().to_owned()).chain(units).collect(),
        ];
        rows.extend(self.answer.frequencies.hz().iter().enumerate().map(|(i, frequency)| {
            let values = self.answer.parts.iter().map(|part| show.figures(part.spectrum.maximax[i]));
            std::iter::once(hz.figures(*frequency)).chain(values).collect()
        }));
        writeln!(out)?;
        Table { keys: 1, headings: 2, texts: 0, last_is_text: false, least: 10, rows }.write(out)
    }

    fn enveloped(&self, of: &EnvelopingPulse, out: &mut dyn Write) -> io::Result<()> {
        let acceleration = self.args.quantity.dimension().name == ACCELERATION.name;
        let show = Show { unit: self.show().unit.filter(|_| acceleration), name: "m/s2" };
        let (shape, amplitude) = (shape_name(of.pulse.shape), show.said(of.pulse.amplitude));
        let [ms, v, mean, most, hz] =
            [1e3 * of.pulse.duration, of.pulse.velocity_change(), of.mean_db, of.most_db, of.most_hz].map(figures);
        writeln!(
            out,
            "Enveloped by a {shape} of {amplitude} and {ms} ms, {v} m/s: above by {mean} dB on average, by {most} dB at most, at {hz} Hz"
        )
    }

    /// Writes whether a spectrum reached the required one, and where it is off most on either side.
    fn reached(&self, part: &Part, deviations: &[Option<Deviation>], out: &mut dyn Write) -> io::Result<()> {
        let Some([low, high]) = outermost(deviations) else {
            return writeln!(out, "The required spectrum covers none of these frequencies");
        };
        let at = |(i, of): (usize, Deviation)| {
            let hz = Show { unit: self.unit, name: "Hz" }.said(part.spectrum.frequency_hz[i]);
            format!("{} dB at {hz}", figures(of.decibel()))
        };
        let told = deviations.iter().flatten();
        let [below, above] =
            [told.clone().filter(|of| of.is_below).count(), told.clone().filter(|of| of.is_above).count()];
        let all = told.count();
        let word = match (below, above) {
            (0, 0)
                if self.answer.question.required.as_ref().and_then(|required| part.reaches(required)) == Some(true) =>
            {
                "is reached".to_owned()
            }
            (0, 0) => "is reached where it is judged, and not judged all over its range".to_owned(),
            (0, above) => format!("is exceeded by more than the tolerance at {above} of {all} frequencies"),
            (below, 0) => format!("is not reached at {below} of {all} frequencies"),
            (below, above) => format!("is not reached at {below} and exceeded at {above} of {all} frequencies"),
        };
        writeln!(out, "The required spectrum {word}: from {} to {}", at(low), at(high))
    }

    fn worst(&self, spectrum: &Spectrum, margins: &[Option<Margin>], out: &mut dyn Write) -> io::Result<()> {
        let Some((i, margin)) = LimitCurve::worst(margins).and_then(|i| Some((i, margins[i]?))) else {
            return writeln!(out, "The limit covers none of these frequencies");
        };
        let hz = Show { unit: self.unit, name: "Hz" }.said(spectrum.frequency_hz[i]);
        let word = if margin.is_safe() { "holds" } else { "is exceeded" };
        writeln!(out, "The limit {word}: least margin {} dB at {hz}", figures(margin.decibel()))
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        if let Some(boundary) = &self.answer.boundary {
            writeln!(out, "velocity_change_m_s,acceleration_m_s2")?;
            return boundary.curve.iter().try_for_each(|(v, a)| writeln!(out, "{},{}", digits(*v), digits(*a)));
        }
        let first = &self.answer.parts[0].spectrum;
        let several = self.answer.parts.iter().any(|part| part.spectrum.damping != first.damping);
        let named = self.answer.parts.iter().any(|part| part.name.is_some());
        let q = if several { "q_factor," } else { "" };
        let of = if named { "of," } else { "" };
        let margin = if self.limit.is_some() { ",margin_db" } else { "" };
        let deviation = if self.answer.question.required.is_some() { ",deviation_db" } else { "" };
        writeln!(
            out,
            "{of}{q}frequency_hz,primary,residual,maximax,positive,negative{margin}{deviation},primary_positive,primary_negative,\
             residual_positive,residual_negative,time_of_peak_s"
        )?;
        let show = self.args.written();
        let written = |x: f64| digits(show.value(x));
        for part in &self.answer.parts {
            let s = &part.spectrum;
            for i in 0..s.frequency_hz.len() {
                if named {
                    write!(out, "{},", text::field(part.name.as_deref().unwrap_or_default()))?;
                }
                if several {
                    write!(out, "{},", digits(0.5 / s.damping.get()))?;
                }
                let [hz, values @ ..] = row(s, i);
                write!(out, "{},{}", digits(hz), values.map(written).join(","))?;
                let margin = part.margins.as_ref().map(|margins| margins[i].map(|m| m.decibel()));
                let deviation = part.deviations.as_ref().map(|off| off[i].map(|of| of.decibel()));
                for db in [margin, deviation].into_iter().flatten() {
                    write!(out, ",{}", db.map(digits).unwrap_or_default())?;
                }
                let signs = [&s.primary_positive, &s.primary_negative, &s.residual_positive, &s.residual_negative];
                let time = if s.time_of_peak_s[i].is_nan() { String::new() } else { digits(s.time_of_peak_s[i]) };
                writeln!(out, ",{},{time}", signs.map(|values| written(values[i])).join(","))?;
            }
        }
        Ok(())
    }
}

fn row(s: &Spectrum, i: usize) -> [f64; 6] {
    [s.frequency_hz[i], s.primary[i], s.residual[i], s.maximax[i], s.positive[i], s.negative[i]]
}
