//! One bar, strike by strike, with as much physics as its lane keeps.
//!
//! Between strikes both ends follow parabolas. With real tilt the turning bends them by `−σ L ω² sin φ`: its means over the flight, as
//! it acts on the height and on the velocity, are series in the angle turned, whose fifth powers are left out. A contact moves the bar as one
//! impulse at its centroid does: beside the jump Δv both ends are set back by Δv times that time. The jump grows by what the contact
//! carries of the weight.

use clatter::flight::Scene;

use super::both::Both;
use super::pulse::Pulse;

/// What all lanes share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) arm: [f64; 2],
    /// 1/length.
    over: f64,
    pub(super) gyration2: f64,
    pub(super) e: f64,
    /// Position of the component in [−1, 1].
    pub(super) position: f64,
}

impl Ends {
    pub(super) fn new(scene: &Scene, position: f64) -> Self {
        let body = scene.body();
        let (arm, gyration2) = (body.arms_m(), body.gyration_m().powi(2));
        Self { arm, over: 1.0 / (arm[0] + arm[1]), gyration2, e: scene.e(), position }
    }
    /// Distance of the component from the center of mass, toward end b.
    pub(super) fn offset(&self) -> f64 {
        0.5 * ((1.0 + self.position) * self.arm[1] - (1.0 - self.position) * self.arm[0])
    }
    /// What the component gets of what both ends do.
    pub(super) fn at(&self, [a, b]: [f64; 2]) -> f64 {
        0.5 * ((1.0 - self.position) * a + (1.0 + self.position) * b)
    }
    /// Bound on the speed at the component: all energy in its motion, `√(2E (1 + x²/ρ²))`.
    pub(super) fn reach(&self, twice_energy: f64) -> f64 {
        let x = self.offset();
        let lever = if x == 0.0 { 1.0 } else { 1.0 + x * x / self.gyration2 };
        (twice_energy * lever).sqrt()
    }
    /// Inertia ratio of a strike at end i at an angle of this cos².
    pub(super) fn ratio(&self, i: usize, cos2: f64) -> f64 {
        let over = self.arm[0] * self.arm[1] * cos2 - self.gyration2;
        over / (self.arm[i] * self.arm[i] * cos2 + self.gyration2)
    }
}

/// The state of one lane just after a strike.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lane {
    height: [f64; 2],
    velocity: [f64; 2],
    gravity: f64,
    tilts: bool,
    /// Time from touch to centroid, and in which the weight gives what a contact carries of it.
    delay: f64,
    carried: f64,
    down: Down,
}

/// What lies on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Down {
    Nothing,
    /// One end, and the other turns about it, after the time that its bounces took.
    End(usize, f64),
    Bar,
}

/// An end whose bounces all end within this share of the time that the other needs to land is down at once.
const BRIEF: f64 = 0.05;

/// The turning of a lane: sine of the angle, its rate, and the spin squared.
#[derive(Debug, Clone, Copy)]
struct Sweep {
    sin: f64,
    rate: f64,
    spin2: f64,
}

/// cos² of the angle from which on a bar counts as upright: its sine no longer tells how fast it turns.
const LEAST_COS2: f64 = 1e-3;

impl Sweep {
    /// Means of sin φ over a time, as it acts on heights and on velocities: series of `2 (sin φ + x cos φ − sin(φ + x))/x²` and
    /// `(cos φ − cos(φ + x))/x`, x = ω t.
    fn means(&self, t: f64) -> [f64; 2] {
        let (x2, turned) = (self.spin2 * t * t, self.rate * t);
        [
            self.sin * (1.0 - x2 / 12.0) + turned * (1.0 / 3.0 - x2 / 60.0),
            self.sin * (1.0 - x2 / 6.0) + turned * (0.5 - x2 / 24.0),
        ]
    }
}

/// The next strike of a lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Next {
    pub(super) end: usize,
    /// Time since the last one.
    pub(super) after: f64,
    /// Downward acceleration of an end that turns about the other.
    turning: f64,
    /// Whether the bar turns upright or over before: what strikes then is not known from parabolas.
    pub(super) tumbles: bool,
    /// When the other end would strike, and how fast; infinite where it does not fall.
    pub(super) rival: [f64; 2],
    /// How a lane with real tilt turns until then.
    sweep: Option<Sweep>,
}

/// No rival.
const ALONE: [f64; 2] = [f64::INFINITY, 0.0];

impl Next {
    /// The first touch.
    pub(super) const FIRST: Self = Self { end: 0, after: 0.0, turning: 0.0, tumbles: false, rival: ALONE, sweep: None };
}

