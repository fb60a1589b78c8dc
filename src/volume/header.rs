//! What a source says of itself before any voxel is read: `value = stored * slope + intercept` at
//! `world = world_from_voxel voxel`.

use super::{MapKind, MapProjection, VoxelBox, VoxelType};
use glam::DAffine3;

/// What a source holds. Nothing in it can be wrong: dims are not zero, the affine can be inverted.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Header {
    /// The kind of file.
    pub format: Format,
    /// Voxels along x, y, z.
    pub dims: [u32; 3],
    /// Numbers per voxel.
    pub components: u32,
    /// Time steps.
    pub times: u32,
    /// The type in the file.
    pub stored: VoxelType,
    /// Voxel space (corner of the grid at 0, centres at +0.5) to world, RAS+ for medical files.
    #[cfg_attr(feature = "json", serde(with = "super::json::affine"))]
    pub world_from_voxel: DAffine3,
    /// Stored number to value.
    pub rescale: Rescale,
    /// The stored number that means "no data".
    #[cfg_attr(feature = "json", serde(with = "super::json::bits"))]
    pub fill: Option<f64>,
    /// True where the file says that values are Hounsfield units (or the format's way of saying so).
    pub hounsfield: bool,
    /// The unit of values as the file words it, `K` or `m s-1`; `None` where it is silent.
    pub unit: Option<String>,
    /// The CF standard name of the variable; `None` where there is none.
    pub standard_name: Option<String>,
    /// What the values are, in the file's words: `Water vapor mixing ratio`.
    pub long_name: Option<String>,
    /// How the picture was taken, by the codes of DICOM PS3.3 C.7.3.1.1.1: `CT`, `MR`, `PT`, `GM` (microscopy).
    pub modality: Option<String>,
    /// What the numbers of a voxel are to each other.
    pub meaning: ComponentKind,
    /// True where the file says that values are names of things: nothing lies between two of them.
    pub is_labels: bool,
    /// True where the world is a piece of the Earth in kilometres: x east, y north, z up.
    pub is_earth: bool,
    /// World units of a degree of longitude along x and of latitude along y, both counted from 0, from a moved pole where
    /// [`Self::map`] has one; `None` where points along that axis have no such coordinate of their own.
    pub degree_lengths: [Option<f64>; 2],
    /// True where the file says how its axes lie in a patient: x right, y anterior, z superior.
    pub is_patient: bool,
    /// Metres of one unit of the world; `None` where the file is silent.
    pub length_metres: Option<f64>,
    /// How many resolutions the source has; 1 where there is only this one.
    pub levels: u32,
    /// The moment of each time step, an ISO 8601 date or a number with its unit. Empty where the file does not say.
    pub time_names: Vec<String>,
    /// The DICOM series of a folder; the one this source reads comes first. Empty in other formats.
    pub series: Vec<Series>,
    /// Names of the variables in the file; the one this source reads comes first. Empty where the format has no names.
    pub variables: Vec<String>,
    /// Variables that the file does not have and that are computed from those that it has, where they are asked for.
    pub derived: Vec<DerivedVariable>,
    /// The map that the world is drawn on; `None` where the file tells no map.
    pub map: Option<MapProjection>,
    /// Names of the variables of two dimensions that hold the latitude and the longitude of each column, degrees; `None` where
    /// the file has none.
    pub earth_arrays: Option<[String; 2]>,
    /// CF standard names of [`Self::variables`], in their order, empty where one has none. Empty in formats without.
    pub variable_standard_names: Vec<String>,
    /// What the places along z of a piece of the Earth stand for.
    pub heights: Heights,
    /// What a person should know about how the file was understood, one sentence each.
    pub notes: Vec<String>,
}

impl Header {
    /// [`Self::degree_lengths`] where degrees are those of the Earth: none where the pole of the grid is moved.
    pub fn earth_degree_lengths(&self) -> [Option<f64>; 2] {
        match self.map {
            Some(map) if map.kind == MapKind::LatitudeLongitude => [None; 2],
            _ => self.degree_lengths,
        }
    }

    /// One scalar volume of one time, the stored numbers being the values, about which nothing else is known.
    pub fn new(
        format: Format,
        dims: [u32; 3],
        stored: VoxelType,
        world_from_voxel: DAffine3,
    ) -> Self {
        Self {
            format,
            dims,
            components: 1,
            times: 1,
            stored,
            world_from_voxel,
            rescale: Rescale::default(),
            fill: None,
            hounsfield: false,
            unit: None,
            standard_name: None,
            long_name: None,
            modality: (format == Format::Tiff).then(|| "GM".to_owned()),
            meaning: ComponentKind::Numbers,
            is_labels: false,
            is_earth: false,
            degree_lengths: [None; 2],
            is_patient: false,
            length_metres: None,
            levels: 1,
            time_names: Vec::new(),
            series: Vec::new(),
            variables: Vec::new(),
            derived: Vec::new(),
            map: None,
            earth_arrays: None,
            variable_standard_names: Vec::new(),
            heights: Heights::Lengths,
            notes: Vec::new(),
        }
    }

