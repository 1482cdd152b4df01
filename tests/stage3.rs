//! Stage 3 of your ray tracer. What it grades is in tests/checks/src/stage3/; where to write, in exercises/src/stage3*.rs.

checks::stage3!(exercises::Kit);
