//! The voxels of Bresenham's line, in whole numbers: along the main axis k of the direction d, from the voxel v on,
//!
//! ```text
//! i_j = v_i + floor(1/2 + (j - v_k) d_i / d_k)        a tie takes the higher voxel
//! ```

use super::{drawn, settings};
use crate::shared::{PictureCase, device, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::lattice::on_main_axis;
use stratavox::offscreen::Renderer;
use stratavox::ray::Ray;
use stratavox::technique::{Filter, Mode};
use stratavox::volume::Grid;

const SIDE: i64 = 19;
const GRID: Grid = Grid {
    dims: [SIDE as u32; 3],
    world_from_voxel: DAffine3::IDENTITY,
};

/// From front to back, those in the grid.
fn line(voxel: [i64; 3], direction: [i64; 3]) -> Vec<[i64; 3]> {
    let largest = direction.map(i64::abs).into_iter().max().unwrap();
    let k = direction.iter().position(|d| d.abs() == largest).unwrap();
    let at = |j: i64| {
        [0, 1, 2].map(|i| {
            let sign = direction[k].signum();
            let twice = direction[k] + 2 * (j - voxel[k]) * direction[i];
            voxel[i] + (sign * twice).div_euclid(2 * largest)
        })
    };
    let mut voxels: Vec<_> = (0..SIDE).map(at).collect();
    if direction[k] < 0 {
        voxels.reverse();
    }
    voxels.retain(|voxel| voxel.iter().all(|i| (0..SIDE).contains(i)));
    voxels
}

fn center(voxel: [i64; 3]) -> DVec3 {
    DVec3::from_array(voxel.map(|i| i as f64 + 0.5))
}

fn shot(voxel: [i64; 3], direction: [i64; 3]) -> PictureCase {
    let towards = DVec3::from_array(direction.map(|d| d as f64)).normalize();
    PictureCase {
        grid: GRID,
        camera: Camera {
            eye: center(voxel) - 40.0 * towards,
            target: center(voxel),
            up: towards.any_orthonormal_vector(),
            projection: Projection::Orthographic { view_height: 1.0 },
            zoom: 1.0,
        },
        extent: [1, 1],
        settings: settings(Mode::Average, 1.0),
    }
}

/// Directions along each axis, in all octants.
fn directions(main: i64, others: &[i64]) -> Vec<[i64; 3]> {
    let mut all = Vec::new();
    for k in 0..3 {
        for main in [main, -main] {
            for &a in others {
                for &b in others {
                    let mut direction = [main; 3];
                    direction[(k + 1) % 3] = a;
                    direction[(k + 2) % 3] = b;
                    all.push(direction);
                }
            }
        }
    }
    all
}

#[test]
fn the_reference_visits_bresenhams_voxels_and_a_tie_takes_the_higher_one() {
    let (frame, _) = shot([9; 3], [1, 0, 0]).parameters();
    let others = [-8, -7, -5, -4, -2, -1, 0, 1, 3, 4, 6, 8];
    let (mut visited, mut ties) = (0, 0);
    // Of powers of two: f64 rounds nothing on the way, and ties are ties.
    for direction in directions(8, &others) {
        let voxel = [9, 8, 10];
        let ray = Ray {
            origin: center(voxel).to_array(),
            direction: direction.map(|d| d as f64),
        };
        let samples = on_main_axis(&frame, &ray, [-16.0, 16.0]);
        let places = samples.map(|sample| ray.at(sample.t));
        let inside = |place: &[f64; 3]| place.iter().all(|&x| (0.0..SIDE as f64).contains(&x));
        let places: Vec<_> = places.filter(inside).collect();
        let found: Vec<_> = places.iter().map(|p| p.map(|x| x.floor() as i64)).collect();
        assert_eq!(found, line(voxel, direction), "{direction:?}");
        visited += found.len();
        ties += places
            .iter()
            .filter(|p| p.iter().any(|x| x.fract() == 0.0))
            .count();
    }
    assert!(visited > 9000 && ties > 1000, "{visited}, {ties} ties");
}

#[test]
fn the_device_visits_bresenhams_voxels_in_all_octants() {
    // A sum tells which voxels were there: any other one makes a difference of 1 at least.
    let field = |p: DVec3| {
        let [x, y, z] = p.floor().to_array().map(|x| x as u32);
        let number = (x + 19 * (y + 19 * z)).wrapping_mul(2_654_435_761);
        f64::from(number >> 22)
    };
    let volume = volume_of(GRID.dims, GRID.world_from_voxel, field);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let (mut visited, mut lines) = (0, 0);
    // Of odd length: no sample is nearer to a border than 1/26 of a voxel.
    for (main, others) in [(13, [-13, -9, 2, 6, 12]), (5, [-4, -1, 0, 3, 5])] {
        for (nth, direction) in directions(main, &others).into_iter().enumerate() {
            let voxel = [nth, 7 * nth, 3 * nth].map(|n| 2 + (n % 15) as i64);
            let shot = shot(voxel, direction);
            let shot = shot.with(|settings| settings.filter = Filter::Nearest);
            let picture = drawn(&mut renderer, &shot, &volume);
            let [samples, mean] = [0, 1].map(|i| f64::from(picture.layers[i].values[0]));
            let wanted = line(voxel, direction);
            let what = format!("{voxel:?} along {direction:?}");
            assert_eq!(samples, wanted.len() as f64, "{what}");
            let values = wanted.iter().map(|&voxel| field(center(voxel)));
            let off = (mean * samples - values.sum::<f64>()).abs();
            assert!(off < 0.1, "{what}: off by {off}");
            visited += wanted.len();
            lines += 1;
        }
    }
    assert!(lines == 300 && visited > 3000, "{lines}, {visited} voxels");
}

#[test]
fn of_axes_that_are_alike_the_lowest_is_taken() {
    let (frame, _) = shot([9; 3], [1, 0, 0]).parameters();
    // Where the second sample lies tells along which axis.
    let axis = |direction: DVec3| {
        let ray = Ray {
            origin: [0.3, 0.2, 0.1],
            direction: direction.to_array(),
        };
        let second = on_main_axis(&frame, &ray, [0.0, 16.0]).nth(1).unwrap();
        let place = ray.at(second.t);
        place.iter().position(|x| (x - 1.5).abs() < 1e-9)
    };
    let part = 2f64.powi(-16);
    assert_eq!(axis(dvec3(1.0, 1.0, 1.0)), Some(0));
    assert_eq!(axis(dvec3(0.4, 1.0, 1.0)), Some(1));
    assert_eq!(axis(dvec3(1.0 - 0.9 * part, 1.0, 0.0)), Some(0));
    assert_eq!(axis(dvec3(1.0 - 1.1 * part, 1.0, 0.0)), Some(1));
    assert_eq!(axis(dvec3(0.0, 1.0 - 0.9 * part, 1.0)), Some(1));
}
