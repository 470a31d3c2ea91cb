//! Snapshots of numbers, figures and pages.
