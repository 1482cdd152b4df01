//! The tests of the reference in one program, so that it is linked once and slow tests run in parallel.

mod calibration;
mod distribution;
mod frames;
mod instances;
mod partitions;
mod precision;
mod scales;
mod scene;
mod seeds;
mod specials;
mod stages;
mod subsets;
mod textbook;
