//! Columns of a file that is written.

/// A column of a file of row groups.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its unit, such as `m/s2`; empty where it has none.
    pub unit: String,
    /// The kind of its numbers.
    pub kind: FieldKind,
}

/// The kind of the numbers of a column, and so how they are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// Any numbers.
    Float,
    /// Numbers of which some are missing: NaN.
    FloatOrNone,
    /// Whole numbers up to 2⁵³.
    Whole,
    /// 0 or 1: no or yes.
    Flag,
}
