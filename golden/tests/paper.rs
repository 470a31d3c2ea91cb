//! The paper's table, claims, curves and page.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use clatter::contour::{self, SafeZone};
use clatter::paper::{Kind, claims, table1};
use clatter::{Axis, Map, Quantity};

fn golden(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// `digits` significant digits; what is only rounding is told as such.
fn digits(value: f64, digits: u8) -> String {
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

#[test]
fn table_1() {
    let mut text = String::new();
    for row in table1().unwrap() {
        let _ = writeln!(text, "{:?}", row.kind);
        for cell in row.cells {
            let _ = writeln!(text, "  {:>6}  {:<12} {:?}", cell.printed, digits(cell.value, 11), cell.agreement);
        }
    }
    golden("table-1", &text);
}

#[test]
fn the_claims() {
    let mut text = String::new();
    for claim in claims().unwrap() {
        let _ = writeln!(text, "{:?}  {}: {}", claim.verdict, claim.place, claim.statement);
        for m in claim.measured {
            let value = if m.kind == Kind::Count { format!("{:.0}", m.value) } else { digits(m.value, 6) };
            let _ = writeln!(text, "    {value:<10} {}", m.what);
        }
    }
    golden("claims", &text);
}

#[test]
fn the_curves_between_counts() {
    let mut text = String::from("curve      q            e\n");
    for n in [2, 3, 4, 10, 100] {
        for point in contour::impacts(n, 4) {
            let _ = writeln!(text, "{n:<6} {:<12.10} {:.10}", point.q, point.e);
        }
    }
    for point in contour::endless(4) {
        let _ = writeln!(text, "endls  {:<12.10} {:.10}", point.q, point.e);
    }
    golden("curves-of-impacts", &text);
}

#[test]
fn the_levels_of_the_safe_zones() {
    let levels = [(0.5, 0.0), (0.5, 0.1), (1.0, 0.0), (1.0, 0.2), (1.0, 0.5), (2.0, 0.5), (2.0, 1.0)];
    let mut text = String::from("e where s = level; - where no e has it\nq     ");
    for (threshold, level) in levels {
        let _ = write!(text, " {:<12}", format!("s({threshold})={level}"));
    }
    for i in 0..=10u8 {
        let q = f64::from(i) / 10.0;
        let _ = write!(text, "\n{q:<6}");
        for (threshold, level) in levels {
            let e = SafeZone::new(threshold).restitution(level, q);
            let _ = write!(text, " {:<12}", e.map_or("-".into(), |e| format!("{e:.10}")));
        }
    }
    golden("levels-of-safe-zones", &text);
}

#[test]
fn coarse_maps() {
    let mut text = String::new();
    for quantity in [Quantity::Impacts, Quantity::PeakEnd, Quantity::Duration, Quantity::NetCenter, Quantity::Zone(1.0)]
    {
        let map = Map::compute(quantity, Axis::q(-0.5, 1.0, 7).unwrap(), Axis::e(0.0, 1.0, 6).unwrap()).unwrap();
        let _ = writeln!(text, "{quantity:?}: q down from -0.5 to 1, e across from 0 to 1");
        for line in map.values.chunks(6) {
            let cells: Vec<_> = line.iter().map(|v| format!("{:<11}", digits(*v, 9))).collect();
            let _ = writeln!(text, "  {}", cells.join(" ").trim_end());
        }
    }
    golden("coarse-maps", &text);
}

/// What the page says, where a reader or a screen reader looks for it.
#[test]
fn the_page() {
    let dir = tempfile::tempdir().unwrap();
    // an opt-out for machines that cannot have typst; it is never set in CI
    if std::env::var_os("CLATTER_SKIP_TYPST").is_some() {
        return;
    }
    let written = clatter_report::write(clatter_report::Report::Paper, dir.path(), &mut |_| ()).unwrap();
    let pdf = lopdf::Document::load(&written.files[0]).unwrap();
    let mut text = String::new();
    let files: Vec<_> = written.files.iter().map(|f| f.file_name().unwrap().to_string_lossy().into_owned()).collect();
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
    let said = pdf.extract_text(&pages).unwrap();
    let words: Vec<&str> = said.split_whitespace().collect();
    let said = words.join(" ");
    for opening in ["Of its ", "Fig. 2 ", "Fig. 5 ", "Fig. 6 ", "Fig. 7 "] {
        let from = said.find(opening).unwrap_or_else(|| panic!("the page does not say {opening:?}"));
        let _ = writeln!(text, "text: {}", said[from..].chars().take(90).collect::<String>());
    }
    golden("page", &text);
}
