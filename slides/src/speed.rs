//! Diagrams of stage 12: bins and their cuts, leaves of whole blocks, a node with eight children, work and span.

use crate::pictures::{heat_panels, load, work};
use anyhow::{Context, Result};
use glam::{Vec3A, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{BinSplitQuery, BinsQuery, Kit};
use raykata::scene::Accelerator;
use raykata::wide::{
    BinGrid, Bins, ChildContents, FlatTree, ForkKind, MAX_BINS, NO_PRIMITIVE, PrimitiveBox, WIDE_NODE_COST,
};
use raykata_cli::report::Thousands;
use raykata_cli::svg::{Axis, Drawing, End, Ink, Middle, Plot, SMALL, Start, TEXT, offset};
use std::collections::HashSet;
use std::path::Path;

/// Numbers from 0 to 1 that look random and are the same in each run: multiples of the golden ratio, without their whole part.
fn scattered(i: u32) -> f32 {
    (f64::from(i) * 0.618_033_988_749_895).fract() as f32
}

/// Boxes in three clusters along x.
fn clusters() -> Vec<Aabb> {
    let places = (0..60u32).map(|i| match i % 3 {
        0 => 10.0 * scattered(i),
        1 => 36.0 + 8.0 * scattered(i),
        _ => 70.0 + 30.0 * scattered(i),
    });
    places.map(|x| Aabb::new(vec3(x, 0.0, 0.0), vec3(x + 1.0, 4.0, 4.0))).collect()
}

/// Three clusters of boxes in 32 bins: the boxes per bin, and the cost of each cut between two bins beside that of each cut
/// of the sorted boxes.
pub fn bins_and_cuts(kit: &dyn Kit) -> Result<String> {
    let boxes = clusters();
    let primitives: Vec<PrimitiveBox> =
        boxes.iter().zip(0..).map(|(bounds, id)| PrimitiveBox::new(id, bounds)).collect();
    let places: Vec<f32> = primitives.iter().map(|one| one.twice_centroid().x).collect();
    let low = places.iter().copied().fold(f32::INFINITY, f32::min);
    let high = places.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let scale = 0.999_99 * MAX_BINS as f32 / (high - low);
    let grid = BinGrid {
        low: Vec3A::new(low, 4.0, 4.0),
        scale: Vec3A::new(scale, 0.0, 0.0),
        n_bins: MAX_BINS as u32,
    };
    let bins = kit.fill_bins(&[BinsQuery { primitives, grid }]).remove(0);
    let query = BinSplitQuery { bins: bins.clone(), n_bins: MAX_BINS as u32 };
    let best = kit.cheapest_split(&[query]).remove(0).context("these boxes can be split")?;

    let mut drawing = Drawing::new("32 bins, and the cost of each cut", 1000.0, 640.0);
    let x = Axis::linear(f64::from(low) / 2.0, f64::from(high) / 2.0);
    let plot = Plot::new(x, Axis::linear(1000.0, 8000.0), [110.0, 400.0], [850.0, 310.0]);
    // Draw the cost of each cut of the sorted boxes.
    let mut sorted = boxes.clone();
    sorted.sort_by(|p, q| p.min.x.total_cmp(&q.min.x));
    let cost = |left: &[Aabb], right: &[Aabb]| -> f64 {
        let side = |side: &[Aabb]| {
            let whole = side[1..].iter().fold(side[0], |all, one| kit.union(&[(all, *one)])[0]);
            kit.surface_area(&[whole])[0] / 2.0 * kit.block_cost(&[side.len() as u32])[0]
        };
        f64::from(side(left) + side(right))
    };
    // The cost is the same wherever a cut lies between two neighbours.
    let sweep: Vec<[f64; 2]> = (1..sorted.len())
        .flat_map(|cut| {
            let (left, right) = sorted.split_at(cut);
            let cost = cost(left, right);
            [left[cut - 1], right[0]].map(|neighbour| [f64::from(neighbour.min.x) + 0.5, cost])
        })
        .collect();
    let numbers = [2000.0, 4000.0, 6000.0, 8000.0].map(|y| (y, format!("{y:.0}")));
    let labels: Vec<(f64, &str)> = numbers.iter().map(|(y, text)| (*y, text.as_str())).collect();
    plot.draw_axes(&mut drawing, &[], &labels, ["", "A(L) c(L) + A(R) c(R)"]);
    plot.draw_curve(&mut drawing, sweep, Ink::Faint.pen(3.0));
    drawing.text([960.0, 30.0], End, SMALL, Ink::Faint, "all 59 cuts of the sorted boxes");
    // Draw the cost of each cut between two bins.
    let border = |bin: usize| f64::from(low + bin as f32 / scale) / 2.0;
    for bin in 1..MAX_BINS {
        let is_left = |one: &&Aabb| ((2.0 * one.min.x + 1.0 - low) * scale) < bin as f32;
        let (left, right): (Vec<Aabb>, Vec<Aabb>) = sorted.iter().partition(is_left);
        let at = plot.at(border(bin), cost(&left, &right));
        let is_best = best.axis == 0 && best.bin as usize == bin;
        let ink = if is_best { Ink::Color(1) } else { Ink::Color(0) };
        drawing.dot(at, if is_best { 11.0 } else { 8.0 }, ink);
        if is_best {
            let text = format!("cheapest_split: bin {bin}, cost {:.0}", best.cost);
            drawing.text(offset(at, [0.0, 36.0]), Middle, SMALL, ink, &text);
        }
    }
    drawing.text([960.0, 66.0], End, SMALL, Ink::Color(0), "31 cuts between bins");
    draw_bins(&mut drawing, &plot, &bins, border);
    Ok(drawing.svg())
}

/// Draws the bins of the first axis below a plot, with the number of primitives in each.
fn draw_bins(drawing: &mut Drawing, plot: &Plot, bins: &Bins, border: impl Fn(usize) -> f64) {
    let most = bins.0[0].iter().map(|bin| bin.count).max().unwrap_or(1);
    for (i, bin) in bins.0[0].iter().enumerate() {
        let [left, right] = [i, i + 1].map(|bin| plot.at(border(bin), plot.y.low)[0]);
        let height = 110.0 * f64::from(bin.count) / f64::from(most);
        drawing.rectangle([left + 2.0, 570.0 - height], [right - 2.0, 570.0], Ink::Color(0), 0.5);
        let text = bin.count.to_string();
        drawing.text([(left + right) / 2.0, 596.0], Middle, SMALL, Ink::Text, &text);
    }
    drawing.text([960.0, 628.0], End, SMALL, Ink::Text, "boxes per bin, by fill_bins");
}

/// The cost of a leaf over its number of primitives.
pub fn blocks_that_pay(kit: &dyn Kit) -> Result<String> {
    let sizes: Vec<u32> = (1..=32).collect();
    let costs = kit.block_cost(&sizes);
    let mut drawing = Drawing::new("The cost of a leaf, in blocks of eight", 1000.0, 520.0);
    let plot = Plot::new(Axis::linear(0.0, 33.0), Axis::linear(0.0, 4.4), [80.0, 430.0], [880.0, 360.0]);
    let x = [(8.0, "8"), (16.0, "16"), (24.0, "24"), (32.0, "32")];
    let y = [(1.0, "1"), (2.0, "2"), (3.0, "3"), (4.0, "4")];
    plot.draw_axes(&mut drawing, &x, &y, ["primitives", "block_cost"]);
    plot.draw_curve(&mut drawing, [[0.0, 0.0], [33.0, 4.125]], Ink::Faint.pen(3.0).dashed());
    for (&n, &cost) in sizes.iter().zip(&costs) {
        let top = plot.at(f64::from(n), f64::from(cost));
        let ink = if n % 8 == 0 { Ink::Color(1) } else { Ink::Color(0) };
        let foot = offset(plot.at(f64::from(n), 0.0), [9.0, 0.0]);
        drawing.rectangle(offset(top, [-9.0, 0.0]), foot, ink, 0.85);
    }
    drawing.text(plot.at(0.6, 3.6), Start, SMALL, Ink::Color(1), "full blocks cost an eighth per primitive");
    Ok(drawing.svg())
}

/// A binary tree in two dimensions: how many primitives are below each node, its depth, and where it stands.
struct Layout {
    depth: Vec<u32>,
    first: Vec<u32>,
    count: Vec<u32>,
}

fn layout(tree: &FlatTree) -> Layout {
    let n = tree.nodes.len();
    let mut all = Layout { depth: vec![0; n], first: vec![0; n], count: vec![0; n] };
    for (index, node) in tree.nodes.iter().enumerate() {
        if !node.is_leaf() {
            let below = [node.first as usize, node.first as usize + 1];
            below.iter().for_each(|&child| all.depth[child] = all.depth[index] + 1);
        }
    }
    // Children come after their parents.
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        (all.first[index], all.count[index]) = if node.is_leaf() {
            (node.first, node.count)
        } else {
            let child = node.first as usize;
            (all.first[child], all.count[child] + all.count[child + 1])
        };
    }
    all
}

