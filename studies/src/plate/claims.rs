//! The statements the paper makes about plates, each measured.

use clatter::{Bar, Corner, Extent, Plate, PlateCount, PlateStart, Start};

use super::bars::{BarsAndPlate, STRIKES};
use super::directions::{is_rod, share};
use super::{E, over_e, plane};
use crate::Error;
use crate::paper::claims::{count, largest, number, part, smallest, turn};
use crate::paper::{Claim, Verdict};

/// Returns every statement of the paper about plates, measured; for uniform plates unless the row says otherwise.
///
/// Directions of tilt are taken as evenly spread in azimuth; their shares are exact. Statements about all e are
/// measured on a grid.
///
/// ```
/// use clatter_studies::{paper::Verdict, plate_claims};
/// let claims = plate_claims()?;
/// // A square plate does not, as a rule, clatter along its diagonal.
/// let diagonal = claims.iter().find(|claim| claim.statement.starts_with("A square plate")).unwrap();
/// assert_eq!(diagonal.verdict, Verdict::Fails);
/// # Ok::<(), clatter_studies::Error>(())
/// ```
///
/// # Errors
/// None in practice: all plates are valid.
pub fn plate_claims() -> Result<Vec<Claim>, Error> {
    claims(&over_e()?, &plane()?)
}

/// Returns the same claims from uniform plates over e, and plates over α and β at e = 0.3.
pub(crate) fn claims(over_e: &[BarsAndPlate], plane: &[BarsAndPlate]) -> Result<Vec<Claim>, Error> {
    Ok(vec![
        sequence(over_e)?,
        rods()?,
        diagonal()?,
        short_side()?,
        insight(over_e)?,
        chore(over_e, plane)?,
        zone(over_e)?,
    ])
}

/// Returns the share of the azimuths of a plate that lead to words of one kind.
fn of(inertia: [f64; 2], e: f64, aspect: f64, kind: fn(&[Corner]) -> bool) -> Result<f64, Error> {
    let atlas = Plate::new(inertia.map(|a| a.sqrt().recip()), e)?.atlas(STRIKES)?;
    Ok(share(&atlas, aspect, kind))
}

const UNIFORM: [f64; 2] = [3.0; 2];
/// Inertia of a plate with its mass near the long axis: β > 1 + α.
const SLENDER: [f64; 2] = [3.0, 8.0];

fn sequence(over_e: &[BarsAndPlate]) -> Result<Claim, Error> {
    let mut fewest = usize::MAX;
    for plate in over_e {
        let atlas = Plate::uniform(plate.e)?.atlas(STRIKES)?;
        fewest = atlas.words().iter().map(|word| word.corners.len()).fold(fewest, usize::min);
    }
    let all = of(UNIFORM, E, 1.0, |word| Corner::ALL.iter().all(|corner| word.contains(corner)))?;
    let endless = Plate::uniform(0.1)?.summary(&PlateStart::default(), 1000);
    let left = endless.final_velocity.map_or(f64::NAN, |v| largest(v.map(f64::abs)));
    let rests = endless.count == PlateCount::Endless && left < 1e-9;
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let few = fewest as f64;
    Ok(Claim {
        place: "Sect. 1",
        statement: "One corner lands first and successive corners strike once or more, until the product bounces clear or lies still.",
        measured: vec![
            count("fewest strikes in any direction, any e", few),
            part("directions in which all four corners strike, e = 0.3", all),
            number("fastest corner after an endless train, e = 0.1, in v₀", left),
        ],
        verdict: Verdict::of(fewest >= 2 && all > 0.5 && rests, fewest >= 2),
        remark: "In the other directions, near the diagonal, two corners or three do.",
    })
}

fn rods() -> Result<Claim, Error> {
    let square = [0.1, E, 0.9].map(|e| of(UNIFORM, e, 1.0, is_rod));
    let [dead, usual, bouncy] = square;
    let (dead, usual, bouncy, long) = (dead?, usual?, bouncy?, of(UNIFORM, E, 2.0, is_rod)?);
    let slender = of(SLENDER, E, 2.0, is_rod)?;
    let all = [dead, usual, bouncy, long, slender];
    Ok(Claim {
        place: "Sect. 2",
        statement: "Rod-like behavior is common for flat rectangles of various aspect ratios.",
        measured: vec![
            part("directions, square, e = 0.1", dead),
            part("e = 0.3", usual),
            part("e = 0.9", bouncy),
            part("2 : 1, e = 0.3", long),
            part("2 : 1, mass near the long axis (α = 3, β = 8), e = 0.3", slender),
        ],
        verdict: Verdict::of(smallest(all) > 0.5, largest(all) > 0.5),
        remark: "Rod-like: the first four strikes are on two corners in turn, or on an edge and then the opposite one, as most \
                 are. Not where the mass lies near the long axis.",
    })
}

