//! The tests of the slides in one program.

mod built;
mod deck;
mod decks;
mod overflow;
mod touch;
