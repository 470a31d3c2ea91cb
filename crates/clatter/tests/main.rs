//! Tests of the bar and the plate without gravity, in one program.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod cases;
mod laws;
mod off_center;
mod off_center_count;
mod oracle;
mod plate;
mod plate_oracle;
mod traps;
