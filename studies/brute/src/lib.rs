//! A brute force over the drops of a product: it finds the worst of each limit by following thousands of drops, without
//! a formula or a line of code of `clatter`, and compares with the results of `clatter assess`.
//!
//! ```sh
//! cargo run --release -p clatter-brute -- hunt PRODUCT.toml --drops=4000
//! cargo run --release -p clatter-brute -- random low-e 7
//! cargo run --release -p clatter-brute -- compare --kind=contacts --seeds=1..40 --clatter=target/release/clatter
//! ```
//!
//! `hunt` prints the worst value of each limit with its drop, `random` a product file as a designer would write one,
//! `compare` the results of `clatter assess` for such files and those of the search. Each drop is integrated in small
//! steps
//! ([`flight`]): equations of motion at any angle, a law of force at each end, bisection where a phase ends. Parts and
//! shocks are taken from the stored history ([`part`]). Plates and boxes of all directions and attitudes are followed as boxes in
//! space ([`solid`]), `--kind=plate`, `--kind=box` and the same with own contacts ([`spatial`]).

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]
// Numbers are counted, and counts are small.
#![allow(clippy::format_push_string, reason = "lines to read, not many")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "small counts"
)]

pub mod compare;
pub mod flight;
mod ground;
pub mod hunt;
pub mod part;
pub mod product;
pub mod random;
pub mod solid;
pub mod spatial;
