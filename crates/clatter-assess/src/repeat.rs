//! The short command that answers a worst drop once more, from the product file.

use crate::{Accuracy, Case, WorstCase};
use clatter_product::{LimitKind, visible};

/// Returns `clatter respond --product=… --component=… --worst=…`, which searches the worst drop of a limit again and answers it; with the
/// model and the tolerance, where they are not those that an assessment has by itself. None where the command line cannot say it: for a
/// file that is standard input, for names that are no plain text, for another time of strikes that land as one.
///
/// # Examples
/// ```
/// use clatter_assess::{Accuracy, repeat};
/// use clatter_product::LimitKind;
/// let command = repeat("phone.toml", "main board", LimitKind::Acceleration, &Accuracy::default());
/// assert_eq!(command.unwrap(), "clatter respond --product=phone.toml --component='main board' --worst=acceleration");
/// ```
#[must_use]
pub fn repeat(path: &str, component: &str, limit: LimitKind, accuracy: &Accuracy) -> Option<String> {
    let own = Accuracy::default();
    let plain = |text: &str| visible(text) == text && text.trim() == text && text.chars().count() <= LONGEST;
    let said = plain(path) && plain(component) && path != "-" && accuracy.merge_s.to_bits() == own.merge_s.to_bits();
    let mut command = format!(
        "clatter respond --product={} --component={} --worst={}",
        quoted(path),
        quoted(component),
        limit.name()
    );
    if let Some(model) = accuracy.model {
        command.extend([" --model=", model.name()]);
    }
    if accuracy.tolerance.to_bits() != own.tolerance.to_bits() {
        command.extend([" --tolerance=", &format!("{:?}", accuracy.tolerance)]);
    }
    said.then_some(command)
}

impl WorstCase {
    /// Returns the command that answers the drop once more, for a shell: the drop as data.
    #[must_use]
    pub fn command(&self) -> String {
        // Numbers, names of fields and of variants: nothing that a shell would take apart.
        let data = serde_json::to_string(&Case::of(self)).unwrap_or_default();
        format!("printf %s '{data}' | clatter respond --drop=-")
    }
}

/// Longer names make no short command.
const LONGEST: usize = 80;

/// Quotes a text as a shell takes it for one word.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/+,:@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_product::Model;

    #[test]
    fn what_differs_from_an_assessment_by_itself_is_said() {
        let accuracy = Accuracy { tolerance: 0.001, model: Some(Model::Map), ..Accuracy::default() };
        let command = repeat("a b.toml", "Jo's", LimitKind::RattleSpace, &accuracy).unwrap();
        let said = r"clatter respond --product='a b.toml' --component='Jo'\''s' --worst=rattle-space --model=map --tolerance=0.001";
        assert_eq!(command, said);
    }

    #[test]
    fn what_a_command_line_cannot_say_is_not_said() {
        let of = |path: &str, name: &str, accuracy: &Accuracy| repeat(path, name, LimitKind::Acceleration, accuracy);
        let own = Accuracy::default();
        assert!(of("a.toml", "part", &own).is_some());
        assert_eq!(of("-", "part", &own), None);
        assert_eq!(of("a.toml", "a\u{1b}b", &own), None);
        assert_eq!(of("a.toml", &"x".repeat(100), &own), None);
        assert_eq!(of("a.toml", "part", &Accuracy { merge_s: 2e-3, ..own }), None);
    }
}
