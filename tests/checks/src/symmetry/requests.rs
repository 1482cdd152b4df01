//! The requests that are turned, and their answers, which are turned back.

use super::Symmetry;
use super::cells::Cells;
use glam::{UVec3, Vec3};
use raykata::bvh::{Bvh, PrimitiveHit, PrimitiveRef};
use raykata::frame::Watch;
use raykata::kit::*;
use raykata::mesh::Mesh;
use raykata::partition::{Bsp, KdTree, Octree, PolygonBsp};
use raykata::shape::{Cone, Cylinder, Plane, PlaneEquation, Sphere, Triangle};
use raykata::wide::FlatTree;

/// A kit that gets turned requests, and whose answers are turned back. Requests that are not listed in its `call`
/// remain as they are.
pub(crate) struct TurnedKit<'a> {
    pub(crate) kit: &'a dyn Kit,
    pub(crate) symmetry: Symmetry,
}

/// A query or an answer that is turned. A `Vec3` is a direction and a `f32` is a length.
trait Turn {
    fn turn(&self, symmetry: &Symmetry) -> Self;
}

macro_rules! turn_requests {
    ($request:ident, $turned:ident; $($Message:ident)* ; $($Search:ident)*) => {
        match $request {
            $(Request::$Message(queries) => {
                let asked = Request::$Message(queries.turn(&$turned.symmetry));
                match $turned.ask(&asked) {
                    Answer::$Message(answers) => Answer::$Message(answers.turn(&$turned.symmetry.inverse())),
                    answer => answer,
                }
            })*
            $(Request::$Search(queries) => {
                let (asked, numbers) = turned_cells(&queries, &$turned.symmetry);
                match $turned.ask(&Request::$Search(asked)) {
                    Answer::$Search(answers) => {
                        Answer::$Search(turned_back(&answers, &numbers, &$turned.symmetry.inverse()))
                    }
                    answer => answer,
                }
            })*
            request => $turned.ask(&request),
        }
    };
}

impl Transport for TurnedKit<'_> {
    fn call(&self, request: Request, _: &dyn Watch) -> Answer {
        turn_requests! { request, self;
            SphereAlgebraic SphereGeometric Plane PlaneByCoefficients
            TriangleCramer TriangleGram TriangleChoice Backfacing VertexNormals
            Slab SplitObjectMedian SplitSpatialMedian SplitSurfaceArea Build ClosestHitBoth ClosestHit AnyHit
            Shade
            Reflect Scatter
            Cylinder Cone
            GridResolution OctreeBuild KdBuild BspBuild PolygonBspBuild CachedSearch PacketSearch
            SafeNormalize
            BuildBinned WideClosestHit;
            GridSearch OctreeByCells OctreeByNeighbours OctreeSearch KdSearch BspSearch PolygonBspSearch
        }
    }
}

impl TurnedKit<'_> {
    fn ask(&self, request: &Request) -> Answer {
        request.answer(self.kit, &raykata::frame::Unwatched)
    }
}

/// Queries with turned structures, and for each query the numbers that the cells had before.
fn turned_cells<S: Cells>(
    queries: &[CellsQuery<S>],
    symmetry: &Symmetry,
) -> (Vec<CellsQuery<S>>, Vec<Vec<u32>>) {
    let turn = |query: &CellsQuery<S>| {
        let (cells, numbers) = query.cells.turned(symmetry);
        (CellsQuery { cells, ray: query.ray.turn(symmetry), hits: query.hits.turn(symmetry) }, numbers)
    };
    queries.iter().map(turn).unzip()
}

/// The answers of searches of turned structures, with the numbers that the cells had before.
fn turned_back(answers: &[CellsAnswer], numbers: &[Vec<u32>], inverse: &Symmetry) -> Vec<CellsAnswer> {
    let turn = |(answer, numbers): (&CellsAnswer, &Vec<u32>)| {
        // A wrong search may visit a cell that does not exist.
        let before = |visit: &u32| numbers.get(*visit as usize).copied().unwrap_or(*visit);
        CellsAnswer { visits: answer.visits.iter().map(before).collect(), ..answer.turn(inverse) }
    };
    answers.iter().zip(numbers).map(turn).collect()
}

impl<T: Turn> Turn for Vec<T> {
    fn turn(&self, symmetry: &Symmetry) -> Self {
        self.iter().map(|one| one.turn(symmetry)).collect()
    }
}

impl<T: Turn> Turn for Option<T> {
    fn turn(&self, symmetry: &Symmetry) -> Self {
        self.as_ref().map(|one| one.turn(symmetry))
    }
}

impl<T: Turn, U: Turn> Turn for (T, U) {
    fn turn(&self, symmetry: &Symmetry) -> Self {
        (self.0.turn(symmetry), self.1.turn(symmetry))
    }
}

impl<T: Turn, const N: usize> Turn for [T; N] {
    fn turn(&self, symmetry: &Symmetry) -> Self {
        self.each_ref().map(|one| one.turn(symmetry))
    }
}

