//! This module writes the pages of an assessment: the verdict first, then each part.

mod changes;
mod inputs;
mod landings;
mod measured;
mod part;
mod plate;

use clatter::End;
use clatter_assess::{Assessment, ComponentAssessment, LimitAssessment, Portrait, Verdict};
use clatter_figures::{FigureError, Place, Share, history, over_tilt, product, shares};
use clatter_product::{Component, LimitKind};
use serde_json::{Value, json};

use crate::Pages;
use crate::words::{hundredths, name, percent, sure_name};

/// The effects that the models leave out, in plain words.
const NOT_COVERED: [[&str; 2]; 10] = [
    [
        "Corners and edges",
        "The product is a bar seen from the side: it lands on one edge, then on the opposite one. A plate that lands on a corner has more ways to clatter, and a corner takes the blow of an edge alone. Both can be worse.",
    ],
    [
        "A case that bends",
        "The case is rigid. A thin case bends between its ends and rings; what its modes add to a part, and take from it, is not here.",
    ],
    [
        "The ground",
        "It is hard, level and without friction, and the same for both ends. Soft ground lengthens the pulses and lowers e.",
    ],
    [
        "Restitution",
        "e is a number within the range given, at any speed. Real edges dent, and their e falls with speed.",
    ],
    [
        "The shape of a pulse",
        "Real contacts follow neither of the two contact laws. Where a stiff part feels the difference, the demand by the other law is told. Without a contact time impacts are instants.",
    ],
    [
        "Parts that act back",
        "A part is light beside the product: it is driven by the motion of the case and does not change it.",
    ],
    [
        "Stops",
        "A suspension is linear, also where it presses a stop that the file gives. Where it gives none, the acceleration of a part that may strike its stop is left undecided.",
    ],
    [
        "Drops between those followed",
        "The worst drop is searched, and the share by which others may ask for more is told with it. How a product lands once more after it has bounced clear hangs on every input: such drops are a sample.",
    ],
    [
        "Places",
        "Where a part could sit is told of the drops of the figures. An assessment of the changed file decides.",
    ],
    ["Damage by repetition", "Each limit is on the worst moment of one drop. Fatigue over many drops is not counted."],
];

/// Returns the effects that the model of a bar leaves out, or that of a plate, which may turn as it lands.
fn not_covered(is_plate: bool, spins: bool) -> Vec<[String; 2]> {
    let of_plate = |said: [&'static str; 2]| {
        let other = plate::NOT_COVERED.into_iter().find(|other| is_plate && other.0 == said[0]);
        other.map_or(said, |other| other.1)
    };
    let of_spin = |said: &str| if spins { said.replace(plate::NO_SPIN, plate::SPIN) } else { said.to_owned() };
    NOT_COVERED.map(of_plate).iter().map(|said| said.map(of_spin)).collect()
}

/// Rows of one drawing of the product, and curves of one figure, at most: more are neither read nor hold on a page.
const ROWS: usize = 32;
const CURVES: usize = 16;

/// A part of the file, what was found of it, and what is drawn.
type Part<'a> = ((&'a Component, &'a ComponentAssessment), &'a Portrait);

