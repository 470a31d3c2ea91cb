//! This module gives the reasons for the results of an assessment: data, and the sentences that show it.

use std::fmt::{Display, Formatter};

use serde::Serializer;

use crate::AtStop;
use clatter_product::{ContactLaw, DropName, Error, MOST_FRICTION, Model, STANDARD_GRAVITY_M_S2};

/// The reason why a limit is undecided, or would be if nothing exceeded it. Shares are of the allowed value.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// No drop of the ranges is answered, for this.
    Unanswered(Error),
    /// Some of the drops that were tried are not answered.
    Refused {
        /// The number of them.
        count: usize,
        /// All that were tried.
        drops: usize,
        /// The reason why one of them is not.
        error: Error,
    },
    /// The search was stopped.
    Stopped {
        /// Drops that were answered by then.
        answered: usize,
    },
    /// The effect of real tilt on a plate is not known: the box of the same product is not followed, for this reason.
    NoTilt(Error),
    /// The model with the most physics does not answer the worst drop found, for this.
    Fullest(Model, Error),
    /// Nothing tells how far other drops may exceed the worst one found.
    NoBound,
    /// Other drops of the ranges may exceed the limit.
    Others {
        /// The demand of the worst drop found, as a share.
        found: f64,
        /// The demand that other drops may have, as a share.
        most: f64,
    },
    /// The assessment contradicts itself.
    Contradiction(Contradiction),
    /// One contact law says safe and the other one unsafe, and the file names none.
    Laws([(ContactLaw, Option<f64>); 2]),
    /// The file names no contact law, and the limit is undecided by this one.
    OtherLaw {
        /// The law.
        law: ContactLaw,
        /// The reasons why it is.
        doubts: Vec<Doubt>,
    },
    /// The file names no contact law, and the limit is exceeded by this one.
    ExceededByOtherLaw(ContactLaw),
    /// Products were drawn, which do not decide it either.
    Drawn {
        /// The number of products that were drawn.
        drawn: u64,
        /// The number that the reliability takes.
        of: u64,
        /// Those of them that hold or exceed it, nobody knows.
        open: u64,
        /// The reason why the first of them has no answer; none where what may still come decides.
        error: Option<Error>,
    },
    /// The part may hit its stop, after which the suspension is not linear.
    Stop {
        /// True where it does for sure.
        hits: bool,
        /// The margin of the rattle space, where it is known.
        margin: Option<f64>,
    },
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unanswered(Error::Stopped) => {
                write!(f, "no drop of the ranges is answered: {} its end", Error::Stopped)
            }
            Self::Unanswered(error) => write!(f, "no drop of the ranges is answered: {error}"),
            Self::Refused { count, drops, error } => {
                write!(f, "{count} of {drops} drops that were tried are not answered: {error}")
            }
            Self::Stopped { answered } => {
                write!(f, "{} its end, after {answered} drops that were answered", Error::Stopped)
            }
            Self::NoTilt(error) => write!(f, "what real tilt adds is not known: {error}"),
            Self::Fullest(model, error) => write!(f, "{} does not answer the worst drop found: {error}", model.name()),
            Self::NoBound => f.write_str("how far other drops may exceed the worst one found is not known"),
            Self::Others { found, most } => write!(
                f,
                "the worst drop found asks for {} % of the limit, and others may ask for up to {} %",
                percent(*found),
                percent(*most)
            ),
            Self::Contradiction(contradiction) => write!(f, "{contradiction}"),
            Self::Laws(laws) => {
                let one = |(law, share): (ContactLaw, Option<f64>)| {
                    let share = share.map_or("an unknown share".to_owned(), |share| format!("{} %", percent(share)));
                    format!("{} asks for {share} of the limit", law.name())
                };
                let both = laws.map(one).join(", ");
                write!(f, "it depends on the contact law, which the file does not name: {both}")
            }
            Self::OtherLaw { law, doubts } => {
                let why = joined(doubts).unwrap_or_default();
                write!(f, "by the {} contact law, which the file does not rule out: {why}", law.name())
            }
            Self::ExceededByOtherLaw(law) => {
                write!(f, "by the {} contact law, which the file does not rule out, it is exceeded", law.name())
            }
            Self::Drawn { drawn, of, open: 0, .. } => {
                write!(f, "the draw was stopped after {drawn} of {of} products, none of which exceeded it")
            }
            Self::Drawn { drawn, open, error, .. } => {
                write!(f, "of {drawn} products that were drawn {open} are not decided, and none exceeded it: ")?;
                match error {
                    Some(error) => write!(f, "{error}"),
                    None => {
                        f.write_str("what they may still ask for as they land again, or be off by, passes the limit")
                    }
                }
            }
            Self::Stop { hits, margin } => {
                let (hits, more) = if *hits { ("hits", "exceeds") } else { ("may hit", "may exceed") };
                let margin = margin.map_or(String::new(), |margin| format!(" (margin {:+} %)", percent(margin)));
                write!(
                    f,
                    "the part {hits} its stop: its displacement {more} the rattle space{margin}, and what the stop does is not known; \
                     a `stop`, more room or a stiffer mount decides it"
                )
            }
        }
    }
}

/// A contradiction in an assessment, which is an error of the program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contradiction {
    /// A drop has a larger demand than the bound by energy allows.
    AboveBound {
        /// The demand of the drop, in the unit of the limit.
        demand: f64,
        /// The bound by energy, in the unit of the limit.
        bound: f64,
    },
    /// A drop has a larger demand than the one that is reported as the worst; shares of the allowed value.
    AboveWorst {
        /// The demand of the drop.
        found: f64,
        /// The reported demand.
        told: f64,
    },
}

