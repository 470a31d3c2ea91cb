//! `clatter fit`: from a measured drop to the data of the product. That its numbers and intervals hold is tested in `clatter-assess`.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use clatter_cli::Exit;
use serde_json::Value;

use crate::{answer, clatter};

/// The paper's reference bar, q = 1/2, so slow and so level that neither gravity nor the tilt counts.
const PRODUCT: &str = r#"# a bar of the laboratory
[product]
name = "Bar"
length = "200 mm"
radius_of_gyration = "57.735 mm" # evenly spread
restitution = [0.1, 0.9] # not known yet
[drop]
speed = "0.1 m/s"
tilt = ["0 deg", "1 deg"]
gravity = "0 gn"
[[component]]
name = "part"
position = "0 mm"
mount = "hard"
velocity_change_limit = "1 m/s"
"#;

/// Its four strikes for e = 0.3 and a gap of 2 ms times the speed, by Eqs. 1 to 3: 0, 1/1.65, 0.8414239 and 17.1929825 times that.
const STRIKES: &str = "time_s,end\n0.25,a\n0.25121212121,b\n0.25168284790,a\n0.28438596491,b\n";

fn write(dir: &Path, name: &str, text: &str) -> String {
    let path = dir.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn estimate<'a>(found: &'a Value, name: &str) -> &'a Value {
    let all = found["estimates"].as_array().unwrap();
    all.iter().find(|one| one["quantity"] == name).unwrap_or_else(|| panic!("{name} in {found:#}"))
}

#[test]
fn strikes_give_the_restitution_and_gap_over_speed() {
    let dir = tempfile::tempdir().unwrap();
    let product = format!("--product={}", write(dir.path(), "bar.toml", PRODUCT));
    let strikes = write(dir.path(), "strikes.csv", STRIKES);
    for ends in [true, false] {
        let file =
            if ends { strikes.clone() } else { write(dir.path(), "times.csv", &STRIKES.replace(['a', 'b'], "")) };
        let found = answer(["fit", &file, &product, "--known-gyration", "--timing=1us"]);
        let e = estimate(&found, "restitution");
        assert!((e["value"].as_f64().unwrap() - 0.3).abs() < 1e-4, "{e}");
        let [lo, hi] = [0, 1].map(|i| e["interval"][i].as_f64().unwrap());
        assert!(lo < 0.3 && 0.3 < hi && hi - lo < 0.01, "{e}");
        let gap = estimate(&found, "gap-over-speed");
        assert!((gap["value"].as_f64().unwrap() - 2e-3).abs() < 1e-6 && gap["unit"] == "s", "{gap}");
        let speed = found["untold"].as_array().unwrap().iter().find(|one| one["quantity"] == "speed").unwrap();
        assert!(
            speed["reason"].as_str().unwrap().contains("the gap over the speed, not the gap and the speed"),
            "{speed}"
        );
        assert_eq!((&found["model"], &found["first"]), (&"finite-tilt".into(), &"a".into()));
        let record = &found["records"][0];
        assert_eq!((&record["kind"], record["strikes"].as_array().unwrap().len()), (&"strikes".into(), 4));
        assert!((record["first_touch_s"].as_f64().unwrap() - 0.25).abs() < 1e-6, "{record}");
        assert_eq!(found["correlations"].as_array().unwrap().len(), found["estimates"].as_array().unwrap().len());
    }
}

