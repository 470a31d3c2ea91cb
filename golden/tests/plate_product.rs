//! The text of the pages of a plate.

use std::fmt::Write as _;

use clatter_product::ProductFile;

/// Checks headings, alternative texts, and the beginnings of the parts of the pages.
#[test]
fn the_pages_of_a_plate() {
    // An opt-out for machines that cannot have typst; it is never set in CI.
    if std::env::var_os("CLATTER_SKIP_TYPST").is_some() {
        return;
    }
    let file = ProductFile::read(include_str!("../../reports/examples/handheld-terminal.toml"), "plate.toml").unwrap();
    let assessment = clatter_assess::assess(&file).unwrap();
    let portraits = clatter_assess::portraits(&file, &assessment);
    let (file, assessment, portraits) = (&file, &assessment, &portraits[..]);
    let pages = clatter_report::Pages {
        file,
        assessment,
        portraits,
        remedies: &[],
        measured: &[],
        path: "plate.toml",
        date: None,
    };
    let (bytes, warnings) = clatter_report::assessment_pdf(&pages, &mut |_| ()).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let pdf = lopdf::Document::load_mem(&bytes).unwrap();
    let mut text = format!("pages: {}\n", pdf.get_pages().len());
    for object in pdf.objects.values() {
        let alt = object.as_dict().ok().and_then(|dict| dict.get(b"Alt").ok());
        if let Some(alt) = alt.and_then(|alt| lopdf::decode_text_string(alt).ok()) {
            let _ = writeln!(text, "alt: {alt}");
        }
    }
    let numbers: Vec<u32> = pdf.get_pages().into_keys().collect();
    let said = pdf.extract_text(&numbers).unwrap();
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    let openings = [
        "Unsafe",
        "The verdict is made from",
        "Fig. 1 ",
        "Fig. 2 ",
        "It sits",
        "Fig. 4 ",
        "Fig. 5 ",
        "Fig. 6 ",
        "Real tilt",
    ];
    for opening in openings {
        let from = said.find(opening).unwrap_or_else(|| panic!("no page says {opening:?}: {said}"));
        let _ = writeln!(text, "text: {}", said[from..].chars().take(180).collect::<String>());
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("plate-product-page", text));
}
