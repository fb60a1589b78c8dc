//! Volumes known in closed form: a value at every point of the world, and the truth for tests.

use glam::DVec3;
use std::f64::consts::PI;

/// A value at every point of the world.
pub trait Field: Send + Sync {
    /// The value at a point of world space.
    fn value(&self, p: DVec3) -> f64;

    /// The gradient per world length where a closed form exists.
    fn gradient(&self, _p: DVec3) -> Option<DVec3> {
        None
    }
}

/// offset + slope·p: trilinear filtering and central differences reproduce it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Value at the world origin.
    pub offset: f64,
    /// Value per world length along each axis.
    pub slope: DVec3,
}

impl Field for Linear {
    fn value(&self, p: DVec3) -> f64 {
        self.offset + self.slope.dot(p)
    }

    fn gradient(&self, _p: DVec3) -> Option<DVec3> {
        Some(self.slope)
    }
}

/// 1 inside, 0 outside, a linear ramp of width `edge` between them, one half at `radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Ball {
    pub center: DVec3,
    pub radius: f64,
    /// 0 for a hard edge.
    pub edge: f64,
}

impl Field for Ball {
    fn value(&self, p: DVec3) -> f64 {
        let inside = self.radius - (p - self.center).length();
        if self.edge > 0.0 {
            (0.5 + inside / self.edge).clamp(0.0, 1.0)
        } else {
            f64::from(inside >= 0.0)
        }
    }
}

/// exp(-|p - c|^2 / 2 s^2): its line integrals, maxima and minima along rays are known (oracle A10).
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Gaussian {
    pub center: DVec3,
    /// Standard deviation, world length.
    pub deviation: f64,
}

impl Field for Gaussian {
    fn value(&self, p: DVec3) -> f64 {
        let r = (p - self.center) / self.deviation;
        (-0.5 * r.length_squared()).exp()
    }

    fn gradient(&self, p: DVec3) -> Option<DVec3> {
        Some((self.center - p) / self.deviation.powi(2) * self.value(p))
    }
}

/// The test signal for reconstruction filters, on the cube [-1, 1] of each axis.
///
/// ```text
/// f = (1 - sin(pi z / 2) + alpha (1 + cos(2 pi f_M cos(pi r / 2)))) / (2 (1 + alpha)),  r^2 = x^2 + y^2
/// ```
///
/// Marschner, Lobb, "An Evaluation of Reconstruction Filters for Volume Rendering", Visualization 1994:
/// f_M = 6, alpha = 0.25, 40 voxels along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarschnerLobb {
    /// f_M
    pub frequency: f64,
    /// alpha
    pub amplitude: f64,
}

impl Default for MarschnerLobb {
    fn default() -> Self {
        Self {
            frequency: 6.0,
            amplitude: 0.25,
        }
    }
}

impl Field for MarschnerLobb {
    fn value(&self, p: DVec3) -> f64 {
        let r = p.x.hypot(p.y);
        let wave = (2.0 * PI * self.frequency * (PI * r / 2.0).cos()).cos();
        let slope = 1.0 - (PI * p.z / 2.0).sin();
        (slope + self.amplitude * (1.0 + wave)) / (2.0 * (1.0 + self.amplitude))
    }

    fn gradient(&self, p: DVec3) -> Option<DVec3> {
        let r = p.x.hypot(p.y);
        let phase = 2.0 * PI * self.frequency * (PI * r / 2.0).cos();
        // sin(pi r / 2) / r has the limit pi / 2.
        let sine_over_r = if r > 1e-9 {
            (PI * r / 2.0).sin() / r
        } else {
            PI / 2.0
        };
        let radial = self.amplitude * phase.sin() * PI * PI * self.frequency * sine_over_r;
        let along_z = -(PI / 2.0) * (PI * p.z / 2.0).cos();
        Some(DVec3::new(radial * p.x, radial * p.y, along_z) / (2.0 * (1.0 + self.amplitude)))
    }
}

/// A layered atmosphere: 1 at z = 0, thinner above (oracles A2 and A9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fog {
    /// exp(-z / height)
    Exponential {
        /// World length over which it falls to 1/e.
        height: f64,
    },
    /// 1 - z / height
    Linear {
        /// World length over which it falls to 0.
        height: f64,
    },
}

impl Field for Fog {
    fn value(&self, p: DVec3) -> f64 {
        match self {
            Self::Exponential { height } => (-p.z / height).exp(),
            Self::Linear { height } => 1.0 - p.z / height,
        }
    }

    fn gradient(&self, p: DVec3) -> Option<DVec3> {
        Some(match self {
            Self::Exponential { height } => DVec3::NEG_Z * self.value(p) / *height,
            Self::Linear { height } => DVec3::NEG_Z / *height,
        })
    }
}

/// Thin nested spheres: shell i of N, at radius (i + 1) / N of the outermost, peaks at the value
/// 1 - i / N and falls off as a Gaussian of its distance, so that each has a value of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Shells {
    pub center: DVec3,
    pub outermost_radius: f64,
    pub count: u32,
    /// Standard deviation across a shell, world length.
    pub thickness: f64,
}

impl Field for Shells {
    fn value(&self, p: DVec3) -> f64 {
        let r = (p - self.center).length();
        let count = f64::from(self.count);
        let shell = |i: u32| {
            let radius = self.outermost_radius * f64::from(i + 1) / count;
            let peak = 1.0 - f64::from(i) / count;
            peak * (-0.5 * ((r - radius) / self.thickness).powi(2)).exp()
        };
        (0..self.count).map(shell).fold(0.0, f64::max)
    }
}