#[test]
fn a_copy_of_the_product_file_has_the_ranges_and_all_else_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let product = write(dir.path(), "bar.toml", PRODUCT);
    let strikes = write(dir.path(), "strikes.csv", STRIKES);
    let [copy, picture] = ["fitted.toml", "fitted.svg"].map(|name| dir.path().join(name));
    let (flag, outputs) =
        (format!("--product={product}"), [&copy, &picture].map(|path| format!("-o{}", path.display())));
    let outcome = clatter(["fit", &strikes, &flag, "--known-gyration", "--timing=1us", &outputs[0], &outputs[1]]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert!(
        outcome.stdout.contains("restitution") && outcome.stdout.contains("The data do not tell"),
        "{}",
        outcome.stdout
    );
    let text = fs::read_to_string(&copy).unwrap();
    let (_, text) = text.split_once('\n').expect("the line with the version");
    let changed: Vec<_> =
        text.lines().zip(PRODUCT.lines()).filter(|(new, old)| new != old).map(|(new, _)| new).collect();
    let [restitution, tilt] = changed[..] else { panic!("{text}") };
    assert!(
        restitution.starts_with("restitution = [0.29") && restitution.ends_with("] # not known yet"),
        "{restitution}"
    );
    assert!(tilt.starts_with("tilt = ") && tilt.contains("deg"), "{tilt}");
    assert_eq!(text.lines().count(), PRODUCT.lines().count());
    let picture = fs::read_to_string(&picture).unwrap();
    assert!(picture.starts_with("<svg") && picture.contains("measured") && picture.contains("computed"), "{picture}");
    // Its own product file is not written over.
    let same = clatter(["fit", &strikes, &flag, &format!("-o{product}")]);
    assert_eq!(same.exit, Exit::BadInput);
    assert!(same.stderr.contains("would be lost"), "{}", same.stderr);
    assert_eq!(fs::read_to_string(&product).unwrap(), PRODUCT);
}

#[test]
fn bounces_give_the_restitution() {
    let dir = tempfile::tempdir().unwrap();
    let product = write(dir.path(), "bar.toml", &PRODUCT.replace("gravity = \"0 gn\"\n", ""));
    // Flights of 0.4, 0.24, 0.144 s.
    let bounces = write(dir.path(), "bounces.csv", "bounce_s\n2.0\n2.4\n2.64\n2.784\n");
    let flag = format!("--product={product}");
    let found = answer(["fit", &bounces, &flag, "--timing=0.1ms"]);
    let e = estimate(&found, "restitution")["value"].as_f64().unwrap();
    assert!((e - 0.6).abs() < 1e-9, "{e}");
    // 2 e v/g = 0.4 s: v = 3.2689 m/s.
    let height = estimate(&found, "drop-height")["value"].as_f64().unwrap();
    assert!((height - 3.268_883_f64.powi(2) / (2.0 * 9.80665)).abs() < 1e-5, "{height}");
    // The same by the times between them, in another notation.
    let intervals = write(dir.path(), "intervals.csv", "interval [ms];note\n400,0;first\n240,0;\n144,0;\n");
    let same = answer(["fit", &intervals, &flag, "--timing=0.1ms"]);
    let other = estimate(&same, "restitution")["value"].as_f64().unwrap();
    assert!((other - e).abs() < 1e-9, "{other}");
    let none = clatter(["fit", &write(dir.path(), "none.csv", "interval_s\n0.4\n0\n0.1\n"), &flag]);
    assert!(none.stderr.contains("line 3: interval_s = 0.0 is not > 0"), "{}", none.stderr);
    let beside = clatter(["fit", &bounces, &write(dir.path(), "strikes.csv", STRIKES), &flag]);
    assert!(beside.stderr.contains("fit it alone"), "{}", beside.stderr);
}

/// Rows of a file by their columns.
fn columns(csv: &str, names: &[&str]) -> Vec<Vec<f64>> {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let places: Vec<usize> = names.iter().map(|name| header.iter().position(|h| h == name).unwrap()).collect();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        places.iter().map(|place| cells[*place].parse().unwrap()).collect()
    };
    lines.map(row).collect()
}

