//! The command of typst and its wheel set the same pages of the studies.

use clatter_report::Typst;

use crate::{accuracy_files, paper, plate, shock};
use ways::{COMMAND, WHEEL, content};

#[path = "../../crates/clatter-report/src/typst/ways.rs"]
mod ways;

#[test]
fn both_ways_set_the_same_reports() {
    let (Some(command), Some(wheel)) = (&*COMMAND, &*WHEEL) else { return };
    let reports = [
        (("paper.typ", include_str!("../../reports/paper.typ")), paper::Data::compute().unwrap().files().unwrap()),
        (("plate.typ", include_str!("../../reports/plate.typ")), plate::Data::compute().unwrap().files().unwrap()),
        (("shock.typ", include_str!("../../reports/shock.typ")), shock::Data::compute().unwrap().files().unwrap()),
        (("accuracy.typ", include_str!("../../reports/accuracy.typ")), accuracy_files().unwrap()),
    ];
    let inputs = [
        ("trade.typ", include_str!("../../reports/trade.typ")),
        ("peers.typ", include_str!("../../reports/peers.typ")),
        ("cube.typ", include_str!("../../reports/cube.typ")),
    ];
    for (source, files) in &reports {
        let files = || inputs.into_iter().chain(files.iter().map(|(name, text)| (*name, text.as_str())));
        let [one, other] = [command, wheel].map(|typst| content(&typst.set(*source, files()).unwrap()));
        let differ = one.lines().zip(other.lines()).find(|(one, other)| one != other);
        assert!(one == other, "{}: {differ:.200?}", source.0);
    }
}
