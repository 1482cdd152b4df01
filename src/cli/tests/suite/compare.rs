//! Runs the command `compare`.

use super::program_runs::said;

#[test]
fn structures_are_compared_side_by_side() {
    let out = tempfile::tempdir().expect("a folder");
    let folder = out.path().display();
    let said = said(&format!("compare scenes/graph.toml --size 32x20 --rounds 1 --level 2 --out {folder}"));
    let rows = [
        "brute force",
        "bounding boxes",
        "bounding spheres",
        "cached bounding boxes",
        "bvh, object median",
        "bvh, spatial median",
        "bvh, surface area",
        "bvh both children",
        "cached bvh",
        "packet bvh",
        "wide bvh",
        "grid",
        "octree",
        "octree by cells",
        "octree by neighbours",
        "kd tree",
        "bsp",
        "polygon bsp",
    ];
    for row in rows {
        assert!(said.lines().any(|line| line.starts_with(&format!("{row}  "))), "no line for {row}:\n{said}");
        let picture = out.path().join(format!("tests-{}.png", row.replace(", ", "-").replace(' ', "-")));
        assert!(std::fs::read(&picture).is_ok_and(|png| png.starts_with(b"\x89PNG")), "{picture:?}");
    }
    assert!(said.contains("\nall pictures are the same, bit by bit\n"), "{said}");
    assert!(said.lines().all(|line| line.starts_with("pictures,") || line.chars().count() <= 80), "{said}");
    // Each column in which smaller is better has a mark.
    assert!(said.matches('*').count() > 4, "{said}");
    // Structures with cells or boxes are drawn; brute force has none.
    let drawn = |row: &&str| out.path().join(format!("cells-{row}.png")).exists();
    assert!(["bsp", "polygon-bsp", "grid", "kd-tree", "bounding-spheres"].iter().all(drawn));
    assert!(!drawn(&"brute-force"));

    let numbers = std::fs::read_to_string(out.path().join("compare.json")).expect("numbers");
    let numbers: serde_json::Value = serde_json::from_str(&numbers).expect("JSON");
    assert_eq!(numbers.as_array().map(Vec::len), Some(rows.len()));
    let asked = |row: usize| numbers[row]["counts"]["primitive_tests"].as_u64().expect("a count");
    assert!(asked(0) > asked(5), "brute force makes more tests than a hierarchy");
    let plot = std::fs::read_to_string(out.path().join("compare.svg")).expect("a plot");
    assert!(rows.iter().all(|row| plot.contains(&format!(">{row}<"))), "{plot}");
}

#[test]
fn savings_heuristics_grids_methods_and_instances_have_tables() {
    for (of, rows) in [
        ("savings", &["graph, boxes, skip and sort", "graph, boxes, skip, cached child"][..]),
        ("heuristics", &["without stop at 60 %", "easy, few straddlers"]),
        ("grids", &["grid, 256 along"]),
        ("methods", &["triangles, inside by direction", "spheres, stable roots"]),
        ("instances", &["copies"]),
    ] {
        let said = said(&format!("compare scenes/graph.toml --size 16x10 --rounds 1 --of {of} --table"));
        assert!(rows.iter().all(|row| said.contains(row)), "{of}: {said}");
    }
}
