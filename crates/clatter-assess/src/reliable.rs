//! Limits that no search decides, decided by products that are drawn.

use clatter_product::{Component, Drop, Error, Limit, LimitKind, Model, ProductFile, Reliability};

use crate::assess::{in_unit, laws, model_of, stopped, verdict};
use crate::engine::answer;
use crate::reason::{Doubt, Note};
use crate::scatter::{ByLaw, DrawnLimit, Shown, draw};
use crate::search::{Task, Watch};
use crate::{Assessment, LandingAssessment, LimitAssessment, Verdict, WorstCase};

/// The products are those that [`scatter`](crate::scatter) draws by this seed.
const SEED: u64 = 1;

/// Draws products for the limits that an assessment leaves undecided, until so many in a row hold that it is *reliable*.
///
/// # Method
/// Products and drops are drawn as the file spreads them, ranges evenly, each product through all of its drops, by the model with the most
/// physics. Where none of [`Reliability::samples`] exceeds a limit, it is reliable: were the share of products that survive below R, so
/// many would hold in a row with a probability of 1 − C at most. A drop that exceeds it is a drop of the ranges, and the limit is unsafe. A
/// product of which neither is known, though its drops are followed until they lie, leaves the limit undecided. Where the file names no contact
/// law, each product is drawn by both, and a limit that one of them exceeds stays undecided.
///
/// No product is drawn for a limit that one law is known to exceed while the other holds, nor for the acceleration of a part that hits its stop.
///
/// # Errors
/// [`Error::OtherProduct`], [`Error::OtherDrops`] for the assessment of another product, and those of a product that cannot be drawn.
///
/// # Examples
/// ```
/// use clatter_product::{EXAMPLE, ProductFile, Reliability};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let searched = clatter_assess::assess(&file)?;
/// let decided = clatter_assess::reliable(&file, searched.clone(), Reliability::new(0.99, 0.95)?, &|_, _| true)?;
/// assert!(decided == searched, "nothing was undecided");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reliable(
    file: &ProductFile,
    assessment: Assessment,
    asked: Reliability,
    watch: Watch<'_>,
) -> Result<Assessment, Error> {
    seeded(file, assessment, asked, SEED, watch)
}

fn seeded(
    file: &ProductFile,
    mut assessment: Assessment,
    asked: Reliability,
    seed: u64,
    watch: Watch<'_>,
) -> Result<Assessment, Error> {
    assessment.is_of(file)?;
    let fullest = if file.product.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt };
    let laws = laws(file, fullest);
    let mut limits = Vec::new();
    for (component, (part, assessed)) in file.components.iter().zip(&assessment.components).enumerate() {
        for (number, (limit, found)) in Limit::of(part).into_iter().zip(&assessed.limits).enumerate() {
            let Some(by_law) = by_law(found, laws.len()) else { continue };
            let task = Task { component: part, limit };
            limits.push(DrawnLimit { task, component, number, by_law, drawn: 0, open: 0, error: None });
        }
    }
    if limits.is_empty() {
        return Ok(assessment);
    }
    draw(file, &assessment.accuracy, (seed, asked.samples()), &mut limits, watch)?;
    for drawn in &limits {
        let limit = &mut assessment.components[drawn.component].limits[drawn.number];
        limit.decide(file, drawn, asked);
        limit.hold_to_bound(assessment.accuracy.tolerance);
    }
    for (n, (component, assessed)) in file.components.iter().zip(&mut assessment.components).enumerate() {
        // A part that may still hit its stop has no other limit decided by what was drawn.
        let is_drawn = |k: usize| limits.iter().any(|drawn| (drawn.component, drawn.number) == (n, k));
        let own = assessed.limits.iter_mut().enumerate();
        let own = own.filter(|(k, limit)| is_drawn(*k) || limit.limit == LimitKind::RattleSpace);
        stopped(component, &mut own.map(|(_, limit)| limit).collect::<Vec<_>>());
        *assessed = verdict(file, component, std::mem::take(&mut assessed.limits));
    }
    for drawn in &limits {
        let limit = &assessment.components[drawn.component].limits[drawn.number];
        rows(&mut assessment.landings, drawn.task.component, limit);
    }
    assessment.verdict = Verdict::of(assessment.components.iter().map(|component| component.verdict));
    Ok(assessment)
}

