//! This test checks that the command of typst and its wheel set the same pages.
//!
//! Both hold the same typst, with other versions of the library that packs streams. So the pages are not the same byte for byte;
//! each object in them is, unpacked, but for the name of the instance, which typst makes of the bytes.

use super::ways::{COMMAND, WHEEL, content};
use crate::{Pages, assessment};

/// The content of the test pages: text, formulas, tables of data, drawings.
const PAGE: &str = "
#set document(title: \"Both ways\", author: \"clatter\")
#set text(font: \"Libertinus Serif\", lang: \"en\")
= What is set
#figure(image(\"/figure.svg\", alt: \"a line\"), caption: [A drawing with _words_])
#math.equation(block: true, alt: \"q\", $ q = (L^2 - rho^2) / (L^2 + rho^2) $)
#table(columns: 2, table.header([e], [q]), ..json(\"data.json\").map(str))
";
const FIGURE: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='60' height='40'>\
    <path d='M3 5L50 30' stroke='#a34a1c'/><text x='9' y='30' font-family='Libertinus Serif' font-size='8'>e, ρ</text></svg>";
/// FNV-1a, 64 bits, of its content. It moves with typst, and with how the content is written down above.
const DIGEST: u64 = 0x92fa_6fd1_daad_6dbc;

#[test]
fn each_way_sets_the_page_that_is_known() {
    for typst in COMMAND.iter().chain(&*WHEEL) {
        let files = [("figure.svg", FIGURE), ("data.json", "[0.3, 0.5]")];
        let content = content(&typst.set(("known.typ", PAGE), files.into_iter()).unwrap());
        let digest = content
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325, |hash: u64, b| (hash ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
        assert_eq!(digest, DIGEST, "by {}", typst.program.display());
    }
}

#[test]
fn each_way_fails_for_a_warning_a_fault_and_what_no_screen_reader_could_read() {
    for typst in COMMAND.iter().chain(&*WHEEL) {
        for (page, says) in [
            ("#set document(title: \"x\")\n#set text(font: \"Nowhere\")\n= One", ["nowhere", "x.typ:2:16"]),
            ("#set document(title: \"x\")\n#panic(1)", ["panicked with: 1", "x.typ:2:1"]),
            ("= One", ["PDF/UA-1", "title"]),
        ] {
            let error = typst.set(("x.typ", page), std::iter::empty()).unwrap_err().to_string();
            assert!(says.iter().all(|says| error.contains(says)), "by {}: {error}", typst.program.display());
        }
    }
}

#[test]
fn both_ways_set_the_same_assessment() {
    let (Some(command), Some(wheel)) = (&*COMMAND, &*WHEEL) else { return };
    let product = clatter_product::ProductFile::read(clatter_product::EXAMPLE, "example.toml").unwrap();
    let assessed = clatter_assess::assess(&product).unwrap();
    let portraits = clatter_assess::portraits(&product, &assessed);
    let pages = Pages {
        file: &product,
        assessment: &assessed,
        portraits: &portraits,
        remedies: &clatter_assess::remedies(&product, &assessed, &clatter_assess::design::Bounds::default(), 0.1)
            .unwrap(),
        measured: &[],
        path: "example.toml",
        date: None,
    };
    let files = assessment::files(&pages).unwrap();
    let source = ("assessment.typ", include_str!("../../../../reports/assessment.typ"));
    let files = || files.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let [one, other] = [command, wheel].map(|typst| content(&typst.set(source, files()).unwrap()));
    let differ = one.lines().zip(other.lines()).find(|(one, other)| one != other);
    assert!(one == other, "{differ:.200?}");
}
