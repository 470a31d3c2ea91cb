//! The pages of an assessment: verdict first, then each part.

use clatter::End;
use clatter_scene::design::{Lever, Outcome, Remedy};
use clatter_scene::{
    Assessment, BarModel, ComponentAssessment, ComponentModel, Fall, First, LimitAssessment, LimitKind, Portrait,
    ProductFile, Spread, Unit, WorstCase,
};
use serde_json::{Value, json};

use crate::figure::component::{history, over_tilt, shares};
use crate::figure::product::{Place, product};
use crate::figure::shock::three;
use crate::paper;

/// Longest name in a running text; the figures cut theirs to the room there is.
const LONGEST_NAME: usize = 60;

/// What the models leave out, in plain words.
const NOT_COVERED: [[&str; 2]; 7] = [
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
        "Parts that act back",
        "A part is light beside the product: it is driven by the motion of the case and does not change it.",
    ],
    [
        "Springs that stiffen",
        "A suspension is linear up to its rattle space. What happens when it strikes its stop is not followed: that is why the stroke is a limit.",
    ],
    ["Damage by repetition", "Each limit is on the worst moment of one drop. Fatigue over many drops is not counted."],
    ["Restitution", "e is a number within the range given. Real edges dent, and their e falls with speed."],
];

/// A value in the unit that engineers use for it.
fn shown(unit: Unit, value: f64) -> String {
    let (factor, name) = customary(unit);
    format!("{} {name}", three(value / factor))
}

/// What one customary unit is in SI, and its name.
fn customary(unit: Unit) -> (f64, &'static str) {
    match unit {
        Unit::MeterPerSecondSquared => (clatter_scene::STANDARD_GRAVITY_M_S2, "gn"),
        Unit::Meter => (1e-3, "mm"),
        Unit::MeterPerSecond => (1.0, "m/s"),
        Unit::RadianPerSecond => (1.0, "rad/s"),
    }
}

fn words(limit: LimitKind) -> &'static str {
    match limit {
        LimitKind::Acceleration => "acceleration",
        LimitKind::RattleSpace => "rattle space",
        LimitKind::VelocityChange => "velocity change",
        LimitKind::AngularVelocityChange => "angular velocity change",
        LimitKind::DamageBoundary => "damage boundary",
    }
}

/// As a signed share of a hundred.
fn percent(share: f64) -> String {
    if share.is_infinite() {
        return "no demand".to_owned();
    }
    let whole = 100.0 * share;
    let text = if whole.abs() < 9.95 { format!("{whole:+.1}\u{a0}%") } else { format!("{whole:+.0}\u{a0}%") };
    text.replace('-', "−")
}

fn millimeters(m: f64) -> String {
    format!("{} mm", three(1e3 * m)).replace('-', "−")
}

/// A name for running text: cut where it is endless, with a box for every character that the pages' typefaces lack.
fn name(text: &str) -> String {
    let printable = |c: char| {
        let known = matches!(u32::from(c), 0x20..=0x7e | 0xa0..=0x24f | 0x370..=0x3ff | 0x400..=0x4ff | 0x5d0..=0x5ea
            | 0x2010..=0x2027 | 0x2030..=0x203a | 0x20ac | 0x2122 | 0x2190..=0x2193 | 0x2200..=0x22ff);
        let defined =
            !matches!(u32::from(c), 0x378 | 0x379 | 0x380..=0x383 | 0x38b | 0x38d | 0x3a2 | 0x3cf..=0x3ff | 0xad);
        if c.is_whitespace() {
            ' '
        } else if known && defined {
            c
        } else {
            '□'
        }
    };
    let mut cut: String = text.chars().take(LONGEST_NAME).map(printable).collect();
    if text.chars().nth(LONGEST_NAME).is_some() {
        cut.push('…');
    }
    cut
}

fn end(end: End) -> &'static str {
    match end {
        End::A => "a",
        End::B => "b",
    }
}

