//! The program that answers questions about the code in this folder. `raykata` and the grader start it.

fn main() {
    // <solution>
    raykata::worker::serve(solutions::Kit);
    // <stub> raykata::worker::serve(exercises::Kit);
    // </solution>
}
