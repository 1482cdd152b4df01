//! Stage 1 of your ray tracer. What it grades is in tests/checks/stage1/src; where to write, in
//! exercises/src/stage1*.rs.

stage1_checks::tests!(exercises::Kit);
