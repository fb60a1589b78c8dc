//! Transfer syntaxes: how a data set and its pixels are written, by DICOM PS3.5 section 10 and annex A of PS3.6.

use super::DICOM;
use crate::format::problem::{escape, unsupported};
use crate::volume::Problem;

/// How a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Syntax {
    /// Each element names the type of its value.
    pub is_explicit: bool,
    pub is_big_endian: bool,
    /// The data set is one deflate stream without a zlib header.
    pub is_deflated: bool,
    pub coding: Coding,
}

/// How pixels are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coding {
    /// As they are, one after the other.
    Native,
    /// As they are, each frame in a fragment.
    Encapsulated,
    Rle,
    /// JPEG of the name: baseline, extended, lossless.
    Jpeg(&'static str),
    Jpeg2000,
}

impl Coding {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Native | Self::Encapsulated => "native",
            Self::Rle => "RLE Lossless",
            Self::Jpeg(name) => name,
            Self::Jpeg2000 => "JPEG 2000",
        }
    }
}

impl Syntax {
    pub(super) const IMPLICIT: Self = Self {
        is_explicit: false,
        ..Self::EXPLICIT
    };
    pub(super) const EXPLICIT: Self = Self {
        is_explicit: true,
        is_big_endian: false,
        is_deflated: false,
        coding: Coding::Native,
    };

    /// The syntax of a UID, or an error that names the one that we do not read.
    pub(super) fn of(uid: &str) -> Result<Self, Problem> {
        let coded = |coding| {
            Ok(Self {
                coding,
                ..Self::EXPLICIT
            })
        };
        let short = uid.strip_prefix("1.2.840.10008.1.2").unwrap_or("?");
        match short {
            "" => Ok(Self::IMPLICIT),
            ".1" => Ok(Self::EXPLICIT),
            ".1.98" => coded(Coding::Encapsulated),
            ".1.99" => Ok(Self {
                is_deflated: true,
                ..Self::EXPLICIT
            }),
            ".2" => Ok(Self {
                is_big_endian: true,
                ..Self::EXPLICIT
            }),
            ".5" => coded(Coding::Rle),
            ".4.50" => coded(Coding::Jpeg("JPEG Baseline (Process 1)")),
            ".4.51" => coded(Coding::Jpeg("JPEG Extended (Process 2 and 4)")),
            ".4.57" => coded(Coding::Jpeg("JPEG Lossless (Process 14)")),
            ".4.70" => coded(Coding::Jpeg(
                "JPEG Lossless (Process 14, Selection Value 1)",
            )),
            ".4.90" | ".4.91" => coded(Coding::Jpeg2000),
            _ => {
                let name = unread(short).unwrap_or("a transfer syntax that we do not know");
                let what = format!("{name} (transfer syntax {})", escape(uid));
                Err(unsupported(DICOM, what))
            }
        }
    }
}

/// The name of a transfer syntax that we know of and do not read.
fn unread(short: &str) -> Option<&'static str> {
    Some(match short {
        ".4.52" | ".4.53" | ".4.54" | ".4.55" | ".4.56" | ".4.58" | ".4.59" | ".4.60" | ".4.61"
        | ".4.62" | ".4.63" | ".4.64" | ".4.65" | ".4.66" => "a retired JPEG process",
        ".4.80" => "JPEG-LS Lossless",
        ".4.81" => "JPEG-LS Lossy (Near-Lossless)",
        ".4.92" | ".4.93" => "JPEG 2000 Part 2 Multi-component",
        ".4.94" | ".4.95" => "JPIP Referenced",
        ".4.100" | ".4.100.1" | ".4.101" | ".4.101.1" => "MPEG2",
        ".4.102" | ".4.102.1" | ".4.103" | ".4.103.1" | ".4.104" | ".4.104.1" | ".4.105"
        | ".4.105.1" | ".4.106" | ".4.106.1" => "MPEG-4 AVC/H.264",
        ".4.107" | ".4.108" => "HEVC/H.265",
        ".4.110" => "JPEG XL Lossless",
        ".4.111" => "JPEG XL JPEG Recompression",
        ".4.112" => "JPEG XL",
        ".4.201" | ".4.202" | ".4.203" => "High-Throughput JPEG 2000",
        ".4.204" | ".4.205" => "JPIP HTJ2K Referenced",
        ".7.1" | ".7.2" | ".7.3" => "SMPTE ST 2110 video",
        ".8.1" => "Deflated Image Frame Compression",
        _ => return None,
    })
}
