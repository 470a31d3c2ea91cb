//! Tests that need what is inside.
