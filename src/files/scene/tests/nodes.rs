//! Shapes, transforms and the graph.

use super::{check_refused_with, scene_with};
use crate::scene::Node;
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Plane, PlaneEquation, Polygon, Shape, Sphere, Triangle};
use glam::{Affine3A, Vec3};

fn one_node(text: &str) -> Node {
    scene_with(&format!("[[nodes]]\n{text}")).nodes.remove(0)
}

#[test]
fn shapes_arrive_as_written() {
    let shape = |text: &str| one_node(&format!("shape = {{ {text} }}")).shape.expect("a shape");
    let (base, apex, radius) = (Vec3::ZERO, Vec3::Y, 2.0);
    assert_eq!(
        shape("sphere = { center = [0, 1, 0], radius = 2 }"),
        Shape::Sphere(Sphere { center: Vec3::Y, radius })
    );
    assert_eq!(
        shape("plane = { point = [0, 1, 0], normal = [0, 0, 1e-30] }"),
        Shape::Plane(Plane { point: Vec3::Y, normal: Vec3::Z })
    );
    assert_eq!(
        shape("plane = { coefficients = [0, -2, 0, 6] }"),
        Shape::PlaneEquation(PlaneEquation { normal: -2.0 * Vec3::Y, d: 6.0 })
    );
    assert_eq!(
        shape("triangle = { a = [0, 0, 0], b = [1, 0, 0], c = [0, 1, 0] }"),
        Shape::Triangle(Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y })
    );
    assert_eq!(
        shape("box = { min = [0, 0, 0], max = [1, 0, 1] }"),
        Shape::Cuboid(Cuboid { min: Vec3::ZERO, max: Vec3::new(1.0, 0.0, 1.0) })
    );
    assert_eq!(
        shape("cylinder = { base = [0, 0, 0], top = [0, 1, 0], radius = 2 }"),
        Shape::Cylinder(Cylinder { base, top: apex, radius })
    );
    assert_eq!(
        shape("cone = { base = [0, 0, 0], apex = [0, 1, 0], radius = 2 }"),
        Shape::Cone(Cone { base, apex, radius })
    );
    assert_eq!(
        shape("disk = { center = [0, 0, 0], normal = [0, 1, 0], radius = 2 }"),
        Shape::Disk(Disk { center: base, normal: Vec3::Y, radius })
    );
    assert_eq!(
        shape("polygon = { corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }"),
        Shape::Polygon(Polygon { corners: vec![Vec3::ZERO, Vec3::X, Vec3::Y] })
    );
}

#[test]
fn a_polygon_may_be_flat_up_to_rounding() {
    // With five digits and far from the origin, a slanted hexagon is not exactly flat; a straight corner is allowed.
    let far = "[1e4, 1e4, 1e4], [10001.3, 1e4, 10000.7], [10002.6, 1e4, 10001.4], [1e4, 10001.1, 1e4]";
    one_node(&format!("shape = {{ polygon = {{ corners = [{far}] }} }}"));
}

#[test]
fn a_concave_polygon_becomes_a_mesh() {
    let corners = "[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]";
    let scene = scene_with(&format!("[[nodes]]\nshape = {{ polygon = {{ corners = [{corners}] }} }}\n"));
    assert_eq!(scene.nodes[0].shape, Some(Shape::Mesh(0)));
    let mesh = &scene.meshes[0];
    assert_eq!((mesh.mesh.triangles.len(), mesh.mesh.positions.len(), mesh.smooth), (2, 4, false));
}

#[test]
fn transforms_act_in_the_order_listed() {
    let moved = |steps: &str, point: Vec3| {
        one_node(&format!("transform = [{steps}]")).transform.transform_point3(point)
    };
    let (scale, translate) = ("{ scale = 2 }", "{ translate = [1, 0, 0] }");
    assert_eq!(moved(&format!("{scale}, {translate}"), Vec3::X), Vec3::new(3.0, 0.0, 0.0));
    assert_eq!(moved(&format!("{translate}, {scale}"), Vec3::X), Vec3::new(4.0, 0.0, 0.0));
    // Seen from the tip of the axis, a quarter turn about z takes x to y.
    let quarter = moved("{ rotate = { axis = [0, 0, 9], degrees = 90 } }", Vec3::X);
    assert!((quarter - Vec3::Y).length() < 1e-7);
    let matrix = "{ matrix = [[1, 2, 3, 4], [0, 1, 0, 5], [0, 0, -1, 6]] }";
    assert_eq!(moved(matrix, Vec3::ONE), Vec3::new(10.0, 6.0, 5.0));
    assert_eq!(moved("", Vec3::ONE), Vec3::ONE);

    let node = one_node("transform_end = [{ translate = [0, 2, 0] }]");
    assert_eq!(
        (node.transform, node.transform_end),
        (Affine3A::IDENTITY, Some(Affine3A::from_translation(2.0 * Vec3::Y)))
    );
    assert_eq!(one_node("").transform_end, None);
}

