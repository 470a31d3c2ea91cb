//! The short command that answers a worst drop once more, from the product file.

use std::f64::consts::TAU;

use clatter::End;
use clatter_flight::{ContactLaw, Feet};

use crate::{Accuracy, LimitKind, Model, WorstCase, visible};

/// `clatter respond --product=… --component=… --worst=…`, which searches the worst drop of a limit again and answers it; with the model
/// and the tolerance, where they are not those that an assessment has by itself. None where the command line cannot say it: for a file
/// that is standard input, for names that are no plain text, for another time of strikes that land as one.
///
/// # Examples
/// ```
/// use clatter_assess::{Accuracy, LimitKind, repeat};
/// let command = repeat("phone.toml", "main board", LimitKind::Acceleration, &Accuracy::default());
/// assert_eq!(command.unwrap(), "clatter respond --product=phone.toml --component='main board' --worst=acceleration");
/// ```
#[must_use]
pub fn repeat(path: &str, component: &str, limit: LimitKind, accuracy: &Accuracy) -> Option<String> {
    let own = Accuracy::default();
    let plain = |text: &str| visible(text) == text && text.trim() == text && text.chars().count() <= LONGEST;
    let said = plain(path) && plain(component) && path != "-" && accuracy.merge_s.to_bits() == own.merge_s.to_bits();
    let mut command = format!(
        "clatter respond --product={} --component={} --worst={}",
        quoted(path),
        quoted(component),
        limit.name()
    );
    if let Some(model) = accuracy.model {
        command.extend([" --model=", model.name()]);
    }
    if accuracy.tolerance.to_bits() != own.tolerance.to_bits() {
        command.extend([" --tolerance=", &format!("{:?}", accuracy.tolerance)]);
    }
    said.then_some(command)
}

impl WorstCase {
    /// The command that answers the drop once more.
    #[must_use]
    pub fn command(&self) -> String {
        let drop = &self.drop;
        if drop.body.is_wide() {
            return self.command_of_plate();
        }
        let [a, b] = drop.body.arms_m();
        let side = if drop.first() == End::A { 1.0 } else { -1.0 };
        let length = a + b;
        let mut command = format!("clatter respond --model={} --length-m={length:?}", self.model.name());
        let mut add = |flag: &str, value: f64| command.extend([" --", flag, "=", &format!("{value:?}")]);
        add("gyration-m", drop.body.gyration_m());
        let center = side * (a - b) / length;
        if center != 0.0 {
            add("center-of-mass", center);
        }
        add("e", drop.restitution);
        add("speed-m-s", drop.speed_m_s);
        if drop.is_flat {
            command.push_str(" --flat");
        } else {
            let tilt = format!("{:?}", drop.tilt_rad.to_degrees());
            command.extend([" --tilt-deg=", &tilt]);
        }
        let mut add = |flag: &str, value: f64| command.extend([" --", flag, "=", &format!("{value:?}")]);
        if drop.spin_rad_s != 0.0 {
            add("spin-rad-s", drop.spin_rad_s);
        }
        add("gravity-m-s2", drop.gravity_m_s2);
        if let Some(feet) = &drop.body.feet {
            Self::of_feet(feet, &[side * self.part.place.at_m[0]], &mut command);
        } else {
            add("at", drop.relative(self.part.place.at_m[0]) + 0.0);
        }
        self.of_part(&mut command);
        let mut add = |flag: &str, value: f64| command.extend([" --", flag, "=", &format!("{value:?}")]);
        let contacts = self.model == Model::Compliant;
        // The acceleration of a part that is mounted rigidly is that of the contact time, by any model.
        if let Some(time) = drop.contact_time_s.filter(|_| contacts || self.part.suspension.is_none()) {
            add("contact-time-s", time);
            if contacts && drop.contact_law != ContactLaw::default() {
                command.extend([" --contact-law=", drop.contact_law.name()]);
            }
        }
        self.of_contacts([drop.first() == End::B, false], &mut command);
        command
    }

    /// Contacts of their own, of a product whose sides run the other way.
    fn of_contacts(&self, sides: [bool; 2], command: &mut String) {
        let drop = &self.drop;
        let own = drop.own_contacts.mirrored(sides);
        for (at, restitution, contact_time_s) in own.told(drop.restitution, drop.contact_time_s) {
            let time_s = contact_time_s.unwrap_or(0.0);
            command.extend([" --contact=", &format!("{at},{restitution:?},{time_s:?}")]);
        }
    }

    /// Feet that it lands on, and the place, which may be beyond them.
    fn of_feet(feet: &Feet, at_m: &[f64], command: &mut String) {
        let (Feet { inset_m: [x, y], height_m }, places) = (feet, at_m.iter().map(|m| format!("{:?}m", m + 0.0)));
        let places = places.collect::<Vec<_>>().join(",");
        command.extend([" --at=", &places, " --feet-m=", &format!("{x:?},{y:?},{height_m:?}")]);
    }

    /// The part and the tolerance.
    fn of_part(&self, command: &mut String) {
        let mut add = |flag: &str, value: f64| command.extend([" --", flag, "=", &format!("{value:?}")]);
        if let Some((hz, ratio)) = self.part.suspension.map(|part| (part.omega() / TAU, part.damping().get())) {
            add("omega", TAU * hz);
            add("damping", ratio);
        }
        add("tolerance", self.tolerance);
    }

