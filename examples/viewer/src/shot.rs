//! Pictures of what was drawn, on their way to a file.

use crate::error::Error;
use ash::vk;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use stratavox::gpu::{Buffer, Gpu, Memory, texel_bytes};
use stratavox::picture::{ColorSpace, Picture, WriteOptions, write_picture};

/// What a copy was recorded of, and where it will be.
pub struct Screenshot {
    pub path: PathBuf,
    pub buffer: Buffer,
    format: vk::Format,
    extent: [u32; 2],
}

impl Screenshot {
    /// Room for the texels of an image.
    pub fn new(
        gpu: &Arc<Gpu>,
        path: PathBuf,
        format: vk::Format,
        extent: [u32; 2],
    ) -> Result<Self, Error> {
        let texels = u64::from(extent[0]) * u64::from(extent[1]);
        let bytes = texels * u64::from(texel_bytes(format).unwrap_or(16));
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        Ok(Self {
            path,
            buffer: Buffer::new(gpu, bytes, usage, Memory::Readback, "screenshot")?,
            format,
            extent,
        })
    }

    /// Writes the file, when the frame is done.
    pub fn write(&self) -> Result<(), Error> {
        let mut bytes = vec![0; self.buffer.bytes() as usize];
        self.buffer.read(0, &mut bytes)?;
        let float = |texel: &[u8], c: usize| {
            f32::from_le_bytes([
                texel[4 * c],
                texel[4 * c + 1],
                texel[4 * c + 2],
                texel[4 * c + 3],
            ])
        };
        let half = |texel: &[u8], c: usize| {
            half::f16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32()
        };
        let code = |texel: &[u8], c: usize| f32::from(texel[c]) / 255.0;
        let (size, space) = match self.format {
            vk::Format::R32G32B32A32_SFLOAT => (16, ColorSpace::Linear),
            vk::Format::R16G16B16A16_SFLOAT => (8, ColorSpace::Linear),
            _ => (4, ColorSpace::Display),
        };
        let pixel = |texel: &[u8]| match self.format {
            vk::Format::R32G32B32A32_SFLOAT => [0, 1, 2, 3].map(|c| float(texel, c)),
            vk::Format::R16G16B16A16_SFLOAT => [0, 1, 2, 3].map(|c| half(texel, c)),
            // What the window shows is opaque, whatever blending left there.
            vk::Format::B8G8R8A8_UNORM => [code(texel, 2), code(texel, 1), code(texel, 0), 1.0],
            _ => [code(texel, 0), code(texel, 1), code(texel, 2), 1.0],
        };
        let picture = Picture {
            width: self.extent[0],
            height: self.extent[1],
            pixels: bytes.chunks_exact(size).map(pixel).collect(),
            color_space: space,
            layers: Vec::new(),
        };
        let options = WriteOptions {
            force: true,
            ..WriteOptions::default()
        };
        Ok(write_picture(&picture, &self.path, options)?)
    }
}

/// A name that no file has yet: `head.png`, `head-2.png`, ...
pub fn free_name(subject: &str) -> PathBuf {
    let allowed = |c: char| {
        if c.is_alphanumeric() || "-_.".contains(c) {
            c
        } else {
            '-'
        }
    };
    let stem: String = subject.chars().map(allowed).collect();
    let names = (1..).map(|n| match n {
        1 => format!("{stem}.png"),
        n => format!("{stem}-{n}.png"),
    });
    let mut free = names.filter(|name| !Path::new(name).exists());
    free.next().expect("there is always another number").into()
}
