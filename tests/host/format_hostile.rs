//! Files that are made to do harm: names that leave the folder, sizes that lie, streams that expand, and things
//! that are no files.
#![cfg(all(feature = "files", unix))]

use crate::encode;
use crate::files;

use encode::{bzip2, gzip, zlib};
use files::{Folder, message};
use std::os::unix::fs::symlink;
use std::path::Path;
use stratavox::format;
use stratavox::volume::{Limits, Problem, VolumeSelection};

/// The two headers that name a file, for 6 bytes.
fn headers(name: &str) -> [(&'static str, String); 4] {
    let nrrd = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 1\nencoding: raw\ndata file: ";
    let metaimage = "NDims = 3\nDimSize = 3 2 1\nElementType = MET_UCHAR\nElementDataFile = ";
    [
        ("a.nhdr", format!("{nrrd}{name}\n")),
        ("a.nhdr", format!("{nrrd}LIST\n{name}\n")),
        ("a.mhd", format!("{metaimage}{name}\n")),
        ("a.mhd", format!("{metaimage}LIST\n{name}\n")),
    ]
}

fn make_pipe(path: &Path) {
    let done = std::process::Command::new("mkfifo").arg(path).status();
    assert!(done.expect("mkfifo").success());
}

#[test]
fn a_header_names_files_in_its_own_folder_only() {
    let outside = Folder::new();
    let secret = outside.write("secret", [0; 6]);
    let folder = Folder::new();
    std::fs::create_dir(folder.path("sub")).unwrap();
    folder.write("sub/inside", [0; 6]);
    folder.write("inside", [0; 6]);
    symlink(&secret, folder.path("link")).unwrap();
    symlink(secret.parent().unwrap(), folder.path("folder-link")).unwrap();
    symlink("inside", folder.path("link-inside")).unwrap();
    make_pipe(&folder.path("pipe"));
    let relative = pathdiff(&folder, &secret);
    let mut escapes = vec![
        secret.display().to_string(),
        relative,
        "/etc/passwd".to_owned(),
        "/dev/zero".to_owned(),
        "//dev/zero".to_owned(),
        "..".to_owned(),
        "../".to_owned(),
        "./../x".to_owned(),
        "sub/../inside".to_owned(),
        "sub/../../x".to_owned(),
        "link".to_owned(),
        "folder-link/secret".to_owned(),
        "sub".to_owned(),
        ".".to_owned(),
        "pipe".to_owned(),
        "inside\0".to_owned(),
        "in\0side".to_owned(),
        "x".repeat(65_000),
        "\u{1b}[2Jinside".to_owned(),
    ];
    escapes.push("./".repeat(3000) + "inside/../inside");
    let mut refused = 0;
    for name in &escapes {
        for (file, header) in headers(name) {
            let error = folder.refused(file, &header);
            assert!(error.len() < 1200, "{} long", error.len());
            assert!(error.chars().all(|c| matches!(c, ' '..='~')), "{error:?}");
            refused += 1;
        }
    }
    assert!(refused >= 80, "{refused} escapes");
    for name in [
        "inside",
        "./inside",
        "sub/inside",
        "link-inside",
        "sub/./inside",
    ] {
        for (file, header) in headers(name) {
            folder
                .read(file, header)
                .unwrap_or_else(|e| panic!("{name}: {}", message(&e)));
        }
    }
}

/// The way from a folder to a file outside it, by `..`.
fn pathdiff(folder: &Folder, file: &Path) -> String {
    let name = file.file_name().unwrap().to_str().unwrap();
    let parent = file
        .parent()
        .unwrap()
        .file_name()
        .unwrap()
        .to_str()
        .unwrap();
    let relative = format!("../{parent}/{name}");
    assert!(folder.path(&relative).is_file(), "the escape is real");
    relative
}

#[test]
fn a_folder_a_pipe_a_device_and_an_empty_file_are_named_for_what_they_are() {
    let folder = Folder::new();
    let open = |path: &Path| {
        let error = format::open(path, &VolumeSelection::default(), &Limits::default())
            .err()
            .expect("no volume");
        message(&error)
    };
    let pipe = folder.path("a.nrrd");
    make_pipe(&pipe);
    for (path, part) in [
        (folder.path("."), "a folder"),
        (pipe, "a pipe"),
        ("/dev/zero".into(), "a device"),
        (folder.write("empty.nrrd", ""), "empty"),
        (folder.path("absent.nrrd"), "looking for the file"),
        (folder.write("a.bin", [0xff, 0, 1, 2]), "bytes ff 00 01 02"),
        (folder.write("a.txt", "hello\n"), "unknown format"),
    ] {
        let error = open(&path);
        assert!(error.contains(part), "{error}");
    }
    // A name that promises a format is asked for that format's first field.
    let error = open(&folder.write("b.nrrd", "hello\n"));
    assert!(error.contains("nrrd field `magic`"), "{error}");
    let error = open(&folder.write("b.mha", "hello\n"));
    assert!(error.contains("metaimage"), "{error}");
}

#[test]
fn what_a_file_holds_counts_and_not_what_it_is_called() {
    let folder = Folder::new();
    let nrrd = "NRRD0001\ntype: uchar\ndimension: 1\nsizes: 3\nencoding: raw\n\nabc";
    let metaimage = "NDims = 1\nDimSize = 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nabc";
    for name in ["a", "a.raw", "a.mha", "a.nii.gz"] {
        let (header, _) = folder.read(name, nrrd).unwrap();
        assert_eq!(header.format.name(), "nrrd", "{name}");
    }
    for name in ["a", "a.raw", "a.nrrd", "a.nii.gz"] {
        let (header, _) = folder.read(name, metaimage).unwrap();
        assert_eq!(header.format.name(), "metaimage", "{name}");
    }
}

#[test]
fn a_size_that_lies_is_refused_when_the_file_is_opened() {
    let folder = Folder::new();
    let mut tried = 0;
    for sizes in [
        "65535 65535 65535",
        "4294967295 4294967295 1",
        "4294967295 4294967295 4294967295",
        "1000 1000 1000",
    ] {
        for (encoding, data) in [
            ("raw", vec![0; 100]),
            ("gzip", gzip(&[0; 100])),
            ("ascii", b"0 ".repeat(100)),
            ("hex", b"00".repeat(100)),
        ] {
            let text = format!(
                "NRRD0004\ntype: double\ndimension: 3\nsizes: {sizes}\nencoding: {encoding}\nendian: big\n\n"
            );
            let path = folder.write("a.nrrd", [text.as_bytes(), &data].concat());
            let error = format::open(&path, &VolumeSelection::default(), &Limits::default())
                .err()
                .expect(sizes);
            let told = matches!(
                error.problem,
                Problem::Size { .. } | Problem::TooFewEncoded { .. } | Problem::Invalid { .. }
            );
            assert!(told, "{sizes} {encoding}: {}", message(&error));
            tried += 1;
        }
        let text = format!(
            "NDims = 3\nDimSize = {sizes}\nElementType = MET_DOUBLE\nCompressedData = True\nElementDataFile = LOCAL\n"
        );
        let path = folder.write("a.mha", [text.as_bytes(), &zlib(&[0; 100])].concat());
        assert!(
            format::open(&path, &VolumeSelection::default(), &Limits::default()).is_err(),
            "{sizes}"
        );
    }
    assert_eq!(tried, 16);
}

#[test]
fn a_stream_that_expands_beyond_its_promise_is_stopped_there() {
    let folder = Folder::new();
    let zeros = vec![0; 64 << 20];
    for (encoding, data) in [("gzip", gzip(&zeros)), ("bzip2", bzip2(&zeros))] {
        assert!(data.len() < 1 << 17, "{encoding}: {}", data.len());
        let text = format!(
            "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 10 10 10\nencoding: {encoding}\n\n"
        );
        let error = folder.refused("a.nrrd", [text.as_bytes(), &data].concat());
        assert!(
            error.contains("promises 1000 bytes of voxels, found"),
            "{encoding}: {error}"
        );
        // As promised, but above the limit.
        let text = text.replace("10 10 10", "4096 4096 4");
        let path = folder.write("a.nrrd", [text.as_bytes(), &data].concat());
        let limits = Limits {
            max_bytes: 1 << 20,
            ..Limits::default()
        };
        let source = format::open(&path, &VolumeSelection::default(), &limits).unwrap();
        let error = source
            .read(Default::default(), source.header().whole())
            .unwrap_err();
        assert!(
            matches!(error.problem, Problem::Limit { .. }),
            "{}",
            message(&error)
        );
    }
}

#[test]
fn a_header_without_end_is_read_to_its_limit_only() {
    let folder = Folder::new();
    let limits = Limits {
        max_header_bytes: 10_000,
        ..Limits::default()
    };
    for text in [
        "NRRD0004\n# ".to_owned() + &"x".repeat(20_000),
        "NRRD0004\n".to_owned() + &"# x\n".repeat(5_000),
        "NDims = 3\nComment = ".to_owned() + &"x".repeat(20_000),
        "NDims = 3\nDimSize = 1 1 1\nElementType = MET_UCHAR\nElementDataFile = LIST\n".to_owned()
            + &"x\n".repeat(9_000),
    ] {
        let path = folder.write("a", &text);
        let error = format::open(&path, &VolumeSelection::default(), &limits)
            .err()
            .expect("too long");
        assert!(
            matches!(
                error.problem,
                Problem::Limit {
                    limit_bytes: 10_000,
                    ..
                }
            ),
            "{}",
            message(&error)
        );
    }
}

#[test]
fn a_file_that_shrinks_between_opening_and_reading_is_refused() {
    let folder = Folder::new();
    let text = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n\n";
    let path = folder.write("a.nrrd", text.to_owned() + "abcdef");
    let source = format::open(&path, &VolumeSelection::default(), &Limits::default()).unwrap();
    folder.write("a.nrrd", text.to_owned() + "abc");
    let error = source
        .read(Default::default(), source.header().whole())
        .unwrap_err();
    assert!(
        message(&error).contains("promises 6 bytes of voxels, found 3"),
        "{}",
        message(&error)
    );
}
