//! Pre-classification: voxels are classified, and what they are made of is interpolated.
//!
//! With sigma_i the extinction and c_i the colour (as it is blended) of the value of voxel i, w_i the weights of the
//! filter and d0 the reference length,
//!
//! ```text
//! depth = sum of w_i sigma_i d0        c = sum of w_i sigma_i d0 c_i / depth        sigma = depth / d0
//! ```
//!
//! so colours are interpolated multiplied with what is there of them: a transparent voxel gives its colour to none
//! (Wittenbrink, Malzbender & Goss 1998). Values between two voxels are classified by neither: of a spike of the
//! function between them nothing is left, and an edge is as blurred as the filter (`sampling.md` 4). Shader:
//! `shaders/lib/material_colors.wgsl`.

use crate::color::ColorSpace;
use crate::transfer::{Absorption, Points, TransferFunction, classify_by_points};
use crate::volume::{Problem, Rescale, Volume, Voxels};

/// Red, green and blue, as they are blended in `space`, times the optical depth over `reference_length`, and that
/// depth: floats on the grid of `volume`, no data where it has none.
///
/// # Errors
/// [`Problem`] where the numbers make no volumes.
pub fn preclassified(
    volume: &Volume,
    function: &TransferFunction,
    reference_length: f64,
    space: ColorSpace,
) -> Result<[Volume; 4], Problem> {
    let absorption = Absorption::Extinction { reference_length };
    let points = Points::new(function, absorption, space);
    let material = |i: usize| -> [f32; 4] {
        let stored = f64::from(volume.voxels.stored(i));
        let value = stored * volume.rescale.slope + volume.rescale.intercept;
        let [r, g, b, extinction]: [f64; 4] = classify_by_points(&points, value);
        let depth = extinction * reference_length;
        [r * depth, g * depth, b * depth, depth].map(|x| x as f32)
    };
    let count = volume.voxels.len();
    let mut numbers: [Vec<f32>; 4] = std::array::from_fn(|_| Vec::with_capacity(count));
    for i in 0..count {
        for (of, number) in numbers.iter_mut().zip(material(i)) {
            of.push(number);
        }
    }
    let made = |values: Vec<f32>| {
        let made = Volume::from_voxels(
            volume.dims,
            volume.world_from_voxel,
            Voxels::F32(values),
            Rescale::default(),
            None,
        )?;
        Ok(Volume {
            validity: volume.validity.clone(),
            ..made
        })
    };
    let [red, green, blue, depth] = numbers;
    Ok([made(red)?, made(green)?, made(blue)?, made(depth)?])
}
