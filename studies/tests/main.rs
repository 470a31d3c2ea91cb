//! Tests of the studies, in one program.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]
#![cfg(test)]

mod orders;
