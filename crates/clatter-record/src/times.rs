//! Times that lie on an even grid are found, as far as what a file holds of them tells.

use clatter_shock::samples::float;

use crate::decimal::Decimal;

/// Times may be off an even grid by this share of a step: what that does to a spectrum is far below what is between samples.
const UNEVEN: f64 = 1e-3;
/// Times that are rounded to more than this share of a step can't be told from uneven ones, or from missing samples.
const COARSEST: f64 = 0.75;
/// Where each line is as exact as its own digits say, zeros at its end may be missing: no more than this share is taken on trust.
const TRUSTED: f64 = 0.25;

/// How the times of a file are printed.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Printed {
    /// Power of ten of the last digit of each; empty for times that are no text.
    places: Vec<i8>,
    /// The least of them; of all that are no text.
    finest: i32,
    /// Significant digits, of that which has most.
    digits: i32,
}

impl Printed {
    /// Whole numbers of units.
    pub(crate) fn whole() -> Self {
        Self::default()
    }
    /// Floats with all their digits.
    pub(crate) fn floats() -> Self {
        Self { finest: -400, ..Self::default() }
    }
    #[inline]
    pub(crate) fn note(&mut self, time: Decimal) {
        let place = time.exponent.clamp(-99, 99);
        self.finest = if self.places.is_empty() { place } else { self.finest.min(place) };
        self.digits = self.digits.max(time.digits);
        #[expect(clippy::cast_possible_truncation, reason = "within 99 of zero")]
        self.places.push(place as i8);
    }
    /// Without the times of these samples.
    pub(crate) fn keep(&mut self, kept: &[bool]) {
        let mut kept = kept.iter();
        self.places.retain(|_| kept.next().copied().unwrap_or(true));
    }
    /// The unit of the last digit, in units of time.
    pub(crate) fn unit(&self) -> f64 {
        10_f64.powi(self.finest)
    }
}

/// Times as a file has them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Times<'a> {
    /// Seconds since the first one.
    pub(crate) since_s: &'a [f64],
    pub(crate) start_s: f64,
    /// Unit of the numbers in the file, in seconds.
    pub(crate) unit_s: f64,
    pub(crate) printed: &'a Printed,
}

