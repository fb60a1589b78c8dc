//! Which side a volume is looked at from, where nobody says it.
//!
//! ```text
//! thin slab    its face: one extent under a third of each other one
//! else         the side of six whose picture has the highest entropy of luminance, if it has a twentieth more than the
//!              usual side:   H = - sum of p_i log2 p_i   over 64 bins of the frame that what is visible fills
//! ```
//!
//! Entropy as a measure of views: Vázquez, Feixas, Sbert, Heidrich, "Viewpoint Selection Using Viewpoint Entropy", VMV
//! 2001; Bordoloi, Shen, "View Selection for Volume Rendering", IEEE Visualization 2005.

use super::frame::{SHARE, box_of, small_of, visible_in};
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
const BETTER: f64 = 1.05;
/// Pixels of the longer side of the small pictures.
const PIXELS: u32 = 96;
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

/// The side of [`SIDES`] whose small picture has a twentieth more entropy than the usual one, and the most; `None` where no
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

/// Bits of luminance that a pixel has to tell, over black, in a frame that is fitted to what is visible; 0 where nothing
/// is visible.
fn entropy(picture: &Picture) -> f64 {
    let Some(part) = box_of(&visible_in(picture), picture.width) else {
        return 0.0;
    };
    let mut counts = [0.0; BINS];
    for (at, [r, g, b, _]) in (0_u32..).zip(&picture.pixels) {
        let place = [at % picture.width, at / picture.width].map(f64::from);
        if (0..2).any(|k| place[k] < part.min[k] || place[k] >= part.max[k]) {
            continue;
        }
        let shown = |c: f32| match picture.color_space {
            ColorSpace::Linear => encode_srgb(f64::from(c)),
            ColorSpace::Display => f64::from(c),
        };
        let luminance = 0.2126 * shown(*r) + 0.7152 * shown(*g) + 0.0722 * shown(*b);
        counts[((luminance * BINS as f64) as usize).min(BINS - 1)] += 1.0;
    }
    // The frame around the box is black.
    let size = [picture.width, picture.height].map(f64::from);
    let filled = [0, 1].map(|k| part.size()[k] / size[k]);
    let scale = filled[0].max(filled[1]) / SHARE;
    let all = scale * scale * size[0] * size[1];
    counts[0] += all - part.size()[0] * part.size()[1];
    let bits = |&count: &f64| {
        let share = count / all;
        if count == 0.0 {
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
    fn pictures_tell_the_bits_of_a_frame_that_they_fill() {
        let picture = |pixels: Vec<[f32; 4]>| Picture {
            width: 10,
            height: pixels.len() as u32 / 10,
            pixels,
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        };
        let black = [0.0, 0.0, 0.0, 1.0];
        let bits = |share: f64| -share * share.log2();
        // Grey fills .9 by .9 of the frame, and black the rest.
        let grey = SHARE * SHARE;
        let found = entropy(&picture(vec![[0.5; 4]; 100]));
        assert!(
            (found - bits(grey) - bits(1.0 - grey)).abs() < 1e-9,
            "{found}"
        );
        let halves = [vec![black; 50], vec![[1.0; 4]; 50]].concat();
        let found = entropy(&picture(halves));
        let white = 0.5 * grey;
        assert!(
            (found - bits(white) - bits(1.0 - white)).abs() < 1e-9,
            "{found}"
        );
        // How far away it is does not count.
        let small = |x: usize, y: usize| (2..7).contains(&x) && (1..6).contains(&y);
        let pixels = (0..100).map(|i| [if small(i % 10, i / 10) { 0.5 } else { 0.0 }; 4]);
        let found = entropy(&picture(pixels.collect()));
        assert!(
            (found - bits(grey) - bits(1.0 - grey)).abs() < 1e-9,
            "{found}"
        );
        assert_eq!(entropy(&picture(vec![[0.0; 4]; 100])), 0.0);
    }
}
