//! Tests of the PLY reader.

mod accepted;
mod refused;

use super::parse;
use crate::files::error::LoadError;
use crate::mesh::Mesh;
use std::path::Path;

/// The header of a simple mesh.
const PLAIN: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                     element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const CORNERS: &str = "0 0 0\n1 0 0\n0 1 0\n";

fn parsed(bytes: impl AsRef<[u8]>) -> Result<Mesh, LoadError> {
    parse(Path::new("a.ply"), bytes.as_ref()).map(|file| file.mesh.mesh.as_ref().clone())
}

#[track_caller]
fn mesh(bytes: impl AsRef<[u8]>) -> Mesh {
    parsed(bytes).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn error(bytes: impl AsRef<[u8]>) -> String {
    parsed(bytes).expect_err("the file should be refused").to_string()
}

/// The plain mesh with its header changed.
#[track_caller]
fn plain_with(from: &str, to: &str) -> String {
    let text = format!("{PLAIN}{CORNERS}3 0 1 2\n");
    assert!(text.contains(from), "nothing to replace");
    text.replacen(from, to, 1)
}

/// For any bytes, the result is a valid mesh or an error.
#[test]
fn no_bytes_make_the_reader_panic() {
    let ascii = format!("{PLAIN}{CORNERS}3 0 1 2\n");
    let mut binary = PLAIN.replace("ascii", "binary_big_endian").into_bytes();
    [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().for_each(|v| binary.extend(v.to_be_bytes()));
    binary.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    for original in [ascii.as_bytes(), &binary] {
        assert!(parsed(original).is_ok());
        crate::files::ply::text::mutations(original, |bytes| {
            if let Ok(mesh) = parsed(bytes) {
                mesh.validate().expect("an accepted mesh is valid");
            }
        });
    }
}
