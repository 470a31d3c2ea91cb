//! This crate is the `clatter` command: it takes arguments and writes tables, JSON, maps and reports.
//!
//! [`run`] is the whole command. It writes to the streams it is handed and returns how the process should
//! exit, so that tests call it as they would call the command.
//!
//! ```
//! use clatter_cli::{Exit, Streams, run};
//!
//! let (mut out, mut err) = (Vec::new(), Vec::new());
//! let mut streams = Streams { out: &mut out, err: &mut err, interactive: false };
//! let exit = run(["clatter", "zone", "--q=0.5", "--e=0", "--threshold=1", "--format=csv"], &mut streams);
//! assert_eq!(exit, Exit::Done);
//! assert!(String::from_utf8(out)?.starts_with("threshold,s,extent\n1.0,"));
//! # Ok::<(), std::string::FromUtf8Error>(())
//! ```

mod assess;
mod atlas;
mod budget;
mod columns;
mod completions;
mod condition_args;
mod design;
mod drop_args;
mod excitation;
mod explain;
mod failure;
mod find_args;
mod fit;
mod help;
mod impacts;
mod init;
mod input;
mod inputs;
mod lists;
mod map;
mod measured;
mod npy;
mod numbers;
mod one_drop;
mod output;
mod progress;
mod quantities;
mod record;
mod record_args;
mod report;
mod respond;
mod scatter;
mod schema;
mod simulate;
mod spectrum;
mod study;
mod text;
mod tradeoff;
mod words;
mod zone;

use std::ffi::OsString;
use std::fmt;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Mutex;

use clap::error::ContextValue;
use clap::{CommandFactory, Parser, Subcommand};
use clatter_answer::Versioned;
use serde::Serialize;

use failure::Failure;
use output::Files;

/// The streams that a command writes to.
pub struct Streams<'a> {
    /// The answer, and nothing else.
    pub out: &'a mut dyn Write,
    /// Warnings, progress and errors.
    pub err: &'a mut dyn Write,
    /// True where somebody watches `err`: progress is shown only then.
    pub interactive: bool,
}

impl fmt::Debug for Streams<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Streams").field("interactive", &self.interactive).finish_non_exhaustive()
    }
}

impl Streams<'_> {
    /// Writes an answer for programs on one line: all of it, or nothing.
    fn json(&mut self, answer: &impl Serialize) -> Result<(), Failure> {
        self.line(&Versioned::new(answer))
    }

    /// Writes several answers in the same way.
    fn json_list(&mut self, answers: &[impl Serialize]) -> Result<(), Failure> {
        self.line(&answers.iter().map(Versioned::new).collect::<Vec<_>>())
    }

    fn line(&mut self, answer: &impl Serialize) -> Result<(), Failure> {
        let text = serde_json::to_string(answer).map_err(|error| Failure::Answer(error.into()))?;
        writeln!(self.out, "{text}").map_err(Failure::Answer)
    }

    /// Writes an answer that may not fit into memory in the same way, part by part.
    fn long_json(&mut self, answer: &impl Serialize) -> Result<(), Failure> {
        serde_json::to_writer(&mut *self.out, &Versioned::new(answer))
            .map_err(|error| Failure::Answer(error.into()))?;
        writeln!(self.out).map_err(Failure::Answer)
    }

    /// Writes a line to standard error, below the part of the answer that is there. A line that cannot be shown is no reason to fail.
    fn note(&mut self, kind: &str, what: impl fmt::Display) {
        self.beside(&format!("{kind}: {what}\n"));
    }

    /// Writes text in the same way that is complete: no terminal obeys anything in it, wherever it comes from.
    fn beside(&mut self, text: &str) {
        let _ = self.out.flush(); // whoever writes next sees the same failure, and tells
        let _ = write!(self.err, "{}", text::visible_lines(text));
    }
}

/// The exit code of the process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// 0: done.
    Done = 0,
    /// 1: an assessment found a component unsafe or could not decide, a survival target was missed, or a spectrum exceeds
    /// its limit.
    Unsafe = 1,
    /// 2: bad input or usage, or an output that cannot be written.
    BadInput = 2,
    /// 3: an outside program is missing or failed.
    Outside = 3,
    /// 4: the answer is whole, and the file beside it that was asked for is not made, as the time was over.
    Unprinted = 4,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// What a tilted drop does to the parts inside a flat product.
