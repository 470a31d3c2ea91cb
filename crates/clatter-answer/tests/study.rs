//! What a study tells does not hang on how it is cut, and is what its drops say one by one.

use clatter_answer::study::{Answer, Error, Merge, Parts, Shard, Study};
use clatter_answer::{assess, scatter};
use clatter_assess::{Accuracy, scatter::Settings};
use clatter_product::{Plan, ProductFile};
use serde_json::Value;

/// A bar.
const EXAMPLE: &str = include_str!("../../../tests/cases/bar-handheld.toml");

fn study(plan: &str) -> Study {
    let plan = Plan::read(&format!("product = \"p.toml\"\n{plan}"), "plan.toml").expect("a plan");
    Study::new(plan, EXAMPLE, "p.toml").expect("a study")
}

/// Rows of a shard, column by column, in groups.
fn groups(study: &Study, shard: Shard) -> Vec<Vec<Vec<f64>>> {
    let mut groups = Vec::new();
    let rows = study.rows_of(shard).expect("a shard");
    let keep = |group: &[&[f64]]| {
        groups.push(group.iter().map(|column| column.to_vec()).collect());
        Ok(())
    };
    study.write(rows, &|_| (), keep).expect("rows");
    groups
}

fn take(merge: &mut Merge<'_>, study: &Study, group: &[Vec<f64>]) -> Result<(), Error> {
    merge.take(&study.counted().into_iter().map(|i| &group[i][..]).collect::<Vec<_>>())
}

fn answer(study: &Study, of: u64) -> Answer<'_> {
    let mut merge = Merge::new(study, 0.95).expect("a confidence");
    for index in 1..=of {
        for group in groups(study, Shard { index, of }) {
            take(&mut merge, study, &group).expect("the next rows");
        }
    }
    merge.finish().expect("all rows")
}

fn json(answer: &Answer<'_>) -> String {
    serde_json::to_string(answer).expect("JSON")
}

#[test]
fn any_number_of_shards_gives_the_same_answer_to_the_last_byte() {
    for (plan, shards) in [
        ("samples = 1500", vec![2, 3, 7, 64, 1500]),
        (
            "samples = 200\n[grid]\nproduct.restitution = [0.2, [0.3, 0.5]]\ndrop.tilt = \"1 deg:8 deg:3\"",
            vec![2, 7, 64],
        ),
        ("search = true\n[grid]\nproduct.restitution = [0.2, 0.5]", vec![2]),
    ] {
        let study = study(plan);
        let whole = json(&answer(&study, 1));
        for of in shards {
            assert!(json(&answer(&study, of)) == whole, "{of} shards of {plan}");
        }
    }
}

/// The same drops, counts, intervals, sums and drivers as of the command that draws them itself.
#[test]
fn each_product_is_answered_as_by_scatter() {
    let study = study("samples = 1500\nseed = 7\n[grid]\nproduct.restitution = [0.2, [0.3, 0.5]]");
    let found: Value = serde_json::to_value(answer(&study, 3)).expect("JSON");
    for (i, restitution) in ["0.2", "[0.3, 0.5]"].into_iter().enumerate() {
        let file = study.family().member(i as u64).expect("a product");
        let settings = Settings { samples: 1500, seed: 7, confidence: 0.95, merge_s: Accuracy::default().merge_s };
        let of_one = serde_json::to_value(scatter::answer(&file, settings).expect("an answer")).expect("JSON");
        let mut member = found["members"][i].clone();
        assert_eq!(
            member.as_object_mut().and_then(|member| member.remove("values")),
            Some(serde_json::json!([restitution]))
        );
        assert_eq!(member, of_one, "{restitution}");
    }
    assert_ne!(found["members"][0]["components"], found["members"][1]["components"]);
}

