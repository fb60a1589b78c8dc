//! The base lattice belongs to the volume: what a camera that moves along it sees, from how far away it sees, and into which
//! parts the volume is cut between its slices.

use super::{blend_error, cubes, drawn, place_error, plane, settings, straight};
use crate::shared::{PictureCase, Worst, volume_of, waves};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::picture::Picture;
use stratavox::technique::Mode;
use stratavox::volume::Grid;

/// Moved by whole voxels, no number is rounded: places in these voxels are multiples of powers of 2.
#[test]
fn a_camera_that_pans_by_whole_voxels_sees_the_same_pixels_elsewhere() {
    let grid = Grid {
        dims: [16, 18, 20],
        world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0))
            * DAffine3::from_scale(dvec3(2.0, 1.0, 0.5)),
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    for (per_voxel, mode) in [
        (1.0, Mode::Composite),
        (2.0, Mode::Mip),
        (4.0, Mode::Average),
    ] {
        for axis in [0, 1, 2] {
            for towards in [1.0, -1.0] {
                let mut shot = straight(grid, axis, towards, settings(mode, per_voxel));
                // The domain begins between base pixels, and the picture beside it.
                shot.settings.crop = Some([DVec3::splat(2.3), grid.far_corner() - 1.4]);
                shot.extent = [80, 72];
                let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
                let sides = grid.world_from_voxel.matrix3;
                let (i, j) = (sides * DVec3::AXES[i], sides * DVec3::AXES[j]);
                // Half of the smaller voxel: a voxel is a whole number of pixels both ways.
                let pixel = 0.5 * i.length().min(j.length());
                shot.camera.projection = Projection::Orthographic {
                    view_height: pixel * f64::from(shot.extent[1]),
                };
                let rays = shot.camera.rays(shot.extent);
                let wanted = drawn(&shot, &volume);
                for pan in [1.0 * i - 2.0 * j, 4.0 * i + 3.0 * j] {
                    let mut panned = shot.clone();
                    panned.camera.eye += pan;
                    panned.camera.target += pan;
                    let found = drawn(&panned, &volume);
                    let by = [rays.origin_dx, rays.origin_dy]
                        .map(|d| (pan.dot(d) / pixel / pixel).round() as i32);
                    assert_same_elsewhere(&shot, by, &wanted, &found);
                }
            }
        }
    }
}

fn assert_same_elsewhere(shot: &PictureCase, by: [i32; 2], wanted: &Picture, found: &Picture) {
    let [width, height] = shot.extent.map(|n| n as i32);
    let mut seen = 0;
    for y in 0..height {
        for x in 0..width {
            let (from_x, from_y) = (x + by[0], y + by[1]);
            if !(0..width).contains(&from_x) || !(0..height).contains(&from_y) {
                continue;
            }
            let [at, from] = [(x, y), (from_x, from_y)].map(|(x, y)| (x + width * y) as usize);
            let numbers = |picture: &Picture, i: usize| {
                let layers = picture.layers.iter().map(|layer| layer.values[i]);
                let all = picture.pixels[i].into_iter().chain(layers);
                all.map(f32::to_bits).collect::<Vec<_>>()
            };
            let (found, wanted) = (numbers(found, at), numbers(wanted, from));
            assert_eq!(
                found,
                wanted,
                "{:?} of {}, panned by {by:?}",
                [x, y],
                shot.what()
            );
            seen += usize::from(found[3] != 0);
        }
    }
    assert!(seen > 200, "only {seen} pixels of {}", shot.what());
}

/// Parallel rays, and those of an eye as far away as that: 10^4 radii of the grid, and more.
fn parallel_and_from_far_away(axis: usize, slope: f64, mode: Mode) -> [PictureCase; 2] {
    let grid = cubes([16, 20, 14]);
    let mut parallel = straight(grid, axis, 1.0, settings(mode, 1.0));
    let Projection::Orthographic { view_height } = parallel.camera.projection else {
        panic!("parallel");
    };
    let towards = DVec3::AXES[axis] + slope * DVec3::AXES[(axis + 1) % 3];
    let distance = 1e4 * 0.5 * grid.far_corner().length();
    parallel.camera.eye = parallel.camera.target - distance * towards.normalize();
    parallel.settings.stack = Some(axis);
    let mut far = parallel.clone();
    far.camera.projection = Projection::Perspective {
        fov_degrees: 2.0 * (0.5 * view_height / distance).atan().to_degrees(),
    };
    [parallel, far]
}

/// By how much channels of neighbours differ at most, which are a voxel away from each other.
fn steepest(picture: &Picture) -> f64 {
    let width = picture.width as usize;
    let pairs = |step: usize| picture.pixels.iter().zip(&picture.pixels[step..]);
    let inside = |pixel: &[f32; 4]| pixel[3] > 0.0;
    let both = pairs(1)
        .chain(pairs(width))
        .filter(|(a, b)| inside(a) && inside(b));
    let apart = both.flat_map(|(a, b)| [0, 1, 2, 3].map(|c| f64::from((a[c] - b[c]).abs())));
    apart.fold(0.0, f64::max)
}

