//! Shapes, transforms and the graph.

use super::{CAMERA, check_refused_with, scene_with};
use crate::files::scene::{Limits, Loaded, parse_within};
use crate::scene::Node;
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Plane, PlaneEquation, Polygon, Shape, Sphere, Triangle};
use glam::{Affine3A, Vec3};
use std::path::Path;

fn one_node(text: &str) -> Node {
    scene_with(&format!("[[nodes]]\n{text}")).nodes.remove(0)
}

#[track_caller]
fn check_node(text: &str, message: &str) {
    check_refused_with(&format!("[[nodes]]\n{text}"), &format!("s.toml:{message}"));
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
fn shapes_that_no_ray_can_hit_are_refused() {
    let shape = |text: &str, message: &str| check_node(&format!("shape = {{ {text} }}"), message);
    shape(
        "plane = { coefficients = [0, 0, 0, 1] }",
        "3:36: the first three of `coefficients` are 0, so they give no plane\nhelp: A x + B y + C z + D = 0: write, for \
         example, [0, 1, 0, -2]",
    );
    shape("plane = { coefficients = [0, 1, 0] }", "3:36: `coefficients` must be four numbers, but has 3");
    shape(
        "plane = { coefficients = [0, 1, 0, 2], normal = [0, 1, 0] }",
        "3:59: `plane` has both `coefficients` and `normal`\nhelp: give `point` and `normal`, or `coefficients` alone",
    );
    shape(
        "plane = { coefficients = [0, 1e-38, 0, 1e30] }",
        "3:36: the plane is farther away than the largest number, 3.4e38",
    );
    shape("sphere = { center = [0, 0, 0], radius = -1 }", "3:51: `radius` must be above 0, but is -1");
    shape("sphere = { center = [0, 0, 0], radus = 1 }", "3:42: unknown key `radus`; did you mean `radius`?");
    shape(
        "sphere = { center = [0, 0, 0] }",
        "3:20: `sphere` lacks `radius`\nhelp: add it, for example `radius = 1.0`",
    );
    shape("sphere = { center = [0, 0], radius = 1 }", "3:31: `center` must be three numbers, but has 2");
    shape(
        "sphere = { center = [0, 'x', 0], radius = 1 }",
        "3:35: entry 2 of `center` must be a number, but is text",
    );
    shape(
        "sphere = { center = [3e38, 0, 0], radius = 3e38 }",
        "3:20: `sphere` exceeds the largest number, 3.4e38",
    );
    shape(
        "plane = { point = [0, 0, 0], normal = [0, 0, 0] }",
        "3:49: `normal` has no length, so it gives no direction\nhelp: give a direction, for example `[0, 1, \
         0]`",
    );
    shape(
        "triangle = { a = [0, 0, 0], b = [1, 1, 1], c = [3, 3, 3] }",
        "3:22: the corners of `triangle` lie on one line, so no ray can hit it",
    );
    shape(
        "box = { min = [0, 2, 0], max = [1, 1, 1] }",
        "3:17: `min` of `box` is 2 along y, which is above `max`, 1\nhelp: exchange the two numbers",
    );
    shape(
        "box = { min = [0, 0, 0], max = [1, 0, 0] }",
        "3:17: `box` is flat along more than one axis, so no ray can hit it",
    );
    shape(
        "cone = { base = [0, 1, 0], apex = [0, 1, 0], radius = 1 }",
        "3:45: `base` and `apex` are the same point",
    );
    shape(
        "",
        "3:9: `shape` needs one of `sphere`, `plane`, `triangle`, `box`, `cylinder`, `cone`, `disk`, `polygon`, \
         `bezier`, `bspline`, `nurbs`, `mesh`, but has none",
    );
    shape("mesh = 'bunny'", "3:18: unknown mesh `bunny`\nhelp: the scene defines none");
    shape(
        "mesh = 'bunny', sphere = {}",
        "3:11: `shape` has both `sphere` and `mesh`\nhelp: delete one of the two",
    );
    check_node("mesh = 'bunny'", "3:1: `mesh` must stand inside `shape`\nhelp: write `shape = { mesh = … }`");
}

#[test]
fn polygons_are_flat() {
    let polygon = |corners: &str, message: &str| {
        check_node(&format!("shape = {{ polygon = {{ corners = [{corners}] }} }}"), &format!("3:{message}"));
    };
    polygon("[0, 0, 0], [1, 0, 0]", "33: a polygon has three corners or more, and this one has 2");
    polygon("[0, 0, 0], [1, 0, 0], [0, 0, 0]", "34: corners 3 and 1 are the same point");
    polygon(
        "[0, 0, 0], [1, 0, 0], [2, 0, 0]",
        "33: the corners lie on one line, so no ray can hit the polygon",
    );
    polygon(
        "[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]",
        "34: corner 1 does not lie in the plane of the polygon\nhelp: divide the polygon into triangles",
    );
    // With five digits and far from the origin, a slanted hexagon is not exactly flat; a straight corner is allowed.
    let far = "[1e4, 1e4, 1e4], [10001.3, 1e4, 10000.7], [10002.6, 1e4, 10001.4], [1e4, 10001.1, 1e4]";
    one_node(&format!("shape = {{ polygon = {{ corners = [{far}] }} }}"));
}

#[test]
fn a_concave_polygon_becomes_a_mesh_and_a_crossed_one_gives_a_warning() {
    let polygon = |corners: &str| {
        let text = format!("{CAMERA}[[nodes]]\nshape = {{ polygon = {{ corners = [{corners}] }} }}\n");
        let Loaded { scene, warnings } =
            parse_within(Path::new("s.toml"), &text, Limits::default()).expect("a scene");
        (scene.nodes[0].shape.clone(), scene, warnings)
    };
    let (shape, scene, warnings) = polygon("[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]");
    assert_eq!((shape, warnings), (Some(Shape::Mesh(0)), vec![]));
    let mesh = &scene.meshes[0];
    assert_eq!((mesh.mesh.triangles.len(), mesh.mesh.positions.len(), mesh.smooth), (2, 4, false));
    // A five-pointed star turns the same way at each corner, and goes around twice.
    let (shape, scene, warnings) = polygon("[0, 10, 0], [6, -8, 0], [-10, 3, 0], [10, 3, 0], [-6, -8, 0]");
    assert_eq!((shape, scene.meshes[0].mesh.triangles.len()), (Some(Shape::Mesh(0)), 3));
    assert_eq!(
        warnings[0].to_string(),
        "s.toml:3:21: the outline of the polygon crosses itself, so its triangles are a guess\n\
         help: list the corners in order around the polygon, or divide it into several"
    );
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
fn transforms_can_be_undone() {
    let steps =
        |steps: &str, message: &str| check_node(&format!("transform = [{steps}]"), &format!("3:{message}"));
    steps("{ scale = [1, 0, 1] }", "28: entry 2 of `scale` must be other than 0, but is 0");
    steps("{ scale = 0 }", "24: `scale` must be other than 0, but is 0");
    steps("{ scale = 1e20 }, { scale = 1e20 }", "13: `transform` cannot be inverted in single precision");
    steps("{ scale = 1e-20 }", "13: `transform` cannot be inverted in single precision");
    let singular = "`matrix` is singular, so rays cannot be transformed back\n\
         help: no column may be zero or a linear combination of the others";
    steps("{ matrix = [[1, 2, 3, 0], [4, 5, 6, 0], [7, 8, 9, 0]] }", &format!("25: {singular}"));
    steps(
        "{ matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
        "26: entry 1 of `matrix` must be four numbers, but has 3",
    );
    steps(
        "{ rotate = { axis = [0, 0, 0], degrees = 1 } }",
        "34: `axis` has no length, so it gives no direction\nhelp: give a direction, for example `[0, 1, 0]`",
    );
    steps(
        "{ turn = 3 }",
        "16: unknown key `turn`\nhelp: known names are `scale`, `rotate`, `translate`, `matrix`",
    );
    steps(
        "{ scale = 2, translate = [1, 0, 0] }",
        "27: entry 1 of `transform` has both `scale` and `translate`\nhelp: delete one of the two",
    );
    // Small, large and uneven scales are accepted.
    one_node("transform = [{ scale = 1e-9 }]");
    let turn = "{ rotate = { axis = [1, 2, 3], degrees = 40 } }";
    one_node(&format!("transform = [{turn}, {{ scale = [1e-3, 1, 1e3] }}, {turn}]"));
}

#[test]
fn a_moving_node_keeps_its_volume() {
    let flat = "between `transform` and `transform_end` the shape becomes flat\n\
        help: do not reflect the shape, and rotate it by less than 180 degrees";
    check_node("transform_end = [{ scale = -1 }]", &format!("3:17: {flat}"));
    let turn = |degrees: u32| {
        format!("transform_end = [{{ rotate = {{ axis = [0, 1, 0], degrees = {degrees} }} }}]")
    };
    check_node(&turn(180), &format!("3:17: {flat}"));
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
fn names_lead_somewhere() {
    check_refused_with(
        "[materials.red]\n[[nodes]]\nmaterial = 'rde'",
        "s.toml:4:12: unknown material `rde`; did you mean `red`?",
    );
    check_node("name = 'a'\nchildren = ['b']", "4:13: unknown node `b`\nhelp: known names are `a`");
    check_node("children = ['node 1']", "3:13: unknown node `node 1`\nhelp: the scene defines none");
    check_node("children = 'a'", "3:12: `children` must be a list of names, but is text");
    check_node(
        "name = 'a'\n[[nodes]]\nname = 'a'",
        "5:8: two nodes are called `a`\nhelp: give one of them another name",
    );
    check_node(
        "name = 'a'\n[[nodes]]\nchildren = ['a', 'a']",
        "5:18: 'a' is listed twice\nhelp: both would have the same place; for another place, add a parent \
         node with a `transform` around it",
    );
}

#[test]
fn loops_and_endless_graphs_are_refused() {
    check_node("name = 'a'\nchildren = ['a']", "4:13: the nodes form a loop: a -> a");
    check_node(
        "name = 'a'\nchildren = ['b']\n[[nodes]]\nname = 'b'\nchildren = ['a']",
        "7:13: the nodes form a loop: a -> b -> a",
    );
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

#[test]
fn splines_whose_numbers_do_not_fit_are_refused() {
    // The place of each error is where `at` first stands in the text.
    let check = |text: &str, at: &str, message: &str| {
        let text = format!("shape = {{ {text} }}");
        let column = text.find(at).expect("a place") + 1;
        check_node(&text, &format!("3:{column}: {message}"));
    };
    let net = "rows = [[[0,0,0], [1,0,0], [2,0,0]], [[0,1,0], [1,1,0], [2,1,0]]]";
    let bspline = |rest: &str, at: &str, message: &str| {
        check(&format!("bspline = {{ {net}, {rest} }}"), at, message);
    };
    let nurbs = |weights: &str, at: &str, message: &str| {
        check(&format!("nurbs = {{ {net}, degree = 1, weights = {weights} }}"), at, message);
    };
    bspline(
        "steps = 1",
        "[[[",
        "`rows` has 3 points along u, and degree 3 needs 4\nhelp: add points, or write a smaller `degree`",
    );
    bspline(
        "degree = 2",
        "[[[",
        "`rows` has 2 points along v, and degree 2 needs 3\nhelp: add points, or write a smaller `degree`",
    );
    bspline("degree = 8", "8 }", "`degree` must be a whole number from 1 to 7, but is 8");
    bspline(
        "degree = [1]",
        "[1]",
        "`degree` must be a whole number from 1 to 7, or two of them: along u and along v, but is a list",
    );
    bspline("degree = 1, steps = 0", "0 }", "`steps` must be a whole number from 1 to 1024, but is 0");
    check(
        "bspline = { rows = [[[0,0,0], [1,0,0]], [[0,1,0]]] }",
        "[[0,1,0]]",
        "entry 2 of `rows` has 1 points, but the first has 2\nhelp: all rows need the same number",
    );
    check("bspline = { rows = [] }", "[]", "`rows` has no points");
    check(
        "bspline = { rows = [[[1,2,3], [1,2,3]], [[1,2,3], [1,2,3]]], degree = 1 }",
        "[[[",
        "all points of the net are the same, so no ray can hit the surface",
    );
    let knots =
        |knots: &str, at: &str, message: &str| bspline(&format!("degree = 1, knots = {knots}"), at, message);
    knots(
        "[[0, 1, 2, 3, 4]]",
        "[[0, 1",
        "`knots` must be two lists of knots: along u and along v, but has 1",
    );
    knots(
        "[[0, 1, 2, 3], [0, 0, 1, 1]]",
        "[0, 1, 2, 3]",
        "5 knots are needed along u (3 points + degree 1 + 1), but there are 4",
    );
    knots(
        "[[0, 0, 1, 2, 2], [0, 3, 2, 4]]",
        "2, 4]",
        "knot 3 along v is 2, which is below the knot before it, 3\nhelp: list the knots in ascending order; equal ones \
         are allowed",
    );
    knots(
        "[[0, 0, 7, 9, 9], [0, 0, 0, 1]]",
        "0, 1]] }",
        "the knot 0 along v occurs 3 times; at an end a knot of degree 1 may occur 2 times",
    );
    knots(
        "[[-3e38, 0, 1, 2, 3e38], [0, 0, 1, 1]]",
        "[-3e38",
        "the knots along u differ by more than the largest number, 3.4e38",
    );
    nurbs(
        "[[1, 1], [1, 1]]",
        "[[1, 1]",
        "`weights` has 2 rows of 2, but `rows` has 2 rows of 3\nhelp: give one weight for each point",
    );
    nurbs("[[1, 0.0, 1], [1, 1, 1]]", "0.0", "entry 2 of `weights` must be above 0, but is 0.0");
    nurbs("[[1, -2, 1], [1, 1, 1]]", "-2", "entry 2 of `weights` must be above 0, but is -2");
    check(
        &format!("nurbs = {{ {net} }}"),
        "{ rows",
        "`nurbs` lacks `weights`\nhelp: add it, for example `weights = [[1, 1], [1, 1]]`",
    );
    // With degree 2 a knot inside may occur twice. With degree 3 the domain of the other knots ends where it begins.
    let four = "[[0,0,0], [1,0,0], [2,0,0], [3,0,1]]";
    let wide = format!("rows = [{four}, {four}, {four}, {four}]");
    check(
        &format!(
            "bspline = {{ {wide}, degree = 2, knots = [[0, 1, 5, 5, 5, 8, 9], [0, 0, 0, 1, 2, 2, 2]] }}"
        ),
        "5, 8",
        "the knot 5 along u occurs 3 times; between the ends a knot of degree 2 may occur 2 times",
    );
    check(
        &format!("bspline = {{ {wide}, knots = [[0, 0, 0, 0, 1, 1, 1, 1], [0, 1, 2, 3, 3, 4, 5, 6]] }}"),
        "[0, 1, 2",
        "the surface is empty: it extends along v from knot 4 to knot 5, which are equal",
    );
}
