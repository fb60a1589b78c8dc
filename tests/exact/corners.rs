//! What software devices read in the place of a texture has the values of the specification: pictures are those of the CPU reference, for
//! every type that has corners and wherever words are folded.

use crate::shared::{
    Comparison, PictureCase, compare, device, device_with, oblique_camera, projections, ramps,
    sheared_affine, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::resident::FootprintTexels;
use stratavox::technique::{
    ClipPlane, FilterBy, GradientStorage, Lattice, Level, Mode, Settings, Shading, Technique,
};
use stratavox::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Rescale, Volume, VoxelType, Voxels};

const TYPES: [VoxelType; 4] = [VoxelType::U8, VoxelType::I8, VoxelType::U16, VoxelType::I16];

const LEVEL: Level = Level {
    value: 0.55,
    srgb: [0.8; 3],
    opacity: 1.0,
};

/// Values from 0 to 1 in all codes of `stored`.
fn volume_of(grid: &Grid, stored: VoxelType, has_holes: bool) -> Volume {
    let [nx, ny, nz] = grid.dims;
    let places = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y, z))));
    let values =
        places.map(|(x, y, z)| waves(dvec3(x.into(), y.into(), z.into()) + DVec3::splat(0.5)));
    let (lowest, steps) = match stored {
        VoxelType::U8 => (0.0, 255.0),
        VoxelType::I8 => (-128.0, 255.0),
        VoxelType::U16 => (0.0, 65535.0),
        _ => (-32768.0, 65535.0),
    };
    let codes = values.map(|value| (value * steps).round() + lowest);
    let voxels = match stored {
        VoxelType::U8 => Voxels::U8(codes.map(|code| code as u8).collect()),
        VoxelType::I8 => Voxels::I8(codes.map(|code| code as i8).collect()),
        VoxelType::U16 => Voxels::U16(codes.map(|code| code as u16).collect()),
        _ => Voxels::I16(codes.map(|code| code as i16).collect()),
    };
    let fill = has_holes.then(|| f64::from(voxels.stored(100)));
    let slope = 1.0 / steps;
    let intercept = -lowest * slope;
    let rescale = Rescale { slope, intercept };
    Volume::from_voxels(grid.dims, grid.world_from_voxel, voxels, rescale, fill).unwrap()
}

/// FootprintTexels are not for conformance pictures, whose weights they have nevertheless.
fn shots(grid: Grid, mode: Mode) -> Vec<PictureCase> {
    let views = projections(&grid).map(|projection| oblique_camera(&grid, projection));
    let settings = Settings {
        mode,
        // Where the driver is one that is faster with its sampler too.
        filter_by: FilterBy::Fetch,
        skip: false,
        ..Settings::default()
    };
    let shot = |camera| PictureCase {
        grid,
        camera,
        extent: [40, 36],
        settings: settings.clone(),
    };
    views.map(shot).into()
}

fn what(volume: &Volume, shot: &PictureCase) -> String {
    let holes = match volume.validity {
        Some(_) => "holes",
        None => "no holes",
    };
    let stored = volume.voxels.voxel_type();
    format!("{stored:?}, {holes}, {}", shot.what())
}

/// The layer of values, which nothing has classified, and where they lie.
fn check_layer(renderer: &mut Renderer, volume: &Volume, shot: &PictureCase, kind: LayerKind) {
    let transfer = ramps();
    let scene = shot.scene(volume, Some(&transfer));
    let found = renderer.render(&scene, &[kind]).unwrap().picture;
    let double = reference::render::<f64>(&scene).unwrap();
    let single = reference::render::<f32>(&scene).unwrap();
    let lists = [&double, &single, &found].map(|picture| {
        let layer = picture.layers.iter().find(|layer| layer.kind == kind);
        &layer.unwrap().values[..]
    });
    let what = format!("{kind:?} of {}", what(volume, shot));
    let drawn = lists[1].iter().filter(|&&value| value > 0.01).count();
    assert!(drawn > 100, "{what}: only {drawn} pixels are drawn");
    let scale = lists[1].iter().copied().fold(1.0, f32::max);
    compare(&what, found.width, lists, scale);
}