/// A binary tree, and which of its nodes become the children of the root of the wide tree.
pub fn wide_node(kit: &dyn Kit) -> Result<String> {
    // Boxes that grow to the right, so that the nodes there have larger areas and are opened first.
    let boxes: Vec<Aabb> = (0..56u32)
        .map(|i| {
            let x = 1.5 * i as f32 + scattered(i);
            let size = 0.4 + 0.05 * i as f32;
            Aabb::new(vec3(x, 0.0, 0.0), vec3(x + size, size, size))
        })
        .collect();
    let tree = kit.build_binned(&[boxes]).remove(0);
    let wide = kit.collapse(&[(tree.clone(), WIDE_NODE_COST)]).remove(0);
    let all = layout(&tree);
    let deepest = f64::from(all.depth.iter().copied().max().unwrap_or(0));

    let mut drawing =
        Drawing::new("A binary tree becomes a tree with eight children per node", 1000.0, 600.0);
    let at = |index: usize| {
        let middle = f64::from(all.first[index]) + f64::from(all.count[index]) / 2.0;
        let x = 20.0 + 960.0 * middle / tree.order.len() as f64;
        [x, 80.0 + 330.0 * f64::from(all.depth[index]) / deepest]
    };
    for (index, node) in tree.nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
        for child in [node.first as usize, node.first as usize + 1] {
            drawing.line(at(index), at(child), Ink::Faint.pen(2.0));
        }
    }
    // The children of the root of the wide tree have the boxes of nodes of the binary tree.
    let root = wide.nodes.first().context("the wide tree is empty")?;
    let n_children = root.n_children() as usize;
    let children: Vec<Aabb> = (0..n_children).map(|place| root.child_bounds(place)).collect();
    for (index, node) in tree.nodes.iter().enumerate() {
        let is_child = children.contains(&node.bounds());
        let is_above =
            !is_child && !node.is_leaf() && children.iter().any(|child| node.bounds().contains_box(child));
        let (radius, ink) = match (is_child, is_above) {
            (true, _) => (15.0, Ink::Color(1)),
            (_, true) => (11.0, Ink::Color(0)),
            _ => (7.0, Ink::Faint),
        };
        drawing.dot(at(index), radius, ink);
    }
    let nodes = wide.nodes.len();
    let inner = tree.nodes.iter().filter(|node| !node.is_leaf()).count();
    drawing.text([20.0, 40.0], Start, TEXT, Ink::Color(0), "opened: its box is not stored");
    drawing.text([980.0, 40.0], End, TEXT, Ink::Color(1), &format!("the {n_children} children of the root"));
    // Draw the wide node below: one place per child, with what it holds.
    let width = 960.0 / 8.0;
    for place in 0..n_children {
        let left = 20.0 + width * place as f64;
        drawing.frame([left, 470.0], [left + width, 530.0], Ink::Color(1).pen(3.0));
        let text = match root.children[place].contents() {
            ChildContents::Inner(node) => format!("node {node}"),
            ChildContents::Leaf { count, .. } => format!("leaf of {count}"),
        };
        drawing.text([left + width / 2.0, 508.0], Middle, SMALL, Ink::Text, &text);
    }
    let free = wide.blocks.iter().flatten().filter(|&&id| id == NO_PRIMITIVE).count();
    let fill = 8.0 - free as f64 / wide.blocks.len() as f64;
    let text = format!("{inner} inner nodes become {nodes}; a block of eight holds {fill:.1} primitives");
    drawing.text([500.0, 578.0], Middle, SMALL, Ink::Text, &text);
    Ok(drawing.svg())
}

