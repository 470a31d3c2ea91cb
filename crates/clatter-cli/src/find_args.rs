//! This module reads how the shocks of a record are found.

use clatter_product::units::{ACCELERATION, Dimension, TIME};
use clatter_shock::Search;

use crate::quantities::plain_or_typed;

/// Whether and how the shocks of a record are found.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct FindArgs {
    /// Find the shocks: each by its start, peak, duration between the 10 % points and velocity change
    #[arg(long)]
    find: bool,
    /// Acceleration that a shock exceeds [default: what noise exceeds in one record of a thousand, by the median of the record]
    #[arg(long, value_name = "ACCELERATION", requires = "find", value_parser = threshold)]
    threshold: Option<f64>,
    /// Time without passing it after which another shock begins, in s without a unit
    #[arg(long, value_name = "TIME", default_value = "5ms", value_parser = quiet)]
    quiet: f64,
}

impl FindArgs {
    /// Returns how to find the shocks, where they are requested.
    pub(crate) fn search(self) -> Option<Search> {
        self.find.then_some(Search { threshold_m_s2: self.threshold, quiet_s: self.quiet })
    }
}

fn threshold(text: &str) -> Result<f64, String> {
    positive(&ACCELERATION, text)
}

fn quiet(text: &str) -> Result<f64, String> {
    positive(&TIME, text)
}

fn positive(dimension: &'static Dimension, text: &str) -> Result<f64, String> {
    let value = plain_or_typed(dimension, text)?.si;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(format!("{value:?} is not finite and > 0")) }
}
