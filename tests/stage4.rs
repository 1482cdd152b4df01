//! Stage 4 of your ray tracer. What it grades is in tests/checks/stage4/src; where to write, in
//! exercises/src/stage4*.rs.

stage4_checks::tests!(exercises::Kit);