#[test]
fn an_eye_far_away_sees_what_parallel_rays_see() {
    for axis in [0, 1, 2] {
        for mode in [Mode::Composite, Mode::Mip, Mode::Average] {
            for slope in [0.0, 0.75, -0.75] {
                let [parallel, far] = parallel_and_from_far_away(axis, slope, mode);
                let volume = volume_of(far.grid.dims, far.grid.world_from_voxel, waves);
                let [wanted, found] = [&parallel, &far].map(|shot| drawn(shot, &volume));
                // A direction of f32 is off by 2^-24 of itself, the way of its ray through 10^5 voxels by 2^-24 of them, along
                // two axes beside the slices, and so is its start: rays of a slope lie beside where they should.
                let away = (far.camera.target - far.camera.eye).length();
                let beside = if slope == 0.0 {
                    0.0
                } else {
                    4.0 * away / f64::from(1 << 24)
                };
                let allowed = 1e-3 + beside * steepest(&wanted);
                let mut worst = Worst::new(far.what());
                for (i, pixel) in far.pixels().enumerate() {
                    let [a, b] = [&wanted, &found].map(|picture| picture.layers[0].values[i]);
                    // A sample more, or less, at a face that rays run along.
                    if (a - b).abs() > 0.05 {
                        worst.leave_out();
                        continue;
                    }
                    for c in 0..4 {
                        let error = found.pixels[i][c] - wanted.pixels[i][c];
                        worst.take(pixel, error.into(), allowed);
                    }
                }
                worst.assert_holds();
            }
        }
    }
}

/// Two parts of a volume that meet between two slices, the near one over the far one: in each of `base` pixels both have their
/// base pixels on one line.
fn assert_composed(shot: &PictureCase, axis: usize, between: f64, is_far_first: bool) {
    let volume = volume_of(shot.grid.dims, shot.grid.world_from_voxel, waves);
    // Places of samples are multiples of 1/4: no ray meets a slice at an edge of this.
    let low = DVec3::splat(0.1) - 0.1 * DVec3::AXES[axis];
    let far = shot.grid.far_corner() - low;
    let (mut end, mut begin) = (far, low);
    end[axis] = between;
    begin[axis] = between;
    let shot = &shot.with(|settings| settings.crop = Some([low, far]));
    let part = |crop| {
        let shot = shot.with(|settings| settings.crop = Some(crop));
        (drawn(&shot, &volume), plane(&shot).unwrap())
    };
    let mut parts = [part([low, end]), part([begin, far])];
    if is_far_first {
        parts.reverse();
    }
    let [(near, near_plane), (behind, behind_plane)] = parts;
    let whole = drawn(shot, &volume);
    let mut worst = Worst::new(shot.what());
    let slices = shot.grid.dims[axis];
    for (i, pixel) in shot.pixels().enumerate() {
        // Weights of the four are 1 and 0, or as far off as places are.
        let of_places = [&near_plane, &behind_plane, &plane(shot).unwrap()]
            .map(|plane| place_error(plane, pixel))
            .iter()
            .sum::<f64>();
        for c in 0..4 {
            let [near, behind, whole] =
                [&near, &behind, &whole].map(|p| p.pixels[i].map(f64::from));
            let over = near[c] + (1.0 - near[3]) * behind[c];
            worst.take(pixel, over - whole[c], blend_error(slices) + of_places);
        }
    }
    worst.assert_holds();
    for (name, picture) in [("near", &near), ("far", &behind)] {
        let seen = picture.pixels.iter().filter(|pixel| pixel[3] > 0.01);
        assert!(seen.count() > 100, "the {name} part of {}", shot.what());
    }
}

#[test]
fn two_parts_that_meet_between_slices_are_the_whole_one_over_the_other() {
    let grid = cubes([16, 16, 16]);
    for axis in [0, 1, 2] {
        for towards in [1.0, -1.0] {
            let shot = straight(grid, axis, towards, settings(Mode::Composite, 2.0));
            for between in [8.0, 3.0] {
                assert_composed(&shot, axis, between, towards < 0.0);
            }
            assert_composed(&sheared(grid, axis, towards), axis, 8.0, towards < 0.0);
        }
    }
}

/// Rays that move by 3/4 of a voxel from slice to slice, along one axis of the base plane: by whole voxels between the middles of
/// the whole and of its halves, whose base rays are the same lines so. A pixel is 5/4 of a voxel on the plane along that axis,
/// 1 along the other, and all of them lie on base pixels, of which there are 4 a voxel.
fn sheared(grid: Grid, axis: usize, towards: f64) -> PictureCase {
    let [i, j] = [(axis + 1) % 3, (axis + 2) % 3].map(|k| DVec3::AXES[k]);
    let direction = towards * (4.0 * DVec3::AXES[axis] + 3.0 * i) / 5.0;
    let target = grid.center() + (i + j) / 8.0;
    let side = 15;
    PictureCase {
        grid,
        camera: Camera {
            eye: target - 40.0 * direction,
            target,
            up: j,
            projection: Projection::Orthographic {
                view_height: side.into(),
            },
            zoom: 1.0,
        },
        extent: [side; 2],
        settings: settings(Mode::Composite, 4.0),
    }
}