    /// World length from level to level, where places along z are nothing but numbers of levels.
    pub fn level_length(&self) -> Option<f64> {
        let step = self.world_from_voxel.matrix3.z_axis.z.abs();
        (self.heights == Heights::Levels).then_some(step)
    }

    /// Metres of a world length along z; `None` where the file is silent, and of levels, whose heights are not known.
    pub fn height_metres(&self) -> Option<f64> {
        self.length_metres
            .filter(|_| self.heights != Heights::Levels)
    }

    /// Voxels of one time and component.
    pub fn voxel_count(&self) -> u64 {
        self.dims.iter().map(|&n| u64::from(n)).product()
    }

    /// The box of all voxels.
    pub fn whole(&self) -> VoxelBox {
        VoxelBox {
            min: [0; 3],
            max: self.dims,
        }
    }
}

/// What the places along z of a piece of the Earth stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub enum Heights {
    /// Lengths over sea level.
    #[default]
    Lengths,
    /// Pressures, at their heights in the standard atmosphere.
    Pressures,
    /// Numbers of levels whose heights are not known: they are spread evenly, the centre of the lowest lies at 0.
    Levels,
}

/// What the components of a voxel are to each other.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub enum ComponentKind {
    /// One number, or several of which the file says nothing.
    Numbers,
    /// sRGB red, green and blue, full at the largest number of an integer type and at 1 for floats.
    Rgb,
    /// The same, and opacity, not premultiplied.
    Rgba,
    /// Coordinates of a vector: its length can be drawn.
    Vector,
    /// Things seen in the same place, such as the dyes of a microscope; one entry a component.
    Channels(Vec<Channel>),
}

/// One of several things seen in the same place.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Channel {
    /// Empty where the file has none.
    pub name: String,
    /// The sRGB colour, 0 to 1, that the file wants it shown in.
    pub srgb: Option<[f32; 3]>,
    /// The values from dark to bright, after rescale, that the file wants it shown with.
    pub window: Option<[f64; 2]>,
}

/// A variable that is computed from others of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct DerivedVariable {
    /// As a file's own variable is asked for: `temperature`.
    pub name: String,
    /// The unit of its values: `K`.
    pub unit: String,
    /// Names of what it is computed from.
    pub from: Vec<String>,
}

/// A series of a DICOM folder.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Series {
    /// Its instance UID.
    pub uid: String,
    /// What was imaged, as the file words it; may be empty.
    pub description: String,
    /// How many pictures it has.
    pub pictures: usize,
}

/// Which volume of a file that holds several; `None` takes the only one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct VolumeSelection {
    /// The name of a variable, a data set's path, an array's name.
    pub variable: Option<String>,
    /// The UID of a DICOM series.
    pub series: Option<String>,
    /// One of several resolutions, 0 the finest.
    pub level: Option<u32>,
    /// True for the voxels as they stand in the file where those of a picture are others: a grid of uneven levels
    /// is drawn from even ones between them.
    pub as_stored: bool,
}

/// `value = stored * slope + intercept`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Rescale {
    /// Value per stored unit; finite and not zero.
    pub slope: f64,
    /// Value of stored zero; finite.
    pub intercept: f64,
}

impl Default for Rescale {
    fn default() -> Self {
        Self {
            slope: 1.0,
            intercept: 0.0,
        }
    }
}

/// The kind of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
#[allow(missing_docs, reason = "the names say it")]
pub enum Format {
    Nifti1,
    Nifti2,
    Nrrd,
    MetaImage,
    Raw,
    Dicom,
    Tiff,
    Vti,
    Vtk,
    Npy,
    Csv,
    Ply,
    Vtp,
    Hdf5,
    NetCdf,
    Zarr,
    Grib2,
    Bricks,
    Phantom,
}

impl Format {
    /// The word of `info --json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nifti1 => "nifti1",
            Self::Nifti2 => "nifti2",
            Self::Nrrd => "nrrd",
            Self::MetaImage => "metaimage",
            Self::Raw => "raw",
            Self::Dicom => "dicom",
            Self::Tiff => "tiff",
            Self::Vti => "vti",
            Self::Vtk => "vtk",
            Self::Npy => "npy",
            Self::Csv => "csv",
            Self::Ply => "ply",
            Self::Vtp => "vtp",
            Self::Hdf5 => "hdf5",
            Self::NetCdf => "netcdf",
            Self::Zarr => "zarr",
            Self::Grib2 => "grib2",
            Self::Bricks => "bricks",
            Self::Phantom => "phantom",
        }
    }
}
