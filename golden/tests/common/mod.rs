//! Common parts of the goldens: their place, the number of digits, the text of a page.

use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Compares `text` with the snapshot of this name.
pub(crate) fn golden(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// Returns `digits` significant digits; a value that is only rounding is marked as such.
pub(crate) fn digits(value: f64, digits: u8) -> String {
    match value {
        v if v.is_infinite() => "inf".into(),
        0.0 => "0".into(),
        v if v.abs() < 1e-12 => "rounding".into(),
        v => {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 12 + digits")]
            let decimals = (f64::from(digits) - 1.0 - v.abs().log10().floor()).max(0.0) as usize;
            format!("{v:.decimals$}")
        }
    }
}

/// Returns the text of the page of a report where a reader or a screen reader looks for it, with the text that follows
/// each of the `openings`.
pub(crate) fn page(report: clatter_studies::Report, openings: &[&str]) -> Option<String> {
    let dir = tempfile::tempdir().expect("a temporary directory");
    // an opt-out for machines that cannot have typst; it is never set in CI
    if std::env::var_os("CLATTER_SKIP_TYPST").is_some() {
        return None;
    }
    let written = clatter_studies::write(report, dir.path(), &mut |_| ()).expect("the report is written");
    let pdf = lopdf::Document::load(&written.files[0]).expect("a PDF");
    let mut text = String::new();
    let files: Vec<_> =
        written.files.iter().filter_map(|f| Some(f.file_name()?.to_string_lossy().into_owned())).collect();
    let _ = writeln!(text, "files: {}", files.join(" "));
    let _ = writeln!(text, "pages: {}", pdf.get_pages().len());
    let (mut fonts, mut alts, mut titles) = (BTreeSet::new(), Vec::new(), Vec::new());
    for object in pdf.objects.values() {
        let Ok(dict) = object.as_dict() else { continue };
        let string = |key: &[u8]| dict.get(key).ok().and_then(|v| lopdf::decode_text_string(v).ok());
        if let Ok(name) = dict.get(b"FontName").and_then(lopdf::Object::as_name) {
            let name = String::from_utf8_lossy(name);
            fonts.insert(name.split('+').next_back().unwrap_or_default().to_owned());
        }
        if let Some(alt) = string(b"Alt") {
            alts.push(alt);
        }
        if dict.has(b"Parent") && dict.has(b"Dest") {
            titles.extend(string(b"Title"));
        }
        assert!(
            dict.get(b"Subtype").and_then(lopdf::Object::as_name).ok() != Some(b"Image"),
            "an image that is not vector"
        );
    }
    let _ = writeln!(text, "fonts: {}", fonts.into_iter().collect::<Vec<_>>().join(", "));
    for (what, lines) in [("heading", titles), ("alt", alts)] {
        for line in lines {
            let _ = writeln!(text, "{what}: {line}");
        }
    }
    let pages: Vec<u32> = pdf.get_pages().into_keys().collect();
    let said = pdf.extract_text(&pages).expect("text");
    let words: Vec<&str> = said.split_whitespace().collect();
    let said = words.join(" ");
    for opening in openings {
        let from = said.find(opening).unwrap_or_else(|| panic!("the page does not say {opening:?}"));
        let _ = writeln!(text, "text: {}", said[from..].chars().take(90).collect::<String>());
    }
    Some(text)
}
