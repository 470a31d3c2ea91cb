//! A spectrum as a table and as CSV.

use std::io::{self, Write};

use clatter_assess::units::ACCELERATION;
use clatter_record::Channel;
use clatter_shock::{LimitCurve, Margin, Spectrum};

use super::records::{Measured, largest};
use super::{Computed, Part};
use crate::columns::Table;
use crate::numbers::{digits, figures, given};
use crate::quantities::Show;
use crate::text;

impl Computed<'_> {
    fn show(&self) -> Show {
        self.args.show(self.limit.as_ref())
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        for (i, part) in self.parts.iter().enumerate() {
            if i > 0 {
                writeln!(out)?;
            }
            self.heading(part, out)?;
            if i == 0 {
                self.about_excitation(out)?;
            }
            if let Some(margins) = &part.margins {
                self.worst(&part.spectrum, margins, out)?;
            }
            if self.args.output.is_none() {
                self.rows(&part.spectrum, part.margins.as_deref(), out)?;
            }
        }
        match &self.args.output {
            Some(target) => {
                let count: usize = self.parts.iter().map(|part| part.spectrum.frequency_hz.len()).sum();
                writeln!(out, "{}: {count} frequencies", text::path(&target.path))
            }
            None => Ok(()),
        }
    }

    fn heading(&self, part: &Part, out: &mut dyn Write) -> io::Result<()> {
        let ([name, _], unit, zeta) = (self.args.quantity.name(), self.show().name(), part.spectrum.damping.get());
        let (name, ratio, q) = (name.replace('-', " "), given(zeta), figures(0.5 / zeta));
        let of = part.name.as_ref().map(|of| format!(" of {of}")).unwrap_or_default();
        writeln!(out, "Shock response spectrum{of}: {name} in {unit}, damping ratio {ratio} (Q = {q})")
    }

    fn about_excitation(&self, out: &mut dyn Write) -> io::Result<()> {
        for Measured { path, record } in &self.records {
            let file = if self.records.len() > 1 { format!("{}: ", text::path(path)) } else { String::new() };
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
        let Some(boundary) = &self.boundary else { return Ok(()) };
        let acceleration = self.args.quantity.dimension().name == ACCELERATION.name;
        let own = self.show().unit.filter(|_| acceleration);
        let pulse = self.args.excitation.pulse.iter().find_map(|pulse| pulse.unit);
        let unit = if self.args.output_units.is_some() { own } else { own.or(pulse) };
        boundary.table(Show { unit, name: "m/s2" }, out)
    }

    fn rows(&self, spectrum: &Spectrum, margins: Option<&[Option<Margin>]>, out: &mut dyn Write) -> io::Result<()> {
        let (show, hz) = (self.show(), Show { unit: self.frequencies.unit, name: "Hz" });
        let unit = show.name();
        let margin = if margins.is_some() { ["margin", "dB"] } else { [""; 2] };
        let head = ["frequency", "primary", "residual", "maximax", "positive", "negative", "time of peak", margin[0]];
        let units = [hz.name(), unit, unit, unit, unit, unit, "s", margin[1]];
        let columns = if margins.is_some() { 8 } else { 7 };
        let mut rows: Vec<Vec<String>> =
            [head, units].map(|row| row[..columns].iter().map(|c| (*c).to_owned()).collect()).into();
        for i in 0..spectrum.frequency_hz.len() {
            let [frequency, values @ ..] = row(spectrum, i);
            let mut cells = vec![hz.figures(frequency)];
            cells.extend(values.map(|x| show.figures(x)));
            let time = spectrum.time_of_peak_s[i];
            cells.push(if time.is_nan() { "-".to_owned() } else { figures(time) });
            cells.extend(margins.map(|margins| margins[i].map_or("-".to_owned(), |m| figures(m.decibel()))));
            rows.push(cells);
        }
        writeln!(out)?;
        Table { keys: 1, headings: 2, texts: 0, last_is_text: false, least: 10, rows }.write(out)
    }

    fn worst(&self, spectrum: &Spectrum, margins: &[Option<Margin>], out: &mut dyn Write) -> io::Result<()> {
        let Some((i, margin)) = LimitCurve::worst(margins).and_then(|i| Some((i, margins[i]?))) else {
            return writeln!(out, "The limit covers none of these frequencies");
        };
        let hz = Show { unit: self.frequencies.unit, name: "Hz" }.said(spectrum.frequency_hz[i]);
        let word = if margin.is_safe() { "holds" } else { "is exceeded" };
        writeln!(out, "The limit {word}: least margin {} dB at {hz}", figures(margin.decibel()))
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        if let Some(boundary) = &self.boundary {
            writeln!(out, "velocity_change_m_s,acceleration_m_s2")?;
            return boundary.curve.iter().try_for_each(|(v, a)| writeln!(out, "{},{}", digits(*v), digits(*a)));
        }
        let first = &self.parts[0].spectrum;
        let several = self.parts.iter().any(|part| part.spectrum.damping != first.damping);
        let named = self.parts.iter().any(|part| part.name.is_some());
        let q = if several { "q_factor," } else { "" };
        let of = if named { "of," } else { "" };
        let margin = if self.limit.is_some() { ",margin_db" } else { "" };
        writeln!(
            out,
            "{of}{q}frequency_hz,primary,residual,maximax,positive,negative{margin},primary_positive,primary_negative,\
             residual_positive,residual_negative,time_of_peak_s"
        )?;
        let show = self.args.written();
        let written = |x: f64| digits(show.value(x));
        for part in &self.parts {
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
                match part.margins.as_ref().map(|margins| margins[i]) {
                    Some(Some(margin)) => write!(out, ",{}", digits(margin.decibel()))?,
                    Some(None) => write!(out, ",")?,
                    None => {}
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
