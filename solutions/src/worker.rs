//! Nothing to do here: the program that answers questions about the code in this folder. `raykata check` starts it.

fn main() {
    // <solution>
    raykata::worker::serve(&solutions::Kit);
    // <stub> raykata::worker::serve(&exercises::Kit);
    // </solution>
}
