//! Directions of tilt of a plate: orders of corners, counts, trains without end.

use std::f64::consts::FRAC_PI_2;

use clatter::{Atlas, Corner, Plate, PlateCount, PlateStart};

use super::bars::STRIKES;
use crate::Error;
use crate::paper::claims::turn;

/// Returns the share of the azimuths of tilt, evenly spread, that lead to words of one kind, for a plate `aspect` times
/// as long, along x, as it is wide.
///
/// A slope s that points ψ off the x axis lifts b by s·length·cos ψ and d by s·width·sin ψ: r = sin ψ/(aspect cos ψ + sin ψ).
pub(crate) fn share(atlas: &Atlas, aspect: f64, kind: impl Fn(&[Corner]) -> bool) -> f64 {
    let azimuth = |r: f64| (r * aspect).atan2(1.0 - r) / FRAC_PI_2;
    let words = atlas.words().iter().filter(|word| kind(&word.corners));
    words.map(|word| azimuth(word.to) - azimuth(word.from)).fold(0.0, |sum, part| sum + part)
}

/// Returns whether a plate rocks as a rod does in its first four strikes: on two corners in turn, or on an edge and
/// then the opposite one.
pub(crate) fn is_rod(word: &[Corner]) -> bool {
    let word = &word[..word.len().min(4)];
    let in_turn = word.windows(3).all(|w| w[0] == w[2]);
    let opposite = |j: Corner| Corner::ALL[(j as usize + 2) % 4];
    let neighbors = word.len() > 1 && word[1] != opposite(word[0]);
    in_turn || neighbors && word[2..].iter().all(|j| !word[..2].contains(j))
}

/// Returns the letters of a word.
pub(crate) fn letters(word: &[Corner]) -> String {
    word.iter().map(|corner| corner.letter()).collect()
}

/// Numbers of strikes over the directions of tilt, of a uniform plate.
#[derive(Debug)]
pub(crate) struct Counts {
    /// For each e, ascending: intervals of directions with one number of strikes, from r = 0 to 1; none where the train
    /// was followed no further.
    pub(crate) rows: Vec<(f64, Vec<Interval>)>,
}

/// Directions with one number of strikes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    /// Begin of the interval of r.
    pub(crate) from: f64,
    /// End of the interval of r.
    pub(crate) to: f64,
    /// Number of strikes.
    pub(crate) strikes: Option<usize>,
}

impl Counts {
    /// Computes the counts for e in the middle of so many equal steps from 0 to 1.
    pub(crate) fn compute(steps: u16) -> Result<Self, Error> {
        let row = |k: u16| {
            let e = (f64::from(k) + 0.5) / f64::from(steps);
            let mut intervals: Vec<Interval> = Vec::new();
            for word in Plate::uniform(e)?.atlas(STRIKES)?.words() {
                let strikes = word.ended.then_some(word.corners.len());
                match intervals.last_mut() {
                    Some(last) if last.strikes == strikes => last.to = word.to,
                    _ => intervals.push(Interval { from: word.from, to: word.to, strikes }),
                }
            }
            Ok::<_, Error>((e, intervals))
        };
        Ok(Self { rows: (0..steps).map(row).collect::<Result<_, _>>()? })
    }

    /// Returns the share of the directions, over all e, whose number of strikes fulfills a condition.
    pub(crate) fn share(&self, is: impl Fn(Option<usize>) -> bool) -> f64 {
        let of = |row: &[Interval]| row.iter().filter(|i| is(i.strikes)).map(|i| i.to - i.from).sum::<f64>();
        #[expect(clippy::cast_precision_loss, reason = "a small grid")]
        let rows = self.rows.len() as f64;
        self.rows.iter().map(|(_, row)| of(row)).sum::<f64>() / rows
    }
}

/// A restitution up to which a word has no end: in closed form, and by the trains themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Endless {
    pub(crate) closed: f64,
    pub(crate) measured: f64,
}

/// Number of strikes after which a train that is not proven endless counts as one with an end.
const FOLLOWED: u64 = 256;

/// Returns the highest e at which a uniform plate with these gaps is proven to clatter without end, to the last bit,
/// between two values.
fn endless_up_to(gaps: [f64; 2], from: f64, to: f64) -> Result<f64, Error> {
    let start = PlateStart::level(gaps)?;
    let endless =
        |e: f64| Plate::uniform(e).is_ok_and(|plate| plate.summary(&start, FOLLOWED).count == PlateCount::Endless);
    Ok(turn(to, from, endless))
}

