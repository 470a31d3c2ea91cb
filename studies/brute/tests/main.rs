//! Tests of the brute force, in one program.

#![cfg(test)]

mod hunt;
mod laws;
mod oracle;
mod solid;
