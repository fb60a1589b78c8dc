//! The images that the window shows.
//!
//! They hold sRGB numbers as they are (`UNORM`): the panel is blended in those, and the picture of the volume, which is
//! linear light, is encoded on its way here (`shaders/picture.wgsl`).

use crate::error::{Doing, Error};
use crate::host::Host;
use crate::words::Present;
use ash::vk;

const FORMATS: [vk::Format; 2] = [vk::Format::B8G8R8A8_UNORM, vk::Format::R8G8B8A8_UNORM];

pub struct Swapchain {
    pub raw: vk::SwapchainKHR,
    pub images: Vec<Shown>,
    pub format: vk::Format,
    pub extent: [u32; 2],
    /// What is in effect, which is `FIFO` where another one was wanted and is not there.
    pub present: vk::PresentModeKHR,
    /// Whether images can be copied from, for screenshots.
    pub can_be_copied: bool,
}

/// One of the images.
pub struct Shown {
    pub image: vk::Image,
    pub view: vk::ImageView,
    /// Signalled when it is drawn. It is presentation that waits, and nothing tells when that has ended but that the
    /// image is given out again: so there is one for each image, and not for each frame in flight.
    pub drawn: vk::Semaphore,
}

impl Swapchain {
    /// Of the window's size, in place of `old`; `None` while the window has none, minimized. The device has finished.
    pub fn new(
        host: &Host,
        old: Option<Self>,
        window: [u32; 2],
        present: Present,
    ) -> Result<Option<Self>, Error> {
        let made = Self::instead_of(host, old.as_ref(), window, present);
        if let Some(old) = old {
            old.destroy(host);
        }
        made
    }

    fn instead_of(
        host: &Host,
        old: Option<&Self>,
        window: [u32; 2],
        present: Present,
    ) -> Result<Option<Self>, Error> {
        let (surfaces, surface) = (&host.surfaces, host.surface);
        let physical_device = host.physical_device;
        // SAFETY: the handles are the host's own; nothing unfinished uses the old swapchain (the caller's promise).
        unsafe {
            let found = surfaces
                .get_physical_device_surface_capabilities(physical_device, surface)
                .doing("ask the window for its size")?;
            let extent = match found.current_extent.width {
                // The window takes the size of its images.
                u32::MAX => [0, 1].map(|k| {
                    let least = [found.min_image_extent.width, found.min_image_extent.height];
                    let most = [found.max_image_extent.width, found.max_image_extent.height];
                    window[k].clamp(least[k], most[k])
                }),
                _ => [found.current_extent.width, found.current_extent.height],
            };
            if extent.contains(&0) || window.contains(&0) {
                return Ok(None);
            }
            let formats = surfaces
                .get_physical_device_surface_formats(physical_device, surface)
                .doing("list the formats of the window")?;
            let space = vk::ColorSpaceKHR::SRGB_NONLINEAR;
            let is_there = |format: &vk::Format| {
                let same = |found: &vk::SurfaceFormatKHR| {
                    found.format == *format && found.color_space == space
                };
                formats.iter().any(same)
            };
            let format = FORMATS.into_iter().find(is_there).ok_or_else(|| {
                Error::NoDevice(format!(
                    "wanted a window of {FORMATS:?}, found {:?}",
                    formats.iter().map(|one| one.format).collect::<Vec<_>>()
                ))
            })?;
            let modes = surfaces
                .get_physical_device_surface_present_modes(physical_device, surface)
                .doing("list the ways to present")?;
            let wanted = match present {
                Present::Fifo => vk::PresentModeKHR::FIFO,
                Present::Mailbox => vk::PresentModeKHR::MAILBOX,
                Present::Immediate => vk::PresentModeKHR::IMMEDIATE,
            };
            // Each driver has FIFO.
            let mode = match modes.contains(&wanted) {
                true => wanted,
                false => vk::PresentModeKHR::FIFO,
            };
            let most = match found.max_image_count {
                0 => u32::MAX,
                most => most,
            };
            let copied = vk::ImageUsageFlags::TRANSFER_SRC;
            let can_be_copied = found.supported_usage_flags.contains(copied);
            let mut usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
            if can_be_copied {
                usage |= copied;
            }
            let opaque = vk::CompositeAlphaFlagsKHR::OPAQUE;
            let alpha = match found.supported_composite_alpha.contains(opaque) {
                true => opaque,
                false => vk::CompositeAlphaFlagsKHR::INHERIT,
            };
            let info = vk::SwapchainCreateInfoKHR::default()
                .surface(surface)
                // One more than the least, or the host waits for the display.
                .min_image_count((found.min_image_count + 1).min(most))
                .image_format(format)
                .image_color_space(space)
                .image_extent(vk::Extent2D {
                    width: extent[0],
                    height: extent[1],
                })
                .image_array_layers(1)
                .image_usage(usage)
                .pre_transform(found.current_transform)
                .composite_alpha(alpha)
                .present_mode(mode)
                .clipped(true)
                .old_swapchain(old.map_or(vk::SwapchainKHR::null(), |old| old.raw));
            let made = host.swapchains.create_swapchain(&info, None);
            let mut swapchain = Self {
                raw: made.doing("make the images of the window")?,
                images: Vec::new(),
                format,
                extent,
                present: mode,
                can_be_copied,
            };
            match swapchain.fill(host) {
                Ok(()) => Ok(Some(swapchain)),
                Err(error) => {
                    swapchain.destroy(host);
                    Err(error)
                }
            }
        }
    }

    fn fill(&mut self, host: &Host) -> Result<(), Error> {
        // SAFETY: the swapchain is valid; what is made is destroyed with it.
        unsafe {
            let images = host.swapchains.get_swapchain_images(self.raw);
            for image in images.doing("list the images of the window")? {
                let whole = vk::ImageSubresourceRange {
                    aspect_mask: vk::ImageAspectFlags::COLOR,
                    level_count: 1,
                    layer_count: 1,
                    ..Default::default()
                };
                let info = vk::ImageViewCreateInfo::default()
                    .image(image)
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(self.format)
                    .subresource_range(whole);
                let view = host.device.create_image_view(&info, None);
                self.images.push(Shown {
                    image,
                    view: view.doing("look at an image of the window")?,
                    drawn: vk::Semaphore::null(),
                });
                let info = vk::SemaphoreCreateInfo::default();
                let drawn = host.device.create_semaphore(&info, None);
                let last = self.images.last_mut().expect("pushed just now");
                last.drawn = drawn.doing("make a semaphore")?;
            }
        }
        Ok(())
    }

    /// Nothing unfinished uses it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: the caller's promise; null is ignored.
        unsafe {
            for shown in &self.images {
                host.device.destroy_image_view(shown.view, None);
                host.device.destroy_semaphore(shown.drawn, None);
            }
            host.swapchains.destroy_swapchain(self.raw, None);
        }
    }
}
