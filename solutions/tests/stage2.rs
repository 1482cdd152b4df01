//! Stage 2 of the reference, against the same checks as the student's.

checks::stage2!(solutions::Kit);
