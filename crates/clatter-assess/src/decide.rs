//! This module names the one command or change that would decide a limit, from the reasons why it is undecided.

use clatter_product::{Error, LimitKind, Source};

use crate::reason::Doubt;
use crate::{LimitAssessment, Verdict};

/// The command that draws products.
const DRAW: &str = "clatter assess FILE --reliability=99%";
/// Up to this share of the limit that drops may ask for, a little more room decides it; beyond, products have to be drawn.
const LITTLE: f64 = 1.1;

/// Names for each undecided limit of a component what would decide it. Where the file names no contact law, more room is not known to be
/// enough by both.
pub(crate) fn decide(limits: &mut [LimitAssessment], by_both_laws: bool) {
    let of_stop =
        limits.iter().find(|limit| limit.limit == LimitKind::RattleSpace).and_then(|limit| match limit.verdict {
            Verdict::Unsafe => more_room(limit, LITTLE).or_else(|| Some(a_stop(limit))),
            _ => decided_by(limit, by_both_laws),
        });
    for limit in limits {
        limit.decided_by = match limit.undecided.as_slice() {
            [Doubt::Stop { .. }, ..] => of_stop.clone(),
            _ => decided_by(limit, by_both_laws),
        };
    }
}

fn decided_by(limit: &LimitAssessment, by_both_laws: bool) -> Option<String> {
    let doubts = &limit.undecided;
    let is_drawn = doubts.iter().any(|doubt| matches!(doubt, Doubt::Drawn { .. }));
    if doubts.is_empty() || doubts.iter().any(|doubt| matches!(doubt, Doubt::Contradiction(_))) {
        return None;
    }
    if let Some(change) = doubts.iter().find_map(of_law).or_else(|| doubts.iter().find_map(of_refusal)) {
        return Some(change);
    }
    // A drop that nothing lets answer is not answered as it is drawn.
    if doubts.iter().any(|doubt| matches!(doubt, Doubt::Unanswered(_))) {
        return None;
    }
    let is_by_others = doubts.iter().all(|doubt| matches!(doubt, Doubt::Others { .. } | Doubt::Drawn { .. }));
    let room = more_room(limit, LITTLE).filter(|_| is_by_others && !by_both_laws);
    room.or_else(|| (!is_drawn).then(|| DRAW.to_owned()))
}

/// Returns the law to be named, where one of them decides.
fn of_law(doubt: &Doubt) -> Option<String> {
    match doubt {
        Doubt::Laws(_) | Doubt::ExceededByOtherLaw(_) => {
            Some("contact_law = \"hysteretic\" or \"dashpot\", whichever it is".to_owned())
        }
        Doubt::OtherLaw { law, .. } => Some(format!("contact_law = {:?}, if that is what it is", law.other().name())),
        _ => None,
    }
}

/// Returns what would be answered in place of what was refused.
fn of_refusal(doubt: &Doubt) -> Option<String> {
    match doubt {
        Doubt::Stopped { .. } | Doubt::Unanswered(Error::Stopped) | Doubt::Drawn { open: 0, .. } => {
            Some("a longer --time-limit".to_owned())
        }
        Doubt::Unanswered(error)
        | Doubt::NoTilt(error)
        | Doubt::Fullest(_, error)
        | Doubt::Refused { error, .. }
        | Doubt::Drawn { error: Some(error), .. } => of_error(error),
        _ => None,
    }
}

fn of_error(error: &Error) -> Option<String> {
    match error {
        Error::Flight(flight) => {
            flight.allowed().map(|(name, allowed)| format!("{} of {allowed}", name.replace(' ', "_")))
        }
        _ => None,
    }
}

/// Returns the stop of a part that exceeds its rattle space, as it is written in the file: anywhere from foam to bare plastics.
fn a_stop(space: &LimitAssessment) -> String {
    let unit = space.unit.customary();
    let gap: f64 = format!("{:.6e}", unit.of_si(space.allowed)).parse().unwrap_or_default();
    let gap = format!("{gap} {}", unit.name);
    format!(
        "stop = {{ gap = \"{gap}\", contact_time = [\"0.2 ms\", \"1 ms\"], restitution = [0.3, 0.7] }}, or as it was measured"
    )
}

