//! `clatter study`: shards as files, what is left as it is, and what is refused before anything is lost.

use std::fs;

use clatter_cli::Exit;
use serde_json::Value;

use crate::{Outcome, clatter};

const BAR: &str = r#"
[product]
name = "Bar"
length = "140 mm"
radius_of_gyration = "40 mm"
restitution = { uniform = [0.2, 0.4] }
[drop]
height = "1 m"
tilt = { triangular = ["0.5 deg", "2 deg", "10 deg"] }
[[component]]
name = "sensor"
position = "60 mm"
mount = "hard"
velocity_change_limit = "7.5 m/s"
"#;
const PLAN: &str = "product = \"bar.toml\"\nsamples = 2000\nseed = 7\n";

/// A folder with the product and a plan.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(plan: &str) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.at("bar.toml"), BAR).unwrap();
        fs::write(folder.at("plan.toml"), plan).unwrap();
        folder
    }
    fn at(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }
    /// Makes a part of its plan.
    fn part(&self, shard: &str, name: &str) -> Outcome {
        clatter(["study", &self.at("plan.toml"), &format!("--shard={shard}"), "-o", &self.at(name)])
    }
    fn parts(&self, of: usize) -> Vec<String> {
        let part = |i: usize| {
            let name = format!("{i}of{of}.parquet");
            let outcome = self.part(&format!("{i}/{of}"), &name);
            assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
            self.at(&name)
        };
        (1..=of).map(part).collect()
    }
}

fn merge(parts: &[String], flags: &[&str]) -> Outcome {
    let flags = flags.iter().map(|flag| (*flag).to_owned());
    clatter(["study", "merge"].map(str::to_owned).into_iter().chain(parts.iter().cloned()).chain(flags))
}

/// Exit 2, nothing on stdout, and one message, with these words.
fn refused(outcome: &Outcome, words: &[&str]) {
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.matches("error: ").count(), 1, "{}", outcome.stderr);
    assert!(words.iter().all(|word| outcome.stderr.contains(word)), "{words:?}: {}", outcome.stderr);
}

#[test]
fn any_number_of_parts_in_any_order_has_one_answer() {
    let folder = Folder::new(PLAN);
    let whole = merge(&folder.parts(1), &["--format=json"]);
    assert_eq!((whole.exit, whole.stderr.as_str()), (Exit::Done, ""));
    for of in [3, 7] {
        let mut parts = folder.parts(of);
        parts.reverse();
        parts.swap(0, 1);
        assert_eq!(merge(&parts, &["--format=json"]).stdout, whole.stdout, "{of} parts");
    }
    // One product is shown as by `scatter`, which answers so few drops by the full model alone.
    let scatter =
        |format: &str| clatter(["scatter", &folder.at("bar.toml"), "--samples=2000", "--seed=7", format]).stdout;
    for format in ["--format=table", "--format=csv"] {
        assert_eq!(merge(&folder.parts(2), &[format]).stdout, scatter(format));
    }
    let found: Value = serde_json::from_str(&whole.stdout).unwrap();
    let of_scatter: Value = serde_json::from_str(&scatter("--format=json")).unwrap();
    assert_eq!(found["members"][0]["components"], of_scatter["components"]);
    // The target is that of `scatter` too: here two in five fail.
    assert_eq!(merge(&folder.parts(2), &["--target=50%"]).exit, Exit::Done);
    let missed = merge(&folder.parts(2), &["--target=99.9%"]);
    assert_eq!(missed.exit, Exit::Unsafe);
    assert!(missed.stdout.contains("Target of 99.9 % MISSED"), "{}", missed.stdout);
}

