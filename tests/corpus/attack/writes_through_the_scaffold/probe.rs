// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    use std::path::Path;
    let film = raykata::film::Film::new(4, 4);
    film.write_png(Path::new("@beside@/marks.png"), |_| 0).is_ok() || film.write_hdr(Path::new("here.hdr")).is_ok()
}
