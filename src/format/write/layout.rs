//! What is written, decided before the first byte: the type, the place in space, and what gets lost.

use super::numbers::Map;
use super::{NumberType, Selection, VolumeFormat, WriteVolumeError, WriteVolumeOptions};
use crate::format::convert::to_u64;
use crate::volume::{ComponentKind, Header, Rescale, VoxelType};
use glam::{DAffine3, DVec3};

/// A volume as the file will describe it.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub dims: [u32; 3],
    pub times: u32,
    pub components: u32,
    /// The type in the file.
    pub number: VoxelType,
    /// What the file says of its numbers; the identity where they are values.
    pub rescale: Rescale,
    /// How a stored number becomes one of the file.
    pub map: Map,
    pub world_from_voxel: DAffine3,
    /// What the file calls the unit of its lengths, where that is not the millimetre.
    pub length_unit: Option<&'static str>,
    pub meaning: ComponentKind,
    pub unit: Option<String>,
    pub is_labels: bool,
    pub is_hounsfield: bool,
    pub notes: Vec<String>,
}

impl Layout {
    pub(super) fn of(
        header: &Header,
        selection: &Selection,
        options: &WriteVolumeOptions,
    ) -> Result<Self, WriteVolumeError> {
        let mut notes = Vec::new();
        let is_part = selection.components != (0..header.components);
        let meaning = if is_part {
            ComponentKind::Numbers
        } else {
            header.meaning.clone()
        };
        let (number, map, rescale) = numbers(header, options, &mut notes);
        let corner = DVec3::from_array(selection.region.min.map(f64::from));
        let (length_unit, scale) = lengths(header, options.format, &mut notes);
        let layout = Self {
            dims: selection.region.dims(),
            times: selection.times.end.saturating_sub(selection.times.start),
            components: selection
                .components
                .end
                .saturating_sub(selection.components.start),
            number,
            rescale,
            map,
            #[allow(
                clippy::arithmetic_side_effects,
                reason = "a product of matrices of f64: nothing wraps or panics"
            )]
            world_from_voxel: DAffine3::from_scale(DVec3::splat(scale))
                * header.world_from_voxel
                * DAffine3::from_translation(corner),
            length_unit,
            meaning,
            unit: header.unit.clone(),
            is_labels: header.is_labels,
            is_hounsfield: header.hounsfield && !matches!(options.numbers, NumberType::Spread(..)),
            notes,
        };
        let mut layout = layout;
        layout.note_losses(header, options);
        layout.voxel_bytes().ok_or_else(|| {
            WriteVolumeError::NoRoom("no file holds so many bytes of voxels".to_owned())
        })?;
        Ok(layout)
    }

    /// Bytes of all numbers.
    pub(super) fn voxel_bytes(&self) -> Option<u64> {
        let others = [self.times, self.components];
        self.dims
            .into_iter()
            .chain(others)
            .try_fold(to_u64(self.number.bytes()), |product, n| {
                product.checked_mul(n.into())
            })
    }

    /// The steps between voxel centres and the centre of the first voxel, RAS+.
    #[allow(
        clippy::arithmetic_side_effects,
        reason = "vectors of f64: nothing wraps or panics"
    )]
    pub(super) fn steps(&self) -> ([DVec3; 3], DVec3) {
        let matrix = self.world_from_voxel.matrix3;
        let first = self.world_from_voxel.transform_point3(DVec3::splat(0.5));
        ([matrix.x_axis, matrix.y_axis, matrix.z_axis], first)
    }

    fn note_losses(&mut self, header: &Header, options: &WriteVolumeOptions) {
        let is_nifti = matches!(options.format, VolumeFormat::Nifti { .. });
        let is_bricks = options.format == VolumeFormat::Bricks;
        let mut lost = Vec::new();
        if options.format == VolumeFormat::Npy {
            lost.push("where the voxels lie");
        }
        if header.is_earth && !is_bricks {
            lost.push("that the world is a piece of the Earth, its degrees and its map");
        }
        if header.is_labels && !is_nifti && !is_bricks {
            lost.push("that the values are labels");
        }
        if !header.time_names.is_empty() {
            lost.push("the moments of its times");
        }
        if matches!(header.meaning, ComponentKind::Channels(_)) {
            lost.push("names and colors of the channels");
        }
        if header.unit.is_some() && options.format != VolumeFormat::Nrrd && !is_bricks {
            lost.push("the unit of the values");
        }
        if !lost.is_empty() {
            self.notes
                .push(format!("the file does not keep {}", lost.join(", ")));
        }
        if !header.is_patient && (is_nifti || options.format == VolumeFormat::Nrrd) {
            self.notes.push(
                "the axes are written as those of a patient, x right, y anterior, z superior: the input does not say so"
                    .to_owned(),
            );
        }
        if let Some(fill) = header.fill {
            self.notes.push(match self.number.is_float() {
                true => "voxels without data are written as NaN".to_owned(),
                false if is_bricks => return,
                false => format!("{fill} means no data in the input: the file cannot say so"),
            });
        }
    }
}

