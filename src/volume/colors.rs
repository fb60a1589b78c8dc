//! Volumes of colour, as the mixing of colours wants them: sRGB numbers from 0 to 1, red, green and blue multiplied
//! with alpha where there is one.
//!
//! Only so can a sampler interpolate them: what is transparent has no colour to give to its neighbours. The
//! products of 8-bit codes are whole and fit 16 bits, so that nothing is lost; others are f32.

use super::{
    Header, Limits, Problem, ReadError, Rescale, Source, TimeComponent, Volume, VoxelType, Voxels,
};

/// The volumes of one time of a source of `ComponentKind::Rgb` or `ComponentKind::Rgba`: three, or four.
///
/// # Errors
/// Another number of components than 3 and 4, more memory than allowed, and whatever the source meets.
pub fn read_colors(
    source: &dyn Source,
    time: u32,
    limits: &Limits,
) -> Result<Vec<Volume>, ReadError> {
    let header = source.header();
    if !(3..=4).contains(&header.components) {
        let problem = Problem::Invalid {
            format: header.format.name(),
            field: "components".into(),
            wanted: "3 or 4 of a colour".into(),
            found: header.components.to_string(),
        };
        let path = source.path().to_owned();
        return Err(ReadError { path, problem });
    }
    let mut volumes = read_all(source, 0..header.components, time, limits)?;
    let full = full_of(header);
    let is_multiplied = volumes.len() == 4;
    let alpha = volumes.pop();
    let mut alpha = alpha.expect("at least three volumes");
    for volume in &mut volumes {
        if is_multiplied {
            multiply(volume, &alpha, full);
        } else {
            scale(volume, full);
        }
    }
    scale(&mut alpha, full);
    volumes.push(alpha);
    Ok(volumes)
}

/// The volumes of several components at one time, checked together against the limits.
///
/// # Errors
/// As [`Volume::read`].
pub fn read_all(
    source: &dyn Source,
    components: impl IntoIterator<Item = u32, IntoIter: ExactSizeIterator>,
    time: u32,
    limits: &Limits,
) -> Result<Vec<Volume>, ReadError> {
    let components = components.into_iter();
    let each = Limits {
        max_bytes: limits.max_bytes / components.len().max(1) as u64,
        ..*limits
    };
    let read = |component| {
        let pick = TimeComponent { time, component };
        Volume::read(source, pick, source.header().whole(), &each)
    };
    components.map(read).collect()
}

/// The stored number of full red: the largest of an integer type, 1 of floats.
fn full_of(header: &Header) -> f64 {
    match header.stored {
        VoxelType::U8 => f64::from(u8::MAX),
        VoxelType::I8 => f64::from(i8::MAX),
        VoxelType::U16 => f64::from(u16::MAX),
        VoxelType::I16 => f64::from(i16::MAX),
        VoxelType::U32 => f64::from(u32::MAX),
        VoxelType::I32 => f64::from(i32::MAX),
        VoxelType::U64 => u64::MAX as f64,
        VoxelType::I64 => i64::MAX as f64,
        VoxelType::F16 | VoxelType::F32 | VoxelType::F64 => 1.0,
    }
}

fn scale(volume: &mut Volume, full: f64) {
    set(
        volume,
        None,
        Rescale {
            slope: 1.0 / full,
            intercept: 0.0,
        },
    );
}

fn multiply(volume: &mut Volume, alpha: &Volume, full: f64) {
    let slope = 1.0 / (full * full);
    let (voxels, slope) = match (&volume.voxels, &alpha.voxels) {
        (Voxels::U8(color), Voxels::U8(alpha)) => {
            let both = color.iter().zip(alpha);
            let product = both.map(|(&color, &alpha)| u16::from(color) * u16::from(alpha));
            (Voxels::U16(product.collect()), slope)
        }
        (color, alpha) => {
            let product =
                |i: usize| f64::from(color.stored(i)) * f64::from(alpha.stored(i)) * slope;
            let products = (0..color.len()).map(|i| product(i) as f32);
            (Voxels::F32(products.collect()), 1.0)
        }
    };
    // A hole of alpha is a hole: the mask of alpha itself says so.
    set(
        volume,
        Some(voxels),
        Rescale {
            slope,
            intercept: 0.0,
        },
    );
}

fn set(volume: &mut Volume, voxels: Option<Voxels>, rescale: Rescale) {
    if let Some(voxels) = voxels {
        volume.voxels = voxels;
    }
    volume.rescale = rescale;
    let count = volume.voxels.len();
    let numbers = (0..count).map(|i| f64::from(volume.voxels.stored(i)) * rescale.slope);
    volume.value_range = numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    });
    volume.hounsfield = false;
    volume.unit = None;
}

/// Luma of a voxel of colours that are not multiplied, ITU-R BT.709 on sRGB numbers; `None` for no data.
pub fn luma(colors: &[Volume], index: usize) -> Option<f64> {
    let weights = [0.2126, 0.7152, 0.0722];
    let mut sum = 0.0;
    for (weight, volume) in weights.into_iter().zip(colors) {
        let is_valid = volume.validity.as_ref().is_none_or(|mask| mask[index] != 0);
        let value = f64::from(volume.voxels.stored(index)) * volume.rescale.slope;
        sum += is_valid.then_some(weight * value)?;
    }
    Some(sum)
}