/// Returns the limit, to three digits, that leaves room for all that drops may ask for, where that is at most `most` of it.
fn more_room(limit: &LimitAssessment, most: f64) -> Option<String> {
    let asked = limit.demand?;
    let needed = asked * (1.0 + limit.uncertainty);
    if !(needed.is_finite() && needed <= most * limit.allowed) {
        return None;
    }
    let unit = limit.unit.customary();
    let digit = libm::pow(10.0, libm::log10(unit.of_si(needed)).floor() - 2.0);
    let rounded = (unit.of_si(needed) / digit + 1e-9).ceil() * digit;
    let value: f64 = format!("{rounded:.6e}").parse().ok()?;
    let more = 100.0 * (value / unit.of_si(limit.allowed) - 1.0);
    let part = match limit.limit.source() {
        Source::Boundary if limit.unit == limit.limit.unit() => ".velocity_change",
        Source::Boundary => ".acceleration",
        _ => "",
    };
    let (key, more) = (limit.limit.key(), (10.0 * more - 1e-6).ceil() / 10.0);
    Some(format!("{key}{part} = \"{value} {}\", {more} % more", unit.name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_product::{ContactLaw, ProductFile};

    /// A bar with one part, of this limit.
    fn assessed(limit: &str) -> LimitAssessment {
        let text = format!(
            "product = {{ name = \"bar\", length = \"150 mm\", radius_of_gyration = \"45 mm\", restitution = 0.3, contact_time = \"0.5 ms\", \
             contact_law = \"hysteretic\" }}\ndrop = {{ height = \"1 m\", tilt = [\"1 deg\", \"6 deg\"] }}\ncomponent = [{{ name = \"part\", \
             position = \"40 mm\", natural_frequency = \"90 Hz\", damping_ratio = 0.05, {limit} }}]\n"
        );
        let file = ProductFile::read(&text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}"));
        crate::assess(&file).unwrap().components.swap_remove(0).limits.swap_remove(0)
    }

    fn limit(undecided: Vec<Doubt>) -> LimitAssessment {
        LimitAssessment { undecided, verdict: Verdict::Undecided, ..assessed("acceleration_limit = \"9000 gn\"") }
    }

    fn said(doubt: Doubt) -> Option<String> {
        decided_by(&limit(vec![doubt]), false)
    }

    #[test]
    fn each_reason_has_its_change() {
        let draw = Some(DRAW.to_owned());
        let bound = |value, bound| clatter_flight::Error::Bound {
            name: "contact time",
            value,
            bound,
            most: true,
            unit: "s",
            reason: "",
        };
        let shorter = || Error::Flight(bound(4e-3, 3.2e-3));
        assert_eq!(said(Doubt::NoBound), draw);
        assert_eq!(said(Doubt::Unanswered(shorter())).unwrap(), "contact_time of at most 3.2 ms");
        assert_eq!(
            said(Doubt::Refused { count: 1, drops: 9, error: shorter() }).unwrap(),
            "contact_time of at most 3.2 ms"
        );
        assert_eq!(said(Doubt::Refused { count: 1, drops: 9, error: Error::Unfinished }), draw);
        assert_eq!(said(Doubt::Unanswered(Error::Unfinished)), None, "what nothing answers is not drawn");
        assert_eq!(said(Doubt::Stopped { answered: 3 }).unwrap(), "a longer --time-limit");
        let laws = [ContactLaw::Hysteretic, ContactLaw::Dashpot].map(|law| (law, None));
        assert_eq!(said(Doubt::Laws(laws)).unwrap(), "contact_law = \"hysteretic\" or \"dashpot\", whichever it is");
        let other = Doubt::OtherLaw { law: ContactLaw::Dashpot, doubts: Vec::new() };
        assert_eq!(said(other).unwrap(), "contact_law = \"hysteretic\", if that is what it is");
        let drawn = Doubt::Drawn { drawn: 299, of: 299, open: 2, error: None };
        assert_eq!(decided_by(&limit(vec![Doubt::NoBound, drawn]), false), None, "more products tell no more");
        assert_eq!(said(Doubt::Contradiction(crate::Contradiction::AboveWorst { found: 1.0, told: 0.9 })), None);
    }

    /// A little room that is missing is named, to three digits and on the side that is enough; much, or by two laws, is drawn for.
    #[test]
    fn a_little_room_is_named() {
        let of = |demand: f64, uncertainty, both| {
            let allowed = 100.0 * clatter_product::STANDARD_GRAVITY_M_S2;
            let demand = Some(demand * allowed);
            decided_by(
                &LimitAssessment {
                    allowed,
                    demand,
                    uncertainty,
                    ..limit(vec![Doubt::Others { found: 1.0, most: 1.0 }])
                },
                both,
            )
        };
        assert_eq!(of(0.96, 0.09, false).unwrap(), "acceleration_limit = \"105 gn\", 5 % more");
        assert_eq!(of(0.96, 0.09, true).unwrap(), DRAW);
        assert_eq!(of(0.96, 0.2, false).unwrap(), DRAW);
        assert_eq!(of(0.96, f64::INFINITY, false).unwrap(), DRAW);
    }

    /// The change that is named decides: put into the file, the limit is safe.
    #[test]
    fn the_room_that_is_named_is_enough() {
        let demand = assessed("acceleration_limit = \"9000 gn\"").demand.unwrap();
        let close = assessed(&format!("acceleration_limit = \"{:?} m/s2\"", 1.005 * demand));
        let by = close.decided_by.clone().unwrap();
        let (change, more) = by.split_once(", ").unwrap();
        assert!(close.verdict == Verdict::Undecided && more.ends_with(" % more"), "{by}: {close:?}");
        assert_eq!(assessed(change).verdict, Verdict::Safe, "{by}");
    }
}
