//! The form of the lines of numbers of a text.

use crate::text::cells::Form;
use crate::text::encoding::Letters;
use crate::text::header::Header;
use crate::text::sensors::Word;

/// The form of the lines of numbers.
#[derive(Debug, Clone, Default)]
pub(in crate::text) struct Shape {
    pub(in crate::text) form: Form,
    /// The letters of text that is no UTF-8.
    pub(in crate::text) letters: Letters,
    pub(in crate::text) columns: usize,
    /// Time of the first sample, and between samples, where lines above the numbers tell it.
    pub(in crate::text) sampled_s: Option<[f64; 2]>,
    /// Time between samples that a line above tells, and the line.
    pub(in crate::text) told: Option<(f64, usize)>,
    /// What else lines above tell.
    pub(in crate::text) header: Header,
    /// The line right above the numbers, where it names the columns: it may come again.
    pub(in crate::text) heading: Option<String>,
    /// The column of the fraction of a second, beside one of seconds, and the size of its unit.
    pub(in crate::text) fraction: Option<(usize, f64)>,
    /// Tells whether some channels were asked for, so that lines without a number of these are of others.
    pub(in crate::text) by_other: bool,
    /// How many samples there are by a line above, and the line.
    pub(in crate::text) count: Option<(usize, usize)>,
    /// Columns in which a unit stands behind each number.
    pub(in crate::text) measured: Vec<bool>,
    /// The column of dates beside times of day.
    pub(in crate::text) date: Option<usize>,
    pub(in crate::text) words: Vec<Word>,
}
