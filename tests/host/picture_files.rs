//! The numbers that picture files hold.

#![cfg(all(feature = "png", feature = "exr"))]

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::picture_shared;

use picture_shared::{EIGHT, SIXTEEN, names, picture, rich};
use stratavox::color::ColorSpace;
use stratavox::picture::compare::{Comparison, Numbers};
use stratavox::picture::{Picture, read_image, write_picture};

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
fn codes_of_a_large_picture_are_those_of_its_rows() {
    const SIDE: u32 = 300;
    let pixel = |i: u32| [0.001 * (i % 997) as f32, 0.5, 0.002 * (i % 401) as f32, 1.0];
    let pixels: Vec<_> = (0..SIDE * SIDE).map(pixel).collect();
    let rows = pixels.chunks(SIDE as usize);
    let wanted = rows.flat_map(|row| picture(SIDE, row.to_vec()).codes(255));
    let wanted: Vec<_> = wanted.collect();
    assert!(picture(SIDE, pixels).codes(255) == wanted);
}

#[test]
fn png_files_hold_the_codes() {
    let folder = tempfile::tempdir().unwrap();
    for (name, options, max) in [("8.png", EIGHT, 255), ("16.PNG", SIXTEEN, 65_535)] {
        let path = folder.path().join(name);
        write_picture(&rich(), &path, options).unwrap();
        let image = read_image(&path).unwrap();
        assert_eq!((image.width, image.height), (5, 3));
        assert_eq!(image.numbers, Numbers::StraightSrgb);
        for (found, wanted) in image.pixels.iter().zip(rich().codes(max)) {
            let found = found.map(|x| (x * f32::from(max)).round() as u16);
            assert_eq!(found, wanted, "{name}");
        }
    }
}

fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

#[test]
fn npy_files_are_what_numpy_writes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.npy");
    write_picture(&rich(), &path, EIGHT).unwrap();
    assert_eq!(
        names(folder.path()),
        [
            "out.albedo.npy",
            "out.bounces.npy",
            "out.depth.npy",
            "out.direct.npy",
            "out.emission.npy",
            "out.indirect.npy",
            "out.label.npy",
            "out.line.npy",
            "out.noise.npy",
            "out.normal.npy",
            "out.npy",
            "out.position.npy",
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
    // Three numbers a pixel, as numpy.save writes float32 of (3, 5, 3).
    let positions = std::fs::read(folder.path().join("out.position.npy")).unwrap();
    assert!(String::from_utf8_lossy(&positions[..128]).contains("'shape': (3, 5, 3), }"));
    let kind = stratavox::picture::LayerKind::Position;
    let layer = rich().layers.into_iter().find(|layer| layer.kind == kind);
    assert_eq!(positions[128..], *bytes_of(&layer.unwrap().values));
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
            "albedo.B",
            "albedo.G",
            "albedo.R",
            "bounces",
            "depth",
            "direct.B",
            "direct.G",
            "direct.R",
            "emission.B",
            "emission.G",
            "emission.R",
            "indirect.B",
            "indirect.G",
            "indirect.R",
            "label",
            "line",
            "noise",
            "normal.X",
            "normal.Y",
            "normal.Z",
            "position.X",
            "position.Y",
            "position.Z",
            "samples",
            "transmittance",
            "value"
        ]
    );
    for layer in rich().layers {
        let (name, count) = (layer.kind.name(), layer.kind.numbers());
        let axes = match layer.kind.is_color() {
            true => [".R", ".G", ".B"],
            false => [".X", ".Y", ".Z"],
        };
        for (k, axis) in axes.into_iter().enumerate().take(count) {
            let name = format!("{name}{}", if count == 1 { "" } else { axis });
            let channel = channels.iter().find(|c| c.name.eq(name.as_str()));
            let found = channel.unwrap().sample_data.values_as_f32();
            let wanted = layer.values.iter().skip(k).step_by(count);
            assert!(
                found
                    .map(f32::to_bits)
                    .eq(wanted.map(|number| number.to_bits())),
                "{name}"
            );
        }
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
