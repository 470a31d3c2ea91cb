//! Laws of the plate, and random plates against a motion in fractions that shares nothing with the crate: it moves the
//! plate from strike to strike by its center of mass and its two turns, and breaks ties by a tilt that differs by 2⁻⁵⁰⁰.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "bit counts and whole numbers of moderate size"
)]
#![expect(clippy::float_cmp, reason = "what is the same is compared as such")]

use std::cmp::Ordering;

use clatter::{Bar, Corner, End, Extent, Plate, PlateCount, PlateStart, Start};
use num_bigint::BigInt;
use proptest::prelude::*;

/// A fraction in lowest terms, its denominator positive.
#[derive(Clone, PartialEq)]
struct Fraction(BigInt, BigInt);

impl Fraction {
    fn of(x: f64) -> Self {
        let (mut n, mut d) = (x, BigInt::from(1));
        while n.fract() != 0.0 {
            (n, d) = (n * 2.0, d * 2);
        }
        // Whole by now, of 53 bits and zeros.
        let mut power = BigInt::from(1);
        while n.abs() >= 9e15 {
            (n, power) = (n / 2.0, power * 2);
        }
        Self(BigInt::from(n as i64) * power, d).reduced()
    }
    fn tiny() -> Self {
        Self(BigInt::from(1), BigInt::from(1) << 500)
    }
    fn reduced(self) -> Self {
        let (mut a, mut b) = (self.0.clone(), self.1.clone());
        while b != BigInt::from(0) {
            (a, b) = (b.clone(), a % b);
        }
        let zero = BigInt::from(0);
        let sign = if (self.1 < zero) == (a < zero) { 1 } else { -1 };
        Self(self.0 / &a * sign, self.1 / &a * sign)
    }
    fn plus(&self, o: &Self) -> Self {
        Self(&self.0 * &o.1 + &o.0 * &self.1, &self.1 * &o.1).reduced()
    }
    fn times(&self, o: &Self) -> Self {
        Self(&self.0 * &o.0, &self.1 * &o.1).reduced()
    }
    fn negative(&self) -> Self {
        Self(-&self.0, self.1.clone())
    }
    fn minus(&self, o: &Self) -> Self {
        self.plus(&o.negative())
    }
    fn over(&self, o: &Self) -> Self {
        Self(&self.0 * &o.1, &self.1 * &o.0).reduced()
    }
    fn is_negative(&self) -> bool {
        self.0 < BigInt::from(0)
    }
    fn cmp(&self, o: &Self) -> Ordering {
        (&self.0 * &o.1).cmp(&(&o.0 * &self.1))
    }
    /// Returns the rounded value, for numbers of moderate size.
    fn float(&self) -> f64 {
        let shift = 1100 + self.1.bits() as i64 - self.0.bits() as i64;
        let whole = (self.0.clone() << shift as usize) / &self.1;
        let cut = (whole.bits() as i64 - 64).max(0);
        let top: BigInt = whole >> cut as usize;
        let digits: f64 = top.to_string().parse().expect("digits");
        digits * 2f64.powi((cut - shift) as i32)
    }
}

struct Struck {
    corner: usize,
    time: f64,
    approach: f64,
    velocities: [f64; 4],
}

