//! How it falls, and what a box lands on.

use clatter::End;

use super::{Reader, Section, shown};
use crate::keys;
use crate::standard;
use crate::{Attitude, DataFault, Drop, Fall, First, Landing, Product, Spread};

/// Keys of what a box lands on: by so many faces at once, and by a standard.
pub(super) const LANDS_ON: [&str; 4] = ["face", "edge", "corner", "standard"];

/// Drops of a file that are listed by hand: each takes a tenth of a second.
const MOST_DROPS: usize = 100;

impl Reader {
    /// What a box lands on; none where a fault was told.
    pub(super) fn landings(&mut self, section: &Section<'_>, product: Option<&Product>) -> Vec<Landing> {
        let tolerance = self.quantity(section, "attitude_tolerance");
        if let (Some(tolerance), false) = (&tolerance, self.is_box) {
            let message = "`attitude_tolerance` is that of a box that lands on a face, edge or corner";
            self.fault(tolerance.span.clone(), message, "here", "add `face`, `edge`, `corner` or `standard`");
        }
        let mut landings = Vec::new();
        for (faces, name) in (1..).zip(&LANDS_ON[..3]) {
            for text in self.texts(section, name) {
                let one = Attitude::on(&text.value).filter(|attitude| attitude.faces() == faces);
                let these = if text.value == "all" { Attitude::all(faces) } else { one.into_iter().collect() };
                if these.is_empty() {
                    self.data(text.span, &DataFault::Attitude { field: name, value: shown(&text.value) }, "this");
                }
                landings.extend(these.into_iter().map(|attitude| (attitude, 1.0, None)));
            }
        }
        if landings.len() > MOST_DROPS {
            let message = format!("{} has {} drops", section.title, landings.len());
            self.fault(
                section.span.clone(),
                message,
                format!("at most {MOST_DROPS}"),
                "put the others into another file",
            );
        }
        if let (Some(keyword), Some(product)) = (self.text(section, "standard"), product) {
            let across = product.width.map_or([0.0; 2], |width| [width.m(), width.thickness_m.unwrap_or(0.0)]);
            let largest_m = across.into_iter().fold(product.body.length_m(), f64::max);
            match standard::drops(&keyword.value, standard::Item { mass_kg: product.mass_kg, largest_m }) {
                Ok((drops, source)) => {
                    landings.extend(drops.into_iter().map(|(attitude, height_m)| (attitude, height_m, Some(source))));
                }
                Err(fault) => self.data(keyword.span, &fault, "this"),
            }
        }
        let landing = |(attitude, height_m, source)| Landing {
            attitude,
            source,
            tolerance_rad: tolerance.as_ref().map_or_else(|| standard::tolerance_rad(attitude), |given| given.value),
            fall: Fall::HeightM(Spread::finite(height_m)),
        };
        landings.into_iter().map(landing).collect()
    }

    pub(super) fn drop(&mut self, section: &Section<'_>) -> Option<Drop> {
        let height = self.spread(section, "height");
        let speed = self.spread(section, "speed");
        let tilt = self.spread(section, "tilt");
        let first = self.choice(section, "first");
        let direction = self.spread(section, "direction");
        if !(self.is_box || section.table.contains_key("tilt")) {
            let key = keys::find(keys::DROP, "tilt").map_or("", |key| key.doc);
            let message = format!("{} has no `tilt`", section.title);
            self.fault(section.span.clone(), message, "in this table", format!("add tilt = \"5 deg\": {key}"));
        }
        let gravity = self.quantity(section, "gravity");
        self.exactly_one(section, &["height", "speed"], !section.table.contains_key("standard"));
        let lands_on = LANDS_ON[..3].iter().copied().filter(|name| section.table.contains_key(*name));
        match lands_on.collect::<Vec<_>>()[..] {
            [] => self.exactly_one(section, &["tilt", "standard"], false),
            // Faces, edges and corners may stand together.
            [first, ..] => self.exactly_one(section, &["tilt", first, "standard"], false),
        }
        self.exactly_one(section, &["standard", "height"], false);
        self.exactly_one(section, &["standard", "speed"], false);
        let wrong =
            if self.is_plate { DataFault::OfPlate { field: "first" } } else { DataFault::OfBar { field: "direction" } };
        if let DataFault::OfPlate { field } | DataFault::OfBar { field } = wrong
            && let Some((key, _)) = section.table.get_key_value(field)
        {
            self.data(key.span(), &wrong, "here");
        }
        let gravity_m_s2 = gravity.as_ref().map_or(clatter_shock::STANDARD_GRAVITY_M_S2, |g| g.value);
        if let (Some(height), true) = (&height, gravity_m_s2 == 0.0) {
            self.data(height.span.clone(), &DataFault::NoGravity, "this height");
        }
        let first = match first.map(|f| f.value) {
            Some("a") => First::End(End::A),
            Some("b") => First::End(End::B),
            _ => First::Either,
        };
        let fall = match (height, speed) {
            (Some(height), _) => Fall::HeightM(height.value),
            // Each drop of a standard has its own.
            (None, None) if section.table.contains_key("standard") => Fall::HeightM(Spread::finite(1.0)),
            (None, speed) => Fall::SpeedMS(speed?.value),
        };
        let tilt_rad = if self.is_box { Spread::finite(0.0) } else { tilt?.value };
        Some(Drop { fall, tilt_rad, first, direction_rad: direction.map(|d| d.value), gravity_m_s2 })
    }
}
