//! Which side a volume is looked at from, where nobody says it.
//!
//! ```text
//! thin slab    its face: one extent under a third of each other one
//! else         the side of six whose small picture has the highest entropy of luminance, if it has a tenth more than the
//!              usual side:   H = - sum of p_i log2 p_i   over 64 bins of all pixels
//! ```
//!
//! Entropy as a measure of views: Vázquez, Feixas, Sbert, Heidrich, "Viewpoint Selection Using Viewpoint Entropy", VMV
//! 2001; Bordoloi, Shen, "View Selection for Volume Rendering", IEEE Visualization 2005.

use super::frame::small_of;
use crate::camera::View;
use crate::color::encode_srgb;
use crate::picture::{ColorSpace, Picture};
use crate::volume::Grid;

/// A slab is so much thinner than it is wide.
const THIN: f64 = 1.0 / 3.0;
/// Azimuth and elevation in degrees of the sides that [`best_side`] compares, the usual side first.
pub const SIDES: [[f64; 2]; 6] = [
    [60.0, 15.0],
    [150.0, 15.0],
    [240.0, 15.0],
    [330.0, 15.0],
    [60.0, 75.0],
    [60.0, -75.0],
];
/// Another side has so much more to show than the usual one.
const BETTER: f64 = 1.1;
/// Pixels of the longer side of the small pictures.
const PIXELS: u32 = 64;
const BINS: usize = 64;

/// The side that shows the face of a thin slab, one of whose extents in the world is under a third of each other one;
/// `None` of other boxes. `has_named_axes` says that the axes are those of a patient: radiologists look at axial slices
/// from the feet.
pub fn face(grid: &Grid, has_named_axes: bool) -> Option<View> {
    let (matrix, far) = (grid.world_from_voxel.matrix3, grid.far_corner());
    let extent = (matrix.x_axis * far.x).abs()
        + (matrix.y_axis * far.y).abs()
        + (matrix.z_axis * far.z).abs();
    let is_thin =
        |axis: usize| (0..3).all(|other| other == axis || extent[axis] < THIN * extent[other]);
    match (0..3).find(|&axis| is_thin(axis))? {
        0 => Some(View::Left),
        1 => Some(View::Anterior),
        _ if has_named_axes => Some(View::Inferior),
        _ => Some(View::Superior),
    }
}

/// The side of [`SIDES`] whose small picture has a tenth more entropy than the usual one, and the most; `None` where no
/// other is so much better. `draw` gives the picture from a side with so many pixels, over black, fitted to the box.
///
/// # Errors
/// Those of `draw`.
pub fn best_side<E>(
    extent_pixels: [u32; 2],
    mut draw: impl FnMut([f64; 2], [u32; 2]) -> Result<Picture, E>,
) -> Result<Option<[f64; 2]>, E> {
    let small = small_of(extent_pixels, PIXELS);
    let usual = entropy(&draw(SIDES[0], small)?);
    let mut best = (BETTER * usual, None);
    for &side in &SIDES[1..] {
        let found = entropy(&draw(side, small)?);
        if found > best.0 {
            best = (found, Some(side));
        }
    }
    Ok(best.1)
}

/// Bits of luminance that a pixel has to tell, over black.
fn entropy(picture: &Picture) -> f64 {
    let mut counts = [0_u32; BINS];
    for [r, g, b, _] in &picture.pixels {
        let shown = |c: f32| match picture.color_space {
            ColorSpace::Linear => encode_srgb(f64::from(c)),
            ColorSpace::Display => f64::from(c),
        };
        let luminance = 0.2126 * shown(*r) + 0.7152 * shown(*g) + 0.0722 * shown(*b);
        counts[((luminance * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let all = picture.pixels.len() as f64;
    let bits = |&count: &u32| {
        let share = f64::from(count) / all;
        if count == 0 {
            0.0
        } else {
            -share * share.log2()
        }
    };
    counts.iter().map(bits).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_picture_tells_nothing_and_two_halves_one_bit() {
        let picture = |pixels: Vec<[f32; 4]>| Picture {
            width: pixels.len() as u32,
            height: 1,
            pixels,
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        };
        assert_eq!(entropy(&picture(vec![[0.5; 4]; 8])), 0.0);
        let halves = [vec![[0.0; 4]; 4], vec![[1.0; 4]; 4]].concat();
        assert_eq!(entropy(&picture(halves)), 1.0);
    }
}
