//! What the ground does to the component's place, as a polygon of accelerations over time.

use clatter::flight::{CompliantFlight, Scene, Stop};
use clatter_shock::{Suspension, VelocityShock};

use super::pulse::{Pulse, straight};

/// (time in s, acceleration in m/s²); two points at one time are a jump.
pub(crate) type Polygon = Vec<(f64, f64)>;
/// The same of both ends.
pub(crate) type EndsPolygon = Vec<(f64, [f64; 2])>;

/// What the ground does to both ends.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pushes {
    /// Free fall taken off; up to where only the weight is left.
    pub(crate) points: EndsPolygon,
    /// The weight that it carries from then on.
    pub(crate) weight: Option<[f64; 2]>,
}

/// How long, in periods of the component, the weight is kept after rest, and how long it is then taken away without
/// ringing.
const WEIGHT_PERIODS: [f64; 2] = [2.0, 64.0];
/// Contact times after rest in which the contacts are followed until they only carry the weight.
const SETTLED: f64 = 1e3;
/// The largest acceleration of a pulse over its mean, about.
const CREST: f64 = 1.6;
/// Shocks below this share of the largest are triangles, below its square nothing.
const SMALL: f64 = 1e-5;

/// What the contacts of a compliant flight do to both ends, from their velocities and heights, free fall taken off.
///
/// Between changes of contact the motion is smooth; `cells` pieces are laid over a contact that does all, fewer (with
/// the square root of its share of the largest shock of an end) over one that does less, denser where it begins. Each
/// piece has the exact change of velocity and the exact path, so that its effect on a component is off by the fourth
/// power of its length.
pub(crate) fn of_contacts(scene: &Scene, flight: &CompliantFlight, until_s: f64, contact_s: f64, cells: f64) -> Pushes {
    let g = scene.gravity_m_s2();
    let piece = |long: f64, start, end| straight(long, start, end).map(|a| a + g);
    let largest = flight.flight.strikes.iter().flat_map(|s| s.delta_v_m_s).fold(0.0_f64, |m, v| m.max(v.abs()));
    let rate = 2.0 * Pulse::new(scene.e()).rate() / contact_s;
    let mut cuts: Vec<_> = flight.phases_s().collect();
    let stop = flight.flight.stop.time_s();
    let at_stop = cuts.last().map_or([false; 2], |(_, on)| *on);
    cuts.push((stop, at_stop));
    let rests = matches!(flight.flight.stop, Stop::AtRest { .. }) && until_s >= stop;
    if rests {
        cuts.push((stop + SETTLED * contact_s, at_stop));
    }
    // On a grid as fine as the time of the end is known, steps of one length are so to the last bit, and the component
    // turns alike in them. A contact begins no earlier than it does. Steps that the grid does not know to eight digits
    // stay as they are.
    let coarse = 3.0 * cuts.last().map_or(0.0, |(time, _)| time.log2().ceil().exp2());
    let on_grid = |time: f64| (time + coarse) - coarse;
    let even = |step: f64| if (on_grid(step) - step).abs() < 1e-8 * step { on_grid(step) } else { step };
    for (time, _) in &mut cuts {
        let near = on_grid(*time);
        *time = if near < *time { near + coarse / 1.5 * f64::EPSILON } else { near };
    }
    let mut points = Vec::with_capacity(16 * cuts.len());
    points.push((0.0, [0.0; 2]));
    let mut doublings = Vec::with_capacity(32);
    let (mut pressing, mut changed) = ([false; 2], 0.0);
    for (phase, pair) in cuts.windows(2).enumerate() {
        let ((from, on), (to, _)) = (pair[0], pair[1]);
        let long = to - from;
        if on != pressing {
            (pressing, changed) = (on, from);
        }
        if from >= until_s {
            break;
        }
        // A shorter phase does nothing, and its motion has no digits.
        if long < 1e-6 * contact_s {
            continue;
        }
        if on == [false; 2] {
            points.extend([(from, [0.0; 2]), (to, [0.0; 2])]);
            continue;
        }
        // A contact that lasts does most of what it does at first.
        let pushed = match flight.velocity_in(phase + 1) {
            Some(end) if long <= 1.5 * contact_s => {
                let start = flight.velocity_in(phase).unwrap_or_default();
                (0..2).fold(0.0_f64, |m, i| m.max(CREST * (end[i] - start[i] + g * long).abs()))
            }
            _ => [0.0, 0.5].iter().fold(0.0_f64, |m, x| {
                let sample = flight.sample_in(phase, x * contact_s.min(long));
                sample.acceleration_m_s2.iter().fold(m, |m, a| m.max((a + g).abs() * contact_s.min(long)))
            }),
        };
        if pushed == 0.0 {
            points.extend([(from, [0.0; 2]), (to, [0.0; 2])]);
            continue;
        }
        let share = (pushed / largest).min(1.0);
        let cells = (cells * share.sqrt()).max((0.5 * cells).clamp(1.0, 6.0));
        let step = cut(&mut doublings, rate, from - changed, long, contact_s, cells);
        let mut steps = flight.steps_in(phase, even(step), &doublings);
        let mut now = steps.next();
        for next in steps {
            if let Some((t, motion)) = now {
                let [a, b] = [0, 1].map(|i| piece(next.0 - t, motion[i], next.1[i]));
                // Not into the next phase by a rounding.
                points.extend([(from + t, [a[0], b[0]]), ((from + next.0).min(to), [a[1], b[1]])]);
            }
            now = Some(next);
        }
    }
    let end = points.last().map_or(0.0, |p| p.0);
    let weight = rests.then(|| flight.sample(end).acceleration_m_s2.map(|a| a + g));
    Pushes { points, weight }
}

