//! The interface for C: `include/stratavox.h`.
//!
//! The names here are those of C, and the comments of what is exported are those of the header, which is made of them.
//! [`crate::embed`] does the work. Each function:
//!
//! - takes handles (`handles`) and structures that say how long they are (`structure`), in which zero is the default;
//! - gives a [`sv_status`] back, and writes a sentence where it fails (`status`);
//! - never unwinds into C, and never uses a handle of something that is gone.
//!
//! What cannot be checked stands in `docs/c-interface.md`: pointers that lead nowhere, and Vulkan handles that are
//! none.

#![allow(non_camel_case_types, reason = "the names are those of C")]
#![allow(
    clippy::missing_safety_doc,
    reason = "the comments are those of the header, for C, which has no unsafe"
)]

mod camera;
mod device;
mod failures;
mod function;
mod geometry;
mod handles;
mod host;
mod images;
mod lines;
mod overlay;
mod parts;
mod paths;
mod pick;
mod plan;
mod record;
mod renderer;
mod requirements;
mod settings;
mod status;
mod structure;
mod submit;
mod update;
mod volume;
mod words;

pub use camera::sv_camera;
pub use device::{
    sv_device, sv_device_announce, sv_device_declare_lost, sv_device_destroy, sv_device_from_host,
    sv_device_memory, sv_device_pipeline_cache, sv_device_pipelines_made, sv_device_retire,
    sv_device_set_memory_budget, sv_memory,
};
pub use function::{
    sv_color_point, sv_medium_point, sv_opacity_point, sv_transfer_function,
    sv_transfer_function_create, sv_transfer_function_desc, sv_transfer_function_destroy,
};
pub use geometry::{
    sv_geometry, sv_geometry_create, sv_geometry_desc, sv_geometry_destroy, sv_geometry_draw,
    sv_geometry_record_upload, sv_round_cone, sv_triangle,
};
pub use host::{sv_feature, sv_get_instance_proc_addr, sv_host_device, sv_limits, sv_vk_function};
pub use images::{sv_depth_image, sv_image_state, sv_target, sv_target_class};
pub use lines::{
    sv_cause, sv_direction, sv_line_kind, sv_lines, sv_lines_breaks, sv_lines_cause,
    sv_lines_count, sv_lines_destroy, sv_lines_positions, sv_lines_values, sv_trace, sv_trace_desc,
};
pub use overlay::{sv_overlay_desc, sv_overlay_rgba};
pub use parts::{
    sv_pacing, sv_renderer_begin_parts, sv_renderer_record_part_into, sv_submitter_submit_in_parts,
    sv_submitter_update_in_parts, sv_submitter_upload_in_parts,
};
pub use paths::{
    sv_path_tracing, sv_renderer_noise, sv_renderer_paths_traced, sv_renderer_restart_paths,
};
pub use pick::{sv_pick, sv_renderer_pick, sv_renderer_record_pick};
pub use plan::{sv_plan, sv_volume_plan};
pub use record::{
    sv_frame_info, sv_renderer_draw, sv_renderer_draw_depth, sv_renderer_record,
    sv_renderer_record_into,
};
pub use renderer::{
    sv_renderer, sv_renderer_create, sv_renderer_desc, sv_renderer_destroy, sv_renderer_resize,
    sv_renderer_set_settings, sv_renderer_set_transfer_function, sv_renderer_set_volume,
};
pub use requirements::{sv_check_device, sv_requirement, sv_requirements};
pub use settings::{sv_clip_plane, sv_isosurface, sv_light, sv_settings};
pub use status::{sv_diagnostic, sv_status};
pub use submit::{
    sv_submission, sv_submitter, sv_submitter_create, sv_submitter_destroy, sv_submitter_submit,
    sv_submitter_upload, sv_timeline_point,
};
pub use update::{
    sv_update, sv_update_desc, sv_update_destroy, sv_volume_record_update,
    sv_volume_record_update_part, sv_volume_stage_update,
};
pub use volume::{
    sv_volume, sv_volume_create, sv_volume_desc, sv_volume_destroy, sv_volume_record_upload,
    sv_volume_record_upload_part, sv_volume_value_range,
};
pub use words::{
    sv_camera_kind, sv_color_space, sv_filter, sv_lattice, sv_mode, sv_scattering, sv_technique,
    sv_tone, sv_version, sv_voxel_type,
};

/// The version of the library's interface: SV_ABI_VERSION of the header that it was built with. Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn sv_abi_version() -> u32 {
    sv_version::SV_ABI_VERSION as u32
}