/// Returns at most so many strikes, and whether the plate has bounced clear.
fn brute(k: [f64; 2], s: [f64; 2], e: f64, velocity: [f64; 3], gaps: [f64; 2], most: usize) -> (Vec<Struck>, bool) {
    let f = Fraction::of;
    let (zero, one, two) = (f(0.0), f(1.0), f(2.0));
    let square = k.map(|k| f(k).times(&f(k)));
    let arm: Vec<[Fraction; 2]> = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|place| std::array::from_fn(|axis| f(place[axis]).minus(&f(s[axis]))))
        .to_vec();
    // Height and velocity of the center of mass, slopes and their rates.
    let plane = |a: &Fraction, b: &Fraction, d: &Fraction| {
        let slopes = [b.minus(a).over(&two), d.minus(a).over(&two)];
        let middle = a.minus(&arm[0][0].times(&slopes[0])).minus(&arm[0][1].times(&slopes[1]));
        [middle, slopes[0].clone(), slopes[1].clone()]
    };
    let at = |x: &[Fraction; 3], j: usize| x[0].plus(&arm[j][0].times(&x[1])).plus(&arm[j][1].times(&x[2]));
    let flat = gaps == [0.0, 0.0];
    let mut gap = if flat { [one.clone(), one.clone()] } else { gaps.map(f) };
    let upward = usize::from(gap[0] != zero);
    gap[upward] = gap[upward].plus(&Fraction::tiny());
    let mut height = plane(&zero, &gap[0], &gap[1]);
    let mut rate = plane(&f(velocity[0]), &f(velocity[1]), &f(velocity[2]));
    let (mut time, mut next, mut list) = (zero.clone(), Some(0), Vec::new());
    while let Some(j) = next {
        if list.len() == most {
            return (list, false);
        }
        let approach = at(&rate, j);
        let own =
            one.plus(&arm[j][0].times(&arm[j][0]).over(&square[0])).plus(&arm[j][1].times(&arm[j][1]).over(&square[1]));
        let impulse = one.plus(&f(e)).times(&approach.negative()).over(&own);
        rate = [
            rate[0].plus(&impulse),
            rate[1].plus(&impulse.times(&arm[j][0]).over(&square[0])),
            rate[2].plus(&impulse.times(&arm[j][1]).over(&square[1])),
        ];
        let velocities = std::array::from_fn(|i| at(&rate, i).float());
        let shown = if flat { 0.0 } else { time.float() };
        list.push(Struck { corner: j, time: shown, approach: approach.float(), velocities });
        let until = |i: usize| at(&height, i).over(&at(&rate, i).negative());
        let mut soonest: Option<(usize, Fraction)> = None;
        for i in (0..4).filter(|i| *i != j && at(&rate, *i).is_negative()) {
            let wait = until(i);
            if soonest.as_ref().is_none_or(|(_, known)| wait.cmp(known) == Ordering::Less) {
                soonest = Some((i, wait));
            }
        }
        next = soonest.as_ref().map(|(i, _)| *i);
        if let Some((_, wait)) = soonest {
            time = time.plus(&wait);
            for axis in 0..3 {
                height[axis] = height[axis].plus(&rate[axis].times(&wait));
            }
        }
    }
    (list, true)
}

/// Returns numbers of few digits, so that ties come up, and of all digits.
fn number(lo: i32, hi: i32) -> impl Strategy<Value = f64> {
    prop_oneof![8 => (lo..=hi).prop_map(|n| f64::from(n) / 32.0), 1 => f64::from(lo) / 32.0..f64::from(hi) / 32.0]
}

fn plates() -> impl Strategy<Value = ([f64; 2], [f64; 2])> {
    let ratio = || prop_oneof![1 => (-8..9_i32).prop_map(|k| 2f64.powi(k)), 4 => number(3, 40)];
    let center = || prop_oneof![Just(0.0), number(-28, 28)];
    ([ratio(), ratio()], [center(), center()])
}

