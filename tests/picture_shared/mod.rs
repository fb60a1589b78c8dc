//! Pictures to write, and ways to write them.

use std::path::Path;
use stratavox::color::ColorSpace;
use stratavox::picture::{BitDepth, Layer, LayerKind, Picture, WriteOptions};

pub const EIGHT: WriteOptions = WriteOptions {
    bit_depth: BitDepth::Eight,
    force: false,
};
pub const SIXTEEN: WriteOptions = WriteOptions {
    bit_depth: BitDepth::Sixteen,
    force: false,
};
pub const FORCE: WriteOptions = WriteOptions {
    bit_depth: BitDepth::Eight,
    force: true,
};

pub fn picture(width: u32, pixels: Vec<[f32; 4]>) -> Picture {
    Picture {
        width,
        height: pixels.len() as u32 / width,
        pixels,
        color_space: ColorSpace::Linear,
        layers: vec![],
    }
}

/// 5 x 3 pixels, alpha from 0 to 1, and all layers, one of them with holes.
pub fn rich() -> Picture {
    let pixels = (0..15).map(|i| {
        let alpha = i as f32 / 14.0;
        [alpha * 0.9, alpha * 0.25, alpha * alpha * 0.5, alpha]
    });
    let layers = LayerKind::ALL
        .into_iter()
        .enumerate()
        .map(|(n, kind)| Layer {
            kind,
            values: (0..15 * kind.numbers())
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

pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