#[test]
fn each_product_of_a_search_is_answered_as_by_assess() {
    let study = study("search = true\n[grid]\nproduct.restitution = [0.2, [0.3, 0.5]]");
    let found: Value = serde_json::to_value(answer(&study, 2)).expect("JSON");
    for i in 0..2 {
        let file: ProductFile = study.family().member(i).expect("a product");
        let of_one =
            serde_json::to_value(assess::answer(&file, &Accuracy::default()).expect("an answer")).expect("JSON");
        let member = &found["members"][usize::try_from(i).expect("an index")];
        assert_eq!(member["verdict"], of_one["verdict"]);
        let components = of_one["components"].as_array().expect("parts");
        let limits = components.iter().flat_map(|component| {
            component["limits"].as_array().expect("limits").iter().map(|limit| (&component["name"], limit))
        });
        for ((name, limit), told) in limits.zip(member["limits"].as_array().expect("limits")) {
            let keys = ["limit", "margin", "verdict", "unit", "allowed", "demand", "bound"];
            let keys = if limit["limit"] == "damage-boundary" { &keys[..3] } else { &keys[..] };
            assert_eq!(&told["component"], name);
            assert!(keys.iter().all(|key| told[*key] == limit[*key]), "{told} is not {limit}");
        }
    }
}

/// What is not answered counts as a failure but for the upper end, what is open for the lower end alone; why is found again.
#[test]
fn rows_without_an_answer_and_open_ones_widen_the_interval() {
    let study = study("samples = 500");
    let mut rows = groups(&study, Shard { index: 1, of: 1 }).remove(0);
    let at = |what: &str| study.fields().iter().position(|field| field.name == what).expect("a column");
    let (used, open) = (at("utilization of display"), at("open of display"));
    let count = |change: &dyn Fn(&mut [Vec<f64>]), rows: &mut Vec<Vec<f64>>| {
        let mut merge = Merge::new(&study, 0.95).expect("a confidence");
        change(rows);
        take(&mut merge, &study, rows).expect("rows");
        serde_json::to_value(merge.finish().expect("all rows")).expect("JSON")["members"][0].clone()
    };
    let none = count(&|_| (), &mut rows);
    let opened = count(&|rows| rows[open][3] = 1.0, &mut rows);
    let lost = count(&|rows| rows[used][5] = f64::NAN, &mut rows);
    let display = |found: &Value, key: &str| found["components"][0][key].as_u64().expect("a count");
    assert_eq!(
        [&none, &opened, &lost].map(|found| [display(found, "open"), display(found, "unanswered")]),
        [[0, 0], [1, 0], [1, 1]]
    );
    let end = |found: &Value, i: usize| found["survival"]["interval"][i].as_f64().expect("a bound");
    assert!(end(&none, 0) > end(&opened, 0) && end(&opened, 0) > end(&lost, 0), "{none}\n{opened}\n{lost}");
    assert!([&none, &opened, &lost].iter().all(|found| found["survival"]["interval"][1] == 1.0), "{lost}");
    assert_eq!(lost["unanswered"], 1);
}

#[test]
fn rows_come_in_their_order_and_all_of_them() {
    let study = study("samples = 10");
    let [first, second] = [1, 2].map(|index| groups(&study, Shard { index, of: 2 }).remove(0));
    let merge = |groups: &[&Vec<Vec<f64>>]| {
        let mut merge = Merge::new(&study, 0.95).expect("a confidence");
        groups.iter().try_for_each(|group| take(&mut merge, &study, group))?;
        merge.finish().map(drop)
    };
    let told = |groups: &[&Vec<Vec<f64>>]| merge(groups).map_or_else(|error| error.to_string(), |()| String::new());
    assert_eq!(told(&[&first, &second]), "");
    assert_eq!(told(&[&second]), "row 0 is not where it should be");
    assert_eq!(told(&[&first, &first]), "row 5 is not where it should be");
    assert_eq!(told(&[&first]), "5 rows of 10 are there");
    assert_eq!(told(&[&first, &second, &second]), "row 10 is not where it should be");
}

