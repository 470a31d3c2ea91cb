//! Tests of product files, their assessment, design and scatter, in one program.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod anchored;
mod bodies;
mod box_commands;
mod boxes;
mod data;
mod design;
mod examples;
mod feet;
mod independent;
mod inputs;
mod late;
mod limits;
mod missed;
mod mutations;
mod own_contacts;
mod plate_commands;
mod plates;
mod portrait;
mod random;
mod safe;
mod scatter;
mod several;
mod shocks;
mod spin;
mod stops;
mod worst_case;
