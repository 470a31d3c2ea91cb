//! Snapshots of numbers, figures and pages; the tests are in `tests/`, what they expect in `snapshots/`.
//!
//! Numbers carry the digits that are guaranteed on any platform. A snapshot never replaces an assertion that knows
//! the law. To accept a change: `cargo insta review`, and a line in the changelog with the reason.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]