    /// Of a plate, seen so that its lowest corner is a.
    fn command_of_plate(&self) -> String {
        let drop = &self.drop;
        if drop.is_solid() {
            return self.command_of_box();
        }
        let (body, [sx, sy]) = (&drop.body, drop.signs());
        let [length, width] = [body.length_m(), body.width_m()];
        let [_, across] = [body.length, body.width.unwrap_or(body.length)];
        let mut command = format!("clatter respond --model={} --length-m={length:?}", self.model.name());
        let mut add = |flag: &str, values: &[f64]| {
            let values: Vec<_> = values.iter().map(|value| format!("{:?}", value + 0.0)).collect();
            command.extend([" --", flag, "=", &values.join(",")]);
        };
        add("width-m", &[width]);
        add("gyration-m", &[body.gyration_m(), across.gyration_m]);
        if body.products_m2[0] != 0.0 {
            add("product-of-inertia-m2", &[sx * sy * body.products_m2[0]]);
        }
        let [a, b] = body.arms_m();
        let center = [sx * (a - b) / length, sy * 2.0 * across.center_m() / width];
        if center.iter().any(|place| *place != 0.0) {
            add("center-of-mass", &center);
        }
        add("e", &[drop.restitution]);
        add("speed-m-s", &[drop.speed_m_s]);
        add("gaps-m", &drop.gaps_m());
        if drop.spin_rad_s != 0.0 {
            add("spin-rad-s", &drop.spin_of_plate());
        }
        add("gravity-m-s2", &[drop.gravity_m_s2]);
        let [x, y] = self.part.at_m();
        if let Some(feet) = &drop.body.feet {
            Self::of_feet(feet, &[sx * x, sy * y], &mut command);
        } else {
            add("at", &[2.0 * sx * x / length, 2.0 * sy * y / width]);
        }
        self.of_part(&mut command);
        if let Some(time) = drop.contact_time_s {
            command.extend([" --contact-time-s=", &format!("{time:?}")]);
        }
        if drop.contact_law != ContactLaw::default() {
            command.extend([" --contact-law=", drop.contact_law.name()]);
        }
        self.of_contacts(drop.signs().map(|sign| sign < 0.0), &mut command);
        command
    }
}

impl WorstCase {
    /// Of a box, turned so that its vertical is that of the world.
    fn command_of_box(&self) -> String {
        let (drop, body) = (&self.drop, &self.drop.body);
        let [x, y, z] = drop.up();
        // The rotation about the axis across both verticals; upside down, about x.
        let turned = (2.0 * (1.0 + z)).max(0.0).sqrt();
        let quaternion =
            if turned > 1e-8 { [0.5 * turned, y / turned, -x / turned, 0.0] } else { [0.0, 1.0, 0.0, 0.0] };
        let [length, width, thickness] = [body.length, body.width.unwrap_or(body.length), body.thickness()];
        let [kx, ky, kz] = [length.gyration_m, width.gyration_m, thickness.gyration_m];
        let mut command = format!("clatter respond --model={}", self.model.name());
        let mut add = |flag: &str, values: &[f64]| {
            let values: Vec<_> = values.iter().map(|value| format!("{:?}", value + 0.0)).collect();
            command.extend([" --", flag, "=", &values.join(",")]);
        };
        add("length-m", &[length.m()]);
        add("width-m", &[width.m()]);
        add("thickness-m", &[thickness.m()]);
        add("gyration-m", &[libm::hypot(ky, kz), libm::hypot(kx, kz), libm::hypot(kx, ky)]);
        if body.products_m2.iter().any(|of| *of != 0.0) {
            add("product-of-inertia-m2", &body.products_m2);
        }
        add("center-of-mass-m", &[length.center_m(), width.center_m(), thickness.center_m()]);
        add("orientation", &quaternion);
        add("e", &[drop.restitution]);
        add("speed-m-s", &[drop.speed_m_s]);
        if drop.spin_rad_s != 0.0 {
            add("spin-rad-s", &drop.spin());
        }
        add("gravity-m-s2", &[drop.gravity_m_s2]);
        add("at-m", &self.part.place.at_m);
        self.of_part(&mut command);
        command.extend([" --axis=", self.part.place.axis.name()]);
        if let Some(time) = drop.contact_time_s {
            command.extend([" --contact-time-s=", &format!("{time:?}")]);
        }
        command.extend([" --contact-law=", drop.contact_law.name()]);
        self.of_contacts([false; 2], &mut command);
        command
    }
}

/// Longer names make no short command.
const LONGEST: usize = 80;

/// As a shell takes it for one word.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/+,:@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    #[test]
    fn what_differs_from_an_assessment_by_itself_is_said() {
        let accuracy = Accuracy { tolerance: 0.001, model: Some(Model::Map), ..Accuracy::default() };
        let command = repeat("a b.toml", "Jo's", LimitKind::RattleSpace, &accuracy).unwrap();
        let said = r"clatter respond --product='a b.toml' --component='Jo'\''s' --worst=rattle-space --model=map --tolerance=0.001";
        assert_eq!(command, said);
    }

    #[test]
    fn what_a_command_line_cannot_say_is_not_said() {
        let of = |path: &str, name: &str, accuracy: &Accuracy| repeat(path, name, LimitKind::Acceleration, accuracy);
        let own = Accuracy::default();
        assert!(of("a.toml", "part", &own).is_some());
        assert_eq!(of("-", "part", &own), None);
        assert_eq!(of("a.toml", "a\u{1b}b", &own), None);
        assert_eq!(of("a.toml", &"x".repeat(100), &own), None);
        assert_eq!(of("a.toml", "part", &Accuracy { merge_s: 2e-3, ..own }), None);
    }
}
