//! Stage 9 of your ray tracer. What it grades is in tests/checks/stage9/src; where to write, in
//! exercises/src/stage9*.rs.

stage9_checks::tests!(exercises::Kit);
