//! Stage 3 of your ray tracer. What it grades is in tests/checks/stage3/src; where to write, in
//! exercises/src/stage3*.rs.

stage3_checks::tests!(exercises::Kit);
