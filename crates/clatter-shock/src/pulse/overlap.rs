//! Pulses that overlap: time is cut at every begin and end, and the parts between are summed.
//!
//! Where few parts act at once they are summed cut by cut. Where many do, time is halved again and again, and the parts
//! that act throughout a half are summed once for all of it, sinusoids of one rate as one: n log n steps instead of n².

use super::{Instant, Piece, Pulse, Shape, SinePiece};
use crate::Error;
use num_complex::Complex64;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A part of a pulse.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    start: Instant,
    end: Instant,
    law: Law,
}

#[derive(Debug, Clone, Copy)]
enum Law {
    Linear { from: f64, to: f64 },
    Sine { amplitude: f64, phase: f64, rate: f64 },
}

/// The most parts at once that are summed cut by cut.
const FEW: usize = 16;
/// The most sinusoids that are kept, or four for each part of a pulse.
const MOST_SINES: usize = 1 << 22;

/// The sum of the parts that act throughout an interval, as from its begin.
#[derive(Debug, Clone)]
struct Base {
    at: Instant,
    value: f64,
    slope: f64,
    sines: Vec<(f64, Complex64)>,
}

impl Base {
    fn moved(&self, at: Instant) -> Self {
        let dt = at.since(self.at);
        let sines = self.sines.iter().map(|&(rate, a)| (rate, a * Complex64::cis(rate * dt))).collect();
        Self { at, value: self.value + self.slope * dt, slope: self.slope, sines }
    }
    fn add(&mut self, term: &Term) {
        match term.law {
            Law::Linear { from, to } => {
                let slope = (to - from) / term.end.since(term.start);
                self.value += from + slope * self.at.since(term.start);
                self.slope += slope;
            }
            Law::Sine { amplitude, phase, rate } => {
                self.add_sine(rate, Complex64::from_polar(amplitude, phase + rate * self.at.since(term.start)));
            }
        }
    }
    fn add_sine(&mut self, rate: f64, a: Complex64) {
        match self.sines.iter_mut().find(|s| s.0.to_bits() == rate.to_bits()) {
            Some(sine) => sine.1 += a,
            None => self.sines.push((rate, a)),
        }
    }
}

/// Pieces, their sinusoids, and the last end.
type Built = (Vec<Piece>, Vec<SinePiece>, Instant);

/// Cuts time at every begin and end, and sums the parts between.
pub(super) fn pieces(mut terms: Vec<Term>) -> Result<Built, Error> {
    terms.sort_by(|a, b| a.start.order(&b.start));
    let mut cuts: Vec<Instant> = terms.iter().flat_map(|t| [t.start, t.end]).collect();
    cuts.sort_by(Instant::order);
    cuts.dedup();
    let end = cuts.last().copied().unwrap_or(Instant::at(0.0));
    let mut built = (Vec::with_capacity(cuts.len()), Vec::with_capacity(terms.len()), end);
    let base = Base { at: cuts.first().copied().unwrap_or(end), value: 0.0, slope: 0.0, sines: Vec::new() };
    if are_few(&terms) {
        sweep(&cuts, &terms, &base, &mut built);
    } else {
        let (sines, allowed) = (count_sines(&terms, &cuts), MOST_SINES.max(4 * terms.len()));
        if sines > allowed {
            return Err(Error::Overlap { sines, allowed });
        }
        divide(&cuts, &terms, &base, &mut built);
    }
    Ok(built)
}

/// Returns whether no instant has many parts. `terms` are in order of their starts.
fn are_few(terms: &[Term]) -> bool {
    let mut ends: Vec<Instant> = terms.iter().map(|t| t.end).collect();
    ends.sort_by(Instant::order);
    // The part that starts now finds the one that started FEW earlier, in order, ended: then at most FEW act.
    terms.iter().skip(FEW).zip(&ends).all(|(term, end)| end.order(&term.start) != Ordering::Greater)
}

/// Returns the number of sinusoids of different rates between all cuts.
fn count_sines(terms: &[Term], cuts: &[Instant]) -> usize {
    let mut ends: Vec<&Term> = terms.iter().collect();
    ends.sort_by(|a, b| a.end.order(&b.end));
    let (mut starting, mut ending) = (terms.iter().peekable(), ends.into_iter().peekable());
    let mut rates: BTreeMap<u64, usize> = BTreeMap::new();
    let mut sines = 0;
    for cut in cuts {
        while let Some(term) = ending.next_if(|t| t.end.order(cut) != Ordering::Greater) {
            if let Law::Sine { rate, .. } = term.law
                && let Some(count) = rates.get_mut(&rate.to_bits())
            {
                *count -= 1;
                if *count == 0 {
                    rates.remove(&rate.to_bits());
                }
            }
        }
        while let Some(term) = starting.next_if(|t| t.start.order(cut) != Ordering::Greater) {
            if let Law::Sine { rate, .. } = term.law {
                *rates.entry(rate.to_bits()).or_insert(0) += 1;
            }
        }
        sines += rates.len();
    }
    sines
}