/// Returns the restitution on the diagonal, a bar with q = 5/7: up to q = 2√e/(1 + e).
pub(crate) fn endless_on_the_diagonal() -> Result<Endless, Error> {
    let q: f64 = 5.0 / 7.0;
    let root = (1.0 - (1.0 - q * q).sqrt()) / q;
    Ok(Endless { closed: root * root, measured: endless_up_to([1.0; 2], 0.1, 0.3)? })
}

/// Returns the restitution round the corners: up to where λ³ + ((1 + e) g − 1) λ² + ((1 + e) g − e) λ + e, g = 1/7,
/// touches zero at a positive λ.
pub(crate) fn endless_round_the_corners() -> Result<Endless, Error> {
    let has_root = |e: f64| {
        let g = 1.0 / 7.0;
        let (b, c) = ((1.0 + e) * g - 1.0, (1.0 + e) * g - e);
        let square = b * b - 3.0 * c;
        let lowest = (square.max(0.0).sqrt() - b) / 3.0;
        square >= 0.0 && ((lowest + b) * lowest + c) * lowest + e <= 0.0
    };
    Ok(Endless { closed: turn(0.1, 0.0, has_root), measured: endless_up_to([1.0, 0.3], 0.02, 0.04)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rods_are_told_from_other_words() {
        let word = |text: &str| text.bytes().map(|c| Corner::ALL[usize::from(c - b'a')]).collect::<Vec<_>>();
        for (text, want) in [
            ("acacac", true),
            ("adada", true),
            ("adcbadc", true),
            ("adbc", true),
            ("abcdabc", true),
            ("adc", true),
            ("acdabc", false),
            ("acab", false),
            ("acbd", false),
            ("adcd", false),
        ] {
            assert_eq!(is_rod(&word(text)), want, "{text}");
        }
    }

    #[test]
    fn azimuths_are_shared_out_whatever_the_aspect() {
        let atlas = Plate::uniform(0.3).unwrap().atlas(STRIKES).unwrap();
        for aspect in [0.5, 1.0, 3.0] {
            assert!((share(&atlas, aspect, |_| true) - 1.0).abs() < 1e-14, "{aspect}");
            // Along the other edge the same plate is 1/aspect as long: a–d becomes a–b.
            let [d, b] = [(aspect, Corner::D), (aspect.recip(), Corner::B)]
                .map(|(aspect, next)| share(&atlas, aspect, |word| word[1] == next));
            assert!((d - b).abs() < 1e-14, "{aspect}: {d} and {b}");
        }
        let short_side = |aspect| share(&atlas, aspect, |word| word[1] == Corner::D);
        assert!(short_side(3.0) > short_side(1.0) + 0.1, "across the short side lies the neighbor that is lower");
    }

    #[test]
    fn trains_end_where_the_closed_forms_say() {
        // A train is proven endless up to one part in 10⁹ of the border.
        let diagonal = endless_on_the_diagonal().unwrap();
        assert!(
            (diagonal.closed - 0.176_571_5).abs() < 1e-7 && (diagonal.measured / diagonal.closed - 1.0).abs() < 1e-8
        );
        let round = endless_round_the_corners().unwrap();
        assert!((round.closed - 0.029_55).abs() < 1e-5, "{round:?}");
        assert!((round.measured / round.closed - 1.0).abs() < 1e-4, "{round:?}");
    }

    /// Corners b and d then are half as high as a and c together.
    #[test]
    fn on_the_diagonal_no_two_corners_land_at_once() {
        for k in 1..=50_u8 {
            let plate = Plate::uniform(f64::from(k) / 50.0).unwrap();
            let start = PlateStart::default();
            let mut train = plate.train(&start).take(60);
            assert!(train.all(|impact| !impact.tie && matches!(impact.corner, Corner::A | Corner::C)), "{plate:?}");
        }
    }

    #[test]
    fn every_direction_has_its_count() {
        let counts = Counts::compute(20).unwrap();
        assert!((counts.share(|_| true) - 1.0).abs() < 1e-13);
        for (e, row) in &counts.rows {
            assert!(
                row[0].from == 0.0 && row.windows(2).all(|w| w[0].to.to_bits() == w[1].from.to_bits()),
                "{e}: {row:?}"
            );
        }
    }
}
