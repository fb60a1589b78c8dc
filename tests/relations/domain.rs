//! What is kept of a volume, and from where it is looked at: the eye inside with a wide lens, crop boxes with
//! fractions, clip planes, holes, flat volumes, long voxels, a world far from its origin, several rays a
//! pixel. Exact answers hold in all of them, and the device follows its CPU reference.

use crate::shared::oracle::{constant_color, homogeneous, linear_density};
use crate::shared::{
    Chord, Device, PictureCase, Reference, Way, Worst, device, inner_box, oblique_camera,
    oblique_shots, ramps, sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::LayerKind;
use stratavox::shaders::MAX_CLIP_PLANES;
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::{ClipPlane, Filter, Mode, Technique};
use stratavox::volume::{Grid, Rescale, Volume, Voxels};

const SHEARED: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

fn ways() -> [Box<dyn Way>; 3] {
    [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
        Box::new(Device),
    ]
}

/// A2 where nothing is cut yet: without the outer half voxel.
fn inner(shot: &PictureCase) -> PictureCase {
    let inner = inner_box(&shot.grid);
    shot.with(|settings| {
        let [low, high] = settings.crop.unwrap_or(inner);
        settings.crop = Some([low.max(inner[0]), high.min(inner[1])]);
    })
}

fn exact_answers_hold(shots: &[PictureCase]) {
    for way in ways() {
        for shot in shots {
            homogeneous(&*way, shot).assert_holds();
            constant_color(&*way, shot).assert_holds();
            linear_density(&*way, &inner(shot)).assert_holds();
        }
    }
}

#[test]
fn exact_answers_hold_with_the_eye_inside_and_a_wide_lens() {
    let grid = SHEARED();
    let wide = Projection::Perspective { fov_degrees: 120.0 };
    let mut shots = Vec::new();
    for voxel in [dvec3(7.3, 12.1, 6.2), dvec3(2.2, 18.7, 11.4)] {
        let camera = Camera {
            eye: grid.world_from_voxel.transform_point3(voxel),
            ..oblique_camera(&grid, wide)
        };
        // Orthographic rays start on the plane through the eye.
        let parallel = Camera {
            projection: Projection::Orthographic { view_height: 14.0 },
            ..camera
        };
        for camera in [camera, parallel] {
            let all = oblique_shots(grid, Mode::Composite).into_iter().take(6);
            shots.extend(all.map(|shot| PictureCase { camera, ..shot }));
        }
    }
    exact_answers_hold(&shots);
}

#[test]
fn exact_answers_hold_in_a_crop_box_with_fractions() {
    let crop = [dvec3(2.3, 5.7, 1.1), dvec3(14.9, 18.2, 11.6)];
    let shots = oblique_shots(SHEARED(), Mode::Composite).into_iter();
    let shots = shots.map(|shot| shot.with(|settings| settings.crop = Some(crop)));
    exact_answers_hold(&shots.collect::<Vec<_>>());
}

#[test]
fn exact_answers_hold_between_clip_planes() {
    let grid = SHEARED();
    let plane = |normal: DVec3, back: f64| {
        let normal = normal.normalize();
        ClipPlane {
            normal,
            offset: normal.dot(grid.center()) - back,
        }
    };
    let planes = vec![
        plane(dvec3(1.0, 0.4, -0.3), 4.1),
        plane(dvec3(-0.5, 1.0, 0.6), 3.7),
        plane(dvec3(-0.2, -0.8, 1.0), 5.3),
    ];
    let shots = oblique_shots(grid, Mode::Composite).into_iter();
    let shots = shots.map(|shot| shot.with(|settings| settings.clip_planes = planes.clone()));
    exact_answers_hold(&shots.collect::<Vec<_>>());
}

/// Planes around the centre of a grid, all as far from it: their normals are the Fibonacci points of a sphere.
fn planes_around(grid: &Grid, count: usize, radius: f64) -> Vec<ClipPlane> {
    let normal = |i: usize| {
        let z: f64 = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let turn = i as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let [x, y] = [turn.cos(), turn.sin()].map(|part| (1.0 - z * z).sqrt() * part);
        dvec3(x, y, z)
    };
    let plane = |normal: DVec3| ClipPlane {
        normal,
        offset: normal.dot(grid.center()) - radius,
    };
    (0..count).map(|i| plane(normal(i))).collect()
}

#[test]
fn a_polytope_of_as_many_planes_as_there_may_be_is_cut_out_exactly() {
    let grid = SHEARED();
    let limit = MAX_CLIP_PLANES as usize;
    for count in [200, limit] {
        let planes = planes_around(&grid, count, 5.2);
        let shots = oblique_shots(grid, Mode::Composite).into_iter();
        let shots = shots.map(|shot| shot.with(|settings| settings.clip_planes = planes.clone()));
        for shot in shots {
            let extent = [16, 14];
            let shot = PictureCase { extent, ..shot };
            let lengths = shot
                .pixels()
                .filter_map(|pixel| Some(Chord::of(&shot, pixel)?.length()));
            let longest = lengths.fold(0.0, f64::max);
            assert!(
                (9.0..11.5).contains(&longest),
                "{longest} of a ball of 10.4"
            );
            for way in ways() {
                homogeneous(&*way, &shot).assert_holds();
            }
        }
    }
    let mut shot = oblique_shots(grid, Mode::Composite).remove(0);
    shot.settings.clip_planes = planes_around(&grid, limit + 1, 5.2);
    let refused = shot.view().on_cpu().unwrap_err();
    assert_eq!(
        refused.to_string(),
        format!("{} clip planes, the limit is {limit}", limit + 1)
    );
}

#[test]
fn exact_answers_hold_for_long_voxels() {
    let turned = DMat3::from_rotation_x(0.3) * DMat3::from_diagonal(dvec3(1.0, 1.0, 4.0));
    let grid = Grid {
        dims: [22, 18, 6],
        world_from_voxel: DAffine3::from_mat3_translation(turned, dvec3(-3.0, 7.0, 2.0)),
    };
    exact_answers_hold(&oblique_shots(grid, Mode::Composite));
}

#[test]
fn a_homogeneous_volume_may_have_axes_of_one_voxel() {
    let scale = DAffine3::from_scale(dvec3(1.0, 1.2, 0.9));
    for dims in [
        [1, 14, 12],
        [15, 1, 12],
        [15, 14, 1],
        [1, 1, 16],
        [18, 1, 1],
        [1, 1, 1],
    ] {
        let grid = Grid {
            dims,
            world_from_voxel: scale,
        };
        for way in ways() {
            for shot in oblique_shots(grid, Mode::Composite) {
                homogeneous(&*way, &shot).assert_holds();
            }
        }
    }
}

#[test]
fn a_world_far_from_its_origin_is_the_same_picture() {
    let far = dvec3(1e6, -1e6, 2e6);
    let away = DAffine3::from_translation(far) * sheared_affine();
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let moved = volume_of(SHEARED().dims, away, waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut of_moved = Renderer::new(device(), &moved).unwrap();
    for shot in oblique_shots(SHEARED(), Mode::Composite) {
        let camera = Camera {
            eye: shot.camera.eye + far,
            target: shot.camera.target + far,
            ..shot.camera
        };
        let away = PictureCase {
            grid: moved.grid(),
            camera,
            ..shot.clone()
        };
        let scene = shot.scene(&volume, Some(&transfer));
        let wanted = renderer.render(&scene, &[]).unwrap().picture;
        let scene = away.scene(&moved, Some(&transfer));
        let found = of_moved.render(&scene, &[]).unwrap().picture;
        let what = format!("far away, {}", shot.what());
        Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 1e-5).assert_holds();
    }
}

/// Values of 1, and holes in the second and in the fifth of every seven voxels.
fn pierced(dims: [u32; 3]) -> Volume {
    let count: u32 = dims.iter().product();
    let is_hole = |i: u32| matches!((i.wrapping_mul(2_654_435_761) >> 16) % 19, 2 | 5);
    let codes = (0..count).map(|i| if is_hole(i) { 200 } else { 1 });
    let voxels = Voxels::U8(codes.collect());
    Volume::from_voxels(
        dims,
        sheared_affine(),
        voxels,
        Rescale::default(),
        Some(200.0),
    )
    .unwrap()
}

#[test]
fn a_sample_counts_where_its_whole_footprint_has_data() {
    // The X-ray of ones is the length of the samples that count. Which do is found out here by the rule alone:
    // all voxels with a weight must be there.
    let volume = pierced([12, 10, 14]);
    let validity = volume.validity.clone().expect("holes");
    let is_valid = |voxel: [i64; 3]| {
        let [x, y, z] =
            [0, 1, 2].map(|k| voxel[k].clamp(0, i64::from(volume.dims[k]) - 1) as usize);
        validity[(z * volume.dims[1] as usize + y) * volume.dims[0] as usize + x] == 1
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let transfer = ramps();
    for conformance in [true, false] {
        for filter in [Filter::Nearest, Filter::Linear] {
            for shot in oblique_shots(volume.grid(), Mode::Xray) {
                let shot = shot.with(|settings| {
                    settings.filter = filter;
                    settings.conformance = conformance;
                });
                let voxel_from_world = shot.grid.world_from_voxel.inverse();
                let axis = stack_axis(&shot.view());
                let in_slice = shot.settings.technique == Technique::Slices2d;
                // Length that counts, and whether some sample is too close to a border to say.
                let wanted = |pixel| {
                    let chord = Chord::of(&shot, pixel)?;
                    let mut sum = 0.0;
                    let mut hangs = chord.hangs;
                    for &(t, length) in &chord.samples {
                        let p = voxel_from_world.transform_point3(chord.at(t)).to_array();
                        let lattice = |k: usize| match filter {
                            Filter::Nearest => p[k],
                            _ => p[k] - 0.5,
                        };
                        let fixed = |k: usize| in_slice && k == axis;
                        hangs |= (0..3)
                            .any(|k| !fixed(k) && (lattice(k) - lattice(k).round()).abs() < 1e-4);
                        let taps = |k: usize| {
                            let first = lattice(k).floor() as i64;
                            let last = match filter {
                                _ if fixed(k) => return p[k].floor() as i64..=p[k].floor() as i64,
                                Filter::Nearest => first,
                                _ => first + 1,
                            };
                            first..=last
                        };
                        let counts =
                            taps(2).all(|z| taps(1).all(|y| taps(0).all(|x| is_valid([x, y, z]))));
                        if counts {
                            sum += length;
                        }
                    }
                    Some((sum, hangs))
                };
                let scene = shot.scene(&volume, Some(&transfer));
                let on_device = renderer
                    .render(&scene, &[LayerKind::Value])
                    .unwrap()
                    .picture;
                let on_cpu = reference::render::<f64>(&scene).unwrap();
                for (way, picture) in [("device", on_device), ("reference", on_cpu)] {
                    let values = picture.layers.iter().find(|l| l.kind == LayerKind::Value);
                    let values = &values.unwrap().values;
                    let what = format!("holes, {filter:?}, {way}, {}", shot.what());
                    let mut worst = Worst::new(what);
                    for (pixel, &found) in shot.pixels().zip(values) {
                        let Some((wanted, hangs)) = wanted(pixel) else {
                            continue;
                        };
                        if hangs {
                            worst.leave_out();
                            continue;
                        }
                        let found = if found.is_nan() {
                            0.0
                        } else {
                            f64::from(found)
                        };
                        worst.take(pixel, found - wanted, 1e-4);
                    }
                    worst.assert_holds();
                }
            }
        }
    }
}

#[test]
fn several_rays_a_pixel_are_the_mean_of_a_finer_picture() {
    // The rays of a pixel lie where a picture of twice (thrice) the size has its pixel centres.
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in [Mode::Composite, Mode::Mip] {
        for shot in oblique_shots(SHEARED(), mode) {
            for per_side in [2, 3] {
                let together = shot.with(|settings| settings.rays_per_side = per_side);
                let finer = PictureCase {
                    extent: shot.extent.map(|n| n * per_side),
                    ..shot.clone()
                };
                let layers = [LayerKind::Samples];
                let scene = together.scene(&volume, Some(&transfer));
                let found = renderer.render(&scene, &layers).unwrap().picture;
                let cpu = reference::render::<f32>(&scene).unwrap();
                let scene = finer.scene(&volume, Some(&transfer));
                let fine = renderer.render(&scene, &[]).unwrap().picture;
                let weight = 1.0 / (per_side * per_side) as f32;
                let mean = |[x, y]: [u32; 2]| {
                    let mut sum = [0.0f32; 4];
                    for j in 0..per_side {
                        for i in 0..per_side {
                            let at = (y * per_side + j) * fine.width + x * per_side + i;
                            let pixel = fine.pixels[at as usize];
                            sum = [0, 1, 2, 3].map(|c: usize| sum[c] + weight * pixel[c]);
                        }
                    }
                    sum
                };
                let hangs = |[x, y]: [u32; 2]| {
                    let inside = (0..per_side * per_side)
                        .map(|i| [x * per_side + i % per_side, y * per_side + i / per_side]);
                    inside
                        .filter_map(|p| Chord::of(&finer, p))
                        .any(|chord| chord.hangs)
                };
                // The parameters differ in the last place, and with them where samples lie.
                for (way, picture) in [("device", &found), ("reference", &cpu)] {
                    let what = format!("{per_side} rays a side, {way}, {}", shot.what());
                    let mut worst = Worst::new(what);
                    for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                        if hangs(pixel) {
                            worst.leave_out();
                            continue;
                        }
                        for (wanted, found) in mean(pixel).into_iter().zip(found) {
                            worst.take(pixel, f64::from(found - wanted), 1e-5);
                        }
                    }
                    worst.assert_holds();
                }
                // The other layers come from the pixel's centre.
                let scene = shot.scene(&volume, Some(&transfer));
                let single = renderer.render(&scene, &layers).unwrap().picture;
                assert_eq!(single.layers, found.layers, "{}", shot.what());
            }
        }
    }
}
