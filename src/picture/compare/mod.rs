//! How far two pictures are apart.
//!
//! ```text
//! max     the largest |a - b| of any number of any pixel
//! rmse    sqrt(mean (a - b)^2) over all numbers of all pixels
//! psnr    -20 log10(rmse), in decibels: the peak is 1
//! ssim    Wang et al. 2004, of luma; flip: Andersson et al. 2020; both over a black background
//! ```
//!
//! Numbers are compared as the files hold them: straight sRGB numbers of two PNGs, linear premultiplied ones
//! of two `.npy` or EXR. Of a PNG and one of the others, the other is first made what a PNG would hold.

mod display;
mod flip;
mod picture;
mod ssim;

pub use flip::{PIXELS_PER_DEGREE, flip_map};

use super::Picture;
use super::straight::straight_srgb;
use crate::color::ColorSpace;

/// The numbers of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Rows from the top.
    pub pixels: Vec<[f32; 4]>,
    /// What they are.
    pub numbers: Numbers,
}

/// What the numbers of an [`Image`] are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// sRGB numbers not multiplied by alpha, and alpha, 0 to 1, as PNG has them.
    StraightSrgb,
    /// Linear light times alpha, and alpha, as `.npy` and EXR have them.
    Premultiplied,
    /// One number a pixel, of no known kind; the other three are 0.
    Plain,
}

impl Numbers {
    fn channels(self) -> usize {
        if self == Self::Plain { 1 } else { 4 }
    }
}

impl From<&Picture> for Image {
    /// As `.npy` would hold it.
    fn from(picture: &Picture) -> Self {
        Self {
            width: picture.width,
            height: picture.height,
            pixels: picture.linear_pixels(),
            numbers: Numbers::Premultiplied,
        }
    }
}

/// Why two pictures cannot be compared.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotComparable {
    /// Their sizes differ.
    #[error("wanted a picture of {wanted}, found one of {found}")]
    Size {
        /// Of the first, as `640x480`.
        wanted: String,
        /// Of the second.
        found: String,
    },
    /// One has colours, the other one number a pixel.
    #[error("wanted a picture with {wanted} numbers a pixel, found one with {found}")]
    Channels {
        /// Of the first.
        wanted: usize,
        /// Of the second.
        found: usize,
    },
    /// No pixel at all, or fewer or more than the size says.
    #[error("wanted {wanted} pixels, at least one, found {found}")]
    Pixels {
        /// Width times height.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
}

/// Two pictures are further apart than they may be.
#[derive(Debug, PartialEq, thiserror::Error)]
#[error(
    "off by {found} at pixel ({}, {}), at most {limit} is allowed", pixel[0], pixel[1]
)]
pub struct TooFar {
    /// Largest error.
    pub found: f64,
    /// What was allowed.
    pub limit: f64,
    /// Where it is, from the left and from the top.
    pub pixel: [u32; 2],
}

/// How far two pictures are apart. Says nothing until asked.
#[must_use = "call `at_most`: a comparison alone checks nothing"]
#[derive(Clone, Debug)]
pub struct Comparison {
    width: u32,
    height: u32,
    max: f64,
    worst_pixel: [u32; 2],
    rmse: f64,
    differing: usize,
    nan_mismatches: usize,
    ssim: Option<f64>,
    flip: Option<f64>,
    errors: Vec<f64>,
}

