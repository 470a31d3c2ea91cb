//! Several drops of a bar or a plate in one file, against each of them alone.

use clatter_assess::{
    LimitAssessment, Verdict,
    design::{Bounds, Lever, Outcome},
    scatter::{Column, Progress, Sampler, Settings},
};
use clatter_product::{DropName, Error, Input, ProductFile, Spread};

const BAR: &str = r#"
product = { name = "terminal", length = "140 mm", radius_of_gyration = "38 mm", restitution = [0.25, 0.4], contact_time = "0.4 ms" }
component = [
  { name = "display", position = "10 mm", natural_frequency = "220 Hz", quality_factor = 12, acceleration_limit = "650 gn", rattle_space = "3.2 mm" },
  { name = "camera", position = "55 mm", natural_frequency = ["90 Hz", "110 Hz"], damping_ratio = 0.1, acceleration_limit = "1000 gn", angular_velocity_change_limit = "120 rad/s" },
]
"#;

const PLATE: &str = r#"
product = { name = "terminal", length = "150 mm", width = "70 mm", thickness = "14 mm", radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.3, contact_time = "0.5 ms" }
component = [{ name = "display", position = ["30 mm", "10 mm"], natural_frequency = "180 Hz", quality_factor = 12, acceleration_limit = "1900 gn" }]
"#;

/// Of a bar: the slow one is steeper.
const FALLS: [&str; 3] = [
    "height = \"1.2 m\"\ntilt = [\"1 deg\", \"4 deg\"]\nfirst = \"a\"\n",
    "height = \"0.5 m\"\ntilt = [\"4 deg\", \"20 deg\"]\nspin = [\"-2 rad/s\", \"2 rad/s\"]\n",
    "speed = \"3 m/s\"\ntilt = \"0 deg\"\n",
];
/// Of a plate.
const RISES: [&str; 2] = [
    "height = \"1.2 m\"\ntilt = [\"1 deg\", \"4 deg\"]\n",
    "height = \"0.8 m\"\ntilt = [\"2 deg\", \"9 deg\"]\ndirection = [\"0 deg\", \"30 deg\"]\n",
];

fn listed(falls: &[&str]) -> String {
    falls.iter().fold(String::new(), |text, fall| text + "[[drop]]\n" + fall)
}

