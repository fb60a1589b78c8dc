//! Spheres with a hard edge, and Gaussians.

use super::super::{Chord, Matter, PictureCase, Way, Worst};
use super::what;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// A sphere off the middle of the grid, so that no symmetry hides an error.
struct Sphere {
    center: DVec3,
    radius: f64,
    /// How far its edge may be from where it should be: half the diagonal of a voxel where it is made of
    /// voxels.
    blur: f64,
}

impl Sphere {
    fn new(shot: &PictureCase, is_voxelized: bool) -> Self {
        let grid = &shot.grid;
        let m = grid.world_from_voxel.matrix3;
        // Opposite faces of the box are dims / |row of voxel_from_world| apart.
        let apart = |k: usize| f64::from(grid.dims[k]) / grid.voxel_rows()[k].length();
        let narrowest = (0..3).map(apart).fold(f64::INFINITY, f64::min);
        let diagonals = [[1., 1., 1.], [1., 1., -1.], [1., -1., 1.], [-1., 1., 1.]];
        let longest = diagonals
            .map(|d| (m * DVec3::from_array(d)).length())
            .into_iter()
            .fold(0.0, f64::max);
        Self {
            center: grid.center() + m * (grid.far_corner() * DVec3::new(0.05, -0.04, 0.03)),
            radius: 0.36 * narrowest,
            blur: if is_voxelized { 0.5 * longest } else { 0.0 },
        }
    }

    /// Length of a ray inside a sphere of this one's centre.
    fn chord(&self, chord: &Chord, radius: f64) -> f64 {
        let to = self.center - chord.origin;
        let off = to.cross(chord.direction).length_squared();
        2.0 * (radius * radius - off).max(0.0).sqrt()
    }

    /// The shortest and the longest chord that samples may find: an edge is met to a sample.
    fn chords(&self, chord: &Chord) -> [f64; 2] {
        let d = chord.samples.iter().map(|s| s.1).fold(0.0, f64::max);
        let shortest = self.chord(chord, self.radius - self.blur) - d;
        [
            shortest.max(0.0),
            self.chord(chord, self.radius + self.blur) + d,
        ]
    }
}

/// Either side of an interval that must hold the number.
fn outside([low, high]: [f64; 2], found: f64) -> f64 {
    if found.is_nan() {
        return found;
    }
    (low - found).max(found - high).max(0.0)
}

fn in_sphere(
    answer: &str,
    way: &dyn Way,
    shot: &PictureCase,
    is_voxelized: bool,
    found: impl Fn(&Matter) -> Vec<f64>,
    wanted: impl Fn(f64) -> f64,
) -> Worst {
    let sphere = Sphere::new(shot, is_voxelized);
    let world_from_voxel = shot.grid.world_from_voxel;
    let value = |voxel: DVec3| {
        let from_center = world_from_voxel.transform_point3(voxel) - sphere.center;
        f64::from(u8::from(from_center.length() < sphere.radius))
    };
    let matter = Matter {
        value: &value,
        color: &|_| [1.0; 3],
        extinction: &|v| v * SPHERE_EXTINCTION,
        range: [0.0, 1.0],
    };
    let mut worst = Worst::new(what(answer, way, shot));
    for (pixel, found) in shot.pixels().zip(found(&matter)) {
        let Some(chord) = Chord::of(shot, pixel) else {
            continue;
        };
        if chord.samples.is_empty() {
            continue;
        }
        let bounds = sphere.chords(&chord).map(&wanted);
        // In f32 some dozens of additions are off by as many units in the last place.
        worst.take(pixel, outside(bounds, found), 5e-6 * wanted(40.0).max(1.0));
    }
    worst
}

const SPHERE_EXTINCTION: f64 = 0.2;

/// A7: an absorbing sphere, alpha = 1 - exp(-2 sigma sqrt(R^2 - b^2)), to a sample at its hard edge.
pub fn absorbing_sphere(way: &dyn Way, shot: &PictureCase, is_voxelized: bool) -> Worst {
    let found = |matter: &Matter| way.picture(shot, matter).iter().map(|p| p[3]).collect();
    in_sphere("A7", way, shot, is_voxelized, found, |length| {
        -(-SPHERE_EXTINCTION * length).exp_m1()
    })
}

/// A8: an emitting sphere, 2 e sqrt(R^2 - b^2). `shot` is an X-ray.
pub fn emissive_sphere(way: &dyn Way, shot: &PictureCase, is_voxelized: bool) -> Worst {
    let found = |matter: &Matter| way.values(shot, matter);
    in_sphere("A8", way, shot, is_voxelized, found, |length| length)
}

