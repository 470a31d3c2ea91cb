//! Random numbers, and random product files as a designer would write them.

use std::fmt::Write;

/// A generator of random numbers (`SplitMix64`).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Creates the generator from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_F491_4F6C_DD1D).wrapping_add(0x9E37_79B9))
    }

    /// Returns a number that is uniform from 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number that is uniform within bounds.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Returns a number that is uniform in the logarithm.
    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    /// Returns true with this probability.
    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// Returns a nearly normal number of standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

/// Kinds of random products.
pub const KINDS: [&str; 11] =
    ["instant", "contacts", "low-e", "high-e", "tiny-tilt", "steep", "damped", "feet", "own-contacts", "spin", "stops"];

/// Returns a value with its unit, or a range about it, with three digits, as one writes them.
fn spread(random: &mut Random, middle: f64, share: f64, chance: f64, unit: &str) -> String {
    if random.chance(chance) {
        let half = middle * random.within(0.2, 1.0) * share;
        format!("[\"{} {unit}\", \"{} {unit}\"]", digits(middle - half), digits(middle + half))
    } else {
        format!("\"{} {unit}\"", digits(middle))
    }
}

fn digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Returns a random product file of a kind, its limits far above any demand; none for an unknown kind.
#[must_use]
pub fn product(kind: &str, seed: u64) -> Option<String> {
    let index = KINDS.iter().position(|&name| name == kind)?;
    let mut random = Random::new(seed.wrapping_mul(16).wrapping_add(index as u64));
    let r = &mut random;
    let length = digits(r.log(0.06, 0.4) * 1e3);
    let contact = match kind {
        "instant" => false,
        "contacts" | "low-e" | "own-contacts" => true,
        _ => r.chance(0.7),
    };
    let (low, high) = match kind {
        "low-e" => (0.02, 0.12),
        "high-e" => (0.55, 0.9),
        _ => (0.1, 0.6),
    };
    let e = r.within(low, high);
    let wide = if r.chance(0.5) { (e * r.within(1.05, 1.5)).min(high) } else { e };
    let mut text = format!(
        "[product]\nname = \"{kind} {seed}\"\nlength = \"{length} mm\"\nradius_of_gyration = \"{} mm\"\n\
         restitution = [{}, {}]\n",
        digits(length * r.within(0.2, 0.38)),
        digits(e),
        digits(wide)
    );
    if kind == "feet" {
        // The feet are so high that no edge touches.
        let inset = digits(length * r.within(0.02, 0.25));
        let _ = writeln!(text, "feet_inset = \"{inset} mm\"\nfeet_height = \"{} mm\"", digits(0.3 * length));
    }
    if r.chance(0.4) {
        let _ = writeln!(text, "center_of_mass = \"{} mm\"", digits(length * r.within(-0.12, 0.12)));
    }
    if contact {
        let time = r.log(0.1, 2.0);
        let own = kind == "own-contacts";
        let law = if !own && r.chance(0.25) { "dashpot" } else { "hysteretic" };
        let _ = writeln!(text, "contact_time = {}\ncontact_law = \"{law}\"", spread(r, time, 0.3, 0.3, "ms"));
        if own {
            let at = ["a", "b"][usize::from(r.chance(0.5))];
            let both = r.chance(0.2);
            let places = if both { &["a", "b"][..] } else { &[at] };
            let _ = writeln!(text, "contacts = [{}]", own_contacts(r, places, time));
        }
    }
    let (from, to) = match kind {
        "tiny-tilt" => (0.0, r.log(0.05, 1.0)),
        "steep" => (r.within(0.0, 15.0), r.within(15.0, 30.0)),
        // Without a contact time the tilt is so steep that no strikes are simultaneous.
        "spin" if !contact => (r.within(10.0, 12.0), r.within(13.0, 20.0)),
        _ => (if r.chance(0.5) { 0.0 } else { r.within(0.5, 3.0) }, r.within(4.0, 15.0)),
    };
    let first = ["a", "b", "either"][(r.unit() * 3.0) as usize];
    let height = r.within(0.3, 1.5);
    let _ = writeln!(
        text,
        "[drop]\nheight = {}\ntilt = [\"{} deg\", \"{} deg\"]\nfirst = \"{first}\"",
        spread(r, height, 0.3, 0.3, "m"),
        digits(from),
        digits(to)
    );
    if kind == "spin" {
        // The unit is the spin that would turn the first end up, at the least height and the farthest end.
        let most = (2.0 * 9.806_65 * 0.7 * height).sqrt() / (0.62e-3 * length);
        let spin = r.within(-0.9, 1.2);
        let other = if r.chance(0.7) { r.within(-0.9, 1.2) } else { spin };
        let [low, high] = [spin.min(other), spin.max(other)].map(|share| digits(share * most));
        let _ = writeln!(text, "spin = [\"{low} rad/s\", \"{high} rad/s\"]");
    }
    let speed = (2.0 * 9.806_65 * height).sqrt();
    for i in 0..=usize::from(r.chance(0.5)) {
        text.push_str(&part(r, kind, i, length, contact, speed));
    }
    Some(text)
}

