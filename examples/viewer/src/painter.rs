//! Draws what egui has laid out, and the picture of the volume into its place in the window.
//!
//! The owners of [`stratavox::gpu`] carry it: what is dropped here waits, as theirs does, until no frame uses it.

use crate::error::Error;
use ash::vk;
use egui::epaint::{ClippedPrimitive, ImageDelta, Primitive, Vertex};
use egui::{ImageData, Rect, TextureId, TexturesDelta};
use std::collections::HashMap;
use std::sync::Arc;
use stratavox::gpu::{
    Bindings, Blend, Buffer, DepthUse, Gpu, Image, ImageDesc, ImageKind, Memory, RasterDesc,
    RasterPipeline, Region, Resource, Sampler, Use, buffer_to_image, image_barrier,
};
use stratavox::shaders::{BindingKind, BindingSlot, Code, Shader, Stage};

const CORNERS: BindingSlot = slot("corners", 0, BindingKind::Storage);
const IMAGE: BindingSlot = slot("image", 1, BindingKind::Texture);
const SMOOTH: BindingSlot = slot("smooth_sampler", 2, BindingKind::Sampler);

/// Corners that there is room for at first; more make a larger buffer.
const FIRST_CORNERS: u64 = 1 << 14;

pub struct Painter {
    gpu: Arc<Gpu>,
    panel: RasterPipeline,
    picture: RasterPipeline,
    smooth: Sampler,
    nearest: Sampler,
    textures: HashMap<TextureId, Image>,
    /// Freed by egui in a frame that still draws them.
    freed: Vec<TextureId>,
    frames: Vec<Corners>,
    meshes: Vec<Mesh>,
}

/// What one frame in flight has to itself.
struct Corners {
    buffer: Buffer,
    /// Of each texture that was drawn.
    bindings: HashMap<TextureId, Bindings>,
}

/// Corners of one texture and one clip rectangle, in pixels.
struct Mesh {
    texture: TextureId,
    clip: vk::Rect2D,
    first: u32,
    count: u32,
}

/// A corner of a triangle as `panel.wgsl` has it.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Corner {
    place: [f32; 2],
    uv: [f32; 2],
    color: [u8; 4],
    /// The stride of a WGSL struct is a multiple of its largest alignment, 8.
    padding: u32,
}

