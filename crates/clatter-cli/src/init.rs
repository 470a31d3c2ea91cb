//! This module is `clatter init`: it writes a product file to begin with.

use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::ValueHint;

use crate::input::is_standard;
use crate::{Failure, Streams, output, text};

/// Write a commented product file that assesses as it stands
///
/// It is that of a plate. Its comments tell what each quantity is, and what is known in public of restitution and contact times. A file
/// that is there already is never written over.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init                     product.toml
  clatter init handheld.toml && clatter assess handheld.toml")]
pub(crate) struct Args {
    /// The file to write; - is standard output
    #[arg(value_name = "FILE", default_value = "product.toml", value_hint = ValueHint::FilePath)]
    file: PathBuf,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if is_standard(&self.file) {
            return streams.out.write_all(clatter_product::EXAMPLE.as_bytes()).map_err(Failure::Answer);
        }
        output::create(&self.file, |file| file.write_all(clatter_product::EXAMPLE.as_bytes())).map_err(|failure| {
            match failure {
                Failure::File { path, reason } if reason.kind() == ErrorKind::AlreadyExists => Failure::Exists(path),
                other => other,
            }
        })?;
        let file = text::path(&self.file);
        writeln!(streams.out, "Wrote {file}; assess it with: clatter assess {file}").map_err(Failure::Answer)
    }
}
