//! The `clatter` command. Everything it does is in the library.

use std::io::{self, BufWriter, IsTerminal};
use std::process::ExitCode;

use clatter_cli::{Streams, own_process, run};

fn main() -> ExitCode {
    #[cfg(unix)]
    tidy_on_signals();
    own_process();
    // Standard error is not kept locked: other threads must be able to say why they end.
    let (mut out, mut err) = (BufWriter::new(io::stdout().lock()), io::stderr());
    let interactive = err.is_terminal();
    run(std::env::args_os(), &mut Streams { out: &mut out, err: &mut err, interactive }).into()
}

/// Ctrl-C and SIGTERM end the process as they always do, after temporary files are removed. Where no thread can be made for that,
/// they end it at once.
#[cfg(unix)]
fn tidy_on_signals() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let wait = || {
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
        if let Some(signal) = signals.forever().next() {
            clatter_report::remove_leftovers();
            let _ = emulate_default_handler(signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".into()).spawn(wait);
}
