//! Splats of a volume on a driver that ends long loops: parts of each ray, one after the other.

use super::{function, noise, scene, seen_from, settings};
use crate::shared::{device_with, volume_of};
use glam::{DAffine3, dvec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::Mode;
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::splat::Sheets;
use stratavox::volume::Grid;

/// Long along z, so that a part is far from all of it.
const DIMS: [u32; 3] = [10, 9, 64];
const LAYERS: [LayerKind; 1] = [LayerKind::Samples];

fn drawn(scene: &Scene, max_loop_turns: u32) -> Result<Picture, String> {
    let device = device_with(Caps {
        max_loop_turns,
        ..Caps::UNLIMITED
    });
    let mut renderer = Renderer::several(device, scene.volumes()).expect("a renderer");
    let rendered = renderer.render(scene, &LAYERS).map_err(|e| e.to_string())?;
    Ok(rendered.picture)
}

#[test]
fn rays_longer_than_loops_may_be_are_drawn_in_parts_to_the_bit() {
    let grid = Grid {
        dims: DIMS,
        world_from_voxel: DAffine3::IDENTITY,
    };
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let f = function();
    let parts = preclassified(&volume, &f, 1.0, ColorSpace::Display).expect("four volumes");
    let beside: Vec<_> = parts[1..].iter().collect();
    let ways = [
        (Mode::Composite, Sheets::Image, false),
        (Mode::Mip, Sheets::Image, false),
        (Mode::Composite, Sheets::Image, true),
        (Mode::Composite, Sheets::Axis, false),
        (Mode::Minip, Sheets::Axis, false),
        (Mode::Composite, Sheets::None, true),
        (Mode::Xray, Sheets::Image, false),
        (Mode::Average, Sheets::Image, false),
    ];
    for (mode, sheets, is_classified) in ways {
        let mut settings = settings(mode, sheets);
        settings.splat.low_pass = 0.0;
        let shot = seen_from(grid, dvec3(0.4, -0.3, 1.0), &settings);
        let scene = match is_classified {
            true => Scene {
                beside: Beside::Classified(&beside),
                ..scene(&shot, &parts[0], &f)
            },
            false => scene(&shot, &volume, &f),
        };
        let way = format!("{mode}, {sheets}, classified: {is_classified}");
        let whole = drawn(&scene, u32::MAX).expect(&way);
        // From all at once to few sheets or slices at a time.
        for turns in [6000, 4000, 3000, 2500] {
            let cut = drawn(&scene, turns).unwrap_or_else(|e| panic!("{way}, {turns}: {e}"));
            assert_eq!(whole.pixels, cut.pixels, "{way}, {turns}");
            assert_eq!(whole.layers, cut.layers, "{way}, {turns}");
        }
        let text = drawn(&scene, 1050).expect_err(&way);
        assert!(text.contains("splats of voxels"), "{way}: {text}");
    }
}