#[test]
fn words_folded_over_many_rows_have_the_values_of_the_reference() {
    // 10 x 9 x 8 cubes of 16-bit words, 4 x 9 x 8 of 8-bit ones: more than a row of the image, which holds 128.
    let grid = Grid {
        dims: [38, 33, 30],
        world_from_voxel: sheared_affine(),
    };
    for stored in TYPES {
        for has_holes in [false, true] {
            let volume = volume_of(&grid, stored, has_holes);
            let device = device();
            assert!(!device.gpu().is_cpu() || FootprintTexels::are_for(device.gpu(), &volume));
            let mut renderer = Renderer::new(device, &volume).unwrap();
            // One projection each.
            for (mode, shot) in [(Mode::Mip, 0), (Mode::Average, 1)] {
                let shot = &shots(grid, mode)[shot];
                check_layer(&mut renderer, &volume, shot, LayerKind::Value);
            }
        }
    }
}

#[test]
fn long_rows_have_the_values_of_the_reference_from_end_to_end() {
    let grid = Grid {
        dims: [2000, 7, 5],
        world_from_voxel: DAffine3::from_scale(dvec3(0.005, 2.0, 2.0)),
    };
    for stored in TYPES {
        let volume = volume_of(&grid, stored, false);
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for shot in shots(grid, Mode::Average) {
            let shot = shot.with(|settings| settings.samples_per_voxel = 0.005);
            check_layer(&mut renderer, &volume, &shot, LayerKind::Value);
        }
    }
}

#[test]
fn surfaces_lie_where_those_of_the_reference_do() {
    let grid = Grid {
        dims: [23, 19, 17],
        world_from_voxel: sheared_affine(),
    };
    for stored in [VoxelType::I8, VoxelType::U16] {
        let volume = volume_of(&grid, stored, false);
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for shot in shots(grid, Mode::Iso) {
            let shot = shot.with(|settings| settings.per_mode.levels = vec![LEVEL]);
            check_layer(&mut renderer, &volume, &shot, LayerKind::Depth);
        }
    }
}

/// A table of opacities is within 1/4096 of them (`sampling.md` 4). Where they are p at most, that moves the alpha of a
/// sample that is no longer than a reference length by 1/4096/(1 - p), and a picture of one colour by the sum of these.
#[test]
fn composites_lit_and_unlit_are_those_of_the_reference_up_to_the_table() {
    const MOST: f64 = 0.04;
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    let color = |value| ColorPoint {
        value,
        srgb: [0.8; 3],
    };
    let transfer = TransferFunction {
        color: vec![color(0.0), color(1.0)],
        opacity: vec![opacity(0.0, 0.0), opacity(1.0, MOST)],
        ..ramps()
    };
    // Half of the little one lies beyond the outermost centres.
    let grids = [[23, 19, 17], [3, 4, 2]].map(|dims| Grid {
        dims,
        world_from_voxel: sheared_affine(),
    });
    let types = [VoxelType::U8, VoxelType::I16];
    for (grid, stored) in grids.into_iter().flat_map(|grid| types.map(|t| (grid, t))) {
        let volume = volume_of(&grid, stored, false);
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for shading in [None, Some(Shading::default())] {
            for shot in shots(grid, Mode::Composite) {
                let shot = shot.with(|settings| settings.shading.clone_from(&shading));
                let scene = shot.scene(&volume, Some(&transfer));
                let found = renderer.render(&scene, &[]).unwrap().picture;
                let wanted = reference::render::<f64>(&scene).unwrap();
                let most = wanted.pixels.iter().map(|p| p[3]).fold(0.0, f32::max);
                let [x, y, z] = grid.dims;
                assert!(
                    f64::from(most) > MOST * f64::from(x.min(y).min(z)) / 4.0,
                    "only {most} is drawn"
                );
                let samples = f64::from(x + y + z);
                let allowed = samples / 4096.0 / (1.0 - MOST);
                let what = what(&volume, &shot);
                let [wanted, found] = [&wanted, &found].map(|p| p.pixels.as_flattened());
                Comparison::of(wanted, found).at_most(allowed as f32, &what);
            }
        }
    }
}