impl Times<'_> {
    /// The time between samples, if all lie on an even grid: to a thousandth of a step, or as far as the times were rounded when
    /// they were written: to decimals or to significant digits, to floats of 32 bits, or each to its own last digit.
    pub(crate) fn step(&self) -> Option<f64> {
        let count = self.since_s.len();
        if count < 2 {
            return None;
        }
        let mean = self.since_s[count - 1] / float(count - 1);
        if mean <= 0.0 {
            return None;
        }
        let own = |i| Some(self.own(i)?.min(TRUSTED * mean));
        let mut found = [None; 3];
        found[0] = self.even(mean, |i| Some(self.decimal(i)));
        let explained = |found: Option<Even>| found.is_some_and(|found| found.exact);
        if !explained(found[0]) && self.is_single() {
            found[1] = self.even(mean, |i| Some(single(self.number(i)) * self.unit_s));
        }
        if !explained(found[0]) && !explained(found[1]) {
            found[2] = self.even(mean, own);
        }
        // A step that rounding explains in full is meant, before one that is a little off.
        let found: Vec<Even> = found.into_iter().flatten().collect();
        found.iter().find(|found| found.exact).or(found.first()).map(|found| found.step_s).or_else(|| self.coarse(mean))
    }

    /// The step of times in whole units not much shorter than a step, if one rate explains every digit: all are rounded, halves either
    /// way, or all are cut off. A record that begins at zero begins there exactly; of another the first digits are rounded as well.
    fn coarse(&self, mean: f64) -> Option<f64> {
        /// Where fewer steps are the long ones, and the first time is rounded, samples are missing.
        const LONG: f64 = 1.0 / 6.0;
        /// Of fewer long steps no one can tell that they come at one rate.
        const REGULAR: f64 = 4.0;
        /// Samples that show a rate.
        const LEAST: usize = 32;
        let unit = 10_f64.powi(self.printed.finest) * self.unit_s;
        let count = self.since_s.len();
        if count < LEAST || !(COARSEST * mean..=mean).contains(&unit) {
            return None;
        }
        // A step is one unit or two.
        let mut long = 0.0;
        for pair in self.since_s.windows(2) {
            let units = (pair[1] - pair[0]) / unit;
            if (units - units.round()).abs() > 1e-3 || !(1.0..=2.0).contains(&units.round()) {
                return None;
            }
            long += units.round() - 1.0;
        }
        let steps = float(count - 1);
        if long < REGULAR {
            return None;
        }
        if self.start_s == 0.0 {
            // Rounded, cut off, and rounded up.
            let bounds = [[-0.5, 0.5], [-1.0, 0.0], [0.0, 1.0]];
            let found = bounds.into_iter().find_map(|bounds| {
                let [low, high] = bounds.map(|bound| bound * unit * (1.0 + 1e-9));
                let mut within = Within::default();
                for (i, time) in self.since_s.iter().enumerate().skip(1) {
                    within.low = within.low.max((time - high) / float(i));
                    within.high = within.high.min((time - low) / float(i));
                }
                (within.low <= within.high).then(|| within.simplest()).flatten()
            });
            if found.is_some() {
                return found;
            }
        }
        if long < LONG * steps {
            return None;
        }
        // The times leave this much above and below a line of some step: it is convex in the step.
        let spread = |step: f64| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            let mut at = 0.0;
            for time in self.since_s {
                let left = time - at;
                (low, high) = (low.min(left), high.max(left));
                at += step;
            }
            high - low
        };
        let explains = |step: f64| spread(step) <= unit * (1.0 + 1e-9);
        let (mut low, mut high) = (mean - unit / steps, mean + unit / steps);
        let ends = (low, high);
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            if spread(low + third) < spread(high - third) { high -= third } else { low += third }
        }
        let best = low.midpoint(high);
        if !explains(best) {
            return None;
        }
        // From there to both sides, as far as it explains all.
        let bound = |mut outside: f64| {
            let mut inside = best;
            for _ in 0..50 {
                let middle = inside.midpoint(outside);
                if explains(middle) { inside = middle } else { outside = middle }
            }
            inside
        };
        Some(Within { low: bound(ends.0), high: bound(ends.1) }.simplest().unwrap_or(best))
    }

    /// A time as the number in the file.
    fn number(&self, i: usize) -> f64 {
        (self.start_s + self.since_s[i]) / self.unit_s
    }
    /// How far a time may be rounded if all have as many decimals, or as many significant digits.
    fn decimal(&self, i: usize) -> f64 {
        let Printed { finest, digits, .. } = *self.printed;
        // A number may be too large for a float, in units that are small.
        #[expect(clippy::cast_possible_truncation, reason = "within 400 of zero")]
        let place = if digits > 0 {
            (libm::log10(self.number(i).abs()).floor().clamp(-400.0, 400.0) as i32 + 1 - digits).max(finest)
        } else {
            finest
        };
        10_f64.powi(place) * self.unit_s
    }
    /// How far a time may be rounded by its own last digit.
    fn own(&self, i: usize) -> Option<f64> {
        Some(10_f64.powi(i32::from(*self.printed.places.get(i)?)) * self.unit_s)
    }
    /// Returns whether all times are floats of 32 bits, as numbers, rounded to the digits that were printed, or in their shortest digits.
    fn is_single(&self) -> bool {
        (0..self.since_s.len()).all(|i| {
            let number = self.number(i);
            #[expect(clippy::cast_possible_truncation, reason = "the question is whether it is one")]
            let near = number as f32;
            let least = 4.0 * f64::EPSILON * number.abs();
            let rounded = self.own(i).map_or(0.0, |unit_s| 0.5 * unit_s / self.unit_s);
            let is = |other: f64, within: f64| (other - number).abs() <= within + least;
            is(f64::from(near), rounded) || format!("{near}").parse().is_ok_and(|shortest| is(shortest, 0.0))
        })
    }

    /// The step of a grid that all times lie on, each to within the larger of what `rounded` says and a thousandth of a step.
    fn even(&self, mean: f64, rounded: impl Fn(usize) -> Option<f64>) -> Option<Even> {
        // Steps that keep all times within the bands, and within what rounding alone explains.
        let mut steps = Within::default();
        let mut exact = Within::default();
        let mut before = 0.0;
        // Differences of floats are no more exact than these.
        let least = 2.0 * f64::EPSILON * (self.start_s.abs() + self.since_s[self.since_s.len() - 1]);
        for (i, &time) in self.since_s.iter().enumerate().skip(1) {
            let rounded = rounded(i)?;
            if rounded > COARSEST * mean || time - before > mean * (1.0 + UNEVEN) + rounded + least || time < before {
                return None;
            }
            let rounded = rounded.max(least);
            steps.note(i, time, rounded.max(UNEVEN * mean));
            exact.note(i, time, rounded);
            before = time;
        }
        if exact.low <= exact.high {
            let step_s = exact.simplest().unwrap_or(mean.clamp(exact.low, exact.high));
            return Some(Even { step_s, exact: true });
        }
        (steps.low <= steps.high).then(|| Even { step_s: mean.clamp(steps.low, steps.high), exact: false })
    }
}

