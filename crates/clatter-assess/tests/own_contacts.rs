//! Products whose ends or corners have contacts of their own.

use clatter::End;
use clatter_assess::{
    Accuracy, Assessment, Part, Verdict, answer,
    design::{Bounds, Plane},
    scatter::{Column, Sampler, Settings},
};
use clatter_flight::Body;
use clatter_product::{
    DataFault, Drop, Error, Input, Limit, LimitKind, Model, OwnContact, OwnContacts, Plan, ProductFile,
};

/// A drill of 300 mm on its side, a soft bumper at end b; the part is on that side of it.
const BAR: &str = r#"
product = { name = "drill", length = "300 mm", radius_of_gyration = "90 mm", center_of_mass = "10 mm", restitution = [0.3, 0.4], contact_time = "0.5 ms", contact_law = "hysteretic", contacts = [{ at = "b", restitution = 0.1, contact_time = "1.5 ms" }] }
drop = { height = "1 m", tilt = ["1 deg", "9 deg"], first = "either" }
component = [
    { name = "drive", position = "60 mm", natural_frequency = "150 Hz", damping_ratio = 0.1, acceleration_limit = "900 gn" },
    { name = "crystal", position = "100 mm", mount = "hard", acceleration_limit = "9000 gn", velocity_change_limit = "12 m/s" },
]
"#;

/// A tablet with one soft corner, which rises away from it.
const PLATE: &str = r#"
product = { name = "tablet", length = "240 mm", width = "170 mm", radius_of_gyration = ["69 mm", "49 mm"], restitution = 0.3, contact_time = "0.6 ms", contact_law = "hysteretic", contacts = [{ at = "a", restitution = 0.05, contact_time = "2 ms" }] }
drop = { height = "1 m", tilt = ["1 deg", "6 deg"], direction = ["20 deg", "50 deg"] }
component = [{ name = "crystal", position = ["-60 mm", "30 mm"], mount = "hard", acceleration_limit = "9000 gn", velocity_change_limit = "12 m/s" }]
"#;

fn read(text: &str) -> ProductFile {
    ProductFile::read(text, "product.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

fn assess(text: &str) -> Assessment {
    clatter_assess::assess(&read(text)).expect("an assessment")
}

fn demands(assessment: &Assessment) -> Vec<f64> {
    let limits = assessment.components.iter().flat_map(|part| &part.limits);
    limits.map(|limit| limit.demand.expect("an answer")).collect()
}

fn alike(one: &[f64], other: &[f64], within: f64) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a / b - 1.0).abs() < within)
}

/// Contacts that are given one by one as the product has them change nothing, to the last bit.
#[test]
fn contacts_that_are_those_of_the_product_change_nothing() {
    let value = BAR.replace("[0.3, 0.4]", "0.3");
    let given = "contacts = [{ at = \"b\", restitution = 0.1, contact_time = \"1.5 ms\" }]";
    let none = value.replace(&format!(", {given}"), "");
    let same = value
        .replace(given, "contacts = [{ at = \"a\", restitution = 0.3 }, { at = \"b\", contact_time = \"0.5 ms\" }]");
    assert!(!none.contains("contacts") && same.contains("at = \"a\""));
    let [none, same, own] = [&none, &same, &value].map(|text| demands(&assess(text)));
    assert_eq!(
        none.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
        same.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
    );
    assert!(!alike(&none, &own, 0.01), "a bumper counts: {own:?} beside {none:?}");
}

/// Seen from behind, or from the other corner, it is the same product.
#[test]
fn a_mirrored_product_has_the_same_answers() {
    let turned = BAR
        .replace("center_of_mass = \"10 mm\"", "center_of_mass = \"-10 mm\"")
        .replace("at = \"b\"", "at = \"a\"")
        .replace("position = \"", "position = \"-");
    assert!(alike(&demands(&assess(BAR)), &demands(&assess(&turned)), 1e-6));
    let turned = PLATE
        .replace("[\"20 deg\", \"50 deg\"]", "[\"200 deg\", \"230 deg\"]")
        .replace("at = \"a\"", "at = \"c\"")
        .replace("[\"-60 mm\", \"30 mm\"]", "[\"60 mm\", \"-30 mm\"]");
    let [one, other] = [PLATE, &turned].map(assess);
    assert!(alike(&demands(&one), &demands(&other), 1e-6), "{:?} {:?}", demands(&one), demands(&other));
    let elsewhere = demands(&assess(&PLATE.replace("at = \"a\"", "at = \"c\"")));
    assert!(!alike(&demands(&one), &elsewhere, 0.01), "{elsewhere:?}");
}

