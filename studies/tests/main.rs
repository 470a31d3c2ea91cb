//! Tests of the studies, in one program.

#![cfg(test)]

mod orders;