fn starts() -> impl Strategy<Value = ([f64; 3], [f64; 2])> {
    let gap = || prop_oneof![Just(0.0), Just(1.0), Just(1e-12), number(1, 64)];
    let velocity = || prop_oneof![Just(-1.0), number(-64, 16)];
    ([velocity(), velocity()], [gap(), gap()]).prop_map(|([b, d], gaps)| ([-1.0, b, d], gaps))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Checks order, count, times and velocities, with ties, flat drops, edges and gaps in ratios of 10¹².
    #[test]
    fn trains_are_those_of_fractions(
        (k, s) in plates(), e in number(0, 32), (velocity, gaps) in starts(),
    ) {
        let plate = Plate::off_center(k, s, e).unwrap();
        let start = PlateStart::new(velocity, gaps).unwrap();
        let (list, ended) = brute(k, s, e, velocity, gaps, 12);
        let mut train = plate.train(&start);
        let scale = velocity.iter().fold(1.0, |most: f64, v| most.max(v.abs())) * 3.0;
        for (n, want) in list.iter().enumerate() {
            let got = train.next();
            prop_assert!(got.is_some(), "ended after {n}");
            let got = got.unwrap();
            prop_assert_eq!(got.corner as usize, want.corner, "impact {} of {:?}", n + 1, list.iter().map(|s| s.corner).collect::<Vec<_>>());
            prop_assert!((got.approach - want.approach).abs() <= 1e-11 * scale, "{got:?}, not {}", want.approach);
            let unit = gaps[0].max(gaps[1]);
            prop_assert!((got.time - want.time).abs() <= 1e-10 * want.time.max(unit), "{got:?}, not {}", want.time);
            for (got, want) in train.velocities().iter().zip(want.velocities) {
                prop_assert!((got - want).abs() <= 1e-11 * scale, "velocities after {}: {got}, not {want}", n + 1);
            }
        }
        if ended {
            prop_assert!(train.next().is_none(), "more than {}", list.len());
            prop_assert_eq!(plate.summary(&start, 100).count, PlateCount::Finite(list.len() as u64));
        }
    }

    /// Mirrors and exchanged axes.
    #[test]
    fn the_names_of_corners_and_axes_do_not_matter((k, s) in plates(), e in 0.05..0.95_f64, r in 0.01..0.99_f64) {
        let plate = Plate::off_center(k, s, e).unwrap();
        let word = |plate: &Plate, gaps: [f64; 2], names: [char; 4]| -> String {
            plate.train(&PlateStart::level(gaps).unwrap()).take(12).map(|impact| names[impact.corner as usize]).collect()
        };
        let plain = word(&plate, [1.0 - r, r], ['a', 'b', 'c', 'd']);
        let exchanged = word(&plate.exchanged(), [r, 1.0 - r], ['a', 'd', 'c', 'b']);
        prop_assert_eq!(&plain, &exchanged);
        prop_assert_eq!(plate.exchanged().exchanged(), plate);
        prop_assert_eq!(plate.mirrored_x().mirrored_y().mirrored_x().mirrored_y(), plate);
        // A mirror moves shocks with the corners, whichever lands first.
        let [own, mirrored] = [plate, plate.mirrored_x()].map(|plate| plate.worst(8).unwrap());
        for (place, image) in [([0.3, -0.7], [-0.3, -0.7]), ([1.0, 1.0], [-1.0, 1.0])] {
            let (here, there) = (own.at(place), mirrored.at(image));
            prop_assert!((here - there).abs() <= 1e-12 * here, "{here} and {there}");
        }
        let [own, mirrored] = [plate, plate.mirrored_x()].map(|plate| plate.worst(2).unwrap().later());
        prop_assert!((own - mirrored).abs() <= 1e-12 * own, "still to come: {own} and {mirrored}");
    }

    /// The word of a direction is that of its interval, and no direction is left out.
    #[test]
    fn the_atlas_holds_the_word_of_every_direction((k, s) in plates(), e in 0.1..0.9_f64, r in 0.0..=1.0_f64) {
        let plate = Plate::off_center(k, s, e).unwrap();
        let atlas = plate.atlas(12).unwrap();
        let words = atlas.words();
        prop_assert!(words[0].from == 0.0 && words[words.len() - 1].to == 1.0, "from 0 to 1");
        prop_assert!(words.windows(2).all(|w| w[0].to == w[1].from && w[0].from <= w[0].to), "no gaps");
        // Next to an end the roundings of 1 − r decide.
        let inside = words.iter().find(|word| word.from + 1e-12 < r && r < word.to - 1e-12);
        if let Some(word) = inside {
            let train = plate.train(&PlateStart::level([1.0 - r, r]).unwrap());
            let corners: Vec<_> = train.take(12).map(|impact| impact.corner).collect();
            prop_assert_eq!(&corners, &word.corners, "direction {}", r);
        }
        let shocks = plate.shocks(&PlateStart::level([1.0 - r, r]).unwrap(), 12);
        let most = shocks.struck().into_iter().fold(0.0, f64::max);
        prop_assert!(most <= atlas.peak().corner * (1.0 + 1e-12), "{most} is more than the worst of all");
    }

    /// The energy (1 − e²) v²/(2 w) is lost at each strike.
    #[test]
    fn a_strike_takes_the_energy_that_it_should((k, s) in plates(), e in 0.0..=1.0_f64, r in 0.01..0.99_f64) {
        let plate = Plate::off_center(k, s, e).unwrap();
        let energy = |[a, b, _, d]: [f64; 4]| {
            let [x, y] = [0.5 * (b - a), 0.5 * (d - a)];
            let v = a + (1.0 + s[0]) * x + (1.0 + s[1]) * y;
            0.5 * (v * v + k[0] * k[0] * x * x + k[1] * k[1] * y * y)
        };
        let mut train = plate.train(&PlateStart::level([1.0 - r, r]).unwrap());
        let mut before = 0.5;
        while let Some(impact) = train.next().filter(|impact| impact.number <= 8) {
            let after = energy(train.velocities());
            // A corner has its own shock, and the middle the mean of all.
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|place| impact.delta_v_at(place));
            prop_assert_eq!(corners, impact.delta_v);
            prop_assert!((4.0 * impact.delta_v_at([0.0; 2]) - corners.iter().sum::<f64>()).abs() < 1e-13);
            let loss = 0.5 * (1.0 - e * e) * impact.approach * impact.approach / plate.weight(impact.corner);
            // Slopes are differences of velocities, and count k² times: roundings too.
            let rounded = 1e-13 * (1.0 + k[0] * k[0] + k[1] * k[1]);
            prop_assert!((before - after - loss).abs() <= rounded, "{before} - {after} is not {loss}");
            before = after;
        }
    }

    /// No point outside of the polygon is safe, and every point inside is.
    #[test]
    fn safe_zones_are_where_no_shock_is_larger(
        (k, s) in plates(), e in 0.1..0.9_f64, place in [-1.0..1.0_f64, -1.0..1.0_f64], threshold in 0.2..3.0_f64,
    ) {
        let shocks = Plate::off_center(k, s, e).unwrap().worst(10).unwrap();
        let zone = shocks.safe_zone(threshold);
        let inside = zone.polygon.len() > 2
            && (0..zone.polygon.len()).all(|i| {
                let ([x0, y0], [x1, y1]) = (zone.polygon[i], zone.polygon[(i + 1) % zone.polygon.len()]);
                (x1 - x0) * (place[1] - y0) - (y1 - y0) * (place[0] - x0) >= 0.0
            });
        let shock = shocks.at(place);
        if (shock - threshold).abs() > 1e-9 * threshold {
            prop_assert_eq!(inside, shock < threshold, "{:?}, {} of {}", zone, shock, threshold);
        }
        for corner in &zone.polygon {
            prop_assert!(shocks.at(*corner) <= threshold * (1.0 + 1e-9), "{corner:?} sees {}", shocks.at(*corner));
        }
        prop_assert_eq!(zone.extent == Extent::Whole, zone.share == 1.0);
    }
}

