//! Stage 2 of your ray tracer. What it grades is in tests/checks/stage2/src; where to write, in
//! exercises/src/stage2*.rs.

stage2_checks::tests!(exercises::Kit);
