//! Stage 10 of your ray tracer. What it grades is in tests/checks/stage10/src; where to write, in
//! exercises/src/stage10*.rs.

stage10_checks::tests!(exercises::Kit);
