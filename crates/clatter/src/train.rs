//! The train, impact by impact.

use crate::motion::{Digits, Drive, Fours, Kind, NORMAL, Sweep, Then, after_first};
use crate::summary::least;
use crate::symmetric::Symmetric;
use crate::{Bar, Count, End, Start};

/// One impact of the train.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impact {
    /// Number of the impact, from 1.
    pub number: u64,
    /// The end that strikes.
    pub end: End,
    /// Time since the first contact, in h0/v0.
    pub time: f64,
    /// Velocity of the striking end just before, negative.
    pub approach: f64,
    /// Jumps of the velocities of ends a and b: −(1 + e) times the approach velocity at the end that strikes, q(1 + e)
    /// times it at the other (Eq. 2), with q that of the end that strikes ([`Bar::inertia_ratios`]).
    pub delta_v: [f64; 2],
}

impl Impact {
    /// Returns the velocity shock at position `s` in [−1, 1] (−1 is end a): `((1 − s) Δv_a + (1 + s) Δv_b)/2` (Eq. 3).
    ///
    /// # Examples
    /// A strike at end a does not move its center of percussion:
    /// ```
    /// let bar = clatter::Bar::new(0.5, 0.3)?;
    /// let first = bar.train(&clatter::Start::default()).next().unwrap();
    /// assert!(first.delta_v_at(bar.percussion(clatter::End::A)).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn delta_v_at(&self, s: f64) -> f64 {
        0.5 * ((1.0 - s) * self.delta_v[0] + (1.0 + s) * self.delta_v[1])
    }
}

/// Iterator over the impacts of a train; without end where the train is endless. Made by [`Bar::train`].
///
/// Times never step back. Whole trains are quickest taken from within, by `for_each`, `fold` or `sum`.
#[derive(Debug, Clone)]
pub struct Train {
    bar: Symmetric,
    jumps: Jumps,
    start: Start,
    /// Number of impacts given so far.
    number: u64,
    steps: Steps,
    later: Option<Box<Later>>,
    /// Index of the next impact in the buffers of `later`.
    at: usize,
}

/// Jumps of a bar, by the approach velocities of the symmetric one.
#[derive(Debug, Clone, Copy)]
struct Jumps {
    e: f64,
    /// q(1 + e) of strikes at end a: jump of the other end over the approach velocity.
    far: f64,
    /// The jump of strikes at end b, and κ, where the center of mass is not the middle. Symmetric bars pay a branch for
    /// it every other impact, no more.
    end_b: Option<[f64; 2]>,
}

impl Jumps {
    #[inline]
    fn symmetric(bar: &Symmetric) -> Self {
        Self { e: bar.e, far: bar.t, end_b: None }
    }

    /// Returns an impact of the symmetric bar as one of this bar.
    #[inline]
    fn own(&self, Impact { number, end, approach, time, .. }: Impact) -> Impact {
        self.impact(number, end, approach, time)
    }

    /// Returns the impact with the jumps of both ends.
    #[inline]
    fn impact(&self, number: u64, end: End, approach: f64, time: f64) -> Impact {
        let jumps = |approach: f64, far: f64| [(-1.0 - self.e) * approach, far * approach];
        let (approach, [struck, free]) = match self.end_b {
            Some([far, kappa]) if end == End::B => (approach / kappa, jumps(approach / kappa, far)),
            _ => (approach, jumps(approach, self.far)),
        };
        Impact { number, end, time, approach, delta_v: if end == End::A { [struck, free] } else { [free, struck] } }
    }
}

/// The recurrence before the next impact.
///
/// Each end has one of its own, so that the strikes of one need not wait for those of the other. With
/// g_n = a_{n+2} − e a_n and D = 4e − T²,
/// ```text
/// a_{n+2} = e a_n + g_n,  g_{n+2} = (e − D) g_n − eD a_n.
/// ```
#[derive(Debug, Clone, Copy)]
struct Steps {
    /// a_n of the next strike of each end.
    approach: [f64; 2],
    /// g_n of these.
    growth: [f64; 2],
    /// e − D and eD.
    turn: [f64; 2],
    /// (t_n − t_{n+1}) a_n a_{n+1} = h0 a_1 e^{n−1}, the Casoratian of velocities and heights.
    gap: f64,
    /// Time of the next impact.
    time: f64,
    /// The share of its terms down to which a_{n+2} may cancel.
    clear: f64,
    /// No plain step leads beyond this impact.
    last: u64,
    /// True if `last` is the last impact of the train.
    ends: bool,
}