/// The pushes at one place, `at` what it gets of both ends, and the weight for as long as a component takes notice of
/// it.
pub(crate) fn at_place(pushes: &Pushes, suspension: &Suspension, at: impl Fn([f64; 2]) -> f64) -> Polygon {
    let mut points: Polygon = pushes.points.iter().map(|&(t, a)| (t, at(a))).collect();
    if let Some(weight) = pushes.weight {
        let (end, weight) = (points.last().map_or(0.0, |p| p.0), at(weight));
        let period = std::f64::consts::TAU / suspension.omega();
        let keep = end + WEIGHT_PERIODS[0] * period;
        points.extend([(end, weight), (keep, weight), (keep + WEIGHT_PERIODS[1] * period, 0.0)]);
    }
    points
}

/// How one phase is cut, `age` after contacts changed: `cells` or so pieces over a contact time, denser just after a
/// change, and ever fewer over a contact that lasts, which only carries the body in the end. How often the first step,
/// which it returns, is doubled.
fn cut(doublings: &mut Vec<u32>, rate: f64, age: f64, long: f64, contact_s: f64, cells: f64) -> f64 {
    doublings.clear();
    let longest = contact_s / cells;
    let first = if age > 0.0 { longest + 0.05 * age } else { (3.0 / (cells * rate)).min(longest) };
    let first = first.min(if age > 0.0 { long } else { long / cells.min(4.0) });
    let (mut step, mut doubled, mut t) = (first, 0, 0.0);
    loop {
        let most = if age + t < 4.0 * contact_s { longest } else { f64::INFINITY };
        // Each may be longer than the last by 4/cells of it. Doubled as late as this, they are as close as if each
        // were.
        while 1.6 * step < (first + 4.0 / cells * t).min(most) {
            (step, doubled) = (2.0 * step, doubled + 1);
        }
        doublings.push(doubled);
        t += step;
        if t + 0.5 * step >= long {
            return first * long / t;
        }
    }
}

/// Velocity shocks as pulses of lone contacts in so many `cells`, added up where they overlap.
pub(crate) fn of_shocks(shocks: &[VelocityShock], e: f64, contact_s: f64, cells: usize) -> Polygon {
    let pulse = Pulse::new(e);
    // Each next one for shocks of a 64th.
    let shapes = [cells, cells.min(cells / 8 + 4), cells.min(8)].map(|cells| pulse.pieces(cells));
    let triangle = vec![[(0.0, 0.0), (0.5, 2.0)], [(0.5, 2.0), (1.0, 0.0)]];
    let largest = shocks.iter().fold(0.0_f64, |m, s| m.max(s.delta_v.abs()));
    // (time, jump, change of slope)
    let mut corners: Vec<(f64, f64, f64)> = Vec::new();
    for shock in shocks {
        let share = shock.delta_v.abs() / largest;
        let pieces = match share {
            s if s > 0.015 => &shapes[0],
            s if s > 2e-4 => &shapes[1],
            s if s > SMALL => &shapes[2],
            _ => &triangle,
        };
        if share < SMALL * SMALL {
            continue;
        }
        let height = shock.delta_v / contact_s;
        let (mut value, mut slope) = (0.0, 0.0);
        for &[(t, a), (u, b)] in pieces {
            let next = (b - a) / (u - t);
            corners.push((shock.time + contact_s * t, height * (a - value), height / contact_s * (next - slope)));
            (value, slope) = (b, next);
        }
        corners.push((shock.time + contact_s, -height * value, -height / contact_s * slope));
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut a, mut slope, mut time) = (0.0, 0.0, corners.first().map_or(0.0, |c| c.0));
    let mut points = vec![(time, 0.0)];
    for (t, jump, bend) in corners {
        a += slope * (t - time);
        points.push((t, a));
        if jump != 0.0 {
            a += jump;
            points.push((t, a));
        }
        slope += bend;
        time = t;
    }
    points
}

