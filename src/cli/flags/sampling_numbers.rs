//! Numbers of sampling flags, checked: a scene file can say what the command line would have refused.

use super::{Error, Numbers};
use crate::shaders::MAX_CLIP_PLANES;
use crate::technique::ClipPlane;
use glam::DVec3;

/// Rays along one side of a pixel.
const MAX_RAYS_PER_SIDE: u32 = 64;

pub fn samples_per_voxel(samples: f64) -> Result<f64, Error> {
    if samples > 0.0 && samples.is_finite() {
        Ok(samples)
    } else {
        Err(Error::usage(
            format!("--samples-per-voxel {samples}: wanted a number over 0"),
            "--samples-per-voxel 2",
        ))
    }
}

pub fn rays_per_side(rays: u32) -> Result<u32, Error> {
    (1..=MAX_RAYS_PER_SIDE)
        .find(|side| side * side == rays)
        .ok_or_else(|| {
            Error::usage(
                format!("--aa {rays}: wanted a square number from 1 to 4096"),
                "--aa 4 sends 2 x 2 rays through each pixel",
            )
        })
}

pub fn crop_box(Numbers([x0, x1, y0, y1, z0, z1]): Numbers<6>) -> Result<[DVec3; 2], Error> {
    let [min, max] = [DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1)];
    if min.cmple(max).all() {
        Ok([min, max])
    } else {
        Err(Error::usage(
            format!("--crop {x0},{x1},{y0},{y1},{z0},{z1}: a lower bound is over its upper one"),
            "the order is X0,X1,Y0,Y1,Z0,Z1, in voxels",
        ))
    }
}

pub fn clip_planes(clips: &[Numbers<4>]) -> Result<Vec<ClipPlane>, Error> {
    if clips.len() > MAX_CLIP_PLANES as usize {
        return Err(Error::TooMany {
            message: format!(
                "{} clip planes, at most {MAX_CLIP_PLANES} are possible",
                clips.len()
            ),
            hint: "leave planes out; --crop cuts along the axes of the grid",
        });
    }
    let plane = |Numbers([x, y, z, offset]): &Numbers<4>| {
        let normal = DVec3::new(*x, *y, *z);
        if normal == DVec3::ZERO {
            return Err(Error::usage(
                format!("--clip 0,0,0,{offset}: a plane needs a direction"),
                "--clip 1,0,0,10 keeps the world points with x >= 10",
            ));
        }
        Ok(ClipPlane {
            normal,
            offset: *offset,
        })
    };
    clips.iter().map(plane).collect()
}
