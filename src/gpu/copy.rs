//! Copies between buffers and images, checked before they are recorded.
//!
//! Texels lie tightly in the buffer: x fastest, then y, then z or layers.
//!
//! ```text
//! bytes = texel bytes * width * height * (depth or layers)
//! ```

use super::{Buffer, Error, Gpu, Image, image::WHOLE_COLOR, texel_bytes};
use ash::vk;

/// Part of an image. For a 2D array, the third number counts layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The first texel.
    pub origin: [u32; 3],
    /// How many texels.
    pub extent: [u32; 3],
}

impl Region {
    /// All of an image.
    pub fn whole(image: &Image) -> Self {
        Self {
            origin: [0; 3],
            extent: image.extent(),
        }
    }

    /// The bytes that the texels of this region take in a buffer; `None` for a format of unknown texel size.
    pub fn bytes(&self, format: vk::Format) -> Option<u64> {
        let texels = self
            .extent
            .iter()
            .try_fold(1_u64, |product, &n| product.checked_mul(n.into()))?;
        texels.checked_mul(texel_bytes(format)?.into())
    }
}

/// Fills a region of `image` from `buffer`, beginning at byte `offset`.
///
/// # Errors
///
/// A region outside the image or the buffer, and an offset that is not a multiple of 4 and of a texel; nothing
/// is recorded then.
///
/// # Safety
///
/// - `cmd` is recording on `gpu`'s device, outside rendering; buffer and image live until it has run;
/// - the image is in [`super::Use::TransferWrite`]; the buffer's content is visible to transfers.
pub unsafe fn buffer_to_image(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    buffer: &Buffer,
    offset: u64,
    image: &Image,
    region: Region,
) -> Result<(), Error> {
    let copy = [checked(buffer, offset, image, region, "copy to")?];
    let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    // SAFETY: the region was checked; the rest is the caller's promise.
    gpu.record(|device| unsafe {
        device.cmd_copy_buffer_to_image(cmd, buffer.raw(), image.raw(), layout, &copy)
    });
    Ok(())
}

/// Fills `buffer`, beginning at byte `offset`, from a region of `image`.
///
/// # Errors
///
/// As [`buffer_to_image`].
///
/// # Safety
///
/// - `cmd` is recording on `gpu`'s device, outside rendering; buffer and image live until it has run;
/// - the image is in [`super::Use::TransferRead`]; nothing unfinished uses the buffer.
pub unsafe fn image_to_buffer(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    image: &Image,
    region: Region,
    buffer: &Buffer,
    offset: u64,
) -> Result<(), Error> {
    let copy = [checked(buffer, offset, image, region, "copy from")?];
    let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    // SAFETY: the region was checked; the rest is the caller's promise.
    gpu.record(|device| unsafe {
        device.cmd_copy_image_to_buffer(cmd, image.raw(), layout, buffer.raw(), &copy)
    });
    Ok(())
}

/// Copies parts of `from` into `to`: first byte there, first byte here, bytes.
///
/// # Errors
///
/// A part outside of either; nothing is recorded then.
///
/// # Safety
///
/// - `cmd` is recording on `gpu`'s device, outside rendering; both live until it has run;
/// - nothing else uses these bytes of `to` meanwhile; what `from` has is visible to transfers.
pub(crate) unsafe fn buffer_to_buffer(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    from: &Buffer,
    to: &Buffer,
    parts: &[vk::BufferCopy],
) -> Result<(), Error> {
    let ends_in = |buffer: &Buffer, first: u64, bytes: u64| {
        let end = first.checked_add(bytes);
        end.is_some_and(|end| end <= buffer.bytes())
    };
    let outside = parts.iter().find(|part| {
        part.size == 0
            || !ends_in(from, part.src_offset, part.size)
            || !ends_in(to, part.dst_offset, part.size)
    });
    if let Some(part) = outside {
        return Err(Error::Argument {
            doing: format!("copy buffer `{}` to `{}`", from.name(), to.name()),
            wanted: format!("bytes inside their {} and {}", from.bytes(), to.bytes()),
            found: format!(
                "{} from {} on to {}",
                part.size, part.src_offset, part.dst_offset
            ),
        });
    }
    if parts.is_empty() {
        return Ok(());
    }
    // SAFETY: the parts were checked; the rest is the caller's promise.
    gpu.record(|device| unsafe { device.cmd_copy_buffer(cmd, from.raw(), to.raw(), parts) });
    Ok(())
}

/// Fills all of a color image with one color.
///
/// # Safety
///
/// `cmd` is recording on `gpu`'s device, outside rendering; the image lives until it has run and is in
/// [`super::Use::TransferWrite`].
pub unsafe fn clear_image(gpu: &Gpu, cmd: vk::CommandBuffer, image: &Image, color: [f32; 4]) {
    let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    let color = vk::ClearColorValue { float32: color };
    // SAFETY: the caller's promises.
    gpu.record(|device| unsafe {
        device.cmd_clear_color_image(cmd, image.raw(), layout, &color, &[WHOLE_COLOR])
    });
}

fn checked(
    buffer: &Buffer,
    offset: u64,
    image: &Image,
    region: Region,
    verb: &str,
) -> Result<vk::BufferImageCopy, Error> {
    let wrong = |wanted: String, found: String| Error::Argument {
        doing: format!(
            "{verb} image `{}`, buffer `{}`",
            image.name(),
            buffer.name()
        ),
        wanted,
        found,
    };
    let is_inside = (0..3).all(|k| {
        let end = region.origin[k].checked_add(region.extent[k]);
        region.extent[k] > 0 && end.is_some_and(|end| end <= image.extent()[k])
    });
    if !is_inside {
        let wanted = format!("a region inside {:?}", image.extent());
        return Err(wrong(
            wanted,
            format!("{:?} from {:?} on", region.extent, region.origin),
        ));
    }
    let (Some(bytes), Some(texel_bytes)) =
        (region.bytes(image.format()), texel_bytes(image.format()))
    else {
        return Err(wrong(
            "a format of known texel size".into(),
            format!("{:?}", image.format()),
        ));
    };
    let alignment = u64::from(texel_bytes.max(4));
    if !offset.is_multiple_of(alignment) {
        return Err(wrong(
            format!("an offset that is a multiple of {alignment}"),
            offset.to_string(),
        ));
    }
    if offset
        .checked_add(bytes)
        .is_none_or(|end| end > buffer.bytes())
    {
        let wanted = format!("{bytes} bytes at {offset}");
        return Err(wrong(
            wanted,
            format!("a buffer of {} bytes", buffer.bytes()),
        ));
    }
    let [layers, depth] = image.kind().layers_and_depth(region.extent);
    let is_deep = image.kind() == super::ImageKind::D3;
    let [first_layer, z] = if is_deep {
        [0, region.origin[2]]
    } else {
        [region.origin[2], 0]
    };
    Ok(vk::BufferImageCopy::default()
        .buffer_offset(offset)
        .image_subresource(
            vk::ImageSubresourceLayers::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .base_array_layer(first_layer)
                .layer_count(layers),
        )
        .image_offset(vk::Offset3D {
            x: region.origin[0] as i32,
            y: region.origin[1] as i32,
            z: z as i32,
        })
        .image_extent(vk::Extent3D {
            width: region.extent[0],
            height: region.extent[1],
            depth,
        }))
}
