//! What is left out of bricks of a stream changes no bit of a picture, whatever was drawn of the same bricks before.

use crate::shared::device;
use crate::skipping_shared::{balls, cameras, hills, samples_of_same_pictures};
use crate::streaming_shared::{Numbers, open};
use std::sync::Arc;
use stratavox::offscreen::{Renderer, StreamOptions};
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Mode, Settings};
use stratavox::transfer::{GradientTransfer, Shape, TransferFunction, Widget};

/// Bricks of a few macro cells, which all have room.
const ROOMY: StreamOptions = StreamOptions {
    side: 24,
    piece_bytes: 100_000,
    device_bytes: 1 << 30,
    all_device_bytes: u64::MAX,
};

/// Draws all of these with one renderer, and says which part of the samples was taken.
fn taken(of: &[(Settings, TransferFunction)], source: &Arc<Numbers>) -> Vec<f64> {
    let stream = open(source, ROOMY);
    assert!(stream.brick_count() >= 4, "{}", stream.brick_count());
    let outline = stream.outline();
    let cameras = cameras(&outline.grid());
    let mut renderer = Renderer::streamed(device(), &stream).expect("a renderer");
    let draw = |(nth, (settings, transfer)): (usize, &(Settings, TransferFunction))| {
        let scene = Scene {
            volume: outline,
            transfer: Some(transfer),
            beside: Default::default(),
            camera: &cameras[nth % cameras.len()],
            extent_pixels: [37, 29],
            settings,
        };
        let [skipped, whole] = samples_of_same_pictures(&mut renderer, &scene);
        assert!(whole > 0.0, "nothing is drawn: {settings:?}");
        skipped / whole
    };
    of.iter().enumerate().map(draw).collect()
}

/// The least of the parts that were taken.
fn least(taken: Vec<f64>) -> f64 {
    taken.into_iter().fold(1.0, f64::min)
}

#[test]
fn contours_and_slabs_are_left_out_of_bricks_too() {
    let mut numbers = crate::skipping_shared::Numbers(41);
    let volume = balls(&mut numbers, false);
    let [low, high] = volume.value_range;
    let plain = hills(&mut numbers, [0.6 * high, high]);
    let contour = |part: f64| Widget {
        srgb: None,
        opacity: 0.8,
        shape: Shape::Contour {
            value: low + part * (high - low),
            half_width: 1.0,
        },
        second: None,
    };
    let contours = TransferFunction {
        opacity: Vec::new(),
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(0.3 * (high - low)),
            share: Vec::new(),
            widgets: vec![contour(0.5), contour(0.9)],
        }),
        ..plain.clone()
    };
    let source = Arc::new(Numbers::from(volume, None));
    let of = |preintegrated, function: &TransferFunction| {
        let settings = Settings {
            preintegrated,
            ..Settings::default()
        };
        vec![(settings, function.clone()); 3]
    };
    let [contours, slabs] = [of(false, &contours), of(true, &plain)];
    assert!(least(taken(&contours, &source)) < 0.8, "contours");
    assert!(least(taken(&slabs, &source)) < 0.8, "slabs");
    let mixed: Vec<_> = contours.into_iter().chain(slabs).rev().collect();
    taken(&mixed, &source);
}

#[test]
fn cells_of_a_narrow_filter_say_nothing_of_wider_ones() {
    let mut numbers = crate::skipping_shared::Numbers(43);
    for _ in 0..4 {
        let volume = balls(&mut numbers, false);
        let function = hills(&mut numbers, volume.value_range);
        let source = Arc::new(Numbers::from(volume, None));
        let of = |(mode, filter)| {
            let settings = Settings {
                mode,
                filter,
                samples_per_voxel: 2.3,
                ..Settings::default()
            };
            (settings, function.clone())
        };
        taken(
            &[
                (Mode::Mip, Filter::Nearest),
                (Mode::Mip, Filter::Linear),
                (Mode::Mip, Filter::CatmullRom),
                (Mode::Minip, Filter::CatmullRom),
                (Mode::Composite, Filter::Nearest),
                (Mode::Composite, Filter::CatmullRom),
                (Mode::Composite, Filter::Linear),
            ]
            .map(of),
            &source,
        );
    }
}
