//! Small things that every stage needs to judge answers.

use crate::broken::Outcome;

/// A diagnosis that is not empty.
pub fn known(diagnosis: &str) -> Option<&str> {
    (!diagnosis.is_empty()).then_some(diagnosis)
}

/// Judges each answer with its query.
pub fn compare<Q, A>(queries: &[Q], answers: Vec<A>, judge: impl Fn(&Q, A) -> Outcome) -> Vec<Outcome> {
    queries.iter().zip(answers).map(|(query, answer)| judge(query, answer)).collect()
}