/// β → 0: with so much inertia across, a and d are one end of a bar, b and c the other.
#[test]
fn a_plate_of_large_inertia_across_is_the_bar() {
    for (k, e) in [(0.577, 0.3), (0.4, 0.2), (1.3, 0.7), (0.1, 0.9), (0.38, 0.5)] {
        let (plate, bar) = (Plate::new([k, 1e9], e).unwrap(), Bar::from_gyration_ratio(k, e).unwrap());
        let start = PlateStart::level([1.0, 0.0]).unwrap();
        // The neighbor is a trifle lower after each strike, and then takes the next one of that end.
        let impacts: Vec<_> = plate.train(&start).take(60).collect();
        let strikes: Vec<_> = bar.train(&Start::default()).take(60).collect();
        assert_eq!(impacts.len(), strikes.len(), "k = {k}, e = {e}");
        for (impact, strike) in impacts.iter().zip(&strikes) {
            let end = usize::from(impact.corner == Corner::B || impact.corner == Corner::C);
            assert_eq!(end, strike.end as usize, "k = {k}, e = {e}, impact {}", strike.number);
            let size = strike.approach.abs().max(1.0);
            assert!((impact.approach - strike.approach).abs() < 4e-15 * size, "{impact:?}, not {strike:?}");
            assert!((impact.time - strike.time).abs() < 1e-13 * strike.time.max(1.0), "{impact:?}, not {strike:?}");
            for (corner, end) in [(0, 0), (1, 1), (2, 1), (3, 0)] {
                let (got, want) = (impact.delta_v[corner], strike.delta_v[end]);
                assert!((got - want).abs() < 4e-15 * size, "{impact:?}, not {strike:?}");
            }
        }
        let shocks = plate.shocks(&start, 100);
        let of_bar = bar.shocks(&Start::default(), End::A);
        let peaks = of_bar.struck();
        let at_end = peaks.a.max(bar.q().abs() * peaks.b);
        assert!((shocks.at([-1.0, 0.0]) - at_end).abs() < 1e-13, "k = {k}, e = {e}: {shocks:?}");
        let interval = of_bar.safe_interval(1.0);
        let share = interval.map_or(0.0, |[lo, hi]| 0.5 * (hi - lo));
        let zone = shocks.safe_zone(1.0);
        assert!((zone.share - share).abs() < 1e-13, "k = {k}, e = {e}: {zone:?}, not {share}");
    }
}

