//! A29: the polygon of a plane and a box against brute force, and the cover that the device draws against
//! the samples of its CPU reference, pixel by pixel.

use crate::shared::{
    Chord, PictureCase, Worst, device, oblique_shots, ramps, sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::shaders::Frame;
use stratavox::technique::slices_3d::cover::polygon;
use stratavox::technique::{Mode, Settings, Technique};
use stratavox::volume::Grid;

/// Directions all over the sphere: the golden spiral.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    (0..count).map(move |i| {
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (s, c) = (golden * f64::from(i)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        dvec3(r * c, r * s, z)
    })
}

/// Along each axis, either way: planes that lie along faces.
fn axes() -> impl Iterator<Item = DVec3> {
    DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis])
}

fn shot_along(grid: Grid, forward: DVec3, samples_per_voxel: f64) -> PictureCase {
    let size = (grid.world_from_voxel.matrix3 * grid.far_corner()).length();
    let camera = Camera {
        eye: grid.center() - 2.0 * size * forward,
        target: grid.center(),
        up: forward.any_orthonormal_vector(),
        projection: Projection::Orthographic { view_height: size },
        zoom: 1.0,
    };
    PictureCase {
        grid,
        camera,
        extent: [32, 32],
        settings: Settings {
            technique: Technique::Slices3d,
            samples_per_voxel,
            ..Settings::default()
        },
    }
}