/// exp(-q.Mq/2) around a point, in world space.
pub struct Gaussian {
    pub center: DVec3,
    pub m: DMat3,
    /// What trilinear interpolation of its voxels takes off, in parts of the peak.
    pub interpolation: f64,
}

impl Gaussian {
    /// Samples every `d` along r know the integral to 2 exp(-2 pi^2 s^2/d^2), s the width along r.
    fn width(&self, r: DVec3) -> f64 {
        1.0 / r.dot(self.m * r).sqrt()
    }

    /// The largest value on a ray.
    fn maximum(&self, chord: &Chord) -> f64 {
        let (q, r) = (chord.origin - self.center, chord.direction);
        let (qq, qr) = (q.dot(self.m * q), q.dot(self.m * r));
        (-0.5 * (qq - qr * qr * self.width(r).powi(2))).exp()
    }

    /// Along a ray of this direction through the middle.
    fn peak(&self, r: DVec3) -> f64 {
        (2.0 * PI).sqrt() * self.width(r)
    }

    fn values(&self, way: &dyn Way, shot: &PictureCase) -> Vec<f64> {
        let world_from_voxel = shot.grid.world_from_voxel;
        let value = |voxel: DVec3| {
            let q = world_from_voxel.transform_point3(voxel) - self.center;
            (-0.5 * q.dot(self.m * q)).exp()
        };
        let matter = Matter {
            value: &value,
            color: &|v| [v; 3],
            extinction: &|v| v.max(0.0),
            range: [0.0, 1.0],
        };
        way.values(shot, &matter)
    }

    /// Relative errors of the integral and of the maximum that this ray's samples may have.
    fn allowed(&self, chord: &Chord) -> [f64; 2] {
        let (s, d) = (self.width(chord.direction), chord.samples[0].1);
        let sum = 2.0 * (-2.0 * (PI * s / d).powi(2)).exp();
        [sum, 1.0 - (-d * d / (8.0 * s * s)).exp()]
    }
}

fn through(
    answer: &str,
    way: &dyn Way,
    shot: &PictureCase,
    gaussian: &Gaussian,
    check: impl Fn(&mut Worst, [u32; 2], &Chord, f64),
) -> Worst {
    let mut worst = Worst::new(what(answer, way, shot));
    for (pixel, found) in shot.pixels().zip(gaussian.values(way, shot)) {
        if let Some(chord) = Chord::of(shot, pixel).filter(|chord| chord.samples.len() > 4) {
            check(&mut worst, pixel, &chord, found);
        }
    }
    worst
}

/// A10: the X-ray of a Gaussian, sqrt(2 pi / r.Mr) exp(-(q.Mq - (r.Mq)^2 / r.Mr) / 2).
pub fn gaussian_xray(way: &dyn Way, shot: &PictureCase, gaussian: &Gaussian) -> Worst {
    through("A10", way, shot, gaussian, |worst, pixel, chord, found| {
        let peak = gaussian.peak(chord.direction);
        let [sum, _] = gaussian.allowed(chord);
        let wanted = peak * gaussian.maximum(chord);
        worst.take(
            pixel,
            found - wanted,
            peak * (sum + 1e-5 + gaussian.interpolation),
        );
    })
}

/// A11: its MIP. A sample is at most half a spacing from the top.
pub fn gaussian_maximum(way: &dyn Way, shot: &PictureCase, gaussian: &Gaussian) -> Worst {
    through("A11", way, shot, gaussian, |worst, pixel, chord, found| {
        let [_, missed] = gaussian.allowed(chord);
        let wanted = gaussian.maximum(chord);
        worst.take(
            pixel,
            found - wanted,
            missed + 1e-6 + gaussian.interpolation,
        );
    })
}

/// A11: MIP over X-ray is sqrt(r.Mr / 2 pi) everywhere, here where the X-ray is over a tenth of its peak.
pub fn gaussian_ratio(
    way: &dyn Way,
    mip: &PictureCase,
    xray: &PictureCase,
    gaussian: &Gaussian,
) -> Worst {
    let sums = gaussian.values(way, xray);
    let index = |[x, y]: [u32; 2]| (y * mip.extent[0] + x) as usize;
    through("A11", way, mip, gaussian, |worst, pixel, chord, found| {
        let part = gaussian.maximum(chord);
        if part > 0.1 {
            let wanted = 1.0 / gaussian.peak(chord.direction);
            let [sum, missed] = gaussian.allowed(chord);
            let relative = missed + (sum + 2e-5 + 2.0 * gaussian.interpolation) / part;
            worst.take(
                pixel,
                found / sums[index(pixel)] - wanted,
                wanted * relative,
            );
        }
    })
}
