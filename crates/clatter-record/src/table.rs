//! The columns of a file, before it is known which is time and which acceleration.

/// Columns of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// In the order of the file.
    pub columns: Vec<Column>,
    /// What the file holds beside them, each with the reason why it is none of them.
    pub left_out: Vec<String>,
    /// What else one should know of the file.
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
    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
