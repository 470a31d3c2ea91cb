//! Products whose verdict, demand or bound would be wrong without a word: what each is told, held against what one of its drops asks for.

use serde_json::Value;

use crate::clatter;

const GN: f64 = 9.806_65;

fn assessed(name: &str) -> Value {
    let path = format!("{}/cases/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let outcome = clatter(["assess", &path, "--format=json"]);
    serde_json::from_str(&outcome.stdout).expect(&outcome.stderr)
}

/// The limits of the first part or of all parts, in the order of the file.
fn limits(answer: &Value) -> Vec<&Value> {
    let components = answer["components"].as_array().unwrap();
    components.iter().flat_map(|component| component["limits"].as_array().unwrap()).collect()
}

fn number(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_else(|| panic!("{key} of {of}"))
}

/// The demand that drops of the ranges may have, as it is told.
fn most(limit: &Value) -> f64 {
    number(limit, "demand") * (1.0 + number(limit, "uncertainty"))
}

/// A flat landing on its end in a soft case asks for 843 gn of 500, by another program.
#[test]
fn a_phone_in_a_soft_case_is_answered() {
    let answer = assessed("bound-phone");
    let [limit] = limits(&answer)[..] else { panic!("{answer}") };
    assert_eq!(limit["verdict"], "unsafe");
    assert!((number(limit, "demand") / (843.0 * GN) - 1.0).abs() < 0.01, "{limit}");
    assert!(number(limit, "bound") > 843.0 * GN, "{limit}");
}

/// The demand of a limit is that of the drop that asks most, and what others and later landings may ask leaves it safe.
#[test]
fn the_demand_is_that_of_the_drop_that_asks_most() {
    let answer = assessed("headline");
    let [limit] = limits(&answer)[..] else { panic!("{answer}") };
    let rows = answer["landings"].as_array().unwrap();
    let largest = rows.iter().map(|row| number(&row["limits"][0], "demand")).fold(0.0, f64::max);
    let is_largest = |demand: f64| demand.to_bits() == largest.to_bits();
    assert!(is_largest(number(limit, "demand")), "{limit}: not {largest}");
    let first = rows.iter().find(|row| is_largest(number(&row["limits"][0], "demand"))).unwrap();
    assert_eq!(limit["worst_case"]["landing"], first["landing"]);
    assert!(most(limit) <= number(limit, "bound") * (1.0 + 1e-9), "{limit}");
    assert!(limit["verdict"] == "safe" && most(limit) < number(limit, "allowed"), "{limit}");
}

/// With friction of 0.3 these parts ask for 52 and 104 gn, by another program: without, for next to nothing.
#[test]
fn parts_along_the_ground_are_judged_with_friction() {
    let answer = assessed("sliding-cube");
    for (limit, pushed) in limits(&answer).into_iter().zip([52.0, 104.0]) {
        assert_eq!(limit["verdict"], "unsafe", "{limit}");
        assert!(number(limit, "demand") > pushed * GN, "{limit}: {pushed}");
    }
    assert_eq!(answer["assumed"].as_array().unwrap().last().unwrap()["input"], "friction");
    // Friction is drawn as well: of 4000 samples 67 % survived.
    let survival = &drawn("sliding-cube", 40)["components"][0]["survival"];
    let [least, most] = [0, 1].map(|end| survival["interval"][end].as_f64().unwrap());
    assert!(least > 0.3 && least < 0.67 && most > 0.67 && most < 0.95, "{survival}");
}

/// It lands at 4.4 m/s on its bottom, along which nothing pushes, turns, and lands on its end later.
#[test]
fn a_velocity_change_across_the_blow_is_that_of_its_shock() {
    let answer = assessed("sideways-velocity");
    let [limit] = limits(&answer)[..] else { panic!("{answer}") };
    assert_eq!(limit["verdict"], "undecided");
    // A drop of 260 that were followed until they lay asked for 2.12.
    assert!(number(limit, "demand") < 2.5 && most(limit) > 2.12, "{limit}");
    assert!(number(&limit["worst_case"], "time_s") > 0.1, "{limit}");
}

/// A plate asks for up to 30 % more than the bar that its file tells where it tells no width.
#[test]
fn a_bar_says_that_it_is_one_and_what_a_plate_may_ask() {
    let [bar, plate] = ["thermostat-bar", "thermostat-plate"].map(assessed);
    let relay = |answer: &Value| (limits(answer)[1]["verdict"].clone(), number(limits(answer)[1], "demand"));
    let ((as_bar, less), (as_plate, more)) = (relay(&bar), relay(&plate));
    assert_eq!((as_bar, as_plate), ("safe".into(), "unsafe".into()));
    assert!((1.2..1.3).contains(&(more / less)), "{more}, {less}");
    assert_eq!(bar["assumed"][0]["input"], "body");
    assert!(bar["assumed"][0]["why"].as_str().unwrap().contains("up to 30 % more"));
    assert!(!plate["assumed"].to_string().contains("body"), "{plate}");
    let path = format!("{}/cases/thermostat-bar.toml", env!("CARGO_MANIFEST_DIR"));
    let first = clatter(["assess", &path]).stdout;
    assert!(first.split("\n\n").next().unwrap().contains("as a bar; if it is wider than a"), "{first}");
}

/// What others may ask is without end, since many drops are not answered: which, and why.
#[test]
fn an_uncertainty_without_end_has_its_reason() {
    let answer = assessed("earbud");
    assert_eq!(limits(&answer)[0]["verdict"], "safe", "{answer}");
    let cases = format!("{}/cases/earbud.toml", env!("CARGO_MANIFEST_DIR"));
    let softer = std::fs::read_to_string(cases).unwrap().replace("\"2 ms\"", "\"8 ms\"");
    let file = tempfile::NamedTempFile::with_suffix(".toml").unwrap();
    std::fs::write(file.path(), softer).unwrap();
    let outcome = clatter(["assess", file.path().to_str().unwrap(), "--format=json"]);
    let answer: Value = serde_json::from_str(&outcome.stdout).expect(&outcome.stderr);
    let limit = limits(&answer)[0];
    assert_eq!((&limit["verdict"], &limit["uncertainty"]), (&"undecided".into(), &"infinite".into()));
    assert!(limit["undecided"].as_str().unwrap().contains("are not answered: contact time 8 ms: at most"), "{limit}");
}

fn drawn(name: &str, samples: u32) -> Value {
    let path = format!("{}/cases/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let outcome = clatter(["scatter", &path, &format!("--samples={samples}"), "--format=json"]);
    serde_json::from_str(&outcome.stdout).expect(&outcome.stderr)
}

/// Every number is counted on the same samples; of none that is answered there is no probability.
#[test]
fn survival_of_all_parts_is_no_likelier_than_of_each() {
    let answer = drawn("scatter-all", 20_000);
    let all = number(&answer["survival"], "probability");
    for part in answer["components"].as_array().unwrap() {
        assert!(all <= number(&part["survival"], "probability"), "{all}: {part}");
    }
    let none = drawn("scatter-none", 20);
    assert_eq!(none["survival"]["probability"], Value::Null);
    assert_eq!(none["components"][0]["survival"]["probability"], Value::Null);
}
