//! Tests of files of measured shocks, in one program.

#![cfg(test)]

mod between;
mod channels;
mod container;
mod field;
mod notations;
mod text;
mod times;
mod torn_container;
