//! This module shows the faults of a product file where they stand.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use crate::{visible, visible_lines};

/// One thing that is wrong with a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Bytes of the file it is about.
    pub span: Range<usize>,
    /// The fault, with the value.
    pub message: String,
    /// The text that stands there, or should.
    pub label: String,
    /// The allowed values, or the action to take; may be empty.
    pub help: String,
    /// Another place that it is about, and what stands there.
    pub also: Option<(Range<usize>, String)>,
}

/// All that is wrong with a file, and all that is odd, each in the order of the file.
///
/// Its `Display` shows each with the place underlined; whatever a terminal would obey is [`visible()`] in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Faults {
    origin: String,
    source: String,
    list: Vec<Fault>,
    warnings: Vec<Fault>,
}

/// Further faults are only counted.
const SHOWN: usize = 24;

impl Faults {
    pub(crate) fn new(origin: &str, source: &str, mut list: Vec<Fault>, mut warnings: Vec<Fault>) -> Self {
        for all in [&mut list, &mut warnings] {
            all.sort_by_key(|fault| (fault.span.start, fault.span.end));
        }
        Self { origin: origin.to_owned(), source: source.to_owned(), list, warnings }
    }
    /// Returns the faults.
    #[must_use]
    pub fn list(&self) -> &[Fault] {
        &self.list
    }
    /// Returns the warnings: values that are allowed and likely a slip.
    #[must_use]
    pub fn warnings(&self) -> &[Fault] {
        &self.warnings
    }
    /// Returns the line and column of a fault, from 1; columns count characters.
    #[must_use]
    pub fn place(&self, fault: &Fault) -> (usize, usize) {
        let before = self.source.get(..fault.span.start).unwrap_or(&self.source);
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// Returns a fault with its place in the file.
    fn rendered(&self, fault: &Fault, level: Level<'_>) -> String {
        let mark = AnnotationKind::Primary.span(fault.span.clone()).label(visible(&fault.label));
        let also = fault.also.iter();
        let also = also.map(|(span, label)| AnnotationKind::Context.span(span.clone()).label(visible(label)));
        let snippet = Snippet::source(&*self.source).path(visible(&self.origin)).annotation(mark).annotations(also);
        let mut group = level.primary_title(visible(&fault.message)).element(snippet);
        if !fault.help.is_empty() {
            group = group.element(Level::HELP.message(visible(&fault.help)));
        }
        visible_lines(&Renderer::plain().term_width(120).render(&[group])).into_owned()
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut blank = "";
        for (name, level, list) in [("error", Level::ERROR, &self.list), ("warning", Level::WARNING, &self.warnings)] {
            for fault in list.iter().take(SHOWN) {
                write!(f, "{blank}{}", self.rendered(fault, level.clone()))?;
                blank = "\n\n";
            }
            if list.len() > SHOWN {
                write!(f, "\n\n{name}: and {} more", list.len() - SHOWN)?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}
