//! The parameters that single modes look at.

use super::View;
use crate::color::decode_srgb;
use crate::picture::ColorSpace;
use crate::shaders::MAX_LEVELS;
use glam::{DVec3, dvec3};

/// Fields of the frame by the same names.
pub(super) struct OfMode {
    pub value_low: f32,
    pub value_scale: f32,
    pub lmip_threshold: f32,
    pub mida_fade: f32,
    pub mida_mip: f32,
    pub attenuation: f32,
    pub depth_cue: f32,
    pub depth_near: f32,
    pub depth_scale: f32,
    pub level_count: u32,
    pub level_values: [[f32; 4]; MAX_LEVELS as usize],
    pub level_colors: [[f32; 4]; MAX_LEVELS as usize],
}

impl View<'_> {
    /// The parameters of single modes, from numbers that `Settings::check` has let pass.
    pub(super) fn of_mode(&self) -> OfMode {
        let per_mode = &self.settings.per_mode;
        let [low, high] = per_mode.unit_values;
        let [near, far] = self.depth_range();
        // No more than these: a mode that looks at them has checked it.
        let mut levels: [_; MAX_LEVELS as usize] = std::array::from_fn(|i| per_mode.levels.get(i));
        levels.sort_by(|a, b| match (a, b) {
            (Some(a), Some(b)) => a.value.total_cmp(&b.value),
            // Places that are not taken come last.
            _ => b.is_some().cmp(&a.is_some()),
        });
        let level_count = levels.iter().flatten().count() as u32;
        let mut level_values = [[0.0; 4]; MAX_LEVELS as usize];
        let mut level_colors = level_values;
        for (i, level) in levels.into_iter().flatten().enumerate() {
            level_values[i][0] = level.value as f32;
            let [r, g, b] = level.srgb.map(|c| self.shown(c) as f32);
            level_colors[i] = [r, g, b, level.opacity as f32];
        }
        // No infinity reaches a shader.
        let finite = |x: f64| (x as f32).clamp(f32::MIN, f32::MAX);
        OfMode {
            value_low: low as f32,
            value_scale: finite(1.0 / (high - low)),
            lmip_threshold: finite(per_mode.lmip_threshold),
            mida_fade: (1.0 + per_mode.mida_gamma.min(0.0)) as f32,
            mida_mip: per_mode.mida_gamma.max(0.0) as f32,
            attenuation: finite(per_mode.attenuation / self.diagonal()),
            depth_cue: per_mode.depth_cue as f32,
            depth_near: near as f32,
            depth_scale: finite(1.0 / (far - near)),
            level_count,
            level_values,
            level_colors,
        }
    }

    /// An sRGB number as it is blended.
    fn shown(&self, srgb: f64) -> f64 {
        match self.settings.color_space {
            ColorSpace::Linear => decode_srgb(srgb),
            ColorSpace::Display => srgb,
        }
    }

    /// World length of the longest diagonal of the grid box.
    fn diagonal(&self) -> f64 {
        let far = self.grid.far_corner();
        let signs = [
            dvec3(1., 1., 1.),
            dvec3(1., 1., -1.),
            dvec3(1., -1., 1.),
            dvec3(-1., 1., 1.),
        ];
        let across = |sign: DVec3| self.grid.world_from_voxel.transform_vector3(sign * far);
        let lengths = signs.map(|sign| across(sign).length());
        lengths.into_iter().fold(0.0, f64::max)
    }

    /// Between which depths the bounding sphere of the grid box lies, seen from the eye or the plane through it.
    fn depth_range(&self) -> [f64; 2] {
        // The world is moved so that the centre is its origin.
        let radius = 0.5 * self.diagonal();
        let rays = self.rays();
        let distance = match self.camera.projection.is_perspective() {
            true => rays.origin.length(),
            false => -rays.forward.dot(rays.origin),
        };
        let near = (distance - radius).max(0.0);
        [near, (distance + radius).max(near + radius)]
    }
}
