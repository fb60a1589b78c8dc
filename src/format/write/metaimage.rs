//! A MetaImage in one file: docs.itk.org/en/latest/learn/metaio.html. Its space is LPS.

use super::WriteVolumeError;
use super::layout::Layout;
use super::slabs::Slabs;
use crate::format::geometry::RAS_FROM_LPS;
use crate::volume::{Rescale, VoxelType};
use flate2::{Compression, write::ZlibEncoder};
use std::fmt::Write as _;
use std::io::{Seek, SeekFrom, Write};

/// Digits that `CompressedDataSize` gets room for.
const SIZE_DIGITS: usize = 20;

pub(super) fn write(
    layout: &Layout,
    compress: bool,
    out: &mut (impl Write + Seek),
    slabs: &mut Slabs,
) -> Result<(), WriteVolumeError> {
    let (before, after) = header(layout, compress);
    out.write_all(before.as_bytes())?;
    if !compress {
        out.write_all(after.as_bytes())?;
        return slabs.interleaved(out);
    }
    // The size is known when all is written: until then its place holds spaces.
    let size_at = out.stream_position()?;
    out.write_all(" ".repeat(SIZE_DIGITS).as_bytes())?;
    out.write_all(after.as_bytes())?;
    let start = out.stream_position()?;
    let mut zlib = ZlibEncoder::new(&mut *out, Compression::default());
    slabs.interleaved(&mut zlib)?;
    zlib.finish()?;
    let end = out.stream_position()?;
    out.seek(SeekFrom::Start(size_at))?;
    out.write_all(end.saturating_sub(start).to_string().as_bytes())?;
    out.seek(SeekFrom::Start(end))?;
    Ok(())
}

/// The lines before and behind the number of `CompressedDataSize`.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn header(layout: &Layout, compress: bool) -> (String, String) {
    let (steps, first) = layout.steps();
    let has_times = layout.times > 1;
    let spacing = steps.map(|step| step.length());
    let directions = steps.map(|step| step.normalize_or_zero() * RAS_FROM_LPS);
    let first = first * RAS_FROM_LPS;
    let join = |numbers: &[f64]| {
        // A sum with zero has no negative zero.
        let words: Vec<String> = numbers.iter().map(|n| (n + 0.0).to_string()).collect();
        words.join(" ")
    };
    let mut matrix = Vec::new();
    let mut offset = first.to_array().to_vec();
    let mut spacing = spacing.to_vec();
    for direction in directions {
        matrix.extend(direction.to_array());
        if has_times {
            matrix.push(0.0);
        }
    }
    let mut sizes: Vec<String> = layout.dims.iter().map(u32::to_string).collect();
    if has_times {
        matrix.extend([0.0, 0.0, 0.0, 1.0]);
        offset.push(0.0);
        spacing.push(1.0);
        sizes.push(layout.times.to_string());
    }
    let mut text = format!(
        "ObjectType = Image\nNDims = {}\nBinaryData = True\nBinaryDataByteOrderMSB = False\n\
         TransformMatrix = {}\nOffset = {}\nElementSpacing = {}\nDimSize = {}\n",
        sizes.len(),
        join(&matrix),
        join(&offset),
        join(&spacing),
        sizes.join(" "),
    );
    if layout.rescale != Rescale::default() {
        let Rescale { slope, intercept } = layout.rescale;
        let _ = write!(
            text,
            "ElementToIntensityFunctionSlope = {slope}\nElementToIntensityFunctionOffset = {intercept}\n"
        );
    }
    if layout.is_hounsfield {
        text.push_str("Modality = MET_MOD_CT\n");
    }
    if layout.components > 1 {
        let _ = writeln!(text, "ElementNumberOfChannels = {}", layout.components);
    }
    text.push_str(if compress {
        "CompressedData = True\nCompressedDataSize = "
    } else {
        "CompressedData = False"
    });
    let rest = format!(
        "\nElementType = {}\nElementDataFile = LOCAL\n",
        word(layout.number)
    );
    (text, rest)
}

fn word(number: VoxelType) -> &'static str {
    match number {
        VoxelType::U8 => "MET_UCHAR",
        VoxelType::I8 => "MET_CHAR",
        VoxelType::U16 => "MET_USHORT",
        VoxelType::I16 => "MET_SHORT",
        VoxelType::U32 => "MET_UINT",
        VoxelType::I32 => "MET_INT",
        VoxelType::U64 => "MET_ULONG_LONG",
        VoxelType::I64 => "MET_LONG_LONG",
        VoxelType::F16 | VoxelType::F32 => "MET_FLOAT",
        VoxelType::F64 => "MET_DOUBLE",
    }
}
