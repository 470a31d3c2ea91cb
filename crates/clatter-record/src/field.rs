//! What a column of a written file is.

/// A column of a file of row groups.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its unit, such as `m/s2`; empty where it has none.
    pub unit: String,
    /// What its numbers are.
    pub kind: FieldKind,
}

/// What the numbers of a column are, and so how they are stored.
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
