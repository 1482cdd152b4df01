//! Stage 4 of your ray tracer. What it grades is in tests/checks/src/stage4/; where to write, in exercises/src/stage4*.rs.

checks::stage4!(exercises::Kit);
