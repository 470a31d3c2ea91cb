//! The command of typst and its wheel set the same pages.
//!
//! Both hold the same typst, with other versions of the library that packs streams. So the pages are not the same byte for byte;
//! each object in them is, unpacked, but for the name of the instance, which typst makes of the bytes.

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::LazyLock;

use super::*;
use crate::page::set;
use crate::{Pages, accuracy_files, assessment, paper, shock};

static COMMAND: LazyLock<Option<Typst>> = LazyLock::new(by_command);
static WHEEL: LazyLock<Option<Typst>> = LazyLock::new(by_wheel);

/// Says on the terminal, where tests are not heard, what is not tested here.
fn skip(why: &str) {
    let _ = writeln!(std::io::stderr(), "skipped: the pages of both ways to run typst are not compared: {why}");
}

fn env(name: &str) -> Option<std::ffi::OsString> {
    std::env::var_os(name).filter(|value| !value.is_empty())
}

/// The command, of the tested version, where there is one.
fn by_command() -> Option<Typst> {
    let all = find::named(&env).unwrap().into_iter().chain(find::on_path(&env, "typst")).map(Typst::new);
    let all = all.chain(find::root(&env).ok().map(|root| build::kept(&root)));
    let found = all.into_iter().find(|typst| typst.asked().is_ok_and(|warning| warning.is_none()));
    if found.is_none() {
        skip(&format!("there is no command typst {VERSION} here"));
    }
    found
}

/// The wheel, of which there is one in the cache afterwards, where it can be had.
fn by_wheel() -> Option<Typst> {
    let installed = || {
        let root = find::root(&env)?;
        fs::create_dir_all(&root).unwrap();
        let _lock = lock::lock(&root.join("lock"), LOCK_LIMIT, &mut |_| ())?;
        let kept = wheel::kept(&root);
        if kept.asked().is_ok() {
            return Ok(kept);
        }
        find::may_install(&env)?;
        wheel::install(&env, &root, wheel::STEP_LIMIT, &mut |_| ())
    };
    let error = match installed() {
        Ok(typst) => return Some(typst),
        Err(error) => error.to_string(),
    };
    // No Python, or a bare one; no network, or no wheel for this machine.
    let may = [
        "CLATTER_NO_INSTALL",
        "none is on PATH",
        "No module named",
        "ensurepip",
        "No matching distribution",
        "HTTPSConnectionPool",
    ];
    assert!(may.iter().any(|may| error.contains(may)), "{error}");
    skip(error.lines().last().unwrap_or_default());
    None
}

/// What a PDF holds, a line an object.
fn content(pdf: &[u8]) -> String {
    let pdf = lopdf::Document::load_mem(pdf).unwrap();
    let mut content = String::new();
    for (id, object) in &pdf.objects {
        if let Ok(stream) = object.as_stream() {
            let mut dict = stream.dict.clone();
            dict.remove(b"Length");
            let plain = stream.get_plain_content().unwrap();
            writeln!(content, "{id:?} {dict:?} {}", plain.escape_ascii()).unwrap();
        } else {
            writeln!(content, "{id:?} {object:?}").unwrap();
        }
    }
    let names = pdf.trailer.get(b"ID").and_then(lopdf::Object::as_array).unwrap();
    let instance = String::from_utf8(names[1].as_str().unwrap().to_vec()).unwrap();
    assert_eq!(content.matches(&instance).count(), 1, "the instance is named in the metadata alone");
    content.replace(&instance, "")
}

/// What the pages are made of: text, formulas, tables of data, drawings.
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
        let content = content(&set(typst, ("known.typ", PAGE), files.into_iter()).unwrap());
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
            let error = set(typst, ("x.typ", page), std::iter::empty()).unwrap_err().to_string();
            assert!(says.iter().all(|says| error.contains(says)), "by {}: {error}", typst.program.display());
        }
    }
}

#[test]
fn both_ways_set_the_same_reports() {
    let (Some(command), Some(wheel)) = (&*COMMAND, &*WHEEL) else { return };
    let product = clatter_assess::ProductFile::read(clatter_assess::EXAMPLE, "example.toml").unwrap();
    let assessed = product.assess().unwrap();
    let portraits = product.portraits(&assessed);
    let pages = Pages {
        file: &product,
        assessment: &assessed,
        portraits: &portraits,
        measured: &[],
        path: "example.toml",
        date: None,
    };
    let pages = assessment::files(&pages);
    let named =
        |files: Vec<paper::File>| files.into_iter().map(|(name, text)| (name.to_owned(), text)).collect::<Vec<_>>();
    let reports = [
        (
            ("paper.typ", include_str!("../../../../reports/paper.typ")),
            named(paper::Data::compute().unwrap().files().unwrap()),
        ),
        (
            ("shock.typ", include_str!("../../../../reports/shock.typ")),
            named(shock::Data::compute().unwrap().files().unwrap()),
        ),
        (("accuracy.typ", include_str!("../../../../reports/accuracy.typ")), named(accuracy_files().unwrap())),
        (("assessment.typ", include_str!("../../../../reports/assessment.typ")), pages.unwrap()),
    ];
    let page = paper::page();
    let inputs = [
        ("page.json", page.as_str()),
        ("trade.typ", include_str!("../../../../reports/trade.typ")),
        ("peers.typ", include_str!("../../../../reports/peers.typ")),
    ];
    for (source, files) in &reports {
        let files = || inputs.into_iter().chain(files.iter().map(|(name, text)| (name.as_str(), text.as_str())));
        let [one, other] = [command, wheel].map(|typst| content(&set(typst, *source, files()).unwrap()));
        let differ = one.lines().zip(other.lines()).find(|(one, other)| one != other);
        assert!(one == other, "{}: {differ:.200?}", source.0);
    }
}
