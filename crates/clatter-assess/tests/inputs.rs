//! Every input of a drop goes all the way: read, searched, bounded, drawn, told and repeated.

use clatter_assess::scatter::{Column, Sampler, Settings};
use clatter_assess::{Case, LimitAssessment, Part, answer, assess};
use clatter_product::{INPUTS, Input, Limit, ProductFile, Row};

/// Two values of an input that ask for different demands; none of what a bar chooses or does not have.
fn ends(input: Input) -> Option<[&'static str; 2]> {
    match input {
        Input::First | Input::Direction => None,
        Input::Height => Some(["0.4 m", "1 m"]),
        Input::Speed => Some(["2 m/s", "4 m/s"]),
        Input::Tilt => Some(["0.2 deg", "5 deg"]),
        Input::Restitution => Some(["0.1", "0.4"]),
        Input::ContactTime => Some(["0.3 ms", "0.6 ms"]),
        Input::Gyration => Some(["36 mm", "44 mm"]),
        Input::Spin => Some(["-4 rad/s", "6 rad/s"]),
        Input::Friction => Some(["0.1", "0.5"]),
    }
}

/// A box with a part across that lands on its bottom, with a value or a range of the friction.
fn slides(value: &str) -> ProductFile {
    let text = format!(
        "[product]\nname = \"Box\"\nlength = \"150 mm\"\nwidth = \"70 mm\"\nthickness = \"30 mm\"\nradius_of_gyration = [\"43 mm\", \"20 mm\"]\n\
         restitution = 0.3\ncontact_time = \"0.4 ms\"\ncontact_law = \"hysteretic\"\nfriction = {value}\n[[drop]]\nheight = \"1 m\"\nface = \"bottom\"\n\
         [[component]]\nname = \"part\"\nposition = [\"40 mm\", \"0 mm\"]\naxis = \"x\"\nmount = \"hard\"\nacceleration_limit = \"3000 gn\"\n"
    );
    ProductFile::read(&text, "box.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
}

/// A product with a value or a range of an input.
fn product(input: Input, value: &str) -> ProductFile {
    if input == Input::Friction {
        return slides(value);
    }
    let fall = if input == Input::Speed { None } else { Some(("height", "1 m")) };
    let product = [("radius_of_gyration", "43 mm"), ("restitution", "0.3"), ("contact_time", "0.4 ms")];
    let drop = fall.into_iter().chain([("tilt", "3 deg")]);
    let key = input.row().name.replace('-', "_");
    let is_of_product = product.iter().any(|(name, _)| *name == key);
    let own = |is: bool| if is_of_product == is { format!("{key} = {value}\n") } else { String::new() };
    let line = |(name, text): (&str, &str)| {
        if name == key { String::new() } else { format!("{name} = \"{text}\"\n").replace("\"0.3\"", "0.3") }
    };
    let text = format!(
        "[product]\nname = \"Bar\"\nlength = \"150 mm\"\n{}{}[drop]\n{}{}\
         [[component]]\nname = \"part\"\nposition = \"40 mm\"\nmount = \"hard\"\nacceleration_limit = \"3000 gn\"\n",
        product.into_iter().map(line).collect::<String>(),
        own(true),
        drop.map(line).collect::<String>(),
        own(false),
    );
    ProductFile::read(&text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
}

fn quoted(text: &str) -> String {
    if text.parse::<f64>().is_ok() { text.to_owned() } else { format!("\"{text}\"") }
}

fn limit(file: &ProductFile) -> LimitAssessment {
    let mut assessment = assess(file).unwrap_or_else(|error| panic!("{error}"));
    assessment.components.remove(0).limits.remove(0)
}

/// What a worst drop has of an input, beside what the file says.
fn told(row: &Row, file: &ProductFile, limit: &LimitAssessment) -> ([f64; 2], f64) {
    let told = row.input.told();
    let range = told.range(&file.product, &file.drop).unwrap_or_else(|| panic!("no range of {}", row.name));
    let worst = limit.worst_case.expect("a worst drop");
    (range, told.value(&worst.drop).unwrap_or_else(|| panic!("no {}", row.name)))
}

#[test]
fn every_input_is_read_searched_bounded_drawn_and_repeated() {
    for row in &INPUTS {
        let Some(values) = ends(row.input) else { continue };
        let alone = values.map(|value| {
            let file = product(row.input, &quoted(value));
            let limit = limit(&file);
            let ([least, most], value) = told(row, &file, &limit);
            assert_eq!(least.to_bits(), most.to_bits(), "{}", row.name);
            assert!((value - most).abs() <= 1e-12 * most.abs(), "{}: {value}, not {most}", row.name);
            limit.demand.expect("a demand")
        });
        let [less, more] = if alone[0] < alone[1] { alone } else { [alone[1], alone[0]] };
        assert!(more > 1.005 * less, "{}: {alone:?} tell nothing", row.name);

        let file = product(row.input, &format!("[{}, {}]", quoted(values[0]), quoted(values[1])));
        let limit = limit(&file);
        let demand = limit.demand.expect("a demand");
        // Of a box fewer drops are followed, and what others may ask for is told.
        let covered = if row.input == Input::Friction { limit.uncertainty } else { 0.005 };
        assert!(demand * (1.0 + covered) > more, "{}: {demand} of the range, {more} of one value in it", row.name);
        assert!(limit.bound.is_none_or(|bound| bound >= demand), "{}: {demand} is beyond its bound", row.name);
        let ([least, most], value) = told(row, &file, &limit);
        let slack = 1e-12 * most.abs().max(least.abs());
        assert!(least < most && value >= least - slack && value <= most + slack, "{}: {value}", row.name);

        let worst = limit.worst_case.expect("a worst drop");
        let written = serde_json::to_string(&Case::of(&worst)).expect("a drop as data");
        let case: Case = serde_json::from_str(&written).unwrap_or_else(|error| panic!("{error}: {written}"));
        let part: Part = case.part().expect("a part");
        let limits = Limit::of(&file.components[0]);
        let again = answer(&case.drop, &part, &limits[0], case.model, case.tolerance).expect("an answer");
        assert!((again.value / demand - 1.0).abs() < 1e-9, "{}: {} again, not {demand}", row.name, again.value);

        let settings = Settings { samples: 200, seed: 1, confidence: 0.95, merge_s: 1e-12 };
        let sampler = Sampler::new(&file, settings).expect("a sampler");
        let column = Column::Drop(row.input.told(), None);
        assert!(sampler.quantities().contains(&column) && sampler.varies(column), "{} is not drawn", row.name);
        let drawn: Vec<f64> = (0..200).map(|sample| sampler.drawn(sample, &[column])[0]).collect();
        let (lowest, highest) = drawn.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (x.min(a), x.max(b)));
        let width = most - least;
        let inside = lowest >= least - slack && highest <= most + slack;
        assert!(
            inside && lowest < least + 0.1 * width && highest > most - 0.1 * width,
            "{}: {lowest}, {highest}",
            row.name
        );
    }
}

/// A value that says that an input is left out is the same file as one without it.
#[test]
fn an_input_that_is_left_out_changes_nothing() {
    for (row, optional) in clatter_product::optional_inputs() {
        let zero = product(row.input, &quoted(&format!("{} {}", optional.without, row.unit)));
        let without = product(Input::Height, "\"1 m\"");
        assert_eq!(limit(&zero).demand.map(f64::to_bits), limit(&without).demand.map(f64::to_bits), "{}", row.name);
        let settings = Settings { samples: 200, seed: 1, confidence: 0.95, merge_s: 1e-12 };
        let columns = [&zero, &without].map(|file| Sampler::new(file, settings).expect("a sampler").columns());
        assert_eq!(columns[0], columns[1]);
    }
}