#[test]
fn a_part_that_is_there_is_left_as_it_is() {
    let folder = Folder::new(PLAN);
    let path = folder.at("a.parquet");
    let json = |flags: &[&str]| {
        let base = ["study", &folder.at("plan.toml"), "--shard=2/3", "-o", &path, "--format=json"].map(str::to_owned);
        let outcome = clatter(base.into_iter().chain(flags.iter().map(|flag| (*flag).to_owned())));
        (outcome.exit == Exit::Done).then(|| serde_json::from_str::<Value>(&outcome.stdout).unwrap()).ok_or(outcome)
    };
    let made = json(&[]).ok().unwrap();
    assert_eq!(
        (&made["rows"], &made["of"], &made["skipped"]),
        (&serde_json::json!([666, 1333]), &2000.into(), &false.into())
    );
    let bytes = fs::read(&path).unwrap();
    let written = fs::metadata(&path).unwrap().modified().unwrap();
    assert_eq!(json(&[]).ok().unwrap()["skipped"], true);
    assert_eq!(fs::metadata(&path).unwrap().modified().unwrap(), written);
    let table = folder.part("2/3", "a.parquet").stdout;
    assert!(
        table.contains("a.parquet is there already, with rows 666 to 1332 of 2000, shard 2/3; --force makes it"),
        "{table}"
    );
    // Made again it is the same, to the last byte.
    assert_eq!(json(&["--force"]).ok().unwrap()["skipped"], false);
    assert!(fs::read(&path).unwrap() == bytes && fs::metadata(&path).unwrap().modified().unwrap() > written);
    // Another shard, another plan, or what is no part is not written over.
    refused(&folder.part("1/3", "a.parquet"), &["a.parquet is there already, and is not this shard", "--force"]);
    fs::write(folder.at("plan.toml"), PLAN.replace('7', "8")).unwrap();
    refused(&folder.part("2/3", "a.parquet"), &["is not this shard"]);
    assert!(fs::read(&path).unwrap() == bytes);
    for (name, torn) in [("text.parquet", &b"time_s\n0\n"[..]), ("torn.parquet", &bytes[..bytes.len() / 2])] {
        fs::write(folder.at(name), torn).unwrap();
        refused(&folder.part("2/3", name), &[name, "no part that can be read", "--force"]);
        assert_eq!(fs::read(folder.at(name)).unwrap(), torn);
    }
}

#[test]
fn what_is_no_whole_study_is_refused_with_its_file() {
    let folder = Folder::new(PLAN);
    let parts = folder.parts(3);
    let bytes = fs::read(&parts[1]).unwrap();
    let changed = |name: &str, bytes: &[u8]| {
        fs::write(folder.at(name), bytes).unwrap();
        merge(&[parts[0].clone(), folder.at(name), parts[2].clone()], &[])
    };
    let at = |text: &[u8]| bytes.windows(text.len()).position(|found| found == text).unwrap();
    refused(
        &merge(&[parts[0].clone(), parts[2].clone()], &[]),
        &["no part has rows 666 to 1332 of 2000: make shard 2/3"],
    );
    refused(&merge(&[&parts[..], &parts[..1]].concat(), &[]), &["1of3.parquet is there twice"]);
    refused(
        &changed("cut.parquet", &bytes[..bytes.len() - 100]),
        &["cut.parquet: Parquet file", "cut short or damaged"],
    );
    refused(&changed("empty.parquet", b""), &["empty.parquet: Parquet file", "cut short"]);
    // A number that is not as it was written.
    let mut torn = bytes.clone();
    torn[4000] ^= 1;
    refused(&changed("torn.parquet", &torn), &["torn.parquet: Parquet file: column", "not as it was written"]);
    let mut old = bytes.clone();
    old[at(b"0.1.0")..][..5].copy_from_slice(b"0.0.9");
    refused(&changed("old.parquet", &old), &["old.parquet is of clatter 0.0.9, and this is clatter 0.1.0"]);
    refused(&merge(&[folder.at("nowhere.parquet")], &[]), &["cannot read", "nowhere.parquet"]);
    fs::write(folder.at("plan.toml"), PLAN.replace('7', "8")).unwrap();
    assert_eq!(folder.part("2/3", "other.parquet").exit, Exit::Done);
    let mixed = merge(&[parts[0].clone(), folder.at("other.parquet"), parts[2].clone()], &[]);
    refused(
        &mixed,
        &["other.parquet is of another study than", "1of3.parquet", "`seed = 8` where that has `seed = 7`"],
    );
    // Nothing was lost by all that; a folder stands for the parts in it.
    assert_eq!(merge(&parts, &[]).exit, Exit::Done);
    refused(&merge(&[folder.at("")], &[]), &["cut.parquet: Parquet file"]);
    fs::create_dir(folder.at("all")).unwrap();
    for (i, part) in parts.iter().enumerate() {
        fs::copy(part, folder.at(&format!("all/{i}.parquet"))).unwrap();
    }
    assert_eq!(merge(&[folder.at("all")], &[]).stdout, merge(&parts, &[]).stdout);
    fs::create_dir(folder.at("none")).unwrap();
    refused(&merge(&[folder.at("none")], &[]), &["no file in", "ends in .parquet"]);
}

