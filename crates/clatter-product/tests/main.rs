//! Tests of product files and plans of studies, in one program.

#![cfg(test)]

mod bad_files;
mod plan;