#[test]
fn small_large_and_uneven_scales_are_accepted() {
    one_node("transform = [{ scale = 1e-9 }]");
    let turn = "{ rotate = { axis = [1, 2, 3], degrees = 40 } }";
    one_node(&format!("transform = [{turn}, {{ scale = [1e-3, 1, 1e3] }}, {turn}]"));
}

#[test]
fn a_moving_node_keeps_its_volume() {
    let turn = |degrees: u32| {
        format!("transform_end = [{{ rotate = {{ axis = [0, 1, 0], degrees = {degrees} }} }}]")
    };
    one_node(&turn(170));
    one_node("transform = [{ scale = 1e-3 }]\ntransform_end = [{ scale = 1e3 }]");
}

#[test]
fn a_node_may_stand_in_several_places() {
    let scene = scene_with(
        "[materials.red]\n[[nodes]]\nname = 'car'\nchildren = ['front', 'rear']\nmaterial = 'red'\n\
         [[nodes]]\nname = 'front'\nchildren = ['wheel']\n[[nodes]]\nname = 'rear'\nchildren = ['wheel']\n\
         [[nodes]]\nname = 'wheel'\n[[nodes]]\n",
    );
    let children: Vec<&[usize]> = scene.nodes.iter().map(|node| &node.children[..]).collect();
    assert_eq!(children, [&[1, 2][..], &[3], &[3], &[], &[]]);
    assert_eq!(scene.roots, [0, 4]);
    assert_eq!((scene.nodes[0].material, scene.nodes[1].material), (Some(1), None));
    assert_eq!(scene.nodes[4].name, "node 5");
}

#[test]
fn loops_and_endless_graphs_are_refused() {
    let chain = |length: usize, children: &dyn Fn(usize) -> String| {
        let node = |i: usize| format!("[[nodes]]\nname = 'n{i}'\nchildren = [{}]\n", children(i));
        (0..length).map(node).collect::<String>() + &format!("[[nodes]]\nname = 'n{length}'\n")
    };
    scene_with(&chain(63, &|i| format!("'n{}'", i + 1)));
    // Levels are counted from the end of the chain, so its third node is the first with 65 levels.
    let deep = chain(66, &|i| format!("'n{}'", i + 1));
    check_refused_with(&deep, "s.toml:10:13: nodes are nested more than 64 deep");
    let around = chain(50_000, &|i| format!("'n{}'", (i + 1) % 50_000));
    let looped = "n0 -> n1 -> n2 -> n3 -> n4 -> n5 -> n6 -> n7 -> … -> n49999 -> n0";
    check_refused_with(&around, &format!("s.toml:150001:13: the nodes form a loop: {looped}"));

    // Each level contains the next one twice, so that 25 levels have 2^25 instances.
    let mut doubled = String::new();
    for level in 0..25 {
        for side in ["l", "r"] {
            let next = level + 1;
            doubled += &format!("[[nodes]]\nname = '{side}{level}'\nchildren = ['l{next}', 'r{next}']\n");
        }
    }
    for side in ["l", "r"] {
        doubled += &format!("[[nodes]]\nname = '{side}25'\n");
        doubled += "shape = { sphere = { center = [0, 0, 0], radius = 1 } }\n";
    }
    check_refused_with(&doubled, "s.toml:4:19: repeated nodes add up to more than 16777216 shapes");
}

#[test]
fn splines_arrive_as_written() {
    let shape = |text: &str| one_node(&format!("shape = {{ {text} }}")).shape.expect("a shape");
    let net = "rows = [[[0, 0, 0], [1, 0, 0], [2, 0, 1]], [[0, 1, 0], [1, 1, 0], [2, 1, 0]]]";
    let Shape::Nurbs { patch, steps } = shape(&format!("bspline = {{ {net}, degree = [2, 1] }}")) else {
        panic!("a spline")
    };
    assert_eq!((patch.degrees, steps), ([2, 1], 8));
    assert_eq!(patch.knots, [vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]]);
    assert_eq!(patch.rows[0][2], Vec3::new(2.0, 0.0, 1.0));
    assert_eq!(patch.weights, [[1.0; 3]; 2]);
    let rest = "weights = [[1, 2, 1], [1, 0.5, 1]], degree = 1, steps = 3, knots = [[0, 1, 2, 3, 9], [-1, -1, 5, 5]]";
    let Shape::Nurbs { patch, steps } = shape(&format!("nurbs = {{ {net}, {rest} }}")) else {
        panic!("a spline")
    };
    assert_eq!((patch.degrees, steps, patch.weights[1][1]), ([1, 1], 3, 0.5));
    // The domain is from the second knot to the last but one.
    assert_eq!(patch.spans(0), [[1.0, 2.0], [2.0, 3.0]]);
    assert_eq!(patch.spans(1), [[-1.0, 5.0]]);
}
