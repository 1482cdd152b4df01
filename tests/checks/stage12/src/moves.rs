//! `reinsert`: the number of moves, by all trees that so many moves can make.

use super::reinsertions::{Case, ask, judge_leaves, moves_something};
use super::trees::{boxes, drawn_tree};
use checks::Trial;
use checks::broken::CheckResult;
use checks::judge::compare;
use checks::tree::{around, half_area};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::wide::FlatTree;
use std::collections::{BTreeMap, BTreeSet};

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

    /// The box of the tree over these leaves, and the areas of all inner nodes together.
    fn areas(&self, leaves: &BTreeMap<u32, Aabb>) -> (Aabb, f64) {
        match self {
            Form::Leaf(first) => (leaves[first], 0.0),
            Form::Inner(pair) => {
                let [(left, of_left), (right, of_right)] =
                    [&pair.0, &pair.1].map(|child| child.areas(leaves));
                let bounds = around([&left, &right]);
                (bounds, of_left + of_right + half_area(&bounds))
            }
        }
    }

    /// The trees that one move makes of this one, and the tree itself.
    fn one_move_away(&self) -> BTreeSet<Form> {
        let moved = self.parts().into_iter().flat_map(|(part, rest)| rest.with(&part));
        moved.chain([self.clone()]).collect()
    }
}

/// The part of the areas that a move must save so that it has to be made. Rounding errors are much smaller.
const CLEARLY: f64 = 0.01;

/// Judges that something is moved if one move makes the areas of all inner nodes together clearly smaller.
fn judge_that_it_moves(case: &Case, yours: &FlatTree) -> CheckResult {
    let tree = &case.query.tree;
    let leaves = tree.nodes.iter().filter(|node| node.is_leaf());
    let leaves = leaves.map(|leaf| (tree.order[leaf.first as usize], leaf.bounds())).collect();
    let given = Form::of(tree, 0);
    let areas = |form: &Form| form.areas(&leaves).1;
    let before = areas(&given);
    let least = given.one_move_away().iter().map(areas).fold(f64::INFINITY, f64::min);
    let (mine, pays) = (Form::of(yours, 0), least < (1.0 - CLEARLY) * before);
    if !pays || areas(&mine) < before {
        return Ok(());
    }
    let broken = case.broken(
        format!("areas of {:.4} together", areas(&mine)),
        format!("less than {before:.4}: one move makes {least:.4} of it"),
        "all trees that are one move away",
    );
    Err(broken.explained_by([(mine == given, "no subtree is moved")]))
}

pub(super) fn reinsert_makes_at_most_so_many_moves(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    let small = (boxes(6), prop::collection::vec(any::<u16>(), 1..12), 0..=2u32)
        .prop_map(|(boxes, cuts, moves)| Case::new(boxes.clone(), drawn_tree(&boxes, 1, &cuts), moves));
    trial.forall(150, small, |cases| judge_moves(trial, cases))?;
    // Boxes of one size at places of their own: often only few moves pay, and each of them changes areas at several levels.
    let box_at = (checks::generate::point(6), 1..=4u8)
        .prop_map(|(low, size)| Aabb::new(low, low + f32::from(size) / 4.0));
    let larger = (prop::collection::vec(box_at, 5..=7), prop::collection::vec(any::<u16>(), 1..12))
        .prop_map(|(boxes, cuts)| Case::new(boxes.clone(), drawn_tree(&boxes, 1, &cuts), 1));
    trial.forall(400, larger, |cases| judge_moves(trial, cases))
}

/// Judges that the trees can be made by so many moves, and that a move is made where one pays.
fn judge_moves(trial: &Trial<'_>, cases: &[Case]) -> Vec<CheckResult> {
    // The tree of a student that counts nothing is the same with any number of moves.
    let unlimited: Vec<Case> =
        cases.iter().map(|case| Case::new(case.boxes.clone(), case.query.tree.clone(), u32::MAX)).collect();
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
            return if case.query.most_moves > 0 { judge_that_it_moves(case, &yours) } else { Ok(()) };
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
}