/// Of a body that is even but for its bumper neither end first stands for the other.
#[test]
fn either_end_first_is_the_worse_of_both() {
    let even = BAR.replace("center_of_mass = \"10 mm\", ", "");
    let of = |first: &str| demands(&assess(&even.replace("\"either\"", first)));
    let [a, b, both] = ["\"a\"", "\"b\"", "\"either\""].map(of);
    for ((a, b), both) in a.iter().zip(&b).zip(&both) {
        // The search climbs from the worst of all.
        assert!((both / a.max(*b) - 1.0).abs() < 0.02, "{both}, {a} and {b}");
    }
    assert!(!alike(&a, &b, 0.01), "{a:?} {b:?}");
}

fn drop(first: End) -> Drop {
    let own = OwnContact { restitution: Some(0.1), contact_time_s: Some(1.5e-3) };
    Drop {
        direction_rad: Drop::towards(first),
        gravity_m_s2: 0.0,
        contact_time_s: Some(4e-4),
        own_contacts: OwnContacts([OwnContact::NONE, own, OwnContact::NONE, OwnContact::NONE]),
        ..Drop::new(Body::new(0.3, 0.15).unwrap(), 2.0, 0.05, 0.4)
    }
}

/// Of a bar with ρ = L, whose far end does nothing to it, the end that lands gets (1 + e) v at π/2 (1 + e) v/τ by its own contact.
#[test]
fn the_end_that_lands_gets_what_its_own_contact_gives() {
    for (first, e, time_s, place) in [(End::A, 0.4, 4e-4, -0.15), (End::B, 0.1, 1.5e-3, 0.15)] {
        let of = |kind| {
            let limit = Limit::new(kind, 1.0);
            answer(&drop(first), &Part::new(place, None), &limit, Model::Compliant, 1e-3).unwrap()
        };
        let [change, peak] = [LimitKind::VelocityChange, LimitKind::Acceleration].map(of);
        // Tilted by 0.05 the ends couple by 3e-3, of which the far end lands on its harder contact.
        assert!((change.value / (2.0 * (1.0 + e)) - 1.0).abs() < 1e-3 && change.impact == 1, "{first:?}: {change:?}");
        let most = std::f64::consts::FRAC_PI_2 * (1.0 + e) * 2.0 / time_s;
        assert!((peak.value / most - 1.0).abs() < 2e-3, "{first:?}: {peak:?}, not {most}");
    }
    let limit = Limit::new(LimitKind::VelocityChange, 1.0);
    let said = answer(&drop(End::A), &Part::new(0.1, None), &limit, Model::FiniteTilt, 1e-3).unwrap_err();
    assert_eq!(said, Error::OwnContacts(Model::FiniteTilt));
}

/// A handheld with a soft bumper around one corner.
const BOX: &str = r#"
product = { name = "handheld", length = "150 mm", width = "70 mm", thickness = "14 mm", friction = 0, radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.3, contact_time = "0.4 ms", contact_law = "hysteretic", contacts = [{ at = "b", restitution = 0.1, contact_time = "1.2 ms" }] }
drop = { height = "1 m", corner = ["bottom front end-b", "top front end-b", "bottom back end-b"] }
component = [{ name = "crystal", position = ["75 mm", "-35 mm"], height = "-7 mm", axis = "any", mount = "hard", acceleration_limit = "9000 gn", velocity_change_limit = "20 m/s" }]
"#;

