//! The command of the brute force; see the library.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clatter_brute::{compare, hunt, product::Product, random, spatial};

const USAGE: &str = "clatter-brute hunt PRODUCT.toml [--drops=4000] [--seed=1]
clatter-brute random KIND SEED
clatter-brute compare --kind=KIND|all [--seeds=1..20] [--drops=4000] [--clatter=PATH]
KIND: instant, contacts, low-e, high-e, tiny-tilt, steep, damped, feet, own-contacts, spin, stops, all of these; plate, box, plate-own-contacts, box-own-contacts, spin-plate, spin-box, plate-stops, box-stops; without --clatter, the command is that of CLATTER";

/// Arguments: those in order, and options.
struct Args(Vec<String>);

impl Args {
    fn option<T: std::str::FromStr>(&self, name: &str, or: T) -> Result<T, String> {
        match self.0.iter().find_map(|arg| arg.strip_prefix("--")?.strip_prefix(name)?.strip_prefix('=')) {
            Some(text) => text.parse().map_err(|_| format!("--{name}={text}: not understood")),
            None => Ok(or),
        }
    }

    fn at(&self, i: usize) -> Result<&str, String> {
        self.0.iter().filter(|arg| !arg.starts_with("--")).nth(i).map(String::as_str).ok_or(USAGE.to_owned())
    }
}

fn run(args: &Args, out: &mut dyn Write) -> Result<(), String> {
    if args.0.iter().any(|arg| arg == "--help") {
        return writeln!(out, "{USAGE}").map_err(|error| error.to_string());
    }
    let (drops, seed) = (args.option("drops", 4000)?, args.option("seed", 1)?);
    let said = match args.at(0)? {
        "hunt" => {
            let path = args.at(1)?;
            let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
            let product = Product::read(&text).map_err(|error| format!("{path}: {error}"))?;
            hunt::hunt(&product, drops, seed).iter().try_for_each(|worst| writeln!(out, "{worst}"))
        }
        "random" => {
            let seed = args.at(2)?.parse().map_err(|_| USAGE.to_owned())?;
            let kind = args.at(1)?;
            let in_space = spatial::KINDS.contains(&kind);
            let text = if in_space { Some(spatial::product(kind, seed)) } else { random::product(kind, seed) };
            write!(out, "{}", text.ok_or(USAGE)?)
        }
        "compare" => {
            let default = std::env::var_os("CLATTER").map_or("target/release/clatter".into(), PathBuf::from);
            let kind = args.option("kind", "all".to_owned())?;
            let seeds = args.option("seeds", "1..20".to_owned())?;
            let (from, to) = seeds.split_once("..").unwrap_or((&seeds, &seeds));
            let seed = |text: &str| text.parse::<u64>().map_err(|_| format!("--seeds={seeds}: A..B"));
            let clatter = args.option("clatter", default)?;
            return compare::compare(&clatter, &kind, seed(from)?..=seed(to)?, drops, out);
        }
        _ => return Err(USAGE.to_owned()),
    };
    said.map_err(|error| error.to_string())
}

fn main() -> ExitCode {
    let args = Args(std::env::args().skip(1).collect());
    match run(&args, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            let _ = writeln!(io::stderr(), "{message}");
            ExitCode::from(2)
        }
    }
}
