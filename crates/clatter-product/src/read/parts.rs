//! Parts of a product, and records of its drops.

use super::{At, Reader, Section};
use crate::check::sensor;
use crate::quantity::Source;
use crate::{Axis, Component, Damping, DataFault, Inside, LimitKind, Limits, Mount, Product, RecordFile, Stops};

impl Reader {
    pub(super) fn component(&mut self, section: &Section<'_>, product: Option<&Product>) -> Option<Component> {
        let name = self.name(section);
        let position = self.spread_of_sides(section, "position");
        let extent = self.quantity_of_sides(section, "extent");
        let height_m = self.quantity(section, "height").map_or(0.0, |height| height.value);
        let axis = self.choice(section, "axis").and_then(|axis| Axis::of(axis.value));
        let mount = self.mount(section);
        // A box comes down on any side: what is mounted rigidly in it is struck along the blow.
        let is_struck = self.is_box && mount == Some(Mount::Hard);
        let axis = axis.unwrap_or(if is_struck { Axis::Any } else { Axis::Z });
        let stops = self.stops(section);
        let limits = self.limits(section);
        let (position, [extent_m, extent_across_m]) = (position?, extent.map_or([0.0; 2], |e| e.value));
        let [position_m, across_m] = position.value;
        let limit_source = self.text(section, "limit_source").map(|source| source.value);
        let component = Component {
            name: name?,
            position_m,
            extent_m,
            across_m,
            extent_across_m,
            inside: Inside { height_m, axis },
            mount: mount?,
            stops,
            limits,
            limit_source,
        };
        if let Some(Err(fault)) = product.map(|product| component.fits(product)) {
            let is_high = matches!(fault, DataFault::Outside { side: "thickness", .. });
            let height = section.table.get("height").filter(|_| is_high);
            self.data(height.map_or(position.span, toml::Spanned::span), &fault, "this position");
            return None;
        }
        // What is wrong in the table, or beside mount = "hard", is told already.
        let is_told = component.mount == Mount::Hard || component.stops.is_none() && section.table.contains_key("stop");
        if let (Err(fault), false) = (component.check_stops(), is_told) {
            let value = section.table.get("stop").or(section.table.get("stop_speed_limit"));
            self.data(value.map_or(section.span.clone(), toml::Spanned::span), &fault, "here");
        }
        if let Err(fault) = component.check_axis(self.is_box) {
            let value = section.table.get("axis").or(section.table.get("height"));
            self.data(value.map_or(section.span.clone(), toml::Spanned::span), &fault, "here");
        }
        let stiff = product.and_then(|product| crate::quantity::lacks_contact_time(product, &component));
        if let Some(reason) = stiff {
            let message = format!("{} needs the contact time of the product", section.title);
            let span =
                section.table.get_key_value("mount").or_else(|| section.table.get_key_value("natural_frequency"));
            let span = span.map_or(section.span.clone(), |(key, value)| key.span().start..value.span().end);
            self.fault(span, message, reason, "add contact_time = \"0.4 ms\" or whatever was measured to [product]");
        }
        Some(component)
    }

    pub(super) fn record(&mut self, section: &Section<'_>, product: Option<&Product>) -> Option<RecordFile> {
        let position = self.quantity(section, "position");
        if let (Some(At { value, span }), Some(product)) = (position.clone(), product)
            && let Err(fault) = sensor(value, product)
        {
            self.data(span, &fault, "this position");
        }
        let mut text = |name| self.text(section, name).map(|text| text.value);
        let [file, drop, acceleration, units] = ["file", "drop", "acceleration", "units"].map(&mut text);
        Some(RecordFile {
            file: file?,
            drop,
            position_m: position.map(|position| position.value),
            acceleration,
            units,
            sample_rate_hz: self.quantity(section, "sample_rate").map(|rate| rate.value),
            timing_s: self.quantity(section, "timing").map(|timing| timing.value),
        })
    }

    fn mount(&mut self, section: &Section<'_>) -> Option<Mount> {
        let mount = self.choice(section, "mount");
        let frequency = self.spread(section, "natural_frequency");
        let damping = self.spread(section, "damping_ratio");
        let quality = self.spread(section, "quality_factor");
        if section.table.contains_key("mount") && mount.is_none() {
            return None;
        }
        if mount.is_some_and(|mount| mount.value == "hard") {
            let limits = LimitKind::ALL.into_iter().filter(|kind| kind.needs_suspension()).map(LimitKind::key);
            for name in ["natural_frequency", "damping_ratio", "quality_factor", "stop"].into_iter().chain(limits) {
                if let Some((key, _)) = section.table.get_key_value(name) {
                    self.data(key.span(), &DataFault::Hard { field: name }, "beside mount = \"hard\"");
                }
            }
            return Some(Mount::Hard);
        }
        if !section.table.contains_key("natural_frequency") {
            let message = format!("{} has no `natural_frequency`", section.title);
            let help = "add natural_frequency = \"180 Hz\", or mount = \"hard\" for a part mounted rigidly";
            self.fault(section.span.clone(), message, "in this table", help);
            return None;
        }
        self.exactly_one(section, &["damping_ratio", "quality_factor"], true);
        let damping = match (damping, quality) {
            (Some(zeta), _) => Damping::Ratio(zeta.value),
            (None, Some(q)) => Damping::Quality(q.value),
            (None, None) => return None,
        };
        Some(Mount::Suspended { frequency_hz: frequency?.value, damping })
    }

    /// Reads the stops of a part; a fault leaves none.
    fn stops(&mut self, section: &Section<'_>) -> Option<Stops> {
        let section = self.table(section, "stop")?;
        let [gap, time, restitution] =
            ["gap", "contact_time", "restitution"].map(|name| self.spread(&section, name).map(|spread| spread.value));
        Some(Stops { gap_m: gap?, contact_time_s: time?, restitution: restitution? })
    }

    fn limits(&mut self, section: &Section<'_>) -> Limits {
        if LimitKind::ALL.iter().all(|kind| !section.table.contains_key(kind.key())) {
            let [_, help] = DataFault::NoLimit.told();
            self.fault(section.span.clone(), format!("{} has no limit", section.title), "in this table", help);
        }
        let mut limits = Limits::default();
        for kind in LimitKind::ALL {
            if kind.source() == Source::Boundary {
                let Some(section) = self.table(section, kind.key()) else { continue };
                let velocity = self.spread(&section, "velocity_change");
                let acceleration = self.spread(&section, "acceleration");
                if let (Some(velocity), Some(acceleration)) = (velocity, acceleration) {
                    limits = limits.with_damage_boundary(velocity.value, acceleration.value);
                }
            } else if let Some(limit) = self.spread(section, kind.key()) {
                limits = limits.with(kind, limit.value);
            }
        }
        limits
    }
}