/// The way of heights through the command: what `simulate` says of a drop comes back.
#[test]
fn heights_come_back() {
    let dir = tempfile::tempdir().unwrap();
    let rows = dir.path().join("rows.csv").display().to_string();
    let flags = ["--model=finite-tilt", "--length=200mm", "--gyration=60mm", "--e=0.4", "--speed=3m/s", "--tilt=3deg"];
    let simulated = clatter(["simulate", "--until=60ms", "-o", &rows].iter().chain(&flags));
    assert_eq!(simulated.exit, Exit::Done, "{}", simulated.stderr);
    let rows = columns(&fs::read_to_string(&rows).unwrap(), &["time_s", "height_a_m", "height_b_m"]);
    let product = PRODUCT.replace("gravity = \"0 gn\"\n", "").replace("\"0.1 m/s\"", "[\"2.5 m/s\", \"3.4 m/s\"]");
    let product = product.replace("\"1 deg\"", "\"10 deg\"");
    let product = write(dir.path(), "bar.toml", &product);
    // As `simulate` writes it, and as a tracker does.
    for (heading, by, separator) in [("time_s,height_a_m,height_b_m", 1.0, ','), ("t [s];y a [mm];y b [mm]", 1e3, ';')]
    {
        let mut csv = format!("{heading}\n");
        for row in &rows {
            writeln!(csv, "{}{separator}{}{separator}{}", 5.0 + row[0], by * row[1], by * row[2]).unwrap();
        }
        let found = answer(["fit", &write(dir.path(), "video.csv", &csv), &format!("--product={product}")]);
        for (name, truth) in [("radius-of-gyration", 0.06), ("speed", 3.0), ("tilt", 3f64.to_radians())] {
            let value = estimate(&found, name)["value"].as_f64().unwrap();
            assert!((value / truth - 1.0).abs() < 1e-3, "{heading}: {name}: {value}, not {truth}");
        }
    }
}

#[test]
fn bad_records_are_told_by_line() {
    let dir = tempfile::tempdir().unwrap();
    let product = format!("--product={}", write(dir.path(), "bar.toml", PRODUCT));
    for (text, said) in [
        ("time_s,end\n0,a\n1,c\n", "line 3: end 'c' is not a, b or empty"),
        ("time_s,end\n0,a\n1e-3,b\n5e-4,a\n", "line 4: time_s 0.0005 is before 0.001, the row above; sort by time"),
        ("time_s,end\n0,a\nsoon,b\n", "line 3: time_s: 'soon' is not a number"),
        ("time_s,end\n0,a\n", "1 strikes; allowed: 2 to 4096"),
        ("time_s,end\n", "no rows"),
        ("time_s,height_a_m,height_b_m\n0,1,inf\n", "line 2: height_b_m: 'inf' is not a number such as 0.5"),
        ("bounce_s\n1\n", "1 bounces; allowed: 3 to 4096"),
        ("time [s],acceleration [g]\n0,0\n1,0\n", "an acceleration needs --position"),
        ("", "an acceleration needs --position"),
    ] {
        let file = write(dir.path(), "record.csv", text);
        let outcome = clatter(["fit", &file, &product]);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{text:?}");
        assert!(outcome.stderr.contains(said) && outcome.stderr.lines().count() == 1, "{}, not {said}", outcome.stderr);
        assert!(outcome.stderr.contains("record.csv"), "{}", outcome.stderr);
    }
    // No drop strikes so: nothing is told of the product, and nothing written.
    let far = write(dir.path(), "far.csv", "time_s,end\n0,a\n0.00082,b\n0.00241,a\n0.00570,b\n0.0058,a\n0.0061,a\n");
    let copy = dir.path().join("fitted.toml");
    let outcome = clatter(["fit", &far, &product, "-o", copy.to_str().unwrap()]);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("far.csv: no drop was found that comes near: strikes"), "{}", outcome.stderr);
    assert!(!copy.exists(), "nothing is written");
    let uneven = write(dir.path(), "uneven.csv", "time [s],acceleration [g]\n0,0\n1,1\n2,0\n7,0\n");
    let outcome = clatter(["fit", &uneven, &product, "--position=0mm"]);
    assert!(outcome.stderr.contains("a fit needs samples that are even in time"), "{}", outcome.stderr);
    for (flags, said) in [
        (&["--position=3m"][..], "beyond the ends"),
        (&["-o", "fit.pdf"], "must end in .toml or .svg"),
        (&["-o", "-"], "no ending that says what to write"),
        (&["--timing=0s"], "--timing"),
    ] {
        let outcome = clatter(["fit", &uneven, &product].iter().copied().chain(flags.iter().copied()));
        assert_eq!(outcome.exit, Exit::BadInput, "{flags:?}");
        assert!(outcome.stderr.contains(said), "{}, not {said}", outcome.stderr);
    }
}

