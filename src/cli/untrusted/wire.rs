//! What the two processes say to each other: JSON with its length in front, and behind it the bytes of voxels.
//!
//! ```text
//! length(u32, little-endian) JSON bytes
//! ```
//!
//! Numbers of headers cross as their bits: nothing is rounded, and a fill may be NaN.

use crate::format::geometry::is_invertible;
use crate::volume::{
    Channel, Format, Header, Limits, Loss, Meaning, Piece, Problem, ReadError, Rescale, Series,
    VoxelType, Voxels, Wanted,
};
use glam::DAffine3;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::io::{self, Read, Write};

/// JSON is no longer than that: lists of series and times are.
const MAX_JSON_BYTES: u32 = 64 << 20;

/// The first message to the reader: what it opens.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Opening {
    pub path: String,
    pub raw: Option<String>,
    pub variable: Option<String>,
    pub series: Option<String>,
    pub level: Option<u32>,
    pub as_stored: bool,
    pub max_bytes: u64,
    pub max_files: usize,
    pub max_header_bytes: usize,
    pub detached: bool,
}

impl Opening {
    pub fn wanted(&self) -> Wanted {
        Wanted {
            variable: self.variable.clone(),
            series: self.series.clone(),
            level: self.level,
            as_stored: self.as_stored,
        }
    }

    pub fn limits(&self) -> Limits {
        Limits {
            max_bytes: self.max_bytes,
            max_files: self.max_files,
            max_header_bytes: self.max_header_bytes,
            detached: self.detached,
        }
    }
}

/// The messages to the reader that follow.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Asking {
    pub time: u32,
    pub component: u32,
    pub min: [u32; 3],
    pub max: [u32; 3],
    pub what: What,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub enum What {
    /// One piece, as voxels.
    Piece,
    /// Pieces of so many slices.
    Slabs(u32),
    /// The bytes of the file.
    Bytes,
}

/// The messages of the reader.
#[derive(Debug, Serialize, Deserialize)]
pub enum Answer {
    Opened(Box<Opened>),
    /// So many numbers follow.
    Voxels {
        r#type: u8,
        count: u64,
        changed: u64,
        worst: u64,
    },
    /// All slabs were sent.
    End,
    /// So many bytes follow, or there are none to be had.
    Bytes(Option<u64>),
    Failed {
        path: String,
        problem: Told,
    },
}

/// A header, in types that JSON has.
#[derive(Debug, Serialize, Deserialize)]
pub struct Opened {
    pub reads_parts: bool,
    pub reads_whole_rows: bool,
    format: u8,
    dims: [u32; 3],
    components: u32,
    times: u32,
    stored: u8,
    world_from_voxel: [u64; 12],
    rescale: [u64; 2],
    fill: Option<u64>,
    hounsfield: bool,
    unit: Option<String>,
    standard_name: Option<String>,
    long_name: Option<String>,
    modality: Option<String>,
    is_patient: bool,
    length_metres: Option<u64>,
    meaning: u8,
    channels: Vec<ChannelBits>,
    is_labels: bool,
    is_earth: bool,
    degree_lengths: [Option<u64>; 2],
    levels: u32,
    time_names: Vec<String>,
    series: Vec<(String, String, usize)>,
    variables: Vec<String>,
    notes: Vec<String>,
}

/// Name, colour and window of a channel.
type ChannelBits = (String, Option<[u32; 3]>, Option<[u64; 2]>);

const FORMATS: [Format; 16] = [
    Format::Nifti1,
    Format::Nifti2,
    Format::Nrrd,
    Format::MetaImage,
    Format::Raw,
    Format::Dicom,
    Format::Tiff,
    Format::Vti,
    Format::Vtk,
    Format::Npy,
    Format::Hdf5,
    Format::NetCdf,
    Format::Zarr,
    Format::Grib2,
    Format::Bricks,
    Format::Phantom,
];

const TYPES: [VoxelType; 11] = [
    VoxelType::U8,
    VoxelType::I8,
    VoxelType::U16,
    VoxelType::I16,
    VoxelType::U32,
    VoxelType::I32,
    VoxelType::U64,
    VoxelType::I64,
    VoxelType::F16,
    VoxelType::F32,
    VoxelType::F64,
];

fn number_of<T: PartialEq>(all: &[T], one: &T) -> u8 {
    all.iter().position(|other| other == one).unwrap_or(0) as u8
}

