//! Light on several volumes in one place: each on the surface across its own gradient. CPU reference of
//! `shaders/lib/mixture_lit_channels.wgsl` and `mixture_lit_colors.wgsl`.
//!
//! ```text
//! gradient of volume i, in units of the first:  s_i A^T g_i        s_i = f_0 / f_i,  f the least that is a surface
//! of labels     g_k = sum of e on two faces, with sign, / 4 + sum of e at eight corners, with sign, / 16
//! ```
//!
//! with e = 1 where the label is and 0 elsewhere, over a cube of two voxels a side. So one half gradient is that of all.

use super::gradient::gradient_of;
use super::{Error, GradientStorage, Operator, Role, Settings, View, compatibility::refuse};
use crate::real::{Real, scale};
use crate::shaders::{Frame, MAX_CHANNELS};

impl View<'_> {
    /// What makes the gradients of volumes of these ranges comparable.
    pub(crate) fn gradient_scales(
        &self,
        volumes: impl IntoIterator<Item = ([f64; 2], Role)>,
    ) -> [f32; MAX_CHANNELS as usize] {
        let least = volumes.into_iter().map(|(range, role)| match role {
            Role::Labels => self.flat_gradient([0.0, 1.0]),
            Role::Numbers | Role::Material | Role::Opacity => self.flat_gradient(range),
        });
        let least: Vec<f32> = least.take(MAX_CHANNELS as usize).collect();
        let mut scales = [1.0; MAX_CHANNELS as usize];
        for (scale, &own) in scales.iter_mut().zip(&least) {
            // A volume of zeros alone has no surface.
            if own > 0.0 && least[0] > 0.0 {
                *scale = least[0] / own;
            }
        }
        scales
    }
}

impl Settings {
    /// Whether light can fall on several volumes.
    ///
    /// # Errors
    /// [`Error::NotShadedTogether`] and [`Error::NotFor`].
    pub(crate) fn check_lit_mixture(&self) -> Result<(), Error> {
        if self.is_half_angle() {
            return Err(Error::NotShadedTogether);
        }
        let is_other = self.gradient_operator() != Operator::Central
            || self.gradient_storage == GradientStorage::Precomputed;
        refuse(
            self.shading.is_some() && is_other,
            "a gradient filter",
            "one volume of numbers",
            "several that are mixed",
        )
    }
}

/// The gradient of volume number `channel`, from what `tap` finds in it so many voxels of the first away.
pub fn channel_gradient<R: Real>(
    frame: &Frame,
    channel: usize,
    tap: impl Fn([i32; 3]) -> Option<R>,
) -> [R; 3] {
    let factor = R::from_f32(frame.channel_gradient_scale[channel]);
    scale(gradient_of(frame, tap), factor)
}

/// The same of where `label` is, by the nearest labels that `tap` finds.
pub fn label_gradient<R: Real>(
    frame: &Frame,
    channel: usize,
    label: R,
    tap: impl Fn([i32; 3]) -> Option<R>,
) -> [R; 3] {
    let mut slope = [R::from_f64(0.0); 3];
    let mut add = |step: [i32; 3], weight: f64| {
        if tap(step) == Some(label) {
            for (sum, n) in slope.iter_mut().zip(step) {
                *sum = *sum + R::from_f64(weight * f64::from(n));
            }
        }
    };
    for axis in 0..3 {
        for sign in [1, -1] {
            let mut step = [0; 3];
            step[axis] = sign;
            add(step, 0.25);
        }
    }
    for corner in 0..8 {
        add([0, 1, 2].map(|k| 1 - 2 * (corner >> k & 1)), 0.0625);
    }
    let factor = R::from_f32(frame.channel_gradient_scale[channel]);
    let row = |k: usize, c: usize| R::from_f32(frame.voxel_from_world[k][c]);
    let part = |c: usize| slope[0] * row(0, c) + slope[1] * row(1, c) + slope[2] * row(2, c);
    scale([part(0), part(1), part(2)], factor)
}
