//! Stage 1 of your ray tracer. What it grades is in tests/checks/src/stage1/; where to write, in exercises/src/stage1*.rs.

checks::stage1!(exercises::Kit);
