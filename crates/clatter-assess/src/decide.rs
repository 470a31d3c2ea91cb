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
            Verdict::Unsafe => more_room(limit, f64::INFINITY),
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
        Doubt::Unanswered(error) | Doubt::NoTilt(error) | Doubt::Fullest(_, error) => of_error(error),
        Doubt::Refused { error, .. } | Doubt::Drawn { error: Some(error), .. } => of_error(error),
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

/// Returns the limit, to three digits, that leaves room for all that drops may ask for, where that is at most `most` of it.
fn more_room(limit: &LimitAssessment, most: f64) -> Option<String> {
    let asked = limit.demand?.max(limit.other_law.filter(|_| most.is_infinite()).unwrap_or(0.0));
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
    let (key, more) = (limit.limit.key(), (10.0 * more).ceil() / 10.0);
    Some(format!("{key}{part} = \"{value} {}\", {more} % more", unit.name))
}
