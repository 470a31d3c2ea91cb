//! This module is `clatter completions`: it writes the script that a shell needs to complete the command.

use clap_complete::Shell;

use crate::{Failure, Streams};

/// Write a script that teaches a shell to complete this command
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:\n  clatter completions bash > ~/.local/share/bash-completion/completions/clatter")]
pub(crate) struct Args {
    /// The shell
    shell: Shell,
}

impl Args {
    pub(crate) fn run(&self, command: &mut clap::Command, streams: &mut Streams<'_>) -> Result<(), Failure> {
        // The script goes into memory first: the generator panics where it cannot write.
        let mut script = Vec::new();
        clap_complete::generate(self.shell, command, "clatter", &mut script);
        streams.out.write_all(&script).map_err(Failure::Answer)
    }
}
