//! Runs of classified voxels, made on the device whenever the function changes, from codes of voxels that stay there.
//!
//! ```text
//! host      of each code whether it is full, and its payload: the law of classification is here alone
//! words     masks, and full voxels before in blocks of words          shaders/run_words.wgsl
//! blocks    full voxels before each block, and all of them            shaders/run_blocks.wgsl
//! payload   of each full voxel that of its code, at its rank          shaders/run_payload.wgsl
//! ```
//!
//! The device moves bits, and computes nothing but places: the bytes are those that the host makes. Numbers of 32 bits have too
//! many codes.

use super::texels::{Texels, WIDTH, bytes_in};
use super::{ClassifiedRuns, MadeBy, PayloadFloats, RunsSize};
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Headless, Memory, ParameterRing, Region,
    Resource, Use, buffer_barrier, buffer_to_buffer,
};
use crate::shaders::{RUN_THREADS, RunBuild, RunBuildFields, shader};
use crate::volume::{RunBits, Volume};
use ash::vk;
use std::sync::Arc;

/// What is staged at once, and the largest part of the payload that is made at once.
const PART_BYTES: u64 = 64 << 20;
/// Of full voxels and of runs.
const SUM_BYTES: u64 = 8;

/// The voxels of a volume, from which runs under one function after another are made.
#[derive(Debug)]
pub struct RunBuilder {
    voxels: Buffer,
    /// Which codes there are among voxels with data.
    occurring: Vec<bool>,
    /// All but what depends on the floats of a payload.
    parameters: RunBuildFields,
    words: ComputePipeline,
    blocks: ComputePipeline,
    payload: ComputePipeline,
    ring: ParameterRing,
}

