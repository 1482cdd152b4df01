//! Untouched.