/// Largest change of velocity within a time, with its sign.
///
/// Over a window that moves, from one corner at either of its ends to the next, the change is a parabola.
pub(crate) fn largest_change(polygon: &[(f64, f64)], within_s: f64) -> f64 {
    let mut velocity = Vec::with_capacity(polygon.len());
    let mut sum = 0.0;
    velocity.push(sum);
    for w in polygon.windows(2) {
        sum += 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0);
        velocity.push(sum);
    }
    // Velocity and acceleration at a time on the side that ends with corner `next`.
    let at = |next: usize, t: f64| {
        if next == 0 || next == polygon.len() {
            return [if next == 0 { 0.0 } else { sum }, 0.0];
        }
        let ((t0, a0), (t1, a1)) = (polygon[next - 1], polygon[next]);
        let h = t - t0;
        let rise = h * (a1 - a0) / (t1 - t0);
        [velocity[next - 1] + h * (a0 + 0.5 * rise), a0 + rise]
    };
    // A jump is two corners at one time.
    let passed = |next: usize| {
        let time = polygon[next].0;
        next + polygon[next..].iter().take_while(|corner| corner.0 <= time).count()
    };
    let (mut tail, mut head) = (0, 0);
    let (mut from, mut before, mut rate, mut largest) = (f64::NEG_INFINITY, 0.0, 0.0, 0.0_f64);
    loop {
        // The head of the window is never behind its tail.
        let to = match (polygon.get(tail), polygon.get(head)) {
            (Some((tail_s, _)), Some((head_s, _))) if head_s - within_s < *tail_s => {
                head = passed(head);
                head_s - within_s
            }
            (Some((tail_s, _)), _) => {
                tail = passed(tail);
                *tail_s
            }
            _ => return largest,
        };
        let ([ahead, after_ahead], [behind, after_behind]) = (at(head, to + within_s), at(tail, to));
        let after = ahead - behind;
        // before + slope x + bend x², x from 0 to 1
        let slope = rate * (to - from);
        let turn = -0.5 * slope / (after - before - slope);
        let mut larger = |found: f64| {
            if found.abs() > largest.abs() {
                largest = found;
            }
        };
        if turn > 0.0 && turn < 1.0 {
            larger(before + 0.5 * slope * turn);
        }
        larger(after);
        (from, before, rate) = (to, after, after_ahead - after_behind);
    }
}

#[cfg(test)]
mod tests {
    use super::{largest_change, of_contacts};
    use clatter::flight::{Body, Scene};

    /// However short contacts are beside the time between them, and however few pieces they get, their pushes do what
    /// the flight does.
    #[test]
    fn pushes_do_what_the_contacts_do() {
        let body = Body::new(0.14, 0.0404).expect("a phone");
        for contact_s in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            for (e, tilt) in [(0.3, 20.0), (0.5, 5.0), (0.9, 1.0)] {
                let scene = Scene::new(body, e, 0.1, tilt, 0.0).and_then(|scene| scene.with_impact_limit(3));
                let scene = scene.expect("a drop");
                let flight = scene.simulate_compliant(contact_s).expect("a contact");
                for cells in [3.0, 40.0] {
                    let points = of_contacts(&scene, &flight, f64::INFINITY, contact_s, cells).points;
                    let mut change = [0.0; 2];
                    for pair in points.windows(2) {
                        let ((from, before), (to, after)) = (pair[0], pair[1]);
                        assert!(from <= to, "{contact_s}: {pair:?}");
                        for (i, change) in change.iter_mut().enumerate() {
                            *change += 0.5 * (before[i] + after[i]) * (to - from);
                        }
                    }
                    for (i, change) in change.into_iter().enumerate() {
                        let of = |size: fn(f64) -> f64| {
                            flight.flight.strikes.iter().map(|s| size(s.delta_v_m_s[i])).sum::<f64>()
                        };
                        // The lever arms of a contact are those of its beginning, and times are known to an ulp.
                        let within = 10.0 * contact_s + 2e-16 / contact_s + 1e-7;
                        let off = (change - of(|v| v)).abs() / of(f64::abs);
                        assert!(off < within, "contacts of {contact_s} s, e {e}, {cells} cells: {off:e}");
                    }
                }
            }
        }
    }

    /// Of a triangle the window that lies evenly about the crest holds most.
    #[test]
    fn the_largest_change_stands_between_corners() {
        let crest = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)];
        let is = |polygon: &[(f64, f64)], within, change: f64| {
            let found = largest_change(polygon, within);
            assert!((found - change).abs() < 1e-15, "{found} within {within}, not {change}");
        };
        is(&crest, 1.0, 0.75);
        is(&crest, 0.5, 0.4375);
        is(&crest, 4.0, 1.0);
        is(&crest.map(|(t, a)| (t, -3.0 * a)), 1.0, -2.25);
        is(&[], 1.0, 0.0);
        is(&[(1.0, 2.0)], 1.0, 0.0);
    }
}
