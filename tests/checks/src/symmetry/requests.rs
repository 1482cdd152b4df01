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

    |query: SphereQuery, symmetry| {
        SphereQuery { ray: query.ray.turn(symmetry), sphere: query.sphere.turn(symmetry) }
    };
    |query: PlaneQuery, symmetry| {
        PlaneQuery { ray: query.ray.turn(symmetry), plane: query.plane.turn(symmetry) }
    };
    |query: PlaneEquationQuery, symmetry| {
        PlaneEquationQuery { ray: query.ray.turn(symmetry), plane: query.plane.turn(symmetry) }
    };
    |query: TriangleQuery, symmetry| {
        TriangleQuery { ray: query.ray.turn(symmetry), triangle: query.triangle.turn(symmetry) }
    };
    |hit: TriangleHit, symmetry| TriangleHit { t: symmetry.length(hit.t), ..*hit };
    |query: SolidQuery<Cylinder>, symmetry| {
        SolidQuery { ray: query.ray.turn(symmetry), solid: query.solid.turn(symmetry) }
    };
    |query: SolidQuery<Cone>, symmetry| {
        SolidQuery { ray: query.ray.turn(symmetry), solid: query.solid.turn(symmetry) }
    };
    |hit: SolidHit, symmetry| {
        SolidHit { t: symmetry.length(hit.t), normal: symmetry.direction(hit.normal) }
    };
    |surface: Surface, symmetry| Surface {
        point: symmetry.point(surface.point),
        error: symmetry.point(surface.error).abs(),
        geometric_normal: symmetry.direction(surface.geometric_normal),
        shading_normal: symmetry.direction(surface.shading_normal),
    };
    |light: LightSample, symmetry| LightSample {
        direction: symmetry.direction(light.direction),
        distance: symmetry.length(light.distance),
        ..*light
    };
    |query: ShadeQuery, symmetry| ShadeQuery {
        surface: query.surface.turn(symmetry),
        to_viewer: symmetry.direction(query.to_viewer),
        lights: query.lights.turn(symmetry),
        ..query.clone()
    };
    |answer: ShadeAnswer, symmetry| ShadeAnswer { rays: answer.rays.turn(symmetry), ..answer.clone() };
    |query: ScatterQuery, symmetry| {
        let [direction, normal] = [query.direction, query.normal].map(|v| symmetry.direction(v));
        ScatterQuery { direction, normal, ..query.clone() }
    };
    |ray: SecondaryRay, symmetry| {
        SecondaryRay { direction: symmetry.direction(ray.direction), ..*ray }
    };

    |query: SlabQuery, symmetry| {
        SlabQuery { ray: query.ray.turn(symmetry), bounds: query.bounds.turn(symmetry) }
    };
    |primitive: PrimitiveRef, symmetry| PrimitiveRef {
        bounds: primitive.bounds.turn(symmetry),
        centroid: symmetry.point(primitive.centroid),
        ..*primitive
    };
    |answer: SplitAnswer, _symmetry| answer.clone();
    |query: BuildQuery, symmetry| BuildQuery { bounds: query.bounds.turn(symmetry), ..query.clone() };
    |bvh: Bvh, symmetry| {
        let mut bvh = bvh.clone();
        bvh.nodes.iter_mut().for_each(|node| node.bounds = node.bounds.turn(symmetry));
        bvh
    };
    |table: Table, symmetry| {
        Table { boxes: table.boxes.turn(symmetry), primitives: table.primitives.turn(symmetry) }
    };
    |query: SearchQuery, symmetry| SearchQuery {
        bvh: query.bvh.turn(symmetry),
        ray: query.ray.turn(symmetry),
        table: query.table.turn(symmetry),
    };
    |hit: PrimitiveHit, symmetry| PrimitiveHit { t: symmetry.length(hit.t), ..*hit };
    |answer: SearchAnswer, symmetry| SearchAnswer { hit: answer.hit.turn(symmetry), ..*answer };
    |found: bool, _symmetry| *found;

    |query: ResolutionQuery, symmetry| {
        ResolutionQuery { bounds: query.bounds.turn(symmetry), ..*query }
    };
    |resolution: UVec3, symmetry| symmetry.resolution(*resolution);
    |query: OctreeQuery, symmetry| OctreeQuery { bounds: query.bounds.turn(symmetry), ..query.clone() };
    |octree: Octree, symmetry| octree.turned(symmetry).0;
    |query: KdQuery, symmetry| KdQuery { bounds: query.bounds.turn(symmetry), ..query.clone() };
    |tree: KdTree, symmetry| tree.turned(symmetry).0;
    |query: BspQuery, symmetry| {
        let turn = |hull: &Vec<Vec3>| hull.iter().map(|corner| symmetry.point(*corner)).collect();
        BspQuery { hulls: query.hulls.iter().map(turn).collect(), ..query.clone() }
    };
    |bsp: Bsp, symmetry| bsp.turned(symmetry).0;
    |bsp: PolygonBsp, symmetry| bsp.turned(symmetry).0;
    |answer: CellsAnswer, symmetry| CellsAnswer { hit: answer.hit.turn(symmetry), ..answer.clone() };
    |query: CachedQuery, symmetry| CachedQuery {
        ray: query.ray.turn(symmetry),
        hits: query.hits.turn(symmetry),
        entries: query.entries.turn(symmetry),
        ..*query
    };
    |query: PacketQuery, symmetry| PacketQuery {
        bvh: query.bvh.turn(symmetry),
        rays: query.rays.turn(symmetry),
        tables: query.tables.turn(symmetry),
    };
    |answer: PacketAnswer, symmetry| PacketAnswer { hits: answer.hits.turn(symmetry), ..answer.clone() };

    |tree: FlatTree, symmetry| {
        let mut tree = tree.clone();
        for node in &mut tree.nodes {
            let bounds = node.bounds().turn(symmetry);
            (node.low, node.high) = (bounds.min, bounds.max);
        }
        tree
    };
    |query: WideQuery, symmetry| WideQuery {
        tree: query.tree.clone(),
        ray: query.ray.turn(symmetry),
        entries: query.entries.iter().map(|entries| entries.map(|t| symmetry.length(t))).collect(),
        hits: query.hits.turn(symmetry),
    };
    |answer: WideAnswer, symmetry| WideAnswer { hit: answer.hit.turn(symmetry), ..answer.clone() };
}
