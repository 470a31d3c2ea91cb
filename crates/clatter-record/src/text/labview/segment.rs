//! One record of a LabVIEW measurement file: its columns, and its rows by their times.

use super::{Channel, Columns, File, Segment, is_comment};
use crate::heading::Heading;
use crate::roles::{Preview, Roles};
use crate::text::rows::{Rows, Shape};
use crate::text::{cut, few_times};
use crate::unit::{Kind, Unit};
use crate::{At, Error, Options, Pick};

impl Segment {
    pub(super) fn rows(&self) -> usize {
        self.lines.iter().map(|(first, last)| last - first).sum()
    }
    /// As messages tell it.
    pub(super) fn told(&self) -> String {
        format!("{} rows from line {} on", self.rows(), self.lines[0].0 + 1)
    }
    pub(super) fn append(&mut self, other: &Self) {
        self.lines.extend(&other.lines);
        for (own, other) in self.channels.iter_mut().zip(&other.channels) {
            own.samples = own.samples.zip(other.samples).map(|(own, other)| own + other);
        }
    }

    /// The channel in a column, from 0.
    fn in_column(&self, file: &File, column: usize) -> Option<usize> {
        let channel = match file.columns {
            Columns::Multi => column.checked_sub(1).filter(|before| before % 2 == 0).map(|before| before / 2),
            _ => column.checked_sub(1),
        };
        channel.filter(|channel| *channel < self.channels.len())
    }

    /// Its columns: of times or empty, and of channels.
    fn columns(&self, file: &File) -> Preview {
        let heading = |(column, name): (usize, &String)| {
            if let Some(channel) = self.in_column(file, column) {
                let Channel { unit, .. } = &self.channels[channel];
                // The unit stands apart from the name.
                return if unit.is_empty() { Heading::of(name) } else { Heading::named_alone(name).with_unit(unit) };
            }
            // The channel that follows.
            let is_timed = self.in_column(file, column + 1).is_some_and(|channel| self.channels[channel].is_timed);
            match file.columns {
                _ if is_comment(name) => Heading { is_text: true, ..Heading::named_alone("") },
                Columns::No if column == 0 => Heading::named_alone(""),
                Columns::One | Columns::Multi if is_timed => Heading::named_alone("X_Value").with_unit("s"),
                _ => Heading::named_alone(name),
            }
        };
        let headings: Vec<Heading> = self.names.iter().enumerate().map(heading).collect();
        Preview { headings, named: true, sampled: file.columns == Columns::No, ..Preview::default() }
    }

    /// The channels by their times.
    pub(super) fn read(&self, file: &File, lines: &[&[u8]], options: &Options) -> Result<Vec<(Rows, Roles)>, Error> {
        let seen = self.columns(file);
        let mut options = options.clone();
        let is_acceleration = |column: &usize| {
            let unit = seen.headings[*column].unit.filter(|_| self.in_column(file, *column).is_some());
            unit.is_some_and(|Unit { kind, .. }| kind == Kind::Acceleration)
        };
        // Each column below the heading is a channel, whatever its name says.
        if options.accelerations.is_empty() {
            let found = (0..seen.headings.len()).filter(is_acceleration);
            options.accelerations = found.map(|column| Pick::Number(column + 1)).collect();
        }
        let mut parts = Vec::new();
        for roles in seen.by_time(&options)? {
            // One time for all may begin and step otherwise for each.
            for Group { sampled_s, samples, roles } in self.by_rate(roles, file, &options)? {
                let roles = Roles { beside_others: true, ..roles };
                let File { form, letters, .. } = *file;
                let shape = Shape { form, letters, columns: seen.headings.len(), sampled_s, ..Shape::default() };
                let mut rows = Rows::new(shape, &roles, &options);
                for (first, last) in &self.lines {
                    file.pass_over(&mut rows, lines, *first);
                    take(&mut rows, lines, *first, *last)?;
                }
                file.pass_over(&mut rows, lines, lines.len());
                rows.close()?;
                let (count, end) = (rows.channels[0].len(), self.lines.last().map_or(0, |(_, last)| *last));
                if let Some(samples) = samples.filter(|samples| *samples > count && rows.bad.count == 0) {
                    rows.bad.add(At::Line(end), || {
                        format!("the record ends after {count} of the {samples} samples that its heading tells of")
                    });
                }
                parts.push((rows, roles));
                few_times(parts.len())?;
            }
        }
        Ok(parts)
    }

    /// Channels by the times that the heading tells: `X0`, `Delta_X`, when each began, and how many samples there are.
    fn by_rate(&self, mut roles: Roles, file: &File, options: &Options) -> Result<Vec<Group>, Error> {
        let first_s = self.channels.iter().filter_map(|channel| channel.date_s).fold(f64::INFINITY, f64::min);
        let Roles { channels, .. } = &mut roles;
        let mut groups: Vec<Group> = Vec::new();
        for role in std::mem::take(channels) {
            let channel = &self.channels[self.in_column(file, role.column).unwrap_or(0)];
            let Channel { samples, is_timed, date_s, x0, delta, .. } = *channel;
            let sampled_s = if file.columns == Columns::No && options.sample_rate_hz.is_none() {
                let Some(step) = delta.filter(|step| *step > 0.0 && is_timed) else {
                    let name = role.name;
                    return Err(Error::Columns(format!("the heading tells no times of {name}: give the sample rate")));
                };
                Some([x0.unwrap_or(0.0) + date_s.map_or(0.0, |date_s| date_s - first_s), step])
            } else {
                None
            };
            let same = |group: &&mut Group| group.sampled_s == sampled_s && group.samples == samples;
            if let Some(group) = groups.iter_mut().find(same) {
                group.roles.channels.push(role);
            } else {
                groups.push(Group { sampled_s, samples, roles: Roles { channels: vec![role], ..roles.clone() } });
                roles.left_out.clear();
            }
        }
        Ok(groups)
    }
}

/// Channels with the same times by the heading.
#[derive(Debug)]
struct Group {
    /// Time of the first sample and between samples, where there is no column of times.
    sampled_s: Option<[f64; 2]>,
    /// How many there should be.
    samples: Option<usize>,
    roles: Roles,
}

/// Takes in some lines, of which the last may have no end.
fn take(rows: &mut Rows, lines: &[&[u8]], first: usize, last: usize) -> Result<(), Error> {
    /// Lines that are handed on at a time.
    const LINES: usize = 1 << 12;
    let is_whole = first == last || last < lines.len() || lines[last - 1].ends_with(b"\n");
    for lines in lines[first..last - usize::from(!is_whole)].chunks(LINES) {
        rows.take(&lines.concat())?;
    }
    if !is_whole {
        let above = lines[first.max(last.saturating_sub(LINES))..last - 1].concat();
        rows.take_end(cut::last_lines(&above).unwrap_or_default(), lines[last - 1])?;
    }
    Ok(())
}