impl RunBuilder {
    /// Brings the codes of a volume; `None` where it has none, or more than buffers or dispatches of the device allow.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn new(device: &mut Headless, volume: &Volume) -> Result<Option<Self>, Error> {
        let Some(codes) = volume.voxels.codes() else {
            return Ok(None);
        };
        let gpu = Arc::clone(device.gpu());
        let validity = volume.validity.as_deref();
        let valid = validity.map(|valid| RunBits::of_rows(volume.dims, |n| valid[n] != 0));
        let valid: Vec<u32> = valid.map_or(Vec::new(), |bits| {
            bits.words().iter().map(|word| word.mask).collect()
        });
        let [nx, ny, nz] = volume.dims.map(u64::from);
        let word_count = nx.div_ceil(32) * ny * nz;
        let [width, height, _] = words_of(word_count).extent().map(u64::from);
        let texel_count = width * height;
        let block_count = texel_count.div_ceil(RUN_THREADS.into());
        let code_bytes = (codes.as_bytes().len() as u64).next_multiple_of(4);
        let bytes = code_bytes + 4 * valid.len() as u64;
        let list_bytes = SUM_BYTES * (texel_count + block_count + 1);
        let limits = gpu.limits();
        let is_within = bytes.max(list_bytes) <= limits.max_storage_buffer_range.into()
            && block_count <= limits.max_workgroup_count[0].into()
            && nx * ny * nz <= u32::MAX.into();
        if !is_within {
            return Ok(None);
        }
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let voxels = Buffer::new(&gpu, bytes, usage, Memory::Device, "codes of voxels")?;
        upload(device, &voxels, 0, codes.as_bytes())?;
        upload(device, &voxels, code_bytes, bytemuck::cast_slice(&valid))?;
        let mut occurring = vec![false; codes.count()];
        let numbers: Vec<u16> = (0..=u16::MAX).collect();
        for (n, code) in codes.look_up(&numbers).into_iter().enumerate() {
            occurring[usize::from(code)] |= validity.is_none_or(|valid| valid[n] != 0);
        }
        let pipeline = |name| ComputePipeline::new(&gpu, shader(name));
        Ok(Some(Self {
            voxels,
            occurring,
            parameters: RunBuildFields {
                row_length: volume.dims[0],
                words_per_row: volume.dims[0].div_ceil(32),
                word_count: word_count as u32,
                texel_count: texel_count as u32,
                block_count: block_count as u32,
                code_bits: codes.bits(),
                valid_at: match validity {
                    Some(_) => (code_bytes / 4) as u32,
                    None => 0,
                },
                payload_at: (codes.count() / 32) as u32,
                payload_words: 0,
                first_rank: 0,
                rank_count: 0,
                is_last: 0,
            },
            words: pipeline("run_words")?,
            blocks: pipeline("run_blocks")?,
            payload: pipeline("run_payload")?,
            ring: ParameterRing::new(&gpu, size_of::<RunBuild>() as u32, 1, "runs in the making")?,
        }))
    }

    /// The runs of what `materials` say of each code: red, green and blue times depth, and depth. `None` where such floats cannot
    /// hold what some voxel with data is made of.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no images of that size.
    ///
    /// # Panics
    /// Where there is not one material for each code.
    pub fn build(
        &self,
        device: &mut Headless,
        materials: &[[f32; 4]],
        floats: PayloadFloats,
    ) -> Result<Option<ClassifiedRuns>, Error> {
        assert_eq!(materials.len(), self.occurring.len(), "a material a code");
        let mut there = materials.iter().zip(&self.occurring);
        if !there.all(|(material, occurs)| !occurs || floats.hold(*material)) {
            return Ok(None);
        }
        let gpu = Arc::clone(device.gpu());
        let classes = classes(&gpu, materials, floats)?;
        let RunBuildFields {
            texel_count,
            block_count,
            ..
        } = self.parameters;
        let sums = u64::from(texel_count) + u64::from(block_count);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        let bytes = SUM_BYTES * (sums + 1);
        let list = Buffer::new(&gpu, bytes, usage, Memory::Device, "words of runs")?;
        let parameters = RunBuildFields {
            payload_words: (floats.bytes() / 4) as u32,
            ..self.parameters
        };
        let [full, runs] = self.count(device, parameters, [&classes, &list])?;
        let of_payload = Texels {
            format: floats.format(),
            count: full.into(),
            name: "payload of runs",
        };
        let payload = of_payload.empty(&gpu)?;
        let of_words = words_of(parameters.word_count.into());
        let words = of_words.empty(&gpu)?;
        let rows = (PART_BYTES / (floats.bytes() * u64::from(WIDTH))) as u32;
        let largest = of_payload.parts(rows).next();
        let largest = largest.map_or(0, |part| bytes_in(of_payload.format, part));
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let made = Buffer::new(&gpu, largest, usage, Memory::Device, "payloads of runs")?;
        let given = [
            ("run_build", Resource::Uniform(&self.ring)),
            ("run_list", Resource::Storage(&list)),
            ("run_voxels", Resource::Storage(&self.voxels)),
            ("run_classes", Resource::Storage(&classes)),
            ("run_payloads", Resource::Storage(&made)),
        ];
        let bindings = Bindings::new(&gpu, self.payload.layout(), &given)?;
        let groups = [block_count, 1, 1];
        let height = of_payload.extent()[1];
        for part in of_payload.parts(rows) {
            let [width, part_height, _] = part.extent;
            let is_last = part.origin[1] + part_height == height;
            self.tell(RunBuildFields {
                first_rank: part.origin[1] * WIDTH,
                rank_count: width * part_height,
                is_last: is_last.into(),
                ..parameters
            })?;
            device.run(|cmd| {
                // SAFETY: recorded outside rendering; all of it lives until `run` has waited, and nothing else knows the images yet.
                unsafe {
                    gpu.record(|device| {
                        device.cmd_fill_buffer(cmd, made.raw(), 0, vk::WHOLE_SIZE, 0)
                    });
                    buffer_barrier(&gpu, cmd, &made, Use::TransferWrite, Use::ComputeWrite);
                    buffer_barrier(&gpu, cmd, &list, Use::TransferRead, Use::ComputeWrite);
                    self.payload
                        .dispatch(cmd, &bindings, &[self.ring.offset(0)?], groups);
                    buffer_barrier(&gpu, cmd, &made, Use::ComputeWrite, Use::TransferRead);
                    of_payload.copy_rows(&gpu, cmd, &made, &payload, part)?;
                    buffer_barrier(&gpu, cmd, &list, Use::ComputeWrite, Use::TransferRead);
                    if is_last {
                        of_words.copy_rows(&gpu, cmd, &list, &words, Region::whole(&words))?;
                    }
                }
                Ok(())
            })?;
        }
        let size = RunsSize::new(full.into(), runs.into(), [&words, &payload]);
        Ok(Some(ClassifiedRuns {
            words,
            payload,
            size,
            made_by: MadeBy::Device,
        }))
    }

    /// Smallest and largest of the four numbers that voxels with data are made of; 0 where none has any.
    pub(crate) fn ranges(&self, materials: &[[f32; 4]]) -> [[f64; 2]; 4] {
        let there = materials.iter().zip(&self.occurring);
        let there = there.filter_map(|(material, occurs)| occurs.then_some(material));
        let range = |number: usize| {
            let numbers = there.clone().map(|material| f64::from(material[number]));
            let ends = numbers.map(|n| [n, n]);
            ends.reduce(|[low, high], [n, _]| [low.min(n), high.max(n)])
        };
        std::array::from_fn(|number| range(number).unwrap_or_default())
    }

    /// The first two passes: how many voxels are full, and how many runs there are.
    fn count(
        &self,
        device: &mut Headless,
        parameters: RunBuildFields,
        [classes, list]: [&Buffer; 2],
    ) -> Result<[u32; 2], Error> {
        let gpu = Arc::clone(device.gpu());
        self.tell(parameters)?;
        let to = vk::BufferUsageFlags::TRANSFER_DST;
        let all = Buffer::new(&gpu, SUM_BYTES, to, Memory::Readback, "full voxels")?;
        let last = vk::BufferCopy::default()
            .src_offset(list.bytes() - SUM_BYTES)
            .size(SUM_BYTES);
        let [uniform, of_list] = [
            ("run_build", Resource::Uniform(&self.ring)),
            ("run_list", Resource::Storage(list)),
        ];
        let bound = Bindings::new(&gpu, self.blocks.layout(), &[uniform, of_list])?;
        let [uniform, of_list] = [
            ("run_build", Resource::Uniform(&self.ring)),
            ("run_list", Resource::Storage(list)),
        ];
        let given = [
            uniform,
            of_list,
            ("run_voxels", Resource::Storage(&self.voxels)),
            ("run_classes", Resource::Storage(classes)),
        ];
        let of_words = Bindings::new(&gpu, self.words.layout(), &given)?;
        let groups = [parameters.block_count, 1, 1];
        let offset = [self.ring.offset(0)?];
        device.run(|cmd| {
            // SAFETY: recorded outside rendering; all of it lives until `run` has waited; the host has written the classes before,
            // and the voxels are there.
            unsafe {
                self.words.dispatch(cmd, &of_words, &offset, groups);
                buffer_barrier(&gpu, cmd, list, Use::ComputeWrite, Use::ComputeWrite);
                self.blocks.dispatch(cmd, &bound, &offset, [1, 1, 1]);
                buffer_barrier(&gpu, cmd, list, Use::ComputeWrite, Use::TransferRead);
                buffer_to_buffer(&gpu, cmd, list, &all, &[last])?;
                buffer_barrier(&gpu, cmd, &all, Use::TransferWrite, Use::HostRead);
            }
            Ok(())
        })?;
        let mut found = [0_u32; 2];
        all.read(0, bytemuck::bytes_of_mut(&mut found))?;
        Ok(found)
    }

    /// Nothing that is recorded is unfinished: every run waits.
    fn tell(&self, parameters: RunBuildFields) -> Result<(), Error> {
        let parameters = RunBuild::from(parameters);
        self.ring.write(0, bytemuck::bytes_of(&parameters))
    }
}