#[test]
fn products_of_a_grid_stand_side_by_side() {
    let grid =
        "[grid]\nproduct.restitution = [0.2, [0.3, 0.5]]\ncomponent.sensor.velocity_change_limit = \"7 m/s:8 m/s:3\"\n";
    let folder = Folder::new(&format!("{}{grid}", PLAN.replace("2000", "300")));
    let parts = folder.parts(4);
    let csv = merge(&parts, &["--format=csv"]).stdout;
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        rows[0][..5],
        ["member", "product.restitution", "component.sensor.velocity_change_limit", "name", "samples"]
    );
    assert_eq!(rows.len(), 1 + 6);
    // The range has a comma, and stands in quotes.
    assert_eq!(rows[2][..4], ["1", "0.2", "7.5 m/s", "sensor"]);
    assert!(csv.contains("\n5,\"[0.3, 0.5]\",8 m/s,sensor,300,"), "{csv}");
    // The same drops of each: what they ask, by hand from the utilization, does not hang on what is allowed.
    let found: Value = serde_json::from_str(&merge(&parts, &["--format=json"]).stdout).unwrap();
    let part = |i: usize| &found["members"][i]["components"][0];
    let asked = |i: usize, limit: f64| part(i)["utilization"]["mean"].as_f64().unwrap() * limit;
    // Means of 300 sums of roundings.
    assert!((asked(0, 7.0) - asked(2, 8.0)).abs() < 1e-12 * asked(0, 7.0), "{csv}");
    assert!(part(0)["failed"].as_u64().unwrap() > part(2)["failed"].as_u64().unwrap(), "{csv}");
    assert_eq!(found["grid"], serde_json::json!(["product.restitution", "component.sensor.velocity_change_limit"]));
    let table = merge(&parts, &["--target=99%"]);
    assert_eq!(table.exit, Exit::Unsafe);
    assert!(table.stdout.starts_with("Bar: 6 products, of each 300 drops drawn with seed 7\n"), "{}", table.stdout);
    assert!(table.stdout.contains("MISSED by 6\n"), "{}", table.stdout);
}

#[test]
fn a_search_judges_each_product() {
    let limits = "[grid]\ncomponent.sensor.velocity_change_limit = [\"5 m/s\", \"50 m/s\"]\n";
    let folder = Folder::new(&format!("product = \"bar.toml\"\nsearch = true\n{limits}"));
    let parts = folder.parts(2);
    let found = merge(&parts, &["--format=json"]);
    assert_eq!(found.exit, Exit::Unsafe);
    let found: Value = serde_json::from_str(&found.stdout).unwrap();
    assert_eq!([0, 1].map(|i| found["members"][i]["verdict"].as_str().unwrap()), ["unsafe", "safe"]);
    let table = merge(&parts, &[]).stdout;
    assert!(table.contains("\n5 m/s ") && table.contains("UNSAFE"), "{table}");
    let csv = merge(&parts, &["--format=csv"]).stdout;
    assert!(csv.contains("\n1,50 m/s,sensor,velocity-change,m/s,50.0,") && csv.ends_with(",safe\n"), "{csv}");
    refused(&merge(&parts, &["--target=99%"]), &["--target", "search"]);
    refused(&folder.part("1/3", "x.parquet"), &["shard 1/3 is none", "2 rows"]);
}