impl Painter {
    /// For a window of this format.
    pub fn new(gpu: &Arc<Gpu>, format: vk::Format, frames_in_flight: u32) -> Result<Self, Error> {
        let pipeline =
            |name, words: [&'static [u32]; 2], slots: [&'static [BindingSlot]; 2], blend| {
                let [vertex, fragment] =
                    [(Stage::Vertex, 0), (Stage::Fragment, 1)].map(|(stage, k)| Shader {
                        name,
                        stage,
                        code: Code::Words(words[k]),
                        constants: &[],
                        bindings: slots[k],
                    });
                RasterPipeline::new(
                    gpu,
                    &RasterDesc {
                        vertex: &vertex,
                        fragment: &fragment,
                        target: format.into(),
                        blend,
                        depth: DepthUse::Ignored,
                    },
                )
            };
        let panel = [
            words(include_bytes!(concat!(
                env!("OUT_DIR"),
                "/panel.vertex.spv"
            ))),
            words(include_bytes!(concat!(
                env!("OUT_DIR"),
                "/panel.fragment.spv"
            ))),
        ];
        let picture = [
            words(include_bytes!(concat!(
                env!("OUT_DIR"),
                "/picture.vertex.spv"
            ))),
            words(include_bytes!(concat!(
                env!("OUT_DIR"),
                "/picture.fragment.spv"
            ))),
        ];
        let corners = |_| {
            Ok(Corners {
                buffer: corner_buffer(gpu, FIRST_CORNERS)?,
                bindings: HashMap::new(),
            })
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            panel: pipeline("panel", panel, [&[CORNERS], &[IMAGE, SMOOTH]], Blend::Over)?,
            picture: pipeline("picture", picture, [&[], &[IMAGE, SMOOTH]], Blend::Replace)?,
            smooth: Sampler::linear_clamp(gpu)?,
            nearest: Sampler::nearest_clamp(gpu)?,
            textures: HashMap::new(),
            freed: Vec::new(),
            frames: (0..frames_in_flight)
                .map(corners)
                .collect::<Result<_, Error>>()?,
            meshes: Vec::new(),
        })
    }

    /// What [`Painter::draw_picture`] draws: `image` is in [`Use::FragmentSampled`] then.
    pub fn bind_picture(&self, image: &Image) -> Result<Bindings, Error> {
        let sampler = match self.gpu.format_features(image.format()).linear {
            true => &self.smooth,
            false => &self.nearest,
        };
        let resources = [
            (IMAGE.name, Resource::sampled(image)),
            (SMOOTH.name, Resource::Sampler(sampler)),
        ];
        Ok(Bindings::new(&self.gpu, self.picture.layout(), &resources)?)
    }

    /// Takes over what egui has laid out: new textures are recorded, corners written.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering, and nothing unfinished was prepared for this frame in flight.
    pub unsafe fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: u32,
        mut textures: TexturesDelta,
        primitives: &[ClippedPrimitive],
        pixels_per_point: f32,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        for id in std::mem::take(&mut self.freed) {
            self.textures.remove(&id);
            self.forget(id);
        }
        for (id, deltas) in textures.set.drain() {
            for delta in deltas {
                // SAFETY: the caller's promise.
                unsafe { self.set_texture(cmd, id, &delta)? };
            }
        }
        self.freed.extend(textures.free.drain());
        self.lay_out(frame, primitives, pixels_per_point, extent)
    }

    /// Draws a picture into the viewport.
    ///
    /// # Safety
    /// `cmd` is recording inside rendering to the window, viewport and scissor set.
    pub unsafe fn draw_picture(&self, cmd: vk::CommandBuffer, picture: &Bindings) {
        // SAFETY: the caller's promise; bindings wait, dropped, for the frame.
        unsafe { self.picture.draw(cmd, picture, &[], 3, 0..1) };
    }

    /// Draws what was prepared. Viewport and scissor are ours afterwards.
    ///
    /// # Safety
    /// `cmd` is recording inside rendering to the window.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, frame: u32, extent: [u32; 2]) {
        let bindings = &self.frames[frame as usize].bindings;
        // SAFETY: the caller's promise; the corners of a mesh are in the buffer.
        unsafe {
            stratavox::gpu::set_area(&self.gpu, cmd, extent);
            for mesh in &self.meshes {
                let Some(bindings) = bindings.get(&mesh.texture) else {
                    continue;
                };
                self.gpu.device().cmd_set_scissor(cmd, 0, &[mesh.clip]);
                // The instance number says where the mesh begins.
                let first = mesh.first..mesh.first + 1;
                self.panel.draw(cmd, bindings, &[], mesh.count, first);
            }
        }
    }

    fn forget(&mut self, id: TextureId) {
        for frame in &mut self.frames {
            frame.bindings.remove(&id);
        }
    }

    /// # Safety
    /// As [`Painter::prepare`].
    unsafe fn set_texture(
        &mut self,
        cmd: vk::CommandBuffer,
        id: TextureId,
        delta: &ImageDelta,
    ) -> Result<(), Error> {
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|n| n as u32);
        let bytes: &[u8] = bytemuck::cast_slice(&image.pixels);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(
            &self.gpu,
            bytes.len() as u64,
            usage,
            Memory::Upload,
            "glyphs",
        )?;
        staging.write(0, bytes)?;
        let [x, y] = delta.pos.unwrap_or_default().map(|n| n as u32);
        let mut before = Use::FragmentSampled;
        if delta.pos.is_none() {
            let desc = ImageDesc {
                kind: ImageKind::D2,
                extent: [width, height, 1],
                format: vk::Format::R8G8B8A8_UNORM,
                usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
                name: "texture of the panel",
            };
            self.textures.insert(id, Image::new(&self.gpu, &desc)?);
            self.forget(id);
            before = Use::Nothing;
        }
        let Some(texture) = self.textures.get(&id) else {
            return Ok(());
        };
        let region = Region {
            origin: [x, y, 0],
            extent: [width, height, 1],
        };
        // SAFETY: the caller's promise. The frames before may still read what is about to be overwritten, so a write of
        // a part waits for their fragment shaders; those of this frame wait for the write. A new image has nothing
        // to keep. The staging buffer waits, dropped, for the frame.
        unsafe {
            image_barrier(&self.gpu, cmd, texture, before, Use::TransferWrite);
            buffer_to_image(&self.gpu, cmd, &staging, 0, texture, region)?;
            let (written, read) = (Use::TransferWrite, Use::FragmentSampled);
            image_barrier(&self.gpu, cmd, texture, written, read);
        }
        Ok(())
    }

    /// Corners into the buffer of the frame, triangle by triangle, and what of them is drawn with which texture.
    fn lay_out(
        &mut self,
        frame: u32,
        primitives: &[ClippedPrimitive],
        pixels_per_point: f32,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        self.meshes.clear();
        let mut corners: Vec<Corner> = Vec::new();
        let clip_from_point = extent.map(|n| 2.0 * pixels_per_point / n as f32);
        for ClippedPrimitive {
            clip_rect,
            primitive,
        } in primitives
        {
            let Primitive::Mesh(mesh) = primitive else {
                continue;
            };
            let first = corners.len() as u32;
            let corner = |index: &u32| {
                let Vertex { pos, uv, color } = mesh.vertices[*index as usize];
                Corner {
                    place: [
                        pos.x * clip_from_point[0] - 1.0,
                        pos.y * clip_from_point[1] - 1.0,
                    ],
                    uv: [uv.x, uv.y],
                    color: color.to_array(),
                    padding: 0,
                }
            };
            corners.extend(mesh.indices.iter().map(corner));
            self.meshes.push(Mesh {
                texture: mesh.texture_id,
                clip: pixels(*clip_rect, pixels_per_point, extent),
                first,
                count: mesh.indices.len() as u32,
            });
        }
        let frame = &mut self.frames[frame as usize];
        let bytes: &[u8] = bytemuck::cast_slice(&corners);
        if bytes.len() as u64 > frame.buffer.bytes() {
            frame.buffer = corner_buffer(&self.gpu, (corners.len() as u64).next_power_of_two())?;
            frame.bindings.clear();
        }
        frame.buffer.write(0, bytes)?;
        for mesh in &self.meshes {
            let texture = self.textures.get(&mesh.texture);
            if let (Some(texture), false) = (texture, frame.bindings.contains_key(&mesh.texture)) {
                let resources = [
                    (CORNERS.name, Resource::Storage(&frame.buffer)),
                    (IMAGE.name, Resource::sampled(texture)),
                    (SMOOTH.name, Resource::Sampler(&self.smooth)),
                ];
                let made = Bindings::new(&self.gpu, self.panel.layout(), &resources)?;
                frame.bindings.insert(mesh.texture, made);
            }
        }
        Ok(())
    }
}

