// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    use std::path::Path;
    let scene = raykata::scene::load::load(Path::new("@root@/scenes/stage1.toml"));
    let mesh = raykata::scene::obj::read(Path::new("@root@/scenes/meshes/tree.obj"));
    scene.is_ok() || mesh.is_ok()
}
