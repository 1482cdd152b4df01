//! The acceleration structure over a set of primitives, built and searched by the functions of stages 3, 8
//! and 9.

use super::grid_resolution::grid_resolution;
use super::primitives::Primitives;
use super::wide::Wide;
use crate::aabb::Aabb;
use crate::bvh::{Bvh, Contents, Node, PrimitiveHit, Probe};
use crate::count::Event;
use crate::graph::{ChildCache, Graph, GraphOptimisations};
use crate::kit::{StructureSize, StudentFunctions};
use crate::partition::limit::limited;
use crate::partition::{Bsp, Cells, Grid, KdTree, Octree, PolygonBsp, Tree, TreeNode, corners};
use crate::ray::Ray;
use crate::scene::{Accelerator, Quality};
use crate::shape::Sphere;
use glam::Vec3;
use std::marker::PhantomData;

/// An acceleration structure over a set of primitives.
#[derive(Debug)]
pub enum Structure {
    /// No structure: every primitive is tested.
    List,
    /// No structure and no search: later primitives cover earlier ones, near or far.
    Painter,
    /// A bounding volume hierarchy.
    Hierarchy(Bvh),
    /// A bounding volume hierarchy whose search visits both children of every node that the ray enters.
    BothChildren(Bvh),
    /// The scene graph, with a bounding volume around each node.
    Graph {
        /// The nodes of the scene graph.
        graph: Graph,
        /// One bounding volume per node of the graph.
        volumes: Volumes,
    },
    /// A uniform grid of cells.
    Grid(Grid),
    /// An octree, a tree of cubes.
    Octree {
        /// The nodes of the octree.
        tree: Octree,
        /// How it is searched.
        search: OctreeSearch,
    },
    /// A kd-tree, divided by planes across the axes.
    KdTree(KdTree),
    /// A binary space partition.
    Bsp {
        /// The nodes of the BSP tree.
        tree: Bsp,
        /// The bounding box of all primitives.
        around: Aabb,
    },
    /// A bounding volume hierarchy with eight children per node.
    Wide(Wide),
    /// A binary space partition with the polygons in its nodes.
    PolygonBsp {
        /// The nodes of the BSP tree.
        tree: PolygonBsp,
        /// The bounding box of all primitives.
        around: Aabb,
    },
}

/// The three searches of an octree.
#[derive(Clone, Copy, Debug)]
pub enum OctreeSearch {
    /// From the root down, nearest octant first.
    FromTheRoot,
    /// From leaf to leaf along the ray, each time from the root.
    ByCells,
    /// From leaf to leaf along the ray, up only as far as needed.
    ByNeighbours,
}

/// The bounding volumes of a scene graph, one per node; empty or `None` for a node without primitives at or
/// below it.
#[derive(Debug)]
pub enum Volumes {
    /// Axis-aligned bounding boxes.
    Boxes(Vec<Aabb>),
    /// Bounding spheres.
    Spheres(Vec<Option<Sphere>>),
}

/// The deepest level of an octree: octants there are a millionth of the scene wide.
const DEEPEST_OCTANT: usize = 20;

