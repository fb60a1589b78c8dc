//! A NRRD in one file: teem.sourceforge.net/nrrd/format.html, version 4.

use super::WriteVolumeError;
use super::layout::Layout;
use super::slabs::Slabs;
use crate::volume::{ComponentKind, VoxelType};
use flate2::{Compression, write::GzEncoder};
use glam::DVec3;
use std::fmt::Write as _;
use std::io::Write;

pub(super) fn write(
    layout: &Layout,
    compress: bool,
    out: &mut impl Write,
    slabs: &mut Slabs,
) -> Result<(), WriteVolumeError> {
    out.write_all(header(layout, compress).as_bytes())?;
    if !compress {
        return slabs.interleaved(out);
    }
    let mut gzip = GzEncoder::new(out, Compression::default());
    slabs.interleaved(&mut gzip)?;
    gzip.finish()?;
    Ok(())
}

fn header(layout: &Layout, compress: bool) -> String {
    let ([x, y, z], first) = layout.steps();
    let vector = |v: DVec3| format!("({},{},{})", v.x, v.y, v.z);
    let mut sizes = layout.dims.map(|n| n.to_string()).to_vec();
    let mut directions = [x, y, z].map(vector).to_vec();
    let mut kinds = vec!["domain"; 3];
    if layout.components > 1 {
        sizes.insert(0, layout.components.to_string());
        directions.insert(0, "none".to_owned());
        kinds.insert(
            0,
            match layout.meaning {
                ComponentKind::Rgb => "RGB-color",
                ComponentKind::Rgba => "RGBA-color",
                ComponentKind::Vector => "vector",
                ComponentKind::Numbers | ComponentKind::Channels(_) => "list",
            },
        );
    }
    if layout.times > 1 {
        sizes.push(layout.times.to_string());
        directions.push("none".to_owned());
        kinds.push("time");
    }
    let mut text = format!(
        "NRRD0004\n# written by stratavox\ntype: {}\ndimension: {}\nspace: right-anterior-superior\nsizes: {}\n\
         space directions: {}\nkinds: {}\nendian: little\nencoding: {}\nspace origin: {}\n",
        word(layout.number),
        sizes.len(),
        sizes.join(" "),
        directions.join(" "),
        kinds.join(" "),
        if compress { "gzip" } else { "raw" },
        vector(first),
    );
    if let Some(unit) = layout.length_unit {
        let _ = writeln!(text, "space units: \"{unit}\" \"{unit}\" \"{unit}\"");
    }
    let unit = match layout.is_hounsfield {
        true => Some("HU"),
        false => layout.unit.as_deref(),
    };
    // A line end in it would begin another field.
    if let Some(unit) = unit.filter(|unit| !unit.chars().any(char::is_control)) {
        let _ = writeln!(text, "sample units: {unit}");
    }
    text.push('\n');
    text
}

fn word(number: VoxelType) -> &'static str {
    match number {
        VoxelType::U8 => "uint8",
        VoxelType::I8 => "int8",
        VoxelType::U16 => "uint16",
        VoxelType::I16 => "int16",
        VoxelType::U32 => "uint32",
        VoxelType::I32 => "int32",
        VoxelType::U64 => "uint64",
        VoxelType::I64 => "int64",
        VoxelType::F16 | VoxelType::F32 => "float",
        VoxelType::F64 => "double",
    }
}
