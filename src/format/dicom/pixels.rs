//! One frame out of a file: decoded, its unused bits cleared, colours as red, green and blue side by side.

use super::DICOM;
use super::dataset::{PixelPlace, Stream, seek_to};
use super::file::PictureFile;
use super::fragments::Fragments;
use super::layout::{Color, Layout};
use super::syntax::Coding;
use super::{jpeg, jpeg2000, rle, samples};
use crate::format::convert::to_u64;
use crate::format::dicom::tags;
use crate::format::problem::{invalid, io, unsupported};
use crate::volume::{Limits, Problem};
use std::io::Read;

/// Where the frames of a file are, checked to be there.
#[derive(Clone, Debug)]
pub(super) enum Frames {
    Native,
    Encapsulated(Fragments),
}

impl Frames {
    /// Compares what the header promises with the bytes that are there. The note says what is odd and harmless.
    pub(super) fn find(
        file: &PictureFile,
        limits: &Limits,
    ) -> Result<(Self, Option<String>), Problem> {
        let layout = &file.layout;
        if layout.frame_bytes() > limits.max_bytes {
            return Err(Problem::Limit {
                what: "one frame".to_owned(),
                wanted_bytes: layout.frame_bytes(),
                limit_bytes: limits.max_bytes,
            });
        }
        let PixelPlace { bytes, .. } = file.place;
        let Some(found_bytes) = bytes else {
            if file.syntax.coding == Coding::Native {
                let found = "fragments in a transfer syntax that has none";
                let field = tags::name(file.place.tag);
                return Err(invalid(DICOM, &field, "a length", found));
            }
            let fragments = Fragments::find(file, limits)?;
            return Ok((Self::Encapsulated(fragments), None));
        };
        if file.syntax.coding != Coding::Native {
            let wanted = format!("fragments of {}", file.syntax.coding.name());
            return Err(invalid(
                DICOM,
                &tags::name(file.place.tag),
                wanted,
                &format!("{found_bytes} bytes"),
            ));
        }
        let wanted_bytes = layout
            .native_frame_bits()
            .saturating_mul(layout.frames.into())
            .div_ceil(8);
        if found_bytes < wanted_bytes {
            return Err(Problem::Size {
                format: DICOM,
                wanted_bytes,
                found_bytes,
            });
        }
        let extra = found_bytes.saturating_sub(wanted_bytes);
        let note =
            (extra > 1).then(|| format!("{extra} bytes follow the last pixel and are passed over"));
        Ok((Self::Native, note))
    }

    /// The samples of one frame, little-endian, of the layout's stored type, `frame_bytes` of them.
    pub(super) fn read(
        &self,
        file: &PictureFile,
        stream: &mut dyn Stream,
        frame: u32,
        limits: &Limits,
    ) -> Result<Vec<u8>, Problem> {
        let layout = &file.layout;
        let wanted_bytes = layout.frame_bytes();
        let mut bytes = match self {
            Self::Native => native(file, stream, frame)?,
            Self::Encapsulated(fragments) => {
                let encoded = fragments.read(stream, frame, limits)?;
                match file.syntax.coding {
                    Coding::Native | Coding::Encapsulated => {
                        let mut encoded = encoded;
                        encoded.truncate(
                            usize::try_from(layout.native_frame_bits().div_ceil(8))
                                .unwrap_or(usize::MAX),
                        );
                        encoded
                    }
                    Coding::Rle => rle::decode(&encoded, layout)?,
                    Coding::Jpeg(name) => jpeg::decode(&encoded, layout, name)?,
                    Coding::Jpeg2000 => jpeg2000::decode(&encoded, layout)?,
                }
            }
        };
        let is_native = matches!(file.syntax.coding, Coding::Native | Coding::Encapsulated);
        if is_native && layout.color == Color::YbrFull422 {
            bytes = samples::rgb_from_422(&bytes);
        } else if is_native && layout.is_planar {
            bytes = samples::interleaved(&bytes, layout.stored().bytes());
        }
        let found_bytes = to_u64(bytes.len());
        if found_bytes != wanted_bytes {
            return Err(Problem::Size {
                format: DICOM,
                wanted_bytes,
                found_bytes,
            });
        }
        // JPEG 2000 and lossy JPEG have turned chroma into colours themselves.
        if layout.color == Color::YbrFull
            && !matches!(file.syntax.coding, Coding::Jpeg(name) if !jpeg::is_lossless(name))
        {
            samples::rgb_from_ybr(&mut bytes);
        }
        samples::clear_unused_bits(&mut bytes, layout);
        Ok(bytes)
    }
}

