//! Fields that voxels of every type hold exactly, and that every filter gives back.
//!
//! ```text
//! code(i, j, k) = c0 + c . (i, j, k), whole numbers from 0 to 255      value = code / 256 + 1 / 8
//! ```
//!
//! Signed types hold code - 128, types of 16 bits 256 times the code; their rescale takes that back exactly. Linear
//! interpolation, and every B-spline and Catmull-Rom, is linear where the field is (their kernels sum to one and
//! are even), as long as no tap lies outside the grid.

use super::chord::{Chord, PictureCase};
use crate::technique::Filter;
use crate::technique::slices_2d::stack_axis;
use crate::volume::{Rescale, Volume, VoxelType, Voxels};
use glam::DVec3;

/// What the field is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One value.
    Homogeneous,
    /// Linear, with another slope along each axis.
    Ramp,
}

/// A field, in codes over voxel space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    at_first: f64,
    slope: DVec3,
}

const INTERCEPT: f64 = 0.125;

impl Kind {
    /// The word of names.
    pub fn word(self) -> &'static str {
        match self {
            Self::Homogeneous => "homogeneous",
            Self::Ramp => "ramp",
        }
    }

    /// The field on a grid of up to 17 x 21 x 13 voxels.
    pub fn field(self) -> Field {
        match self {
            Self::Homogeneous => Field {
                at_first: 137.0,
                slope: DVec3::ZERO,
            },
            Self::Ramp => Field {
                at_first: 11.0,
                slope: DVec3::new(3.0, 7.0, 4.0),
            },
        }
    }
}

impl Field {
    /// The value at a place between the centres of the outermost voxels.
    pub fn value(&self, voxel: DVec3) -> f64 {
        (self.at_first + self.slope.dot(voxel - 0.5)) / 256.0 + INTERCEPT
    }

    /// How much the value rises from voxel to voxel along each axis.
    pub fn slope(&self) -> DVec3 {
        self.slope / 256.0
    }

    /// How much the value changes from voxel to voxel, at most, along each axis.
    pub fn steps(&self) -> DVec3 {
        self.slope.abs() / 256.0
    }

    /// The value of a sample, and how far rounding may move it. `None` where which voxel it lies in depends on rounding.
    pub fn sampled(&self, shot: &PictureCase, chord: &Chord, t: f64) -> Option<(f64, f64)> {
        let mut place = chord.at(t);
        let mut blur = chord.blur_voxels;
        if shot.settings.technique.draws_stacks() {
            let k = stack_axis(&shot.view());
            place[k] = place[k].floor() + 0.5;
            blur[k] = 0.0;
        }
        if shot.settings.filter == Filter::Nearest {
            let at_border = (place - place.round()).abs();
            let steps = self.slope;
            if (0..3).any(|k| steps[k] != 0.0 && at_border[k] <= blur[k]) {
                return None;
            }
            return Some((self.value(place.floor() + 0.5), 0.0));
        }
        Some((self.value(place), self.steps().dot(blur)))
    }

    /// The volume, in voxels of a type.
    pub fn volume(&self, shot: &PictureCase, stored: VoxelType) -> Volume {
        let [nx, ny, nz] = shot.grid.dims;
        let code = |x: u32, y: u32, z: u32| {
            self.at_first + self.slope.dot(DVec3::new(x.into(), y.into(), z.into()))
        };
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y, z))));
        let codes = all.map(|(x, y, z)| code(x, y, z));
        let (voxels, slope, added) = match stored {
            VoxelType::U8 => (Voxels::U8(codes.map(|c| c as u8).collect()), 1.0, 0.0),
            VoxelType::I8 => (
                Voxels::I8(codes.map(|c| (c - 128.0) as i8).collect()),
                1.0,
                128.0,
            ),
            VoxelType::U16 => (
                Voxels::U16(codes.map(|c| (256.0 * c) as u16).collect()),
                256.0,
                0.0,
            ),
            VoxelType::I16 => {
                let moved = codes.map(|c| (256.0 * (c - 128.0)) as i16);
                (Voxels::I16(moved.collect()), 256.0, 128.0)
            }
            VoxelType::F16 => (
                Voxels::F16(codes.map(half::f16::from_f64).collect()),
                1.0,
                0.0,
            ),
            _ => (Voxels::F32(codes.map(|c| c as f32).collect()), 1.0, 0.0),
        };
        let rescale = Rescale {
            slope: 1.0 / (256.0 * slope),
            intercept: INTERCEPT + added / 256.0,
        };
        let affine = shot.grid.world_from_voxel;
        Volume::from_voxels(shot.grid.dims, affine, voxels, rescale, None)
            .expect("as many voxels as the grid has")
    }
}
