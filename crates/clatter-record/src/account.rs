//! The account of every line and every column of a text.

/// The account of every line and every column of a text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// The lines.
    pub lines: Lines,
    /// The columns, in the order of the file: each as messages call it, and what it is taken for.
    pub columns: Vec<(String, String)>,
}

/// How many lines of a text are what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Lines {
    /// All of them.
    pub all: usize,
    /// Above the numbers.
    pub heading: usize,
    /// Rows of numbers.
    pub rows: usize,
    /// Rows of sensors and records that were not asked for.
    pub others: usize,
    /// Lines that cannot be used.
    pub bad: usize,
    /// Empty lines.
    pub empty: usize,
    /// Comments among the numbers.
    pub comments: usize,
    /// Text below the numbers.
    pub below: usize,
}

impl Lines {
    /// Lines that none of the kinds has.
    #[must_use]
    pub fn missing(&self) -> usize {
        let known = self.heading + self.rows + self.others + self.bad + self.empty + self.comments + self.below;
        self.all.abs_diff(known)
    }
}

impl std::fmt::Display for Account {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Lines { all, heading, rows, others, bad, empty, comments, below } = self.lines;
        let counts = [
            (heading, "heading"),
            (rows, "rows"),
            (others, "not asked for"),
            (bad, "not used"),
            (empty, "empty"),
            (comments, "comments"),
            (below, "text below"),
        ];
        let parts: Vec<String> =
            counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        write!(f, "{all} lines: {}; ", parts.join(", "))?;
        let columns: Vec<String> = self.columns.iter().map(|(name, what)| format!("{name}: {what}")).collect();
        write!(f, "columns {}", columns.join(", "))
    }
}
