//! Reads `[[nodes]]`: the scene graph with its shapes and transforms.

use super::names::Names;
use super::reader::{Table, Value};
use super::shapes::{self, KINDS};
use super::{graph, transform};
use crate::files::error::LoadError;
use crate::files::words::quoted;
use crate::scene::{Node, SceneMesh};
use glam::Affine3A;
use std::collections::BTreeSet;

const KEYS: [&str; 7] = ["name", "material", "shape", "children", "transform", "transform_end", "repeat"];

/// The most places that a repeated node has.
const MOST_PLACES: u32 = 65_536;

/// All nodes of `[[nodes]]` in the order of the file, and the indices of those without a parent. Fails if a
/// name is unknown or given twice, if a shape or transform is degenerate, or if the graph is refused by
/// `graph::check`. Concave polygons are added to `all_meshes`.
pub(super) fn nodes(
    value: Option<Value>,
    materials: &Names,
    meshes: &Names,
    all_meshes: &mut Vec<SceneMesh>,
) -> Result<(Vec<Node>, Vec<usize>), LoadError> {
    let Some(value) = value else { return Ok((Vec::new(), Vec::new())) };
    let items = value.list("a list of tables, each under `[[nodes]]`")?;
    let tables: Vec<Table> = items.into_iter().map(table).collect::<Result<_, _>>()?;
    let names = names(&tables)?;

    let mut nodes = Vec::new();
    let mut children_values = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        let (transform, transform_end) = transform::of_node(table)?;
        let listed = table.get("children").map_or(Ok(Vec::new()), |list| list.list("a list of names"))?;
        nodes.push(Node {
            name: match table.get("name") {
                Some(name) => name.text()?.into(),
                None => format!("node {}", index + 1),
            },
            transform,
            transform_end,
            shape: table.get("shape").map(|shape| shapes::shape(shape, meshes, all_meshes)).transpose()?,
            material: table.get("material").map(|name| materials.find(name)).transpose()?,
            children: children(&listed, &names)?,
        });
        children_values.push(listed);
    }
    for (index, table) in tables.iter().enumerate() {
        if let Some(value) = table.get("repeat") {
            let n_places = repeat(value, index, &mut nodes)?;
            let own = std::mem::replace(&mut children_values[index], vec![value; n_places]);
            children_values.extend(vec![vec![value]; n_places]);
            children_values.push(own);
        }
    }
    graph::check(&nodes, &children_values)?;
    let roots = graph::roots(&nodes);
    Ok((nodes, roots))
}

/// Repeats the node with this index: it becomes a group of places, each with one more step of the transform than the one before,
/// of a new node at the end of the list that has what the node had. Returns the number of places.
fn repeat(value: Value, index: usize, nodes: &mut Vec<Node>) -> Result<usize, LoadError> {
    let table = value.table(&["count", "step"])?;
    let count = table.need("count", "10")?.whole(1..=MOST_PLACES)?;
    let step = table.need("step", "[{ translate = [1, 0, 0] }]")?;
    let places = transform::powers(step, count)?;
    let group = Node { name: nodes[index].name.clone(), transform: Affine3A::IDENTITY, ..Node::default() };
    let repeated = std::mem::replace(&mut nodes[index], group);
    let (first, last) = (nodes.len(), nodes.len() + places.len());
    nodes[index].children = (first..last).collect();
    for (place, transform) in (1..).zip(&places) {
        let name = format!("place {place} of {}", repeated.name);
        nodes.push(Node { name, transform: *transform, children: vec![last], ..Node::default() });
    }
    nodes.push(repeated);
    Ok(places.len())
}

/// The table of one node. A shape outside of `shape` is a common mistake, so it gets advice of its own.
fn table(value: Value<'_>) -> Result<Table<'_>, LoadError> {
    let table = value.any_table()?;
    match KINDS.iter().find(|kind| table.get(kind).is_some()) {
        Some(kind) => Err(value
            .source
            .error(table.key_span(kind), format!("`{kind}` must stand inside `shape`"))
            .help(format!("write `shape = {{ {kind} = … }}`"))),
        None => table.with_keys(&KEYS),
    }
}

fn names<'a>(tables: &[Table<'a>]) -> Result<Names<'a>, LoadError> {
    let mut names = Names::new("node");
    for (index, table) in tables.iter().enumerate() {
        let Some(value) = table.get("name") else { continue };
        let name = value.text()?;
        if !names.insert(name, index) {
            return Err(value
                .error(format!("two nodes are called {}", quoted(name)))
                .help("give one of them another name"));
        }
    }
    Ok(names)
}

fn children(listed: &[Value], names: &Names) -> Result<Vec<usize>, LoadError> {
    let (mut children, mut seen) = (Vec::new(), BTreeSet::new());
    for value in listed {
        let child = names.find(*value)?;
        if !seen.insert(child) {
            return Err(value.error(format!("{} is listed twice", value.spelled())).help(
                "both would have the same place; for another place, add a parent node with a `transform` \
                 around it",
            ));
        }
        children.push(child);
    }
    Ok(children)
}
