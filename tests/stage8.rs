//! Stage 8 of your ray tracer. What it grades is in tests/checks/src/stage8/; where to write, in
//! exercises/src/stage8*.rs.

checks::stage8!(exercises::Kit);
