//! Stage 6 of your ray tracer. What it grades is in tests/checks/stage6/src; where to write, in
//! exercises/src/stage6*.rs.

stage6_checks::tests!(exercises::Kit);
