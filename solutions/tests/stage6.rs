//! Stage 6 of the reference, against the same checks as the student's.

checks::stage6!(solutions::Kit);