impl Opened {
    pub fn of(header: &Header, reads_parts: bool, reads_whole_rows: bool) -> Self {
        let channels = match &header.meaning {
            Meaning::Channels(channels) => channels.as_slice(),
            _ => &[],
        };
        Self {
            reads_parts,
            reads_whole_rows,
            format: number_of(&FORMATS, &header.format),
            dims: header.dims,
            components: header.components,
            times: header.times,
            stored: number_of(&TYPES, &header.stored),
            world_from_voxel: header.world_from_voxel.to_cols_array().map(f64::to_bits),
            rescale: [header.rescale.slope, header.rescale.intercept].map(f64::to_bits),
            fill: header.fill.map(f64::to_bits),
            hounsfield: header.hounsfield,
            unit: header.unit.clone(),
            standard_name: header.standard_name.clone(),
            long_name: header.long_name.clone(),
            modality: header.modality.clone(),
            is_patient: header.is_patient,
            length_metres: header.length_metres.map(f64::to_bits),
            meaning: match header.meaning {
                Meaning::Numbers => 0,
                Meaning::Rgb => 1,
                Meaning::Rgba => 2,
                Meaning::Vector => 3,
                Meaning::Channels(_) => 4,
            },
            channels: channels
                .iter()
                .map(|channel| {
                    let srgb = channel.srgb.map(|srgb| srgb.map(f32::to_bits));
                    let window = channel.window.map(|window| window.map(f64::to_bits));
                    (channel.name.clone(), srgb, window)
                })
                .collect(),
            is_labels: header.is_labels,
            is_earth: header.is_earth,
            degree_lengths: header.degree_lengths.map(|length| length.map(f64::to_bits)),
            levels: header.levels,
            time_names: header.time_names.clone(),
            series: header
                .series
                .iter()
                .map(|series| {
                    (
                        series.uid.clone(),
                        series.description.clone(),
                        series.pictures,
                    )
                })
                .collect(),
            variables: header.variables.clone(),
            notes: header.notes.clone(),
        }
    }

    /// `None` where this is no header that a source may have.
    pub fn header(self) -> Option<Header> {
        let world_from_voxel = self.world_from_voxel.map(f64::from_bits);
        let world_from_voxel = DAffine3::from_cols_array(&world_from_voxel);
        let [slope, intercept] = self.rescale.map(f64::from_bits);
        let channels = self
            .channels
            .into_iter()
            .map(|(name, srgb, window)| Channel {
                name,
                srgb: srgb.map(|srgb| srgb.map(f32::from_bits)),
                window: window.map(|window| window.map(f64::from_bits)),
            });
        let series = self.series.into_iter();
        let header = Header {
            format: *FORMATS.get(usize::from(self.format))?,
            dims: self.dims,
            components: self.components,
            times: self.times,
            stored: *TYPES.get(usize::from(self.stored))?,
            world_from_voxel,
            rescale: Rescale { slope, intercept },
            fill: self.fill.map(f64::from_bits),
            hounsfield: self.hounsfield,
            unit: self.unit,
            standard_name: self.standard_name,
            long_name: self.long_name,
            modality: self.modality,
            is_patient: self.is_patient,
            length_metres: self.length_metres.map(f64::from_bits),
            meaning: match self.meaning {
                0 => Meaning::Numbers,
                1 => Meaning::Rgb,
                2 => Meaning::Rgba,
                3 => Meaning::Vector,
                _ => Meaning::Channels(channels.collect()),
            },
            is_labels: self.is_labels,
            is_earth: self.is_earth,
            degree_lengths: self.degree_lengths.map(|length| length.map(f64::from_bits)),
            levels: self.levels,
            time_names: self.time_names,
            series: series
                .map(|(uid, description, pictures)| Series {
                    uid,
                    description,
                    pictures,
                })
                .collect(),
            variables: self.variables,
            notes: self.notes,
        };
        let is_sound = header.dims.iter().all(|&n| n > 0)
            && header.components > 0
            && header.times > 0
            && is_invertible(&world_from_voxel)
            && slope.is_normal()
            && intercept.is_finite();
        is_sound.then_some(header)
    }
}

/// A [`Problem`], in types that JSON has.
#[derive(Debug, Serialize, Deserialize)]
pub enum Told {
    Io(String, String),
    UnknownFormat(String),
    Missing(String, String),
    Invalid(String, [String; 3]),
    Size(String, [u64; 2]),
    TooFewEncoded(String, String, [u64; 2]),
    Damaged(String, String, u64, String),
    Unsupported(String, String),
    Limit(String, [u64; 2]),
}

