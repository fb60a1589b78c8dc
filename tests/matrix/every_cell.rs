//! The matrix of `docs/matrix.md`: every cell is drawn by the device as by its CPU reference, or refused by both with the same
//! reason, and the page says which. A share of them, by turns, stands for all; `make sweep` draws each.

use crate::cells::{DENOISE, FEATURES, FILTERS, Feature, MODES, Matter, Seen, settings};
use crate::page;
use crate::shared::{Worst, compare, device, device_with, sweep};
use glam::dvec3;
use std::error::Error;
use std::sync::Arc;
use stratavox::geometry::{Geometry, RoundCones, Vertex};
use stratavox::gpu::Caps;
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::Picture;
use stratavox::scene::Scene;
use stratavox::technique::{Filter, GradientStorage, Technique};
use stratavox::volume::Volume;

#[test]
fn the_page_says_what_the_checks_of_the_code_say() {
    let page = page::page(&Matter::new(|volume| DENOISE.denoised(volume)));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/matrix.md");
    let kept = std::fs::read_to_string(path).expect("docs/matrix.md");
    assert!(
        page == kept,
        "docs/matrix.md is old: cargo run --example matrix > docs/matrix.md"
    );
}

#[test]
fn every_cell_of_ray_casting_is_drawn_as_computed_or_refused() {
    assert_cells(Technique::Raycast);
}

#[test]
fn every_cell_of_view_aligned_slices_is_drawn_as_computed_or_refused() {
    assert_cells(Technique::Slices3d);
}

#[test]
fn every_cell_of_2d_stacks_is_drawn_as_computed_or_refused() {
    assert_cells(Technique::Slices2d);
}

#[test]
fn every_cell_of_splats_is_drawn_as_computed_or_refused() {
    assert_cells(Technique::Splat);
}

/// Takes several bricks of the cells' volumes along two axes, and along each in a stack.
fn small() -> Caps {
    Caps {
        max_image_dimension_3d: 10,
        max_image_array_layers: 7,
        ..Caps::UNLIMITED
    }
}

fn assert_cells(technique: Technique) {
    let matter = Matter::new(|volume| DENOISE.denoised(volume));
    // What is denoised on the device is drawn on the device.
    let of_device = Matter::new(|volume| {
        offscreen::denoised(&mut device(), volume, &DENOISE).expect("a noise filter")
    });
    let (mut drawn, mut nth) = (0, 0);
    for feature in FEATURES {
        let (channels, parts) = (matter.channels(feature.seen), matter.parts(feature.seen));
        let any = settings(technique, MODES[0].0, FILTERS[0].0, feature);
        let scene = of_device.scene(0, feature.seen, &any, &channels, &parts);
        let device = match feature.seen {
            Seen::Bricked => device_with(small()),
            _ => device(),
        };
        let mut renderer = Renderer::several(device, scene.volumes()).expect("a renderer");
        renderer.set_geometry(geometry(feature.seen, scene.volume).map(Arc::new));
        for (mode, _) in MODES {
            for (filter, _) in FILTERS {
                nth += 1;
                if is_left(filter, nth) {
                    continue;
                }
                let mut settings = settings(technique, mode, filter, feature);
                // Kept gradients are filtered by the device.
                settings.conformance = settings.gradient_storage != GradientStorage::Precomputed;
                let scenes = [&of_device, &matter]
                    .map(|matter| matter.scene(nth, feature.seen, &settings, &channels, &parts));
                drawn += usize::from(is_drawn(&mut renderer, scenes, feature));
            }
        }
    }
    println!("{technique:?}: {drawn} cells drawn");
    // Splats have a kernel of their own in place of all filters but one.
    let most = if technique == Technique::Splat {
        20
    } else {
        100
    };
    assert!(drawn > most, "{technique:?}: only {drawn} cells are drawn");
}

/// What is drawn in the volume: a tube.
fn geometry(seen: Seen, volume: &Volume) -> Option<Geometry> {
    let ends = [(dvec3(-1.0, 7.0, 3.0), 1.5), (dvec3(9.0, 4.0, 6.0), 0.8)];
    let mut cones = RoundCones::default();
    cones.add_line(ends.map(|(voxel, radius)| Vertex {
        place: volume.world_from_voxel.transform_point3(voxel),
        radius,
        color: [0.9, 0.6, 0.1],
    }));
    (seen == Seen::Tube).then(|| cones.into())
}

