//! Pictures as they are drawn without conformance, of bytes: drivers that have other copies of a volume than its texture draw
//! them from the texture too.

use super::{function, of_sheets, ray_of, settings, sheared, shots};
use crate::shared::{Worst, device, volume_of};
use stratavox::offscreen::{Renderer, reference};
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::splat::Sheets;
use stratavox::technique::{Mode, Settings};
use stratavox::volume::{Rescale, Volume, Voxels};

/// A table has 4096 entries for values between 0 and 1, of which rounding may choose the next, in one sheet of a ray: colour is off
/// by its slope, light by that of extinction, (0.4 / 0.6) / (1 - 0.4), times the length of the sheet.
const ENTRY: f64 = 1.0 / 4096.0;
const COLOR: f64 = 0.9;
const EXTINCTION: f64 = 0.4 / 0.6 / 0.6;

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
                    let ray = ray_of(&shot, pixel);
                    // A projected value is classified for the reference length.
                    let length = match (mode, sheets) {
                        (Mode::Composite, Sheets::Image) => {
                            shot.view().step_world() / ray.forward.dot(ray.direction)
                        }
                        (Mode::Composite, _) => {
                            1.0 / ray.line.direction[stack_axis(&shot.view())].abs()
                        }
                        _ => 1.0,
                    };
                    let allowed = ENTRY * (COLOR + EXTINCTION * length) + of_sheets();
                    for c in 0..4 {
                        let error = found.pixels[i][c] - wanted.pixels[i][c];
                        worst.take(pixel, error.into(), allowed);
                    }
                }
                worst.assert_holds();
                let seen = found.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
                assert!(seen > 40, "only {seen} pixels are drawn: {}", shot.what());
            }
        }
    }
}