/// The work and the span of each node, in primitives.
fn work_and_span_of(tree: &FlatTree, all: &Layout, forks: &HashSet<(u32, u32)>) -> Vec<[u64; 2]> {
    let mut costs = vec![[0; 2]; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        let own = u64::from(all.count[index]);
        costs[index] = if node.is_leaf() {
            [own; 2]
        } else {
            let [left, right] = [costs[node.first as usize], costs[node.first as usize + 1]];
            let in_parallel = forks.contains(&(all.first[index], all.count[index]));
            let span = if in_parallel { left[1].max(right[1]) } else { left[1] + right[1] };
            [own + left[0] + right[0], own + span]
        };
    }
    costs
}

/// The upper levels of a parallel build: the width of a node is its number of primitives, and the longest path stands out.
pub fn work_and_span(kit: &dyn Kit) -> Result<String> {
    const N: u32 = 100_000;
    let boxes: Vec<Aabb> = (0..N)
        .map(|i| {
            let center = vec3(scattered(i), scattered(7 * i + 1), scattered(13 * i + 2));
            Aabb::new(center - 0.002, center + 0.002)
        })
        .collect();
    let forked = kit.build_parallel(&[boxes]).remove(0);
    let all = layout(&forked.tree);
    // The drawing shows the forks of children only. Binning in pieces, the bonus, would shorten the span further.
    let of_children = forked.forks.iter().filter(|fork| fork.kind == ForkKind::Children);
    let forks: HashSet<(u32, u32)> = of_children.map(|fork| (fork.first, fork.count)).collect();
    let costs = work_and_span_of(&forked.tree, &all, &forks);

    // Follow the longest path from the root.
    let mut path = vec![0];
    while let Some(node) = path.last().map(|&last| &forked.tree.nodes[last]) {
        if node.is_leaf() {
            break;
        }
        let [left, right] = [node.first as usize, node.first as usize + 1];
        path.push(if costs[left][1] >= costs[right][1] { left } else { right });
    }
    let mut drawing = Drawing::new("Work and span of a parallel build", 1000.0, 560.0);
    let row = 56.0;
    for (index, _) in forked.tree.nodes.iter().enumerate().filter(|&(index, _)| all.depth[index] < 7) {
        let x = |primitive: u32| 20.0 + 960.0 * f64::from(primitive) / f64::from(N);
        let y = 70.0 + row * f64::from(all.depth[index]);
        let (a, b) = ([x(all.first[index]), y], [x(all.first[index] + all.count[index]), y + row - 6.0]);
        let ink = if path.contains(&index) { Ink::Color(1) } else { Ink::Color(0) };
        drawing.rectangle(a, b, ink, if path.contains(&index) { 0.85 } else { 0.3 });
        drawing.frame(a, b, Ink::Text.pen(1.0));
    }
    drawing.text([20.0, 44.0], Start, TEXT, Ink::Text, "100,000 primitives: one level per row");
    let [work, span] = costs[0];
    let levels = 1 + all.depth.iter().max().context("a tree")?;
    let text = format!("work {}: all rows of all {levels} levels", Thousands(work));
    drawing.text([20.0, 506.0], Start, SMALL, Ink::Color(0), &text);
    let text = format!("span {}: the longest path, work / {:.1}", Thousands(span), work as f64 / span as f64);
    drawing.text([20.0, 542.0], Start, SMALL, Ink::Color(1), &text);
    let text = format!("{} forks", forks.len());
    drawing.text([980.0, 44.0], End, TEXT, Ink::Text, &text);
    Ok(drawing.svg())
}

/// The node visits behind each pixel, with two and with eight children per node.
pub fn wide_heatmaps(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "stage9.toml")?;
    (scene.film.width, scene.film.height) = (400, 250);
    let mut films = Vec::new();
    for (accelerator, name) in [(Accelerator::Bvh, "two children"), (Accelerator::WideBvh, "eight children")]
    {
        scene.quality.accelerator = accelerator;
        let rendering = work(kit, &scene)?;
        let visits = rendering.counts.node_visits as f64 / rendering.counts.rays() as f64;
        films.push((rendering.film, format!("{name}: {visits:.1} visits/ray")));
    }
    // The red channel of this view holds the node visits.
    heat_panels(films, |pixel| pixel.x)
}
