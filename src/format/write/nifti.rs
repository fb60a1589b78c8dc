//! NIfTI-1 in one file, by nifti1.h: a header of 348 bytes, four of extensions (none), the voxels.
//!
//! The sform holds every affine; the qform is written too where the steps stand at right angles.

use super::WriteVolumeError;
use super::layout::Layout;
use super::slabs::Slabs;
use crate::volume::{ComponentKind, VoxelType};
use flate2::{Compression, write::GzEncoder};
use glam::{DMat3, DQuat};
use std::io::Write;

/// Header and the four bytes behind it.
const VOXELS_AT: usize = 352;

/// NIFTI_INTENT_LABEL and NIFTI_INTENT_VECTOR.
const LABEL: i16 = 1002;
const VECTOR: i16 = 1007;

pub(super) fn write(
    layout: &mut Layout,
    gzip: bool,
    out: &mut impl Write,
    slabs: &mut Slabs,
) -> Result<(), WriteVolumeError> {
    let header = header(layout)?;
    if !gzip {
        out.write_all(&header)?;
        return voxels(layout, out, slabs);
    }
    let mut gzip = GzEncoder::new(out, Compression::default());
    gzip.write_all(&header)?;
    voxels(layout, &mut gzip, slabs)?;
    gzip.finish()?;
    Ok(())
}

fn voxels(
    layout: &Layout,
    out: &mut impl Write,
    slabs: &mut Slabs,
) -> Result<(), WriteVolumeError> {
    match is_color(layout) {
        true => slabs.interleaved(out),
        false => slabs.one_by_one(out),
    }
}

/// Bytes of a color are one voxel; every other component has an axis of its own.
fn is_color(layout: &Layout) -> bool {
    let channels = match layout.meaning {
        ComponentKind::Rgb => 3,
        ComponentKind::Rgba => 4,
        _ => return false,
    };
    layout.number == VoxelType::U8 && layout.components == channels
}

/// Fields of nifti1.h, each at its offset.
struct Fields([u8; VOXELS_AT]);

impl Fields {
    fn put<const N: usize>(&mut self, at: usize, number: [u8; N]) {
        if let Some(place) = self.0.get_mut(at..at.saturating_add(N)) {
            place.copy_from_slice(&number);
        }
    }

    fn short(&mut self, at: usize, number: i16) {
        self.put(at, number.to_le_bytes());
    }

    fn floats(&mut self, at: usize, numbers: &[f64]) {
        for (k, number) in numbers.iter().enumerate() {
            let place = at.saturating_add(k.saturating_mul(4));
            #[allow(clippy::cast_possible_truncation, reason = "the field is an f32")]
            self.put(place, (*number as f32).to_le_bytes());
        }
    }
}

fn header(layout: &mut Layout) -> Result<[u8; VOXELS_AT], WriteVolumeError> {
    let mut fields = Fields([0; VOXELS_AT]);
    fields.put(0, 348_i32.to_le_bytes());
    let (number, bits) = datatype(layout);
    let color = is_color(layout);
    let components = if color { 1 } else { layout.components };
    let rank = match (layout.times, components) {
        (1, 1) => 3,
        (_, 1) => 4,
        _ => 5,
    };
    let [x, y, z] = layout.dims;
    fields.short(40, rank);
    for (k, size) in [x, y, z, layout.times, components, 1, 1]
        .into_iter()
        .enumerate()
    {
        let size = i16::try_from(size).map_err(|_| {
            WriteVolumeError::NoRoom(format!(
                "NIfTI-1 has no room for an axis of {size}, at most 32767; .nrrd has"
            ))
        })?;
        fields.short(42_usize.saturating_add(k.saturating_mul(2)), size);
    }
    let intent = match (&layout.meaning, layout.is_labels) {
        (_, true) => LABEL,
        (ComponentKind::Vector, _) => VECTOR,
        _ => 0,
    };
    fields.short(68, intent);
    fields.short(70, number);
    fields.short(72, bits);
    fields.floats(108, &[352.0]);
    if !color {
        fields.floats(112, &[layout.rescale.slope, layout.rescale.intercept]);
    }
    // Millimetres, seconds.
    fields.put(123, [2 | 8]);
    place(layout, &mut fields);
    fields.put(344, *b"n+1\0");
    Ok(fields.0)
}

/// pixdim, qform and sform.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn place(layout: &mut Layout, fields: &mut Fields) {
    let ([x, y, z], first) = layout.steps();
    let sizes = [x, y, z].map(|step| step.length());
    let [i, j, k] = [x, y, z].map(|step| step.normalize_or_zero());
    let is_orthogonal = [i.dot(j), i.dot(k), j.dot(k)]
        .iter()
        .all(|dot| dot.abs() < 1e-6);
    let is_mirrored = i.cross(j).dot(k) < 0.0;
    let qfac = if is_mirrored { -1.0 } else { 1.0 };
    let [width, height, depth] = sizes;
    fields.floats(76, &[qfac, width, height, depth, 1.0, 1.0, 1.0, 1.0]);
    if is_orthogonal {
        let turn = DQuat::from_mat3(&DMat3::from_cols(i, j, k * qfac)).normalize();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        fields.short(252, 1);
        fields.floats(256, &[turn.x, turn.y, turn.z, first.x, first.y, first.z]);
    } else {
        layout.notes.push(
            "the axes stand at no right angles: the file has an sform and no qform".to_owned(),
        );
    }
    fields.short(254, 1);
    for (row, at) in [280, 296, 312].into_iter().enumerate() {
        fields.floats(at, &[x[row], y[row], z[row], first[row]]);
    }
}

/// The code and bits of the type.
fn datatype(layout: &Layout) -> (i16, i16) {
    if is_color(layout) {
        return match layout.components {
            3 => (128, 24),
            _ => (2304, 32),
        };
    }
    match layout.number {
        VoxelType::U8 => (2, 8),
        VoxelType::I16 => (4, 16),
        VoxelType::I32 => (8, 32),
        VoxelType::F16 | VoxelType::F32 => (16, 32),
        VoxelType::F64 => (64, 64),
        VoxelType::I8 => (256, 8),
        VoxelType::U16 => (512, 16),
        VoxelType::U32 => (768, 32),
        VoxelType::I64 => (1024, 64),
        VoxelType::U64 => (1280, 64),
    }
}
