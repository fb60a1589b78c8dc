//! Cut faces, where a ray enters through what has cut the volume: CPU reference of `shaders/lib/faces.wgsl` and
//! `face_grey.wgsl`.
//!
//! ```text
//! t0 > where the ray enters the whole grid box        a crop or a clip plane has cut there
//! alpha = 1 - exp(-sigma 1e30)                        1 where sigma > 0, else 0
//! ```

use super::{CutFaces, Settings};
use crate::color::decode_srgb;
use crate::ray::{domain_interval, pixel_ray, visible_interval, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;

/// World length of a face: any extinction of a table fills it.
pub const FACE_LENGTH: f32 = 1e30;

/// The parameters by which shaders know of faces.
pub(super) struct OfFaces {
    pub cut_faces: u32,
    pub cut_low: f32,
    pub cut_scale: f32,
}

impl Settings {
    pub(super) fn of_faces(&self) -> OfFaces {
        let [low, high] = match self.cut_faces {
            Some(CutFaces::Grey(window)) => window,
            _ => [0.0, 1.0],
        };
        OfFaces {
            cut_faces: match self.cut_faces {
                None => 0,
                Some(CutFaces::Own) => 1,
                Some(CutFaces::Grey(_)) => 2,
            },
            cut_low: low as f32,
            cut_scale: ((1.0 / (high - low)) as f32).clamp(f32::MIN, f32::MAX),
        }
    }
}

/// Where the ray of a pixel meets a cut face, as t and in voxel space.
pub fn cut_face<R: Real>(frame: &Frame, pixel: [R; 2]) -> Option<(R, [R; 3])> {
    if frame.cut_faces == 0 {
        return None;
    }
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let [t0, t1] = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    if t0 >= t1 {
        return None;
    }
    let (zero, tiny) = (R::from_f64(0.0), R::from_f32(1e-20));
    let enter = (0..3).map(|k| {
        let slope = voxel.direction[k];
        let slope = if slope.abs() < tiny { tiny } else { slope };
        let at_min = -voxel.origin[k] / slope;
        let at_max = (R::from_f32(frame.dims[k]) - voxel.origin[k]) / slope;
        at_min.min(at_max)
    });
    let uncut = enter.fold(zero, R::max);
    let margin = R::from_f32(1e-3) * R::from_f32(frame.step_world);
    (t0 > uncut + margin).then(|| (t0, voxel.at(t0)))
}

/// What a face is made of, (red, green, blue, extinction), where the volume is made of `own` and has `value`.
pub fn on_face<R: Real>(frame: &Frame, own: [R; 4], value: R) -> [R; 4] {
    if frame.cut_faces != 2 {
        return own;
    }
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    let grey = (value - R::from_f32(frame.cut_low)) * R::from_f32(frame.cut_scale);
    // What is black is open, and so is what is no number.
    if grey.partial_cmp(&zero) != Some(std::cmp::Ordering::Greater) {
        return [zero; 4];
    }
    let srgb = grey.min(one);
    let shown = match frame.color_space_is_display {
        0 => decode_srgb(srgb),
        _ => srgb,
    };
    [shown, shown, shown, one]
}
