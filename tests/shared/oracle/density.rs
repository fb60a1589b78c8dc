//! Media whose extinction, or colour, follows a height s(x) that rises evenly through the world: along a
//! ray s = a + b t, and every integral over t is known.

use super::super::{Chord, Matter, PictureCase, Way, Worst};
use super::what;
use glam::{DAffine3, DVec3, dvec3};
use stratavox::volume::Grid;

/// s(x) = up . x + at_origin, from 0 to 1 through the grid.
struct Height {
    up: DVec3,
    at_origin: f64,
}

impl Height {
    /// Along one axis of the grid, or across all of them.
    fn new(grid: &Grid, is_straight: bool) -> Self {
        // Across, it rises with the rays of the oblique camera.
        let (direction, at_corner) = if is_straight {
            (dvec3(0.0, 0.0, 1.0), 0.0)
        } else {
            (dvec3(-0.35, 0.4, -0.25), 0.6)
        };
        let over_dims = direction / grid.far_corner();
        let voxel_from_world = grid.world_from_voxel.inverse();
        Self {
            up: voxel_from_world.matrix3.transpose() * over_dims,
            at_origin: at_corner + over_dims.dot(voxel_from_world.translation),
        }
    }

    fn at(&self, world: DVec3) -> f64 {
        self.up.dot(world) + self.at_origin
    }

    /// (a, b) of a ray.
    fn along(&self, chord: &Chord) -> (f64, f64) {
        (self.at(chord.origin), self.up.dot(chord.direction))
    }
}

/// Is the picture taken along the last axis?
fn is_straight(shot: &PictureCase) -> bool {
    let forward = shot.camera.frame().forward;
    forward.x.abs().max(forward.y.abs()) < 1e-12
}

/// One extinction after the law `sigma(s)`; `depth(chord, a, b)` is the exact optical depth and how far off
/// it may be.
fn absorbed(
    answer: &str,
    way: &dyn Way,
    shot: &PictureCase,
    sigma: impl Fn(f64) -> f64 + Sync,
    depth: impl Fn(&Chord, [f64; 2], f64, f64) -> (f64, f64),
) -> Worst {
    let height = Height::new(&shot.grid, is_straight(shot));
    let world_from_voxel: DAffine3 = shot.grid.world_from_voxel;
    let value = |voxel: DVec3| sigma(height.at(world_from_voxel.transform_point3(voxel)));
    let matter = Matter {
        value: &value,
        color: &|_| [1.0, 0.5, 0.25],
        extinction: &|v| v.max(0.0),
        range: [0.0, sigma(0.0).max(sigma(1.0))],
    };
    let mut worst = Worst::new(what(answer, way, shot));
    for (pixel, found) in shot.pixels().zip(way.picture(shot, &matter)) {
        let chord = Chord::of(shot, pixel);
        if chord.as_ref().is_some_and(|chord| chord.hangs) {
            worst.leave_out();
            continue;
        }
        let met = chord.and_then(|chord| chord.covered().map(|covered| (chord, covered)));
        let Some((chord, covered)) = met else {
            worst.take(pixel, found[3], 5e-6);
            continue;
        };
        let (a, b) = height.along(&chord);
        let (depth, allowed) = depth(&chord, covered, a, b);
        let wanted = -(-depth).exp_m1();
        // The ends of a chord move in f32, and what they add or take with them.
        let thickest = sigma(0.0).max(sigma(1.0));
        let allowed = allowed + 2.0 * chord.blur * thickest;
        worst.take(pixel, found[3] - wanted, 1e-5 + allowed * (-depth).exp());
        worst.take(
            pixel,
            found[1] - 0.5 * wanted,
            1e-5 + allowed * (-depth).exp(),
        );
    }
    worst
}

/// A2: sigma = p + q s. Midpoints are exact.
pub fn linear_density(way: &dyn Way, shot: &PictureCase) -> Worst {
    const P: f64 = 0.02;
    const Q: f64 = 0.15;
    absorbed(
        "A2",
        way,
        shot,
        |s| P + Q * s,
        |_, [t0, t1], a, b| {
            let middle = a + b * 0.5 * (t0 + t1);
            ((t1 - t0) * (P + Q * middle), 0.0)
        },
    )
}