/// Makes the files of the pages: figures and data.
pub(crate) fn files(pages: &Pages<'_>) -> Result<Vec<(String, String)>, FigureError> {
    let Pages { file, assessment, portraits, measured: drops, .. } = *pages;
    let parts: Vec<Part<'_>> = file.components.iter().zip(&assessment.components).zip(portraits).collect();
    let names: Vec<String> = parts.iter().map(|((_, assessed), _)| name(&assessed.name)).collect();
    let margins: Vec<String> =
        parts.iter().map(|((_, assessed), _)| assessed.tightest().margin.map_or("?".to_owned(), percent)).collect();
    let places = parts.iter().zip(names.iter().zip(&margins));
    let places: Vec<Place<'_>> = places
        .map(|(((component, assessed), portrait), (name, word))| Place {
            name,
            from_m: component.position_m.lo() - 0.5 * component.extent_m,
            to_m: component.position_m.hi() + 0.5 * component.extent_m,
            verdict: assessed.verdict,
            word,
            zone_m: portrait.zone_m,
        })
        .collect();
    let body = &file.product.body;
    let of_plate = file.product.plate();
    let (sides_m, beyond_m) = (file.product.sides_m(), file.product.body.feet.map_or(0.0, |feet| feet.inset_m[0]));
    let mut files = Vec::new();
    let rows: Vec<_> = places.chunks(ROWS).collect();
    for (i, rows) in rows.iter().enumerate() {
        let drawn = match &of_plate {
            Some(plate) => plate::plan(plate, sides_m, &file.components, rows, i * ROWS)?,
            None => product(body.arms_m(), body.gyration_m(), beyond_m, rows)?,
        };
        files.push((format!("product-{}.svg", i + 1), drawn));
    }
    for (i, part) in parts.iter().enumerate() {
        files.push(over_time(i + 1, part)?);
        match &of_plate {
            Some(plate) => files.extend(plate::figures(i + 1, (plate, sides_m), part)?),
            None => files.push(tilts(i + 1, part)?),
        }
    }
    let mut tightest: Vec<_> = parts.iter().zip(&names).collect();
    tightest.sort_by(|a, b| a.0.0.1.tightest().room().total_cmp(&b.0.0.1.tightest().room()));
    tightest.truncate(CURVES);
    let shown: Vec<Share<'_>> = tightest.into_iter().map(|(part, name)| share(part, name)).collect();
    let is_box = file.is_box();
    if !is_box {
        files.push(("shares.svg".into(), shares(&shown, of_plate.is_some())?));
    }
    files.extend(measured::figures(drops)?);
    let said = |p: &Place<'_>| format!("{}: {}, margin {}.", p.name, p.verdict.name(), p.word);
    let drawings = rows.iter().map(|rows| rows.iter().map(said).collect::<Vec<_>>().join(" "));
    let with = |verdict| parts.iter().filter(|((_, assessed), _)| assessed.verdict == verdict).count();
    let data = json!({
        "product": name(&assessment.product),
        "verdict": assessment.verdict.name(),
        "assumed": assessment.assumed.iter().map(|assumed| assumed.told()).collect::<Vec<_>>(),
        "safe": with(Verdict::Safe),
        "reliable": with(Verdict::Reliable),
        "undecided": with(Verdict::Undecided),
        "unsafe": with(Verdict::Unsafe),
        "hardest": hardest(assessment),
        "parts": parts.iter().enumerate().map(|(i, (of, portrait))| part::part(pages, i, *of, portrait)).collect::<Vec<_>>(),
        "inputs": inputs::rows(file, assessment),
        "differences": measured::differences(file, drops),
        "measured": measured::sections(file, drops),
        "made": inputs::made(pages),
        "drawings": drawings.collect::<Vec<_>>(),
        "curves": shown.len(),
        "plate": of_plate.is_some(),
        "box": is_box,
        "landings": landings::rows(file, assessment),
        "landings-of": file.landings.first().and_then(|landing| landing.source),
        "limits-of-the-model": if is_box { json!(landings::NOT_COVERED) } else { json!(not_covered(of_plate.is_some(), file.drop.may_spin())) },
    });
    files.push(("assessment.json".into(), data.to_string()));
    Ok(files)
}

/// Makes the same assessment with names that can surely be set; `None` where its names are such already.
pub(crate) fn surely_named(assessment: &Assessment) -> Option<Assessment> {
    let mut sure = assessment.clone();
    let mut changed = false;
    for text in std::iter::once(&mut sure.product).chain(sure.components.iter_mut().map(|c| &mut c.name)) {
        changed |= sure_name(text) != name(text);
        *text = sure_name(text);
    }
    changed.then_some(sure)
}

