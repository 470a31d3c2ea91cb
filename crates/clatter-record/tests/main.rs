//! Tests of files of measured shocks, in one program.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod baseline;
mod between;
mod butterworth;
mod channels;
mod container;
mod field;
mod integrate;
mod members;
mod notations;
mod text;
mod times;
mod torn_container;
