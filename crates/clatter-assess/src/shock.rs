//! Velocity shocks in a followed drop: what strikes change the velocity of a place by, and the spin of the product.
//!
//! Strikes whose contacts overlap are one shock: it lasts while a point presses, but no longer than one contact time of the
//! product after the last of them has touched. Its change of velocity is the largest between any two times in it.

use clatter_flight::Stretch;

use crate::drop::{Followed, Motion};

/// One shock.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shock {
    /// From the touch of its first strike until it is over.
    pub(crate) span_s: [f64; 2],
    /// Largest change of velocity, without its sign.
    pub(crate) change: f64,
    /// When that is done.
    pub(crate) time_s: f64,
}

impl Followed {
    /// What the strikes do at a place that feels these sections.
    pub(crate) fn shocks(&self, position_m: f64, sections: &[Stretch]) -> Vec<Shock> {
        match &self.motion {
            Motion::Impacts(_, _, flight) => {
                let s = self.drop.relative(position_m);
                flight.strikes.iter().map(|k| Shock::at(k.time_s, k.delta_v_at(s))).collect()
            }
            Motion::Contacts(_) => in_spans(&self.spans_s(), sections, self.drop.gravity_m_s2),
        }
    }

    /// What they do to the spin.
    pub(crate) fn turns(&self) -> Vec<Shock> {
        match &self.motion {
            Motion::Impacts(scene, model, flight) => {
                let [a, b] = scene.body().arms_m();
                let real = *model == clatter_flight::Model::FiniteTilt;
                let mut before = scene.spin_rad_s();
                let turn = |k: &clatter_flight::Strike| {
                    let cos = if real { k.tilt_rad.cos().abs() } else { 1.0 };
                    // Next to upright the velocities of both ends say little of the turn; in flight the spin stays.
                    let [da, db] = k.delta_v_m_s;
                    let turn = if cos > 0.1 { (db - da) / ((a + b) * cos) } else { k.spin_rad_s - before };
                    before = k.spin_rad_s;
                    Shock::at(k.time_s, turn)
                };
                flight.strikes.iter().map(turn).collect()
            }
            Motion::Contacts(flight) => in_spans(&self.spans_s(), &flight.turned(self.precision), 0.0),
        }
    }

    /// When strikes press, those that overlap as one.
    fn spans_s(&self) -> Vec<[f64; 2]> {
        let Motion::Contacts(contacts) = &self.motion else { return Vec::new() };
        let (longest, end) = (self.drop.pressed_s(), contacts.flight.stop.time_s());
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for press in &contacts.presses {
            let until = press.until_s.min(press.from_s + longest).min(end.max(press.from_s));
            match spans.last_mut() {
                Some(last) if press.from_s <= last[1] => last[1] = last[1].max(until),
                _ => spans.push([press.from_s, until]),
            }
        }
        spans
    }
}

impl Shock {
    fn at(time_s: f64, change: f64) -> Self {
        Self { span_s: [time_s; 2], change: change.abs(), time_s }
    }
}

/// The largest of some shocks.
pub(crate) fn largest(shocks: &[Shock]) -> Option<&Shock> {
    shocks.iter().reduce(|most, shock| if shock.change > most.change { shock } else { most })
}

/// The shocks of a history, which falls with `gravity` besides.
fn in_spans(spans: &[[f64; 2]], sections: &[Stretch], gravity: f64) -> Vec<Shock> {
    let (mut shocks, mut velocity, mut next) = (Vec::with_capacity(spans.len()), 0.0, 0);
    for &[from, until] in spans {
        while let Some(section) = sections.get(next).filter(|s| s.from_s + s.length_s < from) {
            velocity += section.velocity_after(section.length_s) - gravity * section.length_s;
            next += 1;
        }
        let (mut range, mut then) = (Range::default(), velocity);
        for section in sections[next..].iter().take_while(|s| s.from_s <= until) {
            if section.from_s >= from {
                range.note(section.from_s, then);
            }
            let fallen = |t: f64| then + section.velocity_after(t) - gravity * t;
            let (begin, end) = ((from - section.from_s).max(0.0), (until - section.from_s).min(section.length_s));
            range.note(section.from_s + begin, fallen(begin));
            turning_points(section, gravity, [begin, end], |t| range.note(section.from_s + t, fallen(t)));
            range.note(section.from_s + end, fallen(end));
            then = fallen(section.length_s);
        }
        let [low, high] = range.0.unwrap_or_default();
        shocks.push(Shock { span_s: [from, until], change: high.1 - low.1, time_s: low.0.max(high.0) });
    }
    shocks
}

/// The lowest and the highest value so far, each with its time.
#[derive(Default)]
struct Range(Option<[(f64, f64); 2]>);

impl Range {
    fn note(&mut self, t: f64, value: f64) {
        let [low, high] = self.0.get_or_insert([(t, value); 2]);
        if value < low.1 {
            *low = (t, value);
        }
        if value > high.1 {
            *high = (t, value);
        }
    }
}

/// Phase of the fastest wave between two samples of a section.
const PHASE: f64 = 0.4;
/// Samples of one section at most.
const MOST: f64 = 256.0;

/// Samples of a section over a time.
pub(crate) fn samples(section: &Stretch, length_s: f64) -> u32 {
    let fastest =
        section.waves.iter().filter(|w| w.amplitude_m_s2 != 0.0).fold(0.0, |most: f64, w| most.max(w.rate_rad_s));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 256")]
    let count = (fastest * length_s / PHASE).clamp(1.0, MOST).ceil() as u32;
    count
}

/// Times within a section at which the acceleration is that of gravity.
fn turning_points(section: &Stretch, gravity: f64, [begin, end]: [f64; 2], mut at: impl FnMut(f64)) {
    let count = samples(section, end - begin);
    let step = (end - begin) / f64::from(count);
    let of = |t: f64| section.acceleration_at(t) - gravity;
    let mut last = (begin, of(begin));
    for k in 1..=count {
        let t = begin + f64::from(k) * step;
        let next = (t, of(t));
        if last.1 * next.1 < 0.0 {
            let (mut low, mut high) = (last, next);
            // A velocity is flat where it turns: three chords leave nothing of it.
            for _ in 0..3 {
                let t = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
                let between = (t, of(t));
                if between.1 * low.1 > 0.0 {
                    low = between;
                } else {
                    high = between;
                }
                at(t);
            }
        }
        last = next;
    }
}
