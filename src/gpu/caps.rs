//! Every limit that we rely on, compared by ourselves before each call.
//!
//! Drivers do not enforce limits: a software driver takes an image eight times as large as its heap and
//! fails later, or on another machine. Names are those of `VkPhysicalDeviceLimits` and its relatives.

use ash::vk;

/// What a device allows. Sizes in bytes, extents in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    missing_docs,
    reason = "each is the limit of the Vulkan specification that has this name"
)]
pub struct Caps {
    pub max_image_dimension_2d: u32,
    pub max_image_dimension_3d: u32,
    pub max_image_array_layers: u32,
    /// Of one image, over all formats and usages (`VkImageFormatProperties` may allow less).
    pub max_resource_bytes: u64,
    pub max_storage_buffer_range: u32,
    pub max_uniform_buffer_range: u32,
    /// `maxPerStageDescriptorStorageBuffers`.
    pub max_storage_buffers_per_stage: u32,
    pub max_buffer_bytes: u64,
    pub max_allocation_bytes: u64,
    pub max_allocations: u64,
    /// The size of the largest memory heap.
    pub max_heap_bytes: u64,
    pub max_workgroup_size: [u32; 3],
    pub max_workgroup_invocations: u32,
    pub max_workgroup_count: [u32; 3],
    pub max_framebuffer: [u32; 2],
    pub max_viewport: [u32; 2],
    /// The size of the largest point; 1 where `largePoints` is not enabled, which a host is not asked for.
    pub max_point_pixels: u32,
    /// R32G32B32A32_SFLOAT targets can be blended into, where the device can; optional in Vulkan.
    pub float32_blend: bool,
    /// A dynamic offset is a multiple of it.
    pub min_uniform_offset_alignment: u64,
    /// Turns that the loops of one invocation may take together. Vulkan has no such limit; llvmpipe has one
    /// (`LP_MAX_TGSI_LOOP_ITERATIONS` of Mesa) and ends loops there without a word.
    pub max_loop_turns: u32,
    /// Bits of a filter weight: one look-up may be off by `2^-bits` of the step between two texels.
    pub subtexel_bits: u32,
    /// Nanoseconds per tick of a timestamp.
    pub timestamp_period_ns: f32,
}

impl Caps {
    /// No limit at all: what to start from where a caller clamps a single limit.
    pub const UNLIMITED: Self = Self {
        max_image_dimension_2d: u32::MAX,
        max_image_dimension_3d: u32::MAX,
        max_image_array_layers: u32::MAX,
        max_resource_bytes: u64::MAX,
        max_storage_buffer_range: u32::MAX,
        max_uniform_buffer_range: u32::MAX,
        max_storage_buffers_per_stage: u32::MAX,
        max_buffer_bytes: u64::MAX,
        max_allocation_bytes: u64::MAX,
        max_allocations: u64::MAX,
        max_heap_bytes: u64::MAX,
        max_workgroup_size: [u32::MAX; 3],
        max_workgroup_invocations: u32::MAX,
        max_workgroup_count: [u32::MAX; 3],
        max_framebuffer: [u32::MAX; 2],
        max_viewport: [u32::MAX; 2],
        max_point_pixels: u32::MAX,
        float32_blend: true,
        min_uniform_offset_alignment: 1,
        max_loop_turns: u32::MAX,
        subtexel_bits: u32::MAX,
        timestamp_period_ns: 0.0,
    };

    /// The least that a Vulkan 1.3 device may offer ("Required Limits" of the specification).
    pub const VULKAN_MINIMUM: Self = Self {
        max_image_dimension_2d: 4096,
        max_image_dimension_3d: 256,
        max_image_array_layers: 256,
        max_resource_bytes: 1 << 31,
        max_storage_buffer_range: 1 << 27,
        max_uniform_buffer_range: 16_384,
        max_storage_buffers_per_stage: 4,
        max_buffer_bytes: 1 << 30,
        max_allocation_bytes: 1 << 30,
        max_allocations: 4096,
        max_heap_bytes: u64::MAX,
        max_workgroup_size: [128, 128, 64],
        max_workgroup_invocations: 128,
        max_workgroup_count: [65_535; 3],
        max_framebuffer: [4096; 2],
        max_viewport: [4096; 2],
        max_point_pixels: 1,
        float32_blend: false,
        min_uniform_offset_alignment: 256,
        max_loop_turns: u32::MAX,
        subtexel_bits: 4,
        timestamp_period_ns: 0.0,
    };

