//! This module reads how a product falls, and the faces, edges and corners on which a box lands.

use clatter::End;
use clatter_flight::Feet;

use super::{Reader, Section, shown};
use crate::check::{FLAT, STEEPEST_RAD, spin_down};
use crate::data_fault::out_of_range;
use crate::inputs::optional_inputs;
use crate::keys;
use crate::standard;
use crate::{Attitude, DataFault, DropName, DropRanges, Fall, First, Landing, Law, Product, Spread};

/// Keys of what a box lands on, by so many faces at once.
const LANDS_ON: [&str; 3] = ["face", "edge", "corner"];

/// Drops of a file that are listed by hand: each takes a tenth of a second.
pub(super) const MOST_DROPS: usize = 100;

/// The face, edge or corner on which a box lands in one drop.
struct LandsOn {
    attitude: Attitude,
    /// The drop height, where a standard demands it.
    height_m: f64,
    tolerance_rad: f64,
    source: Option<&'static str>,
}

/// Returns the range of any angle up to this one.
fn up_to(angle_rad: f64) -> Spread {
    Spread::new(0.0, angle_rad, Law::Range).unwrap_or(Spread::finite(0.0))
}

impl Reader {
    /// Reads how it falls, and the faces, edges and corners on which a box lands in one drop after the other.
    pub(super) fn drops(
        &mut self,
        root: &Section<'_>,
        product: Option<&Product>,
    ) -> (Option<DropRanges>, Vec<Landing>) {
        let several = root.table.get("drop").is_some_and(|drops| drops.get_ref().as_array().is_some());
        let sections = if several { self.tables(root, "drop") } else { self.table(root, "drop").into_iter().collect() };
        let is_of_box = |section: &Section<'_>| {
            LANDS_ON.iter().chain(&["standard", "attitude_tolerance"]).any(|key| section.table.contains_key(*key))
        };
        self.is_box = sections.iter().any(is_of_box);
        let (mut drops, mut all) = (Vec::new(), Vec::<Landing>::new());
        for section in &sections {
            let faults = self.faults.len();
            let lands_on = self.lands_on(section, product);
            let drop = self.drop(section);
            if let (Some(feet), Some(drop)) = (product.and_then(|product| product.body.feet), &drop) {
                self.on_feet(section, drop, &feet);
            }
            if let (Some(product), Some(drop)) = (product, &drop) {
                self.spins(section, drop, product);
            }
            // A faulty drop is compared with nothing.
            let Some(drop) = drop.filter(|_| self.faults.len() == faults) else { continue };
            let own = if several && !self.is_box { vec![Landing::tilted(drop)] } else { Vec::new() };
            let is_listed = section.table.contains_key("standard");
            let of_box = lands_on.into_iter().map(|LandsOn { attitude, height_m, tolerance_rad, source }| {
                let fall = if is_listed { Fall::HeightM(Spread::finite(height_m)) } else { drop.fall };
                Landing {
                    drop: DropRanges { fall, tilt_rad: up_to(tolerance_rad), ..drop },
                    attitude: Some(attitude),
                    source,
                }
            });
            for landing in own.into_iter().chain(of_box) {
                if all.iter().any(|other| other.is_same(&landing)) {
                    let name = landing.attitude.map_or(DropName::Number(all.len() + 1), DropName::On);
                    self.data(section.span.clone(), &DataFault::Twice(name), "here again");
                    break;
                }
                all.push(landing);
            }
            drops.push(drop);
        }
        if all.len() > MOST_DROPS {
            let (message, label) = (format!("the file has {} drops", all.len()), format!("at most {MOST_DROPS}"));
            let at = sections.last().map_or(0..0, |section| section.span.clone());
            self.fault(at, message, label, "put the others into another file");
        }
        let gravity = |drop: &DropRanges| drop.gravity_m_s2.to_bits();
        if let Some(n) = drops.windows(2).position(|two| gravity(&two[0]) != gravity(&two[1])) {
            self.data(sections[n + 1].span.clone(), &DataFault::Gravity, "in this drop");
        }
        // The first drop, with the fall of the first landing, holds the data common to all.
        let drop = drops.into_iter().next();
        let drop = drop.map(|drop| DropRanges { fall: all.first().map_or(drop.fall, |first| first.drop.fall), ..drop });
        // One alone is no list.
        if !self.is_box && all.len() == 1 {
            all.clear();
        }
        (drop, all)
    }

    /// Checks that the place that touches first comes down.
    fn spins(&mut self, section: &Section<'_>, drop: &DropRanges, product: &Product) {
        let Some(spin) = section.table.get("spin") else { return };
        if let Err(fault) = spin_down(product, drop, self.is_box) {
            self.data(spin.span(), &fault, "this");
        }
    }

    /// Checks that feet touch first.
    fn on_feet(&mut self, section: &Section<'_>, drop: &DropRanges, feet: &Feet) {
        let (tilt_rad, most_rad) =
            (drop.tilt_rad.hi(), feet.steepest_rad(drop.direction_rad.map(|given| [given.lo(), given.hi()])));
        if self.is_box {
            self.data(section.span.clone(), &DataFault::FeetOfBox, "in this drop");
        } else if tilt_rad > most_rad {
            let span = section.table.get("tilt").map_or(section.span.clone(), toml::Spanned::span);
            self.data(span, &DataFault::FeetLow { tilt_rad, most_rad }, "this");
        }
    }

    /// Reads the attitude of a box whose bottom is off level by an angle, to one direction.
    fn tilted(&mut self, section: &Section<'_>) -> Option<Attitude> {
        let [tilt, direction] = ["tilt", "direction"].map(|name| self.spread(section, name));
        for (key, help) in [
            ("direction", "add direction = \"30 deg\": where it rises to, from the length towards end b to the width"),
            (
                "attitude_tolerance",
                "add attitude_tolerance = \"2 deg\": beside what a box lands on it is the tilt of one",
            ),
        ] {
            // A product that is no plate has a message of its own that it is no box.
            if self.is_plate && !section.table.contains_key(key) {
                self.fault(section.span.clone(), format!("{} has no `{key}`", section.title), "in this table", help);
            }
        }
        for angle in [&tilt, &direction].into_iter().flatten().filter(|angle| !angle.value.is_value()) {
            let help = "give one angle; `attitude_tolerance` says how far off it may be";
            self.fault(angle.span.clone(), "a box lands at one tilt to one direction", "this range", help);
        }
        Attitude::tilted(tilt?.value.hi(), direction?.value.hi())
    }

    /// Returns the faces, edges and corners on which a box lands; none where a fault was reported.
    fn lands_on(&mut self, section: &Section<'_>, product: Option<&Product>) -> Vec<LandsOn> {
        if !self.is_box {
            return Vec::new();
        }
        let tolerance = self.quantity(section, "attitude_tolerance");
        let mut landings = Vec::new();
        for (faces, name) in (1..).zip(&LANDS_ON) {
            for text in self.texts(section, name) {
                let one = Attitude::on(&text.value).filter(|attitude| attitude.faces() == faces);
                let these = if text.value == "all" { Attitude::all(faces) } else { one.into_iter().collect() };
                if these.is_empty() {
                    self.data(text.span, &DataFault::Attitude { field: name, value: shown(&text.value) }, "this");
                }
                landings.extend(these.into_iter().map(|attitude| (attitude, 1.0, None)));
            }
        }
        // A tilt together with a standard is reported as one too many.
        if section.table.contains_key("tilt") && !section.table.contains_key("standard") {
            landings.extend(self.tilted(section).map(|attitude| (attitude, 1.0, None)));
        }
        if let (Some(keyword), Some(product)) = (self.text(section, "standard"), product) {
            let thickness_m = product.body.thickness.map_or(0.0, |thickness| thickness.m());
            let largest_m = product.body.length_m().max(product.body.width_m()).max(thickness_m);
            match standard::drops(&keyword.value, standard::Item { mass_kg: product.mass_kg, largest_m }) {
                Ok((drops, source)) => {
                    landings.extend(drops.into_iter().map(|(attitude, height_m)| (attitude, height_m, Some(source))));
                }
                Err(fault) => self.data(keyword.span, &fault, "this"),
            }
        }
        let one = |(attitude, height_m, source)| {
            let tolerance_rad =
                tolerance.as_ref().map_or_else(|| standard::tolerance_rad(attitude), |given| given.value);
            LandsOn { attitude, height_m, tolerance_rad, source }
        };
        landings.into_iter().map(one).collect()
    }

    fn drop(&mut self, section: &Section<'_>) -> Option<DropRanges> {
        let height = self.spread(section, "height");
        let speed = self.spread(section, "speed");
        // The drops of a box are given by its faces, edges and corners.
        let [tilt, direction] =
            ["tilt", "direction"].map(|name| if self.is_box { None } else { self.spread(section, name) });
        if let Some(tilt) = tilt.as_ref().filter(|tilt| tilt.value.hi() > STEEPEST_RAD) {
            let degrees = (1e6 * tilt.value.hi().to_degrees()).round() / 1e6;
            let help = "a box, with `thickness`, `direction` and `attitude_tolerance`, lands at up to 90 deg";
            let message = out_of_range("tilt", format!("{degrees} deg"));
            self.fault(tilt.span.clone(), message, keys::allowed(FLAT), help);
        }
        let optional: Vec<_> = optional_inputs()
            .filter_map(|(row, optional)| Some((optional.put, self.spread(section, row.key.1)?)))
            .collect();
        let first = self.choice(section, "first");
        if let (true, false, Some((key, _))) =
            (self.is_box, section.table.contains_key("tilt"), section.table.get_key_value("direction"))
        {
            self.fault(key.span(), "`direction` is that of a `tilt`", "here", "add `tilt`, or leave it out");
        }
        if !(self.is_box || section.table.contains_key("tilt")) {
            let key = keys::find(keys::DROP, "tilt").map_or("", |key| key.doc);
            let message = format!("{} has no `tilt`", section.title);
            self.fault(section.span.clone(), message, "in this table", format!("add tilt = \"5 deg\": {key}"));
        }
        let gravity = self.quantity(section, "gravity");
        self.exactly_one(section, &["height", "speed"], !section.table.contains_key("standard"));
        let lands_on = LANDS_ON.iter().copied().filter(|name| section.table.contains_key(*name));
        match lands_on.collect::<Vec<_>>()[..] {
            [] if self.is_box => self.exactly_one(section, &["face", "edge", "corner", "tilt", "standard"], true),
            [] => self.exactly_one(section, &["tilt", "standard"], false),
            // Faces, edges and corners may stand together.
            [first, ..] => self.exactly_one(section, &["tilt", first, "standard"], false),
        }
        self.exactly_one(section, &["standard", "height"], false);
        self.exactly_one(section, &["standard", "speed"], false);
        self.exactly_one(section, &["standard", "spin"], false);
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
        let direction_rad = direction.map(|direction| direction.value);
        let mut drop = DropRanges { first, direction_rad, gravity_m_s2, ..DropRanges::new(fall, tilt_rad) };
        for (put, given) in optional {
            put(&mut drop, given.value);
        }
        Some(drop)
    }
}