/// The diagonal of a uniform plate is a bar with q = 5/7; endless from e = 0.176566 on, with the limits of that bar.
#[test]
fn the_diagonal_is_a_bar_with_more_inertia() {
    for e in [0.05, 0.1, 0.15, 0.17] {
        let summary = Plate::uniform(e).unwrap().summary(&PlateStart::default(), 1000);
        let bar = Bar::new(5.0 / 7.0, e).unwrap();
        let want = bar.summary(&Start::new([-1.0; 2], 2.0).unwrap());
        assert_eq!(summary.count, PlateCount::Endless, "e = {e}");
        assert!((summary.duration - want.duration).abs() < 1e-9, "{summary:?}, not {want:?}");
        assert!((summary.peak.corner - want.peak.end).abs() < 1e-12, "{summary:?}, not {want:?}");
        assert!(summary.peak.later <= summary.peak.corner, "{summary:?}");
        for v in summary.final_velocity.unwrap() {
            assert!(v.abs() < 1e-9, "{summary:?}");
        }
    }
    let count = Plate::uniform(0.177).unwrap().summary(&PlateStart::default(), 1000).count;
    assert!(matches!(count, PlateCount::Finite(_)), "{count:?}");
}

/// With most of its mass in the middle the diagonal is a bar with q near 1, whose strikes grow for long before they fade: the largest
/// is still to come where the train is found to be endless, and among what is said to come where it is followed no further.
#[test]
fn strikes_that_still_grow_are_among_those_to_come() {
    for (q, e) in [(0.9995_f64, 0.9), (0.999, 0.88), (0.99999, 0.97)] {
        // With gyration ratios k corners are √2/k radii of gyration out: q = (2 − k²)/(2 + k²).
        let k = (2.0 * (1.0 - q) / (1.0 + q)).sqrt();
        let plate = Plate::new([k; 2], e).unwrap();
        let want = Bar::new(q, e).unwrap().summary(&Start::new([-1.0; 2], 2.0).unwrap()).peak.end;
        for most in [10, 1000] {
            let summary = plate.summary(&PlateStart::default(), most);
            assert_eq!(summary.count, PlateCount::Endless, "q = {q}, e = {e}");
            let said = summary.peak.corner.max(summary.peak.later);
            assert!(said >= want * (1.0 - 1e-12), "q = {q}, e = {e}, after {most}: {summary:?}, not {want}");
            assert!(most < 1000 || (summary.peak.corner / want - 1.0).abs() < 1e-12, "{summary:?}, not {want}");
        }
    }
}