/// Returns own contacts: softer or harder, and livelier or not, than those of a product that last so many ms.
pub(crate) fn own_contacts(r: &mut Random, places: &[&str], time: f64) -> String {
    let mut one = |at: &&str| {
        let (e, time) = (digits(r.within(0.02, 0.7)), digits((time * r.log(0.2, 5.0)).min(3.0)));
        match r.unit() {
            u if u < 0.25 => format!("{{ at = \"{at}\", restitution = {e} }}"),
            u if u < 0.5 => format!("{{ at = \"{at}\", contact_time = \"{time} ms\" }}"),
            _ => format!("{{ at = \"{at}\", restitution = {e}, contact_time = \"{time} ms\" }}"),
        }
    };
    places.iter().map(&mut one).collect::<Vec<_>>().join(", ")
}

/// Returns stops of a part of so many Hz in a drop of this speed, as a line of a product file: near and far, hard and soft,
/// dead and lively, their values or ranges of them.
pub(crate) fn stops(r: &mut Random, frequency: f64, speed: f64) -> String {
    // A part as slow as the product stops goes this far; a fast one less.
    let far = speed / (std::f64::consts::TAU * frequency) / (1.0 + frequency / 500.0);
    let gap = r.log(0.03, 1.2) * far * 1e3;
    let time = r.log(0.05, 2.0).min(600.0 / frequency);
    let e = if r.chance(0.15) { r.within(0.0, 0.1) } else { r.within(0.1, 0.75) };
    let [gap, time] = [spread(r, gap, 0.3, 0.4, "mm"), spread(r, time, 0.4, 0.5, "ms")];
    let e = spread(r, e, 0.25, 0.4, "").replace(" \"", "").replace('"', "");
    format!("stop = {{ gap = {gap}, contact_time = {time}, restitution = {e} }}\n")
}

fn part(r: &mut Random, kind: &str, i: usize, length: f64, contact: bool, speed: f64) -> String {
    let at = r.within(-0.48, 0.48) * length;
    let mut text = format!("[[component]]\nname = \"part {i}\"\nposition = \"{} mm\"\n", digits(at));
    if r.chance(0.3) {
        let room = length / 2.0 - at.abs();
        let _ = writeln!(text, "extent = \"{} mm\"", digits(r.within(0.1, 1.0) * room));
    }
    if r.chance(if kind == "stops" { 0.95 } else { 0.7 }) {
        // Without a contact time clatter refuses parts above 318 Hz.
        let frequency = if contact { r.log(15.0, 4000.0) } else { r.log(8.0, 270.0) };
        let zeta = if kind == "damped" { r.log(0.3, 5.0) } else { r.log(0.005, 0.3) };
        let _ = writeln!(text, "natural_frequency = {}", spread(r, frequency, 0.15, 0.5, "Hz"));
        let _ = writeln!(text, "damping_ratio = {}", spread(r, zeta, 0.3, 0.3, "").replace(" \"", "").replace('"', ""));
        text.push_str("acceleration_limit = \"9e6 gn\"\n");
        if r.chance(0.5) {
            text.push_str("rattle_space = \"90 m\"\n");
        }
        if kind == "stops" && r.chance(0.9) {
            text.push_str(&stops(r, frequency, speed));
            text.push_str("stop_speed_limit = \"900 m/s\"\n");
        }
    } else {
        text.push_str("mount = \"hard\"\nvelocity_change_limit = \"900 m/s\"\n");
        if r.chance(0.5) {
            text.push_str("angular_velocity_change_limit = \"9e5 rad/s\"\n");
        }
        if contact {
            text.push_str("acceleration_limit = \"9e6 gn\"\n");
        }
    }
    text
}