impl Structure {
    /// Builds the structure of `accelerator` over primitives with the bounding boxes `bounds`; no structure
    /// if it is `None`, because no search is written.
    ///
    /// A shared mesh has no scene graph, and gets a hierarchy in its place. `hull` returns the corners of a
    /// flat primitive by index, for BSP trees; other primitives are represented by the corners of their
    /// boxes. If a structure is coarser than the scene asks for, because primitives overlap, `notes` receives a
    /// sentence that says so.
    pub fn build<F: StudentFunctions>(
        bounds: &[Aabb],
        graph: Option<Graph>,
        hull: impl Fn(usize) -> Option<Vec<Vec3>>,
        accelerator: Option<Accelerator>,
        quality: &Quality,
        notes: &mut Vec<String>,
    ) -> Structure {
        let (n, leaf_size) = (bounds.len(), quality.leaf_size as usize);
        let octree = |search| Structure::Octree {
            tree: limited(n, || F::octree_build(bounds, leaf_size, DEEPEST_OCTANT)),
            search,
        };
        let hulls = || -> Vec<Vec<Vec3>> {
            let hull = |(index, bounds): (usize, &Aabb)| hull(index).unwrap_or_else(|| corners(bounds));
            bounds.iter().enumerate().map(hull).collect()
        };
        let structure = match (accelerator, graph) {
            (None, _) => Structure::Painter,
            (Some(Accelerator::BruteForce), _) => Structure::List,
            (Some(Accelerator::BoundingBoxes | Accelerator::CachedBoundingBoxes), Some(graph)) => {
                let volumes = Volumes::Boxes(boxes::<F>(&graph, bounds));
                Structure::Graph { graph, volumes }
            }
            (Some(Accelerator::BoundingSpheres), Some(graph)) => {
                let volumes =
                    Volumes::Spheres(boxes::<F>(&graph, bounds).iter().map(sphere_around::<F>).collect());
                Structure::Graph { graph, volumes }
            }
            (Some(Accelerator::Grid), _) => {
                let resolution = grid_resolution::<F>(bounds, &around(bounds), quality, notes);
                Structure::Grid(F::grid_build(bounds, resolution))
            }
            (Some(Accelerator::Octree), _) => octree(OctreeSearch::FromTheRoot),
            (Some(Accelerator::OctreeByCells), _) => octree(OctreeSearch::ByCells),
            (Some(Accelerator::OctreeByNeighbours), _) => octree(OctreeSearch::ByNeighbours),
            (Some(Accelerator::KdTree), _) => {
                Structure::KdTree(limited(n, || F::kd_build(bounds, &quality.kd_heuristics, leaf_size)))
            }
            (Some(Accelerator::Bsp), _) => {
                let tree = limited(n, || F::bsp_build(&hulls(), leaf_size, KdTree::most_depth(n)));
                Structure::Bsp { tree, around: around(bounds) }
            }
            (Some(Accelerator::BvhBothChildren), _) => {
                Structure::BothChildren(F::build(bounds, quality.split, leaf_size))
            }
            (Some(Accelerator::PolygonBsp), _) => {
                let tree =
                    limited(n, || F::polygon_bsp_build(&hulls(), leaf_size, 2 * KdTree::most_depth(n)));
                Structure::PolygonBsp { tree, around: around(bounds) }
            }
            (
                Some(
                    Accelerator::Auto
                    | Accelerator::Bvh
                    | Accelerator::WideBvh
                    | Accelerator::CachedBvh
                    | Accelerator::PacketBvh
                    | Accelerator::BoundingBoxes
                    | Accelerator::BoundingSpheres
                    | Accelerator::CachedBoundingBoxes,
                ),
                _,
            ) => Structure::Hierarchy(F::build(bounds, quality.split, leaf_size)),
        };
        notes.extend(large_leaves(&structure, leaf_size));
        structure
    }

    /// The closest hit of `ray` with the primitives of `probe` within its range, or `None`; for
    /// [`Structure::Painter`] the hit with the last primitive. `savings` are the shortcuts of a search of the
    /// scene graph; other structures ignore it.
    // Not inlined, because each caller would compile all searches again: a third of the time of a build.
    #[inline(never)]
    pub fn closest_hit<F: StudentFunctions, P: Primitives>(
        &self,
        probe: &mut P,
        ray: &Ray,
        savings: GraphOptimisations,
    ) -> Option<PrimitiveHit> {
        match self {
            Structure::Wide(wide) => wide.closest_hit::<F, P>(probe, ray),
            Structure::Hierarchy(bvh) => F::closest_hit(bvh, probe, ray),
            Structure::BothChildren(bvh) => F::closest_hit_both(bvh, probe, ray),
            Structure::Graph { graph, volumes } => {
                let mut probe = GraphProbe::<F, P> { probe, volumes, functions: PhantomData };
                F::closest_hit_in_graph(graph, &mut probe, ray, savings)
            }
            Structure::Grid(grid) => F::grid_search(grid, probe, ray),
            Structure::Octree { tree, search } => match search {
                OctreeSearch::FromTheRoot => F::octree_search(tree, probe, ray),
                OctreeSearch::ByCells => F::octree_by_cells(tree, probe, ray),
                OctreeSearch::ByNeighbours => F::octree_by_neighbours(tree, probe, ray),
            },
            Structure::KdTree(tree) => F::kd_search(tree, probe, ray),
            Structure::Bsp { tree, .. } => F::bsp_search(tree, probe, ray),
            Structure::PolygonBsp { tree, .. } => F::polygon_bsp_search(tree, probe, ray),
            Structure::List => F::brute_force(probe.n_primitives(), probe, ray),
            Structure::Painter => last_hit(probe, ray),
        }
    }

