//! The matrix of `docs/matrix.md`: every cell is drawn by the device as by its twin, or refused by both with the same
//! reason, and the page says which.

mod shared;

#[path = "../examples/matrix/cells.rs"]
mod cells;
#[path = "../examples/matrix/page.rs"]
mod page;

use cells::{FEATURES, FILTERS, Feature, MODES, Matter, settings};
use shared::{compare, device};
use std::error::Error;
use stratavox::offscreen::{Renderer, reference};
use stratavox::scene::Scene;
use stratavox::technique::Technique;

#[test]
fn the_page_says_what_the_checks_of_the_code_say() {
    let page = page::page(&Matter::new());
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

fn assert_cells(technique: Technique) {
    let matter = Matter::new();
    let mut drawn = 0;
    for feature in FEATURES {
        let (channels, parts) = (matter.channels(feature.seen), matter.parts(feature.seen));
        let any = settings(technique, MODES[0].0, FILTERS[0].0, feature);
        let volumes = matter
            .scene(feature.seen, &any, &channels, &parts)
            .volumes();
        let mut renderer = Renderer::several(device(), volumes).expect("a renderer");
        for (mode, _) in MODES {
            for (filter, _) in FILTERS {
                let mut settings = settings(technique, mode, filter, feature);
                settings.conformance = true;
                let scene = matter.scene(feature.seen, &settings, &channels, &parts);
                drawn += usize::from(is_drawn(&mut renderer, &scene, feature));
            }
        }
    }
    println!("{technique:?}: {drawn} cells drawn");
    assert!(drawn > 100, "{technique:?}: only {drawn} cells are drawn");
}

/// Drawn as computed, or refused by all three in the same words.
fn is_drawn(renderer: &mut Renderer, scene: &Scene, feature: &Feature) -> bool {
    let settings = scene.settings;
    let what = format!(
        "{}, {:?} {:?} {:?}",
        feature.name, settings.technique, settings.mode, settings.filter
    );
    let found = renderer.render(scene, &[]);
    let twins = [
        reference::render::<f64>(scene),
        reference::render::<f32>(scene),
    ];
    if let Err(refused) = scene.check() {
        let reason = refused.to_string();
        let of_device = found.err().map(|error| text_of(&error));
        assert_eq!(of_device.as_ref(), Some(&reason), "{what}: device");
        for twin in twins {
            let of_twin = twin.err().map(|error| text_of(&error));
            assert_eq!(of_twin.as_ref(), Some(&reason), "{what}: twin");
        }
        return false;
    }
    let [double, single] = twins.map(|twin| twin.unwrap_or_else(|e| panic!("{what}: {e}")));
    let found = found.unwrap_or_else(|e| panic!("{what}: {e}")).picture;
    let covered = single.pixels.iter().filter(|p| p[3] > 0.01).count();
    assert!(covered > 100, "{what}: only {covered} pixels are drawn");
    let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
    compare(&what, 4 * found.width, all, 1.0);
    true
}

/// The innermost reason.
fn text_of(error: &dyn Error) -> String {
    let mut error = error;
    while let Some(cause) = error.source() {
        error = cause;
    }
    error.to_string()
}
