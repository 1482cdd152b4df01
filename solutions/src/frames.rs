//! The same program as `worker.rs`, which also renders pictures.

fn main() {
    // <solution>
    let kit = solutions::kit();
    raykata::worker::serve_with(&|request, watch| request.answer(&*kit, watch));
    // <stub> raykata::worker::serve(exercises::Kit);
    // </solution>
}