/// An even grid.
#[derive(Debug, Clone, Copy)]
struct Even {
    step_s: f64,
    /// Tells whether rounding explains all that times are off it.
    exact: bool,
}

/// Lengths of a step that times allow.
#[derive(Debug, Clone, Copy)]
struct Within {
    low: f64,
    high: f64,
}

impl Default for Within {
    fn default() -> Self {
        Self { low: 0.0, high: f64::INFINITY }
    }
}

impl Within {
    /// The time of a sample is off by so much at most.
    fn note(&mut self, sample: usize, time: f64, band: f64) {
        let steps = float(sample);
        (self.low, self.high) = (self.low.max((time - band) / steps), self.high.min((time + band) / steps));
    }
    /// The step that has the fewest digits, or whose rate has: 1e-4 s and 51200 Hz are meant where rounded times allow them.
    fn simplest(self) -> Option<f64> {
        // Times cut to whole digits reach their bounds, but for rounding.
        let (low, high) = (self.low * (1.0 - 1e-12), self.high * (1.0 + 1e-12));
        let middle = low.midpoint(high);
        (0..16).find_map(|digits| {
            let round = |value: f64| format!("{value:.digits$e}").parse::<f64>().ok();
            let both = [round(middle), round(middle.recip()).map(f64::recip)];
            both.into_iter().flatten().find(|step| (low..=high).contains(step))
        })
    }
}