/// Returns what the search knows of a limit by each law, if products that are drawn may decide it.
fn by_law(limit: &LimitAssessment, laws: usize) -> Option<Vec<ByLaw>> {
    let no_draw_decides =
        |doubt: &Doubt| matches!(doubt, Doubt::Laws(_) | Doubt::Contradiction(_) | Doubt::Stop { hits: true, .. });
    if limit.verdict != Verdict::Undecided || limit.undecided.iter().any(no_draw_decides) {
        return None;
    }
    let share = |demand: Option<f64>| demand.map_or(0.0, |demand| demand / limit.allowed);
    let by_law: Vec<ByLaw> =
        [limit.demand, limit.other_law].map(share).map(ByLaw::known).into_iter().take(laws).collect();
    by_law.iter().any(|law| !law.exceeded).then_some(by_law)
}

impl LimitAssessment {
    /// Takes in what products say of the limit.
    fn decide(&mut self, file: &ProductFile, drawn: &DrawnLimit<'_>, asked: Reliability) {
        let before: Vec<bool> = [self.demand, self.other_law].map(|demand| demand > Some(self.allowed)).into();
        if let Some(shown) = drawn.by_law[0].shown {
            self.show(file, drawn, &shown);
        }
        if let Some(shown) = drawn.by_law.get(1).and_then(|law| law.shown) {
            let asked = shown.answer.utilization() * self.allowed;
            self.other_law = Some(self.other_law.map_or(asked, |most| most.max(asked)));
        }
        self.verdict = drawn.verdict(asked.samples());
        match self.verdict {
            Verdict::Undecided => {
                let is_news = drawn.by_law.iter().zip(before).any(|(law, before)| law.exceeded && !before);
                if is_news {
                    let share = |demand: Option<f64>| demand.map(|demand| demand / self.allowed);
                    let law = file.product.law();
                    self.undecided =
                        vec![Doubt::Laws([(law, share(self.demand)), (law.other(), share(self.other_law))])];
                } else if drawn.by_law.iter().all(|law| !law.exceeded) {
                    let DrawnLimit { drawn, open, error, .. } = drawn;
                    let (drawn, of) = (*drawn, asked.samples());
                    self.undecided.push(Doubt::Drawn { drawn, of, open: *open, error: error.clone() });
                }
            }
            verdict => {
                self.reliability = Some(asked).filter(|_| verdict == Verdict::Reliable);
                (self.undecided, self.governs) = (Vec::new(), None);
            }
        }
    }

    /// Takes a drop of a drawn product for the worst one.
    fn show(&mut self, file: &ProductFile, drawn: &DrawnLimit<'_>, shown: &Shown) {
        let Shown { listed, drop, part, answer: found, model, tolerance } = *shown;
        let most = self.demand.map_or(f64::INFINITY, |demand| demand / self.allowed * (1.0 + self.uncertainty));
        let used = found.utilization();
        self.uncertainty = (most.max(used + found.off_by / found.allowed) / used - 1.0).max(0.0);
        let limit = in_unit(&drawn.task.limit, found.unit);
        let of = |drop: &Drop| answer(drop, &part, &limit, model, tolerance).ok().map(|answer| answer.value);
        self.clatter_free = of(&drop.flattened());
        let by_other = Drop { contact_law: drop.contact_law.other(), ..drop };
        self.other_law = match self.other_law {
            Some(demand) if drawn.by_law.len() > 1 => Some(demand / self.allowed * found.allowed),
            _ if model == Model::Compliant && drop.own_contacts.is_none() => of(&by_other),
            _ => None,
        };
        self.bound = self.bound.filter(|_| found.unit == drawn.task.limit.kind.unit());
        (self.unit, self.allowed) = (found.unit, found.allowed);
        (self.demand, self.margin) = (Some(found.value), Some(found.allowed / found.value - 1.0));
        self.worst_case = Some(WorstCase {
            drop,
            part,
            drawn: true,
            gyration_varies: !file.product.gyration_m.is_value(),
            landing: file.drop_names().get(listed).copied(),
            listed,
            impact: found.impact,
            time_s: found.time_s,
            model,
            tolerance,
        });
        self.notes.retain(|note| !matches!(note, Note::Model { .. }));
        self.model = model_of(file, listed, &drawn.task);
    }
}

