//! Tests of product files, their assessment, design, scatter and fit, in one program.

#![cfg(test)]

mod bad_files;
mod data;
mod design;
mod examples;
mod fit;
mod independent;
mod late;
mod limits;
mod mutations;
mod portrait;
mod random;
mod safe;
mod scatter;
mod worst_case;
