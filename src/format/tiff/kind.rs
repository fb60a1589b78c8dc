//! Numbers of TIFF 6.0 for kinds of samples and colors, and the names of those that are not read.

use super::TIFF;
use super::ifd::{self, Directory, Reader};
use super::page::Color;
use crate::format::problem::{invalid, unsupported};
use crate::volume::{Problem, VoxelType};

/// The type of samples of so many bits in this SampleFormat.
pub(super) fn stored_type(bits: u64, format: u64) -> Result<VoxelType, Problem> {
    Ok(match (format, bits) {
        // What is "undefined" is mostly written by those who know only whole numbers.
        (1 | 4, 1 | 2 | 4 | 8) => VoxelType::U8,
        (1 | 4, 16) => VoxelType::U16,
        (1 | 4, 32) => VoxelType::U32,
        (1 | 4, 64) => VoxelType::U64,
        (2, 8) => VoxelType::I8,
        (2, 16) => VoxelType::I16,
        (2, 32) => VoxelType::I32,
        (2, 64) => VoxelType::I64,
        (3, 16) => VoxelType::F16,
        (3, 32) => VoxelType::F32,
        (3, 64) => VoxelType::F64,
        (5 | 6, _) => return Err(unsupported(TIFF, "complex numbers")),
        (1..=4, 1..=64) => {
            let kind = ["", "unsigned", "signed", "float", "unsigned"];
            let kind = usize::try_from(format).ok().and_then(|k| kind.get(k));
            let what = format!("{bits} bits per sample ({})", kind.unwrap_or(&""));
            return Err(unsupported(TIFF, what));
        }
        (1..=4, _) => return Err(invalid(TIFF, "BitsPerSample", "1 to 64", &bits.to_string())),
        _ => return Err(invalid(TIFF, "SampleFormat", "1 to 6", &format.to_string())),
    })
}

/// The colors that PhotometricInterpretation names.
pub(super) fn color(reader: &mut Reader, directory: &Directory) -> Result<Color, Problem> {
    let number = reader.integer(directory, ifd::PHOTOMETRIC)?;
    let what = match number {
        None | Some(1) => return Ok(Color::Gray),
        Some(0) => return Ok(Color::WhiteIsZero),
        Some(2) => return Ok(Color::Rgb),
        Some(3) => return Ok(Color::Palette),
        Some(6) => return Ok(Color::YCbCr),
        Some(4) => "a transparency mask",
        Some(5) => "separated inks (CMYK)",
        Some(8) => "CIE L*a*b* colors",
        Some(9) => "ICC L*a*b* colors",
        Some(10) => "ITU L*a*b* colors",
        Some(32803) => "a color filter array",
        Some(32844) => "LogL light",
        Some(32845) => "LogLuv colors",
        Some(34892) => "linear raw light",
        Some(number) => {
            let name = ifd::PHOTOMETRIC.name;
            return Err(invalid(TIFF, name, "a known number", &number.to_string()));
        }
    };
    Err(unsupported(TIFF, what))
}