impl Steps {
    /// No plain steps are left. It is set after every call, so that the fields of the steps need not be kept through
    /// it.
    const OVER: Self = Self {
        approach: [0.0; 2],
        growth: [0.0; 2],
        turn: [0.0; 2],
        gap: 0.0,
        time: 0.0,
        clear: 0.0,
        last: 0,
        ends: false,
    };

    /// Creates the steps before the first impact.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "as `Bar::train`")]
    fn new(bar: &Symmetric, start: &Start) -> Self {
        let ([va, vb], h0, Symmetric { e, t, less, more, .. }) = (start.velocity(), start.height_gap(), *bar);
        let second = t * va + vb;
        // D = 4e − T² by the smaller terms.
        let (small, square) = (e <= 0.5, |x: f64| x * x);
        let d = if small { 4.0 * e - t * t } else { less * more * square(1.0 + e) - square(1.0 - e) };
        let last = if !start.plain {
            0
        } else if least(t, e) >= LARGE {
            if d >= 0.0399 * e {
                PLAIN
            } else {
                // θ > π/60, and e^60 is far from where floats end; or θ > π/223.
                let known = if small { e > 0.01 && d > 0.011 * e } else { d > 0.0008 * e + square(1.0 - e) / 128.0 };
                if known {
                    SLOW
                } else if Sweep::suits(bar) {
                    0
                } else {
                    PLAIN
                }
            }
        } else if t <= -LARGE && second.abs() > -CLEAR * vb {
            // a_2 = T v_a + v_b does not cancel. There are two impacts at most.
            1 + u64::from(second < 0.0)
        } else {
            0
        };
        let turn = [e - d, e * d];
        let c = e + turn[0];
        Self {
            approach: [va, second],
            growth: [c * va + t * vb, turn[0] * (t * va) + c * vb],
            turn,
            gap: h0 * va,
            time: 0.0,
            clear: 2.0 * CLEAR,
            last,
            ends: matches!(last, 1 | 2),
        }
    }
}

/// The state that the impacts after the plain steps begin from.
struct SoFar {
    latest: f64,
    ahead: u64,
    start: Start,
    bar: Symmetric,
}

/// Impacts that plain steps do not give, computed some at a time.
#[derive(Debug, Clone)]
struct Later {
    bar: Symmetric,
    start: Start,
    source: Source,
    /// Number of impacts, unless it is endless, beyond 2⁶⁴ or not yet known.
    count: Option<u64>,
    /// Number of impacts computed or skipped so far.
    ahead: u64,
    /// The latest impacts, up to the end of the buffers.
    approach: [f64; BUFFER],
    times: [f64; BUFFER],
    /// Time of the last of them.
    latest: f64,
}

/// The method that gives the impacts.
#[derive(Debug, Clone)]
enum Source {
    /// A train of up to some 400 impacts.
    Sweep(Sweep),
    /// Four strikes at a time, from the closed form.
    Fours(Box<(Drive, Fours)>),
    /// Each from the closed form.
    Closed(Box<Drive>),
    /// T ≤ 0: a second impact after `first`; e = 0: all further impacts at the instant of the second.
    Instant { first: f64, a: f64, t: f64, h0: f64 },
}

/// Number of impacts computed together.
const BUFFER: usize = 16;
/// Plain steps taken before the closed form, which forgets no digit, takes over.
const PLAIN: u64 = 32;
/// Plain steps of a slow wave whose D is known well enough: it ends before.
const SLOW: u64 = 256;
/// A velocity that cancels by more than this factor times its number is left to the closed form: |a_{n+2}| against e
/// |a_n|.
///
/// Of a wave with N impacts and θ ≈ π/N, a velocity that passes is N · 2θ times this factor of the amplitude at least,
/// or 1/326. Its error, in roundings of 2⁻⁵³ of the amplitude, is:
/// * 2.7 N from the steps: each of N/2 rounds the velocity twice and g, which is 2θ of the amplitude at most and counts
///   1/2θ times, three times;
/// * 0.64 N² from D = 4e − T², which is off by 16 roundings of e at most and turns the wave by N/8eθ of that;
/// * or 13 (1 + (1 − e)²/D) from D = (1 − q²)(1 + e)² − (1 − e)², off by 8 of D and of (1 − e)².
///
/// The sum is 2700 at most, where [`Bar::train`] lets plain steps go on: an error of 2700 · 326 · 2⁻⁵³ ≤ 1e−10.
const CLEAR: f64 = 1.0 / 2048.0;
/// Plain steps need T and e of at least this size, so that no term of theirs comes near the subnormal floats.
const LARGE: f64 = 1e-8;