/// Round the corners of a uniform plate, a–d–c–b–a…, without end where λ³ + ((1 + e)/7 − 1) λ² + ((1 + e)/7 − e) λ + e has
/// a positive root: for e up to 0.02955. Far along the train is where it tends to.
#[test]
fn words_round_the_corners_are_endless_below_their_restitution() {
    let start = PlateStart::level([1.0, 0.3]).unwrap();
    for e in [0.005, 0.02, 0.028] {
        let plate = Plate::uniform(e).unwrap();
        let summary = plate.summary(&start, 1000);
        assert_eq!(summary.count, PlateCount::Endless, "e = {e}: {summary:?}");
        let mut train = plate.train(&start);
        let last = train.by_ref().take(400).last().unwrap();
        assert!((last.time - summary.duration).abs() < 1e-9, "e = {e}: {summary:?}, not {last:?}");
        assert!(train.velocities().iter().all(|v| v.abs() < 1e-9), "e = {e}: {:?}", train.velocities());
        assert!(
            plate.train(&start).take(400).all(|impact| summary.peak.corner >= -(1.0 + e) * impact.approach),
            "peak"
        );
    }
    assert_eq!(Plate::uniform(0.0295).unwrap().summary(&start, 1000).count, PlateCount::Endless);
    for e in [0.0297, 0.04] {
        let count = Plate::uniform(e).unwrap().summary(&start, 1000).count;
        assert!(matches!(count, PlateCount::Finite(_)), "e = {e}: {count:?}");
    }
}

/// Corners a and b alternate as if they did so for ever, but before they come together c and d are down too.
#[test]
fn a_pair_is_not_endless_where_another_corner_comes_down_before_its_end() {
    let plate = Plate::off_center([0.34, 0.9], [-0.33, -0.18], 0.09).unwrap();
    let start = PlateStart::new([-1.0, -0.5, -0.71], [0.24, 0.03]).unwrap();
    let impacts: Vec<_> = plate.train(&start).take(60).collect();
    let word: String = impacts.iter().map(|impact| impact.corner.letter()).take(12).collect();
    assert_eq!(word, "ababababcdcd");
    assert_ne!(plate.summary(&start, 8).count, PlateCount::Endless);
    let (summary, last) = (plate.summary(&start, 60), impacts[59]);
    assert!((summary.duration - last.time).abs() < 1e-9, "{summary:?}, not {last:?}");
    assert!(plate.shocks(&start, 60).struck().iter().all(|shock| *shock > 0.5), "{:?}", plate.shocks(&start, 60));
}

/// Two corners of an edge that alternate without end, and the drops of other plates that the oracle gave up: where a
/// train is said to be endless it is still going, at the time and with the velocities that it is said to tend to.
#[test]
fn endless_trains_tend_to_what_is_said() {
    let mut endless = [0, 0];
    for n in 0..60_u32 {
        let x = |k: u32| f64::from((n * k + 7) % 59) / 59.0;
        let plate = Plate::off_center(
            [0.2 + 0.6 * x(3), 0.15 + 0.5 * x(11)],
            [0.6 * x(17) - 0.3, 0.4 * x(23) - 0.2],
            0.02 + 0.1 * x(31),
        )
        .unwrap();
        let start = PlateStart::new([-1.0, -0.6 - x(37), -0.6 - x(41)], [0.1 + x(43), 0.1 + x(47)]).unwrap();
        let summary = plate.summary(&start, 200);
        if summary.count != PlateCount::Endless {
            continue;
        }
        let mut train = plate.train(&start);
        let impacts: Vec<_> = train.by_ref().take(200).collect();
        assert_eq!(impacts.len(), 200, "{plate:?}, {start:?}");
        let corners = Corner::ALL.iter().filter(|corner| impacts[150..].iter().any(|i| i.corner == **corner)).count();
        endless[usize::from(corners > 2)] += 1;
        // A corner that still comes down then strikes at that speed or more.
        let down =
            summary.final_velocity.unwrap().into_iter().fold(0.0, |most: f64, v| most.max(-v)) * (1.0 + plate.e());
        assert!(
            summary.peak.later >= down && plate.shocks(&start, 200).later() >= down,
            "{plate:?}, {start:?}: {summary:?}"
        );
        let off = (impacts[199].time - summary.duration).abs();
        assert!(off < 1e-6 * summary.duration, "{plate:?}, {start:?}: {summary:?}, not {:?}", impacts[199]);
        for (got, want) in train.velocities().iter().zip(summary.final_velocity.unwrap()) {
            assert!((got - want).abs() < 1e-6, "{plate:?}, {start:?}: {:?}, not {summary:?}", train.velocities());
        }
        let peak = impacts.iter().fold(0.0, |most: f64, i| most.max(-i.approach)) * (1.0 + plate.e());
        assert!((summary.peak.corner - peak).abs() < 1e-12, "{plate:?}, {start:?}: {summary:?}, not {peak}");
    }
    eprintln!("endless: {} of two corners, {} of more", endless[0], endless[1]);
    assert!(endless.iter().all(|n| *n > 2), "some of both kinds: {endless:?}");
}