/// Finds the limit that is exceeded by most: the part, the margin.
fn hardest(assessment: &Assessment) -> Option<Value> {
    let limits = assessment.components.iter().flat_map(|c| c.limits.iter().map(move |l| (c, l)));
    let exceeded = limits.filter(|(_, l)| l.verdict == Verdict::Unsafe);
    let worst = exceeded.min_by(|a, b| a.1.room().total_cmp(&b.1.room()));
    worst.map(|(c, l)| {
        let share = l.demand.map_or(f64::INFINITY, |demand| demand / l.allowed);
        json!({ "name": name(&c.name), "limit": l.limit.words(), "share": hundredths(share) })
    })
}

/// Returns the quantity of the tightest limit, as the figures name it: they are too low for the longest of the words.
fn title(of: &LimitAssessment) -> String {
    let what = match of.limit {
        LimitKind::AngularVelocityChange => "change of *ω*",
        kind => kind.measured(of.unit),
    };
    format!("{what}, {}", of.unit.customary().name)
}

/// Draws the response over time of one part.
fn over_time(number: usize, ((_, assessed), portrait): &Part<'_>) -> Result<(String, String), FigureError> {
    let tightest = assessed.tightest();
    let unit = tightest.unit.customary();
    let points: Vec<(f64, f64)> = portrait.history.iter().map(|p| (1e3 * p.0, unit.of_si(p.1))).collect();
    let impacts: Vec<f64> = portrait.impacts_s.iter().map(|t| 1e3 * t).collect();
    let titles = ["time since the first touch, ms", &title(tightest)];
    Ok((format!("history-{number}.svg"), history(&points, &impacts, unit.of_si(tightest.allowed), titles)?))
}

/// Draws the demand of one part of a bar over the tilt.
fn tilts(number: usize, ((_, assessed), portrait): &Part<'_>) -> Result<(String, String), FigureError> {
    let tightest = assessed.tightest();
    let allowed = tightest.unit.customary().of_si(tightest.allowed);
    let curves = portrait.over_tilt.iter().map(|(first, curve)| {
        let points: Vec<_> = curve.iter().map(|p| (p.tilt_rad.to_degrees(), allowed * p.share)).collect();
        (if *first == End::A { "end *a* first" } else { "end *b* first" }, points)
    });
    let curves: Vec<(&str, Vec<(f64, f64)>)> = curves.collect();
    let titles = ["tilt at the first touch, degrees", &title(tightest)];
    Ok((format!("tilt-{number}.svg"), over_tilt(&curves, allowed, titles)?))
}

