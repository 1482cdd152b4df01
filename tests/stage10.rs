//! Stage 10 of your ray tracer. What it grades is in tests/checks/src/stage10/; where to write, in
//! exercises/src/stage10*.rs.

checks::stage10!(exercises::Kit);
