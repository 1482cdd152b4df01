//! The scaffold of Raykata, a teaching kit for ray tracing: everything around the exercises, and no answer to
//! any of them.
//!
//! # Where to look
//!
//! | module | what it holds |
//! |---|---|
//! | [`ray`], [`aabb`], [`shape`], [`mesh`] | geometry as data: rays with an open range of `t`, boxes, shapes, indexed meshes |
//! | [`bvh`], [`graph`], [`partition`] | acceleration structures as data, and what a search may ask ([`bvh::Probe`], [`partition::Cells`]) |
//! | [`material`], [`emitter`], [`light_path`], [`camera`], [`film`] | what surfaces and lights are made of, the steps of a path, where rays start, where colours end |
//! | [`scene`], [`world`] | scene files (TOML, PLY, OBJ), and the scene flattened into primitives |
//! | [`effects`], [`count`], [`random`] | what a scene needs, what it cost, and random numbers that are looked up by address |
//! | [`rounding`] | bounds on rounding errors |
//! | [`kit`] | the list of student functions, the door through which they are called, and the messages to a worker |
//! | [`tracer`], [`frame`], [`rows`], [`building`] | the renderer, its tiles, threads and pieces, and the progress of a build |
//! | [`rubric`], [`course`], [`worker`] | points, titles and hints of the checks, and what a course changes in them; the process that answers for a kit |
//!
//! # Conventions
//!
//! Lengths are in world units, angles in radians unless a name says degrees, times in `0..=1` of the interval
//! in which nodes move. Colours are red, green and blue in linear light unless a name says encoded. A ray's
//! `t` counts lengths of its direction, which need not be of unit length. A range of `t` is open at both
//! ends; a box is closed. Coordinates are right-handed, and the anticlockwise side of a triangle is its
//! front.

pub mod aabb;
pub mod building;
pub mod bvh;
pub mod camera;
pub mod count;
pub mod course;
pub mod effects;
pub mod emitter;
pub mod film;
pub mod frame;
pub mod graph;
pub mod kit;
pub mod light_path;
pub mod material;
pub mod mesh;
pub mod partition;
pub mod random;
pub mod ray;
pub mod rounding;
pub mod rows;
pub mod rubric;
pub mod scene;
pub mod shape;
pub mod tracer;
pub mod wide;
pub mod worker;
pub mod world;
