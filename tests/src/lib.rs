//! Acceptance tests over the whole chain.
