//! Stage 4 of the reference, against the same checks as the student's.

checks::stage4!(solutions::Kit);
