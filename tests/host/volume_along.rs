//! What runs and an octree say of a ray, against a walk from voxel to voxel (Amanatides and Woo 1987), to the last bit.

use crate::voxel_sets::{Random, random, sets};
use stratavox::volume::{Octree, RayInterval, Runs, VoxelSet};

type Ray = [[f64; 3]; 2];

/// Where the ray crosses plane `plane` of axis `k`.
fn crossing([origin, direction]: Ray, k: usize, plane: u32) -> f64 {
    (f64::from(plane) - origin[k]) / direction[k]
}

/// Where the ray enters voxel number `i` of axis `k`, and where it leaves it.
fn slab(ray: Ray, k: usize, i: u32) -> Option<[f64; 2]> {
    let [origin, direction] = ray;
    if direction[k] == 0.0 {
        return (origin[k].floor() == f64::from(i)).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let [a, b] = [i, i + 1].map(|plane| crossing(ray, k, plane));
    Some(if direction[k] > 0.0 { [a, b] } else { [b, a] })
}

/// The intervals, voxel by voxel.
fn walk(set: &VoxelSet, ray: Ray) -> Vec<RayInterval> {
    let dims = set.dims();
    let mut found: Vec<RayInterval> = Vec::new();
    let mut t = 0.0;
    // Where all three coordinates are inside at the same time.
    let mut last = f64::INFINITY;
    for (k, &count) in dims.iter().enumerate() {
        let inside: Vec<_> = (0..count).filter_map(|i| slab(ray, k, i)).collect();
        t = inside
            .iter()
            .map(|part| part[0])
            .fold(f64::INFINITY, f64::min)
            .max(t);
        last = inside
            .iter()
            .map(|part| part[1])
            .fold(f64::NEG_INFINITY, f64::max)
            .min(last);
    }
    if t >= last {
        return found;
    }
    let holds = |part: Option<[f64; 2]>| part.is_some_and(|[enter, leave]| enter <= t && t < leave);
    let start = |k: usize| (0..dims[k]).find(|&i| holds(slab(ray, k, i)));
    let mut voxel = [0, 1, 2].map(|k| i64::from(start(k).expect("inside of the grid")));
    while t < last {
        let leave = |k: usize| slab(ray, k, voxel[k] as u32).expect("inside")[1];
        let leaves = [0, 1, 2].map(leave);
        let until = leaves.into_iter().fold(last, f64::min);
        let is_full = set.contains(voxel.map(|n| n as u32));
        match found.last_mut() {
            _ if until <= t => {}
            Some(before) if before.is_full == is_full => before.end = until,
            _ => found.push(RayInterval {
                start: t,
                end: until,
                is_full,
            }),
        }
        t = t.max(until);
        for k in 0..3 {
            if leaves[k] <= t {
                voxel[k] += if ray[1][k] > 0.0 { 1 } else { -1 };
            }
        }
    }
    found
}

/// Rays through a grid from everywhere, and those that lie in planes and meet edges and corners.
fn rays(dims: [u32; 3], count: usize, random: &mut Random) -> Vec<Ray> {
    let mut rays = Vec::new();
    for nth in 0..count {
        let mut within = |k: usize, beyond: f64| {
            let n = f64::from(dims[k]);
            (random.unit() * (1.0 + 2.0 * beyond) - beyond) * n
        };
        let from = [0, 1, 2].map(|k| within(k, 1.5));
        let to = [0, 1, 2].map(|k| within(k, 0.0));
        let direction = [0, 1, 2].map(|k| to[k] - from[k]);
        let at_edge = to.map(|n| (2.0 * n).round() / 2.0);
        let steps = [0, 1, 2].map(|_| f64::from(random.below(3)) - 1.0);
        rays.push(match nth % 4 {
            0 => [from, direction],
            // From inside.
            1 => [to, direction],
            // Through edges and corners, along planes and axes.
            2 => [[0, 1, 2].map(|k| at_edge[k] - 3.0 * steps[k]), steps],
            _ => [[0, 1, 2].map(|k| at_edge[k] - direction[k]), direction],
        });
    }
    rays
}

#[test]
fn intervals_are_those_of_a_walk_from_voxel_to_voxel() {
    let mut numbers = Random::new(17);
    let mut met = 0;
    let cubes = [0.02, 0.5, 0.9].map(|share| random([16; 3], share, 9));
    for set in sets().into_iter().chain(cubes) {
        let octree = Octree::new(&set);
        let runs = [0, 1, 2].map(|axis| Runs::new(&set, axis));
        for ray in rays(set.dims(), 100, &mut numbers) {
            let wanted = walk(&set, ray);
            let [origin, direction] = ray;
            let context = || format!("{ray:?} through {:?}", set.dims());
            assert_eq!(octree.along(origin, direction), wanted, "{}", context());
            for runs in &runs {
                let found = runs.along(origin, direction);
                assert_eq!(found, wanted, "along {}: {}", runs.axis(), context());
            }
            met += usize::from(wanted.len() > 1);
        }
    }
    assert!(met > 1000, "only {met} rays met full and empty voxels");
}

/// The middle of an interval lies in a voxel of its kind: what no rounding of a crossing excuses.
#[test]
fn the_middle_of_an_interval_lies_in_a_voxel_of_its_kind() {
    let mut numbers = Random::new(3);
    for seed in 0..8 {
        let set = random([13, 9, 20], 0.3, seed);
        let octree = Octree::new(&set);
        for [origin, direction] in rays(set.dims(), 100, &mut numbers) {
            for interval in octree.along(origin, direction) {
                let ends = [interval.start, interval.end];
                assert!(ends[0] >= 0.0 && ends[0] < ends[1], "{interval:?}");
                // A ray without a direction stays for ever.
                if ends[1].is_infinite() {
                    continue;
                }
                let t = 0.5 * (ends[0] + ends[1]);
                let point = [0, 1, 2].map(|k| origin[k] + t * direction[k]);
                let is_near_a_face = point.iter().any(|n| (n - n.round()).abs() < 1e-9);
                if !is_near_a_face {
                    let voxel = point.map(|n| n.floor() as u32);
                    assert_eq!(set.contains(voxel), interval.is_full, "{interval:?}");
                }
            }
        }
    }
}

#[test]
fn rays_that_miss_or_go_nowhere_have_no_intervals_or_one() {
    let set = random([4, 5, 6], 0.5, 1);
    let octree = Octree::new(&set);
    let runs = Runs::new(&set, 1);
    let of = |origin, direction| {
        let found = octree.along(origin, direction);
        assert_eq!(runs.along(origin, direction), found);
        found
    };
    assert_eq!(of([-1.0, 2.0, 2.0], [-1.0, 0.0, 0.0]), []);
    assert_eq!(of([4.0, 2.0, 2.0], [0.0, 1.0, 0.0]), []);
    assert_eq!(of([f64::NAN, 2.0, 2.0], [1.0, 0.0, 0.0]), []);
    assert_eq!(of([1.0, 2.0, 2.0], [1.0, f64::INFINITY, 0.0]), []);
    let stays = of([1.5, 2.5, 3.5], [0.0, -0.0, 0.0]);
    assert_eq!(stays.len(), 1);
    assert_eq!((stays[0].start, stays[0].end), (0.0, f64::INFINITY));
    // Huge numbers end too.
    of([1e300, 1.0, 1.0], [-1e300, 1e-300, 0.0]);
    of([-1e15, 2.2, 2.2], [1.0, 1e-17, -1e-17]);
}
