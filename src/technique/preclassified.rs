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

use super::Error;
use crate::color::ColorSpace;
use crate::transfer::{Absorption, Points, TransferFunction, classify_by_points};
use crate::volume::{Codes, Problem, Rescale, Volume, Voxels};

/// By what voxels are classified.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Law {
    /// Of values alone.
    pub function: TransferFunction,
    /// World length that depths are over.
    pub reference_length: f64,
    /// In which colours are blended.
    pub space: ColorSpace,
}

impl Law {
    /// [`preclassified`].
    ///
    /// # Errors
    /// [`Error::Classified`].
    pub fn volumes(&self, volume: &Volume) -> Result<[Volume; 4], Error> {
        let made = preclassified(volume, &self.function, self.reference_length, self.space);
        made.map_err(|problem| Error::Classified {
            problem: problem.to_string(),
        })
    }

    /// [`materials_of_codes`].
    pub fn materials(&self, volume: &Volume) -> Option<Vec<[f32; 4]>> {
        materials_of_codes(volume, &self.function, self.reference_length, self.space)
    }
}

/// What stored numbers are made of.
struct Materials {
    points: Points,
    reference_length: f64,
    rescale: Rescale,
}

impl Materials {
    fn new(volume: &Volume, function: &TransferFunction, length: f64, space: ColorSpace) -> Self {
        let absorption = Absorption::Extinction {
            reference_length: length,
        };
        Self {
            points: Points::new(function, absorption, space),
            reference_length: length,
            rescale: volume.rescale,
        }
    }

    /// Red, green and blue times depth, and depth.
    fn of(&self, stored: f32) -> [f32; 4] {
        let value = f64::from(stored) * self.rescale.slope + self.rescale.intercept;
        let [r, g, b, extinction]: [f64; 4] = classify_by_points(&self.points, value);
        let depth = extinction * self.reference_length;
        [r * depth, g * depth, b * depth, depth].map(|x| x as f32)
    }

    fn of_codes(&self, volume: &Volume, codes: Codes) -> Vec<[f32; 4]> {
        let kind = volume.voxels.voxel_type();
        let all = 0..codes.count();
        all.map(|code| self.of(kind.number_of(code as u16)))
            .collect()
    }

    /// One after another; beside each other many are alike.
    fn of_each(&self, volume: &Volume) -> [Vec<f32>; 4] {
        let count = volume.voxels.len();
        let mut numbers: [Vec<f32>; 4] = std::array::from_fn(|_| Vec::with_capacity(count));
        let mut last: Option<(u32, [f32; 4])> = None;
        for i in 0..count {
            let stored = volume.voxels.stored(i);
            let material = match last {
                Some((bits, material)) if bits == stored.to_bits() => material,
                _ => self.of(stored),
            };
            last = Some((stored.to_bits(), material));
            for (of, number) in numbers.iter_mut().zip(material) {
                of.push(number);
            }
        }
        numbers
    }
}

/// What [`preclassified`] makes of each code of the voxels (`Voxels::codes`); `None` of voxels without codes.
pub fn materials_of_codes(
    volume: &Volume,
    function: &TransferFunction,
    reference_length: f64,
    space: ColorSpace,
) -> Option<Vec<[f32; 4]>> {
    let codes = volume.voxels.codes()?;
    let materials = Materials::new(volume, function, reference_length, space);
    Some(materials.of_codes(volume, codes))
}

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
    let materials = Materials::new(volume, function, reference_length, space);
    // Of few voxels most codes would be classified for nothing.
    let codes = volume.voxels.codes();
    let numbers = match codes.filter(|codes| codes.count() <= volume.voxels.len()) {
        Some(codes) => {
            let table = materials.of_codes(volume, codes);
            std::array::from_fn(|c| {
                let column: Vec<f32> = table.iter().map(|material| material[c]).collect();
                codes.look_up(&column)
            })
        }
        None => materials.of_each(volume),
    };
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