/// The first two examples of the help, with files of these names.
#[test]
fn the_examples_of_the_help_run() {
    let help = clatter(["fit", "--help"]).stdout;
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "strikes.csv", STRIKES);
    write(dir.path(), "bar.toml", PRODUCT);
    let examples: Vec<&str> = help.lines().filter(|line| line.trim().starts_with("clatter fit strikes.csv")).collect();
    assert_eq!(examples.len(), 2, "{help}");
    for example in examples {
        let place = |name: &str| dir.path().join(name).display().to_string();
        let argument = |word: &str| match word.strip_prefix("--product=") {
            Some(name) => format!("--product={}", place(name)),
            None if word.contains('.') => place(word),
            None => word.to_owned(),
        };
        let outcome = clatter(example.split_whitespace().skip(1).map(argument));
        assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{example}: {}", outcome.stdout);
    }
}

/// A product file with a record of its drop.
/// A range of the radius of gyration stands beside what was measured, is written as one, and is not known.
#[test]
fn a_range_of_the_radius_of_gyration_is_a_range() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "strikes.csv", STRIKES);
    let record = "\n[[record]]\nfile = \"strikes.csv\"\ntiming = \"1 us\"\n";
    // The true one is 57.735 mm; the middle of the ranges is not.
    for (range, agrees) in [(r#"["50 mm", "75 mm"]"#, true), (r#"["62 mm", "75 mm"]"#, false)] {
        let product = write(dir.path(), "bar.toml", &(PRODUCT.replace("\"57.735 mm\"", range) + record));
        let assessment: Value = serde_json::from_str(&clatter(["assess", &product, "--format=json"]).stdout).unwrap();
        let drop = &assessment["measured"][0];
        let radius = estimate(drop, "radius-of-gyration");
        assert!((radius["value"].as_f64().unwrap() - 0.057_735).abs() < 1e-4, "{radius}");
        assert_eq!((&radius["agrees"], &radius["stated"][1]), (&agrees.into(), &0.075.into()));
    }
    let product = write(dir.path(), "wide.toml", &PRODUCT.replace("\"57.735 mm\"", r#"["50 mm", "75 mm"]"#));
    let strikes = dir.path().join("strikes.csv");
    let (strikes, flag) = (strikes.to_str().unwrap(), format!("--product={product}"));
    let copy = dir.path().join("copy.toml");
    let outcome = clatter(["fit", strikes, &flag, "--timing=1us", &format!("-o{}", copy.display())]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    let text = fs::read_to_string(&copy).unwrap();
    assert!(text.contains("radius_of_gyration = [\"57."), "{text}");
    let known = clatter(["fit", strikes, &flag, "--known-gyration"]);
    assert_eq!(known.exit, Exit::BadInput);
    assert!(known.stderr.contains("it gives a range, 50 to 75 mm"), "{}", known.stderr);
}

fn with_record(restitution: &str, record: &str) -> String {
    PRODUCT.replace("[0.1, 0.9]", restitution) + "\n[[record]]\n" + record
}

#[test]
fn records_of_a_product_file_stand_beside_its_verdict() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "strikes.csv", STRIKES);
    let record = "file = \"strikes.csv\"\ntiming = \"1 us\"\n";
    let agrees = write(dir.path(), "agrees.toml", &with_record("[0.1, 0.9]", record));
    let other = write(dir.path(), "other.toml", &with_record("[0.5, 0.9]", record));
    for (product, expected) in [(&agrees, true), (&other, false)] {
        let outcome = clatter(["assess", product, "--format=json"]);
        let assessment: Value = serde_json::from_str(&outcome.stdout).unwrap();
        let drop = &assessment["measured"][0];
        assert_eq!((&drop["drop"], &drop["files"][0]), (&"strikes.csv".into(), &"strikes.csv".into()));
        let e = estimate(drop, "restitution");
        assert!((e["value"].as_f64().unwrap() - 0.3).abs() < 0.01, "{e}");
        assert_eq!((&e["agrees"], &e["stated"][1]), (&expected.into(), &0.9.into()));
        let warned =
            outcome.stderr.contains("restitution was measured as 0.3") && outcome.stderr.contains("0.5000 to 0.9000");
        assert_eq!(warned, !expected, "{}", outcome.stderr);
        let table = clatter(["assess", product]).stdout;
        let word = if expected { "agrees" } else { "differs" };
        assert!(table.lines().any(|line| line.starts_with("restitution ") && line.ends_with(word)), "{table}");
    }
    let both = clatter(["assess", &agrees, &other, "--format=json"]).stdout;
    let both: Value = serde_json::from_str(&both).unwrap();
    assert!((0..2).all(|i| both[i]["measured"][0]["model"] == "finite-tilt"), "{both}");
    // Without records nothing is said of them.
    let none = write(dir.path(), "none.toml", PRODUCT);
    assert!(!clatter(["assess", &none, "--format=json"]).stdout.contains("measured"));
}

#[test]
fn records_of_a_product_file_are_of_one_drop_by_its_name() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "strikes.csv", STRIKES);
    let record = |drop: &str| format!("file = \"strikes.csv\"\n{drop}timing = \"1 us\"\n");
    for (name, drops) in [("", 2), ("drop = \"3\"\n", 1)] {
        let text = with_record("[0.1, 0.9]", &record(name)) + "[[record]]\n" + &record(name);
        let product = write(dir.path(), "bar.toml", &text);
        let assessment: Value = serde_json::from_str(&clatter(["assess", &product, "--format=json"]).stdout).unwrap();
        assert_eq!(assessment["measured"].as_array().unwrap().len(), drops);
    }
}