    /// What the driver reports.
    ///
    /// # Safety
    /// `physical_device` belongs to `instance`, which speaks Vulkan 1.3; so does the device.
    pub(super) unsafe fn of(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Self {
        let mut properties11 = vk::PhysicalDeviceVulkan11Properties::default();
        let mut properties12 = vk::PhysicalDeviceVulkan12Properties::default();
        let mut properties13 = vk::PhysicalDeviceVulkan13Properties::default();
        let mut properties2 = vk::PhysicalDeviceProperties2::default()
            .push_next(&mut properties11)
            .push_next(&mut properties12)
            .push_next(&mut properties13);
        let mut features = vk::PhysicalDeviceFeatures2::default();
        // SAFETY: the caller's promise.
        let memory = unsafe {
            instance.get_physical_device_properties2(physical_device, &mut properties2);
            instance.get_physical_device_features2(physical_device, &mut features);
            instance.get_physical_device_memory_properties(physical_device)
        };
        let limits = properties2.properties.limits;
        let heaps = memory.memory_heaps_as_slice();
        Self {
            max_image_dimension_2d: limits.max_image_dimension2_d,
            max_image_dimension_3d: limits.max_image_dimension3_d,
            max_image_array_layers: limits.max_image_array_layers,
            max_resource_bytes: u64::MAX,
            max_storage_buffer_range: limits.max_storage_buffer_range,
            max_uniform_buffer_range: limits.max_uniform_buffer_range,
            max_storage_buffers_per_stage: limits.max_per_stage_descriptor_storage_buffers,
            max_buffer_bytes: properties13.max_buffer_size,
            max_allocation_bytes: properties11.max_memory_allocation_size,
            max_allocations: limits.max_memory_allocation_count.into(),
            max_heap_bytes: heaps.iter().map(|heap| heap.size).max().unwrap_or(0),
            max_workgroup_size: limits.max_compute_work_group_size,
            max_workgroup_invocations: limits.max_compute_work_group_invocations,
            max_workgroup_count: limits.max_compute_work_group_count,
            max_framebuffer: [limits.max_framebuffer_width, limits.max_framebuffer_height],
            max_viewport: limits.max_viewport_dimensions,
            max_point_pixels: match features.features.large_points {
                vk::TRUE => limits.point_size_range[1] as u32,
                _ => 1,
            },
            float32_blend: true,
            min_uniform_offset_alignment: limits.min_uniform_buffer_offset_alignment,
            max_loop_turns: match properties12.driver_id {
                vk::DriverId::MESA_LLVMPIPE => 65_535,
                _ => u32::MAX,
            },
            subtexel_bits: limits.sub_texel_precision_bits,
            timestamp_period_ns: limits.timestamp_period,
        }
    }

    /// The stricter of two, limit by limit. `timestamp_period_ns` is a fact and stays as it is in `self`.
    pub fn clamped_to(self, other: &Self) -> Self {
        fn least<const N: usize>(a: [u32; N], b: [u32; N]) -> [u32; N] {
            std::array::from_fn(|k| a[k].min(b[k]))
        }
        Self {
            max_image_dimension_2d: self
                .max_image_dimension_2d
                .min(other.max_image_dimension_2d),
            max_image_dimension_3d: self
                .max_image_dimension_3d
                .min(other.max_image_dimension_3d),
            max_image_array_layers: self
                .max_image_array_layers
                .min(other.max_image_array_layers),
            max_resource_bytes: self.max_resource_bytes.min(other.max_resource_bytes),
            max_storage_buffer_range: self
                .max_storage_buffer_range
                .min(other.max_storage_buffer_range),
            max_uniform_buffer_range: self
                .max_uniform_buffer_range
                .min(other.max_uniform_buffer_range),
            max_storage_buffers_per_stage: self
                .max_storage_buffers_per_stage
                .min(other.max_storage_buffers_per_stage),
            max_buffer_bytes: self.max_buffer_bytes.min(other.max_buffer_bytes),
            max_allocation_bytes: self.max_allocation_bytes.min(other.max_allocation_bytes),
            max_allocations: self.max_allocations.min(other.max_allocations),
            max_heap_bytes: self.max_heap_bytes.min(other.max_heap_bytes),
            max_workgroup_size: least(self.max_workgroup_size, other.max_workgroup_size),
            max_workgroup_invocations: self
                .max_workgroup_invocations
                .min(other.max_workgroup_invocations),
            max_workgroup_count: least(self.max_workgroup_count, other.max_workgroup_count),
            max_framebuffer: least(self.max_framebuffer, other.max_framebuffer),
            max_viewport: least(self.max_viewport, other.max_viewport),
            max_point_pixels: self.max_point_pixels.min(other.max_point_pixels),
            float32_blend: self.float32_blend && other.float32_blend,
            min_uniform_offset_alignment: self
                .min_uniform_offset_alignment
                .max(other.min_uniform_offset_alignment),
            max_loop_turns: self.max_loop_turns.min(other.max_loop_turns),
            subtexel_bits: self.subtexel_bits.min(other.subtexel_bits),
            timestamp_period_ns: self.timestamp_period_ns,
        }
    }
}
