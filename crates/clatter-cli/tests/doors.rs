//! One question has one answer: what the JSON says of each limit the table says as well, the printed page, `design` and `explain`.

#![cfg(test)]
#![expect(clippy::print_stdout, reason = "what fails is of the product that was told last")]

use std::path::{Path, PathBuf};
use std::process::Command;

use clatter_product::{
    ProductFile,
    units::{ACCELERATION, ANGULAR_VELOCITY, Dimension, LENGTH, SPEED},
};
use serde_json::Value;

/// A box on one face, and two drops of a bar.
const SMALL: [(&str, &str); 2] = [
    (
        "box.toml",
        r#"
product = { name = "Small box", length = "150 mm", width = "70 mm", thickness = "30 mm", mass = "200 g", radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.2, contact_time = "1 ms" }
drop = [{ height = "0.5 m", face = "bottom", attitude_tolerance = "2 deg" }]
component = [{ name = "part", position = ["30 mm", "0 mm"], axis = "z", mount = "hard", acceleration_limit = "500 gn", velocity_change_limit = "50 m/s" }]
"#,
    ),
    (
        "list.toml",
        r#"
product = { name = "Small list", length = "6 in", radius_of_gyration = "43 mm", restitution = 0.3, contact_time = "0.5 ms", contact_law = "dashpot" }
drop = [{ speed = "4 m/s", tilt = "3 deg" }, { speed = "2 m/s", tilt = ["10 deg", "20 deg"], first = "b" }]
component = [{ name = "part", position = "30 mm", natural_frequency = "200 Hz", damping_ratio = 0.05, acceleration_limit = "4000 gn", rattle_space = "0.5 in" }]
"#,
    ),
];

/// What is worked out is told to four digits, and on a page to three.
const DIGITS: [f64; 2] = [5.1e-4, 5.1e-3];

fn clatter(arguments: &[&str]) -> (String, Option<i32>) {
    let done = Command::new(env!("CARGO_BIN_EXE_clatter")).args(arguments).output().unwrap();
    assert!(done.status.code() != Some(2), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
    (String::from_utf8(done.stdout).unwrap(), done.status.code())
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&clatter(&[arguments, &["--format=json"]].concat()).0).unwrap()
}

fn array(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

fn limits(answer: &Value) -> Vec<(&Value, &Value)> {
    let parts = array(&answer["components"]).iter();
    parts.flat_map(|part| array(&part["limits"]).iter().map(move |limit| (part, limit))).collect()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

/// Whether a quantity as it is told, "-" or "–" where it is not known, is that of the JSON.
fn is_told(told: &str, value: &Value, unit: &Value, digits: f64) {
    let dimension: &Dimension = match text(unit) {
        "m/s2" => &ACCELERATION,
        "m" => &LENGTH,
        "m/s" => &SPEED,
        _ => &ANGULAR_VELOCITY,
    };
    match value.as_f64() {
        Some(value) => {
            let said = dimension.read(told).unwrap().si;
            assert!((said / value - 1.0).abs() < digits, "{told}, not {value}");
        }
        None => assert!(["-", "–"].contains(&told), "{told}, not {value}"),
    }
}

/// The same of a margin, told to a tenth of a percent or, on a page, to a percent.
fn is_margin(told: &str, value: &Value, least: f64) {
    let Some(value) = value.as_f64() else { panic!("{value}") };
    let said: f64 = told.replace('−', "-").trim_end_matches('%').trim().parse().unwrap();
    assert!((said / 100.0 - value).abs() < least, "{told}, not {value}");
}

/// A column of the table, which is broken where it is too wide; rows that go on with a part leave its name out.
fn column<'a>(table: &'a str, head: &str) -> Vec<&'a str> {
    let cells = |line: &'a str| line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect::<Vec<_>>();
    let is_head = |line: &&'a str| line.starts_with("component") && cells(line).contains(&head);
    let mut lines = table.lines().skip_while(|line| !is_head(line));
    let heads = cells(lines.next().unwrap());
    let from_right = heads.iter().rev().position(|cell| *cell == head).unwrap();
    lines
        .take_while(|line| !line.is_empty())
        .map(|line| cells(line).into_iter().rev().nth(from_right).unwrap())
        .collect()
}

fn the_table_says(answer: &Value, table: &str) {
    let verdict = match text(&answer["verdict"]) {
        "unsafe" => "is UNSAFE",
        "safe" => "is safe",
        _ => "is undecided",
    };
    assert!(table.starts_with(&format!("{} {verdict}", text(&answer["product"]))), "{table}");
    let limits = limits(answer);
    let names = column(table, "limit").into_iter().zip(column(table, "verdict"));
    assert_eq!(names.len(), limits.len(), "{table}");
    for ((name, verdict), (_, limit)) in names.zip(&limits) {
        assert_eq!((name, &*verdict.to_lowercase()), (text(&limit["limit"]), text(&limit["verdict"])));
    }
    let columns = [
        ("allowed", "allowed"),
        ("demand", "demand"),
        ("bound by energy", "bound"),
        ("flat drop", "clatter_free"),
        ("other law", "other_law"),
    ];
    for (head, key) in columns {
        for (told, (_, limit)) in column(table, head).into_iter().zip(&limits) {
            is_told(told, &limit[key], &limit["unit"], DIGITS[0]);
        }
    }
    for (told, (_, limit)) in column(table, "margin").into_iter().zip(&limits) {
        is_margin(told, &limit["margin"], 5.1e-4);
    }
}

