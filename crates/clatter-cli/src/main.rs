//! The `clatter` command. Everything it does is in the library.

use std::io::{self, BufWriter, IsTerminal};
use std::process::ExitCode;

use clatter_cli::{Streams, run};

fn main() -> ExitCode {
    // Standard error is not kept locked: other threads must be able to say why they end.
    let (mut out, mut err) = (BufWriter::new(io::stdout().lock()), io::stderr());
    let interactive = err.is_terminal();
    run(std::env::args_os(), &mut Streams { out: &mut out, err: &mut err, interactive }).into()
}
