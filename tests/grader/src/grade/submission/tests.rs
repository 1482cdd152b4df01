use super::*;
use std::io::Write;
use std::os::unix::fs::symlink;

const SHAPES: &str = "stage1_shapes.rs";

fn wanted() -> Vec<String> {
    vec![SHAPES.into(), "stage2_triangles.rs".into()]
}

fn write(root: &Path, files: &[(&str, &[u8])]) {
    for (path, bytes) in files {
        let path = root.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

fn remark(taken: &SubmittedFiles, file: &str) -> String {
    let of_file = taken.remarks.iter().filter(|remark| remark.file == file);
    of_file.map(|remark| remark.what.clone()).collect::<Vec<_>>().join("; ")
}

#[test]
fn a_folder_gives_the_files_that_students_write_and_says_what_it_keeps_back() {
    let root = tempfile::tempdir().unwrap();
    write(
        root.path(),
        &[
            ("ray/exercises/src/stage1_shapes.rs", b"\xef\xbb\xbfone\r\ntwo\r\n"),
            ("ray/old/src/stage1_shapes.rs", b"old"),
            ("ray/solutions/src/stage1_shapes.rs", b"answer"),
            ("ray/build.rs", b"fn main() {}"),
            ("ray/.cargo/config.toml", b"[build]"),
            ("ray/tests/golden/a.snap", b"x"),
            ("ray/exercises/src/helper.rs", b""),
            ("ray/notes.txt", b""),
        ],
    );
    let taken = take(root.path(), &wanted(), &wanted());
    assert_eq!(taken.files, BTreeMap::from([(SHAPES.into(), "one\ntwo\n".into())]));
    assert_eq!(taken.trouble, None);
    assert!(remark(&taken, "ray/exercises/src/stage1_shapes.rs").contains("byte order mark"));
    assert!(
        remark(&taken, "ray/old/src/stage1_shapes.rs")
            .contains("ray/exercises/src/stage1_shapes.rs is graded")
    );
    assert!(remark(&taken, "stage2_triangles.rs").contains("missing"));
    assert!(remark(&taken, "ray/build.rs").contains("without cargo"));
    assert!(remark(&taken, "ray/.cargo/config.toml").contains("cargo"));
    assert!(remark(&taken, "ray/tests/golden/a.snap").contains("own checks"));
    assert!(remark(&taken, "ray/exercises/src/helper.rs").contains("no exercise file has this name"));
    assert_eq!(remark(&taken, "ray/notes.txt"), "");
}

#[test]
fn links_pipes_and_other_traps_are_not_followed() {
    let root = tempfile::tempdir().unwrap();
    symlink("/dev/zero", root.path().join(SHAPES)).unwrap();
    nix::unistd::mkfifo(&root.path().join("stage2_triangles.rs"), nix::sys::stat::Mode::S_IRWXU).unwrap();
    symlink("/", root.path().join("src")).unwrap();
    let taken = take(root.path(), &wanted(), &wanted());
    assert!(taken.files.is_empty());
    assert!(remark(&taken, SHAPES).contains("link"));
    assert!(remark(&taken, "stage2_triangles.rs").contains("not a regular file"));
    assert!(taken.trouble.unwrap().contains("right folder"));
}

#[test]
fn text_that_is_none_is_refused_with_what_to_do() {
    for (bytes, says) in [
        (b"\xff\xfea\0".to_vec(), "UTF-16"),
        (b"ab\xffcd".to_vec(), "byte 2"),
        (vec![b' '; MOST_BYTES as usize + 1], "1024 KiB"),
    ] {
        let error = text(&bytes[..]).unwrap_err();
        assert!(error.contains(says), "{error}");
    }
    assert_eq!(text(&b"plain\n"[..]).unwrap(), ("plain\n".into(), None));
}

fn zipped(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
    for (path, bytes) in files {
        zip.start_file(*path, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn tarred(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut tar = tar::Builder::new(Vec::new());
    for (path, bytes) in files {
        let mut header = tar::Header::new_gnu();
        header.as_gnu_mut().unwrap().name[..path.len()].copy_from_slice(path.as_bytes());
        header.set_size(bytes.len() as u64);
        header.set_cksum();
        tar.append(&header, *bytes).unwrap();
    }
    tar.into_inner().unwrap()
}

fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gzip.write_all(bytes).unwrap();
    gzip.finish().unwrap()
}

#[test]
fn archives_give_the_same_as_folders_and_lead_nowhere() {
    let files: [(&str, &[u8]); 3] = [
        ("me-main/exercises/src/stage1_shapes.rs", b"one"),
        ("../../../tmp/stage2_triangles.rs", b"two"),
        ("me-main/build.rs", b""),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in
        [("a.zip", zipped(&files)), ("a.tar", tarred(&files)), ("a.tar.gz", gzipped(&tarred(&files)))]
    {
        fs::write(folder.path().join(name), bytes).unwrap();
        let taken = take(&folder.path().join(name), &wanted(), &wanted());
        assert_eq!(taken.files, BTreeMap::from([(SHAPES.into(), "one".into())]), "{name}");
        assert!(remark(&taken, "../../../tmp/stage2_triangles.rs").contains("out of the archive"), "{name}");
        assert!(remark(&taken, "me-main/build.rs").contains("without cargo"), "{name}");
    }
}

#[test]
fn bombs_and_rubbish_are_trouble_and_nothing_worse() {
    let folder = tempfile::tempdir().unwrap();
    let huge = vec![0; (1 << 20) + 1];
    let half = &huge[..600 << 10];
    let many: Vec<(String, &[u8])> = (0..300).map(|n| (format!("{n}.txt"), &huge[..])).collect();
    let many: Vec<(&str, &[u8])> = many.iter().map(|(name, bytes)| (name.as_str(), *bytes)).collect();
    for (name, bytes, says) in [
        ("a.zip", b"no zip at all".to_vec(), "download it again, or hand in a new .zip"),
        ("cut.tgz", gzipped(&tarred(&[(SHAPES, b"one")]))[..40].to_vec(), "download it again"),
        ("a.7z", b"7z".to_vec(), ".7z is not read here; unpack it"),
        ("a.tar", vec![7; 2000], "cannot be unpacked"),
        ("a.tgz", b"\x1f\x8b and then nothing".to_vec(), "cannot be unpacked"),
        ("bomb.tgz", gzipped(&tarred(&many)), "256 MiB"),
        ("empty.zip", zipped(&[]), "right folder"),
        ("sum.zip", zipped(&[(SHAPES, half), ("stage2_triangles.rs", half)]), "1024 KiB together"),
    ] {
        fs::write(folder.path().join(name), bytes).unwrap();
        let trouble = take(&folder.path().join(name), &wanted(), &wanted()).trouble.unwrap();
        assert!(trouble.contains(says), "{name}: {trouble}");
    }
    let nested = zipped(&[("work.zip", &zipped(&[(SHAPES, b"one")]))]);
    fs::write(folder.path().join("nested.zip"), nested).unwrap();
    let nested = take(&folder.path().join("nested.zip"), &wanted(), &wanted());
    assert!(remark(&nested, "work.zip").contains("hand in its files"));
    let long = zipped(&[(SHAPES, &huge)]);
    fs::write(folder.path().join("long.zip"), long).unwrap();
    assert!(
        remark(&take(&folder.path().join("long.zip"), &wanted(), &wanted()), SHAPES).contains("1024 KiB")
    );
}

#[test]
fn submissions_are_found_by_name_and_twins_are_distinguished() {
    let folder = tempfile::tempdir().unwrap();
    write(
        folder.path(),
        &[("ann/x", b""), ("bob.zip", b""), ("cat.tar.gz", b""), ("ann.zip", b""), ("list.csv", b"")],
    );
    symlink("/", folder.path().join("root")).unwrap();
    let (found, others) = find(folder.path()).unwrap();
    let names: Vec<&str> = found.iter().map(|one| one.student.as_str()).collect();
    assert_eq!(names.len(), 4);
    assert!(
        names.contains(&"ann")
            && names.contains(&"ann.zip")
            && names.contains(&"bob")
            && names.contains(&"cat")
    );
    assert_eq!(others.len(), 2, "the list and the link");
}

#[test]
fn the_fingerprint_is_of_all_texts_and_of_nothing_else() {
    let with = |name: &str, text: &str| SubmittedFiles {
        files: [(name.into(), text.into())].into(),
        ..SubmittedFiles::default()
    };
    let (one, other) = (with("ab", "c"), with("a", "bc"));
    assert_ne!(one.content(), other.content());
    let remarked =
        SubmittedFiles { remarks: vec![Remark { file: "x".into(), what: "y".into() }], ..with("ab", "c") };
    assert_eq!(one.content(), remarked.content());
}