/// What comes first of a text: a quantity and its unit, a dash, or a word.
fn quantity<'a>(left: &mut &'a str) -> &'a str {
    *left = left.trim_start();
    let mut words = left.match_indices(' ').map(|(at, _)| at);
    let first = words.next().unwrap();
    let is_number = left.starts_with(|c: char| c.is_ascii_digit() || "+−∞".contains(c));
    let (told, rest) = left.split_at(if is_number { words.next().unwrap() } else { first });
    *left = rest;
    told
}

fn the_page_says(answer: &Value, page: &str) {
    let first = page.split_once("Signature ").unwrap().1.to_lowercase();
    assert!(first.starts_with(text(&answer["verdict"])), "{page}");
    let mut left = page.split_once("Bound Margin Verdict ").unwrap().1;
    let mut last = "";
    for (part, limit) in limits(answer) {
        if text(&part["name"]) != last {
            last = text(&part["name"]);
            left = left.trim_start().strip_prefix(last).unwrap_or_else(|| panic!("{last}: {left}"));
        }
        let words = text(&limit["limit"]).replace('-', " ");
        left = left.split_once(&words).unwrap().1;
        for key in ["allowed", "demand", "clatter_free", "bound"] {
            is_told(quantity(&mut left), &limit[key], &limit["unit"], DIGITS[1]);
        }
        is_margin(quantity(&mut left), &limit["margin"], 5.1e-3);
        assert_eq!(quantity(&mut left), text(&limit["verdict"]));
    }
}

/// `design` tells the margins by both contact laws where the file names none, and the page the changes that it finds.
fn design_says(answer: &Value, path: &str, both: bool, page: Option<&str>) {
    let design = json(&["design", path]);
    for (part, said) in array(&answer["components"]).iter().zip(array(&design["components"])) {
        assert_eq!(part["verdict"], said["verdict"]);
        let margin = |limit: &Value| {
            let asked = [&limit["demand"], &limit["other_law"]];
            let asked = asked.into_iter().take(if both { 2 } else { 1 }).filter_map(Value::as_f64);
            asked.map(|asked| limit["allowed"].as_f64().unwrap() / asked - 1.0).fold(f64::INFINITY, f64::min)
        };
        let least = array(&part["limits"]).iter().map(margin).fold(f64::INFINITY, f64::min);
        assert!((said["margin"].as_f64().unwrap() - least).abs() < 1e-9, "{said}: {least}");
    }
    let (Some(mut left), table) = (page, clatter(&["design", path]).0) else { return };
    // The page tells parts in the order of the file, changes in that of the levers.
    for row in table.lines().filter(|line| line.starts_with("  ") && line.contains(" -> ")) {
        let row = row.split("   (").next().unwrap().split(", ").next().unwrap();
        let told = row.split_whitespace().filter(|word| *word != "->").collect::<Vec<_>>().join(" ").replace('-', "−");
        left = left.split_once(&told).unwrap_or_else(|| panic!("{path}: {told}: {left}")).1;
    }
}

/// The worst drops are those that `explain` takes, and the model with the most physics asks as much in them to the tolerance of 1 %.
fn explain_says(answer: &Value, path: &str) {
    let explained = json(&["explain", path]);
    let mut all = array(&explained["limits"]).iter();
    for (part, limit) in limits(answer) {
        let said = all.next().unwrap();
        assert_eq!([&said["component"], &said["limit"]], [&part["name"], &limit["limit"]]);
        assert_eq!(said["worst_case"], limit["worst_case"]);
        let [asked, demand] = [&said["reference"]["value"], &limit["demand"]].map(|value| value.as_f64().unwrap());
        assert!((asked / demand - 1.0).abs() < 0.01, "{said}: {demand}");
    }
}

#[test]
fn every_door_gives_the_same_answer() {
    let dir = tempfile::tempdir().unwrap();
    let worked = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../reports/examples"));
    let mut paths: Vec<PathBuf> = worked.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    for (name, product) in SMALL {
        std::fs::write(dir.path().join(name), product).unwrap();
        paths.push(dir.path().join(name));
    }
    for path in paths {
        let (path, pdf) = (path.to_str().unwrap(), dir.path().join("page.pdf"));
        let answer = json(&["assess", path]);
        println!("{path}");
        // An opt-out for machines that cannot have typst; it is never set in CI.
        let is_set = std::env::var_os("CLATTER_SKIP_TYPST").is_none();
        let page = if is_set { vec!["--output", pdf.to_str().unwrap()] } else { Vec::new() };
        let (table, code) = clatter(&[&["assess", path][..], &page].concat());
        assert_eq!(code, Some(i32::from(answer["verdict"] != "safe")));
        the_table_says(&answer, &table);
        let page = is_set.then(|| {
            let pdf = lopdf::Document::load(&pdf).unwrap();
            let numbers: Vec<u32> = pdf.get_pages().into_keys().collect();
            pdf.extract_text(&numbers).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
        });
        if let Some(page) = &page {
            the_page_says(&answer, page);
        }
        let file = ProductFile::read(&std::fs::read_to_string(path).unwrap(), path).unwrap();
        // Of a plate or a box they take long.
        if !file.product.body.is_wide() {
            design_says(&answer, path, file.product.contact_law.is_none(), page.as_deref());
            explain_says(&answer, path);
        }
    }
}
