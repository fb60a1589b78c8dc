//! Where in a pixel its ray goes through, and what moves the patterns of rays.

use super::{Jitter, Lattice, View};
use crate::shaders::BLUE_NOISE_SIDE;

/// Where in a pixel its ray goes through; (0, 0) is the centre, the corners lie at +-1/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InPixel {
    /// The place, the same in every pixel.
    pub at: [f64; 2],
    /// The side of a square around it in which each pixel has a place of its own; 0: none.
    pub cell_pixels: f64,
}

impl InPixel {
    /// The centre of every pixel.
    pub const CENTER: Self = Self {
        at: [0.0; 2],
        cell_pixels: 0.0,
    };
}

impl From<[f64; 2]> for InPixel {
    fn from(at: [f64; 2]) -> Self {
        Self {
            at,
            cell_pixels: 0.0,
        }
    }
}

/// The parameters by which shaders know of the patterns.
pub(super) struct OfPatterns {
    pub is_jittered: u32,
    pub jitter: u32,
    pub jitter_shift: [u32; 2],
    pub is_uneven: u32,
    pub cell_seed: u32,
    pub cell_pixels: f32,
}

impl View<'_> {
    /// Other patterns for each seed and each ray of a pixel. From one picture of a film to the next the same noise is
    /// turned on: steps of the golden ratio are far apart for any run of pictures.
    pub(super) fn of_patterns(&self) -> OfPatterns {
        let Jitter { seed, frame } = self.settings.jitter;
        const GOLDEN: u32 = 2_654_435_769;
        let scattered = |x: u64| x.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
        let seed = scattered(seed.into()) as u32;
        let at = self.in_pixel.at.map(|x| (x * 4096.0).round() as i64 as u64);
        let ray = scattered(scattered(at[0]) ^ at[1]) as u32;
        let turned = frame.wrapping_mul(GOLDEN);
        let moved = seed.wrapping_add(ray);
        OfPatterns {
            is_jittered: (self.settings.lattice == Lattice::Jitter).into(),
            jitter: moved.wrapping_add(turned),
            jitter_shift: [moved >> 20, moved >> 26].map(|n| n % BLUE_NOISE_SIDE),
            is_uneven: (self.in_pixel.cell_pixels > 0.0).into(),
            cell_seed: moved ^ turned,
            cell_pixels: self.in_pixel.cell_pixels as f32,
        }
    }
}
