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

/// How long, in periods of the component, the weight is kept after rest, and how long it is then taken away without ringing.
const WEIGHT_PERIODS: [f64; 2] = [2.0, 64.0];
/// Contact times after rest in which the contacts are followed until they only carry the weight.
const SETTLED: f64 = 1e3;
/// Shocks below this share of the largest are triangles, below its square nothing.
const SMALL: f64 = 1e-5;

/// What the contacts of a compliant flight do to both ends, from their velocities and heights, free fall taken off.
///
/// Between changes of contact the motion is smooth; `cells` pieces are laid over a contact that does all, fewer (with the square
/// root of its share of the largest shock of an end) over one that does less, denser where it begins. Each piece has the exact change of velocity and the exact
/// path, so that its effect on a component is off by the fourth power of its length.
pub(crate) fn of_contacts(scene: &Scene, flight: &CompliantFlight, until_s: f64, contact_s: f64, cells: f64) -> Pushes {
    let g = scene.gravity_m_s2();
    let piece = |from: f64, to: f64, start, end| straight(to - from, start, end).map(|a| a + g);
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
    let mut points = Vec::with_capacity(16 * cuts.len());
    points.push((0.0, [0.0; 2]));
    let mut nodes = Vec::new();
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
        let first = long.min(contact_s);
        let push = [0.02, 0.5].iter().fold(0.0_f64, |m, x| {
            let sample = flight.sample(from + x * first);
            sample.acceleration_m_s2.iter().fold(m, |m, a| m.max((a + g).abs()))
        });
        if push == 0.0 {
            points.extend([(from, [0.0; 2]), (to, [0.0; 2])]);
            continue;
        }
        let share = (push * first / largest).min(1.0);
        let cells = (cells * share.sqrt()).max((0.5 * cells).clamp(1.0, 6.0));
        cut(&mut nodes, rate, from - changed, long, contact_s, cells);
        // Just before its end, not in what follows.
        let last = to - 1e-9 * long.min(contact_s);
        let motion = |t| flight.motion_in(phase, t);
        let mut now = (from, motion(from));
        for t in &nodes {
            let time = (from + t).min(last);
            let next = (time, motion(time));
            let [a, b] = [0, 1].map(|i| piece(now.0, next.0, now.1[i], next.1[i]));
            points.extend([(now.0, [a[0], b[0]]), (next.0, [a[1], b[1]])]);
            now = next;
        }
    }
    let end = points.last().map_or(0.0, |p| p.0);
    let weight = rests.then(|| flight.sample(end).acceleration_m_s2.map(|a| a + g));
    Pushes { points, weight }
}

/// The pushes at one place, `at` what it gets of both ends, and the weight for as long as a component takes notice of it.
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

/// Times after 0 at which one phase is cut, `age` after contacts changed: `cells` or so over a contact time, denser just after a change,
/// and ever fewer over a contact that lasts, which only carries the body in the end.
fn cut(nodes: &mut Vec<f64>, rate: f64, age: f64, long: f64, contact_s: f64, cells: f64) {
    nodes.clear();
    let longest = contact_s / cells;
    let first = if age > 0.0 { longest + 0.05 * age } else { (3.0 / (cells * rate)).min(longest) };
    let mut step = first.min(if age > 0.0 { long } else { long / cells.min(4.0) });
    let mut t = 0.0;
    while t + 1.5 * step < long {
        t += step;
        nodes.push(t);
        let most = if age + t < 4.0 * contact_s { longest } else { f64::INFINITY };
        step = (step * (1.0 + 4.0 / cells)).min(most);
    }
    nodes.push(long);
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
    let (mut tail, mut head) =
        (Cursor { polygon, velocity: &velocity, next: 0 }, Cursor { polygon, velocity: &velocity, next: 0 });
    let mut change = |t: f64| head.at(t + within_s) - tail.at(t);
    let (mut begins, mut ends) =
        (polygon.iter().map(|p| p.0).peekable(), polygon.iter().map(|p| p.0 - within_s).peekable());
    let Some(mut from) = ends.next() else { return 0.0 };
    let mut before = change(from);
    let mut largest = before;
    loop {
        let to = match (begins.peek(), ends.peek()) {
            (Some(begin), Some(end)) if begin < end => begins.next(),
            (_, Some(_)) => ends.next(),
            _ => begins.next(),
        };
        let Some(to) = to else { return largest };
        // A jump of the acceleration is two corners at one time.
        if to <= from {
            continue;
        }
        let (middle, after) = (change(0.5 * (from + to)), change(to));
        // before + slope x + bend x², x from 0 to 1
        let (slope, bend) = (4.0 * middle - 3.0 * before - after, 2.0 * (before + after - 2.0 * middle));
        let turn = -0.5 * slope / bend;
        let mut larger = |found: f64| {
            if found.abs() > largest.abs() {
                largest = found;
            }
        };
        if turn > 0.0 && turn < 1.0 {
            larger(before + 0.5 * slope * turn);
        }
        larger(after);
        (from, before) = (to, after);
    }
}

/// The velocity under a polygon of accelerations, at times that do not run back.
struct Cursor<'a> {
    polygon: &'a [(f64, f64)],
    velocity: &'a [f64],
    /// The first corner after the last time asked.
    next: usize,
}

impl Cursor<'_> {
    fn at(&mut self, t: f64) -> f64 {
        while self.polygon.get(self.next).is_some_and(|p| p.0 <= t) {
            self.next += 1;
        }
        let k = self.next;
        if k == 0 || k == self.polygon.len() {
            return if k == 0 { 0.0 } else { self.velocity[k - 1] };
        }
        let ((t0, a0), (t1, a1)) = (self.polygon[k - 1], self.polygon[k]);
        let h = t - t0;
        self.velocity[k - 1] + h * (a0 + 0.5 * h * (a1 - a0) / (t1 - t0))
    }
}

#[cfg(test)]
mod tests {
    use super::largest_change;

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
