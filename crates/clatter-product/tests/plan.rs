//! Plans of studies: read strictly, with every fault where it stands, and the products that a grid makes.

use clatter_product::{Plan, ProductFile};

/// A bar.
const EXAMPLE: &str = include_str!("../../../tests/cases/bar-handheld.toml");

const PLAN: &str = "product = \"p.toml\"\nsamples = 1_000\nseed = 7\n[grid]\n";

fn faults(text: &str) -> String {
    Plan::read(text, "plan.toml").map_or_else(|faults| faults.to_string(), |plan| format!("{plan:?} is a plan"))
}

fn family(grid: &str) -> Result<clatter_product::Family, String> {
    let plan = Plan::read(&format!("{PLAN}{grid}"), "plan.toml").map_err(|faults| faults.to_string())?;
    plan.family(EXAMPLE, "p.toml").map_err(|faults| faults.to_string())
}

#[test]
fn what_is_wrong_is_told_where_it_stands() {
    for (text, told) in [
        ("", vec!["no `product`", "no `samples`"]),
        ("product = \"p.toml\"\nsample = 5", vec!["has no key `sample`", "did you mean `samples`?"]),
        ("product = 5\nsamples = 5", vec!["`product` cannot be this integer", "plan.toml:1:11"]),
        ("product = \"p\"\nsamples = 0", vec!["`samples` = 0 is out of its range", "from 1 to 1e12"]),
        ("product = \"p\"\nsamples = 1.5", vec!["`samples` = 1.5 is no whole number", "plan.toml:2:11"]),
        ("product = \"p\"\nsamples = 2e12", vec!["2e12", "from 1 to 1e12"]),
        ("product = \"p\"\nsamples = \"5 mm\"", vec!["`samples` cannot be \"5 mm\"", "expected a number"]),
        ("product = \"p\"\nsamples = 5\nseed = -1", vec!["`seed` = -1", "from 0 to 9007199254740992"]),
        ("product = \"p\"\nsamples = 5\nsearch = true", vec!["a search draws no `samples`"]),
        ("product = \"p\"\nsearch = 1", vec!["`search` cannot be this integer", "true or false"]),
        ("product = \"p\"\nsamples = 5\ngrid = 3", vec!["`grid` cannot be this integer", "a table [grid]"]),
        (
            "product = \"p\"\nsamples = 5\n[grid]\ndrop.height = 3",
            vec!["`drop.height` cannot be this integer", "80 Hz:120 Hz:5"],
        ),
        ("product = \"p\"\nsamples = 5\n[grid]\ndrop.height = []", vec!["`drop.height` cannot be this array"]),
        ("product = \"p\"\nsamples = 5\n[grid]\ndrop.height = \"1 m:2 mm:5\"", vec!["1 m:2 mm:5", "in one unit"]),
        ("product = \"p\"\nsamples = 5\n[grid]\ndrop.height = \"1 m:2 m:1\"", vec!["2 to 10000 values"]),
        (
            "product = \"p\"\nsamples = 5\n[grid]\ndrop.height = \"1 m:2 m:9999\"\ndrop.tilt = \"1 deg:2 deg:2\"",
            vec!["too many products"],
        ),
        ("product = \"p\"\nsamples = ", vec!["invalid TOML", "plan.toml:2"]),
    ] {
        let message = faults(text);
        assert!(told.iter().all(|told| message.contains(told)), "{text:?}:\n{message}");
    }
}

#[test]
fn a_grid_names_quantities_that_the_product_file_gives() {
    for (grid, told) in [
        ("product.restitutoin = [0.2]", vec!["no quantity of a product file is `product.restitutoin`", "restitution"]),
        ("product.width = [\"60 mm\"]", vec!["the product file has no `product.width`", "give it there"]),
        ("component.dispaly.position = [\"1 mm\"]", vec!["no component named \"dispaly\"", "display"]),
        ("component = [1]", vec!["`component` is no quantity", "component.NAME.KEY"]),
        ("product = [1]", vec!["`product` is no quantity", "expected a table and a key"]),
        ("product.name = [\"x\"]", vec!["`product.name` is no quantity"]),
        ("component.display.mount = [\"hard\"]", vec!["the product file has no `component.display.mount`"]),
        ("drop.height.normal = [1]", vec!["`drop.height.normal` is no quantity"]),
        // The product that it makes is read as any other, and told with its values.
        (
            "product.restitution = [0.2, 1.4]",
            vec!["`restitution` = 1.4 is out of its range", "p.toml with product.restitution = 1.4"],
        ),
        ("drop.tilt = [[\"3 deg\", \"1 deg\"]]", vec!["the range of `tilt` begins above its end"]),
    ] {
        let message = family(grid).map_or_else(|message| message, |family| format!("{family:?}"));
        assert!(told.iter().all(|told| message.contains(told)), "{grid}:\n{message}");
    }
}

/// The last axis runs fastest; ranges, distributions and steps stand in the file as if they had been written there.
#[test]
fn products_of_a_grid_are_the_file_with_other_values() {
    let grid = "product.restitution = [0.1, { uniform = [0.2, 0.3] }]\ncomponent.display.acceleration_limit = \"100 gn:300 gn:3\"";
    let family = family(grid).unwrap();
    assert_eq!(family.members(), 6);
    let member = |i| family.member(i).unwrap();
    let limits = |file: &ProductFile| file.components[0].limits;
    for (i, restitution, limit) in [(0, 0.1, "100 gn"), (2, 0.1, "300 gn"), (4, 0.2, "200 gn")] {
        let file = member(i);
        assert_eq!(file.product.restitution.lo().to_bits(), f64::to_bits(restitution), "{i}");
        let line = EXAMPLE.lines().find(|line| line.starts_with("acceleration_limit")).unwrap();
        let other = EXAMPLE.replacen(line, &format!("acceleration_limit = {limit:?}"), 1);
        assert_eq!(limits(&file), limits(&ProductFile::read(&other, "p.toml").unwrap()), "{i}");
        assert_eq!(file.components[1..], ProductFile::read(EXAMPLE, "p.toml").unwrap().components[1..], "{i}");
    }
    assert_eq!(family.values(5), ["{ uniform = [0.2, 0.3] }", "\"300 gn\""]);
    // Without rounding that nobody wrote.
    let plan = Plan::read(&format!("{PLAN}product.restitution = \"0.2:0.4:3\""), "plan.toml").unwrap();
    assert_eq!(plan.grid[0].values, ["0.2", "0.3", "0.4"]);
}

/// Texts of any sort are read or refused.
#[test]
fn torn_plans_are_refused() {
    let whole =
        format!("{PLAN}product.restitution = [0.1, {{ uniform = [0.2, 0.3] }}]\n\"drop\".tilt = \"1 deg:3 deg:5\"\n");
    let mut read = 0;
    for (at, _) in whole.char_indices() {
        for with in ["", "\"", "[", "é", ":", "=", "\n", "9"] {
            for text in [format!("{}{with}{}", &whole[..at], &whole[at..]), format!("{}{with}", &whole[..at])] {
                if let Ok(plan) = Plan::read(&text, "plan.toml") {
                    let _ = plan.family(EXAMPLE, "p.toml");
                    read += 1;
                }
            }
        }
    }
    assert!(read > 0, "some are plans still");
}