    /// The same for a scene graph with a cache in each node, which is updated; other structures have no such cache.
    #[inline(never)]
    pub fn closest_hit_with_cache<F: StudentFunctions, P: Primitives>(
        &self,
        probe: &mut P,
        ray: &Ray,
        savings: GraphOptimisations,
        cache: &mut ChildCache,
    ) -> Option<PrimitiveHit> {
        match self {
            Structure::Graph { graph, volumes } => {
                let mut probe = GraphProbe::<F, P> { probe, volumes, functions: PhantomData };
                F::closest_hit_with_child_cache(graph, &mut probe, ray, savings, cache)
            }
            other => other.closest_hit::<F, P>(probe, ray, savings),
        }
    }

    /// Whether `ray` hits any primitive of `probe` within its range. Only hierarchies and lists stop at the
    /// first hit; other structures search the closest one.
    #[inline(never)]
    pub fn any_hit<F: StudentFunctions, P: Primitives>(
        &self,
        probe: &mut P,
        ray: &Ray,
        savings: GraphOptimisations,
    ) -> bool {
        match self {
            Structure::Wide(wide) => wide.any_hit::<F, P>(probe, ray),
            Structure::Hierarchy(bvh) | Structure::BothChildren(bvh) => F::any_hit(bvh, probe, ray),
            Structure::List | Structure::Painter => last_hit(probe, ray).is_some(),
            other => other.closest_hit::<F, P>(probe, ray, savings).is_some(),
        }
    }

    /// The nodes of a bounding volume hierarchy; empty for any other structure.
    pub fn nodes(&self) -> &[Node] {
        match self {
            Structure::Hierarchy(bvh) | Structure::BothChildren(bvh) => &bvh.nodes,
            _ => &[],
        }
    }

    /// The number of nodes, levels, references to primitives and bytes of the structure; `None` for brute
    /// force.
    pub fn size(&self) -> Option<StructureSize> {
        fn bytes<T>(list: &[T]) -> usize {
            std::mem::size_of_val(list)
        }
        fn tree<Node>(nodes: &[Node], levels: usize, items: &[u32]) -> (usize, usize, usize, usize) {
            (nodes.len(), levels, items.len(), bytes(nodes) + bytes(items))
        }
        let (nodes, levels, references, bytes) = match self {
            Structure::List | Structure::Painter => return None,
            Structure::Wide(wide) => return Some(wide.size()),
            Structure::Hierarchy(bvh) | Structure::BothChildren(bvh) => {
                tree(&bvh.nodes, bvh.depth(), &bvh.order)
            }
            Structure::Graph { graph, volumes } => {
                let lists: usize =
                    graph.nodes.iter().map(|n| bytes(&n.children) + bytes(&n.primitives)).sum();
                let volumes = match volumes {
                    Volumes::Boxes(boxes) => bytes(boxes),
                    Volumes::Spheres(spheres) => bytes(spheres),
                };
                let references = graph.nodes.iter().map(|node| node.primitives.len()).sum();
                (graph.nodes.len(), graph.depth(), references, bytes(&graph.nodes) + lists + volumes)
            }
            Structure::Grid(grid) => {
                (grid.n_nodes(), grid.depth(), grid.items.len(), bytes(&grid.starts) + bytes(&grid.items))
            }
            Structure::Octree { tree: octree, .. } => tree(&octree.nodes, octree.depth(), &octree.items),
            Structure::KdTree(kd_tree) => tree(&kd_tree.nodes, kd_tree.depth(), &kd_tree.items),
            Structure::Bsp { tree: bsp, .. } => tree(&bsp.nodes, bsp.depth(), &bsp.items),
            Structure::PolygonBsp { tree: bsp, .. } => tree(&bsp.nodes, bsp.depth(), &bsp.items),
        };
        let [nodes, levels, references, bytes] = [nodes, levels, references, bytes].map(|n| n as u64);
        Some(StructureSize { nodes, levels, references, bytes })
    }
}

