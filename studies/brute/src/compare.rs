//! Comparison of `clatter assess` with the brute force on random products.

use std::collections::BTreeMap;
use std::io::Write;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::flight::{Law, Own};
use crate::hunt::{Worst, hunt};
use crate::part::{Stop, Suspension};
use crate::product::{Kind, Product, gaps};
use crate::random::{KINDS, Random, product};
use crate::spatial;

/// Relative excess of a finding over the reported value from which on it counts: the error of the integration here.
pub(crate) const SLACK: f64 = 1e-3;

/// The counts of a comparison.
#[derive(Debug, Default)]
struct Counts {
    limits: usize,
    reached: usize,
    above: usize,
    turning: usize,
    search: usize,
    broken: usize,
    beyond: usize,
    room: usize,
    undecided: usize,
    unanswered: usize,
    reasons: BTreeMap<String, usize>,
}

/// One limit as reported by `clatter assess`.
pub(crate) struct Claimed {
    pub(crate) verdict: String,
    pub(crate) demand: f64,
    pub(crate) allowed: f64,
    pub(crate) uncertainty: f64,
    /// Bound over all drops of the ranges; NaN where none is given.
    pub(crate) bound: f64,
    reason: String,
}

impl Claimed {
    /// Returns whether a found value exceeds the bound.
    pub(crate) fn is_beyond_bound(&self, found: f64) -> bool {
        found > self.bound * (1.0 + SLACK)
    }
}

