//! Helper functions with which every stage judges answers.

use crate::broken::{Broken, CheckResult, Mistake, all_hold};

/// Wrong formulas, each with whether it gives a right answer. Those that do not are refuted by it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Refuted(Vec<(bool, &'static str)>);

/// The judgement of one answer, with the formulas that it refutes.
pub type Judged = Result<Refuted, Broken>;

impl From<()> for Refuted {
    fn from((): ()) -> Self {
        Refuted::default()
    }
}

/// Judges each answer with its query. A formula that gives another answer than a right one of the student is not the student's.
pub fn compare<Q, A, R: Into<Refuted>>(
    queries: &[Q],
    answers: Vec<A>,
    judge: impl Fn(&Q, A) -> Result<R, Broken>,
) -> Vec<CheckResult> {
    proven(queries.iter().zip(answers).map(|(query, answer)| judge(query, answer)))
}

/// The outcomes of a batch without the formulas that its right answers refute.
pub fn proven<R: Into<Refuted>>(outcomes: impl Iterator<Item = Result<R, Broken>>) -> Vec<CheckResult> {
    let outcomes: Vec<Judged> = outcomes.map(|outcome| outcome.map(Into::into)).collect();
    let mut refuted: Vec<Mistake> = Vec::new();
    // Only a wrong answer needs to know what right ones refute.
    if outcomes.iter().any(Result::is_err) {
        for mistake in
            outcomes.iter().flatten().flat_map(|Refuted(listed)| Mistake::those(false, listed, true))
        {
            if !refuted.contains(&mistake) {
                refuted.push(mistake);
            }
        }
    }
    let named = |outcome: Judged| outcome.map(|_| ()).map_err(|broken| broken.without(&refuted));
    outcomes.into_iter().map(named).collect()
}

/// Whether an answer is right, and the error if it is not.
pub struct Unless<B>(bool, B);

/// Judges one answer: an error unless it is right.
pub fn unless<B: FnOnce() -> Broken>(is_right: bool, broken: B) -> Unless<B> {
    Unless(is_right, broken)
}

impl<B: FnOnce() -> Broken> Unless<B> {
    /// Adds wrong formulas in the same order for each query: whether the formula gives this answer, and its text. [`compare`] and
    /// [`proven`] name a formula only if it also gives the right answers of the batch.
    pub fn formulas(self, formulas: impl IntoIterator<Item = (bool, &'static str)>) -> Judged {
        let (Unless(is_right, broken), formulas) = (self, formulas.into_iter().collect());
        if is_right { Ok(Refuted(formulas)) } else { Err(broken().computed_by(formulas)) }
    }
}

/// Judges an answer that has several parts.
pub fn all_parts(parts: impl Iterator<Item = Judged>) -> Judged {
    let parts: Vec<Judged> = parts.collect();
    let refuted = parts.iter().flatten().flat_map(|part| part.0.clone()).collect();
    all_hold(proven(parts.into_iter())).map(|()| Refuted(refuted))
}

/// The same as [`compare`] with formulas that are computed only if an answer is wrong.
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
    let given = queries.iter().zip(&answers).map(|(query, answer)| formulas(query, answer));
    proven(outcomes.into_iter().zip(given).map(|(outcome, given)| match outcome {
        Ok(()) => Ok(Refuted(given)),
        Err(broken) => Err(broken.computed_by(given)),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_answer_refutes_each_formula_that_gives_another_one() {
        let judge = |query: &i32, yours| {
            unless(yours == *query, Broken::default).formulas([(yours == 0, "a"), (yours != 1, "b")])
        };
        let diagnosis = |queries: &[i32]| all_hold(compare(queries, vec![0; queries.len()], judge));
        assert_eq!(diagnosis(&[0, 1]).unwrap_err().diagnosis.as_deref(), Some("a\nor: b"));
        let outcomes = compare(&[0, 1, 2], vec![0, 0, 2], judge);
        assert_eq!(all_hold(outcomes).unwrap_err().diagnosis.as_deref(), Some("b"));
    }
}