#[test]
fn a_record_that_cannot_be_read_is_an_error_and_a_drop_that_nothing_explains_a_warning() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "a.csv", "time [ms],a [g]\n0,0\n0.1,50\n0.2,0\n");
    // Times that speed up and slow down are those of no drop.
    write(dir.path(), "wild.csv", "time_s,end\n0,a\n0.1,a\n0.11,a\n0.9,b\n0.91,a\n7,b\n7.1,b\n7.2,b\n7.3,b\n");
    for (record, exit, said) in [
        ("file = \"none.csv\"\n", Exit::BadInput, "none.csv"),
        ("file = \"a.csv\"\n", Exit::BadInput, "an acceleration needs --position (of [[record]], position)"),
        ("file = \"a.csv\"\nposition = \"0.2 m\"\n", Exit::BadInput, "allowed: up to 100 mm"),
        ("file = \"a.csv\"\nposition = \"0 mm\"\nunits = \"ms,m/s2\"\n", Exit::BadInput, "is in g by its heading"),
        ("file = \"a.csv\"\nplace = \"0 mm\"\n", Exit::BadInput, "[[record]] 1 has no key `place`"),
        ("file = \"wild.csv\"\n", Exit::Done, "warning: wild.csv: "),
    ] {
        let product = write(dir.path(), "bar.toml", &with_record("[0.1, 0.9]", record));
        let outcome = clatter(["assess", &product]);
        assert!(outcome.stderr.contains(said), "{record}: {}", outcome.stderr);
        assert_eq!(outcome.exit, exit, "{record}: {}", outcome.stderr);
    }
}
