//! Stage 10 of the reference, against the same checks as the student's.

checks::stage10!(solutions::Kit);