/// The words of rows.
fn words_of(count: u64) -> Texels {
    Texels {
        format: vk::Format::R32G32_UINT,
        count,
        name: "words of runs",
    }
}

/// Of each code a bit, whether it is full, and then its payload.
fn classes(gpu: &Arc<Gpu>, materials: &[[f32; 4]], floats: PayloadFloats) -> Result<Buffer, Error> {
    let masks = materials.chunks(32).map(|of_word| {
        let bits = (0_u32..).zip(of_word);
        bits.fold(0_u32, |mask, (bit, m)| mask | u32::from(m[3] > 0.0) << bit)
    });
    let masks: Vec<u32> = masks.collect();
    let masks: &[u8] = bytemuck::cast_slice(&masks);
    let payload_bytes = floats.bytes() as usize;
    let bytes = (masks.len() + payload_bytes * materials.len()) as u64;
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let made = Buffer::new(gpu, bytes, storage, Memory::Upload, "classes of codes")?;
    made.write_with(0, bytes, |out| {
        let (bits, payloads) = out.split_at_mut(masks.len());
        bits.copy_from_slice(masks);
        let payloads = payloads.chunks_exact_mut(payload_bytes);
        payloads
            .zip(materials)
            .for_each(|(payload, material)| floats.encode(*material, payload));
    })?;
    Ok(made)
}

/// Brings bytes to a place of a buffer; of the last word what is left is 0.
fn upload(device: &mut Headless, to: &Buffer, at: u64, bytes: &[u8]) -> Result<(), Error> {
    let gpu = Arc::clone(device.gpu());
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let largest = (bytes.len() as u64).next_multiple_of(4).min(PART_BYTES);
    if largest == 0 {
        return Ok(());
    }
    let staging = Buffer::new(&gpu, largest, usage, Memory::Upload, "staged codes")?;
    for (number, part) in (0..).zip(bytes.chunks(PART_BYTES as usize)) {
        let size = (part.len() as u64).next_multiple_of(4);
        staging.write_with(0, size, |out| {
            let (own, rest) = out.split_at_mut(part.len());
            own.copy_from_slice(part);
            rest.fill(0);
        })?;
        let copy = vk::BufferCopy::default()
            .dst_offset(at + number * PART_BYTES)
            .size(size);
        device.run(|cmd| {
            // SAFETY: recorded outside rendering; both live until `run` has waited, and nothing else knows them yet; the host has
            // written before.
            unsafe {
                buffer_to_buffer(&gpu, cmd, &staging, to, &[copy])?;
                buffer_barrier(&gpu, cmd, to, Use::TransferWrite, Use::ComputeRead);
            }
            Ok(())
        })?;
    }
    Ok(())
}
