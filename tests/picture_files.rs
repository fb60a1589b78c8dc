//! Pictures in files: their numbers, and that a file appears whole or not at all.

#![cfg(all(feature = "png", feature = "exr"))]

use std::path::{Path, PathBuf};
use std::process::Command;
use stratavox::color::ColorSpace;
use stratavox::picture::compare::{Comparison, Numbers};
use stratavox::picture::{
    BitDepth, Layer, LayerKind, OutputProblem, Picture, PictureProblem, WriteOptions, read_image,
    write_picture,
};

const EIGHT: WriteOptions = WriteOptions {
    bit_depth: BitDepth::Eight,
    force: false,
};
const SIXTEEN: WriteOptions = WriteOptions {
    bit_depth: BitDepth::Sixteen,
    force: false,
};
const FORCE: WriteOptions = WriteOptions {
    bit_depth: BitDepth::Eight,
    force: true,
};

fn picture(width: u32, pixels: Vec<[f32; 4]>) -> Picture {
    Picture {
        width,
        height: pixels.len() as u32 / width,
        pixels,
        color_space: ColorSpace::Linear,
        layers: vec![],
    }
}

/// 5 x 3 pixels, alpha from 0 to 1, and all layers, one of them with holes.
fn rich() -> Picture {
    let pixels = (0..15).map(|i| {
        let alpha = i as f32 / 14.0;
        [alpha * 0.9, alpha * 0.25, alpha * alpha * 0.5, alpha]
    });
    let layers = LayerKind::ALL
        .into_iter()
        .enumerate()
        .map(|(n, kind)| Layer {
            kind,
            values: (0..15)
                .map(|i| {
                    if n == 1 && i % 4 == 0 {
                        f32::NAN
                    } else {
                        n as f32 * 1e5 + i as f32
                    }
                })
                .collect(),
        });
    Picture {
        layers: layers.collect(),
        ..picture(5, pixels.collect())
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn png_codes_are_those_of_the_sampling_law() {
    // (linear premultiplied, 8-bit codes): white, black, nothing, colour without alpha, half-covered
    // light 0.214041 = sRGB 0.5 = 127.5 (just above: up, just below: down), too bright, below 0, no number.
    let cases = [
        ([1.0, 1.0, 1.0, 1.0], [255, 255, 255, 255]),
        ([0.0, 0.0, 0.0, 1.0], [0, 0, 0, 255]),
        ([0.0, 0.0, 0.0, 0.0], [0, 0, 0, 0]),
        ([0.5, 0.5, 0.5, 0.0], [0, 0, 0, 0]),
        ([0.107_021, 0.107_020, 0.0, 0.5], [128, 127, 0, 128]),
        ([3.0, -1.0, f32::NAN, 2.0], [255, 0, 0, 255]),
        // The linear part of the curve: 0.003 x 12.92 x 255 = 9.88.
        ([0.003, 0.003, 0.003, 1.0], [10, 10, 10, 255]),
    ];
    for (pixel, wanted) in cases {
        let found = picture(1, vec![pixel]).codes(255)[0];
        assert_eq!(found, wanted, "{pixel:?}");
    }
    let display = Picture {
        color_space: ColorSpace::Display,
        ..picture(1, vec![[0.25, 0.1, 0.0, 0.5]])
    };
    assert_eq!(display.codes(255)[0], [128, 51, 0, 128]);
    assert_eq!(display.codes(65_535)[0], [32_768, 13_107, 0, 32_768]);
}

#[test]
fn png_files_hold_the_codes_and_say_that_they_are_srgb() {
    let folder = tempfile::tempdir().unwrap();
    for (name, options, max) in [("8.png", EIGHT, 255), ("16.PNG", SIXTEEN, 65_535)] {
        let path = folder.path().join(name);
        write_picture(&rich(), &path, options).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert!(
            bytes.windows(4).any(|word| word == b"sRGB"),
            "{name} has no sRGB chunk"
        );
        let image = read_image(&path).unwrap();
        assert_eq!((image.width, image.height), (5, 3));
        assert_eq!(image.numbers, Numbers::StraightSrgb);
        for (found, wanted) in image.pixels.iter().zip(rich().codes(max)) {
            let found = found.map(|x| (x * f32::from(max)).round() as u16);
            assert_eq!(found, wanted, "{name}");
        }
    }
}

#[test]
fn npy_files_are_what_numpy_writes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.npy");
    write_picture(&rich(), &path, EIGHT).unwrap();
    assert_eq!(
        names(folder.path()),
        [
            "out.depth.npy",
            "out.npy",
            "out.samples.npy",
            "out.transmittance.npy",
            "out.value.npy"
        ]
    );
    let bytes = std::fs::read(&path).unwrap();
    // As numpy.save writes float32 of (3, 5, 4): 128 bytes of header.
    let header =
        b"\x93NUMPY\x01\x00v\x00{'descr': '<f4', 'fortran_order': False, 'shape': (3, 5, 4), }";
    assert!(
        bytes.starts_with(header),
        "{:?}",
        String::from_utf8_lossy(&bytes[..128])
    );
    assert_eq!((bytes[127], bytes.len()), (b'\n', 128 + 15 * 16));
    let image = read_image(&path).unwrap();
    assert_eq!(
        (image.pixels, image.numbers),
        (rich().pixels, Numbers::Premultiplied)
    );
    let depth = read_image(&folder.path().join("out.depth.npy")).unwrap();
    assert_eq!(
        (depth.width, depth.height, depth.numbers),
        (5, 3, Numbers::Plain)
    );
    let values = depth.pixels.iter().map(|pixel| pixel[0].to_bits());
    assert!(values.eq(rich().layers[1].values.iter().map(|x| x.to_bits())));
}

#[test]
fn exr_files_hold_the_same_floats_and_a_channel_for_each_layer() {
    use exr::prelude::*;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.exr");
    write_picture(&rich(), &path, EIGHT).unwrap();
    let image = read_image(&path).unwrap();
    assert_eq!((image.width, image.height), (5, 3));
    assert_eq!(
        (image.pixels, image.numbers),
        (rich().pixels, Numbers::Premultiplied)
    );
    let layer = read_first_flat_layer_from_file(&path).unwrap().layer_data;
    let channels = layer.channel_data.list;
    let found: Vec<String> = channels
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    assert_eq!(
        found,
        [
            "A",
            "B",
            "G",
            "R",
            "depth",
            "samples",
            "transmittance",
            "value"
        ]
    );
    for layer in rich().layers {
        let channel = channels
            .iter()
            .find(|c| c.name.eq(layer.kind.name()))
            .unwrap();
        let found = channel.sample_data.values_as_f32().map(f32::to_bits);
        assert!(
            found.eq(layer.values.iter().map(|x| x.to_bits())),
            "{:?}",
            layer.kind
        );
    }
}

#[test]
fn display_numbers_become_light_in_float_files_only() {
    let folder = tempfile::tempdir().unwrap();
    // sRGB 0.5, half covered: light 0.214041 times 0.5.
    let display = Picture {
        color_space: ColorSpace::Display,
        ..picture(2, vec![[0.25, 0.0, 0.0, 0.5], [0.3; 4]])
    };
    for name in ["a.npy", "a.exr"] {
        let path = folder.path().join(name);
        write_picture(&display, &path, EIGHT).unwrap();
        let found = read_image(&path).unwrap().pixels;
        assert!(
            (found[0][0] - 0.107_020_57).abs() < 1e-7,
            "{name}: {:?}",
            found[0]
        );
        assert_eq!(found[0][3], 0.5);
        // Straight 1 is light 1.
        assert!((found[1][0] - 0.3).abs() < 1e-7, "{name}: {:?}", found[1]);
    }
}

#[test]
fn a_background_goes_behind_in_the_space_of_the_picture() {
    let mut light = picture(
        3,
        vec![[0.0; 4], [0.2, 0.1, 0.0, 0.5], [0.3, 0.2, 0.1, 1.0]],
    );
    let mut display = Picture {
        color_space: ColorSpace::Display,
        ..light.clone()
    };
    light.over_background([0.5, 0.0, 1.0, 1.0]);
    display.over_background([0.5, 0.0, 1.0, 0.5]);
    let grey = 0.214_041_14;
    assert_eq!(light.pixels[0], [grey, 0.0, 1.0, 1.0]);
    assert_eq!(light.pixels[1], [0.2 + grey / 2.0, 0.1, 0.5, 1.0]);
    assert_eq!(light.pixels[2], [0.3, 0.2, 0.1, 1.0]);
    assert_eq!(display.pixels[0], [0.25, 0.0, 0.5, 0.5]);
    assert_eq!(display.pixels[1], [0.325, 0.1, 0.25, 0.75]);
}

#[test]
fn an_existing_file_stays_unless_forced() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.exr", "a.npy"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "mine").unwrap();
        let error = write_picture(&rich(), &path, EIGHT).unwrap_err();
        assert!(matches!(error.problem, OutputProblem::Exists), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), b"mine", "{name}");
        write_picture(&rich(), &path, FORCE).unwrap();
        assert!(read_image(&path).is_ok(), "{name}");
    }
    assert!(
        names(folder.path())
            .iter()
            .all(|name| !name.ends_with(".part"))
    );
}

