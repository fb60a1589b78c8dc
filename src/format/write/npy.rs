//! NumPy's array file, format 1.0 (NEP 1): `[time,] z, y, x [, component]`, the last axis fastest.

use super::WriteVolumeError;
use super::layout::Layout;
use super::slabs::Slabs;
use crate::volume::VoxelType;
use std::io::Write;

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

pub(super) fn write(
    layout: &Layout,
    out: &mut impl Write,
    slabs: &mut Slabs,
) -> Result<(), WriteVolumeError> {
    let [x, y, z] = layout.dims;
    let mut shape = vec![z, y, x];
    if layout.times > 1 {
        shape.insert(0, layout.times);
    }
    if layout.components > 1 {
        shape.push(layout.components);
    }
    let shape: Vec<String> = shape.iter().map(u32::to_string).collect();
    let mut text = format!(
        "{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}",
        word(layout.number),
        shape.join(", ")
    );
    // The numbers begin at a multiple of 64 bytes; the text ends in a line feed.
    let before = MAGIC.len().saturating_add(2);
    while before.saturating_add(text.len()).saturating_add(1) % 64 != 0 {
        text.push(' ');
    }
    text.push('\n');
    let length = u16::try_from(text.len())
        .map_err(|_| WriteVolumeError::NoRoom("the shape is too long for npy".to_owned()))?;
    out.write_all(MAGIC)?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(text.as_bytes())?;
    slabs.interleaved(out)
}

fn word(number: VoxelType) -> &'static str {
    match number {
        VoxelType::U8 => "|u1",
        VoxelType::I8 => "|i1",
        VoxelType::U16 => "<u2",
        VoxelType::I16 => "<i2",
        VoxelType::U32 => "<u4",
        VoxelType::I32 => "<i4",
        VoxelType::U64 => "<u8",
        VoxelType::I64 => "<i8",
        VoxelType::F16 => "<f2",
        VoxelType::F32 => "<f4",
        VoxelType::F64 => "<f8",
    }
}