impl Iterator for Train {
    type Item = Impact;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "through memory, an impact takes five times as long")]
    fn next(&mut self) -> Option<Impact> {
        let plain = if self.number.is_multiple_of(2) { self.step::<0>() } else { self.step::<1>() };
        if plain.is_some() {
            return plain;
        }
        if self.later.is_none() {
            if self.steps.ends {
                return None;
            }
            self.later = Some(Later::boxed(&self.so_far()));
            self.steps = Steps::OVER;
        }
        let later = self.later.as_mut()?;
        if self.at == BUFFER {
            self.at = later.fill();
            self.steps = Steps::OVER;
        }
        let (approach, time) = (*later.approach.get(self.at)?, *later.times.get(self.at)?);
        (self.at, self.number) = (self.at + 1, self.number + 1);
        Some(self.jumps.impact(self.number, End::striking(self.number), approach, time))
    }

    #[inline]
    fn fold<B, F: FnMut(B, Impact) -> B>(mut self, init: B, f: F) -> B {
        if self.jumps.end_b.is_some() {
            return self.fold_off_center(init, f);
        }
        self.jumps.end_b = None; // for the compiler, which does not ask again
        self.fold_inline(init, f)
    }

    /// Skips in constant time, except for the plain steps at the beginning.
    fn nth(&mut self, mut skip: usize) -> Option<Impact> {
        while self.later.is_none() {
            let impact = self.next()?;
            if skip == 0 {
                return Some(impact);
            }
            skip -= 1;
        }
        let waiting = BUFFER - self.at;
        if skip >= waiting {
            let later = self.later.as_mut()?;
            later.skip(skip - waiting);
            self.number = later.ahead;
            self.at = BUFFER;
        } else {
            self.number += skip as u64;
            self.at += skip;
        }
        self.next()
    }
}

impl Train {
    /// Folds step by step, then buffer by buffer: sums over whole trains need not ask for each impact separately.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "as `next`")]
    fn fold_inline<B, F: FnMut(B, Impact) -> B>(mut self, init: B, mut f: F) -> B {
        let mut all = init;
        if self.number % 2 == 1
            && let Some(impact) = self.step::<1>()
        {
            all = f(all, impact);
        }
        // Impacts come in pairs, so that nothing depends on the number.
        if self.number.is_multiple_of(2) {
            while let Some(impact) = self.step::<0>() {
                all = f(all, impact);
                let Some(impact) = self.step::<1>() else { break };
                all = f(all, impact);
            }
        }
        if self.later.is_none() && self.steps.ends {
            return all;
        }
        // Later impacts are those of the symmetric bar.
        let jumps = self.jumps;
        let f = |all, impact| f(all, if jumps.end_b.is_some() { jumps.own(impact) } else { impact });
        match self.later {
            Some(later) => later.fold(self.at, all, f),
            None => fold_later(&self.so_far(), all, f),
        }
    }

    #[cold]
    #[inline(never)]
    fn fold_off_center<B, F: FnMut(B, Impact) -> B>(self, init: B, f: F) -> B {
        self.fold_inline(init, f)
    }

    /// Returns copies, so that a train that needs no more than plain steps stays in registers.
    #[inline]
    fn so_far(&self) -> SoFar {
        SoFar { latest: self.steps.time, ahead: self.number, start: self.start, bar: self.bar }
    }

