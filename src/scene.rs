//! Everything that makes one picture.

use crate::camera::Camera;
use crate::technique::{Settings, View};
use crate::transfer::TransferFunction;
use crate::volume::Volume;

/// A volume, how it is classified, who looks at it, and what is computed.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// What is shown.
    pub volume: &'a Volume,
    /// Value to colour and opacity; `None`: grey over the range of the projected values of this picture
    /// (projecting modes only).
    pub transfer: Option<&'a TransferFunction>,
    /// The eye.
    pub camera: &'a Camera,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// The words of the picture.
    pub settings: &'a Settings,
}

impl Scene<'_> {
    /// World length that opacities are for: the transfer function's own, else the smallest spacing.
    pub fn reference_length(&self) -> f64 {
        let own = self.transfer.and_then(|function| function.reference_length);
        own.unwrap_or_else(|| self.volume.grid().smallest_spacing())
    }
}

/// Where in the pixel its rays go through: a regular grid of `per_side` squared, the centre for one.
pub fn positions_in_pixel(per_side: u32) -> impl Iterator<Item = [f64; 2]> {
    let at = move |i: u32| (f64::from(i) + 0.5) / f64::from(per_side) - 0.5;
    (0..per_side).flat_map(move |y| (0..per_side).map(move |x| [at(x), at(y)]))
}

impl<'a> Scene<'a> {
    /// The view through one position in each pixel.
    pub fn view(&self, grid: &'a crate::volume::Grid, in_pixel: [f64; 2]) -> View<'a> {
        View {
            grid,
            camera: self.camera,
            extent_pixels: self.extent_pixels,
            in_pixel,
            settings: self.settings,
        }
    }
}
