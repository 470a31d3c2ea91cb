//! The columns of a file, before it is known which is time and which acceleration.

/// Columns of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// In the order of the file.
    pub columns: Vec<Column>,
    /// Other contents of the file, each with the reason why it is none of them.
    pub left_out: Vec<String>,
    /// Notes that one should know of the file.
    pub notes: Vec<String>,
}

/// A column of numbers and what the file says of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name; empty where the file gives none. It may hold the unit, as in `time [ms]`.
    pub name: String,
    /// The group of the file that it lies in, with which its name may begin; empty where there are none.
    pub group: String,
    /// Its unit as the file spells it, where it stands apart from the name.
    pub unit: Option<String>,
    /// Time of its first value and time between its values in seconds, where the file tells them apart from the
    /// numbers; the latter is NaN where the file contradicts itself.
    pub sampled_s: Option<[f64; 2]>,
    /// The numbers.
    pub values: Values,
}

impl Column {
    /// Its name without that of its group.
    pub(crate) fn own_name(&self) -> &str {
        let rest = self.name.strip_prefix(&self.group).and_then(|rest| rest.strip_prefix(['/', '.']));
        rest.filter(|_| !self.group.is_empty()).unwrap_or(&self.name)
    }
}

/// The numbers of a column.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Values {
    /// As floats.
    Float(Vec<f64>),
    /// As integers, which floats may not hold: nanoseconds since 1970.
    Integer(Vec<i64>),
}

impl Values {
    /// How many.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::Integer(values) => values.len(),
        }
    }
    /// Returns whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of a row; NaN where there is none.
    pub(crate) fn float(&self, row: usize) -> f64 {
        match self {
            Self::Float(values) => values.get(row).copied().unwrap_or(f64::NAN),
            #[expect(clippy::cast_precision_loss, reason = "within half an ulp")]
            Self::Integer(values) => values.get(row).map_or(f64::NAN, |value| *value as f64),
        }
    }
    /// As floats, within half an ulp.
    #[expect(clippy::cast_precision_loss, reason = "within half an ulp")]
    pub(crate) fn into_floats(self) -> Vec<f64> {
        match self {
            Self::Float(values) => values,
            Self::Integer(values) => values.into_iter().map(|value| value as f64).collect(),
        }
    }
    /// The numbers times a size.
    #[expect(clippy::cast_precision_loss, reason = "no converter has so many digits")]
    pub(crate) fn times(&self, size: f64) -> Vec<f64> {
        match self {
            Self::Float(values) => values.iter().map(|value| value * size).collect(),
            Self::Integer(values) => values.iter().map(|value| *value as f64 * size).collect(),
        }
    }
    /// The first of some times in seconds, and all of them since it; exact for integers.
    #[expect(clippy::cast_precision_loss, reason = "a record lasts less than 2^53 of its units")]
    pub(crate) fn since_first(&self, size: f64) -> (f64, Vec<f64>) {
        match self {
            Self::Float(values) => {
                let first = values.first().copied().unwrap_or(0.0);
                (first * size, values.iter().map(|value| (value - first) * size).collect())
            }
            Self::Integer(values) => {
                let first = values.first().copied().unwrap_or(0);
                let since = |value: &i64| (i128::from(*value) - i128::from(first)) as f64 * size;
                (first as f64 * size, values.iter().map(since).collect())
            }
        }
    }
    /// As integers, which they are.
    #[expect(clippy::cast_possible_truncation, reason = "integers up to 2^53 that were made floats")]
    pub(crate) fn into_integers(self) -> Vec<i64> {
        match self {
            Self::Integer(values) => values,
            Self::Float(values) => values.into_iter().map(|value| value as i64).collect(),
        }
    }
    /// Adds the next part of a column. Where one has integers beyond 2^53, both become integers; where the other has some
    /// beyond 2^63, which came as floats, both become floats.
    pub(crate) fn append(&mut self, after: Self) {
        let is_beyond = |values: &Self| match values {
            Self::Float(values) => values.iter().any(|value| value.abs() > 2_f64.powi(53)),
            Self::Integer(_) => false,
        };
        *self = match (std::mem::replace(self, Self::Float(Vec::new())), after) {
            (Self::Float(mut before), Self::Float(after)) => {
                before.extend(after);
                Self::Float(before)
            }
            (before, after) if is_beyond(&before) || is_beyond(&after) => {
                Self::Float([before.into_floats(), after.into_floats()].concat())
            }
            (before, after) => Self::Integer([before.into_integers(), after.into_integers()].concat()),
        };
    }
}
