//! The reference loses no box, and starts every secondary ray in front of its surface. The tables show when one does not.

use grader::kits::{self, Need, Source, Which};
use judge::boxes_and_offsets::tables;

#[test]
fn the_reference_loses_no_box_and_a_fixed_offset_is_wrong() {
    let root = kits::root().expect("a kit");
    let reference = Source::prepare(&root, Which::Solutions, Need::Frames).expect("it builds").fresh();
    let tables = tables(&*reference, 2000, 1);
    let [boxes, offsets] = &tables[..] else { panic!("two tables") };
    let row = |name: &str| {
        let rows = boxes.rows.iter().chain(&offsets.rows);
        rows.clone().find(|row| row.0 == name).unwrap_or_else(|| panic!("no row {name}")).1.join(", ")
    };
    // The slab test of stage 3 widens its exit for hits in front of the ray only.
    assert_eq!(row("kit: slab"), "0, 19.07");
    assert_eq!(row("kit: conservative_slab"), "0, 0");
    assert_eq!(row("kit: offset_origin"), "0 / 0, 0 / 0, 0 / 0, 0 / 0");
    // A distance of 0.0001 is far at coordinates of 0.001 and 1. At a million it is less than a float, so about half of the
    // rounded points are behind the surface.
    let fixed = row("always by 0.0001");
    assert!(fixed.starts_with("0 / 100.00, 0 / 100.00, 0 / 0, "), "{fixed}");
    assert!(!fixed.ends_with(" 0 / 0"), "{fixed}");
}