#[test]
fn plans_and_arguments_that_are_wrong_are_told() {
    let folder = Folder::new(PLAN);
    for (shard, told) in
        [("0/3", "from 1/N to N/N"), ("4/3", "from 1/N to N/N"), ("1", "I/N"), ("-1/3", "I/N"), ("1/2001", "2000 rows")]
    {
        refused(&folder.part(shard, "x.parquet"), &[told]);
    }
    refused(&folder.part("1/3", "x.csv"), &["x.csv", "must end in .parquet"]);
    let plain = |arguments: &[&str]| clatter(["study"].iter().chain(arguments));
    refused(&plain(&[]), &["<PLAN.toml>", "--output <FILE>"]);
    refused(&plain(&["merge"]), &["<PART.parquet>"]);
    refused(&plain(&["nowhere.toml", "-o", "x.parquet"]), &["cannot read nowhere.toml"]);
    for (plan, told) in [
        ("product = \"bar.toml\"\nsample = 5\n".to_owned(), vec!["plan.toml:2:1", "did you mean `samples`?"]),
        ("product = \"no.toml\"\nsamples = 5\n".to_owned(), vec!["cannot read", "no.toml"]),
        (format!("{PLAN}[grid]\nproduct.restitution = [0.2, 2]\n"), vec!["bar.toml with product.restitution = 2"]),
    ] {
        fs::write(folder.at("plan.toml"), plan).unwrap();
        let outcome = folder.part("1/1", "x.parquet");
        assert_eq!(outcome.exit, Exit::BadInput);
        assert!(told.iter().all(|told| outcome.stderr.contains(told)), "{}", outcome.stderr);
        assert!(!std::path::Path::new(&folder.at("x.parquet")).exists());
    }
    // A product that the part would be written over is seen through the plan.
    fs::rename(folder.at("bar.toml"), folder.at("bar.parquet")).unwrap();
    fs::write(folder.at("plan.toml"), PLAN.replace("bar.toml", "bar.parquet")).unwrap();
    refused(&folder.part("1/1", "bar.parquet"), &["bar.parquet is read by this command and would be lost"]);
}

/// A sample of a box goes through all of its drops: a row tells what each part is asked in all of them and in each, and any number of
/// parts gives the answer of `scatter`. Boxes of a grid go through the same drops.
#[test]
fn a_box_is_studied_through_all_of_its_drops() {
    let folder = Folder::new("product = \"bar.toml\"\nsamples = 150\nseed = 7\n");
    let thick = BAR
        .replace(
            "\"140 mm\"",
            "\"140 mm\"\nmass = \"190 g\"\nwidth = \"70 mm\"\nthickness = \"12 mm\"\ncontact_time = \"0.4 ms\"",
        )
        .replace("\"40 mm\"", "[\"40 mm\", \"20 mm\"]")
        .replace("tilt = { triangular = [\"0.5 deg\", \"2 deg\", \"10 deg\"] }", "face = [\"bottom\", \"end-a\"]")
        .replace("\"60 mm\"", "[\"60 mm\", \"0 mm\"]")
        .replace("velocity_change", "acceleration")
        .replace("\"7.5 m/s\"", "\"900 gn\"");
    fs::write(folder.at("bar.toml"), &thick).unwrap();
    let [whole, cut] = [1, 3].map(|of| merge(&folder.parts(of), &["--format=json"]));
    assert_eq!((whole.exit, whole.stderr.as_str()), (Exit::Done, ""));
    assert_eq!(whole.stdout, cut.stdout);
    let scatter = clatter(["scatter", &folder.at("bar.toml"), "--samples=150", "--seed=7", "--format=json"]);
    let of_scatter: Value = serde_json::from_str(&scatter.stdout).unwrap();
    let found: Value = serde_json::from_str(&whole.stdout).unwrap();
    for of in ["components", "landings", "survival"] {
        assert_eq!(found["members"][0][of], of_scatter[of], "{of}");
    }
    assert_eq!(found["members"][0]["landings"].as_array().unwrap().len(), 2);
    // Heavier ones are dropped otherwise.
    let listed =
        thick.replace("height = \"1 m\"\nface = [\"bottom\", \"end-a\"]", "standard = \"MIL-STD-810H/516.8-IV\"");
    fs::write(folder.at("bar.toml"), listed).unwrap();
    let plan = "product = \"bar.toml\"\nsamples = 5\n[grid]\nproduct.mass = [\"190 g\", \"60 kg\"]\n";
    fs::write(folder.at("plan.toml"), plan).unwrap();
    let other = "product 2 of the grid goes through other drops than the first";
    refused(&folder.part("1/1", "part.parquet"), &[other]);
}