///
/// A flat body that falls almost level lands on one end, then on the other, in a rapid train of impacts: the
/// clatter. Each impact changes the velocity of every part at once. These velocity shocks, not the drop alone,
/// are what the parts have to survive.
#[derive(Debug, Parser)]
#[command(name = "clatter", version, after_help = SHORT_HELP, after_long_help = inputs::PRIMER, max_term_width = 100, help_template = help::template())]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Write over a file that the command reads as well, or that is write-protected
    #[arg(long, global = true)]
    force: bool,
    #[command(flatten)]
    budget: budget::Budget,
}

const SHORT_HELP: &str =
    "Start with 'clatter impacts --q=0.5 --e=0.3'. 'clatter --help' tells what q, e and the units are.";

#[derive(Debug, Subcommand)]
enum Command {
    Impacts(impacts::Args),
    Zone(zone::Args),
    Atlas(atlas::Args),
    Map(map::Args),
    Simulate(Box<simulate::Args>),
    Respond(Box<respond::Args>),
    Record(Box<record::Args>),
    Spectrum(Box<spectrum::Args>),
    Design(design::Args),
    Scatter(scatter::Args),
    Study(study::Args),
    Assess(assess::Args),
    Explain(explain::Args),
    Tradeoff(tradeoff::Args),
    Fit(Box<fit::Args>),
    Init(init::Args),
    Schema(schema::Args),
    Report(report::Args),
    Completions(completions::Args),
}

impl Cli {
    fn run(self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        self.command.files().check_input()?;
        self.command.files().check(self.force)?;
        let less = self.command.less();
        let asks = matches!(self.command, Command::Assess(_) | Command::Scatter(_) | Command::Design(_));
        self.budget.watch(less, asks, streams.interactive);
        let exit = self.command.run(self.force, streams)?;
        if budget::was_cut() {
            streams
                .note("warning", format_args!("--time-limit is over: the answer is of what was done by then; {less}"));
        }
        Ok(exit)
    }
}

impl Command {
    /// Returns the advice on how to use less memory and time.
    fn less(&self) -> &'static str {
        match self {
            Self::Impacts(_) | Self::Simulate(_) => "fewer impacts or a shorter time take less",
            Self::Map(_) => "fewer values of q and e take less",
            Self::Record(_) => "a shorter record and fewer channels take less",
            Self::Respond(_) | Self::Spectrum(_) => "shorter lists and fewer natural frequencies take less",
            Self::Scatter(_) => "fewer samples take less",
            Self::Study(_) => "more and smaller shards take less",
            Self::Fit(_) => "shorter records take less",
            Self::Report(_) => "one report at a time takes less",
            _ => "narrower ranges and fewer components take less",
        }
    }

    fn run(self, force: bool, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        match self {
            Self::Scatter(args) => return args.run(streams),
            Self::Study(args) => return args.run(force, streams),
            Self::Assess(args) => return args.run(streams),
            Self::Design(args) => return args.run(streams),
            Self::Spectrum(args) => return args.run(streams),
            Self::Impacts(args) => args.run(streams),
            Self::Zone(args) => args.run(streams),
            Self::Atlas(args) => args.run(streams),
            Self::Map(args) => args.run(streams),
            Self::Simulate(args) => args.run(streams),
            Self::Respond(args) => args.run(streams),
            Self::Record(args) => args.run(streams),
            Self::Explain(args) => args.run(streams),
            Self::Tradeoff(args) => args.run(streams),
            Self::Fit(args) => args.run(streams),
            Self::Init(args) => args.run(streams),
            Self::Schema(args) => args.run(streams),
            Self::Report(args) => args.run(streams),
            Self::Completions(args) => args.run(&mut Cli::command(), streams),
        }?;
        Ok(Exit::Done)
    }

    fn files(&self) -> Files<'_> {
        match self {
            Self::Atlas(args) => args.files(),
            Self::Map(args) => args.files(),
            Self::Simulate(args) => args.files(),
            Self::Respond(args) => args.files(),
            Self::Record(args) => args.files(),
            Self::Spectrum(args) => args.files(),
            Self::Design(args) => args.files(),
            Self::Scatter(args) => args.files(),
            Self::Study(args) => args.files(),
            Self::Assess(args) => args.files(),
            Self::Tradeoff(args) => args.files(),
            Self::Fit(args) => args.files(),
            _ => Files::default(),
        }
    }
}

