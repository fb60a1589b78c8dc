//! Shear-warp: each pixel is the bilinear mean of four rays of a 2D stack, through the points of a plane between its slices. The
//! rays are found here from camera and grid alone, each as the only pixel of a camera of its own, and drawn by the
//! CPU reference of slices.

mod blur;

use crate::shared::{
    Device, PictureCase, Reference, Way, Worst, device, oblique_camera, projections, ramps,
    sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use std::collections::HashMap;
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::technique::shear_warp::base_plane;
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

/// The base plane of a picture, and its rays as those of cameras.
struct Oracle<'a> {
    shot: &'a PictureCase,
    volume: &'a Volume,
    axis: usize,
    height: f64,
    per_voxel: f64,
    rays: HashMap<[i64; 2], [f64; 6]>,
}

impl<'a> Oracle<'a> {
    fn new(shot: &'a PictureCase, volume: &'a Volume, axis: usize) -> Self {
        let far = shot.grid.far_corner();
        let [low, high] = shot.settings.crop.unwrap_or([DVec3::ZERO, far]);
        let Intermediate::PerVoxel(per_voxel) = shot.settings.intermediate else {
            panic!("a number of base pixels");
        };
        Self {
            shot,
            volume,
            axis,
            height: 0.5 * (low[axis] + high[axis]),
            per_voxel,
            rays: HashMap::new(),
        }
    }

    fn across(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Colour, or (value, whether there is one, 0, 0), then samples of a base ray and the length that they stand for.
    fn ray(&mut self, at: [i64; 2]) -> [f64; 6] {
        if let Some(&found) = self.rays.get(&at) {
            return found;
        }
        let mut point = DVec3::ZERO;
        for (axis, at) in self.across().into_iter().zip(at) {
            point[axis] = (at as f64 + 0.5) / self.per_voxel;
        }
        point[self.axis] = self.height;
        let target = self.shot.grid.world_from_voxel.transform_point3(point);
        let camera = self.shot.camera;
        let forward = (camera.target - camera.eye).normalize();
        let eye = match camera.projection.is_perspective() {
            true => camera.eye,
            false => target - forward * forward.dot(target - camera.eye),
        };
        let one = PictureCase {
            camera: Camera {
                eye,
                target,
                ..camera
            },
            extent: [1, 1],
            ..self.shot.with(|settings| {
                settings.technique = Technique::Slices2d;
                settings.stack = Some(self.axis);
                settings.order = Order::FrontToBack;
            })
        };
        let transfer = ramps();
        let scene = one.scene(self.volume, Some(&transfer));
        let picture = reference::render::<f64>(&scene).unwrap();
        let layer = |kind| {
            let mut layers = picture.layers.iter();
            layers
                .find(|layer| layer.kind == kind)
                .map(|layer| f64::from(layer.values[0]))
        };
        let samples = layer(LayerKind::Samples).unwrap();
        let voxel_from_world = self.shot.grid.world_from_voxel.inverse();
        let ray = voxel_from_world.transform_vector3((target - eye).normalize());
        let ray = match camera.projection.is_perspective() {
            true => ray,
            false => voxel_from_world.transform_vector3(forward),
        };
        let length = samples / ray[self.axis].abs();
        let found = match layer(LayerKind::Value) {
            None => {
                let [r, g, b, a] = picture.pixels[0].map(f64::from);
                [r, g, b, a, samples, length]
            }
            Some(value) if value.is_nan() => [0.0, 0.0, 0.0, 0.0, samples, length],
            Some(value) => [value, 1.0, 0.0, 0.0, samples, length],
        };
        self.rays.insert(at, found);
        found
    }

    /// How much farther the pixel's ray runs beside the axis than along it, in voxels, and the four rays around with their
    /// weights.
    fn around(&mut self, [x, y]: [u32; 2]) -> (f64, Vec<(f64, [f64; 6])>) {
        let rays = self.shot.camera.rays(self.shot.extent);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let voxel_from_world = self.shot.grid.world_from_voxel.inverse();
        let origin = voxel_from_world.transform_point3(origin);
        let direction = voxel_from_world.transform_vector3(direction);
        let t = (self.height - origin[self.axis]) / direction[self.axis];
        let point = origin + t * direction;
        let place = self.across().map(|axis| self.per_voxel * point[axis] - 0.5);
        let low = place.map(f64::floor);
        let mut all = Vec::new();
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = |k: usize, step: i64| 1.0 - (place[k] - low[k] - step as f64).abs();
            let ray = self.ray([low[0] as i64 + i, low[1] as i64 + j]);
            all.push((weight(0, i) * weight(1, j), ray));
        }
        let steepness = direction.abs().max_element() / direction[self.axis].abs();
        (steepness, all)
    }
}

