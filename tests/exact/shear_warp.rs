//! Shear-warp: each pixel is the bilinear mean of four rays of a 2D stack, through the points of a plane between its slices.

mod blur;
mod counts;
mod four_rays;
mod law;
mod moved;
mod planes;
mod waves;

use crate::shared::{
    Device, PictureCase, Reference, Way, Worst, device, oblique_camera, projections, ramps,
    sheared_affine, volume_of,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::Renderer;
use stratavox::picture::{LayerKind, Picture};
use stratavox::technique::shear_warp::{BasePlane, base_plane};
use stratavox::technique::{
    Error, Filter, InPixel, Intermediate, Mode, Order, Settings, Technique, View,
};
use stratavox::volume::{Grid, Volume};

const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

fn sheared() -> Grid {
    Grid {
        dims: [17, 21, 13],
        world_from_voxel: sheared_affine(),
    }
}

fn cubes(dims: [u32; 3]) -> Grid {
    Grid {
        dims,
        world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0)),
    }
}

fn settings(mode: Mode, per_voxel: f64) -> Settings {
    Settings {
        technique: Technique::ShearWarp,
        intermediate: Intermediate::PerVoxel(per_voxel),
        mode,
        conformance: true,
        // All samples are counted.
        skip: false,
        ..Settings::default()
    }
}

/// In the middle of the picture, where rays go through both faces across the axis y.
fn through_all(grid: Grid, settings: Settings) -> PictureCase {
    let [mut shot, _] = shots(grid, &settings);
    shot.camera.eye = shot.camera.target + 40.0 * dvec3(0.3, -1.0, 0.2);
    shot.camera.zoom = 6.0;
    shot
}

fn shots(grid: Grid, settings: &Settings) -> [PictureCase; 2] {
    projections(&grid).map(|projection| PictureCase {
        grid,
        camera: oblique_camera(&grid, projection),
        extent: [40, 36],
        settings: settings.clone(),
    })
}

fn layers(mode: Mode) -> &'static [LayerKind] {
    match mode.is_projection() {
        true => &[LayerKind::Samples, LayerKind::Value],
        false => &[LayerKind::Samples, LayerKind::Transmittance],
    }
}

fn drawn(shot: &PictureCase, volume: &Volume) -> Picture {
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let scene = shot.scene(volume, Some(&transfer));
    renderer
        .render(&scene, layers(shot.settings.mode))
        .unwrap()
        .picture
}

fn plane(shot: &PictureCase) -> Result<BasePlane, Error> {
    base_plane(&View {
        grid: &shot.grid,
        camera: &shot.camera,
        extent_pixels: shot.extent,
        in_pixel: InPixel::CENTER,
        settings: &shot.settings,
    })
}

/// How far off the place of a pixel in the intermediate image may be, in base pixels:
///
/// ```text
/// U = (a x + b y + c) / (d x + e y + f) - 1/2        2^-24 of each of: a number of the matrix as f32, its product, two sums,
///                                                    two and a half times as much of the quotient, one of the difference
/// ```
fn place_error(base: &BasePlane, [x, y]: [u32; 2]) -> f64 {
    let pixel = dvec3(f64::from(x) + 0.5, f64::from(y) + 0.5, 1.0);
    let rows = base.base_from_pixel.transpose();
    let w = rows.z_axis.dot(pixel);
    let of_rows = [rows.x_axis, rows.y_axis].map(|row| {
        let place = (row.dot(pixel) / w).abs();
        let of_sum = |row: DVec3| 4.0 * (row * pixel).abs().element_sum() / w;
        of_sum(row) + place * of_sum(rows.z_axis) + 2.5 * place + place + 0.5
    });
    // The mean of four is off by both, and by its own weights: differences and products of numbers up to 1.
    (of_rows[0] + of_rows[1] + 4.0) / f64::from(1 << 24)
}

/// How far apart a channel of two composites of the same samples may be, front to back:
///
/// ```text
/// C += T (a c),  T *= 1 - a      of the n-th sample T is off by two roundings for each one before, its light by three more;
///                                light of all is 1 at most, and each sum of it is off by half of 2^-24
/// ```
fn blend_error(slices: u32) -> f64 {
    let slices = f64::from(slices);
    2.0 * (2.0 * slices + 3.0 + 0.5 * slices) / f64::from(1 << 24)
}

/// Along an axis, with a pixel for each base pixel.
fn straight(grid: Grid, axis: usize, towards: f64, settings: Settings) -> PictureCase {
    let Intermediate::PerVoxel(per_voxel) = settings.intermediate else {
        panic!("a number of base pixels");
    };
    let across = [(axis + 1) % 3, (axis + 2) % 3];
    let sides = across.map(|k| f64::from(grid.dims[k]));
    PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() - 40.0 * towards * DVec3::AXES[axis],
            target: grid.center(),
            up: DVec3::AXES[across[1]],
            projection: Projection::Orthographic {
                view_height: sides[1],
            },
            zoom: 1.0,
        },
        extent: sides.map(|n| (n * per_voxel) as u32),
        settings,
    }
}