    /// Returns the next impact by a plain step, at end `I`; none where the train has ended, and where more digits are
    /// needed.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "as `next`")]
    fn step<const I: usize>(&mut self) -> Option<Impact> {
        let steps = &mut self.steps;
        if self.number >= steps.last {
            return None;
        }
        let (e, approach, time) = (self.bar.e, steps.approach[I], steps.time);
        let held = e * approach;
        let (then, doubt) = (held + steps.growth[I], steps.clear * held);
        self.number += 1;
        let impact = self.jumps.impact(self.number, [End::A, End::B][I], approach, time);
        // At one instant no time passes, also where velocities fade below the floats.
        steps.time -= if steps.gap == 0.0 { 0.0 } else { steps.gap / (approach * steps.approach[1 - I]) };
        if then >= doubt && self.number < steps.last {
            // The next impact is the last one; where the terms of a_{n+2} nearly cancel, that impact needs more digits.
            // The state stays as it is: it is not used again.
            steps.ends = then > -doubt;
            steps.last = self.number + u64::from(steps.ends);
            return Some(impact);
        }
        steps.approach[I] = then;
        steps.growth[I] = steps.turn[0] * steps.growth[I] - steps.turn[1] * approach;
        steps.gap *= e;
        steps.clear += CLEAR;
        Some(impact)
    }
}

impl Source {
    /// Returns the source from impact `ahead` + 1 on, and the number of impacts.
    fn new(bar: &Symmetric, start: &Start, ahead: u64) -> (Self, Option<u64>) {
        if bar.t <= 0.0 || bar.e == 0.0 {
            let first = after_first(bar, start);
            let count = if first <= 0.0 { Some(1) } else { (bar.t <= 0.0).then_some(2) };
            return (Self::Instant { first, a: start.velocity()[0], t: bar.t, h0: start.height_gap() }, count);
        }
        let drive = Drive::new(bar, start, Digits::ALL);
        let count = match drive.count() {
            Count::Finite(n) => Some(n),
            Count::Huge(_) | Count::Endless => None,
        };
        let closed = match drive.kind {
            Kind::Wave(wave) => drive.is_out_of_range(&wave),
            Kind::Decay(_) => count.is_some(),
            Kind::Edge => true,
        };
        let fours = || Box::new((drive, Fours::new(&drive, ahead)));
        (if closed { Self::Closed(Box::new(drive)) } else { Self::Fours(fours()) }, count)
    }

    /// Returns whether strikes may be so close that roundings exceed the time between them.
    fn crowded(&self) -> bool {
        match self {
            Self::Sweep(_) => false,
            Self::Fours(fours) => fours.1.crowded,
            Self::Closed(_) | Self::Instant { .. } => true,
        }
    }
}

impl Later {
    /// Creates the impacts from number `ahead` + 1 on, none before `latest`.
    #[cold]
    fn boxed(so_far: &SoFar) -> Box<Self> {
        let SoFar { bar, start, ahead, latest } = *so_far;
        let swept = if ahead == 0 { Sweep::new(&bar, &start) } else { None };
        let (source, count) =
            swept.map_or_else(|| Source::new(&bar, &start, ahead), |sweep| (Source::Sweep(sweep), None));
        let (approach, times) = ([0.0; BUFFER], [0.0; BUFFER]);
        Box::new(Self { bar, start, source, count, ahead, approach, times, latest })
    }

