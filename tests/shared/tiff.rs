//! TIFFs by hand, right and wrong ones: little-endian, classic.
#![allow(dead_code, reason = "each test uses a part of it")]

/// The value of an entry.
#[derive(Clone, Debug)]
pub enum Value {
    Short(u16),
    Long(u32),
    Longs(Vec<u32>),
    Bytes(Vec<u8>),
}

use Value::{Bytes, Long, Longs, Short};

/// Entries of one page, by tag, and the bytes of its one strip.
#[derive(Clone, Debug)]
pub struct Page {
    pub entries: Vec<(u16, Value)>,
    pub strip: Vec<u8>,
}

impl Page {
    /// Gray bytes, uncompressed.
    pub fn gray(width: u32, height: u32, strip: Vec<u8>) -> Self {
        Self {
            entries: vec![
                (256, Long(width)),
                (257, Long(height)),
                (258, Short(8)),
                (259, Short(1)),
                (262, Short(1)),
                (277, Short(1)),
                (278, Long(height)),
                (279, Long(strip.len() as u32)),
            ],
            strip,
        }
    }

    /// With another value, or one more.
    pub fn with(mut self, tag: u16, value: Value) -> Self {
        self.entries.retain(|(other, _)| *other != tag);
        self.entries.push((tag, value));
        self
    }

    pub fn without(mut self, tag: u16) -> Self {
        self.entries.retain(|(other, _)| *other != tag);
        self
    }

    pub fn described(self, text: &str) -> Self {
        let mut bytes = text.as_bytes().to_vec();
        bytes.push(0);
        self.with(270, Bytes(bytes))
    }
}

/// Pages one after the other. `loops_to` is the page that the last one's link leads to.
pub fn file(pages: &[Page], loops_to: Option<usize>) -> Vec<u8> {
    let mut bytes = b"II\x2a\0\0\0\0\0".to_vec();
    let mut link = 4;
    let mut starts = Vec::new();
    for page in pages {
        let strip_at = bytes.len() as u32;
        bytes.extend(&page.strip);
        let mut entries = page.entries.clone();
        if !entries.iter().any(|(tag, _)| matches!(tag, 273 | 324)) {
            entries.push((273, Long(strip_at)));
        }
        entries.sort_by_key(|(tag, _)| *tag);
        let places: Vec<[u8; 12]> = entries
            .iter()
            .map(|(tag, value)| entry(*tag, value, &mut bytes))
            .collect();
        let start = bytes.len() as u32;
        starts.push(start);
        bytes[link..link + 4].copy_from_slice(&start.to_le_bytes());
        bytes.extend((places.len() as u16).to_le_bytes());
        bytes.extend(places.concat());
        link = bytes.len();
        bytes.extend([0; 4]);
    }
    if let Some(page) = loops_to {
        bytes[link..link + 4].copy_from_slice(&starts[page].to_le_bytes());
    }
    bytes
}

fn entry(tag: u16, value: &Value, bytes: &mut Vec<u8>) -> [u8; 12] {
    let (kind, count, data) = match value {
        Short(n) => (3_u16, 1, n.to_le_bytes().to_vec()),
        Long(n) => (4, 1, n.to_le_bytes().to_vec()),
        Longs(all) => (
            4,
            all.len(),
            all.iter().flat_map(|n| n.to_le_bytes()).collect(),
        ),
        Bytes(all) => (2, all.len(), all.clone()),
    };
    let mut entry = [0; 12];
    entry[..2].copy_from_slice(&tag.to_le_bytes());
    entry[2..4].copy_from_slice(&kind.to_le_bytes());
    entry[4..8].copy_from_slice(&(count as u32).to_le_bytes());
    if data.len() <= 4 {
        entry[8..8 + data.len()].copy_from_slice(&data);
    } else {
        entry[8..].copy_from_slice(&(bytes.len() as u32).to_le_bytes());
        bytes.extend(data);
    }
    entry
}