#[test]
fn along_an_axis_it_has_the_pixels_that_the_rasterizer_blends() {
    for dims in [[16, 18, 20], [17, 13, 9]] {
        let grid = cubes(dims);
        let volume = volume_of(grid.dims, grid.world_from_voxel, crate::shared::waves);
        for (per_voxel, mode) in [
            (1.0, Mode::Composite),
            (2.0, Mode::Composite),
            (4.0, Mode::Mip),
            (1.0, Mode::Xray),
        ] {
            for axis in [0, 1, 2] {
                for towards in [1.0, -1.0] {
                    let shot = straight(grid, axis, towards, settings(mode, per_voxel));
                    let found = drawn(&shot, &volume);
                    let stack = shot.with(|settings| {
                        settings.technique = Technique::Slices2d;
                        settings.order = Order::FrontToBack;
                    });
                    let wanted = drawn(&stack, &volume);
                    let mut worst = Worst::new(shot.what());
                    let allowed = blend_error(dims[axis]);
                    for (i, pixel) in shot.pixels().enumerate() {
                        for c in 0..4 {
                            let error = found.pixels[i][c] - wanted.pixels[i][c];
                            worst.take(pixel, error.into(), allowed);
                        }
                        // Whole numbers, of which one has all of the weight.
                        let samples = [&found, &wanted].map(|p| p.layers[0].values[i]);
                        assert_eq!(samples[0], samples[1], "{pixel:?} of {}", shot.what());
                    }
                    worst.assert_holds();
                }
            }
        }
    }
}

#[test]
fn a_finer_intermediate_image_is_four_times_nearer_to_rays_of_pixels() {
    let grid = cubes([24, 22, 26]);
    let smooth =
        |p: DVec3| 0.5 + 0.3 * (0.31 * p.x + 0.2 * p.y).sin() * (0.27 * p.y - 0.21 * p.z).cos();
    let volume = volume_of(grid.dims, grid.world_from_voxel, smooth);
    let error = |per_voxel: f64| {
        // What is warped has a second derivative everywhere.
        let settings = Settings {
            filter: Filter::Cubic,
            ..settings(Mode::Xray, per_voxel)
        };
        let shot = through_all(grid, settings);
        let found = drawn(&shot, &volume);
        let stack = shot.with(|settings| settings.technique = Technique::Slices2d);
        let wanted = drawn(&stack, &volume);
        let off = |i: usize| f64::from(found.layers[1].values[i] - wanted.layers[1].values[i]);
        let sum: f64 = (0..found.pixels.len()).map(|i| off(i) * off(i)).sum();
        (sum / found.pixels.len() as f64).sqrt()
    };
    let [one, two, four] = [1.0, 2.0, 4.0].map(error);
    for ratio in [one / two, two / four] {
        assert!((ratio - 4.0).abs() < 0.4, "{one}, {two}, {four}");
    }
}

#[test]
fn an_x_ray_of_a_linear_field_is_exact() {
    let grid = cubes([24, 22, 26]);
    let linear = |p: DVec3| 0.1 + dvec3(0.011, 0.007, -0.004).dot(p - DVec3::ZERO).abs();
    let volume = volume_of(grid.dims, grid.world_from_voxel, linear);
    for per_voxel in [0.5, 1.0, 3.0] {
        let shot = through_all(grid, settings(Mode::Xray, per_voxel));
        let found = drawn(&shot, &volume);
        let wanted = drawn(&shot.with(|s| s.technique = Technique::Slices2d), &volume);
        let mut worst = Worst::new(shot.what());
        for (i, pixel) in shot.pixels().enumerate() {
            let [found, wanted] = [&found, &wanted].map(|p| f64::from(p.layers[1].values[i]));
            worst.take(pixel, (found - wanted) / wanted, 1e-5);
        }
        worst.assert_holds();
    }
}

/// The CPU reference in both precisions, and the device, on a field given by its formula.
#[test]
fn a_box_of_one_opacity_is_as_opaque_as_its_slices_are_long() {
    let grid = cubes([16, 18, 20]);
    let ways: [Box<dyn Way>; 3] = [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
        Box::new(Device),
    ];
    let extinction = 0.05;
    let matter = crate::shared::Matter {
        value: &|_| 0.5,
        color: &|_| [0.3, 0.6, 0.9],
        extinction: &|_| extinction,
        range: [0.0, 1.0],
    };
    for way in ways {
        let shot = through_all(grid, settings(Mode::Composite, 1.0));
        // All slices, each for 1 / |d_y|.
        let slope = (shot.camera.target - shot.camera.eye).normalize().y.abs();
        let wanted = -(-extinction * f64::from(grid.dims[1]) / slope).exp_m1();
        let mut worst = Worst::new(way.name());
        for (pixel, found) in shot.pixels().zip(way.picture(&shot, &matter)) {
            worst.take(pixel, found[3] - wanted, 5e-6);
            worst.take(pixel, found[2] - 0.9 * wanted, 5e-6);
        }
        worst.assert_holds();
    }
}