/// Implements [`Turn`] by an expression.
macro_rules! turn {
    ($(|$this:ident: $Type:ty, $symmetry:ident| $turned:expr;)*) => {
        $(impl Turn for $Type {
            fn turn(&self, $symmetry: &Symmetry) -> Self {
                let $this = self;
                $turned
            }
        })*
    };
}

turn! {
    |length: f32, symmetry| symmetry.length(*length);
    |v: Vec3, symmetry| symmetry.direction(*v);
    |ray: raykata::ray::Ray, symmetry| symmetry.ray(ray);
    |bounds: raykata::aabb::Aabb, symmetry| symmetry.bounds(bounds);
    |sphere: Sphere, symmetry| {
        Sphere { center: symmetry.point(sphere.center), radius: symmetry.length(sphere.radius) }
    };
    |plane: Plane, symmetry| {
        Plane { point: symmetry.point(plane.point), normal: symmetry.direction(plane.normal) }
    };
    |plane: PlaneEquation, symmetry| {
        PlaneEquation { normal: symmetry.direction(plane.normal), d: symmetry.length(plane.d) }
    };
    |triangle: Triangle, symmetry| {
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|corner| symmetry.point(corner));
        Triangle { a, b, c }
    };
    |mesh: Mesh, symmetry| {
        let positions = mesh.positions.iter().map(|position| symmetry.point(*position)).collect();
        Mesh { positions, normals: mesh.normals.turn(symmetry), ..mesh.clone() }
    };
    |cylinder: Cylinder, symmetry| {
        let [base, top] = [cylinder.base, cylinder.top].map(|end| symmetry.point(end));
        Cylinder { base, top, radius: symmetry.length(cylinder.radius) }
    };
    |cone: Cone, symmetry| {
        let [base, apex] = [cone.base, cone.apex].map(|end| symmetry.point(end));
        Cone { base, apex, radius: symmetry.length(cone.radius) }
    };
    |surface: Surface, symmetry| Surface {
        point: symmetry.point(surface.point),
        error: symmetry.point(surface.error).abs(),
        geometric_normal: symmetry.direction(surface.geometric_normal),
        shading_normal: symmetry.direction(surface.shading_normal),
    };
    |primitive: PrimitiveRef, symmetry| PrimitiveRef {
        bounds: primitive.bounds.turn(symmetry),
        centroid: symmetry.point(primitive.centroid),
        ..*primitive
    };
    |bvh: Bvh, symmetry| {
        let mut bvh = bvh.clone();
        bvh.nodes.iter_mut().for_each(|node| node.bounds = node.bounds.turn(symmetry));
        bvh
    };
    |resolution: UVec3, symmetry| symmetry.resolution(*resolution);
    |octree: Octree, symmetry| octree.turned(symmetry).0;
    |tree: KdTree, symmetry| tree.turned(symmetry).0;
    |query: BspQuery, symmetry| {
        let turn = |hull: &Vec<Vec3>| hull.iter().map(|corner| symmetry.point(*corner)).collect();
        BspQuery { hulls: query.hulls.iter().map(turn).collect(), ..query.clone() }
    };
    |bsp: Bsp, symmetry| bsp.turned(symmetry).0;
    |bsp: PolygonBsp, symmetry| bsp.turned(symmetry).0;
    |tree: FlatTree, symmetry| {
        let mut tree = tree.clone();
        for node in &mut tree.nodes {
            let bounds = node.bounds().turn(symmetry);
            (node.low, node.high) = (bounds.min, bounds.max);
        }
        tree
    };
}

/// Implements [`Turn`] for structs of which these fields are turned, and the others stay.
macro_rules! turn_fields {
    ($($Type:ty: $($field:ident)*;)*) => {
        $(impl Turn for $Type {
            #[allow(unused_mut, unused_variables, reason = "nothing of some structs is turned")]
            fn turn(&self, symmetry: &Symmetry) -> Self {
                let mut turned = self.clone();
                $(turned.$field = self.$field.turn(symmetry);)*
                turned
            }
        })*
    };
}

turn_fields! {
    bool:;
    TriangleHit: t;
    SolidHit: t normal;
    PrimitiveHit: t;
    LightSample: direction distance;
    SecondaryRay: direction;
    Table: boxes primitives;

    SphereQuery: ray sphere;
    PlaneQuery: ray plane;
    PlaneEquationQuery: ray plane;
    TriangleQuery: ray triangle;
    SolidQuery<Cylinder>: ray solid;
    SolidQuery<Cone>: ray solid;
    ShadeQuery: surface to_viewer lights;
    ScatterQuery: direction normal;
    SlabQuery: ray bounds;
    BuildQuery: bounds;
    SearchQuery: bvh ray table;
    ResolutionQuery: bounds;
    OctreeQuery: bounds;
    KdQuery: bounds;
    CachedQuery: ray hits entries;
    PacketQuery: bvh rays tables;
    WideQuery: ray entries hits;

    ShadeAnswer: rays;
    SplitAnswer:;
    SearchAnswer: hit;
    CellsAnswer: hit;
    PacketAnswer: hits;
    WideAnswer: hit;
}