/// "0.9 to 1.2 m", or one value.
fn range(spread: &Spread, factor: f64, unit: &str) -> String {
    let (lo, hi) = (three(spread.lo() / factor), three(spread.hi() / factor));
    if lo == hi { format!("{lo} {unit}") } else { format!("{lo} to {hi} {unit}") }
}

/// The drop in a sentence.
fn drop(file: &ProductFile) -> String {
    let fall = match file.drop.fall {
        Fall::HeightM(h) => {
            let [slow, fast] = file.drop.speeds_m_s().map(three);
            let speed = if slow == fast { slow } else { format!("{slow} to {fast}") };
            format!("From {}, which gives {speed} m/s", range(&h, 1.0, "m"))
        }
        Fall::SpeedMS(v) => format!("At {}", range(&v, 1.0, "m/s")),
    };
    let tilt = range(&file.drop.tilt_rad, 1f64.to_radians(), "°").replace(" °", "°");
    let first = match file.drop.first {
        First::End(end_) => format!("end {} first", end(end_)),
        First::Either => "either end first".to_owned(),
    };
    let gravity = if file.drop.gravity_m_s2 > 0.0 {
        format!("gravity {} m/s² after the first touch", three(file.drop.gravity_m_s2))
    } else {
        "no gravity after the first touch".to_owned()
    };
    format!("{fall}, tilted by {tilt}, {first}; {gravity}.")
}

/// The product in a sentence.
fn body(file: &ProductFile) -> String {
    let product = &file.product;
    let [a, b] = product.body.arms_m();
    let center = 0.5 * (a - b);
    let off = if center.abs() > 1e-9 * (a + b) {
        format!(", center of mass {} from the middle", millimeters(center))
    } else {
        String::new()
    };
    let contact = match product.contact_time_s {
        Some(t) => format!("; an end touches for {} ms", three(1e3 * t)),
        None => "; contacts are taken as instants".to_owned(),
    };
    format!(
        "Length {}, radius of gyration {}{off}: inertia ratio q = {}. Restitution {}{contact}.",
        millimeters(product.body.length_m()),
        millimeters(product.body.gyration_m()),
        three(product.inertia_ratio()),
        range(&product.restitution, 1.0, "").trim_end(),
    )
}

fn models(limit: &LimitAssessment) -> String {
    let bar = match limit.model.bar {
        BarModel::Map => "impact map",
        BarModel::Ballistic => "ballistic",
        BarModel::FiniteTilt => "finite tilt",
        BarModel::Compliant => "compliant contact",
    };
    let component = match limit.model.component {
        ComponentModel::LargestShock => "largest shock",
        ComponentModel::ImpulseTrain => "impulse train",
        ComponentModel::PulseTrain => "pulse train",
        ComponentModel::Base => "pulses of the case itself",
    };
    let within = if limit.tolerance < 5e-4 {
        "less than 0.1\u{a0}%".to_owned()
    } else if limit.tolerance == f64::INFINITY {
        "no known share: the models are far off".to_owned()
    } else {
        percent(limit.tolerance).replace('+', "")
    };
    let how = if limit.guaranteed {
        format!("Proven over the whole ranges, to {within}.")
    } else {
        format!("Searched, to {within}.")
    };
    let warning = limit.warning.as_ref().map_or(String::new(), |warning| format!(" But {warning}."));
    format!("{bar}, {component}: {}. {how}{warning}", limit.model.reason.trim_end_matches('.'))
}

fn place(worst: &WorstCase) -> String {
    millimeters(worst.position_m)
}

