//! Stage 5 of your ray tracer. What it grades is in tests/checks/stage5/src; where to write, in
//! exercises/src/stage5*.rs.

stage5_checks::tests!(exercises::Kit);