/// Takes the result for a limit into those of each of several drops: one that no product exceeded, none exceeded in any drop.
fn rows(landings: &mut [LandingAssessment], component: &Component, limit: &LimitAssessment) {
    let worst = limit.worst_case.filter(|worst| worst.drawn).map(|worst| worst.listed);
    for (listed, landing) in landings.iter_mut().enumerate() {
        let is_own = |name: &str, kind: LimitKind| name == component.name && kind == limit.limit;
        for row in landing.limits.iter_mut().filter(|row| is_own(&row.component, row.limit)) {
            if worst == Some(listed) {
                (row.demand, row.margin) = (limit.demand, limit.margin);
                row.verdict = row.verdict.max(limit.verdict);
            }
            if limit.verdict == Verdict::Reliable && row.verdict == Verdict::Undecided {
                row.verdict = Verdict::Reliable;
            }
        }
        landing.verdict = Verdict::of(landing.limits.iter().map(|row| row.verdict));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accuracy;

    /// A bar that falls at 2 to 4 m/s, in free space: all that it does grows as its speed.
    const BAR: &str = r#"
product = { name = "bar", length = "150 mm", radius_of_gyration = "45 mm", restitution = 0.3 }
drop = { speed = ["2 m/s", "4 m/s"], tilt = "2 deg", first = "a", gravity = "0 gn" }
component = [{ name = "part", position = "40 mm", mount = "hard", velocity_change_limit = "LIMIT m/s" }]
"#;
    /// A bar whose contacts take time, of no named law. At so low a restitution a dashpot is the harder one by far.
    const EITHER: &str = r#"
product = { name = "bar", length = "150 mm", radius_of_gyration = "45 mm", restitution = 0.1, contact_time = "0.5 ms" }
drop = { speed = ["2 m/s", "4 m/s"], tilt = "2 deg", first = "a" }
component = [{ name = "part", position = "-75 mm", mount = "hard", acceleration_limit = "LIMIT m/s2" }]
"#;
    const PLATE: &str = r#"
product = { name = "plate", length = "150 mm", width = "80 mm", thickness = "10 mm", radius_of_gyration = ["43 mm", "23 mm"], restitution = 0.3, contact_time = "0.5 ms", contact_law = "hysteretic" }
drop = { speed = ["2 m/s", "4 m/s"], tilt = ["1 deg", "4 deg"] }
component = [{ name = "part", position = ["40 mm", "10 mm"], mount = "hard", acceleration_limit = "LIMIT m/s2" }]
"#;
    const BOX: &str = r#"
product = { name = "box", length = "150 mm", width = "80 mm", thickness = "40 mm", radius_of_gyration = ["43 mm", "23 mm"], restitution = 0.3, contact_time = "0.5 ms", contact_law = "hysteretic" }
drop = [{ speed = ["2 m/s", "4 m/s"], face = ["bottom", "end-a"] }]
component = [{ name = "part", position = ["40 mm", "10 mm"], mount = "hard", acceleration_limit = "LIMIT m/s2" }]
"#;

    fn read(text: &str, limit: f64) -> ProductFile {
        let text = text.replace("LIMIT", &format!("{limit:?}"));
        ProductFile::read(&text, "test.toml").unwrap_or_else(|faults| panic!("{faults}"))
    }

    /// An assessment by a search that found nothing and left all undecided.
    fn nothing_found(file: &ProductFile) -> Assessment {
        let found = crate::assess_watched(file, &Accuracy::default(), &|_, _| false).unwrap();
        let limits = found.components.iter().flat_map(|component| &component.limits);
        assert!(limits.clone().all(|limit| limit.verdict == Verdict::Undecided && limit.margin.is_none()), "{found:?}");
        found
    }

    fn asked(reliability: f64, confidence: f64) -> Reliability {
        Reliability::new(reliability, confidence).unwrap()
    }

    fn drawn(file: &ProductFile, by: Reliability, seed: u64) -> LimitAssessment {
        seeded(file, nothing_found(file), by, seed, &|_, _| true)
            .unwrap()
            .components
            .swap_remove(0)
            .limits
            .swap_remove(0)
    }

    /// Its demand in the fastest drop.
    fn most(text: &str) -> f64 {
        crate::assess(&read(text, 900.0)).unwrap().components[0].limits[0].demand.unwrap()
    }

    /// The limit that this share of all drops exceeds: of speeds from 2 to 4 m/s those above 4 − 2 share.
    fn exceeded_in(share: f64) -> f64 {
        most(BAR) / 4.0 * (4.0 - 2.0 * share)
    }

    /// The worst drop is one that the model answers with what is said.
    fn is_repeated(limit: &LimitAssessment) {
        let worst = limit.worst_case.unwrap();
        let allowed = Limit::new(limit.limit, limit.allowed);
        let again = answer(&worst.drop, &worst.part, &allowed, worst.model, worst.tolerance).unwrap();
        assert!(worst.drawn && Some(again.value) == limit.demand && again.value > limit.allowed, "{limit:?}");
        let command = worst.command();
        let case: crate::Case = serde_json::from_str(command.split('\'').nth(1).unwrap()).unwrap();
        let again = answer(&case.drop, &case.part().unwrap(), &allowed, case.model, case.tolerance).unwrap();
        assert_eq!(Some(again.value), limit.demand, "{command}");
    }

    #[test]
    fn what_one_product_in_twenty_exceeds_is_unsafe_and_what_none_does_is_reliable() {
        let limit = drawn(&read(BAR, exceeded_in(0.05)), asked(0.99, 0.95), 1);
        assert_eq!((limit.verdict, limit.reliability), (Verdict::Unsafe, None));
        assert!(limit.undecided.is_empty() && limit.decided_by.is_none() && limit.margin.unwrap() < 0.0);
        is_repeated(&limit);
        let file = read(BAR, 1.001 * most(BAR));
        for (by, samples) in [(asked(0.9, 0.9), 22), (asked(0.99, 0.95), 299), (asked(0.95, 0.95), 59)] {
            let limit = drawn(&file, by, 1);
            assert_eq!((limit.verdict, limit.reliability.unwrap().samples()), (Verdict::Reliable, samples));
            // The demand is the largest of those that were drawn, and that is less than the worst of all.
            let share = limit.demand.unwrap() / most(BAR);
            assert!((0.9..1.0).contains(&share) && limit.worst_case.unwrap().drawn, "{share}");
            let json = serde_json::to_value(&limit).unwrap();
            assert_eq!((&json["verdict"], &json["samples"]), (&"reliable".into(), &samples.into()));
            assert_eq!([&json["reliability"], &json["confidence"]], [by.reliability(), by.confidence()]);
        }
    }

    /// The promise: where fewer than 90 % of all products survive, reliable is said with a chance of at most 10 %. Of 200 draws of a product
    /// of which 89.9 % do it is 19 on average, and more than 33 in one of a thousand such tests.
    #[test]
    fn what_is_not_so_reliable_is_seldom_called_so() {
        let file = read(BAR, exceeded_in(0.101));
        let said = (0..200).filter(|seed| drawn(&file, asked(0.9, 0.9), *seed).verdict == Verdict::Reliable).count();
        assert!((7..=33).contains(&said), "{said} of 200");
    }

    #[test]
    fn both_laws_have_to_hold_where_none_is_named() {
        let [own, other] = ["hysteretic", "dashpot"]
            .map(|law| most(&EITHER.replace("\"0.5 ms\" }", &format!("\"0.5 ms\", contact_law = \"{law}\" }}"))));
        assert!(other > 2.1 * own, "so that in half of the speed the one is above the other: {own}, {other}");
        let of = |limit: f64| drawn(&read(EITHER, limit), asked(0.9, 0.9), 1);
        assert_eq!(of(1.01 * other).verdict, Verdict::Reliable);
        let limit = of(1.01 * own);
        assert_eq!((limit.verdict, limit.reliability), (Verdict::Undecided, None));
        assert!(limit.why_undecided().unwrap().contains("depends on the contact law"), "{limit:?}");
        assert!(limit.decided_by.as_ref().unwrap().starts_with("contact_law = "), "{limit:?}");
        assert!(limit.demand.unwrap() <= limit.allowed && limit.other_law.unwrap() > limit.allowed, "{limit:?}");
        let limit = of(0.5 * own);
        assert_eq!(limit.verdict, Verdict::Unsafe);
        is_repeated(&limit);
    }

    /// What the search knows counts: no draw makes a limit reliable that one law exceeds.
    #[test]
    fn what_one_law_is_known_to_exceed_is_not_drawn_away() {
        let own = most(&EITHER.replace("\"0.5 ms\" }", "\"0.5 ms\", contact_law = \"hysteretic\" }"));
        let file = read(EITHER, 1.5 * own);
        let found = crate::assess(&file).unwrap();
        assert!(matches!(found.components[0].limits[0].undecided[..], [Doubt::Laws(_)]), "{found:?}");
        let never = |_: usize, _: usize| -> bool { panic!("nothing is drawn") };
        assert_eq!(reliable(&file, found.clone(), asked(0.99, 0.95), &never).unwrap(), found);
    }

    #[test]
    fn plates_and_boxes_are_repeated_too_on_any_number_of_threads() {
        for text in [PLATE, BOX] {
            let worst = most(text);
            let file = read(text, 0.6 * worst);
            let found = nothing_found(&file);
            let of = |threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| reliable(&file, found.clone(), asked(0.9, 0.9), &|_, _| true)).unwrap()
            };
            let [one, seven] = [1, 7].map(of);
            assert_eq!(serde_json::to_string(&one).unwrap(), serde_json::to_string(&seven).unwrap());
            assert_eq!(one.verdict, Verdict::Unsafe);
            let limit = &one.components[0].limits[0];
            is_repeated(limit);
            let rows = one.landings.iter().flat_map(|landing| &landing.limits).filter_map(|row| row.demand);
            assert!(rows.into_iter().all(|demand| Some(demand) <= limit.demand));
            assert!(crate::portraits(&file, &one).len() == 1, "it is drawn");
            let file = read(text, 1.5 * worst);
            let all = reliable(&file, nothing_found(&file), asked(0.9, 0.9), &|_, _| true).unwrap();
            assert_eq!((all.verdict, all.components[0].reliability), (Verdict::Reliable, Some(asked(0.9, 0.9))));
            assert!(all.landings.iter().all(|landing| landing.verdict == Verdict::Reliable), "{:?}", all.landings);
        }
    }

    /// Ends that sink in by more than the product is made for are answered in no drop: the draw gives up soon.
    #[test]
    fn where_no_product_is_answered_the_draw_ends() {
        let file = read(&EITHER.replace("0.5 ms", "40 ms"), 1e4);
        let found = crate::assess(&file).unwrap();
        assert!(matches!(found.components[0].limits[0].undecided[..], [Doubt::Unanswered(_), ..]), "{found:?}");
        let limit = &reliable(&file, found, asked(0.99, 0.95), &|_, _| true).unwrap().components[0].limits[0];
        let why = limit.why_undecided().unwrap();
        assert!(
            why.contains("of 32 products that were drawn 32 are not decided, and none exceeded it: contact time"),
            "{why}"
        );
        assert!(limit.decided_by.as_ref().unwrap().starts_with("contact_time of at most "), "{limit:?}");
    }

    /// A draw that is stopped leaves the limit undecided, and says how far it came.
    #[test]
    fn a_draw_that_is_stopped_says_so() {
        let file = read(BAR, 1.001 * most(BAR));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let stopped = pool.install(|| reliable(&file, nothing_found(&file), asked(0.9, 0.9), &|done, _| done < 10));
        let limit = &stopped.unwrap().components[0].limits[0];
        assert!(limit.why_undecided().unwrap().ends_with("stopped after 10 of 22 products, none of which exceeded it"));
    }

    /// What hits its stop in a drop that was drawn is not linear: its acceleration is decided with its rattle space alone.
    #[test]
    fn an_acceleration_is_reliable_where_the_stop_is_not_reached() {
        let text = BAR.replace("mount = \"hard\", velocity_change_limit = \"LIMIT m/s\"", "natural_frequency = \"60 Hz\", damping_ratio = 0.1, acceleration_limit = \"1000 gn\", rattle_space = \"LIMIT mm\"");
        let space_mm = 1e3 * crate::assess(&read(&text, 100.0)).unwrap().components[0].limits[1].demand.unwrap();
        for (factor, expected) in [(1.001, [Verdict::Reliable; 2]), (0.7, [Verdict::Undecided, Verdict::Unsafe])] {
            let file = read(&text, factor * space_mm);
            let all = reliable(&file, nothing_found(&file), asked(0.9, 0.9), &|_, _| true).unwrap();
            let limits = &all.components[0].limits;
            assert_eq!([limits[0].verdict, limits[1].verdict], expected, "{limits:?}");
        }
    }
}