#[test]
fn an_existing_layer_file_keeps_the_picture_from_being_written() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.samples.npy"), "mine").unwrap();
    let error = write_picture(&rich(), &folder.path().join("a.npy"), EIGHT).unwrap_err();
    assert!(error.path.ends_with("a.samples.npy"), "{error}");
    assert_eq!(names(folder.path()), ["a.samples.npy"]);
}

#[test]
fn places_that_take_no_file_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| write_picture(&rich(), &folder.path().join(name), EIGHT).unwrap_err();
    let missing = at("nowhere/a.png");
    assert!(
        matches!(missing.problem, OutputProblem::NoFolder(_)),
        "{missing}"
    );
    assert!(missing.to_string().contains("nowhere"), "{missing}");
    std::fs::create_dir(folder.path().join("b.png")).unwrap();
    assert!(matches!(at("b.png").problem, OutputProblem::IsFolder));
    for name in ["a.jpg", "a", "a.png.gz"] {
        let error = at(name);
        assert!(
            matches!(error.problem, OutputProblem::Extension(_)),
            "{error}"
        );
    }
    let torn = Picture { width: 4, ..rich() };
    let error = write_picture(&torn, &folder.path().join("c.npy"), EIGHT).unwrap_err();
    assert!(
        matches!(error.problem, OutputProblem::Size { .. }),
        "{error}"
    );
    let empty = Picture {
        height: 0,
        pixels: vec![],
        ..picture(1, vec![[0.0; 4]])
    };
    let error = write_picture(&empty, &folder.path().join("c.png"), EIGHT).unwrap_err();
    assert!(matches!(error.problem, OutputProblem::Encode(_)), "{error}");
    assert_eq!(names(folder.path()), ["b.png"]);
}