/// Units that NRRD files name, in metres.
const NRRD_UNITS: [(&str, f64); 4] = [("nm", 1e-9), ("um", 1e-6), ("m", 1.0), ("km", 1e3)];

/// The unit of lengths that the file names, and what multiplies lengths to be in it, or else in millimetres: readers of
/// MetaImage and many of NIfTI know no other unit.
fn lengths(
    header: &Header,
    format: VolumeFormat,
    notes: &mut Vec<String>,
) -> (Option<&'static str>, f64) {
    let is_metres = |unit: f64, metres: f64| (metres / unit - 1.0).abs() < 1e-9;
    let keeps_numbers = matches!(format, VolumeFormat::Bricks | VolumeFormat::Npy);
    let Some(metres) = header
        .length_metres
        .filter(|&metres| !keeps_numbers && !is_metres(1e-3, metres))
    else {
        return (None, 1.0);
    };
    let named = NRRD_UNITS
        .iter()
        .find(|(_, unit)| format == VolumeFormat::Nrrd && is_metres(*unit, metres));
    if let Some((name, _)) = named {
        return (Some(name), 1.0);
    }
    let scale = metres / 1e-3;
    notes.push(format!(
        "lengths are written in millimetres, {scale} for each unit of the input"
    ));
    (None, scale)
}

/// The type of the file, the way to it, and what the file says of its numbers.
fn numbers(
    header: &Header,
    options: &WriteVolumeOptions,
    notes: &mut Vec<String>,
) -> (VoxelType, Map, Rescale) {
    let plain = Rescale::default();
    let map = |number: VoxelType, rescale: Rescale, window| Map {
        number,
        rescale,
        window,
        fill: header.fill,
    };
    let in_format = |number: VoxelType, notes: &mut Vec<String>| {
        if number == VoxelType::F16
            && !matches!(options.format, VolumeFormat::Npy | VolumeFormat::Bricks)
        {
            notes.push("the format has no f16: f32 is written".to_owned());
            return VoxelType::F32;
        }
        number
    };
    match options.numbers {
        NumberType::Values(number) => {
            let number = in_format(number, notes);
            (number, map(number, header.rescale, None), plain)
        }
        NumberType::Spread(number, window) => {
            let number = in_format(number, notes);
            (number, map(number, header.rescale, Some(window)), plain)
        }
        NumberType::Stored => {
            let keeps_rescale = matches!(
                options.format,
                VolumeFormat::MetaImage | VolumeFormat::Nifti { .. } | VolumeFormat::Bricks
            );
            if header.rescale == plain || keeps_rescale {
                let number = in_format(header.stored, notes);
                return (number, map(number, plain, None), header.rescale);
            }
            let number = type_of_values(header);
            notes.push(format!(
                "the file cannot say value = stored * {} + {}: values are written, as {}",
                header.rescale.slope,
                header.rescale.intercept,
                number.name()
            ));
            (number, map(number, header.rescale, None), plain)
        }
    }
}

/// The smallest type that holds every value that stored numbers can have.
fn type_of_values(header: &Header) -> VoxelType {
    let Rescale { slope, intercept } = header.rescale;
    let range = match header.stored {
        VoxelType::U8 => Some((0.0, 255.0)),
        VoxelType::I8 => Some((-128.0, 127.0)),
        VoxelType::U16 => Some((0.0, 65_535.0)),
        VoxelType::I16 => Some((-32_768.0, 32_767.0)),
        _ => None,
    };
    let whole = slope == 1.0 && intercept.fract() == 0.0;
    let Some((low, high)) = range.filter(|_| whole) else {
        return match header.stored {
            VoxelType::F64 => VoxelType::F64,
            _ => VoxelType::F32,
        };
    };
    let (low, high) = (low + intercept, high + intercept);
    let fits = |min: f64, max: f64| min <= low && high <= max;
    match () {
        () if fits(0.0, 255.0) => VoxelType::U8,
        () if fits(-128.0, 127.0) => VoxelType::I8,
        () if fits(-32_768.0, 32_767.0) => VoxelType::I16,
        () if fits(0.0, 65_535.0) => VoxelType::U16,
        () if fits(i32::MIN.into(), i32::MAX.into()) => VoxelType::I32,
        () => VoxelType::F32,
    }
}
