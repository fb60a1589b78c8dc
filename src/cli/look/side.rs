//! Which side a volume is looked at from, where no flag and no file says it.
//!
//! ```text
//! thin slab    its face: one extent under a third of each other one
//! else         the side of six whose small picture has the highest entropy of luminance, if it has a tenth more than the
//!              usual side:   H = - sum of p_i log2 p_i   over 64 bins of all pixels
//! ```
//!
//! Entropy as a measure of views: Vázquez, Feixas, Sbert, Heidrich, "Viewpoint Selection Using Viewpoint Entropy", VMV
//! 2001; Bordoloi, Shen, "View Selection for Volume Rendering", IEEE Visualization 2005.

use super::framing::{Small, View, small_of};
use crate::cli::Error;
use crate::cli::flags::{SceneFlags, Subject, ViewWord};
use crate::color::encode_srgb;
use crate::picture::{ColorSpace, Picture};

/// A slab is so much thinner than it is wide.
const THIN: f64 = 1.0 / 3.0;
/// Azimuth and elevation in degrees, the usual side first.
const SIDES: [[f64; 2]; 6] = [
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

/// The scene looking at the face of a thin slab. Pieces of the Earth are thin, and seen from the south.
pub fn with_side(scene: &SceneFlags, subject: &Subject, has_named_axes: bool) -> SceneFlags {
    let mut sided = scene.clone();
    if !scene.is_auto() || scene.section.section.is_some() || scene.camera.names_a_side() {
        return sided;
    }
    if subject.is_earth {
        return sided;
    }
    let extent = glam::DVec3::AXES.map(|axis| subject.half_extent(axis));
    let is_thin =
        |axis: usize| (0..3).all(|other| other == axis || extent[axis] < THIN * extent[other]);
    // Radiologists look at axial slices from the feet.
    let view = match (0..3).find(|&axis| is_thin(axis)) {
        Some(0) => ViewWord::Left,
        Some(1) => ViewWord::Anterior,
        Some(_) if has_named_axes => ViewWord::Inferior,
        Some(_) => ViewWord::Superior,
        None => return sided,
    };
    sided.camera.view = Some(view);
    sided
}

/// Turns the scene to the best of six sides; `boxed` fits a camera to the box.
pub fn best_side(
    scene: &mut SceneFlags,
    boxed: impl Fn(&SceneFlags) -> Result<View, Error>,
    extent_pixels: [u32; 2],
    draw: &mut Small,
) -> Result<(), Error> {
    let small = small_of(extent_pixels, PIXELS);
    let mut best = (0.0, None);
    for side in SIDES {
        let mut turned = scene.clone();
        (turned.camera.azimuth, turned.camera.elevation) = (Some(side[0]), Some(side[1]));
        let view = boxed(&turned)?;
        let found = entropy(&draw(&view.camera, &view.settings, small)?);
        match best.1 {
            None => best = (BETTER * found, Some(side)),
            Some(_) if found > best.0 => best = (found, Some(side)),
            Some(_) => {}
        }
    }
    if let Some(side) = best.1.filter(|&side| side != SIDES[0]) {
        (scene.camera.azimuth, scene.camera.elevation) = (Some(side[0]), Some(side[1]));
    }
    Ok(())
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
