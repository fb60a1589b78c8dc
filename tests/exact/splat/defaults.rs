//! Pictures as they are drawn without conformance, of bytes: drivers that have other copies of a volume than its texture draw
//! them from the texture too.

use super::{function, settings, sheared, shots};
use crate::shared::{Worst, device, volume_of};
use stratavox::offscreen::{Renderer, reference};
use stratavox::technique::splat::Sheets;
use stratavox::technique::{Mode, Settings};
use stratavox::volume::{Rescale, Volume, Voxels};

#[test]
fn bytes_are_drawn_by_default_as_they_are_computed() {
    let grid = sheared();
    let waves = volume_of(grid.dims, grid.world_from_voxel, super::noise);
    let Voxels::F32(values) = &waves.voxels else {
        panic!("made of f32");
    };
    let codes = values.iter().map(|v| (255.0 * v) as u8).collect();
    let rescale = Rescale {
        slope: 1.0 / 255.0,
        intercept: 0.0,
    };
    let (dims, affine) = (grid.dims, grid.world_from_voxel);
    let volume = Volume::from_voxels(dims, affine, Voxels::U8(codes), rescale, None).unwrap();
    let function = function();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in [Mode::Composite, Mode::Mip, Mode::Xray] {
        for sheets in [Sheets::Image, Sheets::Axis] {
            let settings = Settings {
                conformance: false,
                ..settings(mode, sheets)
            };
            for shot in shots(grid, &settings) {
                let scene = shot.scene(&volume, Some(&function));
                let found = renderer.render(&scene, &[]).unwrap().picture;
                let wanted = reference::render::<f32>(&scene).unwrap();
                let mut worst = Worst::new(format!("{sheets:?}, {}", shot.what()));
                for (i, pixel) in shot.pixels().enumerate() {
                    for c in 0..4 {
                        let error = found.pixels[i][c] - wanted.pixels[i][c];
                        // A table has 4096 steps, of which rounding may choose the next.
                        worst.take(pixel, error.into(), 2e-3);
                    }
                }
                worst.assert_holds();
                let seen = found.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
                assert!(seen > 40, "only {seen} pixels are drawn: {}", shot.what());
            }
        }
    }
}
