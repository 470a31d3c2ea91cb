//! Summaries of the train of a plate.

use super::endless::Limit;
use super::{Corner, Plate, PlateImpact, PlateShocks, PlateStart};

/// The number of impacts of a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum PlateCount {
    /// The exact number of impacts.
    Finite(u64),
    /// A train proven without end: some corners strike in the same order for ever.
    Endless,
    /// More impacts than were followed.
    MoreThan(u64),
}

/// The largest velocity shock of a train.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlatePeak {
    /// Largest shock of a corner in its own strike, (1 + e)|v_j|.
    pub corner: f64,
    /// The impact that holds it, from 1; the first if several tie.
    pub impact: u64,
    /// The corner that strikes then.
    pub struck: Corner,
    /// Largest shock of the center of mass, (1 + e)|v_j|/w_j(j).
    pub center: f64,
    /// Bound on the shocks of later strikes, where the train was not followed to its end: (1 + e) √w_j(j) times the
    /// root of twice the kinetic energy that is left, per mass. 0 after the last strike.
    pub later: f64,
}

/// A train of a plate without the list of its impacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateSummary {
    /// Number of impacts.
    pub count: PlateCount,
    /// Time of the last impact followed, or the limit it tends to where the train is endless.
    pub duration: f64,
    /// Largest shocks.
    pub peak: PlatePeak,
    /// Velocities of the corners after the last impact, or the limit they tend to; `None` where the train was not
    /// followed to its end. A corner that still comes down in the limit strikes after the endless train, on a plate
    /// that rests on two others: that strike is not followed, and bounded by [`PlatePeak::later`].
    pub final_velocity: Option<[f64; 4]>,
    /// Largest shocks of every corner in its own strikes.
    struck: [f64; 4],
    /// Bound on the shock of a corner in strikes that were not followed, 0 where they are known to be less than
    /// `struck`.
    open: f64,
}

/// The number of strikes after which a train is first checked for an end; later checks are at every power of two.
const FIRST_CHECK: u64 = 8;

impl Plate {
    /// Returns count, peaks, final velocities and duration, of at most so many impacts.
    ///
    /// # Method
    /// The train is followed, and checked after 8, 16, 32 … strikes for having no end: two corners that alternate as an
    /// endless bar, or a word of three or four corners that repeats itself and shrinks.
    ///
    /// # Examples
    /// The diagonal of a uniform plate is a bar with q = 5/7, endless from e = 0.17657 down:
    /// ```
    /// use clatter::{Plate, PlateCount, PlateStart};
    /// let count = |e: f64| Ok::<_, clatter::Error>(Plate::uniform(e)?.summary(&PlateStart::default(), 1000).count);
    /// assert_eq!(count(0.176)?, PlateCount::Endless);
    /// assert_eq!(count(0.3)?, PlateCount::Finite(6));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn summary(&self, start: &PlateStart, most: u64) -> PlateSummary {
        let mut train = self.train(start);
        let mut struck = [0.0_f64; 4];
        let mut peak = PlatePeak { corner: 0.0, impact: 0, struck: Corner::A, center: 0.0, later: 0.0 };
        let (mut word, mut duration, mut next_check) = (Vec::new(), 0.0, FIRST_CHECK);
        while (word.len() as u64) < most {
            let Some(PlateImpact { number, corner, approach, time, .. }) = train.next() else { break };
            duration = time;
            let (shock, j) = ((-1.0 - self.e) * approach, corner as usize);
            word.push(j);
            struck[j] = struck[j].max(shock);
            peak.center = peak.center.max(shock / self.weight[j]);
            if shock > peak.corner {
                (peak.corner, peak.impact, peak.struck) = (shock, number, corner);
            }
            if number == next_check {
                next_check *= 2;
                let limit = self.limit(start, &word, &train);
                let less = |limit: &Limit| (0..4).all(|j| limit.later[j] <= struck[j]);
                if let Some(limit) = limit.filter(|limit| next_check > most || less(limit)) {
                    peak.later = limit.later.into_iter().fold(limit.after, f64::max);
                    let duration = if start.is_flat() { 0.0 } else { limit.time };
                    let (count, final_velocity) = (PlateCount::Endless, Some(limit.velocity));
                    let open = if less(&limit) { limit.after } else { peak.later };
                    return PlateSummary { count, duration, peak, final_velocity, struck, open };
                }
            }
        }
        let number = word.len() as u64;
        if train.ended() {
            let (count, final_velocity) = (PlateCount::Finite(number), Some(train.velocities()));
            return PlateSummary { count, duration, peak, final_velocity, struck, open: 0.0 };
        }
        peak.later = self.later(&train.velocities());
        PlateSummary {
            count: PlateCount::MoreThan(number),
            duration,
            peak,
            final_velocity: None,
            struck,
            open: peak.later,
        }
    }

    /// Returns the largest shocks of one drop everywhere on the plate, of at most so many impacts.
    #[must_use]
    pub fn shocks(&self, start: &PlateStart, most: u64) -> PlateShocks {
        let summary = self.summary(start, most);
        PlateShocks::new(self, summary.struck, summary.open)
    }

    /// Returns a bound on the shocks of strikes after these velocities.
    pub(super) fn later(&self, velocities: &[f64; 4]) -> f64 {
        (1.0 + self.e) * self.heaviest.sqrt() * self.norm(*velocities)
    }
}