/// Both corners of a box at b land on the bumper, that at c does not: what lands is pressed as by a box whose contacts are all like its own, up to
/// its peak, where nothing else has touched.
#[test]
fn corners_of_a_box_over_one_another_have_one_contact() {
    let file = read(BOX);
    let of = |text: &str, corner: &str| {
        let three = "[\"bottom front end-b\", \"top front end-b\", \"bottom back end-b\"]";
        let assessment = assess(&text.replace(three, &format!("\"{corner}\", attitude_tolerance = \"0.5 deg\"")));
        demands(&assessment)[0]
    };
    let given = "contacts = [{ at = \"b\", restitution = 0.1, contact_time = \"1.2 ms\" }]";
    assert!(BOX.contains(given) && file.is_box());
    let all_soft = BOX.replace(given, "").replace("0.3, contact", "0.1, contact").replace("0.4 ms", "1.2 ms");
    let all_hard = BOX.replace(given, "");
    for (corner, alike) in [
        ("bottom front end-b", &all_soft),
        ("top front end-b", &all_soft),
        ("bottom back end-b", &all_hard),
        ("top back end-a", &all_hard),
    ] {
        // The crystal sits in a corner of the bottom: it feels most there, of the first press.
        let [own, alike] = [BOX, alike].map(|text| {
            let place = match corner {
                "top front end-b" => "[\"75 mm\", \"-35 mm\"], height = \"7 mm\"",
                "bottom back end-b" => "[\"75 mm\", \"35 mm\"], height = \"-7 mm\"",
                "top back end-a" => "[\"-75 mm\", \"35 mm\"], height = \"7 mm\"",
                _ => "[\"75 mm\", \"-35 mm\"], height = \"-7 mm\"",
            };
            of(&text.replace("[\"75 mm\", \"-35 mm\"], height = \"-7 mm\"", place), corner)
        });
        // Straight over a corner that is pressed alone; a search leaves 10 %, both take the same drops.
        assert!((own / alike - 1.0).abs() < 1e-6, "{corner}: {own}, not {alike}");
    }
}

/// Turned upside down about its length, a box has b where d was: the same product lands on the other corners.
#[test]
fn a_box_that_is_turned_over_has_the_same_answers() {
    let turned = BOX
        .replace("at = \"b\"", "at = \"c\"")
        .replace("[\"75 mm\", \"-35 mm\"], height = \"-7 mm\"", "[\"75 mm\", \"35 mm\"], height = \"7 mm\"")
        .replace("\"bottom front end-b\"", "\"top BACK end-b\"")
        .replace("\"top front end-b\"", "\"bottom BACK end-b\"")
        .replace("\"bottom back end-b\"", "\"top front end-b\"")
        .replace("BACK", "back");
    // Its landing, which rebounds do not exceed in acceleration; velocity changes of later falls hang on every input.
    let [one, other] = [BOX, &turned].map(|text| demands(&assess(text))[0]);
    assert!((one / other - 1.0).abs() < 1e-3, "{one}, {other}");
    let elsewhere = demands(&assess(&BOX.replace("at = \"b\"", "at = \"c\"")));
    assert!((elsewhere[0] / one - 1.0).abs() > 0.05, "{elsewhere:?} beside {one}");
}

/// No drop exceeds what the energy allows by the stiffest of all contacts, and what is called safe has room for it.
#[test]
fn demands_are_within_what_energy_allows() {
    for text in [BAR, PLATE, BOX] {
        for limit in assess(text).components.iter().flat_map(|part| &part.limits) {
            let within = limit.bound.is_none_or(|bound| limit.demand.unwrap() <= bound);
            assert!(within && limit.verdict == Verdict::Safe, "{limit:?}");
            let own = limit.worst_case.as_ref().unwrap().drop.own_contacts;
            assert!(!own.is_none() && limit.other_law.is_none(), "followed with its contacts, by their law alone");
        }
    }
    // A bumper that is harder than the product counts in the bound too.
    let hard =
        PLATE.replace("restitution = 0.05, contact_time = \"2 ms\"", "restitution = 0.6, contact_time = \"0.1 ms\"");
    let [soft, hard] = [PLATE, &hard].map(|text| assess(text).components[0].limits[0].bound.unwrap());
    assert!(hard > 2.0 * soft, "{hard}, {soft}");
}

/// What knows no contacts of their own says so.
#[test]
fn what_takes_contacts_that_are_alike_says_so() {
    let file = read(BAR);
    let accuracy = Accuracy { model: Some(Model::Map), ..Accuracy::default() };
    assert_eq!(clatter_assess::assess_to(&file, &accuracy).unwrap_err(), Error::OwnContacts(Model::Map));
    let plane = Plane::of(&file, &Bounds::default()).unwrap_err().to_string();
    assert!(plane.contains("takes a product whose contacts are alike"), "{plane}");
    let mut lively = read(PLATE);
    lively.product.own_contacts.0[2].restitution = Some(1.5);
    let Err(Error::Data { fault: DataFault::Value { field: "restitution", .. }, .. }) = lively.check() else {
        panic!("{:?}", lively.check())
    };
    let mut dashpot = file;
    dashpot.product.contact_law = None;
    assert_eq!(dashpot.check(), Err(DataFault::OwnContactsLaw.into()));
}