    /// Computes the next impacts and returns their first index in the buffers: the end of these where the train has
    /// ended.
    #[cold]
    fn fill(&mut self) -> usize {
        // Beyond 2^64 − 1 impacts there are no numbers left.
        let left = self.count.unwrap_or(u64::MAX).saturating_sub(self.ahead);
        let n = usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER));
        if n == 0 {
            return BUFFER;
        }
        let mut at = BUFFER - n;
        match &mut self.source {
            Source::Sweep(sweep) => {
                // A copy may stay in registers.
                let (mut on, mut taken, mut then) = (sweep.clone(), 0, Then::On);
                let buffers = self.approach.as_chunks_mut().0.iter_mut().zip(self.times.as_chunks_mut().0);
                for (approach, times) in buffers {
                    let n;
                    ([*approach, *times], n, then) = on.take();
                    taken += n;
                    if then != Then::On {
                        break;
                    }
                }
                *sweep = on;
                self.ahead += taken as u64;
                match then {
                    Then::On => {}
                    Then::End => self.count = Some(self.ahead),
                    Then::Doubt => (self.source, self.count) = Source::new(&self.bar, &self.start, self.ahead),
                }
                if taken == 0 {
                    return self.fill();
                }
                at = BUFFER - taken;
                to_the_end(taken, [&mut self.approach, &mut self.times]);
            }
            Source::Fours(fours) => {
                let (drive, fours) = &mut **fours;
                fours.take(drive, &mut self.approach, &mut self.times);
                to_the_end(n, [&mut self.approach, &mut self.times]);
                // The first strike is computed by itself, and so is a last one next to a tie: it takes more digits.
                if self.ahead == 0 {
                    (self.approach[at], self.times[at]) = drive.strike(1);
                }
                if let (Some(count), true) = (self.count, left <= BUFFER as u64) {
                    let [before, last] = [self.approach[BUFFER - 2], self.approach[BUFFER - 1]];
                    // δ_N−1 > θ/4, as |a_N−1/a_N−2| = √e sin δ_N−1/sin(δ_N−1 + θ).
                    let clear = n > 1 && last < 0.25 * self.bar.e.sqrt() * before && last < -NORMAL;
                    if !clear {
                        (self.approach[BUFFER - 1], self.times[BUFFER - 1]) = drive.strike(count);
                    }
                }
                self.ahead += n as u64;
            }
            Source::Closed(drive) => {
                self.ahead += 1;
                at = BUFFER - 1;
                (self.approach[at], self.times[at]) = drive.strike(self.ahead);
            }
            Source::Instant { first, a, t, h0 } => {
                let later = if *h0 == 0.0 || *first <= 0.0 { 0.0 } else { *h0 / *first };
                for (approach, time) in self.approach.iter_mut().zip(&mut self.times).skip(at) {
                    (*approach, *time) = (*a, if self.ahead == 0 { 0.0 } else { later });
                    *a = if self.ahead == 0 { -*first } else { *a * *t };
                    self.ahead += 1;
                }
            }
        }
        // At one instant no time passes; where velocities fade below the floats the closed form has 0/0 for it.
        if self.start.height_gap() == 0.0 {
            self.times[at..].fill(0.0);
        }
        // Roundings of times that hardly differ, or of two ways to the same time, may step back. All times are checked
        // at once: a step back is rare, and a running maximum is a chain of operations that wait for each other.
        let back = self.times[at] < self.latest;
        if back || self.source.crowded() && (1..BUFFER).filter(|&i| self.times[i] < self.times[i - 1]).count() > 0 {
            for time in &mut self.times[at..] {
                self.latest = self.latest.max(*time);
                *time = self.latest;
            }
        }
        self.latest = self.times[BUFFER - 1];
        at
    }

    /// Folds all impacts, from index `at` of the buffers on. It is not part of the fold of a [`Train`], whose plain
    /// steps then stay in registers.
    #[inline(never)]
    fn fold<B, F: FnMut(B, Impact) -> B>(mut self: Box<Self>, mut at: usize, init: B, mut f: F) -> B {
        let (mut all, jumps) = (init, Jumps::symmetric(&self.bar));
        loop {
            let number = self.ahead - (BUFFER - at) as u64;
            all = hand_out(&jumps, number, [&self.approach[at..], &self.times[at..]], all, &mut f);
            at = self.fill();
            if at == BUFFER {
                return all;
            }
        }
    }

    /// Skips impacts after those of the buffers, in constant time.
    fn skip(&mut self, skip: usize) {
        if skip == 0 {
            return;
        }
        if let Source::Sweep(_) = self.source {
            (self.source, self.count) = Source::new(&self.bar, &self.start, self.ahead);
        }
        self.ahead = self.ahead.saturating_add(skip as u64);
        match &mut self.source {
            Source::Fours(fours) => fours.1 = Fours::new(&fours.0, self.ahead),
            Source::Sweep(_) | Source::Closed(_) => {}
            // The rest, past the second impact, is a geometric series.
            Source::Instant { a, t, .. } => {
                #[expect(clippy::cast_precision_loss, reason = "beyond 2^53 the power is 0, or 1 at q = 1")]
                let steps = skip as f64;
                *a *= libm::pow(*t, steps);
            }
        }
    }
}

