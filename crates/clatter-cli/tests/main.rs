//! Tests of the command as a process of its own, in one program.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod brute;
mod channels;
mod command;
mod doors;
mod files;
mod repeat;
mod time_limit;
mod width;