const fn slot(name: &'static str, binding: u32, kind: BindingKind) -> BindingSlot {
    BindingSlot {
        name,
        binding,
        kind,
    }
}

fn corner_buffer(gpu: &Arc<Gpu>, corners: u64) -> Result<Buffer, Error> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let bytes = corners * size_of::<Corner>() as u64;
    Ok(Buffer::new(gpu, bytes, usage, Memory::Upload, "corners")?)
}

/// A rectangle of points in whole pixels, inside the window.
pub fn pixels(rect: Rect, pixels_per_point: f32, extent: [u32; 2]) -> vk::Rect2D {
    let side =
        |points: f32, most: u32| ((points * pixels_per_point).round().max(0.0) as u32).min(most);
    let [left, right] = [rect.left(), rect.right()].map(|x| side(x, extent[0]));
    let [top, bottom] = [rect.top(), rect.bottom()].map(|y| side(y, extent[1]));
    vk::Rect2D {
        offset: vk::Offset2D {
            x: left as i32,
            y: top as i32,
        },
        extent: vk::Extent2D {
            width: right.saturating_sub(left),
            height: bottom.saturating_sub(top),
        },
    }
}

/// SPIR-V lives as long as the program.
pub fn words(bytes: &'static [u8]) -> &'static [u32] {
    let words = bytes
        .chunks_exact(4)
        .map(|word| u32::from_ne_bytes([word[0], word[1], word[2], word[3]]));
    words.collect::<Vec<_>>().leak()
}
