//! Stage 1 of the reference, against the same checks as the student's.

checks::stage1!(solutions::Kit);
