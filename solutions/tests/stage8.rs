//! Stage 8 of the reference, against the same checks as the student's.

checks::stage8!(solutions::Kit);