/// Every channel and layer of a picture against the means of its rays. Returns how many pixels show something.
fn compare(shot: &PictureCase, volume: &Volume, axis: usize) -> usize {
    let found = drawn(shot, volume);
    let mut oracle = Oracle::new(shot, volume, axis);
    let mode = shot.settings.mode;
    let mut worst = Worst::new(format!("{}, axis {axis}", shot.what()));
    let mut seen = 0;
    for (i, pixel) in shot.pixels().enumerate() {
        let (steepness, around) = oracle.around(pixel);
        let sum =
            |of: &dyn Fn(&[f64; 6]) -> f64| around.iter().map(|(w, ray)| w * of(ray)).sum::<f64>();
        let range = |c: usize| {
            let all = around.iter().map(|(_, ray)| ray[c]);
            all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
        };
        // A place in the intermediate image is known to a few roundings of numbers under 64, each of 2^-24 of it.
        let of_place = 2e-5;
        let mut take = |wanted: f64, found: f32, range: f64| {
            // A place on a slice is off by as much more as the ray is steep beside it, and so is the length of a sample.
            let of_rays = 5e-6 * steepness * steepness;
            let allowed = of_rays * wanted.abs().max(1.0) + of_place * range;
            worst.take(pixel, f64::from(found) - wanted, allowed);
        };
        take(sum(&|ray| ray[4]), found.layers[0].values[i], range(4));
        if !mode.is_projection() {
            for c in 0..4 {
                take(sum(&|ray| ray[c]), found.pixels[i][c], range(c));
            }
            take(
                1.0 - sum(&|ray| ray[3]),
                found.layers[1].values[i],
                range(3),
            );
            seen += usize::from(found.pixels[i][3] > 0.01);
            continue;
        }
        let value = found.layers[1].values[i];
        let share = sum(&|ray| ray[1]);
        if share == 0.0 {
            assert!(
                value.is_nan() && found.pixels[i] == [0.0; 4],
                "{pixel:?}: {value}"
            );
            continue;
        }
        if share < 1e-3 {
            worst.leave_out();
            continue;
        }
        let wanted = match mode {
            Mode::Xray => sum(&|ray| ray[0]),
            // Over all that the four have gone through: not the mean of means.
            Mode::Average => sum(&|ray| ray[0] * ray[5]) / sum(&|ray| ray[5]),
            _ => sum(&|ray| ray[0] * ray[1]) / share,
        };
        take(wanted, value, range(0) + range(1));
        seen += 1;
    }
    worst.assert_holds();
    seen
}

#[test]
fn a_pixel_is_the_mean_of_four_rays_through_the_slices_of_a_stack() {
    let grid = sheared();
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    for mode in MODES {
        for shot in shots(grid, &settings(mode, 1.0)) {
            for axis in [0, 1, 2] {
                let shot = shot.with(|settings| settings.stack = Some(axis));
                let seen = compare(&shot, &volume, axis);
                assert!(seen > 100, "only {seen} pixels: {}", shot.what());
            }
        }
    }
}

#[test]
fn so_it_is_of_finer_rays_and_of_a_part_of_the_volume() {
    let grid = sheared();
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    for (per_voxel, mode) in [(2.0, Mode::Composite), (3.7, Mode::Mip), (0.6, Mode::Xray)] {
        for shot in shots(grid, &settings(mode, per_voxel)) {
            let shot = shot.with(|settings| {
                settings.stack = Some(1);
                settings.crop = Some([dvec3(2.3, 4.0, 0.0), dvec3(15.0, 17.6, 11.2)]);
            });
            let seen = compare(&shot, &volume, 1);
            assert!(seen > 100, "only {seen} pixels: {}", shot.what());
        }
    }
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
        let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
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
                    for (i, pixel) in shot.pixels().enumerate() {
                        for c in 0..4 {
                            let error = found.pixels[i][c] - wanted.pixels[i][c];
                            worst.take(pixel, error.into(), 4e-6);
                        }
                        let samples = [&found, &wanted].map(|p| p.layers[0].values[i]);
                        worst.take(pixel, (samples[0] - samples[1]).into(), 1e-4);
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

fn plane(shot: &PictureCase) -> Result<stratavox::technique::shear_warp::BasePlane, Error> {
    base_plane(&View {
        grid: &shot.grid,
        camera: &shot.camera,
        extent_pixels: shot.extent,
        in_pixel: InPixel::CENTER,
        settings: &shot.settings,
    })
}

#[test]
fn the_intermediate_image_does_not_know_the_size_of_the_picture() {
    for shot in shots(sheared(), &settings(Mode::Composite, 1.0)) {
        let small = plane(&shot).unwrap();
        let large = PictureCase {
            extent: shot.extent.map(|n| 2 * n),
            ..shot.clone()
        };
        let large = plane(&large).unwrap();
        assert_eq!((small.rays, small.extent), (large.rays, large.extent));
        // With `pixels` it does.
        let fine = |extent| {
            let shot = shot.with(|settings| settings.intermediate = Intermediate::Pixels);
            plane(&PictureCase { extent, ..shot }).unwrap().per_voxel
        };
        let [small, large] = [fine(shot.extent), fine(shot.extent.map(|n| 2 * n))];
        assert!((large / small - 2.0).abs() < 1e-6, "{small}, {large}");
    }
}

#[test]
fn an_eye_among_the_slices_and_images_without_end_are_refused_by_name() {
    let [_, mut shot] = shots(sheared(), &settings(Mode::Composite, 1.0));
    shot.settings.stack = Some(2);
    let inside = sheared()
        .world_from_voxel
        .transform_point3(dvec3(-9.0, 3.0, 6.0));
    shot.camera.eye = inside;
    assert_eq!(plane(&shot), Err(Error::EyeAmongSlices));
    let [mut steep, _] = shots(sheared(), &settings(Mode::Composite, 1.0));
    steep.settings.stack = Some(0);
    let beside = steep
        .grid
        .world_from_voxel
        .transform_vector3(dvec3(1e-4, 0.3, 1.0));
    steep.camera.eye = steep.camera.target - 40.0 * beside.normalize();
    steep.camera.up = DVec3::X;
    steep.camera.projection = Projection::Orthographic { view_height: 1e6 };
    let found = plane(&steep);
    assert!(
        matches!(found, Err(Error::IntermediateTooLarge { .. })),
        "{found:?}"
    );
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