/// What a picture is made of does not depend on what was drawn before it, with or without a texture.
#[test]
fn a_renderer_goes_from_what_reads_corners_alone_to_all_else_and_back() {
    let grid = Grid {
        dims: [23, 19, 17],
        world_from_voxel: sheared_affine(),
    };
    let transfer = ramps();
    let changes: [fn(&mut Settings); 9] = [
        |_| {},
        |settings| settings.technique = Technique::Slices3d,
        |settings| settings.lattice = Lattice::Planes,
        |settings| {
            settings.mode = Mode::Mip;
            settings.per_mode.exact_maximum = true;
        },
        |settings| {
            settings.shading = Some(Shading::default());
            settings.gradient_storage = GradientStorage::Precomputed;
        },
        |settings| settings.preintegrated = true,
        |settings| settings.filter_by = FilterBy::Sampler,
        |settings| settings.filter_by = FilterBy::Auto,
        |settings| settings.conformance = true,
    ];
    let shot = &shots(grid, Mode::Composite)[0];
    for (stored, has_holes) in [(VoxelType::U8, false), (VoxelType::I16, true)] {
        let volume = volume_of(&grid, stored, has_holes);
        let drawn = |renderer: &mut Renderer, shot: &PictureCase| {
            let scene = shot.scene(&volume, Some(&transfer));
            renderer.render(&scene, &[]).unwrap().picture.pixels
        };
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let first = drawn(&mut renderer, shot);
        for change in changes {
            let changed = shot.with(change);
            if has_holes && changed.settings.gradient_storage == GradientStorage::Precomputed {
                continue;
            }
            let mut fresh = Renderer::new(device(), &volume).unwrap();
            for (shot, wanted) in [
                (&changed, drawn(&mut fresh, &changed)),
                (shot, first.clone()),
            ] {
                assert!(wanted.iter().any(|pixel| pixel[3] > 0.1));
                let found = drawn(&mut renderer, shot);
                assert!(found == wanted, "{}", what(&volume, shot));
            }
        }
    }
}

/// Rays and view-aligned slices read corners in both pictures; where there are none, `fetch` has the weights of
/// conformance pictures, which are the CPU reference's.
#[test]
fn fetches_are_those_of_the_reference_in_every_technique() {
    let grid = Grid {
        dims: [23, 19, 17],
        world_from_voxel: sheared_affine(),
    };
    for stored in [VoxelType::U8, VoxelType::I16] {
        let volume = volume_of(&grid, stored, false);
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for technique in [Technique::Raycast, Technique::Slices3d, Technique::Slices2d] {
            let shot = shots(grid, Mode::Mip)[0].with(|settings| settings.technique = technique);
            check_layer(&mut renderer, &volume, &shot, LayerKind::Value);
            let by = renderer.filtered(&shot.settings).unwrap().by;
            let is_by_corners =
                technique != Technique::Slices2d && renderer.device().gpu().is_cpu();
            assert_eq!(by, if is_by_corners { "corners" } else { "fetch" });
        }
    }
}