#[cfg(unix)]
#[test]
fn a_new_file_has_the_rights_that_the_users_mask_leaves() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    write_picture(&picture(1, vec![[0.0; 4]]), &path, EIGHT).unwrap();
    let plain = folder.path().join("plain");
    std::fs::write(&plain, "").unwrap();
    let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain), "{:o}", mode(&path));
}

/// Writes 64 x 64 pixels (64 KiB) to the path in the environment; a test only for the one below.
#[test]
fn write_where_told() {
    let Some(path) = std::env::var_os("STRATAVOX_TEST_WRITE_TO").map(PathBuf::from) else {
        return;
    };
    let error = write_picture(&picture(64, vec![[0.5; 4]; 64 * 64]), &path, FORCE).unwrap_err();
    assert!(
        matches!(
            error.problem,
            OutputProblem::Write {
                wanted_bytes: 65_664,
                ..
            }
        ),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn a_file_that_finds_no_room_leaves_the_old_one_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    std::fs::write(&path, "mine").unwrap();
    // The limit ends a write early and then refuses it, as a full disk does.
    let status = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 16; exec \"$0\" --exact write_where_told",
        ])
        .arg(std::env::current_exe().unwrap())
        .env("STRATAVOX_TEST_WRITE_TO", &path)
        .status()
        .unwrap();
    assert!(status.success(), "the write did not fail as it should");
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    assert_eq!(names(folder.path()), ["a.npy"]);
}

#[test]
fn comparing_a_png_with_the_floats_it_came_from_finds_half_a_code_at_most() {
    let folder = tempfile::tempdir().unwrap();
    let [png, npy] = ["a.png", "a.npy"].map(|name| folder.path().join(name));
    write_picture(&rich(), &png, EIGHT).unwrap();
    write_picture(&rich(), &npy, EIGHT).unwrap();
    let comparison =
        Comparison::of(&read_image(&npy).unwrap(), &read_image(&png).unwrap()).unwrap();
    // 1e-6 for f32 codes.
    comparison.at_most(0.5 / 255.0 + 1e-6).unwrap();
    assert!(
        comparison.at_most(0.1 / 255.0).is_err(),
        "{}",
        comparison.max()
    );
}