/// Prepares a process of the command's own, at its start: memory and time are watched, and the threads are made that share long work.
/// There are as many threads as processors, or as many as `RAYON_NUM_THREADS` says if that is less; none but the present one where
/// no more can be made.
pub fn own_process() {
    budget::own_process();
    columns::own_process();
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse().ok()).filter(|count| *count > 0);
    let count = asked.map_or(processors, |asked: usize| asked.min(processors));
    // The pool is made once or never: so threads are tried first, all at the same time.
    let wait = Mutex::new(());
    let made = std::thread::scope(|scope| {
        let _wait = wait.lock();
        let one = || std::thread::Builder::new().spawn_scoped(scope, || drop(wait.lock())).ok();
        (0..count).map_while(|_| one()).count()
    });
    let pool = rayon::ThreadPoolBuilder::new().num_threads(made.max(1));
    // Where there is a pool already, it stays.
    let _ = if made == 0 { pool.use_current_thread() } else { pool }.build_global();
}

/// Makes the same error with each value of the command line on one line, and with escapes for what a terminal would obey.
fn visible_values(mut usage: clap::Error) -> clap::Error {
    let given: Vec<_> = usage.context().map(|(kind, value)| (kind, value.clone())).collect();
    for (kind, value) in given {
        let value = match value {
            ContextValue::String(text) => ContextValue::String(text::visible(&text).into_owned()),
            ContextValue::Strings(list) => {
                ContextValue::Strings(list.iter().map(|text| text::visible(text).into_owned()).collect())
            }
            _ => continue,
        };
        usage.insert(kind, value);
    }
    usage
}

/// Runs the command with these arguments, the first of which is the name it was called by.
///
/// A reader that goes away early (`clatter impacts … | head`) is no error.
pub fn run<I, T>(args: I, streams: &mut Streams<'_>) -> Exit
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let done = match Cli::try_parse_from(args) {
        Ok(cli) => cli.run(streams),
        Err(help) if !help.use_stderr() => {
            let help = text::visible_lines(&help.render().to_string()).into_owned();
            write!(streams.out, "{help}").map_err(Failure::Answer).map(|()| Exit::Done)
        }
        Err(usage) => {
            streams.beside(&visible_values(usage).render().to_string());
            return Exit::BadInput;
        }
    };
    let exit = *done.as_ref().unwrap_or(&Exit::Done);
    match done.and_then(|_| streams.out.flush().map_err(Failure::Answer)) {
        Ok(()) => exit,
        Err(Failure::Answer(gone)) if gone.kind() == io::ErrorKind::BrokenPipe => exit,
        // These begin with their own "error: ", one each.
        Err(failure @ Failure::Product(_)) => {
            streams.beside(&format!("{failure}\n"));
            failure.exit()
        }
        Err(failure) => {
            streams.note("error", &failure);
            failure.exit()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two arguments of one name would take each other's values; clap itself looks for that in debug builds alone.
    #[test]
    fn every_argument_of_a_command_has_its_own_name() {
        let mut cli = Cli::command();
        cli.build();
        let mut count = 0;
        for command in cli.get_subcommands() {
            let mut ids: Vec<&str> = command.get_arguments().map(|argument| argument.get_id().as_str()).collect();
            count += ids.len();
            ids.sort_unstable();
            let twice: Vec<_> = ids.windows(2).filter(|pair| pair[0] == pair[1]).collect();
            assert!(twice.is_empty(), "{}: {twice:?}", command.get_name());
        }
        assert!(count > 100, "{count}");
    }
}