fn file(product: &str, falls: &[&str]) -> ProductFile {
    let drops = match falls {
        [one] => format!("[drop]\n{one}"),
        all => listed(all),
    };
    let text = format!("{product}{drops}");
    ProductFile::read(&text, "several.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

/// What a list asks of a limit is what one of its drops alone asks, to the last bit, by the same drop; each of them is told as alone.
#[test]
fn a_list_is_as_bad_as_the_worst_of_its_drops() {
    for (product, falls) in [(BAR, &FALLS[..]), (PLATE, &RISES[..])] {
        let list = clatter_assess::assess(&file(product, falls)).unwrap();
        let alone: Vec<_> = falls.iter().map(|fall| clatter_assess::assess(&file(product, &[fall])).unwrap()).collect();
        for (i, component) in list.components.iter().enumerate() {
            for (k, limit) in component.limits.iter().enumerate() {
                let of: Vec<&LimitAssessment> = alone.iter().map(|one| &one.components[i].limits[k]).collect();
                let verdict = of.iter().map(|one| one.verdict).max().unwrap();
                assert_eq!(limit.verdict, verdict, "{} {:?}", component.name, limit.limit);
                let worst = limit.worst_case.unwrap();
                assert_eq!(worst.landing, Some(DropName::Number(worst.listed + 1)));
                assert_eq!(limit.demand, of[worst.listed].demand);
                assert_eq!(worst.drop, of[worst.listed].worst_case.unwrap().drop);
                let least = of.iter().filter(|one| one.verdict == verdict).filter_map(|one| one.margin);
                assert_eq!(limit.margin, least.reduce(f64::min));
                // What no drop exceeds is the most of what none of each does.
                let most = |of: &LimitAssessment| of.demand.unwrap() * (1.0 + of.uncertainty);
                let of_each = of.iter().map(|one| most(one)).fold(0.0, f64::max);
                assert!((most(limit) / of_each - 1.0).abs() < 1e-12, "{limit:?}");
                let bounds = of.iter().map(|one| one.bound).collect::<Option<Vec<f64>>>();
                assert_eq!(limit.bound, bounds.map(|all| all.into_iter().fold(0.0, f64::max)));
            }
        }
        for (n, (told, one)) in list.landings.iter().zip(&alone).enumerate() {
            assert_eq!((told.landing, told.verdict), (DropName::Number(n + 1), one.verdict));
            let limits = one.components.iter().flat_map(|component| &component.limits);
            let said = limits.map(|limit| (limit.demand, limit.verdict));
            assert!(told.limits.iter().map(|limit| (limit.demand, limit.verdict)).eq(said), "drop {}", n + 1);
        }
    }
}

/// Every sample goes through all drops of its list and needs what the worst of them asks. Which end is first, tilts and spins of one drop
/// hang on no other: over many samples their correlation is within 4 of its standard deviations, 1/√n.
#[test]
fn a_sample_goes_through_all_drops() {
    let file = file(BAR, &FALLS);
    let settings = Settings { samples: 400, seed: 3, confidence: 0.95, merge_s: 1e-3 };
    let sampler = Sampler::new(&file, settings).unwrap();
    let (columns, mut rows) = (sampler.columns(), Vec::<Vec<f64>>::new());
    let scatter = sampler
        .run(true, &|| true, |progress: &Progress<'_>| {
            rows.extend(progress.values.chunks(columns.len()).map(<[f64]>::to_vec));
            Ok::<_, std::convert::Infallible>(())
        })
        .unwrap();
    let of = |column: Column| {
        let at = columns.iter().position(|other| *other == column).unwrap_or_else(|| panic!("{column:?}"));
        rows.iter().map(move |row| row[at]).collect::<Vec<f64>>()
    };
    for part in 0..2 {
        let each = [0, 1, 2].map(|n| of(Column::LandingUtilization(n, part)));
        for (k, most) in of(Column::Utilization(part)).into_iter().enumerate() {
            assert_eq!(most.to_bits(), each[0][k].max(each[1][k]).max(each[2][k]).to_bits());
        }
        for n in 0..3 {
            assert!(
                scatter.landings[n].components[part].survival.estimate >= scatter.components[part].survival.estimate
            );
        }
    }
    // Drop 1 has end a first, and no spin.
    assert!(
        !columns.contains(&Column::Drop(Input::First, Some(0)))
            && !columns.contains(&Column::Drop(Input::Spin, Some(0)))
    );
    let (second, third) = (of(Column::Drop(Input::First, Some(1))), of(Column::Drop(Input::First, Some(2))));
    let (tilts, spins) = (of(Column::Drop(Input::Tilt, Some(1))), of(Column::Drop(Input::Spin, Some(1))));
    for (a, b) in
        [(&second, &third), (&tilts, &spins), (&second, &tilts), (&of(Column::Drop(Input::Tilt, Some(0))), &tilts)]
    {
        #[expect(clippy::cast_precision_loss, reason = "a count")]
        let n = a.len() as f64;
        let mean = |x: &[f64]| x.iter().sum::<f64>() / n;
        let (ma, mb) = (mean(a), mean(b));
        let of = |x: &[f64], m: f64, y: &[f64], l: f64| x.iter().zip(y).map(|(x, y)| (x - m) * (y - l)).sum::<f64>();
        let correlation = of(a, ma, b, mb) / (of(a, ma, a, ma) * of(b, mb, b, mb)).sqrt();
        assert!(correlation.abs() < 4.0 / n.sqrt(), "{correlation}");
    }
    assert!(of(Column::Drop(Input::Speed, Some(2))).iter().all(|speed| speed.to_bits() == 3_f64.to_bits()));
}

/// A drop that another one exceeds everywhere changes nothing that a page shows: safe places, curves and changes are those of the harder one.
#[test]
fn an_easier_drop_changes_no_page() {
    // The display fails, the camera has room.
    let bar = BAR.replace("120 rad/s", "250 rad/s");
    let easy = FALLS[0].replace("1.2 m", "0.9 m");
    let hard = file(&bar, &FALLS[..1]);
    let both = file(&bar, &[&easy, FALLS[0]]);
    let of = |file: &ProductFile| {
        let assessment = clatter_assess::assess(file).unwrap();
        assert_eq!(assessment.verdict, Verdict::Unsafe);
        clatter_assess::portraits(file, &assessment)
    };
    let (hard, both) = (of(&hard), of(&both));
    assert!(hard.iter().any(|portrait| portrait.zone_m.is_some()));
    assert_eq!(hard, both);
    // A harder one does: its worst drop is drawn, and its places hold no more than those of the easier one.
    let harder = of(&file(&bar, &[FALLS[0], &FALLS[0].replace("1.2 m", "1.5 m")]));
    for (more, less) in hard.iter().zip(&harder) {
        let within = |[lo, hi]: [f64; 2]| more.zone_m.is_some_and(|[from, to]| from <= lo && hi <= to);
        assert!(less.zone_m.is_none_or(within), "{less:?}");
    }
    assert_ne!(hard, harder);
}

/// A change that makes a part safe leaves its margin in each drop of the list alone.
#[test]
fn changes_hold_in_all_drops() {
    let list = file(BAR, &FALLS[..2]);
    let found =
        clatter_assess::remedies(&list, &clatter_assess::assess(&list).unwrap(), &Bounds::default(), 0.1).unwrap();
    let mut held = 0;
    for part in &found {
        for remedy in &part.levers {
            let (Lever::Limit(kind), Outcome::Change { change, .. }) = (remedy.lever, &remedy.outcome) else {
                continue;
            };
            let margins = FALLS[..2].iter().map(|fall| {
                let mut alone = file(BAR, &[fall]);
                let limits = &mut alone.components[part.component].limits;
                *limits = limits.with(kind, Spread::value(change.to[0]).unwrap());
                let component = &clatter_assess::assess(&alone).unwrap().components[part.component];
                assert_eq!(component.verdict, Verdict::Safe, "{change:?}");
                component.limits.iter().find(|limit| limit.limit == kind).unwrap().margin.unwrap()
            });
            let least = margins.fold(f64::INFINITY, f64::min);
            assert!(least >= 0.1, "{change:?}: {least}");
            held += 1;
        }
    }
    assert!(held > 0);
}

/// What cannot be told of several drops is refused by name.
#[test]
fn what_a_list_is_not_is_told() {
    let faults = |text: &str| ProductFile::read(text, "several.toml").unwrap_err().to_string();
    let said = faults(&format!("{BAR}{}", listed(&[FALLS[0], FALLS[0]])));
    assert!(said.contains("drop 2 is the same as one before it"), "{said}");
    let said = faults(&format!("{BAR}{}[[record]]\nfile = \"drop.csv\"\n", listed(&FALLS)));
    assert!(said.contains("a fit takes a file with one drop"), "{said}");
    let moon = format!("{}gravity = \"0.2 gn\"\n", FALLS[1]);
    let said = faults(&format!("{BAR}{}", listed(&[FALLS[0], &moon])));
    assert!(said.contains("gravity differs from drop to drop"), "{said}");
    let said = faults(&format!("{BAR}{}", listed(&[FALLS[0], "height = \"1 m\"\n"])));
    assert!(said.contains("has no `tilt`"), "{said}");
    let said =
        faults(&format!("{BAR}{}", listed(&[FALLS[0], "height = \"1 m\"\ntilt = \"1 deg\"\nface = \"bottom\"\n"])));
    assert!(said.contains("more than one of `tilt`, `face`"), "{said}");
    // An assessment of other drops.
    let list = file(BAR, &FALLS);
    let (all, one) = (clatter_assess::assess(&list).unwrap(), file(BAR, &FALLS[..1]));
    assert!(
        clatter_assess::portraits(&one, &all).is_empty()
            && clatter_assess::portraits(&list, &clatter_assess::assess(&one).unwrap()).is_empty()
    );
    assert_eq!(clatter_assess::remedies(&one, &all, &Bounds::default(), 0.1).unwrap_err(), Error::OtherDrops);
    // Built in code as well.
    let mut both = file(BAR, &FALLS);
    both.landings[1].drop.gravity_m_s2 = 1.0;
    assert!(matches!(both.check(), Err(Error::Data { .. })));
    let mut both = file(BAR, &FALLS);
    both.landings[1].drop.tilt_rad = Spread::value(0.9).unwrap();
    assert!(both.check().unwrap_err().to_string().contains("`tilt`"));
}
