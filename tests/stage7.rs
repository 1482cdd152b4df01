//! Stage 7 of your ray tracer. What it grades is in tests/checks/stage7/src; where to write, in
//! exercises/src/stage7*.rs.

stage7_checks::tests!(exercises::Kit);