/// In one piece and in bricks, whose textures have other sizes and origins.
#[test]
fn the_sampler_is_there_for_who_asks_for_it() {
    let grid = Grid {
        dims: [23, 19, 17],
        world_from_voxel: sheared_affine(),
    };
    let volume = volume_of(&grid, VoxelType::U16, false);
    let in_bricks = Caps {
        max_image_dimension_3d: 13,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    };
    let transfer = ramps();
    // Sub-texel positions of 4 bits at least (`subTexelPrecisionBits`): half a sixteenth along each axis of the
    // steepest step that there is.
    let steepest = 0.2 * 0.61 + 0.15 * 0.53 + 0.15 * 0.57;
    let value = |picture: &Picture| {
        let layer = picture
            .layers
            .iter()
            .find(|layer| layer.kind == LayerKind::Value);
        layer.unwrap().values.clone()
    };
    for caps in [Caps::UNLIMITED, in_bricks] {
        let mut renderer = Renderer::new(device_with(caps), &volume).unwrap();
        for technique in [Technique::Raycast, Technique::Slices3d, Technique::Slices2d] {
            let shot = shots(grid, Mode::Average)[0].with(|settings| {
                settings.filter_by = FilterBy::Sampler;
                settings.technique = technique;
            });
            let scene = shot.scene(&volume, Some(&transfer));
            let kinds = [LayerKind::Value];
            let found = renderer.render(&scene, &kinds).unwrap().picture;
            let wanted = reference::render::<f64>(&scene).unwrap();
            let filtered = renderer.filtered(&shot.settings).unwrap();
            assert_eq!((filtered.by, filtered.because), ("sampler", "asked for"));
            let (wanted, found) = (value(&wanted), value(&found));
            let what = format!("by the sampler, {technique}");
            Comparison::of(&wanted, &found).at_most(3.0 * steepest / 32.0, &what);
        }
    }
}

/// Pictures that nothing is cut from have programs of their own.
#[test]
fn a_plane_that_cuts_nothing_changes_no_bit() {
    let grid = Grid {
        dims: [23, 19, 17],
        world_from_voxel: sheared_affine(),
    };
    let transfer = ramps();
    let beyond = ClipPlane {
        normal: DVec3::Z,
        offset: -1e6,
    };
    for stored in [VoxelType::U8, VoxelType::I16] {
        let volume = volume_of(&grid, stored, false);
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let modes = [
            Mode::Composite,
            Mode::Mida,
            Mode::Iso,
            Mode::Mip,
            Mode::Minip,
            Mode::Average,
            Mode::Lmip,
            Mode::AttenuatedMip,
        ];
        let by_rays = modes.map(|mode| (mode, Technique::Raycast, None));
        let lit = Some(Shading::default());
        let others = [
            (Mode::Composite, Technique::Raycast, lit),
            (Mode::Composite, Technique::Slices3d, None),
            (Mode::Composite, Technique::Slices2d, None),
        ];
        for (mode, technique, shading) in by_rays.into_iter().chain(others) {
            let layers: &[LayerKind] = match technique {
                Technique::Raycast => &[LayerKind::Depth, LayerKind::Samples],
                _ => &[],
            };
            for shot in shots(grid, mode) {
                let whole = shot.with(|settings| {
                    settings.technique = technique;
                    settings.shading.clone_from(&shading);
                    settings.per_mode.levels = vec![LEVEL];
                });
                let cut = whole.with(|settings| settings.clip_planes = vec![beyond]);
                let [wanted, found] = [&whole, &cut].map(|shot| {
                    let scene = shot.scene(&volume, Some(&transfer));
                    renderer.render(&scene, layers).unwrap().picture
                });
                let what = what(&volume, &whole);
                let seen = wanted.pixels.iter().filter(|pixel| pixel[3] > 0.0).count();
                assert!(seen > 100, "{what}: only {seen} pixels are drawn");
                assert!(wanted.pixels == found.pixels, "{what}: other pixels");
                for (wanted, found) in wanted.layers.iter().zip(&found.layers) {
                    let [wanted, found] = [wanted, found].map(|layer| bytes_of(&layer.values));
                    assert!(wanted == found, "{what}: another layer");
                }
            }
        }
    }
}

/// No depth is not equal to itself.
fn bytes_of(values: &[f32]) -> &[u8] {
    bytemuck::cast_slice(values)
}