/// A study varies a contact by its place.
#[test]
fn a_grid_varies_a_contact() {
    let plan = "product = \"p.toml\"\nsearch = true\n[grid]\nproduct.contacts.b.restitution = [0.05, 0.2]";
    let family = Plan::read(plan, "plan.toml").unwrap().family(BAR, "p.toml").unwrap();
    let own = |k: u64| family.member(k).unwrap().product.own_contacts.0[1].restitution;
    assert_eq!((own(0), own(1)), (Some(0.05), Some(0.2)));
}

/// One message each, with what is allowed.
#[test]
fn each_fault_of_a_contact_is_told() {
    let given = "{ at = \"b\", restitution = 0.1, contact_time = \"1.5 ms\" }";
    let contact = |other: &str| BAR.replace(given, other);
    let record = BAR.replace("component = [", "record = [{ file = \"x.csv\" }]\ncomponent = [");
    for (text, said) in [
        (contact("{ at = \"e\", restitution = 0.1 }"), "`at` cannot be \"e\""),
        (contact("{ restitution = 0.1 }"), "[[contacts]] 1 has no `at`"),
        (contact("{ at = \"b\", restitutoin = 0.1 }"), "did you mean `restitution`?"),
        (contact("{ at = \"b\" }"), "give its `restitution`, its `contact_time`, or both"),
        (contact("{ at = \"b\", restitution = 0.1 }, { at = \"b\", restitution = 0.2 }"), "two contacts are at \"b\""),
        (contact("{ at = \"b\", restitution = 1.1 }"), "`restitution` = 1.1 is out of its range"),
        (contact("{ at = \"b\", restitution = [0.1, 0.2] }"), "`restitution` cannot be this array"),
        (contact("{ at = \"b\", contact_time = \"0 ms\" }"), "`contact_time` = \"0 ms\" is out of its range"),
        (contact("{ at = \"c\", restitution = 0.1 }"), "a product without `width` has no contact at \"c\""),
        (BAR.replace(", contact_time = \"0.5 ms\"", ""), "need the `contact_time` of the others"),
        (BAR.replace("contact_law = \"hysteretic\", ", ""), "add contact_law = \"hysteretic\""),
        (BAR.replace("contact_law = \"hysteretic\"", "contact_law = \"dashpot\""), "dashpots that differ couple"),
        (record, "leave one of `record` and `contacts` out"),
    ] {
        let faults = ProductFile::read(&text, "product.toml").expect_err("a bad file");
        // A key that is meant otherwise leaves its contact without what it has.
        let most = if said.contains("did you mean") { 2 } else { 1 };
        assert!(faults.to_string().contains(said) && faults.list().len() <= most, "{said}: {faults}");
    }
}

/// A sample is the drop that its inputs say, with the contacts of the product: those without would fail at other drops.
#[test]
fn samples_have_the_contacts_of_the_product() {
    let file = read(BAR);
    let settings = Settings { samples: 40, seed: 1, confidence: 0.95, merge_s: 1e-12 };
    let inputs = [Input::First, Input::Tilt, Input::Restitution];
    let columns = inputs.map(|input| Column::Drop(input, None));
    let (part, limits) = (Part::new(0.1, None), Limit::of(&file.components[1]));
    let mut apart = 0;
    for (drawn, asked) in Sampler::new(&file, settings).unwrap().rows(0..40, &columns, &|_| ()) {
        let first = if drawn[0] < 0.5 { End::A } else { End::B };
        let drop = file.one_drop(first, |row, given| {
            inputs.iter().position(|input| *input == row.input).map_or(given.hi(), |i| drawn[i])
        });
        let of = |drop: &Drop| {
            let used =
                limits.iter().map(|limit| answer(drop, &part, limit, Model::Compliant, 0.005).unwrap().utilization());
            used.fold(0.0, f64::max)
        };
        let (found, known) = (asked[1].as_ref().unwrap().utilization, of(&drop));
        assert!((found / known - 1.0).abs() < 0.01, "{drawn:?}: {found}, not {known}");
        apart += u32::from((of(&Drop { own_contacts: OwnContacts::NONE, ..drop }) / known - 1.0).abs() > 0.1);
    }
    assert!(apart >= 10, "{apart}");
}
