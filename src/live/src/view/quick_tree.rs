//! The structure of the pictures that code without optimisation renders. The surface area heuristic sorts all primitives three
//! times per level, which takes such code more than 20 s for 352,800 triangles; a median and larger leaves take it a second. The picture is
//! the same with every split, and the finished picture uses that of the scene.

use raykata::scene::{Accelerator, Quality, Split};
use std::path::Path;

/// The number of primitives per leaf. It saves four levels of the tree.
const LEAF_SIZE: u32 = 32;

/// The quality with a split that is quickly built; `None` if the scene needs none, or if no such split is written.
pub fn quickly_built(root: &Path, quality: &Quality) -> Option<Quality> {
    let is_written = |file: &str, name: &str| {
        let text = std::fs::read_to_string(live::exercises(root).join(file)).unwrap_or_default();
        let body = text.split("\npub fn ").find(|function| function.starts_with(&format!("{name}(")));
        body.is_some_and(|body| !body.contains("todo!("))
    };
    let of_stage_3 = |name: &str| is_written("stage3_build.rs", name);
    let builds = match quality.accelerator {
        Accelerator::Bvh => true,
        // With stage 12, such a scene has the wide tree, which has no other splits.
        Accelerator::Auto => !is_written("stage12_build.rs", "build_binned"),
        _ => false,
    };
    if quality.split != Split::SurfaceArea
        || !builds
        || !of_stage_3("build")
        || !of_stage_3("split_object_median")
    {
        return None;
    }
    // The spatial median is quicker. Where it puts all primitives on one side, it needs the other one.
    let split = if of_stage_3("split_spatial_median") { Split::SpatialMedian } else { Split::ObjectMedian };
    Some(Quality { split, leaf_size: LEAF_SIZE, ..*quality })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_written_replaces_the_heuristic() {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(root.path().join("exercises/src")).unwrap();
        let functions = ["split_object_median", "split_spatial_median", "build"];
        let quality = Quality { accelerator: Accelerator::Bvh, ..Quality::default() };
        let split = |written: &[&str]| {
            let body = |name: &&str| {
                let body = if written.contains(name) { "1" } else { "todo!(\"write it\")" };
                format!("\n/// Its documentation.\npub fn {name}(n: u8) -> u8 {{\n    {body}\n}}\n")
            };
            let text: String = functions.iter().map(body).collect();
            std::fs::write(root.path().join("exercises/src/stage3_build.rs"), text).unwrap();
            quickly_built(root.path(), &quality).map(|quality| quality.split)
        };
        assert_eq!(split(&functions), Some(Split::SpatialMedian));
        assert_eq!(split(&["build", "split_object_median"]), Some(Split::ObjectMedian));
        for written in [&["build"][..], &["build", "split_spatial_median"], &["split_object_median"], &[]] {
            assert_eq!(split(written), None, "{written:?}");
        }
        assert_eq!(split(&functions), Some(Split::SpatialMedian));
        let chosen = Quality { split: Split::ObjectMedian, ..quality };
        assert_eq!(quickly_built(root.path(), &chosen), None, "the scene has a quick split");
        let grid = Quality { accelerator: Accelerator::Grid, ..quality };
        assert_eq!(quickly_built(root.path(), &grid), None);
    }
}