/// Halves time until few parts are left that do not act throughout.
fn divide(cuts: &[Instant], terms: &[Term], base: &Base, built: &mut Built) {
    if cuts.len() <= FEW || terms.len() <= FEW {
        return sweep(cuts, terms, base, built);
    }
    let middle = cuts.len() / 2;
    for half in [&cuts[..=middle], &cuts[middle..]] {
        let (first, last) = (half[0], half[half.len() - 1]);
        let mut own = base.moved(first);
        let mut rest = Vec::new();
        for term in terms {
            if term.end.order(&first) != Ordering::Greater || term.start.order(&last) != Ordering::Less {
                continue;
            }
            if term.start.order(&first) != Ordering::Greater && term.end.order(&last) != Ordering::Less {
                own.add(term);
            } else {
                rest.push(*term);
            }
        }
        divide(half, &rest, &own, built);
    }
}

/// Sums the active parts cut by cut, in addition to `base`. `terms` are in order of their starts.
fn sweep(cuts: &[Instant], terms: &[Term], base: &Base, (pieces, sines, _): &mut Built) {
    let mut coming = terms.iter().peekable();
    let mut active: Vec<Term> = Vec::new();
    for cut in cuts.windows(2) {
        let (start, end) = (cut[0], cut[1]);
        active.retain(|t| t.end.order(&start) == Ordering::Greater);
        while let Some(term) = coming.next_if(|t| t.start.order(&start) != Ordering::Greater) {
            active.push(*term);
        }
        let first_sine = sines.len();
        let (since, until) = (start.since(base.at), end.since(base.at));
        let (mut from, mut to) = (base.value + base.slope * since, base.value + base.slope * until);
        let length = end.since(start);
        let mut add = |rate: f64, amplitude: f64, phase: Complex64| match sines[first_sine..]
            .iter_mut()
            .find(|s| s.rate.to_bits() == rate.to_bits())
        {
            Some(sine) => {
                let sum = sine.phase * sine.amplitude + phase * amplitude;
                sine.amplitude = sum.norm();
                sine.phase = if sine.amplitude > 0.0 { sum / sine.amplitude } else { sine.phase };
            }
            None => sines.push(SinePiece { amplitude, rate, phase, turned: Complex64::cis(rate * length) }),
        };
        for &(rate, a) in &base.sines {
            add(rate, 1.0, a * Complex64::cis(rate * since));
        }
        for t in &active {
            match t.law {
                Law::Linear { from: a, to: b } => {
                    let length = t.end.since(t.start);
                    let at = |instant: Instant| a + (b - a) * (instant.since(t.start) / length);
                    from += if t.start == start { a } else { at(start) };
                    to += if t.end == end { b } else { at(end) };
                }
                Law::Sine { amplitude, phase, rate } => {
                    add(rate, amplitude, Complex64::cis(phase + rate * start.since(t.start)));
                }
            }
        }
        pieces.push(Piece { shock: 0.0, start, length, from, to, sines: (first_sine, sines.len()) });
    }
}

/// Adds the parts of one pulse. Sinusoids are cut so that each part turns by half a circle at most.
pub(super) fn add_terms(p: &Pulse, terms: &mut Vec<Term>) {
    let (a, d) = (p.amplitude, p.duration);
    let instant = |fraction: f64| Instant::after(p.start, fraction * d);
    let mut add = |from: f64, to: f64, law: Law| {
        let (start, end) = (instant(from), instant(to));
        if start.order(&end) == Ordering::Less {
            terms.push(Term { start, end, law });
        }
    };
    let line = |from, to| Law::Linear { from, to };
    match p.shape {
        Shape::HalfSine => add(0.0, 1.0, Law::Sine { amplitude: a, phase: 0.0, rate: PI / d }),
        Shape::Haversine => {
            add(0.0, 1.0, line(0.5 * a, 0.5 * a));
            add(0.0, 0.5, Law::Sine { amplitude: -0.5 * a, phase: FRAC_PI_2, rate: TAU / d });
            add(0.5, 1.0, Law::Sine { amplitude: -0.5 * a, phase: PI + FRAC_PI_2, rate: TAU / d });
        }
        Shape::Triangle => {
            add(0.0, 0.5, line(0.0, a));
            add(0.5, 1.0, line(a, 0.0));
        }
        Shape::InitialPeakSawtooth => add(0.0, 1.0, line(a, 0.0)),
        Shape::TerminalPeakSawtooth => add(0.0, 1.0, line(0.0, a)),
        Shape::Rectangle => add(0.0, 1.0, line(a, a)),
        Shape::Trapezoid { ramp } => {
            add(0.0, ramp, line(0.0, a));
            add(ramp, 1.0 - ramp, line(a, a));
            add(1.0 - ramp, 1.0, line(a, 0.0));
        }
    }
}
