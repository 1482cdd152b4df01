//! The program that answers questions about the code in this folder. `raykata` and the grader start
//! it.

fn main() {
    // <solution>
    let kit = solutions::kit();
    raykata::worker::serve_with(&|request, watch| request.answer(&*kit, watch));
    // <stub> raykata::worker::serve(exercises::Kit);
    // </solution>
}
