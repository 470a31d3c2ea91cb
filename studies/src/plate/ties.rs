//! Corners that land at one instant, or nearly, by rigid impacts and by contacts that take time.

use clatter::{Bar, Corner, End, Plate, PlateStart, Start};
use clatter_assess::{Part, answer};
use clatter_flight::{Contact, ContactLaw, PlateScene};
use clatter_product::{Drop, Limit, LimitKind, Model, Place};
use rayon::prelude::*;

use super::E;
use super::bars::STRIKES;
use crate::Error;

/// Contact time in s, on a plate of 2 m by 2 m that falls at 1 m/s without gravity: at small tilt no other length or
/// speed counts.
const CONTACT_S: f64 = 1e-4;
/// Tolerance of the answer for each drop.
const TOLERANCE: f64 = 1e-3;

/// Returns the shocks of a drop of a uniform plate onto contacts that take time: `gap` is the heights of b and d
/// together over the fall in one contact time, `r` the direction of its tilt.
fn drop_shocks(law: ContactLaw, gap: f64, r: f64) -> Result<Shocks, Error> {
    let plate = clatter_flight::Plate::new([1.0; 4], [(1.0_f64 / 3.0).sqrt(); 2])?;
    let height = gap * CONTACT_S;
    let contact = Contact::new(law, E, CONTACT_S)?;
    let scene = PlateScene::new(plate, 1.0, [height * (1.0 - r), height * r], 0.0)?;
    let drop = Drop { contact_time_s: Some(CONTACT_S), contact_law: law, ..Drop::of_plate(&scene, E)? };
    let mut found = Shocks { shocks: [0.0; 4], peak: 0.0 };
    for (shock, at_m) in found.shocks.iter_mut().zip(plate.corners_m()) {
        let part = Part::at(Place::flat(at_m), None);
        let value_of = |kind| answer(&drop, &part, &Limit::new(kind, 1.0), Model::Compliant, TOLERANCE);
        *shock = value_of(LimitKind::VelocityChange)?.value;
        found.peak = found.peak.max(value_of(LimitKind::Acceleration)?.value / contact.peak_per_change());
    }
    Ok(found)
}

/// The shocks of the corners of a plate.
struct Shocks {
    /// Largest velocity shock of each corner, in v0.
    shocks: [f64; 4],
    /// Largest acceleration of any corner, as the shock of a lone contact with that peak.
    peak: f64,
}

impl Shocks {
    fn largest(&self) -> f64 {
        self.shocks.into_iter().fold(0.0, f64::max)
    }
}

