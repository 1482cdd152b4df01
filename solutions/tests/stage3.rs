//! Stage 3 of the reference, against the same checks as the student's.

checks::stage3!(solutions::Kit);
