//! The tiny writer of the tests: numbers to bytes of a type, bytes to an encoding.
#![allow(dead_code, reason = "each test uses a part of it")]

use std::io::Write;
use stratavox::volume::VoxelType;

/// Whole numbers that every type can hold as they are given: the writer of the tests.
pub fn bytes_of(values: &[i128], stored: VoxelType, big_endian: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    for &value in values {
        let mut number = match stored {
            VoxelType::U8 => (value as u8).to_le_bytes().to_vec(),
            VoxelType::I8 => (value as i8).to_le_bytes().to_vec(),
            VoxelType::U16 => (value as u16).to_le_bytes().to_vec(),
            VoxelType::I16 => (value as i16).to_le_bytes().to_vec(),
            VoxelType::U32 => (value as u32).to_le_bytes().to_vec(),
            VoxelType::I32 => (value as i32).to_le_bytes().to_vec(),
            VoxelType::U64 => (value as u64).to_le_bytes().to_vec(),
            VoxelType::I64 => (value as i64).to_le_bytes().to_vec(),
            VoxelType::F16 => half::f16::from_f64(value as f64).to_le_bytes().to_vec(),
            VoxelType::F32 => (value as f32).to_le_bytes().to_vec(),
            VoxelType::F64 => (value as f64).to_le_bytes().to_vec(),
        };
        if big_endian {
            number.reverse();
        }
        bytes.extend(number);
    }
    bytes
}

/// The smallest and the largest number of a type, and some between; a float gets those of i16.
pub fn extremes(stored: VoxelType) -> Vec<i128> {
    let (low, high): (i128, i128) = match stored {
        VoxelType::U8 => (0, u8::MAX.into()),
        VoxelType::I8 => (i8::MIN.into(), i8::MAX.into()),
        VoxelType::U16 => (0, u16::MAX.into()),
        VoxelType::U32 => (0, u32::MAX.into()),
        VoxelType::I32 => (i32::MIN.into(), i32::MAX.into()),
        VoxelType::U64 => (0, u64::MAX.into()),
        VoxelType::I64 => (i64::MIN.into(), i64::MAX.into()),
        VoxelType::F16 => (-2048, 2048),
        VoxelType::I16 | VoxelType::F32 | VoxelType::F64 => (i16::MIN.into(), i16::MAX.into()),
    };
    vec![low, high, 0, 1, low + 1, high - 1]
}

pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub fn bzip2(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub fn hex(bytes: &[u8]) -> Vec<u8> {
    let lines = bytes.chunks(30).map(|line| {
        let digits: String = line.iter().map(|byte| format!("{byte:02x}")).collect();
        digits + "\n"
    });
    lines.collect::<String>().into_bytes()
}

pub fn ascii(values: &[i128]) -> Vec<u8> {
    let lines = values.chunks(7).map(|line| {
        let words: Vec<String> = line.iter().map(i128::to_string).collect();
        words.join(" ") + "\n"
    });
    lines.collect::<String>().into_bytes()
}