impl Told {
    pub fn of(problem: &Problem) -> Self {
        match problem {
            Problem::Io { doing, cause } => Self::Io((*doing).to_owned(), cause.to_string()),
            Problem::UnknownFormat(text) => Self::UnknownFormat(text.clone()),
            Problem::Missing { format, field } => {
                Self::Missing((*format).to_owned(), field.clone())
            }
            Problem::Invalid {
                format,
                field,
                wanted,
                found,
            } => Self::Invalid(
                (*format).to_owned(),
                [field.clone(), wanted.clone(), found.clone()],
            ),
            Problem::Size {
                format,
                wanted_bytes,
                found_bytes,
            } => Self::Size((*format).to_owned(), [*wanted_bytes, *found_bytes]),
            Problem::TooFewEncoded {
                format,
                encoding,
                wanted_bytes,
                encoded_bytes,
            } => Self::TooFewEncoded(
                (*format).to_owned(),
                (*encoding).to_owned(),
                [*wanted_bytes, *encoded_bytes],
            ),
            Problem::Damaged {
                format,
                encoding,
                decoded_bytes,
                cause,
            } => Self::Damaged(
                (*format).to_owned(),
                (*encoding).to_owned(),
                *decoded_bytes,
                cause.clone(),
            ),
            Problem::Unsupported { format, what } => {
                Self::Unsupported((*format).to_owned(), what.clone())
            }
            Problem::Limit {
                what,
                wanted_bytes,
                limit_bytes,
            } => Self::Limit(what.clone(), [*wanted_bytes, *limit_bytes]),
        }
    }

    pub fn problem(self) -> Problem {
        // The names of formats live as long as the program; an error ends it.
        let word = |text: String| -> &'static str { Box::leak(text.into_boxed_str()) };
        match self {
            Self::Io(doing, cause) => Problem::Io {
                doing: word(doing),
                cause: io::Error::other(cause),
            },
            Self::UnknownFormat(text) => Problem::UnknownFormat(text),
            Self::Missing(format, field) => Problem::Missing {
                format: word(format),
                field,
            },
            Self::Invalid(format, [field, wanted, found]) => Problem::Invalid {
                format: word(format),
                field,
                wanted,
                found,
            },
            Self::Size(format, [wanted_bytes, found_bytes]) => Problem::Size {
                format: word(format),
                wanted_bytes,
                found_bytes,
            },
            Self::TooFewEncoded(format, encoding, [wanted_bytes, encoded_bytes]) => {
                Problem::TooFewEncoded {
                    format: word(format),
                    encoding: word(encoding),
                    wanted_bytes,
                    encoded_bytes,
                }
            }
            Self::Damaged(format, encoding, decoded_bytes, cause) => Problem::Damaged {
                format: word(format),
                encoding: word(encoding),
                decoded_bytes,
                cause,
            },
            Self::Unsupported(format, what) => Problem::Unsupported {
                format: word(format),
                what,
            },
            Self::Limit(what, [wanted_bytes, limit_bytes]) => Problem::Limit {
                what,
                wanted_bytes,
                limit_bytes,
            },
        }
    }
}

pub fn failed(error: &ReadError) -> Answer {
    Answer::Failed {
        path: error.path.to_string_lossy().into_owned(),
        problem: Told::of(&error.problem),
    }
}

/// Writes a message.
pub fn put(out: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let json = serde_json::to_vec(message)?;
    let length = u32::try_from(json.len()).map_err(io::Error::other)?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&json)?;
    out.flush()
}

/// Reads a message; `None` where the other side has ended.
pub fn take<T: DeserializeOwned>(input: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; 4];
    match input.read_exact(&mut length) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        outcome => outcome?,
    }
    let length = u32::from_le_bytes(length);
    if length > MAX_JSON_BYTES {
        return Err(io::Error::other("a message is too long"));
    }
    let mut json = vec![0; length as usize];
    input.read_exact(&mut json)?;
    Ok(Some(serde_json::from_slice(&json)?))
}

