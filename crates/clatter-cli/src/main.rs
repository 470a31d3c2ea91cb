//! This program is the `clatter` command. Everything it does is in the library.

#[cfg(unix)]
use std::fs::File;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::process::ExitCode;

use clatter_cli::{Streams, own_process, run};

fn main() -> ExitCode {
    #[cfg(unix)]
    tidy_on_signals();
    own_process();
    // Standard error is not kept locked: other threads must be able to say why they end.
    let (mut out, mut err) = (BufWriter::new(stdout()), io::stderr());
    let interactive = err.is_terminal();
    run(std::env::args_os(), &mut Streams { out: &mut out, err: &mut err, interactive }).into()
}

/// Returns a standard output that reports where it is closed or not open for writing: that of the standard library accepts such writes as
/// if they succeeded. Where the system, or the library at the start of the process, puts the null device in the place of a closed one,
/// there is nothing to report.
#[cfg(unix)]
fn stdout() -> Box<dyn Write> {
    use std::os::fd::AsFd as _;
    match io::stdout().as_fd().try_clone_to_owned() {
        Ok(own) => Box::new(File::from(own)),
        Err(error) => Box::new(Gone(error.raw_os_error().unwrap_or_default())),
    }
}

#[cfg(not(unix))]
fn stdout() -> Box<dyn Write> {
    Box::new(io::stdout().lock())
}

/// Takes nothing, for the reason that the system gave.
#[cfg(unix)]
struct Gone(i32);

#[cfg(unix)]
impl Write for Gone {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::Error::from_raw_os_error(self.0))
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Removes temporary files on Ctrl-C and SIGTERM, which then end the process as they always do. Where no thread can be made for that,
/// they end it at once; where the process is set to ignore them, as in the background of a script, it goes on doing so.
#[cfg(unix)]
fn tidy_on_signals() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let wait = || {
        let heeded = [SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
        let Ok(mut signals) = Signals::new(heeded) else { return };
        if let Some(signal) = signals.forever().next() {
            clatter_report::remove_leftovers();
            let _ = emulate_default_handler(signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".into()).spawn(wait);
}

/// Returns whether the process was started with this signal ignored, as far as the system reports it.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
