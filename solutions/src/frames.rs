//! The same program as `worker.rs`, which also renders pictures.

fn main() {
    // <solution>
    raykata::worker::serve(solutions::Kit);
    // <stub> raykata::worker::serve(exercises::Kit);
    // </solution>
}