fn diagonal() -> Result<Claim, Error> {
    let back = |word: &[Corner]| word.starts_with(&[Corner::A, Corner::C, Corner::A]);
    let shares = [0.1, E, 0.5, 0.9].map(|e| of(UNIFORM, e, 1.0, back));
    let [a, b, c, d] = shares;
    let (a, b, c, d) = (a?, b?, c?, d?);
    let heavy = of([10.0; 2], E, 1.0, back)?;
    let all = [a, b, c, d, heavy];
    Ok(Claim {
        place: "Sect. 2",
        statement: "A square plate clatters on its lowest corner and the diagonal opposite, until the others take their turn.",
        measured: vec![
            part("directions that begin a, c, a; e = 0.1", a),
            part("e = 0.3", b),
            part("e = 0.5", c),
            part("e = 0.9", d),
            part("mass in the middle (α = β = 10), e = 0.3", heavy),
        ],
        verdict: Verdict::of(smallest(all) > 0.5, largest(all) > 0.5),
        remark: "Only where it lands near the diagonal. In most directions a neighbor strikes second and the corner opposite \
                 to that third.",
    })
}

fn short_side() -> Result<Claim, Error> {
    let [next, back]: [fn(&[Corner]) -> bool; 2] =
        [|word| word.starts_with(&[Corner::A, Corner::D]), |word| word.starts_with(&[Corner::A, Corner::D, Corner::A])];
    let second = of(UNIFORM, E, 2.0, next)?;
    let third = of(UNIFORM, E, 2.0, back)?;
    let slender = of(SLENDER, E, 2.0, back)?;
    let pushed = |beta: f64| {
        let plate = Plate::new([3.0_f64.sqrt().recip(), beta.sqrt().recip()], E)?;
        Ok::<_, Error>(plate.train(&PlateStart::default()).next().map_or(f64::NAN, |first| first.delta_v[3]))
    };
    let down = turn(1.0, 20.0, |beta| pushed(beta).is_ok_and(|jump| jump < 0.0));
    Ok(Claim {
        place: "Sect. 2",
        statement: "A longer plate clatters several times between its lowest corner and the neighbor across the short side.",
        measured: vec![
            part("2 : 1, e = 0.3: directions in which that neighbor is second", second),
            part("in which the lowest corner is third again", third),
            number("β from which a strike brings that neighbor down, α = 3", down),
            part("lowest corner third again with β = 8", slender),
        ],
        verdict: Verdict::of(third > 0.5, second > 0.5),
        remark: "It is second, but each strike pushes it up where β < 1 + α: the far short side is next. They alternate where the mass \
                 lies near the long axis.",
    })
}

/// Returns the restitutions from which on the bar and the plate have no safe zone within v0/2.
fn without_zone() -> [f64; 2] {
    let plate = |e: f64| Plate::uniform(e).and_then(|plate| plate.worst(STRIKES)).map(|s| s.safe_zone(0.5).extent);
    let bar = |e: f64| Bar::new(0.5, e).map(|bar| bar.shocks_either(&Start::default()).safe_zone(0.5).extent);
    [turn(0.2, 0.9, |e| bar(e) == Ok(Extent::None)), turn(0.2, 0.9, |e| plate(e) == Ok(Extent::None))]
}

fn insight(over_e: &[BarsAndPlate]) -> Result<Claim, Error> {
    let against = over_e.windows(2).filter(|w| w[1].corner < w[0].corner || w[1].middle < w[0].middle).count();
    let narrower = over_e.windows(2).filter(|w| (0..3).any(|k| w[1].plan[k] > w[0].plan[k])).count();
    let plate = BarsAndPlate::new(UNIFORM, E)?;
    let (corner, middle) = (plate.corner / plate.bar[0], plate.middle / plate.bar[1]);
    let [bar, own] = without_zone();
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let steps = (against + narrower) as f64;
    Ok(Claim {
        place: "Sect. 2",
        statement: "A plate would add little insight.",
        measured: vec![
            count("steps of e at which a shock falls or a zone widens", steps),
            number("largest corner shock over that of the bar's ends, e = 0.3", corner),
            number("shock in the middle over that in the bar's", middle),
            number("no zone within v₀/2 from e, bar", bar),
            number("plate", own),
        ],
        verdict: Verdict::of(steps == 0.0 && (corner - 1.0).abs() < 0.05 && (middle - 1.0).abs() < 0.05, steps == 0.0),
        remark: "The rules carry over: low e, parts in the middle. The numbers do not: the bar along an edge says too little of \
                 the corners and too much of the middle.",
    })
}