/// Folds as [`Later::fold`] does, from impact `ahead` + 1 on; a sweep is not stored anywhere.
#[inline(never)]
fn fold_later<B, F: FnMut(B, Impact) -> B>(so_far: &SoFar, init: B, mut f: F) -> B {
    let SoFar { bar, start, mut ahead, mut latest } = *so_far;
    let (mut all, jumps) = (init, Jumps::symmetric(&bar));
    if ahead == 0
        && let Some(mut sweep) = Sweep::new(&bar, &start)
    {
        loop {
            let ([approach, times], taken, then) = sweep.take();
            if then == Then::On {
                all = hand_out(&jumps, ahead, [&approach, &times], all, &mut f);
                ahead += taken as u64;
                continue;
            }
            all = hand_out(&jumps, ahead, [&approach[..taken], &times[..taken]], all, &mut f);
            if then == Then::End {
                return all;
            }
            (ahead, latest) = (ahead + taken as u64, times[..taken].last().copied().unwrap_or(latest));
            break;
        }
    }
    Later::boxed(&SoFar { latest, ahead, start, bar }).fold(BUFFER, all, f)
}

/// Folds the impacts after number `number`, in pairs, so that nothing depends on the number.
#[inline(always)]
#[expect(clippy::inline_always, reason = "four at a time, without a loop")]
fn hand_out<B, F: FnMut(B, Impact) -> B>(
    jumps: &Jumps,
    mut number: u64,
    [approach, times]: [&[f64]; 2],
    init: B,
    f: &mut F,
) -> B {
    let (mut all, first) = (init, End::striking(number + 1));
    let ((approach, rest), (times, last)) = (approach.as_chunks::<2>(), times.as_chunks::<2>());
    for (approach, times) in approach.iter().zip(times) {
        all = f(all, jumps.impact(number + 1, first, approach[0], times[0]));
        all = f(all, jumps.impact(number + 2, first.other(), approach[1], times[1]));
        number += 2;
    }
    if let (&[approach], &[time]) = (rest, last) {
        all = f(all, jumps.impact(number + 1, first, approach, time));
    }
    all
}

/// Moves the first n of the buffers to their end.
fn to_the_end(n: usize, buffers: [&mut [f64; BUFFER]; 2]) {
    if n < BUFFER {
        for buffer in buffers {
            buffer.copy_within(..n, BUFFER - n);
        }
    }
}

impl Bar {
    /// Returns the impacts one by one, end a first.
    ///
    /// # Method
    /// The recurrence of every other strike, one for each end, `a_{n+2} = (2e − D) a_n − e² a_{n−2}` in the form of
    /// differences, gives trains of up to 60 strikes, or 222 where e is not small, and the first 32 strikes of a longer
    /// one; the closed form serves next to a tie. Beyond, four neighboring strikes are carried on together by rotations
    /// that keep small angles exact. In a train of up to some 400 strikes they follow from the discriminant alone, from
    /// the first one on, and the train ends where the velocity changes its sign. In longer ones the four are anchored
    /// in the closed form anew every 256 strikes, and the number of impacts is settled beforehand, as exactly as by
    /// [`Bar::count`]. Times between strikes are h0 |v_a| e^{n−1}/(a_n a_{n+1}): sums of positive terms.
    ///
    /// # Accuracy
    /// [`crate::accuracy::APPROACH`], [`JUMP`](crate::accuracy::JUMP) and [`TIME`](crate::accuracy::TIME), for a train
    /// of any length; where the center of mass is not the middle, relative to the largest of the same end. Velocities
    /// below the range of floats are 0; where the last plain step or the only terms left are subnormal (a bar with
    /// massless ends that turns about its center), times have only the digits that these have.
    ///
    /// # Examples
    /// ```
    /// let bar = clatter::Bar::new(0.5, 0.3)?;
    /// let times: Vec<f64> = bar.train(&clatter::Start::default()).map(|impact| impact.time).collect();
    /// assert_eq!(times.len(), 4);
    /// assert!((times[1] - 1.0 / 1.65).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "a bar that is made on the spot then needs no place in memory")]
    pub fn train(&self, start: &Start) -> Train {
        let mut jumps = Jumps::symmetric(&self.symmetric);
        if !self.is_symmetric() {
            let [far, far_b] = self.inertia_ratios().map(|q| q + q * self.symmetric.e);
            jumps = Jumps { far, end_b: Some([far_b, self.kappa()]), ..jumps };
        }
        Train { jumps, ..self.symmetric.train(&self.arrival(start)) }
    }
}

