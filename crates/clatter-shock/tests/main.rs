//! Tests of the component and its spectra, in one program.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod conditions;
mod extremes;
mod filter;
mod fragility;
mod history_boundary;
mod integrator;
mod long_pulses;
mod omitted;
mod peak_above;
mod response;
mod sections;
mod spectrum;
mod stop;
mod stop_steps;
mod uneven;
