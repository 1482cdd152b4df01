//! The program that answers questions about the code in this folder. `raykata` and the grader start
//! it.

fn main() {
    raykata::worker::serve(exercises::Kit);
}
