//! Stage 2 of your ray tracer. What it grades is in tests/checks/src/stage2/; where to write, in exercises/src/stage2*.rs.

checks::stage2!(exercises::Kit);