/// The hit with the last primitive, in the order of the scene, that the ray hits.
fn last_hit<P: Primitives>(probe: &mut P, ray: &Ray) -> Option<PrimitiveHit> {
    (0..probe.n_primitives())
        .rev()
        .find_map(|primitive| Cells::hit(probe, primitive, ray).map(|t| PrimitiveHit { t, primitive }))
}

/// A probe for a scene graph, whose nodes have volumes of their own.
struct GraphProbe<'p, F, P> {
    probe: &'p mut P,
    volumes: &'p Volumes,
    functions: PhantomData<F>,
}

impl<F: StudentFunctions, P: Primitives> Probe for GraphProbe<'_, F, P> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.probe.open(node)
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.probe.count(Event::BoxTest);
        match self.volumes {
            Volumes::Boxes(boxes) => {
                let bounds = &boxes[node as usize];
                let (inverse, conservative) = (self.probe.inverse_direction(), self.probe.conservative());
                let test = if conservative { F::conservative_slab } else { F::slab };
                let interval = test(ray, inverse, bounds);
                self.probe.tested(|| *bounds, interval.is_some());
                interval.map(|(enter, _)| enter)
            }
            Volumes::Spheres(spheres) => F::enter_bounding_sphere(ray, spheres[node as usize].as_ref()?),
        }
    }

    #[inline]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        Probe::hit(self.probe, primitive, ray)
    }
}

/// The bounding box of all boxes that are not empty.
fn around(bounds: &[Aabb]) -> Aabb {
    let boxes = bounds.iter().filter(|one| !one.is_empty());
    boxes.fold(Aabb::EMPTY, |all, one| Aabb::new(all.min.min(one.min), all.max.max(one.max)))
}

/// A bounding box for each node of a graph, around its primitives and all nodes below.
fn boxes<F: StudentFunctions>(graph: &Graph, bounds: &[Aabb]) -> Vec<Aabb> {
    let mut boxes = vec![Aabb::EMPTY; graph.nodes.len()];
    // Children have larger indices than their parents, so go through the nodes backwards.
    for (index, node) in graph.nodes.iter().enumerate().rev() {
        let own = node.primitives.iter().map(|&primitive| bounds[primitive as usize]);
        let below = node.children.iter().map(|&child| boxes[child as usize]);
        boxes[index] = own.chain(below).fold(Aabb::EMPTY, |all, one| F::union(&all, &one));
    }
    boxes
}

fn sphere_around<F: StudentFunctions>(bounds: &Aabb) -> Option<Sphere> {
    (!bounds.is_empty()).then(|| F::bounding_sphere(&corners(bounds)))
}

/// A leaf is large if it has more than this many times `leaf_size` primitives. Smaller leaves are common around
/// the vertices of ordinary meshes, where up to 64 triangles meet.
const LARGE: usize = 16;

/// A sentence that says that dividing stopped early; `None` unless more than half of the references of a
/// partition of space are in large leaves. A hierarchy has no large leaves, because it lists each primitive once.
fn large_leaves(structure: &Structure, leaf_size: usize) -> Option<String> {
    fn counts<N: TreeNode>(tree: &Tree<N>) -> Vec<usize> {
        // A polygon that lies in an inner node is listed by no leaf.
        let leaves = tree.nodes.iter().filter(|node| node.is_leaf());
        leaves.filter_map(|leaf| Some(leaf.range()?.1 as usize)).collect()
    }
    let (name, counts) = match structure {
        Structure::Octree { tree, .. } => ("octree", counts(tree)),
        Structure::KdTree(tree) => ("kd-tree", counts(tree)),
        Structure::Bsp { tree, .. } => ("BSP tree", counts(tree)),
        Structure::PolygonBsp { tree, .. } => ("BSP tree of polygons", counts(tree)),
        _ => return None,
    };
    let in_large: usize = counts.iter().filter(|&&count| count > LARGE * leaf_size).sum();
    let largest = counts.iter().max()?;
    (2 * in_large > counts.iter().sum()).then(|| {
        format!(
            "the {name} has up to {largest} primitives per leaf (`leaf_size = {leaf_size}`), because primitives overlap \
             or are too close to each other: dividing stopped where it would mostly list the same ones again; \
             `accelerator = \"bvh\"` lists each one once"
        )
    })
}