#[test]
fn other_files_are_refused_with_what_was_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x");
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_image(&path).unwrap_err()
    };
    let npy = |header: &str| {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes
    };
    let shaped = |shape| {
        npy(&format!(
            "{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}"
        ))
    };
    assert!(matches!(
        refused(b"").problem,
        PictureProblem::UnknownFormat { .. }
    ));
    assert!(matches!(
        refused(b"GIF89a").problem,
        PictureProblem::UnknownFormat { .. }
    ));
    let wide = refused(&npy(
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 4), }",
    ));
    assert!(
        wide.to_string().contains("wanted '<f4', found '<f8'"),
        "{wide}"
    );
    let huge = refused(&shaped("(4294967295, 4294967295, 4)"));
    assert!(
        matches!(huge.problem, PictureProblem::TooLarge { .. }),
        "{huge}"
    );
    let short = refused(&shaped("(2, 3, 4)"));
    assert!(
        matches!(
            short.problem,
            PictureProblem::Size {
                wanted_bytes: 96,
                found_bytes: 0,
                ..
            }
        ),
        "{short}"
    );
    for shape in [
        "(1, 2, 3)",
        "(4,)",
        "()",
        "(1, -1)",
        "(1, 99999999999999999999)",
        "7",
        "(1, 2",
    ] {
        let error = refused(&shaped(shape));
        assert!(
            matches!(
                error.problem,
                PictureProblem::Invalid { field: "shape", .. }
            ),
            "{error}"
        );
    }
    // 100 000 x 1000 pixels promised by 42 bytes of PNG, or by an EXR of one row.
    let small = folder.path().join("small.png");
    write_picture(&picture(1, vec![[0.0; 4]]), &small, EIGHT).unwrap();
    let mut lie = std::fs::read(&small).unwrap();
    lie[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 0, 3, 0xe8]);
    let crc = crc32(&lie[12..29]);
    lie[29..33].copy_from_slice(&crc.to_be_bytes());
    let error = refused(&lie);
    assert!(
        matches!(error.problem, PictureProblem::Size { .. }),
        "{error}"
    );
    let small = folder.path().join("small.exr");
    write_picture(&picture(1, vec![[0.0; 4]]), &small, EIGHT).unwrap();
    let mut lie = std::fs::read(&small).unwrap();
    let at = lie
        .windows(10)
        .position(|word| word == b"dataWindow")
        .unwrap()
        + 21
        + 8;
    lie[at..at + 8].copy_from_slice(&[0x9f, 0x86, 1, 0, 0xe7, 3, 0, 0]);
    let error = refused(&lie);
    assert!(
        matches!(error.problem, PictureProblem::Size { .. }),
        "{error}"
    );
    assert!(matches!(
        read_image(&folder.path().join("none")).unwrap_err().problem,
        PictureProblem::Io(_)
    ));
}

#[test]
fn cut_and_garbled_files_are_errors_or_pictures_of_the_same_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x");
    let mut state = 7_u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    for (name, options) in [
        ("a.npy", EIGHT),
        ("a.png", EIGHT),
        ("b.png", SIXTEEN),
        ("a.exr", EIGHT),
    ] {
        let source = folder.path().join(name);
        let mut rich = rich();
        rich.layers.truncate(1);
        write_picture(&rich, &source, options).unwrap();
        let whole = std::fs::read(&source).unwrap();
        let mut refused = 0;
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            refused += usize::from(read_image(&path).is_err());
        }
        // PNG: a picture is whole before its last chunk is.
        assert!(
            refused + 16 >= whole.len(),
            "{name}: {refused} of {} cuts",
            whole.len()
        );
        for _ in 0..2000 {
            let mut garbled = whole.clone();
            for _ in 0..=random() % 4 {
                let at = random() % garbled.len();
                garbled[at] = [0, 1, 0x7f, 0x80, 0xff, random() as u8][random() % 6];
            }
            std::fs::write(&path, &garbled).unwrap();
            if let Ok(image) = read_image(&path) {
                assert_eq!(
                    image.pixels.len(),
                    image.width as usize * image.height as usize
                );
            }
        }
    }
}

/// CRC-32 of ISO 3309, as PNG's chunks have it.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 * (crc & 1))
        })
    })
}