fn native(file: &PictureFile, stream: &mut dyn Stream, frame: u32) -> Result<Vec<u8>, Problem> {
    let layout = &file.layout;
    let bits = layout.native_frame_bits();
    let first_bit = bits.saturating_mul(frame.into());
    // Frames of single bits follow each other without a gap.
    let shift = first_bit % 8;
    let start = file.place.offset.saturating_add(first_bit / 8);
    let wanted_bytes = bits.saturating_add(shift).div_ceil(8);
    let are_swapped =
        file.syntax.is_big_endian && file.place.are_words && layout.bits_allocated == 8;
    if are_swapped && bits.saturating_mul(frame.into()) % 16 != 0 {
        let what = "frames of an odd number of bytes in big-endian words";
        return Err(unsupported(DICOM, what));
    }
    // The last of an odd number of bytes stands behind the one that pads its word.
    let read_bytes = wanted_bytes.saturating_add(u64::from(are_swapped) & wanted_bytes);
    seek_to(stream, start)?;
    let mut bytes = Vec::new();
    stream
        .take(read_bytes)
        .read_to_end(&mut bytes)
        .map_err(io("reading pixels"))?;
    if to_u64(bytes.len()) != read_bytes {
        let found_bytes = to_u64(bytes.len());
        return Err(Problem::Size {
            format: DICOM,
            wanted_bytes: read_bytes,
            found_bytes,
        });
    }
    if layout.bits_allocated == 1 {
        return Ok(samples::bytes_of_bits(&bytes, shift, layout.pixels()));
    }
    if file.syntax.is_big_endian {
        match layout.bits_allocated {
            8 if file.place.are_words => {
                samples::swap::<2>(&mut bytes);
                bytes.truncate(usize::try_from(wanted_bytes).unwrap_or(usize::MAX));
            }
            8 => {}
            16 => samples::swap::<2>(&mut bytes),
            32 => samples::swap::<4>(&mut bytes),
            _ => samples::swap::<8>(&mut bytes),
        }
    }
    Ok(bytes)
}

/// An encoded frame that cannot be what the header says.
pub(super) fn damaged(encoding: &'static str, cause: impl ToString) -> Problem {
    Problem::Damaged {
        format: DICOM,
        encoding,
        decoded_bytes: 0,
        cause: cause.to_string(),
    }
}

/// Compares what a coded frame says of itself with the header, before anything is decoded.
pub(super) fn same_size(
    encoding: &'static str,
    layout: &Layout,
    [width, height]: [u64; 2],
    samples: usize,
) -> Result<(), Problem> {
    let wanted = [u64::from(layout.columns), u64::from(layout.rows)];
    let wanted_samples = usize::try_from(layout.color.samples()).unwrap_or(usize::MAX);
    if (wanted, wanted_samples) == ([width, height], samples) {
        return Ok(());
    }
    let [columns, rows] = wanted;
    Err(Problem::Invalid {
        format: DICOM,
        field: format!("the {encoding} header"),
        wanted: format!("{columns} x {rows} pixels of {wanted_samples} samples, as the file says"),
        found: format!("{width} x {height} pixels of {samples} samples"),
    })
}
