//! Tests of the bar and the plate without gravity, in one program.

#![cfg(test)]

mod cases;
mod laws;
mod off_center;
mod off_center_count;
mod oracle;
mod plate;
mod plate_oracle;
mod traps;
