//! Which column of times a channel goes with, where there are several, as in t1, a1, t2, a2.

use std::collections::{HashMap, HashSet};

use crate::heading::Named;
use crate::roles::{Preview, Roles};
use crate::unit::Kind;
use crate::{Error, Options};

impl Preview {
    /// The columns by their times: more than one where channels have columns of times of their own.
    ///
    /// # Errors
    /// Those of [`Preview::roles`], and [`Error::Columns`] for channels of two rates whose times are not told apart.
    pub(crate) fn by_time(&self, options: &Options) -> Result<Vec<Roles>, Error> {
        let mut roles = self.roles(options)?;
        let times: Vec<usize> = (0..self.headings.len()).filter(|column| self.is_time(*column)).collect();
        // By all channels, whichever are asked for.
        let all = self.channels(times.first().copied(), &Options::default()).unwrap_or_default();
        let owners = if self.named && options.time.is_none() { self.paired(&times, &all) } else { None };
        let Some(owners) = owners else {
            if let (None, Some((time, _))) = (&options.time, roles.time) {
                self.refuse_other_time(time)?;
            }
            return Ok(vec![roles]);
        };
        let of_channel: HashMap<usize, usize> = all.iter().copied().zip(owners.iter().copied()).collect();
        let owner = |column: usize| match of_channel.get(&column) {
            Some(time) => Some(*time),
            None => times.iter().rfind(|time| **time < column).copied(),
        };
        let called: HashSet<String> = owners.iter().map(|time| self.called(*time)).collect();
        roles.left_out.retain(|column| !called.contains(column));
        for time in &owners {
            "time".clone_into(&mut roles.columns[*time].1);
        }
        let mut groups: Vec<(Option<usize>, Roles)> = Vec::new();
        for role in std::mem::take(&mut roles.channels) {
            let time = owner(role.column);
            if let Some((_, group)) = groups.iter_mut().find(|(other, _)| *other == time) {
                group.channels.push(role);
                continue;
            }
            let sized = time.map(|time| self.time_size(time, options).map(|size| (time, size)));
            let mut group = Roles { channels: vec![role], beside_others: true, ..roles.clone() };
            // A rate stands in place of times.
            if options.sample_rate_hz.is_none() {
                group.time = sized.transpose()?;
            } else {
                group.checked = sized.and_then(Result::ok).filter(|(time, _)| self.goes_on(*time));
            }
            roles.left_out.clear();
            groups.push((time, group));
        }
        Ok(groups.into_iter().map(|(_, group)| group).collect())
    }

    /// Refuses columns where another one of times does not go with the one that is taken.
    fn refuse_other_time(&self, time: usize) -> Result<(), Error> {
        let span = |column: usize| {
            let heading = &self.headings[column];
            let unit = heading.unit.filter(|unit| unit.kind == Kind::Time && heading.named() == Named::Time)?;
            let at = |row: Option<&Vec<f64>>| row.and_then(|row| row.get(column)).map(|time| time * unit.size);
            Some(at(self.rows.last())? - at(self.rows.first())?).filter(|span| *span > 0.0)
        };
        let Some(own) = span(time) else { return Ok(()) };
        // Far more than what is rounded in a few rows.
        let differs = |column: &usize| span(*column).is_some_and(|other| libm::log(other / own).abs() > 0.3);
        match (0..self.headings.len()).find(differs) {
            None => Ok(()),
            Some(other) => Err(Error::Columns(format!(
                "column {} runs at another rate than column {}: take channels of one of them, by --time and --acceleration",
                self.called(other),
                self.called(time)
            ))),
        }
    }

    /// The column of times of each of some channels, where not all have the same: the nearest before it, else that with the number
    /// at the end of its name.
    pub(crate) fn paired(&self, times: &[usize], channels: &[usize]) -> Option<Vec<usize>> {
        let several = |owners: &Vec<usize>| owners.iter().any(|owner| *owner != owners[0]);
        // Columns come in their order.
        let before =
            |channel: &usize| times.partition_point(|time| time < channel).checked_sub(1).map(|last| times[last]);
        let by_place: Option<Vec<usize>> = channels.iter().map(before).collect();
        let number = |column: usize| {
            let name = self.headings[column].name.as_str();
            &name[name.trim_end_matches(|c: char| c.is_ascii_digit()).len()..]
        };
        // None for a number that several have.
        let mut numbered: HashMap<&str, Option<usize>> = HashMap::new();
        for time in times.iter().filter(|time| !number(**time).is_empty()) {
            numbered.entry(number(*time)).and_modify(|time| *time = None).or_insert(Some(*time));
        }
        let numbered = |channel: &usize| numbered.get(number(*channel)).copied().flatten();
        let by_number = || channels.iter().map(numbered).collect::<Option<Vec<usize>>>();
        by_place.filter(several).or_else(|| by_number().filter(several))
    }
}
