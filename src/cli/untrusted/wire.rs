//! What the two processes say to each other: JSON with its length in front, and behind it the bytes of voxels.
//!
//! ```text
//! length(u32, little-endian) JSON bytes
//! ```
//!
//! Nothing of a header is rounded on its way, and a fill may be NaN.

use crate::format::geometry::is_invertible;
use crate::volume::{
    Header, Limits, Piece, PrecisionLoss, Problem, ReadError, TimeComponent, VolumeSelection,
    VoxelBox, VoxelType, Voxels,
};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned};
use std::io::{self, Read, Write};

/// JSON is no longer than that: lists of series and times are.
const MAX_JSON_BYTES: u32 = 64 << 20;

/// The first message to the reader: what it opens.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Opening {
    pub path: String,
    pub raw: Option<String>,
    pub wanted: VolumeSelection,
    pub limits: Limits,
}

/// The messages to the reader that follow.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Asking {
    pub pick: TimeComponent,
    pub region: VoxelBox,
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
        r#type: VoxelType,
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
        #[serde(with = "Told")]
        problem: Problem,
    },
}

/// What was opened.
#[derive(Debug, Serialize, Deserialize)]
pub struct Opened {
    pub header: Header,
    pub reads_parts: bool,
    pub reads_whole_rows: bool,
}

impl Opened {
    /// Whether this is a header that a source may have.
    pub fn is_sound(&self) -> bool {
        let Header {
            dims,
            components,
            times,
            world_from_voxel,
            rescale,
            ..
        } = &self.header;
        dims.iter().all(|&n| n > 0)
            && *components > 0
            && *times > 0
            && is_invertible(world_from_voxel)
            && rescale.slope.is_normal()
            && rescale.intercept.is_finite()
    }
}

/// A word of the program's own.
type Word = &'static str;

/// The names of formats live as long as the program; an error ends it.
fn word<'de, D: Deserializer<'de>>(from: D) -> Result<Word, D::Error> {
    Ok(Box::leak(Box::deserialize(from)?))
}

mod cause {
    use super::*;

    pub fn serialize<S: Serializer>(cause: &io::Error, to: S) -> Result<S::Ok, S::Error> {
        cause.to_string().serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<io::Error, D::Error> {
        String::deserialize(from).map(io::Error::other)
    }
}

/// How a [`Problem`] crosses.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Problem")]
enum Told {
    Io {
        #[serde(deserialize_with = "word")]
        doing: Word,
        #[serde(with = "cause")]
        cause: io::Error,
    },
    UnknownFormat(String),
    Missing {
        #[serde(deserialize_with = "word")]
        format: Word,
        field: String,
    },
    Invalid {
        #[serde(deserialize_with = "word")]
        format: Word,
        field: String,
        wanted: String,
        found: String,
    },
    Size {
        #[serde(deserialize_with = "word")]
        format: Word,
        wanted_bytes: u64,
        found_bytes: u64,
    },
    TooFewEncoded {
        #[serde(deserialize_with = "word")]
        format: Word,
        #[serde(deserialize_with = "word")]
        encoding: Word,
        wanted_bytes: u64,
        encoded_bytes: u64,
    },
    Damaged {
        #[serde(deserialize_with = "word")]
        format: Word,
        #[serde(deserialize_with = "word")]
        encoding: Word,
        decoded_bytes: u64,
        cause: String,
    },
    Unsupported {
        #[serde(deserialize_with = "word")]
        format: Word,
        what: String,
    },
    Unstructured,
    Limit {
        what: String,
        wanted_bytes: u64,
        limit_bytes: u64,
    },
}

/// Says why nothing was read.
pub fn put_failed(out: &mut impl Write, error: ReadError) -> io::Result<()> {
    let ReadError { path, problem } = error;
    let path = path.to_string_lossy().into_owned();
    put(out, &Answer::Failed { path, problem })
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
            r#type: piece.voxels.voxel_type(),
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
    r#type: VoxelType,
    count: usize,
    loss: PrecisionLoss,
) -> io::Result<Piece> {
    fn numbers<T: bytemuck::Pod>(input: &mut impl Read, count: usize) -> io::Result<Vec<T>> {
        let mut numbers = Vec::new();
        numbers.try_reserve_exact(count).map_err(io::Error::other)?;
        numbers.resize(count, T::zeroed());
        input.read_exact(bytemuck::cast_slice_mut(&mut numbers))?;
        Ok(numbers)
    }
    let voxels = match r#type {
        VoxelType::U8 => Voxels::U8(numbers(input, count)?),
        VoxelType::I8 => Voxels::I8(numbers(input, count)?),
        VoxelType::U16 => Voxels::U16(numbers(input, count)?),
        VoxelType::I16 => Voxels::I16(numbers(input, count)?),
        VoxelType::F16 => Voxels::F16(numbers(input, count)?),
        VoxelType::F32 => Voxels::F32(numbers(input, count)?),
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
    use crate::volume::{Channel, ComponentKind, Format, Heights, Rescale, Series};
    use glam::DAffine3;

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
            meaning: ComponentKind::Channels(vec![
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
            heights: Heights::Levels,
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
        let opened = Opened {
            header: header.clone(),
            reads_parts: true,
            reads_whole_rows: false,
        };
        put(&mut bytes, &Answer::Opened(Box::new(opened))).expect("written");
        let found = take(&mut bytes.as_slice()).expect("read");
        let Some(Answer::Opened(found)) = found else {
            panic!("{found:?}");
        };
        assert!(found.is_sound());
        assert_eq!(found.header, header);
    }

    #[test]
    fn a_piece_crosses_unchanged_and_what_is_missing_is_an_error() {
        let piece = Piece {
            voxels: Voxels::F32(vec![0.1, f32::INFINITY, -0.0]),
            loss: PrecisionLoss {
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
                    take_piece(
                        &mut input,
                        r#type,
                        count as usize,
                        PrecisionLoss { changed, worst },
                    )
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
