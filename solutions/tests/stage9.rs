//! Stage 9 of the reference, against the same checks as the student's.

checks::stage9!(solutions::Kit);
