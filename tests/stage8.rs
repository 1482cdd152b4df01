//! Stage 8 of your ray tracer. What it grades is in tests/checks/stage8/src; where to write, in
//! exercises/src/stage8*.rs.

stage8_checks::tests!(exercises::Kit);
