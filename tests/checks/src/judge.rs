//! Helper functions with which every stage judges answers.

use crate::broken::CheckResult;

/// The diagnosis, or `None` if it is empty.
pub fn known(diagnosis: &str) -> Option<&str> {
    (!diagnosis.is_empty()).then_some(diagnosis)
}

/// Judges each answer with its query.
pub fn compare<Q, A>(
    queries: &[Q],
    answers: Vec<A>,
    judge: impl Fn(&Q, A) -> CheckResult,
) -> Vec<CheckResult> {
    queries.iter().zip(answers).map(|(query, answer)| judge(query, answer)).collect()
}