#[test]
fn shards_are_all_rows_each_once_of_about_one_size() {
    let study = study("samples = 1000");
    for of in [1, 3, 7, 999, 1000] {
        let rows: Vec<_> = (1..=of).map(|index| study.rows_of(Shard { index, of }).expect("a shard")).collect();
        assert!(rows[0].start == 0 && rows.windows(2).all(|pair| pair[0].end == pair[1].start), "{of}");
        let sizes: Vec<_> = rows.iter().map(|rows| rows.end - rows.start).collect();
        assert!(
            rows.last().is_some_and(|rows| rows.end == 1000)
                && sizes.iter().max() <= sizes.iter().min().map(|s| s + 1).as_ref()
        );
    }
    for (index, of) in [(0, 3), (4, 3), (1, 0), (1, 1001)] {
        let message = study.rows_of(Shard { index, of }).expect_err("no shard").to_string();
        assert!(message.contains(&format!("shard {index}/{of} is none")), "{message}");
    }
}

/// Files that are not all shards of one plan, each once: which, and why.
#[test]
fn parts_are_held_against_each_other() {
    let (one, other) = (study("samples = 1000"), study("samples = 1000\nseed = 2"));
    let notes = |study: &Study, index, of| study.notes(Shard { index, of }).expect("a shard");
    let told = |files: &[(&str, Vec<(&'static str, String)>)]| {
        let mut parts = Parts::default();
        let add = |parts: &mut Parts, (name, notes): &(&str, Vec<(&'static str, String)>)| {
            parts.add(name, |key| notes.iter().find(|(name, _)| *name == key).map(|(_, note)| note.as_str()))
        };
        let added = files.iter().try_for_each(|file| add(&mut parts, file));
        let order = added.and_then(|()| parts.in_order(&one));
        order.map_or_else(
            |error| error.to_string(),
            |order| format!("{:?}", order.iter().map(|(i, _)| *i).collect::<Vec<_>>()),
        )
    };
    let thirds = [1, 2, 3].map(|index| notes(&one, index, 3));
    let [a, b, c] = thirds.clone();
    assert_eq!(told(&[("c", c.clone()), ("a", a.clone()), ("b", b.clone())]), "[1, 2, 0]");
    assert_eq!(told(&[("c", c.clone()), ("a", a.clone())]), "no part has rows 333 to 665 of 1000: make shard 2/3");
    assert_eq!(told(&[("b", b.clone()), ("c", c.clone())]), "no part has rows 0 to 332 of 1000: make shard 1/3");
    assert_eq!(told(&[("a", a.clone()), ("b", b.clone())]), "no part has rows 666 to 999 of 1000: make shard 3/3");
    assert_eq!(told(&[("a", a.clone()), ("a", a.clone())]), "a is there twice: merge each part once");
    assert_eq!(
        told(&[("a", a.clone()), ("half", notes(&one, 1, 2))]),
        "half has rows that a has too: merge each part once"
    );
    // Shards of other sizes are as good, where they fit.
    assert_eq!(told(&[("half", notes(&one, 2, 2)), ("x", notes(&one, 1, 4)), ("y", notes(&one, 2, 4))]), "[1, 2, 0]");
    assert_eq!(
        told(&[("a", a.clone()), ("other", notes(&other, 2, 3))]),
        "other is of another study than a: its plan has `seed = 2` where that has no more"
    );
    let with = |key: &str, note: &str| {
        let mut notes = b.clone();
        notes.iter_mut().filter(|(name, _)| *name == key).for_each(|(_, text)| note.clone_into(text));
        notes
    };
    let version = told(&[("a", a.clone()), ("old", with("clatter.version", "0.0.9"))]);
    assert!(version.starts_with("old is of clatter 0.0.9, and this is clatter 0.1.0: merge it"), "{version}");
    let longer = EXAMPLE.replace("140 mm", "150 mm");
    let plan = Plan::read("product = \"p.toml\"\nsamples = 1000", "plan.toml").expect("a plan");
    let longer = Study::new(plan, &longer, "p.toml").expect("a study");
    let product = told(&[("a", a.clone()), ("x", notes(&longer, 2, 3))]);
    assert!(product.starts_with("x is of another study than a: its product has `length"), "{product}");
    assert_eq!(told(&[("x", Vec::new())]), "x is no part of a study: it has no clatter.version");
    // A lone part that was changed.
    for (key, note) in
        [("clatter.rows", "333:665"), ("clatter.seed", "8"), ("clatter.check", "0"), ("clatter.shard", "1/3")]
    {
        assert_eq!(told(&[("x", with(key, note))]), "x is damaged: what it says of itself is not as it was written");
    }
    // All that is missing is told.
    let tenth = |index| notes(&one, index, 10);
    assert_eq!(
        told(&[("x", tenth(2)), ("y", tenth(3)), ("z", tenth(6))]),
        "no part has rows 0 to 99 of 1000: make shard 1/10; no part has rows 300 to 499 of 1000: make shards 4/10 to 5/10; \
         no part has rows 600 to 999 of 1000: make shards 7/10 to 10/10"
    );
}

/// What a row says of one part goes together, and a few rows of each part are drawn again.
#[test]
fn rows_are_held_against_each_other_and_against_those_drawn_again() {
    let study = study("samples = 100");
    let rows = groups(&study, Shard { index: 1, of: 1 }).remove(0);
    let at = |what: &str| study.fields().iter().position(|field| field.name == what).expect("a column");
    let refused = |column: &str, value: f64| {
        let mut rows = rows.clone();
        rows[at(column)][7] = value;
        let mut merge = Merge::new(&study, 0.95).expect("a confidence");
        take(&mut merge, &study, &rows).expect_err("changed").to_string()
    };
    let exceeds = study.fields().iter().find(|field| field.name.starts_with("exceeds")).expect("a limit").name.clone();
    let part = exceeds.rsplit(" of ").next().expect("a part");
    let flipped = 1.0 - rows[at(&exceeds)][7];
    assert!(refused(&exceeds, flipped).contains("contradict"));
    assert!(refused(&format!("utilization of {part}"), 1.0 + flipped).contains("contradict"));
    assert!(refused(&format!("open of {part}"), 0.5).contains("neither 0 nor 1"));
    assert_eq!(study.again(&(0..100)).len(), 3);
    for row in study.again(&(0..100)) {
        let i = usize::try_from(row).expect("small");
        let mut told: Vec<f64> = rows.iter().map(|column| column[i]).collect();
        study.check(row, &told).expect("as it was drawn");
        told[1] = told[1].next_up();
        assert!(study.check(row, &told).is_err(), "row {row}");
    }
    let search = self::study("search = true\n[grid]\nproduct.restitution = [0.2, 0.3]");
    let rows = groups(&search, Shard { index: 1, of: 1 }).remove(0);
    assert_eq!((search.again(&(0..2)), search.again(&(1..2))), (vec![0], Vec::new()));
    search.check(0, &rows.iter().map(|column| column[0]).collect::<Vec<_>>()).expect("as it was searched");
}

/// The lines of what is no product file are not told.
#[test]
fn what_is_no_product_is_told_without_its_lines() {
    let plan = Plan::read("product = \"p.toml\"\nsamples = 10", "plan.toml").expect("a plan");
    let error = Study::new(plan, "password = \"x\"\n", "secret.txt").expect_err("no product").to_string();
    assert_eq!(error, "secret.txt is no product file: it has no [product]");
}

/// What the grid sets is among the columns of the drops, though it is one value in each product; what is one value in all is not.
#[test]
fn what_differs_from_product_to_product_has_a_column() {
    let names = |plan: &str| study(plan).fields().into_iter().map(|field| field.name).collect::<Vec<_>>();
    let has = |names: &[String], name: &str| names.iter().any(|known| known == name);
    let (of_grid, alone) = (
        names("samples = 10\n[grid]\nproduct.restitution = [0.2, 0.3]"),
        names("samples = 10\n[grid]\nproduct.restitution = [0.2]"),
    );
    assert!(has(&of_grid, "restitution") && !has(&alone, "restitution"), "{of_grid:?}, {alone:?}");
    assert!(has(&of_grid, "tilt_rad") && !has(&of_grid, "contact_time_s"), "{of_grid:?}");
}