/// The distance between floats of 32 bits around a number.
fn single(number: f64) -> f64 {
    libm::exp2(libm::log2(number.abs().max(f64::from(f32::MIN_POSITIVE))).floor()) * f64::from(f32::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step_of(texts: &[String]) -> Option<f64> {
        let numbers: Vec<Decimal> =
            texts.iter().map(|text| Decimal::scan(text.as_bytes(), b'.').expect(text).0).collect();
        let mut printed = Printed::default();
        for number in &numbers {
            printed.note(*number);
        }
        let since_s: Vec<f64> = numbers.iter().map(|number| number.above(numbers[0])).collect();
        Times { since_s: &since_s, start_s: numbers[0].float(), unit_s: 1.0, printed: &printed }.step()
    }

    fn texts(print: impl Fn(f64) -> String) -> Vec<String> {
        (0..1200).map(|i| print(f64::from(i) / 51_200.0)).collect()
    }

    /// `%.6g`, as tables of spreadsheets and LabVIEW have it: significant digits without zeros at the end.
    fn significant(number: f64, digits: i32) -> String {
        if number == 0.0 {
            return "0".to_owned();
        }
        #[expect(clippy::cast_possible_truncation, reason = "a small number")]
        let places = usize::try_from(digits - 1 - number.abs().log10().floor() as i32).unwrap_or(0);
        let text = format!("{number:.places$}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }

    #[test]
    fn times_that_were_rounded_are_even() {
        #[expect(clippy::cast_possible_truncation, reason = "floats of 32 bits are what is tested")]
        let single = |t: f64| t as f32;
        let as_single = |t: f64| format!("{}", single(t));
        for (name, texts) in [
            ("exact", texts(|t| format!("{t:?}"))),
            ("six decimals", texts(|t| format!("{t:.6}"))),
            ("five decimals, half a step", texts(|t| format!("{t:.5}"))),
            ("nine decimals", texts(|t| format!("{t:.9}"))),
            ("exponents", texts(|t| format!("{t:.5e}"))),
            ("six significant digits", texts(|t| significant(t, 6))),
            ("six significant digits from 1 s on", texts(|t| significant(1.0 + t, 6))),
            ("floats of 32 bits", texts(as_single)),
            ("floats of 32 bits from 1 s on", texts(|t| as_single(1.0 + t))),
            ("nine digits of floats of 32 bits from 1 s on", texts(|t| significant(f64::from(single(1.0 + t)), 9))),
            ("whole microseconds, cut", texts(|t| format!("{:.6}", (t * 1e6).floor() * 1e-6))),
            ("two ways to print", texts(|t| if t < 0.001 { format!("{t:.8e}") } else { format!("{t:.6}") })),
        ] {
            let step = step_of(&texts).unwrap_or_else(|| panic!("{name}: not even"));
            // A round rate is meant where it is within what the digits allow.
            assert_eq!(step.to_bits(), 51_200_f64.recip().to_bits(), "{name}: {step}");
        }
    }

    /// Cut to six significant digits: six decimals below 1 s and five from there on, more than half a step of 60 kHz.
    #[test]
    fn times_of_so_many_digits_are_coarser_from_one_second_on() {
        let cut = |time: f64| {
            let unit = if time < 1.0 { 1e-6 } else { 1e-5 };
            significant((time / unit + 1e-6).floor() * unit, 6)
        };
        let texts: Vec<String> = (0..1200).map(|i| cut(0.99 + f64::from(i) / 6e4)).collect();
        assert_eq!(step_of(&texts).map(f64::to_bits), Some(6e4_f64.recip().to_bits()), "{:?}", step_of(&texts));
    }

    /// Milliseconds of 800 and of 833 Hz, cut off and rounded; single samples that are missing are no rounding.
    #[test]
    fn coarse_times_whose_rate_explains_every_digit() {
        for hz in [800.0_f64, 833.0] {
            for phase in [0.0, 0.3, 0.5, 0.9] {
                let texts: Vec<String> =
                    (0..400).map(|i| format!("{:.3}", (1e3 * f64::from(i) / hz + phase).floor() * 1e-3)).collect();
                let step = step_of(&texts).unwrap_or_else(|| panic!("{hz} {phase}"));
                // One printed unit over the whole length.
                assert!((step * hz - 1.0).abs() < 1e-3 * hz / 1e3 / 400.0 * 1e3, "{hz} {phase}: {step}");
                assert!(hz > 800.0 || step.to_bits() == hz.recip().to_bits(), "the simplest rate: {step}");
            }
        }
        let missing =
            |is: &dyn Fn(i32) -> bool| (0..300).filter(|i| !is(*i)).map(|i| format!("{i}")).collect::<Vec<_>>();
        assert_eq!(step_of(&missing(&|i| i == 77)), None, "one");
        // Milliseconds of 900 Hz, cut off, are the same: there every sample is where it is printed.
        let cut = step_of(&missing(&|i| i % 10 == 9)).expect("900 Hz");
        assert!((cut * 0.9 - 1.0).abs() < 1e-12, "{cut}");
        assert_eq!(step_of(&missing(&|i| i % 10 == 7)), None, "every tenth, but not as times from zero on are cut");
        // Halves either way, from zero on and from within.
        let halves = |from: i32| {
            (from..300)
                .map(|i| {
                    let (whole, odd) = (5 * i / 4, 5 * i % 4);
                    let up = odd == 3 || odd == 2 && (i / 2) % 2 == 1;
                    format!("{}", whole + i32::from(up))
                })
                .collect::<Vec<_>>()
        };
        assert_eq!([0, 7].map(|from| step_of(&halves(from))), [Some(1.25); 2]);
        assert_eq!(step_of(&missing(&|i| i % 4 == 3 && i < 150)), None, "every fourth of one half");
    }

    /// Times of many digits that single samples are off by half a percent of a step.
    #[test]
    fn half_a_percent_of_a_step_is_uneven() {
        let off = |share: f64| {
            let time = |i: i32| f64::from(i) + if i % 100 == 50 { share } else { 0.0 };
            (0..1200).map(|i| format!("{:.9}", time(i) / 51_200.0)).collect::<Vec<_>>()
        };
        assert_eq!(step_of(&off(5e-3)), None);
        assert!(step_of(&off(5e-4)).is_some(), "a twentieth of a percent is nothing");
    }

    #[test]
    fn times_that_are_off_the_grid_are_not_even() {
        let shifted = |i: i32, share: f64, print: &dyn Fn(f64) -> String| -> Vec<String> {
            (0..1200).map(|k| print((f64::from(k) + if k >= i { share } else { 0.0 }) / 51_200.0)).collect()
        };
        for (name, texts) in [
            ("a missing sample", shifted(600, 1.0, &|t| format!("{t:?}"))),
            ("a missing sample, six decimals", shifted(600, 1.0, &|t| format!("{t:.6}"))),
            ("a missing sample, five decimals", shifted(600, 1.0, &|t| format!("{t:.5}"))),
            ("a third of a step, six decimals", shifted(600, 0.33, &|t| format!("{t:.6}"))),
            ("a hundredth of a step", shifted(600, 0.01, &|t| format!("{t:.9}"))),
            ("coarser than the samples", texts(|t| format!("{t:.4}"))),
            ("all at once", texts(|_| "1".to_owned())),
        ] {
            assert_eq!(step_of(&texts), None, "{name}");
        }
    }
}