#[test]
fn ties_are_told_and_taken_as_a_tilt_that_differs_by_next_to_nothing() {
    let plate = Plate::uniform(0.5).unwrap();
    let first = |gaps: [f64; 2]| {
        let impacts: Vec<_> = plate.train(&PlateStart::level(gaps).unwrap()).collect();
        let word: String = impacts.iter().map(|impact| impact.corner.letter()).collect();
        (word, impacts.iter().map(|impact| impact.tie).collect::<Vec<_>>(), impacts)
    };
    // The plate lands on an edge: a and d together.
    let (edge, ties, _) = first([1.0, 0.0]);
    assert_eq!(edge, first([1.0, 1e-50]).0, "the limit of a vanishing tilt");
    assert!(ties[0] && ties[1..].iter().all(|tie| !tie), "{ties:?}");
    let (other, ties, _) = first([0.0, 1.0]);
    assert_eq!(other, first([1e-50, 1.0]).0, "the limit of a vanishing tilt");
    assert!(ties[0], "{ties:?}");
    // All at once: the order of the diagonal, at one instant.
    let (flat, ties, impacts) = first([0.0, 0.0]);
    assert_eq!(flat, first([1.0, 1.0]).0);
    assert!(ties[0] && impacts.iter().all(|impact| impact.time == 0.0), "{impacts:?}");
    // With α = β = 1 the strike at a leaves (1/2, −1/2, −3/2, −1/2): from (2, 1) c and d come down together, and with h_d
    // larger by next to nothing c is first; from (1, 2) it is b, not c.
    let plate = Plate::new([1.0, 1.0], 0.5).unwrap();
    for (gaps, second) in [([2.0, 1.0], Corner::C), ([1.0, 2.0], Corner::B)] {
        let impacts: Vec<_> = plate.train(&PlateStart::level(gaps).unwrap()).collect();
        assert_eq!(impacts.iter().map(|impact| impact.tie).collect::<Vec<_>>()[..2], [false, true], "{impacts:?}");
        assert_eq!((impacts[1].corner, impacts[1].time), (second, 2.0), "{impacts:?}");
    }
    // The direction of a tie is where an interval of the atlas begins, and its word is the one that begins there.
    let atlas = plate.atlas(40).unwrap();
    let third = atlas.words().iter().find(|word| word.from == 1.0 / 3.0).expect("an end at 1/3");
    let word: Vec<_> = plate.train(&PlateStart::level([2.0, 1.0]).unwrap()).map(|impact| impact.corner).collect();
    assert_eq!(word, third.corners);
}

#[test]
fn values_out_of_range_are_refused_by_name() {
    for (made, message) in [
        (Plate::new([0.0, 1.0], 0.5), "gyration ratio along x = 0.0 is not in [1e-9, 1e9]"),
        (Plate::new([1.0, f64::NAN], 0.5), "gyration ratio along y = NaN is not in [1e-9, 1e9]"),
        (Plate::new([1.0, 1.0], 1.5), "restitution e = 1.5 is not in [0, 1]"),
        (
            Plate::off_center([1.0; 2], [0.0, 1.0], 0.5),
            "center of mass along y = 1.0 is not in (-1, 1), between the edges",
        ),
    ] {
        assert_eq!(made.unwrap_err().to_string(), message);
    }
    for (made, message) in [
        (
            PlateStart::new([1.0, -1.0, -1.0], [1.0; 2]),
            "velocity of corner a = 1.0 is not in [-1e60, -1e-60]: corner a must approach the ground",
        ),
        (PlateStart::level([1.0, -1.0]), "height gap of corner d = -1.0 is not 0 or in [1e-60, 1e60]"),
    ] {
        assert_eq!(made.unwrap_err().to_string(), message);
    }
    let limit = Plate::uniform(0.5).unwrap().atlas(0).unwrap_err();
    assert_eq!(limit.to_string(), "limit of strikes = 0.0 is not in [1, 100]");
}