fn chore(over_e: &[BarsAndPlate], plane: &[BarsAndPlate]) -> Result<Claim, Error> {
    let off = |plate: &BarsAndPlate| plate.corner / plate.diagonal - 1.0;
    let uniform = largest(over_e.iter().map(|plate| off(plate).abs()));
    let others = plane.iter().map(off);
    let (least, most) = (smallest(others.clone()), largest(others));
    let words = Plate::uniform(E)?.atlas(STRIKES)?.words().len();
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let words = words as f64;
    Ok(Claim {
        place: "Sect. 2",
        statement: "It would add parameters of geometry and inertia and make design guidance a chore.",
        measured: vec![
            number("worst corner over that of a bar along the diagonal, less 1: most of uniform plates", uniform),
            number("least of α and β from 1 to 10, e = 0.3", least),
            number("most of them", most),
            count("orders of corners over all directions, e = 0.3", words),
        ],
        verdict: Verdict::of(uniform > 0.05, most > 0.05),
        remark: "Not of a uniform plate: the aspect has no effect, and the paper's charts hold at q = 5/7. Other plates get more than the \
                 bar along their diagonal, by up to a fifth; their worst case is a list.",
    })
}

fn zone(over_e: &[BarsAndPlate]) -> Result<Claim, Error> {
    let usual = BarsAndPlate::new(UNIFORM, E)?.plan[0];
    let dead = BarsAndPlate::new(UNIFORM, 0.1)?.plan[0];
    let both = BarsAndPlate::new([10.0; 2], 0.1)?.plan[0];
    let widest = largest(over_e.iter().map(|plate| plate.plan[0]));
    Ok(Claim {
        place: "Abstract",
        statement: "Low moment of inertia and low restitution make a significant safe zone in the center.",
        measured: vec![
            part("plan within v₀/2, uniform, e = 0.3", usual),
            part("e = 0.1", dead),
            part("widest of all e from 0.02", widest),
            part("α = β = 10, e = 0.1", both),
        ],
        verdict: Verdict::of(both > 0.1, both > usual && dead > usual),
        remark: "It grows as stated, but what is a tenth of the length of a bar is a few hundredths of the area of a plate.",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::Kind;

    #[test]
    fn every_statement_about_plates_is_measured() {
        let claims = plate_claims().unwrap();
        for claim in &claims {
            assert!(!claim.measured.is_empty() && !claim.remark.is_empty(), "{}", claim.statement);
            for m in &claim.measured {
                assert!(m.value.is_finite(), "{}: {m:?}", claim.statement);
                assert!(m.kind != Kind::Share || (0.0..=1.0).contains(&m.value), "{}: {m:?}", claim.statement);
            }
        }
    }

    #[test]
    fn measured_figures_have_their_closed_forms() {
        let claims = plate_claims().unwrap();
        let find = |what: &str| {
            let mut all = claims.iter().flat_map(|claim| &claim.measured).filter(|m| m.what == what);
            all.next().unwrap_or_else(|| panic!("nothing is called {what}")).value
        };
        let peak = |q: f64, e: f64| (1.0 + e) * (1.0 + q * (1.0 + e));
        let corner = peak(5.0 / 7.0, 0.3) / peak(0.5, 0.3);
        assert!((find("largest corner shock over that of the bar's ends, e = 0.3") - corner).abs() < 1e-13);
        assert!(
            (find("shock in the middle over that in the bar's") - corner * 4.0 / 7.0).abs() < 1e-13,
            "1/7 over 1/4"
        );
        // Zones end where the middle gets v0/2: a quarter of the bar's peak, a seventh of the plate's.
        assert!((peak(0.5, find("no zone within v₀/2 from e, bar")) / 4.0 - 0.5).abs() < 1e-13);
        assert!((peak(5.0 / 7.0, find("plate")) / 7.0 - 0.5).abs() < 1e-13);
        assert!((find("β from which a strike brings that neighbor down, α = 3") - 4.0).abs() < 1e-13, "1 + α");
        assert!(find("least of α and β from 1 to 10, e = 0.3") > -1e-13, "the diagonal is one of the directions");
    }
}
