//! Numbers to a device, through one dispatch or one draw, and back.

use crate::conformance::case::Stop;
use crate::conformance::test_bed::TestBed;
use crate::gpu::{
    Bindings, Blend, Buffer, ComputePipeline, DepthUse, Gpu, Headless, Image, ImageDesc, ImageKind,
    Load, Memory, RasterDesc, RasterPipeline, Region, Resource, Use, begin_rendering,
    buffer_barrier, buffer_to_image, end_rendering, image_barrier, image_to_buffer, set_area,
};
use crate::shaders::shader;
use ash::vk;
use bytemuck::Pod;
use std::sync::Arc;

/// A storage buffer that holds `numbers`.
pub fn buffer<T: Pod>(gpu: &Arc<Gpu>, numbers: &[T], name: &str) -> Result<Buffer, Stop> {
    let bytes: &[u8] = bytemuck::cast_slice(numbers);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let made = Buffer::new(gpu, bytes.len() as u64, usage, Memory::Upload, name)?;
    made.write(0, bytes)?;
    Ok(made)
}

/// A storage buffer of `count` zeros that comes back to the host.
pub fn zeros<T: Pod>(gpu: &Arc<Gpu>, count: usize, name: &str) -> Result<Buffer, Stop> {
    let bytes = (count * size_of::<T>()) as u64;
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let made = Buffer::new(gpu, bytes, usage, Memory::Readback, name)?;
    made.write_with(0, bytes, |bytes| bytes.fill(0))?;
    Ok(made)
}

/// What a buffer holds.
pub fn read<T: Pod>(buffer: &Buffer) -> Result<Vec<T>, Stop> {
    let mut numbers = vec![T::zeroed(); buffer.bytes() as usize / size_of::<T>()];
    buffer.read(0, bytemuck::cast_slice_mut(&mut numbers))?;
    Ok(numbers)
}

/// An image that holds `texels`, x fastest, in [`Use::Sampled`].
pub fn image(
    device: &mut Headless,
    kind: ImageKind,
    extent: [u32; 3],
    format: vk::Format,
    texels: &[u8],
) -> Result<Image, Stop> {
    let gpu = Arc::clone(device.gpu());
    let sampled = vk::ImageUsageFlags::SAMPLED;
    let usage = sampled | vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC;
    let made = Image::new(
        &gpu,
        &ImageDesc {
            kind,
            extent,
            format,
            usage,
            name: "probed",
        },
    )?;
    let from = vk::BufferUsageFlags::TRANSFER_SRC;
    let bytes = texels.len().next_multiple_of(4) as u64;
    let staging = Buffer::new(&gpu, bytes, from, Memory::Upload, "staging")?;
    staging.write(0, texels)?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering, with barriers between; `run` waits, and both live meanwhile.
        unsafe {
            image_barrier(&gpu, cmd, &made, Use::Nothing, Use::TransferWrite);
            buffer_to_image(&gpu, cmd, &staging, 0, &made, Region::whole(&made))?;
            image_barrier(&gpu, cmd, &made, Use::TransferWrite, Use::Sampled);
        }
        Ok(())
    })?;
    Ok(made)
}

/// The texels of an image that is in the use `before`.
pub fn texels(device: &mut Headless, image: &Image, before: Use) -> Result<Vec<u8>, Stop> {
    let gpu = Arc::clone(device.gpu());
    let region = Region::whole(image);
    let bytes = region.bytes(image.format());
    let bytes = bytes.ok_or_else(|| Stop::Suite("a format of unknown size".into()))?;
    let to = vk::BufferUsageFlags::TRANSFER_DST;
    let back = Buffer::new(
        &gpu,
        bytes.next_multiple_of(4),
        to,
        Memory::Readback,
        "readback",
    )?;
    device.run(|cmd| {
        // SAFETY: as above.
        unsafe {
            image_barrier(&gpu, cmd, image, before, Use::TransferRead);
            image_to_buffer(&gpu, cmd, image, region, &back, 0)
        }
    })?;
    let mut texels = read(&back)?;
    texels.truncate(bytes as usize);
    Ok(texels)
}

/// One dispatch.
pub fn compute(
    device: &mut Headless,
    name: &str,
    given: &[(&str, Resource<'_>)],
    groups: [u32; 3],
) -> Result<(), Stop> {
    let gpu = Arc::clone(device.gpu());
    let pipeline = ComputePipeline::new(&gpu, shader(name))?;
    let bindings = Bindings::new(&gpu, pipeline.layout(), given)?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; images were left in the uses that their resources say; `run` waits, and
        // all that is bound lives meanwhile.
        unsafe { pipeline.dispatch(cmd, &bindings, &[], groups) };
        Ok(())
    })?;
    Ok(())
}

