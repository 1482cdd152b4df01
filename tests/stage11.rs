//! Stage 11 of your ray tracer. What it grades is in tests/checks/stage11/src; where to write, in
//! exercises/src/stage11*.rs.

stage11_checks::tests!(exercises::Kit);