/// Returns the demand on the tightest limit of a part over the tilt, the worse of both first ends, as a share of the allowed value; of a
/// plate over the direction.
fn share<'a>(((_, assessed), portrait): &Part<'_>, name: &'a str) -> Share<'a> {
    let around = portrait.plate.iter().flat_map(plate::around);
    let mut points: Vec<(f64, f64)> = around.map(|(direction, share, _)| (direction, share)).collect();
    for (_, curve) in &portrait.over_tilt {
        let curve = curve.iter().map(|p| (p.tilt_rad.to_degrees(), p.share));
        if points.is_empty() {
            points = curve.collect();
        } else {
            points.iter_mut().zip(curve).for_each(|(p, q)| p.1 = p.1.max(q.1));
        }
    }
    Share { name, verdict: assessed.verdict, points }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_assess::design::{Bounds, Outcome, Remedies, Remedy};
    use clatter_product::ProductFile;

    /// A bar.
    const EXAMPLE: &str = include_str!("../../../tests/cases/bar-handheld.toml");

    fn pages(text: &str, to: &std::path::Path) -> lopdf::Document {
        let file = ProductFile::read(text, "test.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        let pages = Pages {
            file: &file,
            assessment: &assessment,
            portraits: &portraits,
            remedies: &[],
            measured: &[],
            path: "test.toml",
            date: None,
        };
        crate::write_assessment(&pages, to, &mut |_| ()).unwrap();
        lopdf::Document::load(to).unwrap()
    }

    fn said(pdf: &lopdf::Document, page: u32) -> String {
        pdf.extract_text(&[page]).unwrap()
    }

    fn data(files: &[(String, String)]) -> Value {
        serde_json::from_str(&files.iter().find(|(name, _)| name == "assessment.json").unwrap().1).unwrap()
    }

    /// Of all limits that are exceeded the first page names the one that is by most, wherever it stands in the file.
    #[test]
    fn the_hardest_limit_is_the_one_that_is_exceeded_by_most() {
        let part = |name: &str, limit: u32| {
            format!(
                "[[component]]\nname = \"{name}\"\nposition = \"40 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"{limit} mm/s\"\n"
            )
        };
        let product = "[product]\nname = \"bar\"\nlength = \"150 mm\"\nradius_of_gyration = \"43 mm\"\nrestitution = 0.3\n\
            [drop]\nspeed = \"3 m/s\"\ntilt = \"3 deg\"\n";
        for order in [["much", "little"], ["little", "much"]] {
            let parts = order.map(|name| part(name, if name == "much" { 500 } else { 2000 }));
            let file = ProductFile::read(&format!("{product}{}", parts.concat()), "bar.toml").unwrap();
            let told = hardest(&clatter_assess::assess(&file).unwrap()).unwrap();
            assert_eq!(told["name"], json!(name("much")), "{told}");
        }
    }

    /// A page of several drops of a bar has a row and the tilt of each, and figures as of one drop.
    #[test]
    fn several_drops_of_a_bar_have_a_row_each() {
        let drops = "[[drop]]\nspeed = \"2 m/s\"\ntilt = \"3 deg\"\nfirst = \"b\"\n[[drop]]\n";
        let text = EXAMPLE.replace("[drop]\n", drops);
        let dir = tempfile::tempdir().unwrap();
        let page = said(&pages(&text, &dir.path().join("page.pdf")), 1);
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        for words in
            ["Each drop of the file", "drop 1, end b first, 2 m/s 3°", "drop 2, either end first, 4.85 m/s 1 to 10°"]
        {
            assert!(page.contains(words), "{words}: {page}");
        }
    }

    /// A page prints the changes that were found, each in the unit of the file; where none is known it names the command that finds them.
    #[test]
    fn a_part_is_told_what_would_make_it_safe() {
        let file = ProductFile::read(include_str!("../../../tests/cases/bar-laptop.toml"), "laptop.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let found = clatter_assess::remedies(&file, &assessment, &Bounds::default(), 0.1).unwrap();
        let told = |remedies: &[Remedies]| {
            let (file, assessment) = (&file, &assessment);
            let portraits = &clatter_assess::portraits(file, assessment)[..];
            let pages = Pages { file, assessment, portraits, remedies, measured: &[], path: "laptop.toml", date: None };
            let data = data(&files(&pages).unwrap());
            data["parts"].as_array().unwrap().iter().map(|part| part["changes"].clone()).collect::<Vec<_>>()
        };
        let all = told(&found);
        for (part, remedies) in all.iter().zip(&found) {
            let enough = |remedy: &&Remedy| matches!(remedy.outcome, Outcome::Change { .. });
            let alone = remedies.levers.iter().filter(enough).count();
            let together = remedies.pair.as_ref().map_or(0, |pair| pair.changes.len());
            assert_eq!(part["rows"].as_array().unwrap().len(), alone + together, "{part}");
        }
        let [disk, fan, _] = &all[..] else { panic!("{all:?}") };
        assert!(
            disk["say"].as_str().unwrap().starts_with("No single change is enough; these two together are"),
            "{disk}"
        );
        let place = |row: &&Value| row["what"] == "place";
        let place = fan["rows"].as_array().unwrap().iter().find(place).expect("its place");
        assert_eq!((&place["from"], &place["to"]), (&json!("100 mm"), &json!("80 mm")));
        assert!(told(&[])[0]["say"].as_str().unwrap().contains("clatter design"));
        let stopped = |remedies: &Remedies| {
            let levers = remedies.levers.iter().map(|remedy| Remedy { outcome: Outcome::Stopped, ..remedy.clone() });
            Remedies { levers: levers.collect(), pair: None, nearest: None, ..remedies.clone() }
        };
        let stopped = told(&found.iter().map(stopped).collect::<Vec<_>>());
        assert!(stopped[0]["not"].as_str().unwrap().contains("the time was over"), "{stopped:?}");
    }

    /// The share of the tightest limit is demand over allowed; over the tilt the worse of both ends counts; and up to the tilt at which the
    /// gap of 330 mm closes within a millisecond both ends of the laptop land as one.
    #[test]
    fn a_page_says_what_was_found_of_each_part() {
        let file = ProductFile::read(include_str!("../../../tests/cases/bar-laptop.toml"), "laptop.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        let pages = Pages {
            file: &file,
            assessment: &assessment,
            portraits: &portraits,
            remedies: &[],
            measured: &[],
            path: "laptop.toml",
            date: None,
        };
        let data = data(&files(&pages).unwrap());
        let fast = file.drop.speeds_m_s()[1];
        let as_one = (1e-3 * fast / file.product.body.length_m()).asin().to_degrees();
        let parts = file.components.iter().zip(&assessment.components).zip(&portraits);
        for (part, told) in parts.zip(data["parts"].as_array().unwrap()) {
            let (tightest, summary) = (part.0.1.tightest(), told["summary"].as_str().unwrap());
            let percent = summary.split("\u{a0}% of it").next().unwrap().rsplit(' ').next().unwrap();
            let share = 100.0 * tightest.demand.unwrap() / tightest.allowed;
            assert!((percent.parse::<f64>().unwrap() - share).abs() <= 0.5, "{share}: {summary}");
            let most = |points: &mut dyn Iterator<Item = f64>| points.fold(0.0, f64::max);
            let drawn = most(&mut super::share(&part, "").points.into_iter().map(|point| point.1));
            let asked = most(&mut part.1.over_tilt.iter().flat_map(|(_, curve)| curve).map(|point| point.share));
            assert!((drawn - asked).abs() < 1e-12, "{drawn}, not {asked}");
            let tilt = told["tilt"].as_str().unwrap().split(" Up to ").nth(1).unwrap().split('°').next().unwrap();
            // At most one step of the tilts is missing.
            assert!((as_one - 0.15..=as_one + 0.005).contains(&tilt.parse().unwrap()), "{tilt}, not {as_one}");
        }
    }

    /// Where the worst drop demands nearly all that is allowed, the search does not decide, and the page says so.
    #[test]
    fn an_undecided_part_is_told_as_such() {
        let file = |limit: f64| {
            let text = EXAMPLE.replace("\"1000 gn\"", &format!("\"{limit} m/s2\""));
            ProductFile::read(&text, "test.toml").unwrap()
        };
        let asked = clatter_assess::assess(&file(1e4)).unwrap().components[1].limits[0].demand.unwrap();
        let close = file(1.005 * asked);
        let assessment = clatter_assess::assess(&close).unwrap();
        let camera = &assessment.components[1];
        assert_eq!(camera.limits[0].verdict, Verdict::Undecided, "{camera:?}");
        let portraits = clatter_assess::portraits(&close, &assessment);
        let pages = Pages {
            file: &close,
            assessment: &assessment,
            portraits: &portraits,
            remedies: &[],
            measured: &[],
            path: "close.toml",
            date: None,
        };
        let data = data(&files(&pages).unwrap());
        let part = &data["parts"][1];
        assert_eq!(part["limits"][0]["verdict"], "undecided");
        let why = part["undecided"][0]["why"].as_str().unwrap();
        assert!(why.contains("% of the limit, and others"), "{why}");
    }

    #[test]
    fn the_verdict_stands_on_the_first_page_and_every_part_has_a_section() {
        let dir = tempfile::tempdir().unwrap();
        let text =
            EXAMPLE.replace("name = \"camera\"", "name = \"camera\"\nlimit_source = \"data sheet 12-3, rev. B\"");
        let pdf = pages(&text, &dir.path().join("report.pdf"));
        let first = said(&pdf, 1);
        for word in
            ["Handheld", "display", "camera", "crystal", "Margin", "Flat drop", "Revision", "Author", "Signature"]
        {
            assert!(first.contains(word), "{word} is not on the first page: {first}");
        }
        let words = first.split_whitespace().collect::<Vec<_>>().join(" ");
        let assumed =
            "It is answered as a bar; if it is wider than a quarter of its length, give width: up to 30 % more.";
        assert!(words.contains(assumed), "{words}");
        let rest: String = (2..=u32::try_from(pdf.get_pages().len()).unwrap()).map(|page| said(&pdf, page)).collect();
        for word in [
            "display",
            "camera",
            "crystal",
            "does not cover",
            "--product=test.toml",
            "--worst=",
            "data sheet 12-3, rev. B",
        ] {
            assert!(rest.contains(word), "{word} has no section: {rest}");
        }
    }

    /// The share is that of the assessment: demand over allowed.
    #[test]
    fn what_exceeds_its_limit_is_told_on_the_first_page_with_its_share() {
        let dir = tempfile::tempdir().unwrap();
        let text = include_str!("../../../tests/cases/bar-laptop.toml");
        let found = clatter_assess::assess(&ProductFile::read(text, "laptop.toml").unwrap()).unwrap();
        let shares = found.components.iter().flat_map(|c| &c.limits).map(|l| l.demand.unwrap() / l.allowed);
        let share = clatter_figures::three(100.0 * shares.fold(0.0, f64::max));
        let pdf = pages(text, &dir.path().join("report.pdf"));
        let first: String = said(&pdf, 1).split_whitespace().collect();
        assert!(first.contains(&format!("therattlespaceofdiskdrive:theworstdropasksfor{share}%ofit")), "{first}");
        // The last page has more than a few lines.
        let last = u32::try_from(pdf.get_pages().len()).unwrap();
        assert!(said(&pdf, last).len() > 800, "{}", said(&pdf, last));
    }

    /// Rows of many parts go on in further drawings, and one figure has a few curves.
    #[test]
    fn many_parts_are_drawn_in_pieces() {
        let many = (0..70).map(|k| {
            format!(
                "[[component]]\nname = \"part {k}\"\nposition = \"{} mm\"\nmount = \"hard\"\nvelocity_change_limit = \"{} m/s\"\n",
                k - 35,
                6.0 + 0.1 * f64::from(k)
            )
        });
        let head = EXAMPLE.split("[[component]]").next().unwrap();
        let file = ProductFile::read(&(head.to_owned() + &many.collect::<String>()), "many.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        let (file, assessment, portraits) = (&file, &assessment, &portraits[..]);
        let files =
            files(&Pages { file, assessment, portraits, remedies: &[], measured: &[], path: "many.toml", date: None })
                .unwrap();
        let drawn = |name: &str| files.iter().find(|(file, _)| file == name).map(|(_, svg)| svg.as_str());
        let rows = (1..=3).map(|k| drawn(&format!("product-{k}.svg")).unwrap().matches(">part ").count());
        assert_eq!(rows.collect::<Vec<_>>(), [32, 32, 6]);
        assert_eq!(drawn("shares.svg").unwrap().matches(">part ").count(), CURVES);
        assert_eq!(data(&files)["drawings"].as_array().unwrap().len(), 3);
    }

    /// Strikes of the paper's reference bar at e = 0.3, as in the tests of `clatter-cli`; and what no computed drop explains.
    #[test]
    fn measured_drops_have_a_section_and_what_they_contradict_stands_on_the_first_page() {
        use clatter_fit::{Known, Measured, MeasuredDrop, MeasuredStrike, fit};
        let file = ProductFile::read(EXAMPLE, "test.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        let strike = |(time_s, end)| MeasuredStrike { time_s, end: Some(end) };
        let times = [(0.0, End::A), (1.2121e-3, End::B), (1.682_85e-3, End::A), (34.386e-3, End::B)];
        let measured = Measured::Strikes { strikes: times.map(strike).into(), deviation_s: Some(1e-6) };
        let known = Known { contact_time_s: None, ..Known::from(&file) };
        let found = |name: &str, found| MeasuredDrop { name: name.into(), files: vec![name.into()], found };
        let drops = [
            found("strikes\u{485}.csv", Ok(fit(&known, &[measured]).unwrap())),
            found("wild.csv", Err("no drop was found".to_owned())),
        ];
        let pages = Pages {
            file: &file,
            assessment: &assessment,
            portraits: &portraits,
            remedies: &[],
            measured: &drops,
            path: "test.toml",
            date: None,
        };
        let dir = tempfile::tempdir().unwrap();
        let to = dir.path().join("report.pdf");
        crate::write_assessment(&pages, &to, &mut |_| ()).unwrap();
        let pdf = lopdf::Document::load(&to).unwrap();
        let words = |page| said(&pdf, page).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words(1).contains("Measured otherwise. wild.csv: no drop was found."), "{}", words(1));
        let last = u32::try_from(pdf.get_pages().len()).unwrap();
        let rest = (2..=last).map(words).collect::<Vec<_>>().join(" ");
        for text in
            ["Measured beside computed", "strikes□.csv", "Restitution 0.", "0.25 to 0.4", "The data do not tell"]
        {
            assert!(rest.contains(text), "{text}: {rest}");
        }
    }

    #[test]
    fn names_of_any_kind_print_as_they_are_or_as_boxes() {
        let dir = tempfile::tempdir().unwrap();
        let hostile = r#"#eval(\"x\") $ *b* _c_ @d <e> \\ `f` // g ־שלום 漢字 😀 \u0001"#;
        let text = EXAMPLE
            .replace("name = \"camera\"", &format!("name = \"{hostile}\""))
            .replace("name = \"crystal\"", "name = \"基板\"")
            .replace("name = \"display\"", &format!("name = \"{}\"", "d".repeat(100_000)));
        let pdf = pages(&text, &dir.path().join("report.pdf"));
        let plain: String = said(&pdf, 1).chars().filter(|c| !c.is_whitespace()).collect();
        assert!(plain.contains(r#"#eval("x")$*b*_c_@d<e>\`f`//g"#), "{plain}");
        assert!(plain.contains("dddd…") && plain.contains("□□"), "{plain}");
    }

    /// Each of these would fail the page: a mark that combines, one that surrounds, a sign next to accented Greek.
    #[test]
    fn names_that_cannot_be_set_are_drawn_as_boxes_and_told() {
        let dir = tempfile::tempdir().unwrap();
        let to = dir.path().join("report.pdf");
        let text = EXAMPLE
            .replace("name = \"camera\"", "name = \"C\u{485}amera ∰ ή\"")
            .replace("name = \"crystal\"", "name = \"ῥ∰ά\"")
            .replace("name = \"display\"", "name = \"display \u{488}\"");
        let file = ProductFile::read(&text, "test.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        let pages = Pages {
            file: &file,
            assessment: &assessment,
            portraits: &portraits,
            remedies: &[],
            measured: &[],
            path: "C\u{485}.toml",
            date: None,
        };
        let warnings = crate::write_assessment(&pages, &to, &mut |_| ()).unwrap();
        assert!(warnings.iter().any(|warning| warning.contains("drawn as boxes")), "{warnings:?}");
        let first: String = said(&lopdf::Document::load(&to).unwrap(), 1).split_whitespace().collect();
        for name in ["C□amera□ή", "□□ά", "display□"] {
            assert!(first.contains(name), "{name}: {first}");
        }
    }

    #[test]
    fn two_runs_give_the_same_bytes() {
        let dir = tempfile::tempdir().unwrap();
        let bytes = |name: &str| {
            pages(EXAMPLE, &dir.path().join(name));
            std::fs::read(dir.path().join(name)).unwrap()
        };
        assert!(bytes("a.pdf") == bytes("b.pdf"), "two runs differ");
    }
}
