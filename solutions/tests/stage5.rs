//! Stage 5 of the reference, against the same checks as the student's.

checks::stage5!(solutions::Kit);