/// Several dispatches of one shader, each with bindings of its own, in order: a barrier between each two.
pub fn chain(
    device: &mut Headless,
    name: &str,
    given: &[Vec<(&str, Resource<'_>)>],
    written: &[&Buffer],
    groups: [u32; 3],
) -> Result<(), Stop> {
    let gpu = Arc::clone(device.gpu());
    let pipeline = ComputePipeline::new(&gpu, shader(name))?;
    let bindings = given
        .iter()
        .map(|given| Bindings::new(&gpu, pipeline.layout(), given));
    let bindings: Vec<_> = bindings.collect::<Result<_, _>>()?;
    device.run(|cmd| {
        for bindings in &bindings {
            // SAFETY: as above.
            unsafe {
                pipeline.dispatch(cmd, bindings, &[], groups);
                for buffer in written {
                    buffer_barrier(&gpu, cmd, buffer, Use::ComputeWrite, Use::ComputeWrite);
                }
            }
        }
        Ok(())
    })?;
    Ok(())
}

/// Triangles to draw into a target of one colour.
pub struct Drawing<'a> {
    pub format: vk::Format,
    pub extent: [u32; 2],
    pub clear: [f32; 4],
    pub blend: Blend,
    /// Three a triangle, in normalized device coordinates.
    pub corners: &'a [[f32; 4]],
    /// Triangle i of instance k has number i + k.
    pub colors: &'a [[f32; 4]],
    pub instances: u32,
}

/// Draws in one call and gives the target's texels.
pub fn draw(bed: &mut TestBed, drawing: &Drawing<'_>) -> Result<Vec<u8>, Stop> {
    let given = [("corners", drawing.corners), ("colors", drawing.colors)];
    render(bed, ["probe/shapes", "probe/color"], drawing, &given)
}

/// The same with shaders of the caller's and what they read; the first is what vertices are counted by.
pub fn draw_with(
    bed: &mut TestBed,
    shaders: [&str; 2],
    format: vk::Format,
    extent: [u32; 2],
    given: &[(&str, &[[f32; 4]])],
) -> Result<Vec<u8>, Stop> {
    let drawing = Drawing {
        format,
        extent,
        clear: [0.0; 4],
        blend: Blend::Replace,
        corners: given[0].1,
        colors: &[],
        instances: 1,
    };
    render(bed, shaders, &drawing, given)
}

fn render(
    bed: &mut TestBed,
    [vertex, fragment]: [&str; 2],
    drawing: &Drawing<'_>,
    given: &[(&str, &[[f32; 4]])],
) -> Result<Vec<u8>, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let buffers = given
        .iter()
        .map(|(name, numbers)| Ok((*name, buffer(&gpu, numbers, name)?)));
    let buffers: Vec<_> = buffers.collect::<Result<_, Stop>>()?;
    let target = target(&gpu, drawing.format, drawing.extent)?;
    let pipeline = RasterPipeline::new(
        &gpu,
        &RasterDesc {
            vertex: shader(vertex),
            fragment: shader(fragment),
            target: drawing.format.into(),
            blend: drawing.blend,
            depth: DepthUse::Ignored,
        },
    )?;
    let resources = buffers
        .iter()
        .map(|(name, b)| (*name, Resource::Storage(b)));
    let resources: Vec<_> = resources.collect();
    let bindings = Bindings::new(&gpu, pipeline.layout(), &resources)?;
    device.run(|cmd| {
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        unsafe {
            image_barrier(&gpu, cmd, &target, Use::Nothing, Use::ColorTarget);
            let clear = Load::Clear(drawing.clear);
            begin_rendering(&gpu, cmd, &[(target.view(), clear)], drawing.extent);
            set_area(&gpu, cmd, drawing.extent);
            let count = drawing.corners.len() as u32;
            pipeline.draw(cmd, &bindings, &[], count, 0..drawing.instances);
            end_rendering(&gpu, cmd);
        }
        Ok(())
    })?;
    texels(device, &target, Use::ColorTarget)
}

/// An image to draw into, sample and copy from.
pub fn target(
    gpu: &Arc<Gpu>,
    format: vk::Format,
    [width, height]: [u32; 2],
) -> Result<Image, Stop> {
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format,
        usage,
        name: "target",
    };
    Ok(Image::new(gpu, &desc)?)
}

/// Number `i` of texels of floats, halves or codes of 8 or 16 bits.
pub fn number(format: vk::Format, texels: &[u8], i: usize) -> f64 {
    let two = || [texels[2 * i], texels[2 * i + 1]];
    match format {
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8_UNORM => f64::from(texels[i]) / 255.0,
        vk::Format::R16_UNORM | vk::Format::R16G16B16A16_UNORM => {
            f64::from(u16::from_le_bytes(two())) / 65_535.0
        }
        vk::Format::R16_SFLOAT | vk::Format::R16G16_SFLOAT | vk::Format::R16G16B16A16_SFLOAT => {
            half::f16::from_le_bytes(two()).to_f64()
        }
        _ => {
            let mut bytes = [0; 4];
            bytes.copy_from_slice(&texels[4 * i..4 * i + 4]);
            f32::from_le_bytes(bytes).into()
        }
    }
}
