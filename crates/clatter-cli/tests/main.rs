//! Tests of the command as a process of its own, in one program.

#![cfg(test)]

mod channels;
mod command;
mod files;
mod repeat;
mod time_limit;
mod width;