impl Comparison {
    /// Compares `found` with `wanted`.
    ///
    /// A NaN is as far as can be from anything but another NaN; an infinity from all but the same one.
    pub fn of(wanted: &Image, found: &Image) -> Result<Self, NotComparable> {
        check(wanted, found)?;
        let [a, b] = if wanted.numbers == found.numbers {
            [wanted.pixels.clone(), found.pixels.clone()]
        } else {
            [straight(wanted), straight(found)]
        };
        let channels = wanted.numbers.channels();
        let mut comparison = Self {
            width: wanted.width,
            height: wanted.height,
            max: 0.0,
            worst_pixel: [0, 0],
            rmse: 0.0,
            differing: 0,
            nan_mismatches: 0,
            ssim: None,
            flip: None,
            errors: Vec::with_capacity(a.len()),
        };
        let mut squares = 0.0;
        for (i, (a, b)) in a.iter().zip(&b).enumerate() {
            let mut worst = 0.0;
            for c in 0..channels {
                let error = distance(a[c], b[c]);
                squares += error * error;
                worst = f64::max(worst, error);
                comparison.nan_mismatches += usize::from(a[c].is_nan() != b[c].is_nan());
            }
            if worst > comparison.max {
                let width = wanted.width as usize;
                comparison.max = worst;
                comparison.worst_pixel = [(i % width) as u32, (i / width) as u32];
            }
            comparison.differing += usize::from(worst > 0.0);
            comparison.errors.push(worst);
        }
        comparison.rmse = (squares / (channels * a.len()) as f64).sqrt();
        if wanted.numbers != Numbers::Plain {
            let size = [wanted.width as usize, wanted.height as usize];
            let shown = [display::over_black(wanted), display::over_black(found)];
            comparison.ssim = Some(ssim::mean(&shown, size));
            let map = flip_map(&shown[0], &shown[1], size[0], PIXELS_PER_DEGREE);
            comparison.flip = Some(map.iter().sum::<f64>() / map.len() as f64);
        }
        Ok(comparison)
    }

    /// An error unless no number is further from its counterpart than `limit`.
    pub fn at_most(&self, limit: f64) -> Result<(), TooFar> {
        if self.max <= limit {
            return Ok(());
        }
        Err(TooFar {
            found: self.max,
            limit,
            pixel: self.worst_pixel,
        })
    }

    /// The largest error.
    pub fn max(&self) -> f64 {
        self.max
    }

    /// Where the largest error is first, from the left and from the top.
    pub fn worst_pixel(&self) -> [u32; 2] {
        self.worst_pixel
    }

    /// Root of the mean square of the errors.
    pub fn rmse(&self) -> f64 {
        self.rmse
    }

    /// Decibels; infinite for equal pictures.
    pub fn psnr(&self) -> f64 {
        -20.0 * self.rmse.log10()
    }

    /// 1 for equal pictures; none for plain numbers.
    pub fn ssim(&self) -> Option<f64> {
        self.ssim
    }

    /// Mean over the picture, 0 for equal ones, at most 1; none for plain numbers.
    pub fn flip(&self) -> Option<f64> {
        self.flip
    }

    /// How many pixels differ at all.
    pub fn differing(&self) -> usize {
        self.differing
    }

    /// How many numbers are NaN in one picture only.
    pub fn nan_mismatches(&self) -> usize {
        self.nan_mismatches
    }

    /// How many pixels were compared; at least one.
    pub fn pixels(&self) -> usize {
        self.errors.len()
    }
}

fn check(wanted: &Image, found: &Image) -> Result<(), NotComparable> {
    let size = |image: &Image| format!("{}x{}", image.width, image.height);
    if (wanted.width, wanted.height) != (found.width, found.height) {
        return Err(NotComparable::Size {
            wanted: size(wanted),
            found: size(found),
        });
    }
    let channels = [wanted.numbers.channels(), found.numbers.channels()];
    if channels[0] != channels[1] {
        return Err(NotComparable::Channels {
            wanted: channels[0],
            found: channels[1],
        });
    }
    for image in [wanted, found] {
        let pixels = image.width as usize * image.height as usize;
        if pixels == 0 || pixels != image.pixels.len() {
            return Err(NotComparable::Pixels {
                wanted: pixels,
                found: image.pixels.len(),
            });
        }
    }
    Ok(())
}

fn distance(a: f32, b: f32) -> f64 {
    let error = (f64::from(a) - f64::from(b)).abs();
    if !error.is_nan() {
        error
    } else if (a.is_nan() && b.is_nan()) || a == b {
        // Equal infinities have no difference.
        0.0
    } else {
        f64::INFINITY
    }
}

fn straight(image: &Image) -> Vec<[f32; 4]> {
    match image.numbers {
        Numbers::Premultiplied => {
            let pixels = image.pixels.iter();
            let straight = |&pixel| straight_srgb(pixel, ColorSpace::Linear).map(|x| x as f32);
            pixels.map(straight).collect()
        }
        _ => image.pixels.clone(),
    }
}
