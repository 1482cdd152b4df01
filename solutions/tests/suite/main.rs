//! The tests of the reference in one program, so that it is linked once and slow tests run in parallel.

mod adversarial;
mod bounds;
mod calibration;
mod coarse_structures;
mod digits;
mod distribution;
mod edges;
mod frames;
mod heckbert;
mod indirect;
mod instances;
mod leaks;
mod light;
mod methods;
mod partitions;
mod precision;
mod scales;
mod scene;
mod seeds;
mod slabs;
mod specials;
mod stages;
mod subsets;
mod textbook;
mod texture_filter;
mod watertight;
