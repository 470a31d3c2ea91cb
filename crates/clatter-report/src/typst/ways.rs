//! This module has the two ways to run typst, and reads the content of their pages, for all tests of pages.

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::LazyLock;

use super::Typst;

pub(crate) static COMMAND: LazyLock<Option<Typst>> = LazyLock::new(by_command);
pub(crate) static WHEEL: LazyLock<Option<Typst>> = LazyLock::new(by_wheel);

/// Says on the terminal, where tests are not heard, what is not tested here.
fn skip(why: &str) {
    let _ = writeln!(std::io::stderr(), "skipped: the pages of both ways to run typst are not compared: {why}");
}

/// Returns the command of the tested version, where there is one.
fn by_command() -> Option<Typst> {
    let found = Typst::by_command().unwrap();
    if found.is_none() {
        skip("there is no command typst of the tested version here");
    }
    found
}

/// Returns the wheel, where it can be had; it is in the cache afterwards.
fn by_wheel() -> Option<Typst> {
    let error = match Typst::by_wheel(&mut |_| ()) {
        Ok(typst) => return Some(typst),
        Err(error) => error.to_string(),
    };
    // The machine may have no Python, or a bare one; no network, or no wheel that fits.
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

/// Returns the content of a PDF, one line for each object.
pub(crate) fn content(pdf: &[u8]) -> String {
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