/// Compares products of a kind, or of all.
///
/// # Errors
/// Where the command does not run or writes fail.
pub fn compare(
    clatter: &Path,
    kind: &str,
    seeds: RangeInclusive<u64>,
    drops: usize,
    out: &mut dyn Write,
) -> Result<(), String> {
    if spatial::KINDS.contains(&kind) {
        return spatial::compare(clatter, kind, seeds, drops, out);
    }
    let kinds: Vec<&str> = KINDS.into_iter().filter(|&name| kind == "all" || kind == name).collect();
    if kinds.is_empty() {
        return Err(format!("--kind={kind}: one of {}, {}", KINDS.join(", "), spatial::KINDS.join(", ")));
    }
    let mut reasons = BTreeMap::new();
    for kind in kinds {
        let mut counts = Counts::default();
        for seed in seeds.clone() {
            let text = product(kind, seed).ok_or("no such kind")?;
            let lines = one(clatter, kind, seed, &text, drops, &mut counts)?;
            write!(out, "{lines}").and_then(|()| out.flush()).map_err(|error| error.to_string())?;
        }
        let Counts { limits, reached, above, turning, search, broken, beyond, room, undecided, unanswered, .. } =
            counts;
        writeln!(
            out,
            "== {kind}: {limits} limits; for {reached} a drop reaches 99 % of what was told, for {above} one exceeds it with its \
             uncertainty ({turning} only by how the bar turns in free flight; {search} that clatter answers as high), {beyond} above their \
             bound, {broken} were told safe and are exceeded; of {room} with 10 to 30 % of room {undecided} are undecided; {unanswered} are not answered"
        )
        .map_err(|error| error.to_string())?;
        for (reason, count) in counts.reasons {
            *reasons.entry(reason).or_insert(0) += count;
        }
    }
    for (reason, count) in reasons {
        writeln!(out, "{count:6} undecided: {reason}").map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// Compares one product: a first assessment gives the demands, a second has limits somewhat above them.
fn one(clatter: &Path, kind: &str, seed: u64, text: &str, drops: usize, counts: &mut Counts) -> Result<String, String> {
    let first = assess(clatter, text)?;
    let limited = with_room(text, &first, &mut Random::new(seed + 77));
    let told = assess(clatter, &limited)?;
    let product = Product::read(&limited)?;
    let mut lines = String::new();
    for worst in hunt(&product, drops, seed) {
        counts.limits += 1;
        let name = (worst.part.clone(), worst.kind.name().to_owned());
        let Some(told) = told.get(&name) else {
            lines += &format!("{kind} {seed}: {worst}\n  not told\n");
            continue;
        };
        let Claimed { verdict, demand, allowed, uncertainty, bound, reason } = told;
        if told.is_beyond_bound(worst.peak.value) {
            counts.beyond += 1;
            lines += &format!("{kind} {seed}: {worst}\n  ABOVE ITS BOUND of {bound:.5}\n");
        }
        if demand.is_nan() {
            lines += &format!("{kind} {seed}: {worst}\n  {verdict}, no drop is answered: {reason}\n");
            counts.unanswered += 1;
            continue;
        }
        let found = worst.peak.value;
        let over = found / (demand * (1.0 + uncertainty)) - 1.0;
        let broken = verdict == "safe" && found > allowed * (1.0 + SLACK);
        counts.broken += usize::from(broken);
        counts.reached += usize::from(found > 0.99 * demand);
        if allowed / demand > 1.1 && allowed / demand < 1.3 {
            counts.room += 1;
            if verdict == "undecided" {
                counts.undecided += 1;
                *counts.reasons.entry(reason.clone()).or_default() += 1;
            }
        }
        if over > SLACK || broken {
            counts.above += 1;
            counts.turning += usize::from(worst.still < demand * (1.0 + uncertainty) * (1.0 + SLACK));
            let repeat = repeat(&worst);
            // A flat landing of instant impacts cannot be given by its tilt.
            let same = if worst.flat { None } else { answer(clatter, &repeat, worst.kind) };
            counts.search += usize::from(same.is_some_and(|same| same > found * (1.0 - 0.01)));
            lines += &format!(
                "{kind} {seed}: {worst}\n  told {demand:.5} ± {:.1} % {verdict}, allowed {allowed:.5}: {:+.1} % beyond{}; without turning in flight {:.5}; the same drop by clatter: {}\n  {}\n",
                uncertainty * 100.0,
                over * 100.0,
                if broken { ", NOT SAFE" } else { "" },
                worst.still,
                same.map_or("none".to_owned(), |same| format!("{same:.5} ({:+.2} %)", (same / found - 1.0) * 100.0)),
                repeat.join(" ")
            );
        }
    }
    Ok(lines)
}

/// Returns the same file with limits up to 30 % above the reported demands.
pub(crate) fn with_room(text: &str, told: &BTreeMap<(String, String), Claimed>, random: &mut Random) -> String {
    let (mut limited, gaps) = (String::new(), gaps(text));
    let mut part = -1;
    for line in text.lines() {
        part += i32::from(line == "[[component]]");
        let limit = told.iter().find(|((name, kind), _)| {
            *name == format!("part {part}") && line.starts_with(&format!("{} = ", key(kind)))
        });
        match limit {
            Some(((_, kind), told)) if told.demand > 0.0 => {
                let mut allowed = told.demand * (1.0 + random.within(0.0, 0.3));
                if kind == "rattle-space" {
                    // A file whose stop lies beyond the rattle space is refused.
                    allowed = allowed.max(gaps.get(part as usize).copied().unwrap_or(0.0) * (1.0 + 1e-6));
                }
                limited += &format!("{} = \"{allowed:.6e} {}\"\n", key(kind), unit(kind));
            }
            _ => limited += &format!("{line}\n"),
        }
    }
    limited
}

fn key(kind: &str) -> String {
    let name = kind.replace('-', "_");
    if kind == "rattle-space" { name } else { name + "_limit" }
}

fn unit(kind: &str) -> &str {
    match kind {
        "acceleration" => "m/s2",
        "rattle-space" => "m",
        "velocity-change" | "stop-speed" => "m/s",
        "angular-velocity-change" => "rad/s",
        _ => unreachable!("{kind} is no limit of one number"),
    }
}

/// Returns every limit by its part and kind.
pub(crate) fn assess(clatter: &Path, text: &str) -> Result<BTreeMap<(String, String), Claimed>, String> {
    let file: PathBuf = std::env::temp_dir().join(format!("clatter-brute-{}.toml", std::process::id()));
    std::fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))?;
    let output = Command::new(clatter).arg("assess").arg("--format=json").arg(&file).output();
    let output = output.map_err(|error| format!("{}: {error}", clatter.display()))?;
    let _ = std::fs::remove_file(&file);
    let answer: Value = serde_json::from_slice(&output.stdout)
        .map_err(|_| format!("{}\n{text}", String::from_utf8_lossy(&output.stderr)))?;
    let list = |value: &Value, key: &str| value[key].as_array().cloned().unwrap_or_default();
    let number = |value: &Value, key: &str| value[key].as_f64().unwrap_or(f64::NAN);
    let word = |value: &Value, key: &str| value[key].as_str().unwrap_or_default().to_owned();
    let mut limits = BTreeMap::new();
    for component in list(&answer, "components") {
        for limit in list(&component, "limits") {
            let reason = match &limit["undecided"] {
                Value::String(text) => text.clone(),
                Value::Object(map) => map.get("reason").unwrap_or(&Value::Null).to_string(),
                other => other.to_string(),
            };
            let told = Claimed {
                verdict: word(&limit, "verdict"),
                demand: number(&limit, "demand"),
                allowed: number(&limit, "allowed"),
                uncertainty: number(&limit, "uncertainty"),
                bound: number(&limit, "bound"),
                reason: without_numbers(&reason),
            };
            limits.insert((word(&component, "name"), word(&limit, "limit")), told);
        }
    }
    Ok(limits)
}

