//! The same program as `worker.rs`, which also renders pictures.

fn main() {
    raykata::worker::serve(exercises::Kit);
}
