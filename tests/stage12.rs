//! Stage 12 of your ray tracer. What it grades is in tests/checks/stage12/src; where to write, in
//! exercises/src/stage12*.rs.

stage12_checks::tests!(exercises::Kit);