/// The largest shock of a corner near ties.
#[derive(Debug)]
pub(crate) struct Ties {
    /// Rigid: directions from r = 0 to ½ with one shock each, (from, to, shock).
    pub(crate) rigid: Vec<[f64; 3]>,
    /// Largest shocks by each law over r, at [`GAP`].
    pub(crate) over_direction: [Vec<(f64, f64)>; 2],
    /// Largest shocks by each law over the gap, the worst of all directions.
    pub(crate) over_gap: [Vec<(f64, f64)>; 2],
    /// Largest acceleration by each law over all gaps and directions, as the shock of a lone contact with that peak.
    pub(crate) peaks: [f64; 2],
    /// Shocks of each corner in a landing on the edge from a to d, by method.
    pub(crate) edge: [(&'static str, [f64; 4]); 5],
}

/// Heights of b and d together, over the fall in one contact time, for the curve over the direction.
pub(crate) const GAP: f64 = 10.0;
/// Directions of a curve, up to the diagonal, and those among which the worst is searched.
const CURVE: u16 = 100;
const SEARCH: u16 = 50;
/// Gaps of a curve: from 10⁻¹ to 10²·⁵.
const GAPS: u16 = 28;
/// Gap of a landing on an edge: the far edge is so high that nothing overlaps with it.
const FAR: f64 = 100.0;

impl Ties {
    pub(crate) fn compute() -> Result<Self, Error> {
        let plate = Plate::uniform(E)?;
        let words = plate.atlas(STRIKES)?;
        let rigid = words.words().iter().filter(|word| word.from < 0.5);
        let rigid = rigid.map(|word| [word.from, word.to.min(0.5), word.peak()]).collect();
        let direction = |k: u16, of: u16| 0.5 * f64::from(k) / f64::from(of);
        let over_direction = |law| {
            let point = |k| Ok((direction(k, CURVE), drop_shocks(law, GAP, direction(k, CURVE))?.largest()));
            (0..=CURVE).into_par_iter().map(point).collect::<Result<Vec<_>, Error>>()
        };
        let over_gap = |law| {
            let point = |k: u16| {
                let gap = 10.0_f64.powf(3.5 * f64::from(k) / f64::from(GAPS) - 1.0);
                let mut worst = [0.0_f64; 2];
                for k in 0..=SEARCH {
                    let found = drop_shocks(law, gap, direction(k, SEARCH))?;
                    worst = [worst[0].max(found.largest()), worst[1].max(found.peak)];
                }
                Ok((gap, worst))
            };
            let worst = (0..=GAPS).into_par_iter().map(point).collect::<Result<Vec<_>, Error>>()?;
            let peak = worst.iter().fold(0.0_f64, |most, (_, [_, peak])| most.max(*peak));
            let shocks: Vec<_> = worst.into_iter().map(|(gap, [shock, _])| (gap, shock)).collect();
            Ok::<_, Error>((shocks, peak))
        };
        let [hysteretic, dashpot] = ContactLaw::ALL;
        let ((soft, soft_peak), (rubber, rubber_peak)) = (over_gap(hysteretic)?, over_gap(dashpot)?);
        Ok(Self {
            rigid,
            over_direction: [over_direction(hysteretic)?, over_direction(dashpot)?],
            over_gap: [soft, rubber],
            peaks: [soft_peak, rubber_peak],
            edge: edge(&plate)?,
        })
    }

    /// Returns the largest shock of all gaps and directions by a law, and the gap that has it.
    pub(crate) fn worst(&self, law: usize) -> (f64, f64) {
        self.over_gap[law]
            .iter()
            .fold((0.0, 0.0), |most, &(gap, shock)| if shock > most.1 { (gap, shock) } else { most })
    }
}

/// Returns the shocks of corners a, b, c and d in a landing on the edge from a to d.
fn edge(plate: &Plate) -> Result<[(&'static str, [f64; 4]); 5], Error> {
    let start = PlateStart::level([1.0, 0.0])?;
    let shocks = plate.shocks(&start, STRIKES as u64);
    let [a, b, c, d] = Corner::ALL.map(|corner| shocks.at(corner.position()));
    let bar = Bar::new(0.5, E)?.shocks(&Start::default(), End::A);
    let [near, far] = [-1.0, 1.0].map(|s| bar.at(s));
    let [hysteretic, dashpot] = ContactLaw::ALL;
    Ok([
        ("rigid, a just before d", [a, b, c, d]),
        // This is the same in a mirror.
        ("rigid, d just before a", [d, c, b, a]),
        ("rigid, both at once: the paper's bar", [near, far, far, near]),
        ("contacts, hysteretic", drop_shocks(hysteretic, FAR, 0.0)?.shocks),
        ("contacts, dashpot", drop_shocks(dashpot, FAR, 0.0)?.shocks),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::claims::turn;

    /// An edge that lands whole is the paper's bar, whose hysteretic contacts tend to instant impacts. If one corner
    /// lands a moment before the other, one far corner gets a larger shock and the other a smaller one.
    #[test]
    fn contacts_make_one_answer_of_a_tie() {
        let [(_, first), (_, second), (_, both), (_, hysteretic), (_, dashpot)] =
            edge(&Plate::uniform(E).unwrap()).unwrap();
        assert!(first[2] > 1.05 * both[2] && first[1] < 0.9 * both[1], "{first:?}, {both:?}");
        let mirrored = [first[3], first[2], first[1], first[0]];
        assert_eq!(second.map(f64::to_bits), mirrored.map(f64::to_bits), "{second:?}");
        for (got, want) in hysteretic.iter().zip(both) {
            assert!((got / want - 1.0).abs() < 2.0 * TOLERANCE, "{hysteretic:?}, not {both:?}");
        }
        assert!(dashpot.iter().zip(both).all(|(got, want)| (got / want - 1.0).abs() < 0.05), "{dashpot:?}");
    }

    #[test]
    fn contacts_that_are_short_beside_the_gaps_agree_with_rigid_impacts() {
        let atlas = Plate::uniform(E).unwrap().atlas(STRIKES).unwrap();
        for r in [0.1, 0.3, 0.45, 0.5] {
            let rigid = atlas.words().iter().find(|word| word.to >= r).unwrap().peak();
            for law in ContactLaw::ALL {
                let got = drop_shocks(law, 1000.0, r).unwrap().largest();
                assert!((got / rigid - 1.0).abs() < 2.0 * TOLERANCE, "{law:?} at {r}: {got}, not {rigid}");
            }
        }
    }

    /// Each of four contacts then carries a quarter of the mass, a lone one a seventh: the hysteretic law keeps its
    /// restitution, the dashpot has that of a damping ratio √(4/7) as large.
    #[test]
    fn a_flat_landing_is_one_shock_by_the_law_of_more_mass() {
        let ratio = |e: f64| Contact::new(ContactLaw::Dashpot, e, CONTACT_S).unwrap().damping_ratio();
        let given_back = turn(0.9, 0.1, |e| ratio(e) >= (4.0_f64 / 7.0).sqrt() * ratio(E));
        for (law, e) in [(ContactLaw::Hysteretic, E), (ContactLaw::Dashpot, given_back)] {
            let shocks = drop_shocks(law, 0.0, 0.5).unwrap().shocks;
            assert!(shocks.iter().all(|shock| (shock - 1.0 - e).abs() < 2.0 * TOLERANCE), "{law:?}, {e}: {shocks:?}");
        }
    }
}
