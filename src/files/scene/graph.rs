//! Checks of the scene graph as a whole: it has no loops, and its depth and number of shapes are limited.

use super::reader::Value;
use crate::files::error::LoadError;
use crate::files::words::one_line;
use crate::scene::Node;

/// The largest number of levels. Programs that traverse the graph by recursion call themselves once per
/// level.
const MAX_LEVELS: u32 = 64;
/// The largest number of shapes, counted once per path that leads to them, because a graph with few nodes can
/// have very many paths.
const MAX_SHAPES: u64 = 1 << 24;

/// The indices of the nodes that no other node lists as a child, in ascending order.
pub(super) fn roots(nodes: &[Node]) -> Vec<usize> {
    let mut is_root = vec![true; nodes.len()];
    nodes.iter().flat_map(|node| &node.children).for_each(|&child| is_root[child] = false);
    (0..nodes.len()).filter(|&index| is_root[index]).collect()
}

/// The state of a node while the graph is traversed.
#[derive(Clone, Copy)]
enum Visit {
    /// Not seen yet.
    No,
    /// Its children are being visited.
    Under,
    /// Done, with the number of its levels and shapes, itself included.
    Done { levels: u32, shapes: u64 },
}

/// Fails if the graph has a loop, more than 64 levels, or more than 2^24 shapes counted once per place.
/// `listed` are the children of each node as the file names them, for messages.
pub(super) fn check(nodes: &[Node], listed: &[Vec<Value>]) -> Result<(), LoadError> {
    let mut visits = vec![Visit::No; nodes.len()];
    for start in 0..nodes.len() {
        // The path from `start` down, each node with the number of its finished children. It is a list instead of a
        // recursion, because a loop or a long chain in a file must not overflow the stack.
        let mut way: Vec<(usize, usize)> = Vec::new();
        if matches!(visits[start], Visit::No) {
            visits[start] = Visit::Under;
            way.push((start, 0));
        }
        while let Some((node, done)) = way.last_mut() {
            let Some(&child) = nodes[*node].children.get(*done) else {
                visits[*node] = finished(&nodes[*node], &listed[*node], &visits)?;
                way.pop();
                continue;
            };
            let value = &listed[*node][*done];
            *done += 1;
            match visits[child] {
                Visit::Done { .. } => {}
                Visit::Under => return Err(value.error(loop_message(nodes, &way, child))),
                Visit::No => {
                    visits[child] = Visit::Under;
                    way.push((child, 0));
                }
            }
        }
    }
    Ok(())
}

/// The levels and shapes of a node whose children are all done.
fn finished(node: &Node, listed: &[Value], visits: &[Visit]) -> Result<Visit, LoadError> {
    let (mut levels, mut shapes) = (1, u64::from(node.shape.is_some()));
    for (&child, value) in node.children.iter().zip(listed) {
        if let Visit::Done { levels: below, shapes: more } = visits[child] {
            levels = levels.max(below + 1);
            shapes += more;
        }
        if levels > MAX_LEVELS {
            return Err(value.error(format!("nodes are nested more than {MAX_LEVELS} deep")));
        }
        if shapes > MAX_SHAPES {
            return Err(value.error(format!("repeated nodes add up to more than {MAX_SHAPES} shapes")));
        }
    }
    Ok(Visit::Done { levels, shapes })
}

/// The message for the loop that is closed when the last node of `way` lists `child`.
fn loop_message(nodes: &[Node], way: &[(usize, usize)], child: usize) -> String {
    const LONGEST: usize = 8; // names; a longer loop is shown by its ends
    let looped: Vec<usize> = way.iter().map(|(node, _)| *node).skip_while(|&node| node != child).collect();
    let name = |&node: &usize| one_line(&nodes[node].name);
    let mut names: Vec<String> = looped.iter().take(LONGEST).map(name).collect();
    if looped.len() > LONGEST {
        names.push("…".into());
        names.extend(looped.last().map(name));
    }
    names.push(name(&child));
    format!("the nodes form a loop: {}", names.join(" -> "))
}
