//! Rejects malformed structures in answers before a law looks at them. The laws traverse trees with loops and recursion. A tree
//! whose root is its own child would make them loop without end or overflow the stack. A flat or wide tree of stage 12 has one
//! order of nodes, which its laws compare before they follow a child.

use raykata::bvh::Contents;
use raykata::count::Counts;
use raykata::kit::{Answer, SearchAnswer};
use raykata::partition::{Grid, Tree, TreeNode};

/// Deepest allowed tree, in levels. The checks recurse over trees and print them with one indent per level. The deepest
/// tree that a check needs has 24 levels. A builder that splits off one primitive per level makes up to 512.
const DEEPEST: usize = 2_000;

/// Describes the first malformed structure of an answer.
pub(crate) fn fault(answer: &Answer) -> Option<String> {
    match answer {
        Answer::Build(trees) => trees.iter().find_map(|tree| {
            let node = |index: usize| match tree.nodes[index].contents {
                Contents::Inner { left, right } => (vec![left, right], None),
                Contents::Leaf { first, count } => (Vec::new(), Some((first, count))),
            };
            fault_of_nodes(tree.nodes.len(), tree.order.len(), node)
        }),
        Answer::KdBuild(trees) => trees.iter().find_map(|tree| fault_of_tree(tree)),
        Answer::OctreeBuild(trees) => trees.iter().find_map(|tree| fault_of_tree(tree)),
        Answer::BspBuild(trees) => trees.iter().find_map(fault_of_tree),
        Answer::PolygonBspBuild(trees) => trees.iter().find_map(|tree| fault_of_tree(tree)),
        Answer::GridBuild(grids) => grids.iter().find_map(fault_of_grid),
        Answer::ClosestHit(searches) | Answer::ClosestHitBoth(searches) => {
            searches.iter().find_map(fault_of_search)
        }
        Answer::AnyHit(searches) => searches.iter().find_map(|(_, search)| fault_of_search(search)),
        _ => None,
    }
}

fn fault_of_tree<N: TreeNode>(tree: &Tree<N>) -> Option<String> {
    let node = |index: usize| (tree.nodes[index].children().collect(), tree.nodes[index].range());
    fault_of_nodes(tree.nodes.len(), tree.items.len(), node)
}

/// `node` returns the children of a node, and the first position and the length of the list that it has, if any.
fn fault_of_nodes(
    n_nodes: usize,
    n_items: usize,
    node: impl Fn(usize) -> (Vec<u32>, Option<(u32, u32)>),
) -> Option<String> {
    let mut reached = vec![false; n_nodes];
    let mut waiting = if n_nodes > 0 { vec![(0, 0, 1)] } else { Vec::new() };
    // Traverse the tree without recursion. Each node must be reached once, within the depth limit.
    while let Some((parent, index, depth)) = waiting.pop() {
        let child = || format!("a child of node {parent} is node {index}");
        match reached.get_mut(index) {
            None => return Some(format!("{}, but there are {n_nodes} nodes", child())),
            Some(true) if index == 0 => return Some(format!("{}, the root, which has no parent", child())),
            Some(true) => return Some(format!("{}, which is a child already: it has one parent", child())),
            Some(reached) => *reached = true,
        }
        if depth > DEEPEST {
            return Some(format!("the tree has more than {DEEPEST} levels"));
        }
        let (children, range) = node(index);
        if let Some((first, count)) = range {
            let end = first as usize + count as usize;
            if end > n_items {
                let kind = if children.is_empty() { "leaf" } else { "node" };
                return Some(format!("{kind} {index} ends at position {end} of a list of {n_items}"));
            }
        }
        waiting.extend(children.into_iter().map(|child| (index, child as usize, depth + 1)));
    }
    None
}

/// Checks the cost counters of a search. They are counted in the student's process, where code may reset them. A hit
/// without any visited node or tested primitive shows that.
fn fault_of_search(search: &SearchAnswer) -> Option<String> {
    let Counts { node_visits, primitive_tests, .. } = search.counts;
    let nothing = search.hit.is_some() && (node_visits == 0 || primitive_tests == 0);
    nothing.then(|| format!("a hit after {node_visits} nodes opened and {primitive_tests} primitives tested"))
}

fn fault_of_grid(grid: &Grid) -> Option<String> {
    let cells = grid.resolution.to_array().into_iter().map(u64::from).try_fold(1, u64::checked_mul);
    // A grid over no primitives may have no cells.
    let fits = grid.starts.is_empty()
        || cells.and_then(|cells| cells.checked_add(1)) == Some(grid.starts.len() as u64);
    if !fits {
        return Some(format!("the grid has {} list starts for {} cells", grid.starts.len(), grid.resolution));
    }
    let ordered = grid.starts.windows(2).all(|pair| pair[0] <= pair[1]);
    let within = grid.starts.last().is_none_or(|&end| end as usize <= grid.items.len());
    (!ordered || !within)
        .then(|| "the lists of the grid's cells are not in order or end beyond the items".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use raykata::aabb::Aabb;
    use raykata::bvh::{Bvh, Node as BvhNode};
    use raykata::partition::{KdNode, KdTree};

    fn tree(children: &[Option<(u32, u32)>]) -> Answer {
        let contents = |node: &Option<(u32, u32)>| match *node {
            Some((left, right)) => Contents::Inner { left, right },
            None => Contents::Leaf { first: 0, count: 1 },
        };
        let nodes =
            children.iter().map(|node| BvhNode { bounds: Aabb::EMPTY, contents: contents(node) }).collect();
        let mut bvh = Bvh::for_primitives(1);
        bvh.nodes = nodes;
        bvh.order = vec![0];
        Answer::Build(vec![bvh])
    }

    #[test]
    fn rings_and_strange_children_are_no_trees() {
        assert_eq!(fault(&tree(&[Some((1, 2)), None, None])), None);
        assert_eq!(fault(&tree(&[])), None);
        assert!(fault(&tree(&[Some((0, 0))])).unwrap().contains("of node 0 is node 0, the root"));
        assert!(
            fault(&tree(&[Some((1, 1)), None])).unwrap().contains("of node 0 is node 1, which is a child")
        );
        assert!(
            fault(&tree(&[Some((1, 9)), None])).unwrap().contains("of node 0 is node 9, but there are 2")
        );
        let mut tree = KdTree::new(Aabb::EMPTY);
        tree.nodes = vec![KdNode::Leaf { first: u32::MAX, count: u32::MAX }];
        assert!(fault(&Answer::KdBuild(vec![tree])).unwrap().contains("ends at"));
    }

    #[test]
    fn a_tree_that_is_a_long_way_down_is_refused_before_anybody_follows_it() {
        let n = 2 * DEEPEST as u32 + 1;
        let chain: Vec<Option<(u32, u32)>> =
            (0..n).map(|i| (i % 2 == 0 && i + 2 < n).then_some((i + 1, i + 2))).collect();
        assert!(fault(&tree(&chain)).unwrap().contains("levels"));
    }
}
