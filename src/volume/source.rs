//! Where voxels come from: a header that promises, and a `read` that keeps the promise.

#[cfg(doc)]
use super::Survey;
use super::{Surveyed, VoxelType, Voxels};
use glam::DAffine3;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A volume that can be read in parts: a file, a folder, or a formula.
pub trait Source: Send + Sync {
    /// The file, folder or phantom, as errors name it.
    fn path(&self) -> &Path;

    /// What the source holds, checked once when it was opened.
    fn header(&self) -> &Header;

    /// The stored numbers of `region` at one time and component, x fastest.
    ///
    /// `pick` and `region` lie inside the header; integers of 32 and 64 bits and f64 are rounded to f32,
    /// and [`Piece::loss`] says what that cost.
    fn read(&self, pick: Pick, region: VoxelBox) -> Result<Piece, ReadError>;

    /// False where a part is found only by reading all that stands before it, as in a file that is compressed as a
    /// whole.
    fn reads_parts(&self) -> bool {
        true
    }

    /// True where a part of a row of voxels costs about what the whole row does, as in files of plain rows or of
    /// slices: neighbours along x are read together then.
    fn reads_whole_rows(&self) -> bool {
        false
    }

    /// What the source knows of its bricks, with an overview of about `most_seen` voxels; `None` where somebody has to
    /// look ([`Survey::of`]).
    ///
    /// # Errors
    /// What reading meets.
    fn surveyed(&self, pick: Pick, most_seen: u64) -> Result<Option<Surveyed>, ReadError> {
        let _ = (pick, most_seen);
        Ok(None)
    }

    /// Hands `region` to `take` in slabs of so many slices along z, the first one first, until it breaks off. A file
    /// that is compressed as a whole is decoded once.
    ///
    /// # Errors
    /// What reading meets.
    fn read_slabs(
        &self,
        pick: Pick,
        region: VoxelBox,
        slices: u32,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<(), ReadError> {
        for slab in region.slabs(slices) {
            if take(slab, self.read(pick, slab)?).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// The same numbers as little-endian bytes of the type in the file, none of them rounded. `None` from a source
    /// that has them in the types of [`Voxels`] only.
    fn read_bytes(&self, pick: Pick, region: VoxelBox) -> Result<Option<Vec<u8>>, ReadError> {
        let _ = (pick, region);
        Ok(None)
    }
}

/// What one [`Source::read`] brings.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The stored numbers, x fastest.
    pub voxels: Voxels,
    /// What rounding them to f32 changed.
    pub loss: Loss,
}

impl From<Voxels> for Piece {
    /// Voxels that needed no rounding.
    fn from(voxels: Voxels) -> Self {
        Self {
            voxels,
            loss: Loss::default(),
        }
    }
}

/// What rounding 32- and 64-bit integers and f64 to f32 changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loss {
    /// How many numbers are not what the file holds. A NaN that stays NaN is not changed.
    pub changed: u64,
    /// The largest distance between a number in the file and the one kept; infinite where one left the range of f32.
    pub worst: f64,
}

impl Loss {
    /// True where every number is exactly that of the file.
    pub fn is_none(&self) -> bool {
        self.changed == 0
    }

    /// The loss of two pieces together.
    pub fn and(self, other: Self) -> Self {
        Self {
            changed: self.changed.saturating_add(other.changed),
            worst: self.worst.max(other.worst),
        }
    }
}

/// Which of several volumes in one source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pick {
    /// Index of the time step.
    pub time: u32,
    /// Index of the component of a voxel.
    pub component: u32,
}

/// What a source holds. Nothing in it can be wrong: dims are not zero, the affine can be inverted.
#[derive(Clone, Debug, PartialEq)]
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
    pub world_from_voxel: DAffine3,
    /// Stored number to value.
    pub rescale: Rescale,
    /// The stored number that means "no data".
    pub fill: Option<f64>,
    /// True where the file says that values are Hounsfield units (or the format's way of saying so).
    pub hounsfield: bool,
    /// The unit of values as the file words it, `K` or `m s-1`; `None` where it is silent.
    pub unit: Option<String>,
    /// What the numbers of a voxel are to each other.
    pub meaning: Meaning,
    /// True where the file says that values are names of things: nothing lies between two of them.
    pub is_labels: bool,
    /// True where the world is a piece of the Earth in kilometres: x east, y north, z up.
    pub is_earth: bool,
    /// How many resolutions the source has; 1 where there is only this one.
    pub levels: u32,
    /// The moment of each time step, an ISO 8601 date or a number with its unit. Empty where the file does not say.
    pub time_names: Vec<String>,
    /// The DICOM series of a folder; the one this source reads comes first. Empty in other formats.
    pub series: Vec<Series>,
    /// Names of the variables in the file; the one this source reads comes first. Empty where the format has no names.
    pub variables: Vec<String>,
    /// What a person should know about how the file was understood, one sentence each.
    pub notes: Vec<String>,
}

impl Header {
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
            meaning: Meaning::Numbers,
            is_labels: false,
            is_earth: false,
            levels: 1,
            time_names: Vec::new(),
            series: Vec::new(),
            variables: Vec::new(),
            notes: Vec::new(),
        }
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

/// What the components of a voxel are to each other.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
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
pub struct Channel {
    /// Empty where the file has none.
    pub name: String,
    /// The sRGB colour, 0 to 1, that the file wants it shown in.
    pub srgb: Option<[f32; 3]>,
    /// The values from dark to bright, after rescale, that the file wants it shown with.
    pub window: Option<[f64; 2]>,
}