/// Writes voxels behind the message that tells of them.
pub fn put_piece(out: &mut impl Write, piece: &Piece) -> io::Result<()> {
    put(
        out,
        &Answer::Voxels {
            r#type: number_of(&TYPES, &piece.voxels.voxel_type()),
            count: piece.voxels.len() as u64,
            changed: piece.loss.changed,
            worst: piece.loss.worst.to_bits(),
        },
    )?;
    match &piece.voxels {
        Voxels::U8(v) => out.write_all(v),
        Voxels::I8(v) => out.write_all(bytemuck::cast_slice(v)),
        Voxels::U16(v) => out.write_all(bytemuck::cast_slice(v)),
        Voxels::I16(v) => out.write_all(bytemuck::cast_slice(v)),
        Voxels::F16(v) => out.write_all(bytemuck::cast_slice(v)),
        Voxels::F32(v) => out.write_all(bytemuck::cast_slice(v)),
    }?;
    out.flush()
}

/// Reads the voxels that follow such a message.
pub fn take_piece(
    input: &mut impl Read,
    r#type: u8,
    count: usize,
    loss: Loss,
) -> io::Result<Piece> {
    fn numbers<T: bytemuck::Pod>(input: &mut impl Read, count: usize) -> io::Result<Vec<T>> {
        let mut numbers = Vec::new();
        numbers.try_reserve_exact(count).map_err(io::Error::other)?;
        numbers.resize(count, T::zeroed());
        input.read_exact(bytemuck::cast_slice_mut(&mut numbers))?;
        Ok(numbers)
    }
    let voxels = match TYPES.get(usize::from(r#type)) {
        Some(VoxelType::U8) => Voxels::U8(numbers(input, count)?),
        Some(VoxelType::I8) => Voxels::I8(numbers(input, count)?),
        Some(VoxelType::U16) => Voxels::U16(numbers(input, count)?),
        Some(VoxelType::I16) => Voxels::I16(numbers(input, count)?),
        Some(VoxelType::F16) => Voxels::F16(numbers(input, count)?),
        Some(VoxelType::F32) => Voxels::F32(numbers(input, count)?),
        _ => {
            return Err(io::Error::other(
                "voxels of a type that memory does not have",
            ));
        }
    };
    Ok(Piece { voxels, loss })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_crosses_unchanged() {
        let header = Header {
            components: 2,
            times: 3,
            rescale: Rescale {
                slope: 0.1,
                intercept: -1e-300,
            },
            fill: Some(f64::INFINITY),
            hounsfield: true,
            unit: Some("K".to_owned()),
            meaning: Meaning::Channels(vec![
                Channel {
                    name: "a".to_owned(),
                    srgb: Some([0.1, 0.2, 0.3]),
                    window: Some([0.1, 1e300]),
                },
                Channel::default(),
            ]),
            is_labels: true,
            is_earth: true,
            degree_lengths: [Some(71.3), None],
            levels: 4,
            time_names: vec!["now".to_owned()],
            series: vec![Series {
                uid: "1.2".to_owned(),
                description: "head".to_owned(),
                pictures: 7,
            }],
            variables: vec!["t".to_owned()],
            notes: vec!["a note".to_owned()],
            ..Header::new(
                Format::Phantom,
                [4, 5, 6],
                VoxelType::F64,
                DAffine3::from_scale(glam::dvec3(0.1, 0.2, 0.3)),
            )
        };
        let mut bytes = Vec::new();
        let opened = Answer::Opened(Box::new(Opened::of(&header, true, false)));
        put(&mut bytes, &opened).expect("written");
        let found = take(&mut bytes.as_slice()).expect("read");
        let Some(Answer::Opened(found)) = found else {
            panic!("{found:?}");
        };
        assert_eq!(found.header(), Some(header));
    }

    #[test]
    fn a_piece_crosses_unchanged_and_what_is_missing_is_an_error() {
        let piece = Piece {
            voxels: Voxels::F32(vec![0.1, f32::INFINITY, -0.0]),
            loss: Loss {
                changed: 2,
                worst: 0.1,
            },
        };
        let mut bytes = Vec::new();
        put_piece(&mut bytes, &piece).expect("written");
        for cut in 0..=bytes.len() {
            let mut input = &bytes[..cut];
            let found = take::<Answer>(&mut input).and_then(|answer| match answer {
                Some(Answer::Voxels {
                    r#type,
                    count,
                    changed,
                    worst,
                }) => {
                    let worst = f64::from_bits(worst);
                    take_piece(&mut input, r#type, count as usize, Loss { changed, worst })
                }
                _ => Err(io::Error::other("no voxels")),
            });
            match cut == bytes.len() {
                true => assert_eq!(found.expect("a piece"), piece),
                false => assert!(found.is_err(), "{cut}"),
            }
        }
    }
}
