//! A DICOM file, element by element, explicit and little-endian, so that a test can make each of them wrong.
#![allow(dead_code, reason = "each test uses a part of it")]

use crate::files::{Folder, message, numbers};
use glam::DVec3;
use std::collections::BTreeMap;
use stratavox::format;
use stratavox::volume::{Header, Limits, Source, TimeComponent, VolumeSelection};

pub const COLUMNS: usize = 6;
pub const ROWS: usize = 4;

#[derive(Clone)]
pub struct Dicom {
    pub syntax: String,
    elements: BTreeMap<u32, ([u8; 2], Vec<u8>)>,
}

/// The stored number of a pixel of the slice `k`.
pub fn number(k: usize, x: usize, y: usize) -> i16 {
    (k * 1000 + y * 10 + x) as i16 - 500
}

impl Dicom {
    /// A signed MR slice of 6 x 4 pixels at `position`, rows to the left, columns to the back.
    pub fn slice(k: usize, position: [f64; 3]) -> Self {
        let mut file = Self {
            syntax: "1.2.840.10008.1.2.1".to_owned(),
            elements: BTreeMap::new(),
        };
        let numbers = (0..ROWS).flat_map(|y| (0..COLUMNS).map(move |x| number(k, x, y)));
        file.text(0x0008_0016, b"UI", "1.2.840.10008.5.1.4.1.1.4")
            .text(0x0008_0018, b"UI", &format!("1.2.3.{k}"))
            .text(0x0008_0060, b"CS", "MR")
            .text(0x0020_000e, b"UI", "1.2.3")
            .text(0x0020_0013, b"IS", &format!("{}", 100 - k))
            .text(0x0020_0032, b"DS", &words(&position))
            .text(0x0020_0037, b"DS", "1\\0\\0\\0\\1\\0")
            .u16(0x0028_0002, 1)
            .text(0x0028_0004, b"CS", "MONOCHROME2")
            .u16(0x0028_0010, ROWS as u16)
            .u16(0x0028_0011, COLUMNS as u16)
            .text(0x0028_0030, b"DS", "2\\1.5")
            .u16(0x0028_0100, 16)
            .u16(0x0028_0101, 16)
            .u16(0x0028_0102, 15)
            .u16(0x0028_0103, 1)
            .put(
                0x7fe0_0010,
                b"OW",
                numbers.flat_map(i16::to_le_bytes).collect(),
            );
        file
    }

    pub fn put(&mut self, tag: u32, kind: &[u8; 2], value: Vec<u8>) -> &mut Self {
        self.elements.insert(tag, (*kind, value));
        self
    }

    pub fn text(&mut self, tag: u32, kind: &[u8; 2], text: &str) -> &mut Self {
        let mut value = text.as_bytes().to_vec();
        if value.len() % 2 == 1 {
            value.push(if kind == b"UI" { 0 } else { b' ' });
        }
        self.put(tag, kind, value)
    }

    pub fn u16(&mut self, tag: u32, number: u16) -> &mut Self {
        self.put(tag, b"US", number.to_le_bytes().to_vec())
    }

    pub fn without(&mut self, tag: u32) -> &mut Self {
        self.elements.remove(&tag);
        self
    }

    pub fn tags(&self) -> Vec<u32> {
        self.elements.keys().copied().collect()
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut file = vec![0; 128];
        file.extend(b"DICM");
        let mut meta = Self {
            syntax: String::new(),
            elements: BTreeMap::new(),
        };
        meta.text(0x0002_0010, b"UI", &self.syntax);
        for (tag, (kind, value)) in meta.elements.iter().chain(&self.elements) {
            file.extend(((tag >> 16) as u16).to_le_bytes());
            file.extend((*tag as u16).to_le_bytes());
            file.extend(kind);
            match kind {
                b"OW" | b"OB" | b"SQ" | b"UN" => {
                    file.extend([0, 0]);
                    file.extend((value.len() as u32).to_le_bytes());
                }
                _ => file.extend((value.len() as u16).to_le_bytes()),
            }
            file.extend(value);
        }
        file
    }
}

/// Numbers as DICOM words them.
pub fn words(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
    words.join("\\")
}

pub fn open(folder: &Folder) -> Result<Box<dyn Source>, String> {
    let path = folder.path("");
    format::open(&path, &VolumeSelection::default(), &Limits::default()).map_err(|e| message(&e))
}

/// The numbers of one time, x fastest.
pub fn read(source: &dyn Source, time: u32) -> Vec<f32> {
    let piece = source.read(
        TimeComponent { time, component: 0 },
        source.header().whole(),
    );
    numbers(&piece.unwrap().voxels)
}

pub fn slice_numbers(k: usize) -> Vec<f32> {
    let all = (0..ROWS).flat_map(|y| (0..COLUMNS).map(move |x| number(k, x, y)));
    all.map(f32::from).collect()
}

pub fn center(header: &Header, index: [f64; 3]) -> DVec3 {
    header
        .world_from_voxel
        .transform_point3(DVec3::from_array(index) + 0.5)
}

pub fn is_noted(header: &Header, part: &str) -> bool {
    header.notes.iter().any(|note| note.contains(part))
}

/// Slices `k` at height `2.5 k`, each changed; written under names that say nothing.
pub fn series(count: usize, change: impl Fn(usize, &mut Dicom)) -> Folder {
    let folder = Folder::new();
    for k in 0..count {
        let mut slice = Dicom::slice(k, [-10.0, 20.0, 2.5 * k as f64]);
        change(k, &mut slice);
        folder.write(&format!("{}.dcm", k * 7 % 13), slice.bytes());
    }
    folder
}