/// A3: sigma = c s^2. Midpoints miss c b^2 d^3 / 12 in each segment, which is taken off the answer.
pub fn quadratic_density(way: &dyn Way, shot: &PictureCase) -> Worst {
    const C: f64 = 0.3;
    absorbed(
        "A3",
        way,
        shot,
        |s| C * s * s,
        |chord, [t0, t1], a, b| {
            let (s0, s1) = (a + b * t0, a + b * t1);
            let integral = C * (t1 - t0) * (s0 * s0 + s0 * s1 + s1 * s1) / 3.0;
            let missed: f64 = chord.samples.iter().map(|(_, d)| d.powi(3)).sum();
            (integral - C * b * b * missed / 12.0, 0.0)
        },
    )
}

/// A9: an exponential atmosphere, sigma = sigma0 exp(-s / H). Each midpoint is off by at most
/// d^3/24 max|sigma''|.
pub fn atmosphere(way: &dyn Way, shot: &PictureCase) -> Worst {
    const SIGMA: f64 = 0.5;
    const H: f64 = 0.3;
    let sigma = |s: f64| SIGMA * (-s / H).exp();
    absorbed("A9", way, shot, sigma, |chord, [t0, t1], a, b| {
        let (s0, s1) = (a + b * t0, a + b * t1);
        let length = t1 - t0;
        let x = b * length / H;
        // (1 - exp(-x)) / x, 1 for a ray across the layers.
        let mean = if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x };
        let steepest = sigma(s0.min(s1)) * (b / H).powi(2);
        let cubes: f64 = chord.samples.iter().map(|(_, d)| d.powi(3)).sum();
        (sigma(s0) * length * mean, cubes / 24.0 * steepest)
    })
}

/// A4: constant extinction, light c = s. With L covered from s = s0 on:
///
/// ```text
/// C = s0 (1 - exp(-sigma L)) + b (1 - exp(-sigma L)(1 + sigma L)) / sigma
/// ```
///
/// The root mean square of the errors of all pixels, for a grid and for the one of half its spacing: their
/// ratio is 2 to the order.
pub fn order_of_convergence(way: &dyn Way, shot: &PictureCase) -> [f64; 2] {
    [1, 2].map(|factor| error_with_light_rising(way, &refined(shot, factor)))
}

fn error_with_light_rising(way: &dyn Way, shot: &PictureCase) -> f64 {
    let across = (shot.grid.world_from_voxel.matrix3 * shot.grid.far_corner()).length();
    let sigma = 3.0 / across;
    let height = Height::new(&shot.grid, is_straight(shot));
    let world_from_voxel: DAffine3 = shot.grid.world_from_voxel;
    let value = |voxel: DVec3| height.at(world_from_voxel.transform_point3(voxel));
    let matter = Matter {
        value: &value,
        color: &|v| [v, 1.0 - v, 0.5],
        extinction: &|_| sigma,
        range: [0.0, 1.0],
    };
    let (mut sum, mut count) = (0.0, 0.0f64);
    for (pixel, found) in shot.pixels().zip(way.picture(shot, &matter)) {
        let Some(chord) = Chord::of(shot, pixel).filter(|chord| !chord.hangs) else {
            continue;
        };
        let Some([t0, t1]) = chord.covered() else {
            continue;
        };
        let (a, b) = height.along(&chord);
        let (s0, depth) = (a + b * t0, sigma * (t1 - t0));
        let fallen = (-depth).exp();
        let wanted = s0 * (1.0 - fallen) + b * (1.0 - fallen * (1.0 + depth)) / sigma;
        sum += (found[0] - wanted).powi(2);
        count += 1.0;
    }
    assert!(count > 40.0, "only {count} pixels");
    (sum / count).sqrt()
}

/// The same world with `factor` times as many voxels an axis.
fn refined(shot: &PictureCase, factor: u32) -> PictureCase {
    let n = f64::from(factor);
    PictureCase {
        grid: Grid {
            dims: shot.grid.dims.map(|dim| dim * factor),
            world_from_voxel: shot.grid.world_from_voxel
                * DAffine3::from_scale(DVec3::splat(1.0 / n)),
        },
        settings: stratavox::technique::Settings {
            crop: shot.settings.crop.map(|ends| ends.map(|end| end * n)),
            ..shot.settings.clone()
        },
        ..shot.clone()
    }
}
