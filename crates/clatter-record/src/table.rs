//! The columns of a file, before it is known which is time and which acceleration.

/// Columns of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// In the order of the file.
    pub columns: Vec<Column>,
}

/// A column of numbers and what the file says of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name; empty where the file gives none. It may hold the unit, as in `time [ms]`.
    pub name: String,
    /// Its unit as the file spells it, where it stands apart from the name.
    pub unit: Option<String>,
    /// Time of its first value and time between its values in seconds, where the file tells them apart from the numbers.
    pub sampled_s: Option<[f64; 2]>,
    /// The numbers.
    pub values: Values,
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