/// What would make a failing part safe, one change at a time.
fn remedies(remedies: &[Remedy]) -> String {
    let what = |lever: Lever| match lever {
        Lever::InertiaRatio => "the inertia ratio q",
        Lever::Restitution => "the restitution e",
        Lever::Position => "its place",
        Lever::Frequency => "its natural frequency",
        Lever::Damping => "its damping ratio",
    };
    let value = |lever: Lever, of: [f64; 2], between: &str| {
        let (size, unit) = match lever {
            Lever::Position => (1e3, " mm"),
            Lever::Frequency => (1.0, " Hz"),
            _ => (1.0, ""),
        };
        let [lo, hi] = of.map(|v| three(size * v).replace('-', "−"));
        if lo == hi { format!("{lo}{unit}") } else { format!("{lo}{between}{hi}{unit}") }
    };
    let (mut enough, mut not) = (Vec::new(), Vec::new());
    for Remedy { lever, outcome } in remedies {
        match outcome {
            Outcome::Change { from, to, .. } => {
                let bound = if to[0] < from[0] { "down" } else { "up" };
                enough.push(format!(
                    "{} {bound} from {} to {}",
                    what(*lever),
                    value(*lever, *from, "–\u{2060}"),
                    value(*lever, *to, "–\u{2060}")
                ));
            }
            Outcome::Nowhere { bounds } => not.push(format!("{} ({})", what(*lever), value(*lever, *bounds, " to "))),
            Outcome::NoEffect => {}
        }
    }
    let alone = match &enough[..] {
        [] => String::new(),
        changes => format!(" One of these alone would make it safe: {}.", changes.join("; ")),
    };
    let rest = match (&not[..], enough.is_empty()) {
        ([], _) => String::new(),
        (levers, true) => format!(" No single change is enough: {}.", levers.join("; ")),
        (levers, false) => format!(" Not enough alone, whatever it is: {}.", levers.join("; ")),
    };
    alone + &rest
}

/// What the page says of one part.
fn part(part: &ComponentAssessment, portrait: &Portrait) -> Value {
    let safe = part.limits.iter().all(LimitAssessment::is_safe);
    let tightest = part.tightest();
    let worst = &tightest.worst_case;
    let (who, what) = (name(&part.name), words(tightest.limit));
    let frequency = worst.frequency_hz.map(|f| format!(" at {} Hz", three(f))).unwrap_or_default();
    let summary = format!(
        "It sits {} from the middle, towards end {}. The tightest limit is its {what}: {} is allowed, and the worst drop asks for {} ({}). \
         That drop lands on end {} at {} m/s, tilted by {}°, with e = {}{frequency}; {}",
        millimeters(part.position_m.abs()),
        if part.position_m < 0.0 { "a" } else { "b" },
        shown(tightest.unit, tightest.allowed),
        shown(tightest.unit, tightest.demand),
        percent(tightest.margin),
        end(worst.first),
        three(worst.speed_m_s),
        three(worst.tilt_deg),
        three(worst.restitution),
        if worst.impact > 1 {
            format!("the peak comes after impact {}, not after the first.", worst.impact)
        } else {
            "the peak comes after the first impact.".to_owned()
        },
    );
    let zone = match portrait.zone_m {
        Some([lo, hi]) if lo < hi => {
            format!(" Its middle could sit anywhere from {} to {} and be safe.", millimeters(lo), millimeters(hi))
        }
        Some(_) => String::new(),
        None => " Nowhere along the product would it be safe.".to_owned(),
    };
    let limits = part.limits.iter().map(|l| {
        json!({
            "name": words(l.limit), "allowed": shown(l.unit, l.allowed), "demand": shown(l.unit, l.demand),
            "margin": percent(l.margin), "safe": l.is_safe(), "first": end(l.worst_case.first),
            "tilt": format!("{}°", three(l.worst_case.tilt_deg)), "speed": format!("{} m/s", three(l.worst_case.speed_m_s)),
            "restitution": three(l.worst_case.restitution), "place": place(&l.worst_case), "impact": l.worst_case.impact.to_string(),
            "models": models(l),
        })
    });
    let allowed = shown(tightest.unit, tightest.allowed);
    let limit_seen = if tightest.demand > tightest.allowed / 3.0 {
        format!(" Dash-dotted: the limit of {allowed}.")
    } else {
        format!(" The limit, {allowed}, lies outside the figure.")
    };
    json!({
        "name": who,
        "safe": safe,
        "position": millimeters(part.position_m),
        "summary": summary + &zone + &remedies(&portrait.remedies),
        "limits": limits.collect::<Vec<_>>(),
        "history": format!("The {what} over time in that drop; red ticks are impacts.{limit_seen}"),
        "history-alt": format!("Curve of the {what} of this part over time in its worst drop, with the impacts marked at the foot."),
        "tilt": format!("The {what} asked at each tilt, at the worst speed and restitution.{limit_seen}"),
        "tilt-alt": format!("Curve of the worst {what} over the tilt at the first touch."),
    })
}

