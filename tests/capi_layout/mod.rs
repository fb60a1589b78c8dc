//! What Rust knows of the structures of C, as assertions that a compiler of C checks.

use std::mem::offset_of;
use stratavox::capi::*;

/// The size of a structure and the offset of each of its members; one that is left out does not compile.
macro_rules! layout {
    ($asserts:ident: $($name:ident { $($field:ident),* $(,)? })*) => {$(
        let size = size_of::<$name>();
        $asserts.push(assertion(&format!("sizeof({})", stringify!($name)), size));
        $({
            let what = format!("offsetof({}, {})", stringify!($name), stringify!($field));
            $asserts.push(assertion(&what, offset_of!($name, $field)));
        })*
        let _all = |whole: $name| { let $name { $($field: _),* } = whole; };
    )*};
}

fn assertion(what: &str, number: usize) -> String {
    format!("_Static_assert({what} == {number}, \"{what}\");\n")
}

/// One line of C each.
pub fn asserts() -> Vec<String> {
    let mut asserts = Vec::new();
    layout! { asserts:
        sv_limits { struct_size, next, max_image_dimension_2d, max_image_dimension_3d, max_image_array_layers, max_storage_buffer_range, max_allocation_bytes, max_allocations, max_heap_bytes }
        sv_host_device { struct_size, next, api_version, queue_family, instance, physical_device, device, get_instance_proc_addr, features, has_debug_utils, limits, pipeline_cache, pipeline_cache_bytes, device_lost, user, memory_budget }
        sv_diagnostic { struct_size, next, status, wanted, allowed, text }
        sv_memory { struct_size, next, used_bytes, reserved_bytes, peak_bytes, vulkan_objects, handles, budget_bytes, allocations, device_budget_bytes, device_used_bytes }
        sv_plan { struct_size, next, device_bytes, staging_bytes, bricks }
        sv_update_desc { struct_size, next, origin, extent, voxels, voxel_bytes }
        sv_pacing { struct_size, next, target_ms, tell, user }
        sv_trace_desc { struct_size, next, dims, direction, velocities, velocity_count, world_from_voxel, seeds, seed_count, spacing, most_lines, most_vertices, length, duration, tolerance, kind, time_count, times, start, end }
        sv_round_cone { first, second, first_radius, second_radius, first_color, second_color }
        sv_triangle { corners, colors, reserved }
        sv_geometry_desc { struct_size, next, target, color_space, frames_in_flight, cones, cone_count, triangles, triangle_count }
        sv_overlay_desc { struct_size, next, width, height, camera, marks, dims, is_patient, world_from_voxel, function, settings, caption, unit, time, source, is_earth, is_logarithmic, length_metres, height_factor, text_pixels, under, under_count, has_color, reserved, color }
        sv_requirement { name, wanted, found, unlocks, is_required, is_met }
        sv_color_point { value, srgb }
        sv_opacity_point { value, opacity }
        sv_medium_point { value, linear }
        sv_transfer_function_desc { struct_size, next, colors, color_count, opacities, opacity_count, reference_length, is_stepped, reserved, extinctions, extinction_count, albedos, albedo_count, emissions, emission_count }
        sv_pick { struct_size, next, is_hit, has_value, has_color, reserved, distance, position, value, color }
        sv_camera { struct_size, next, kind, is_reversed, eye, target, up, fov_degrees, view_height, zoom, view_from_world, clip_from_view }
        sv_frame_info { struct_size, next, camera, frame, reserved }
        sv_image_state { layout, has_queue_family, stage, access, queue_family, reserved }
        sv_target { struct_size, next, image, view, format, width, height, is_cleared, clear_color, before, after }
        sv_clip_plane { normal, offset }
        sv_isosurface { value, srgb, opacity }
        sv_light { towards, srgb }
        sv_settings { struct_size, next, technique, mode, filter, lattice, color_space, is_preintegrated, disable_space_skipping, has_exact_maximum, samples_per_voxel, termination, crop_min, crop_max, clip_planes, clip_plane_count, levels, level_count, is_lit, has_lmip_threshold, ambient, diffuse, specular, shininess, lights, light_count, unit_values, lmip_threshold, mida_gamma, attenuation, depth_cue, jitter_seed, jitter_frame, rays_per_voxel, paths, scattering, tone, exposure }
        sv_path_tracing { struct_size, next, samples, samples_per_frame, seed, bounces, is_unscattered, is_rayleigh, density, albedo, mean_cosine, second_mean_cosine, second_part, light_size_degrees, sky, surface, f0, roughness }
        sv_target_class { struct_size, next, color_format, samples, depth_format, has_stencil, is_depth_reversed, subpass, render_pass }
        sv_depth_image { view, layout, width, height, reserved }
        sv_renderer_desc { struct_size, next, volume, function, settings, target, width, height, frames_in_flight, has_host_depth, gives_depth, blends_slices_in_target, depth_images, depth_image_count, picks }
        sv_timeline_point { semaphore, value }
        sv_submission { struct_size, next, queue, lock, unlock, user, waits, wait_count, signals, signal_count }
        sv_volume_desc { struct_size, next, dims, voxel_type, voxels, voxel_bytes, world_from_voxel, slope, intercept, has_fill, fill, settings, has_value_range, reserved, value_range }
    }
    for (name, number) in [
        ("SV_E_DRIVER", sv_status::SV_E_DRIVER as i32),
        ("SV_E_ARGUMENT", sv_status::SV_E_ARGUMENT as i32),
        ("SV_MODE_MIDA", sv_mode::SV_MODE_MIDA as i32),
        (
            "SV_FILTER_CATMULL_ROM",
            sv_filter::SV_FILTER_CATMULL_ROM as i32,
        ),
        ("SV_VOXEL_F64", sv_voxel_type::SV_VOXEL_F64 as i32),
        (
            "SV_TECHNIQUE_SPLAT",
            sv_technique::SV_TECHNIQUE_SPLAT as i32,
        ),
        ("SV_TONE_FILMIC", sv_tone::SV_TONE_FILMIC as i32),
        ("SV_CAUSE_CROWDED", sv_cause::SV_CAUSE_CROWDED as i32),
        (
            "SV_DIRECTION_BACKWARD",
            sv_direction::SV_DIRECTION_BACKWARD as i32,
        ),
        (
            "SV_LINE_KIND_STREAK",
            sv_line_kind::SV_LINE_KIND_STREAK as i32,
        ),
        ("SV_ABI_VERSION", sv_version::SV_ABI_VERSION as i32),
    ] {
        asserts.push(format!("_Static_assert({name} == {number}, \"{name}\");\n"));
    }
    asserts
}
