//! Helper functions with which every stage judges answers.

use crate::broken::CheckResult;

/// Judges each answer with its query.
pub fn compare<Q, A>(
    queries: &[Q],
    answers: Vec<A>,
    judge: impl Fn(&Q, A) -> CheckResult,
) -> Vec<CheckResult> {
    queries.iter().zip(answers).map(|(query, answer)| judge(query, answer)).collect()
}

/// Judges each answer with its query, and proves mistakes by all answers, right ones too. `formulas` lists wrong formulas in
/// the same order for each query: whether the formula gives this answer, and its text. A formula explains the failing answers
/// only if it also gives the right ones.
pub fn compare_formulas<Q, A: Clone>(
    queries: &[Q],
    answers: Vec<A>,
    judge: impl Fn(&Q, A) -> CheckResult,
    formulas: impl Fn(&Q, &A) -> Vec<(bool, &'static str)>,
) -> Vec<CheckResult> {
    let outcomes = compare(queries, answers.clone(), judge);
    if outcomes.iter().all(CheckResult::is_ok) {
        return outcomes;
    }
    let given: Vec<_> = queries.iter().zip(&answers).map(|(query, answer)| formulas(query, answer)).collect();
    // A formula that gives another answer than a right one of the student is not the student's.
    let is_refuted = |formula: usize| {
        let mut passed = outcomes.iter().zip(&given).filter(|(outcome, _)| outcome.is_ok());
        passed.any(|(_, given)| !given[formula].0)
    };
    let refuted: Vec<bool> = (0..given[0].len()).map(is_refuted).collect();
    let explain = |(outcome, given): (CheckResult, Vec<(bool, &'static str)>)| {
        outcome.map_err(|broken| {
            let proven = given.into_iter().zip(&refuted);
            broken.computed_by(proven.map(|((gives, text), refuted)| (gives && !refuted, text)).collect())
        })
    };
    outcomes.into_iter().zip(given).map(explain).collect()
}
