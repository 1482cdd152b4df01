//! `reinsert`: the number of moves, by all trees that so many moves can make.

use super::reinsertions::{Case, ask, judge_leaves, moves_something};
use super::trees::{boxes, drawn_tree};
use checks::Trial;
use checks::broken::CheckResult;
use checks::judge::compare;
use proptest::prelude::*;
use raykata::wide::FlatTree;
use std::collections::BTreeSet;

/// The shape of a tree whose leaves are known by their first primitives. The order of the children does not matter.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Form {
    Leaf(u32),
    Inner(Box<(Form, Form)>),
}

impl Form {
    fn of(tree: &FlatTree, node: u32) -> Form {
        let at = &tree.nodes[node as usize];
        if at.is_leaf() {
            return Form::Leaf(tree.order[at.first as usize]);
        }
        Form::joined(Form::of(tree, at.first), Form::of(tree, at.first + 1))
    }

    fn joined(one: Form, other: Form) -> Form {
        Form::Inner(Box::new(if one <= other { (one, other) } else { (other, one) }))
    }

    /// Each subtree with the rest of the tree, except for the whole tree.
    fn parts(&self) -> Vec<(Form, Form)> {
        let Form::Inner(pair) = self else { return Vec::new() };
        let (left, right) = &**pair;
        let mut parts = vec![(left.clone(), right.clone()), (right.clone(), left.clone())];
        parts.extend(left.parts().into_iter().map(|(part, rest)| (part, Form::joined(rest, right.clone()))));
        parts.extend(right.parts().into_iter().map(|(part, rest)| (part, Form::joined(left.clone(), rest))));
        parts
    }

    /// The trees in which `part` is beside some node of this one.
    fn with(&self, part: &Form) -> Vec<Form> {
        let mut all = vec![Form::joined(self.clone(), part.clone())];
        if let Form::Inner(pair) = self {
            let (left, right) = &**pair;
            all.extend(left.with(part).into_iter().map(|left| Form::joined(left, right.clone())));
            all.extend(right.with(part).into_iter().map(|right| Form::joined(left.clone(), right)));
        }
        all
    }

    /// The trees that one move makes of this one, and the tree itself.
    fn one_move_away(&self) -> BTreeSet<Form> {
        let moved = self.parts().into_iter().flat_map(|(part, rest)| rest.with(&part));
        moved.chain([self.clone()]).collect()
    }
}

pub(super) fn reinsert_makes_at_most_so_many_moves(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    let small = (boxes(6), prop::collection::vec(any::<u16>(), 1..12), 0..=2u32)
        .prop_map(|(boxes, cuts, moves)| Case::new(boxes.clone(), drawn_tree(&boxes, 1, &cuts), moves));
    trial.forall(150, small, |cases| {
        // The tree of a student that counts nothing is the same with any number of moves.
        let unlimited: Vec<Case> = cases
            .iter()
            .map(|case| Case::new(case.boxes.clone(), case.query.tree.clone(), u32::MAX))
            .collect();
        let unlimited = ask(trial, &unlimited);
        let judge = |(case, unlimited): &(&Case, FlatTree), yours: FlatTree| {
            judge_leaves(case, &yours)?;
            if case.boxes.is_empty() {
                return Ok(());
            }
            let mut reached = BTreeSet::from([Form::of(&case.query.tree, 0)]);
            for _ in 0..case.query.most_moves {
                reached = reached.iter().flat_map(Form::one_move_away).collect();
            }
            if reached.contains(&Form::of(&yours, 0)) {
                return Ok(());
            }
            let moves = case.query.most_moves;
            let broken = case.broken(
                "a tree that is further away".into(),
                format!("a tree that {moves} moves can make of the given one"),
                "all trees that are so many moves away",
            );
            let is_unlimited = Form::of(&yours, 0) == Form::of(unlimited, 0);
            Err(broken.explained_by([(
                is_unlimited,
                "`most_moves` is ignored: the tree is that of any number of moves",
            )]))
        };
        let cases_and_trees: Vec<(&Case, FlatTree)> = cases.iter().zip(unlimited).collect();
        compare(&cases_and_trees, ask(trial, cases), judge)
    })
}
