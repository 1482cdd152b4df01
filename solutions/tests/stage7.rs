//! Stage 7 of the reference, against the same checks as the student's.

checks::stage7!(solutions::Kit);