fn area(corners: &[DVec3], normal: DVec3) -> f64 {
    let sum = |i: usize| (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    let sum: DVec3 = (1..corners.len().max(2) - 1).map(sum).sum();
    0.5 * sum.dot(normal)
}

/// The cover's eight corners in the centred world.
fn box_corners(frame: &Frame) -> [DVec3; 8] {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let (low, high) = (vector(frame.cover_min), vector(frame.cover_max));
    let rows = frame.world_from_voxel.map(|row| row.map(f64::from));
    let m = DMat3::from_cols_array_2d(&rows.map(|[x, y, z, _]| [x, y, z])).transpose();
    let at_origin = DVec3::from_array(rows.map(|row| row[3]));
    std::array::from_fn(|i| {
        let part = DVec3::from_array([i & 1, i >> 1 & 1, i >> 2].map(|b| b as f64));
        m * (low + part * (high - low)) + at_origin
    })
}

/// Cuts all twelve edges and puts what is found in order around the middle.
fn brute_force_area(frame: &Frame, normal: DVec3, height: f64) -> f64 {
    let corners = box_corners(frame);
    let mut cuts = Vec::new();
    for i in 0..8usize {
        for bit in [1, 2, 4].into_iter().filter(|bit| i & bit == 0) {
            let (a, b) = (corners[i], corners[i | bit]);
            let (rise, part) = (normal.dot(b - a), height - normal.dot(a));
            if rise.abs() > 1e-12 && (0.0..=1.0).contains(&(part / rise)) {
                cuts.push(a + (b - a) * (part / rise));
            }
        }
    }
    if cuts.len() < 3 {
        return 0.0;
    }
    let middle = cuts.iter().sum::<DVec3>() / cuts.len() as f64;
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let angle = |p: &DVec3| v.dot(*p - middle).atan2(u.dot(*p - middle));
    cuts.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    area(&cuts, normal).abs()
}

fn grids() -> [Grid; 2] {
    let cube = Grid {
        dims: [8; 3],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let sheared = Grid {
        dims: [9, 6, 7],
        world_from_voxel: sheared_affine(),
    };
    [cube, sheared]
}

#[test]
fn the_six_vertices_bound_the_area_that_brute_force_finds() {
    let mut worst = Worst::new("A29, area");
    for grid in grids() {
        for forward in directions(200).chain(axes()) {
            let shot = shot_along(grid, forward, 3.0);
            let (frame, count) = shot.parameters();
            let normal = DVec3::from_array(frame.forward.map(f64::from));
            for i in 0..count {
                let plane = frame.slice_first + i as i32 * frame.slice_direction;
                let corners = polygon::<f64>(&frame, plane).map(DVec3::from_array);
                let height = (f64::from(plane) + 0.5) * f64::from(frame.step_world);
                let wanted = brute_force_area(&frame, normal, height);
                // f32 knows an axis only to 1e-7: a plane along a face is on one side of it or the other.
                let allowed = 1e-5 * wanted.max(1.0);
                worst.take([i, 0], area(&corners, normal).abs() - wanted, allowed);
                if wanted > 0.0 {
                    let off = corners.map(|p| (normal.dot(p) - height).abs());
                    worst.take([i, 1], off.into_iter().fold(0.0, f64::max), 1e-5);
                }
            }
        }
    }
    worst.assert_holds();
}

#[test]
fn the_areas_of_all_planes_add_up_to_the_volume() {
    // The area as a function of height is a quadratic between corners and has no jumps: the sum over N planes is
    // off by some 1/N^2 of it.
    let mut worst = Worst::new("A29, volume");
    for grid in grids() {
        for (i, forward) in (0..).zip(directions(60)) {
            let shot = shot_along(grid, forward, 40.0);
            let (mut frame, count) = shot.parameters();
            // The domain instead of its cover, whose planes are all drawn.
            frame.cover_min = frame.domain_min;
            frame.cover_max = frame.domain_max;
            let normal = DVec3::from_array(frame.forward.map(f64::from));
            let areas = (0..count).map(|i| {
                let plane = frame.slice_first + i as i32 * frame.slice_direction;
                area(
                    &polygon::<f64>(&frame, plane).map(DVec3::from_array),
                    normal,
                )
                .abs()
            });
            let found = areas.sum::<f64>() * f64::from(frame.step_world);
            let dims: f64 = grid.dims.map(f64::from).into_iter().product();
            let wanted = dims * grid.world_from_voxel.matrix3.determinant().abs();
            let planes = f64::from(count);
            worst.take([i, 0], found / wanted - 1.0, 1e-5 + 2.0 / (planes * planes));
        }
    }
    worst.assert_holds();
}

#[test]
fn the_cover_leaves_out_no_sample_and_doubles_none() {
    // Additive blending of ones: the device counts, and must count what its CPU reference does without a cover.
    let grid = Grid {
        dims: [9, 11, 8],
        world_from_voxel: sheared_affine(),
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut cameras: Vec<Camera> = oblique_shots(grid, Mode::Mip)
        .iter()
        .map(|s| s.camera)
        .collect();
    for forward in directions(24) {
        cameras.push(shot_along(grid, forward, 1.0).camera);
        // From inside, the cover goes behind the eye.
        cameras.push(Camera {
            eye: grid.center() + 0.7 * forward,
            target: grid.center() + dvec3(2.0, 1.0, -3.0),
            up: DVec3::Z,
            projection: Projection::Perspective { fov_degrees: 120.0 },
            zoom: 1.0,
        });
    }
    for technique in [Technique::Slices3d, Technique::Slices2d] {
        let mut worst = Worst::new(format!("samples counted, {technique:?}"));
        for camera in &cameras {
            let shot = PictureCase {
                grid,
                camera: *camera,
                extent: [40, 36],
                settings: Settings {
                    technique,
                    conformance: true,
                    ..Settings::default()
                },
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer: Some(&transfer),
                camera,
                extent_pixels: shot.extent,
                settings: &shot.settings,
            };
            let found = renderer
                .render(&scene, &[LayerKind::Samples])
                .unwrap()
                .picture;
            let wanted = reference::render::<f32>(&scene).unwrap();
            let wanted = wanted
                .layers
                .iter()
                .find(|l| l.kind == LayerKind::Samples)
                .unwrap();
            let pairs = found.layers[0].values.iter().zip(&wanted.values);
            for (pixel, (found, wanted)) in shot.pixels().zip(pairs) {
                if Chord::of(&shot, pixel).is_some_and(|chord| chord.hangs) {
                    worst.leave_out();
                } else {
                    worst.take(pixel, f64::from(found - wanted), 0.5);
                }
            }
        }
        worst.assert_holds();
    }
}
