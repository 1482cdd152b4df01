//! Stage 9 of your ray tracer. What it grades is in tests/checks/src/stage9/; where to write, in
//! exercises/src/stage9*.rs.

checks::stage9!(exercises::Kit);