/// Returns a reason without its numbers, by which alone reasons differ from file to file.
fn without_numbers(text: &str) -> String {
    let word = |word: &str| if word.contains(|c: char| c.is_ascii_digit()) { "#" } else { word }.to_owned();
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// Returns the arguments for the same drop in clatter; its end a is the one that touches first.
#[must_use]
pub fn repeat(worst: &Worst) -> Vec<String> {
    let Worst { drop, place, suspension, .. } = worst;
    let sign = if drop.b_first { -1.0 } else { 1.0 };
    let half = sign * drop.length / 2.0;
    let model = if drop.contact.is_some() { "compliant" } else { "finite-tilt" };
    let mut args = vec![
        "respond".to_owned(),
        format!("--model={model}"),
        format!("--length-m={}", drop.length),
        format!("--gyration-m={}", drop.gyration),
        format!("--center-of-mass={}", drop.center / half),
        format!("--e={}", drop.e),
        format!("--speed-m-s={}", drop.speed),
        format!("--tilt-deg={}", if worst.flat { 0.0 } else { drop.tilt.to_degrees() }),
        format!("--spin-rad-s={}", drop.spin),
        format!("--gravity-m-s2={}", drop.gravity),
        format!("--at={}", ((place + drop.center) / half).clamp(-1.0, 1.0)),
        "--tolerance=0.001".to_owned(),
    ];
    if let Some((law, time)) = drop.contact {
        let law = if law == Law::Dashpot { "dashpot" } else { "hysteretic" };
        args.extend([format!("--contact-law={law}"), format!("--contact-time-s={time}")]);
    }
    // In clatter end a is the one that touches first.
    for (end, own) in drop.own.iter().enumerate().filter(|(_, own)| **own != Own::default()) {
        let (e, time) = (own.e.unwrap_or(drop.e), own.time.or(drop.contact.map(|(_, time)| time)).unwrap_or(0.0));
        args.push(format!("--contact={},{e},{time}", ["a", "b"][end ^ usize::from(drop.b_first)]));
    }
    args.extend(suspension.iter().flat_map(held));
    args
}

/// Returns the arguments of a suspension.
pub(crate) fn held(Suspension { omega, zeta, stop }: &Suspension) -> Vec<String> {
    let mut args = vec![format!("--omega={omega}"), format!("--damping={zeta}")];
    if let Some(Stop { gap, time, e }) = stop {
        args.extend([
            format!("--stop-gap-m={gap}"),
            format!("--stop-contact-time-s={time}"),
            format!("--stop-restitution={e}"),
        ]);
    }
    args
}

pub(crate) fn answer(clatter: &Path, args: &[String], kind: Kind) -> Option<f64> {
    let output = Command::new(clatter).args(args).arg("--format=json").stderr(Stdio::null()).output().ok()?;
    let answer: Value = serde_json::from_slice(&output.stdout).ok()?;
    let suspended = args.iter().any(|arg| arg.starts_with("--omega="));
    let value = |key: &str| answer["answers"][key]["value"].as_f64();
    match kind {
        Kind::Acceleration if suspended => value("part_acceleration"),
        Kind::Acceleration => value("acceleration"),
        Kind::RattleSpace => value("part_displacement"),
        Kind::StopSpeed => answer["at_stop"]["largest_hit_m_s"].as_f64(),
        Kind::VelocityChange => value("velocity_change"),
        Kind::AngularVelocityChange => value("angular_velocity_change"),
        Kind::DamageBoundary(velocity, acceleration) => {
            Some((value("velocity_change")? / velocity).min(value("acceleration")? / acceleration))
        }
    }
}
