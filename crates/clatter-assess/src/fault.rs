//! What is wrong with a product file, shown where it stands.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use crate::{visible, visible_lines};

/// One thing that is wrong with a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Bytes of the file it is about.
    pub span: Range<usize>,
    /// What is wrong, with the value.
    pub message: String,
    /// What stands there, or should.
    pub label: String,
    /// What is allowed, or what to do; may be empty.
    pub help: String,
}

/// All that is wrong with a file, in the order of the file.
///
/// Its `Display` shows each with the place underlined; whatever a terminal would obey is [`visible()`] in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Faults {
    origin: String,
    source: String,
    list: Vec<Fault>,
}

/// Further faults are only counted.
const SHOWN: usize = 24;

impl Faults {
    pub(crate) fn new(origin: &str, source: &str, mut faults: Vec<Fault>) -> Self {
        faults.sort_by_key(|fault| (fault.span.start, fault.span.end));
        Self { origin: origin.to_owned(), source: source.to_owned(), list: faults }
    }
    /// Each of them.
    #[must_use]
    pub fn list(&self) -> &[Fault] {
        &self.list
    }
    /// Line and column of a fault, from 1; columns count characters.
    #[must_use]
    pub fn place(&self, fault: &Fault) -> (usize, usize) {
        let before = self.source.get(..fault.span.start).unwrap_or(&self.source);
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let renderer = Renderer::plain().term_width(120);
        for (i, fault) in self.list.iter().take(SHOWN).enumerate() {
            if i > 0 {
                writeln!(f, "\n")?;
            }
            let mark = AnnotationKind::Primary.span(fault.span.clone()).label(visible(&fault.label));
            let snippet = Snippet::source(&*self.source).path(visible(&self.origin)).annotation(mark);
            let mut group = Level::ERROR.primary_title(visible(&fault.message)).element(snippet);
            if !fault.help.is_empty() {
                group = group.element(Level::HELP.message(visible(&fault.help)));
            }
            write!(f, "{}", visible_lines(&renderer.render(&[group])))?;
        }
        if self.list.len() > SHOWN {
            write!(f, "\n\nerror: and {} more", self.list.len() - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}