/// Of two cells of the linear filter one is drawn, and of five of other filters, by turns: rows have seven of all filters, so
/// that they are others in each mode and row.
fn is_left(filter: Filter, nth: usize) -> bool {
    let every = if filter == Filter::Linear { 2 } else { 5 };
    !sweep::is_long() && !nth.is_multiple_of(every)
}

/// Drawn as computed, or refused by all three in the same words.
fn is_drawn(renderer: &mut Renderer, [scene, of_reference]: [Scene; 2], feature: &Feature) -> bool {
    let settings = scene.settings;
    let what = format!(
        "{}, {:?} {:?} {:?} {:?}",
        feature.name, settings.technique, settings.mode, settings.filter, scene.camera.projection
    );
    let found = renderer.render(&scene, &[]);
    if feature.seen == Seen::Bricked
        && scene.check().is_ok()
        && let Err(refused) = settings.check_bricks(2)
    {
        // How many bricks there are is for the device to say.
        let reason = text_of(&found.expect_err("refused by the device"));
        let of_two = refused.to_string();
        let [start, _] = of_two.split(" in 2 ").collect::<Vec<_>>()[..] else {
            panic!("{of_two}");
        };
        assert!(reason.starts_with(start), "{what}: {reason}");
        return false;
    }
    let geometry = geometry(feature.seen, scene.volume);
    let references = [
        reference::render_with::<f64>(&of_reference, geometry.as_ref()),
        reference::render_with::<f32>(&of_reference, geometry.as_ref()),
    ];
    if let Err(refused) = Matter::check(&scene, feature.seen) {
        let reason = refused.to_string();
        let of_device = found.err().map(|error| text_of(&error));
        assert_eq!(of_device.as_ref(), Some(&reason), "{what}: device");
        for reference in references {
            let of_reference = reference.err().map(|error| text_of(&error));
            assert_eq!(of_reference.as_ref(), Some(&reason), "{what}: reference");
        }
        return false;
    }
    let [double, single] =
        references.map(|reference| reference.unwrap_or_else(|e| panic!("{what}: {e}")));
    let found = found.unwrap_or_else(|e| panic!("{what}: {e}")).picture;
    let covered = single.pixels.iter().filter(|p| p[3] > 0.01).count();
    assert!(covered > 80, "{what}: only {covered} pixels are drawn");
    if settings.conformance {
        let mut found = found;
        if settings.uneven_rays && settings.filter == Filter::Nearest {
            forgive_samples_on_faces(&what, &single, &mut found);
        }
        let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
        compare(&what, 4 * found.width, all, 1.0);
    } else {
        assert_lit_alike(&what, &double, &found);
    }
    true
}

/// Of 418 x 4 rays through places like any other, with some 30 samples each, a few come within rounding (1e-6) of the
/// face between two voxels along one of three axes: 0.3 in the mean, more than three in one picture of 4000.
fn forgive_samples_on_faces(what: &str, single: &Picture, found: &mut Picture) {
    let pairs = found.pixels.iter_mut().zip(&single.pixels);
    let jumps = pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1e-5));
    let jumps: Vec<_> = jumps.collect();
    assert!(jumps.len() <= 3, "{what}: {} pixels are off", jumps.len());
    for (found, single) in jumps {
        *found = *single;
    }
}

/// The cosine of light on a kept gradient is off by 2.4e-3 at most (`tests/exact/light.rs`), for lamps of colours 1 and 0.6
/// at most of which half is diffuse by 2e-3. Weights of a sampler, which move a surface, are none of its business:
/// where they make matter denser by more than 1e-3 a pixel does not count.
fn assert_lit_alike(what: &str, wanted: &Picture, found: &Picture) {
    let mut worst = Worst::new(what);
    let pairs = wanted.pixels.iter().zip(&found.pixels);
    let mut counted = 0;
    for (i, (own, found)) in pairs.enumerate() {
        let pixel = [i as u32 % wanted.width, i as u32 / wanted.width];
        let denser = (own[3] - found[3]).abs();
        if denser > 1e-3 {
            worst.leave_out();
            continue;
        }
        counted += usize::from(own[3] > 0.01);
        for c in 0..3 {
            let off = f64::from(found[c] - own[c]);
            worst.take(pixel, off, 2e-3 + f64::from(denser));
        }
    }
    assert!(counted > 80, "{what}: only {counted} pixels are as dense");
    worst.assert_holds();
}

/// The innermost reason.
fn text_of(error: &dyn Error) -> String {
    let mut error = error;
    while let Some(cause) = error.source() {
        error = cause;
    }
    error.to_string()
}