/// A series of a DICOM folder.
#[derive(Clone, Debug, PartialEq, Eq)]
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
pub struct Wanted {
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

/// Voxels from `min` (included) to `max` (excluded).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct VoxelBox {
    pub min: [u32; 3],
    pub max: [u32; 3],
}

impl VoxelBox {
    /// Whether all of its voxels are in `other` too.
    pub fn is_in(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] >= other.min[k] && self.max[k] <= other.max[k])
    }

    /// What both have; `None` where they have no voxel in common.
    pub fn and(&self, other: &Self) -> Option<Self> {
        let both = Self {
            min: std::array::from_fn(|k| self.min[k].max(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].min(other.max[k])),
        };
        (0..3).all(|k| both.min[k] < both.max[k]).then_some(both)
    }

    /// The smallest box that has the voxels of both.
    pub fn around(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// Voxels along x, y, z.
    pub fn dims(&self) -> [u32; 3] {
        std::array::from_fn(|k| self.max[k] - self.min[k])
    }

    /// Boxes of so many slices along z, the last one thinner, that make up this one.
    pub fn slabs(self, slices: u32) -> impl Iterator<Item = Self> {
        let [first, end] = [self.min[2], self.max[2]];
        let slices = slices.max(1);
        (first..end).step_by(slices as usize).map(move |z| {
            let mut slab = self;
            (slab.min[2], slab.max[2]) = (z, z.saturating_add(slices).min(end));
            slab
        })
    }
}

/// The kind of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
            Self::Hdf5 => "hdf5",
            Self::NetCdf => "netcdf",
            Self::Zarr => "zarr",
            Self::Grib2 => "grib2",
            Self::Bricks => "bricks",
            Self::Phantom => "phantom",
        }
    }
}

/// What went wrong with a source, and with which one.
#[derive(Debug, thiserror::Error)]
#[error("cannot read {}: {problem}", path.display())]
pub struct ReadError {
    /// The file, folder or phantom.
    pub path: PathBuf,
    /// What was found there.
    #[source]
    pub problem: Problem,
}

/// What can be wrong with a source. Texts taken from a file are escaped before they get here.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The system would not let us.
    #[error("{doing}")]
    Io {
        /// What was being done.
        doing: &'static str,
        /// The system's word.
        #[source]
        cause: std::io::Error,
    },
    /// No reader knows these bytes.
    #[error("unknown format{0}")]
    UnknownFormat(String),
    /// A field that must be there is not.
    #[error("the {format} header has no `{field}`")]
    Missing {
        /// The kind of file.
        format: &'static str,
        /// The field.
        field: String,
    },
    /// A field says something that cannot be.
    #[error("{format} field `{field}`: wanted {wanted}, found {found}")]
    Invalid {
        /// The kind of file.
        format: &'static str,
        /// The field.
        field: String,
        /// What would do.
        wanted: String,
        /// What stands there.
        found: String,
    },
    /// Fewer (or more) bytes than promised.
    #[error(
        "{format} data: the header promises {wanted_bytes} bytes of voxels, found {found_bytes}"
    )]
    Size {
        /// The kind of file.
        format: &'static str,
        /// What the header promises.
        wanted_bytes: u64,
        /// What is there.
        found_bytes: u64,
    },
    /// So few encoded bytes cannot hold so many voxels.
    #[error(
        "{format} data: the header promises {wanted_bytes} bytes of voxels, which {encoded_bytes} bytes of {encoding} cannot hold"
    )]
    TooFewEncoded {
        /// The kind of file.
        format: &'static str,
        /// How the voxels are written.
        encoding: &'static str,
        /// What the header promises.
        wanted_bytes: u64,
        /// What is there, encoded.
        encoded_bytes: u64,
    },
    /// The encoded voxels cannot be decoded.
    #[error(
        "{format} data: the {encoding} voxels are damaged after {decoded_bytes} good bytes: {cause}"
    )]
    Damaged {
        /// The kind of file.
        format: &'static str,
        /// How the voxels are written.
        encoding: &'static str,
        /// How many bytes of voxels came out before.
        decoded_bytes: u64,
        /// What the decoder says.
        cause: String,
    },
    /// A valid file that we do not read yet; says what.
    #[error("{format}: {what} is not supported")]
    Unsupported {
        /// The kind of file.
        format: &'static str,
        /// The feature.
        what: String,
    },
    /// More than the limits allow.
    #[error("{what} needs {wanted_bytes} bytes, the limit is {limit_bytes}")]
    Limit {
        /// What is too large.
        what: String,
        /// What it needs.
        wanted_bytes: u64,
        /// What is allowed.
        limit_bytes: u64,
    },
}

/// What a reader may use. Checked against declared sizes before anything is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Memory that one volume may take.
    pub max_bytes: u64,
    /// Files that one header may name.
    pub max_files: usize,
    /// Bytes of a text header.
    pub max_header_bytes: usize,
    /// True where a header may name other files, always in its own folder.
    pub detached: bool,
}

impl Limits {
    /// For files of strangers: one file, small headers, little memory.
    pub const UNTRUSTED: Self = Self {
        max_bytes: 1 << 30,
        max_files: 4096,
        max_header_bytes: 1 << 16,
        detached: false,
    };
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_bytes: 4 << 30,
            max_files: 65_536,
            max_header_bytes: 1 << 20,
            detached: true,
        }
    }
}
