//! Tests of bodies that fall in time, in one program.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod block;
mod contact_ahead;
mod contact_balance;
mod contact_extremes;
mod contact_laws;
mod contact_oracle;
mod contact_plate;
mod contact_reference;
mod contact_tumble;
mod corners;
mod cost;
mod ends;
mod energy;
mod extremes;
mod feet;
mod friction;
mod independent;
mod own_contacts;
mod plain;
mod plate_impacts;
mod reference;
mod rest;
mod slapdown;
mod train;