/// Time until `h + v t − ½ g t²` comes to 0, the later root where it starts upward; 0 where it is below.
fn fall(h: f64, v: f64, g: f64) -> f64 {
    let square = v * v + 2.0 * g * h;
    if g <= 0.0 {
        return if v < 0.0 && square >= 0.0 { (2.0 * h / (square.sqrt() - v)).max(0.0) } else { f64::INFINITY };
    }
    let root = square.max(0.0).sqrt();
    if square < 0.0 {
        0.0
    } else if v >= 0.0 {
        (v + root) / g
    } else {
        (2.0 * h / (root - v)).max(0.0)
    }
}

impl Lane {
    /// The scene at its first touch, without gravity; the cosine of its tilt counts where it spins.
    pub(super) fn start(scene: &Scene, cos: f64) -> Self {
        let [a, b] = scene.body().arms_m();
        let (spin, speed) = (scene.spin_rad_s(), scene.speed_m_s());
        Self {
            height: [0.0, scene.height_gap_m()],
            velocity: [-speed - a * cos * spin, -speed + b * cos * spin],
            gravity: 0.0,
            tilts: false,
            delay: 0.0,
            carried: 0.0,
            down: Down::Nothing,
        }
    }
    pub(super) fn with_gravity(self, gravity: f64) -> Self {
        Self { gravity, ..self }
    }
    pub(super) fn with_tilt(self) -> Self {
        Self { tilts: true, ..self }
    }
    pub(super) fn with_contact(self, pulse: &Pulse, time: f64) -> Self {
        Self { delay: time * pulse.centroid, carried: time * pulse.carried, ..self }
    }
    fn sweep(&self, ends: &Ends) -> Sweep {
        let sin = ends.over * (self.height[1] - self.height[0]);
        let rate = ends.over * (self.velocity[1] - self.velocity[0]);
        let cos2 = ((1.0 - sin) * (1.0 + sin)).max(LEAST_COS2);
        Sweep { sin, rate, spin2: rate * rate / cos2 }
    }
    /// The next strike; `None` if nothing falls.
    pub(super) fn next(&self, ends: &Ends) -> Option<Next> {
        let g = self.gravity;
        if self.down == Down::Bar {
            return None;
        }
        if let Down::End(i, bounced) = self.down {
            let j = 1 - i;
            let turning = g * (1.0 + ends.ratio(i, 1.0));
            let after = bounced + fall(self.height[j], self.velocity[j], turning);
            return (after < f64::INFINITY).then_some(Next { end: j, after, turning, ..Next::FIRST });
        }
        let lands = |i: usize, down: f64| fall(self.height[i], self.velocity[i], down);
        let mut times = [lands(0, g), lands(1, g)];
        let first = times[0].min(times[1]);
        if first == f64::INFINITY {
            return None;
        }
        if !self.tilts {
            let end = usize::from(times[1] < times[0]);
            return Some(Next { end, after: first, ..Next::FIRST });
        }
        let sweep = self.sweep(ends);
        let [a, b] = ends.arm;
        let bend = sweep.spin2 * sweep.means(first)[0];
        let sinks = [g - a * bend, g + b * bend];
        times = [lands(0, sinks[0]), lands(1, sinks[1])];
        // The bend was that of another time: once more, as a straight line.
        let again = |end: usize, after: f64| {
            let arm = if end == 0 { -a } else { b };
            let [height, velocity] = sweep.means(after).map(|mean| g + arm * sweep.spin2 * mean);
            let low = self.height[end] + after * (self.velocity[end] - 0.5 * height * after);
            let speed = self.velocity[end] - velocity * after;
            let most = 0.1 * after;
            if speed < 0.0 { (after - (low / speed).clamp(-most, most)).max(0.0) } else { after }
        };
        let mut end = usize::from(times[1] < times[0]);
        if times[end] == f64::INFINITY {
            return None;
        }
        times[end] = again(end, times[end]);
        let mut other = 1 - end;
        // `again` moves each by a tenth at most, so that no other order is possible beyond.
        if times[other] < 1.25 * times[end] {
            times[other] = again(other, times[other]);
            if times[other] < times[end] {
                (end, other) = (other, end);
            }
        }
        let [after, later] = [times[end], times[other]];
        let rival = [later, sinks[other] * later - self.velocity[other]];
        let tumbles = (sweep.sin + after * sweep.rate).abs() > 1.0;
        Some(Next { end, after, turning: 0.0, tumbles, rival, sweep: Some(sweep) })
    }
    /// Flies and strikes; returns the velocity shocks of both ends.
    pub(super) fn strike(&mut self, ends: &Ends, next: &Next) -> [f64; 2] {
        // All that follows for a known end: what is indexed by a variable goes through memory.
        if next.end == 0 { self.strike_at::<0>(ends, next) } else { self.strike_at::<1>(ends, next) }
    }
    fn strike_at<const I: usize>(&mut self, ends: &Ends, next: &Next) -> [f64; 2] {
        let (i, t, mut lane) = (I, next.after, *self);
        let mut falls = [lane.gravity; 2];
        if let Down::End(_, bounced) = std::mem::replace(&mut lane.down, Down::Nothing) {
            lane.velocity[i] -= (t - bounced) * next.turning;
        } else {
            let mut sinks = falls;
            if lane.tilts {
                let sweep = next.sweep.unwrap_or_else(|| lane.sweep(ends));
                let [height, velocity] = sweep.means(t);
                for (k, arm) in [-ends.arm[0], ends.arm[1]].into_iter().enumerate() {
                    sinks[k] += arm * sweep.spin2 * height;
                    falls[k] += arm * sweep.spin2 * velocity;
                }
            }
            for k in 0..2 {
                lane.height[k] += t * (lane.velocity[k] - 0.5 * sinks[k] * t);
                lane.velocity[k] -= t * falls[k];
            }
        }
        lane.height[i] = 0.0;
        let sin = if lane.tilts { (lane.height[1 - i] * ends.over).clamp(-0.9, 0.9) } else { 0.0 };
        let ratio = ends.ratio(i, (1.0 - sin) * (1.0 + sin));
        let jump = lane.carried * falls[i].max(0.0) - (1.0 + ends.e) * lane.velocity[i].min(0.0);
        let mut delta_v = [-ratio * jump; 2];
        delta_v[i] = jump;
        for (k, jump) in delta_v.into_iter().enumerate() {
            lane.height[k] -= jump * lane.delay;
            lane.velocity[k] += jump;
        }
        if lane.tilts && lane.delay > 0.0 {
            lane.turn_back(ends, sin);
        }
        lane.settle::<I>(ends, ratio);
        *self = lane;
        delta_v
    }
    /// Set back from the sine of an angle, the spin is the same, and its vertical part is not.
    #[inline]
    fn turn_back(&mut self, ends: &Ends, from: f64) {
        let [a, b] = ends.arm;
        let to = ends.over * (self.height[1] - self.height[0]);
        let squares = ((1.0 - to) * (1.0 + to)).max(LEAST_COS2) / ((1.0 - from) * (1.0 + from));
        let change = ends.over * (self.velocity[1] - self.velocity[0]) * (squares.sqrt() - 1.0);
        self.velocity[0] -= a * change;
        self.velocity[1] += b * change;
    }
    /// Lets end i lie where it would bounce ever less for a short while, or where its contact does not lift it out of the ground again.
    #[inline]
    fn settle<const I: usize>(&mut self, ends: &Ends, ratio: f64) {
        let (h, w) = (self.height[I], self.velocity[I]);
        // Turning lifts it.
        let sweep = self.sweep(ends);
        let lift =
            if self.tilts { ends.arm[I] * sweep.spin2 * if I == 0 { sweep.sin } else { -sweep.sin } } else { 0.0 };
        let g = self.gravity - lift;
        let sunk = w * w + 2.0 * g * h < 0.0;
        if sunk && self.velocity[1 - I] >= 0.0 && self.is_sunk(1 - I) {
            self.down = Down::Bar;
            return;
        }
        let lands = self.lands(1 - I);
        if g > 0.0 && lands > 0.0 && w >= 0.0 && (sunk || 2.0 * w < BRIEF * lands * g * (1.0 - ends.e)) {
            self.lie_at::<I>(ends, ratio, if sunk { 0.0 } else { lands });
        }
    }
    /// Whether an end has no speed to come out of the ground with.
    fn is_sunk(&self, k: usize) -> bool {
        self.velocity[k] * self.velocity[k] + 2.0 * self.gravity * self.height[k] < 0.0
    }
    /// When end j would land by gravity alone; 0 where that is not to come.
    fn lands(&self, j: usize) -> f64 {
        if self.gravity > 0.0 { fall(self.height[j], self.velocity[j], self.gravity) } else { 0.0 }
    }
    /// Lets an end lie; without contacts, whose ends can not sink, once its bounces have ended, if the other lands after that.
    pub(super) fn lie(&mut self, ends: &Ends, end: usize) {
        let (lands, ratio) = (self.lands(1 - end), ends.ratio(end, 1.0));
        let sum = self.velocity[end].max(0.0) / (1.0 - ends.e);
        let lands = if self.delay > 0.0 {
            0.0
        } else if 2.0 * sum < lands * self.gravity {
            lands
        } else {
            return;
        };
        if end == 0 { self.lie_at::<0>(ends, ratio, lands) } else { self.lie_at::<1>(ends, ratio, lands) }
    }
    /// Bounces of w, e w, … last 2S/g in all, S = w/(1 − e), if they end before the other end `lands`.
    fn lie_at<const I: usize>(&mut self, ends: &Ends, ratio: f64, lands: f64) {
        let (i, j, sum) = (I, 1 - I, self.velocity[I].max(0.0) / (1.0 - ends.e));
        let mut bounced = 2.0 * sum / self.gravity;
        if bounced < lands {
            self.height[j] += bounced * (self.velocity[j] - sum);
            self.velocity[j] -= (2.0 + ratio * (1.0 + ends.e)) * sum;
            if self.tilts {
                // It lands with what its spin has, of which this is the vertical part.
                let sin = (self.height[j] * ends.over).min(0.9);
                self.velocity[j] /= ((1.0 - sin) * (1.0 + sin)).sqrt();
            }
        } else {
            bounced = 0.0;
        }
        (self.height[i], self.velocity[i], self.down) = (0.0, 0.0, Down::End(i, bounced));
    }
    /// The end that lies on the ground, if one does.
    pub(super) fn lying(&self) -> Option<usize> {
        if let Down::End(end, _) = self.down { Some(end) } else { None }
    }
    /// Whether the next strike presses the end that lies there into the ground.
    pub(super) fn is_pressed_by(&self, ends: &Ends, next: &Next, contact_s: f64) -> bool {
        self.lying().is_some() && next.after >= contact_s && ends.ratio(next.end, 1.0) > 0.0
    }
    /// Flies until the other end lands, and does what both do together; returns the velocity shocks of both ends.
    pub(super) fn strike_lying(&mut self, ends: &Ends, next: &Next, both: &Both, contact_s: f64) -> [f64; 2] {
        let Down::End(_, bounced) = std::mem::replace(&mut self.down, Down::Nothing) else { return [0.0; 2] };
        let speed = (next.after - bounced) * next.turning - self.velocity[next.end];
        self.height = both.set_back.map(|back| speed * contact_s * back);
        self.velocity = both.velocity.map(|velocity| speed * velocity);
        let mut delta_v = self.velocity;
        delta_v[next.end] += speed;
        match [self.is_sunk(0), self.is_sunk(1)] {
            [true, true] => self.down = Down::Bar,
            [true, false] => self.lie(ends, 0),
            [false, true] => self.lie(ends, 1),
            [false, false] => {}
        }
        delta_v
    }
    /// Twice the energy over the mass, where it turns like this until its next strike.
    pub(super) fn twice_energy_until(&self, ends: &Ends, next: Option<&Next>) -> f64 {
        let [a, b] = ends.arm;
        let center = (b * self.velocity[0] + a * self.velocity[1]) * ends.over;
        let sweep = next.and_then(|next| next.sweep).unwrap_or_else(|| self.sweep(ends));
        let spin2 = if self.tilts { sweep.spin2 } else { sweep.rate * sweep.rate };
        let height = ((b * self.height[0] + a * self.height[1]) * ends.over).max(0.0);
        center * center + ends.gyration2 * spin2 + 2.0 * self.gravity * height
    }
    /// What a strike at end i that changed its velocity by this took of it, just after that; what the contact carries of the weight
    /// takes nothing.
    pub(super) fn twice_lost(&self, ends: &Ends, i: usize, jump: f64) -> f64 {
        let jump = (jump - self.carried * self.gravity).max(0.0);
        let sin = if self.tilts { self.height[1 - i] * ends.over } else { 0.0 };
        let arm2 = ends.arm[i] * ends.arm[i] * (1.0 - sin * sin).max(0.0);
        jump * jump * (1.0 - ends.e) / (1.0 + ends.e) * ends.gyration2 / (ends.gyration2 + arm2)
    }
    /// Twice the energy over the mass.
    pub(super) fn twice_energy(&self, ends: &Ends) -> f64 {
        self.twice_energy_until(ends, None)
    }
}
