//! This module is `clatter schema`: it writes the schema of a product file, for editors.

use crate::{Failure, Streams};

/// Print the JSON Schema of product files, for editors
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  clatter schema > product.schema.json

An editor with a TOML language server completes and checks keys with '#:schema ./product.schema.json' in the first line
of the product file.")]
pub(crate) struct Args {}

impl Args {
    #[expect(clippy::unused_self, reason = "all commands are run alike")]
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        serde_json::to_writer_pretty(&mut *streams.out, &clatter_product::schema())
            .map_err(|error| Failure::Answer(error.into()))?;
        writeln!(streams.out).map_err(Failure::Answer)
    }
}