impl Symmetric {
    /// Returns the same as [`Bar::train`], for a start in the variables of the symmetric bar.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "as `Bar::train`")]
    pub(crate) fn train(&self, start: &Start) -> Train {
        let (jumps, steps) = (Jumps::symmetric(self), Steps::new(self, start));
        Train { bar: *self, jumps, start: *start, number: 0, steps, later: None, at: BUFFER }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the trains of all kinds and lengths: short, long, hardly ending, endless, at one instant.
    fn trains() -> impl Strategy<Value = Train> {
        let bars = (-0.9..1.0_f64, 0.0..1.0_f64, 0.0..16.0_f64, 0..5_u8).prop_map(|(q, e, x, kind)| match kind {
            0 => Bar::new(q, e),
            1 => Bar::new(1.0 - 0.5 * 10f64.powf(-x), 1.0 - 10f64.powf(-0.5 * x)),
            2 => Bar::new((2.0 * e.sqrt() / (1.0 + e) * (1.0 - 10f64.powf(-x))).min(1.0), e),
            3 => Bar::new((2.0 * e.sqrt() / (1.0 + e) * (1.0 + 10f64.powf(-x))).min(1.0), e),
            _ => Bar::new(q, 0.0),
        });
        let starts = prop_oneof![Just(-1.0), Just(0.0), -2.0..2.0_f64];
        (bars, starts).prop_map(|(bar, vb)| bar.unwrap().train(&Start::new([-1.0, vb], 1.0).unwrap()))
    }

    #[test]
    fn times_of_a_flat_drop_are_zero_where_velocities_fade() {
        let zero = [0; 100];
        for e in [1.632_834_255_935_002_4e-219, 1e-160, 1e-300, 1e-5] {
            for q in [1.0, 0.999, 2.0 * libm::sqrt(e) / (1.0 + e)] {
                let train = Bar::new(q, e).unwrap().train(&Start::new([-1.0, 1.0], 0.0).unwrap());
                let times: Vec<_> = train.clone().take(100).map(|impact| impact.time.to_bits()).collect();
                assert_eq!(times, zero[..times.len()], "q = {q:?}, e = {e:?}");
                let summary = train.bar.summary(&train.start);
                assert_eq!(summary.duration.to_bits(), 0, "q = {q:?}, e = {e:?}: {summary:?}");
                // This folds, as sums do.
                let sum = train.take(100).fold(0.0, |sum, impact| sum + impact.time);
                assert_eq!(sum.to_bits(), 0, "q = {q:?}, e = {e:?}");
            }
        }
    }

    proptest! {
        /// It covers the hand-over from plain steps, new anchors, and the last strike by itself; also strikes so close
        /// that roundings exceed the time between them.
        #[test]
        fn times_never_step_back(train in trains()) {
            let mut latest = 0.0;
            for impact in train.take(2000) {
                prop_assert!(impact.time >= latest, "strike {} at {:?} after {latest:?}", impact.number, impact.time);
                latest = impact.time;
            }
        }

        /// Sums, skips and single steps meet the same impacts.
        #[test]
        fn however_impacts_are_taken_they_are_the_same(train in trains(), skip in 0..700_usize) {
            let most = 3000;
            let one_by_one: Vec<_> = train.clone().take(most).collect();
            if one_by_one.len() < most {
                let folded = train.clone().fold(Vec::new(), |mut list, impact| { list.push(impact); list });
                prop_assert_eq!(&folded, &one_by_one);
                let mut rest = train.clone();
                let taken = rest.by_ref().take(skip).count();
                let folded = rest.fold(Vec::new(), |mut list, impact| { list.push(impact); list });
                prop_assert_eq!(&folded, &one_by_one[taken..]);
            }
            let mut skipping = train;
            let (got, want) = (skipping.nth(skip), one_by_one.get(skip));
            prop_assert_eq!(got.map(|i| (i.number, i.end)), want.map(|i| (i.number, i.end)));
            if let (Some(got), Some(want)) = (got, want) {
                // It starts from an anchor of its own, within twice the allowed error.
                prop_assert!((got.time - want.time).abs() <= 2e-10 * want.time.max(1.0), "{got:?}, not {want:?}");
                prop_assert_eq!(skipping.next().map(|i| i.number), one_by_one.get(skip + 1).map(|i| i.number));
            }
        }
    }
}