/// The files of the pages: figures and data.
pub(crate) fn files(file: &ProductFile, assessment: &Assessment, portraits: &[Portrait]) -> Vec<(String, String)> {
    let parts = || assessment.components.iter().zip(&file.components).zip(portraits);
    let margins: Vec<String> = assessment.components.iter().map(|c| percent(c.tightest().margin)).collect();
    let names: Vec<String> = assessment.components.iter().map(|c| name(&c.name)).collect();
    let places: Vec<Place<'_>> = parts()
        .zip(names.iter().zip(&margins))
        .map(|(((assessed, component), portrait), (name, margin))| Place {
            name,
            from_m: component.position_m - 0.5 * component.extent_m,
            to_m: component.position_m + 0.5 * component.extent_m,
            safe: assessed.limits.iter().all(LimitAssessment::is_safe),
            word: margin,
            zone_m: portrait.zone_m,
        })
        .collect();
    let mut files =
        vec![("product.svg".into(), product(file.product.body.arms_m(), file.product.body.gyration_m(), &places))];
    for (i, ((assessed, _), portrait)) in parts().enumerate() {
        let tightest = assessed.tightest();
        let (factor, unit) = customary(tightest.unit);
        let title = format!("{}, {unit}", words(tightest.limit));
        let points: Vec<(f64, f64)> = portrait.history.iter().map(|p| (1e3 * p.0, p.1 / factor)).collect();
        let impacts: Vec<f64> = portrait.impacts_s.iter().map(|t| 1e3 * t).collect();
        let allowed = tightest.allowed / factor;
        files.push((format!("history-{}.svg", i + 1), history(&points, &impacts, allowed, ["time, ms", &title])));
        let curves: Vec<(&str, Vec<(f64, f64)>)> = portrait
            .over_tilt
            .iter()
            .map(|(first, curve)| {
                let points = curve.iter().map(|p| (p.0.to_degrees(), p.1 / factor)).collect();
                (if *first == End::A { "end *a* first" } else { "end *b* first" }, points)
            })
            .collect();
        files.push((format!("tilt-{}.svg", i + 1), over_tilt(&curves, allowed, ["tilt, degrees", &title])));
    }
    let lines: Vec<(String, Vec<(f64, f64)>)> = parts()
        .zip(&names)
        .map(|(((assessed, _), portrait), name)| {
            let allowed = assessed.tightest().allowed;
            let mut points: Vec<(f64, f64)> = Vec::new();
            for (i, (_, curve)) in portrait.over_tilt.iter().enumerate() {
                let curve = curve.iter().map(|p| (p.0.to_degrees(), p.1 / allowed));
                if i == 0 {
                    points = curve.collect();
                } else {
                    points.iter_mut().zip(curve).for_each(|(p, q)| p.1 = p.1.max(q.1));
                }
            }
            (name.clone(), points)
        })
        .collect();
    files.push(("shares.svg".into(), shares(&lines)));
    let by_margin =
        |a: &&ComponentAssessment, b: &&ComponentAssessment| a.tightest().margin.total_cmp(&b.tightest().margin);
    let hardest = assessment.components.iter().min_by(by_margin);
    let open = assessment.components.iter().zip(&names).filter(|(c, _)| c.tightest().warning.is_some());
    let data = json!({
        "open": open.map(|(_, name)| name).collect::<Vec<_>>(),
        "hardest": hardest.map(|c| json!({"name": name(&c.name), "margin": percent(c.tightest().margin)})),
        "product": name(&assessment.product),
        "safe": assessment.components.iter().all(|c| c.limits.iter().all(LimitAssessment::is_safe)),
        "parts": parts().map(|((assessed, _), portrait)| part(assessed, portrait)).collect::<Vec<_>>(),
        "drop": drop(file),
        "body": body(file),
        "drawing": places.iter().map(|p| format!("{}: {}.", p.name, p.word)).collect::<Vec<_>>().join(" "),
        "limits-of-the-model": NOT_COVERED,
    });
    files.push(("assessment.json".into(), data.to_string()));
    files.push(("page.json".into(), paper::page()));
    files
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_scene::EXAMPLE;

    fn pages(text: &str, to: &std::path::Path) -> lopdf::Document {
        let file = ProductFile::read(text, "test.toml").unwrap();
        let assessment = file.assess().unwrap();
        let portraits = file.portraits(&assessment).unwrap();
        crate::write_assessment(&file, &assessment, &portraits, to, &mut |_| ()).unwrap();
        lopdf::Document::load(to).unwrap()
    }

    fn said(pdf: &lopdf::Document, page: u32) -> String {
        pdf.extract_text(&[page]).unwrap()
    }

    #[test]
    fn a_failing_part_is_told_what_would_make_it_safe() {
        let file = ProductFile::read(include_str!("../../../reports/examples/phone.toml"), "phone.toml").unwrap();
        let portraits = file.portraits(&file.assess().unwrap()).unwrap();
        let [board, camera, crystal] = [0, 1, 2].map(|i| remedies(&portraits[i].remedies));
        assert!(camera.is_empty(), "{camera}");
        assert!(
            crystal.starts_with(" One of these alone would make it safe: ") && !crystal.contains("Not enough"),
            "{crystal}"
        );
        assert!(crystal.contains("its place down from 30 mm to 2") && !crystal.contains("frequency"), "{crystal}");
        assert!(board.contains("its natural frequency down from 200–\u{2060}240 Hz to 13"), "{board}");
        assert!(
            board.contains("Not enough alone, whatever it is: ") && board.contains("its place (−40 to 40 mm)"),
            "{board}"
        );
    }

    #[test]
    fn the_verdict_stands_on_the_first_page_and_every_part_has_a_section() {
        let dir = tempfile::tempdir().unwrap();
        let pdf = pages(EXAMPLE, &dir.path().join("report.pdf"));
        let first = said(&pdf, 1);
        for word in ["Handheld", "display", "camera", "crystal", "Margin"] {
            assert!(first.contains(word), "{word} is not on the first page: {first}");
        }
        let rest: String = (2..=u32::try_from(pdf.get_pages().len()).unwrap()).map(|page| said(&pdf, page)).collect();
        for word in ["display", "camera", "crystal", "does not cover"] {
            assert!(rest.contains(word), "{word} has no section: {rest}");
        }
    }

    #[test]
    fn names_of_any_kind_print_as_they_are_or_as_boxes() {
        let dir = tempfile::tempdir().unwrap();
        let short = EXAMPLE.replace("name = \"camera\"", "name = \"基板\"");
        assert!(said(&pages(&short, &dir.path().join("short.pdf")), 1).contains("□□"), "boxes");
        let hostile = r#"#eval(\"x\") $ *b* _c_ @d <e> \\ `f` // g ־שלום 漢字 😀 \u0001"#;
        let text = EXAMPLE
            .replace("name = \"camera\"", &format!("name = \"{hostile}\""))
            .replace("name = \"display\"", &format!("name = \"{}\"", "d".repeat(100_000)));
        let pdf = pages(&text, &dir.path().join("report.pdf"));
        let plain: String = said(&pdf, 1).chars().filter(|c| !c.is_whitespace()).collect();
        assert!(plain.contains(r#"#eval("x")$*b*_c_@d<e>\`f`//g"#), "{plain}");
        assert!(plain.contains("dddd…"), "{plain}");
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

    #[test]
    fn margins_are_signed() {
        assert_eq!(
            [0.0, -0.031, 0.5, f64::INFINITY].map(percent),
            ["+0.0\u{a0}%", "−3.1\u{a0}%", "+50\u{a0}%", "no demand"]
        );
    }
}
