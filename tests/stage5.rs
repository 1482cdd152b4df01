//! Stage 5 of your ray tracer. What it grades is in tests/checks/src/stage5/; where to write, in exercises/src/stage5*.rs.

checks::stage5!(exercises::Kit);
