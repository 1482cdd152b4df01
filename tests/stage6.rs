//! Stage 6 of your ray tracer. What it grades is in tests/checks/src/stage6/; where to write, in exercises/src/stage6*.rs.

checks::stage6!(exercises::Kit);