impl Display for Contradiction {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let (what, [one, other]) = match *self {
            Self::AboveBound { demand, bound } => ("a drop asks for more than its energy allows", [demand, bound]),
            Self::AboveWorst { found, told } => ("a drop asks for more than the worst that is told", [found, told]),
        };
        write!(f, "this is an error of clatter, please report it: {what} ({one:.4e} and {other:.4e})")
    }
}

/// A further fact to be known of a limit. Shares are of the allowed value.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Drops next to the worst one are not answered, so that nothing tells how far off it is.
    NoError,
    /// The answer may be off by this share of itself.
    Error(f64),
    /// The demand of rebounds may be up to this share, by their energy.
    Rebounds(f64),
    /// Nothing tells how far other drops may exceed the worst one found, for this.
    Open(Vec<Doubt>),
    /// The same of another drop of the list.
    OpenIn(Option<DropName>, Vec<Doubt>),
    /// The assessment contradicts itself.
    Contradiction(Contradiction),
    /// Edges beyond feet, which instant impacts do not follow, may come down as the product lands again.
    Edges,
    /// A bar does not roll about its length, where most products turn fastest.
    Rolls,
    /// The part reaches its stop, of which the file says nothing.
    AtStop(AtStop),
    /// The demand that real tilt and friction add, by a box with full rotation in drops next to the worst one.
    Tilt {
        /// The largest demand of the box less that of the worst drop, as a share of the latter; negative where the box has less.
        off: f64,
        /// The thickness of a plate; none of a bar.
        thickness_m: Option<f64>,
    },
    /// The requested model is not the one with the most physics.
    Model {
        /// The requested one.
        asked: Model,
        /// The one with the most physics.
        fullest: Model,
        /// The demand of the worst drop by that model, less that by this one, as a share of the latter.
        off: f64,
    },
}

impl Display for Note {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::AtStop(AtStop { largest_hit_m_s, asks_m_s2 }) => {
                let [soft, hard] = asks_m_s2.map(|a| three(a / STANDARD_GRAVITY_M_S2));
                write!(
                    f,
                    "it reaches its stop at up to {} m/s: one with contacts of 1 ms would ask the part for {soft} gn, one of 0.2 ms for {hard} gn; \
                     a `stop` in the file tells",
                    three(*largest_hit_m_s)
                )
            }
            Self::Rolls => f.write_str(
                "a bar does not roll about its length, which narrow products do several times as fast: a `width` tells how fast",
            ),
            Self::NoError => f.write_str("how far off it is is not known: drops next to the worst are not answered"),
            Self::Error(share) => write!(
                f,
                "it may be off by {} %: later strikes add, and multiply what those before got wrong",
                percent(*share)
            ),
            Self::Open(doubts) => {
                let why = joined(doubts).unwrap_or_default();
                write!(f, "how far other drops may exceed it is not known: {why}")
            }
            Self::OpenIn(name, doubts) => {
                let (name, why) = (name.map_or_else(String::new, |name| name.to_string()), joined(doubts).unwrap_or_default());
                write!(f, "how far drops of {name} may exceed it is not known: {why}")
            }
            Self::Contradiction(contradiction) => write!(f, "{contradiction}"),
            Self::Edges => f.write_str(
                "after its clatter edges beyond the feet may come down, which instant impacts do not follow: energy bounds what they \
                 change velocities by",
            ),
            Self::Rebounds(most) => {
                let most =
                    if most.is_finite() { format!("{} %", percent(*most)) } else { "an unknown share".to_owned() };
                write!(
                    f,
                    "rebounds may ask for up to {most} of the limit, by their energy: how the product lands again is sensitive to \
                     every input"
                )
            }
            Self::Tilt { off, thickness_m } => {
                match thickness_m {
                    Some(thickness_m) => {
                        write!(f, "the plate is of small tilt: a box {} mm thick with full rotation", (1e6 * thickness_m).round() / 1e3)?;
                    }
                    None => f.write_str("a steep bar is followed without friction, and its parts move upright: a box whose parts tilt with it")?,
                }
                write!(f, ", and friction of 0 and {MOST_FRICTION}, says {:+} % next to this drop", percent(*off))
            }
            Self::Model { asked, fullest, off } => {
                write!(f, "{} was asked for; {} says {:+} % in this drop", asked.name(), fullest.name(), percent(*off))
            }
        }
    }
}

/// The reason why a drop is followed by its model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// Contacts take a time that is known.
    ContactTime,
    /// The model was requested.
    ByRequest(Model),
    /// The contact time is not known.
    NoContactTime,
}

impl Display for Reason {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::ContactTime => f.write_str("contacts that take time: how long is known"),
            Self::ByRequest(model) => write!(f, "{} was asked for", model.name()),
            Self::NoContactTime => {
                f.write_str("instant impacts at real tilt, with gravity: the contact time is not known")
            }
        }
    }
}

/// Joins doubts, one after the other, in a sentence; none of none.
pub(crate) fn joined(doubts: &[Doubt]) -> Option<String> {
    let all: Vec<_> = doubts.iter().map(Doubt::to_string).collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// Rounds to three digits.
fn three(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// Returns a share of a hundred to one decimal.
fn percent(share: f64) -> f64 {
    (10.0 * (100.0 * share)).round() / 10.0
}

pub(crate) fn as_text<T: Display, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

pub(crate) fn as_texts<T: Display, S: Serializer>(list: &[T], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(list.iter().map(ToString::to_string))
}

pub(crate) fn as_sentence<S: Serializer>(doubts: &[Doubt], serializer: S) -> Result<S::Ok, S::Error> {
    match joined(doubts) {
        Some(text) => serializer.serialize_some(&text),
        None => serializer.serialize_none(),
    }
}
