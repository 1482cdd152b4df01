//! Stage 7 of your ray tracer. What it grades is in tests/checks/src/stage7/; where to write, in exercises/src/stage7*.rs.

checks::stage7!(exercises::Kit);
