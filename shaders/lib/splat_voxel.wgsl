// Voxels, one by one, and which of them are splatted where splats are added as they are: by their centres.

#import box
#import filter_nearest
#import mask
#import holes_{holes}

struct Segment {
    t: f32,
    length: f32,
}

fn centre_of(voxel: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(voxel) + 0.5;
}

fn is_inside_clips(voxel: vec3<i32>) -> bool {
    let world = vec4(centre_of(voxel), 1.0) * frame.world_from_voxel;
    var is_inside = true;
    for (var i = 0u; i < frame.clip_plane_count; i++) {
        let plane = frame.clip_planes[i];
        is_inside = is_inside && dot(plane.xyz, world) >= plane.w;
    }
    return is_inside;
}

// What a voxel adds to a sheet for each part of its weight: its value and 1 where it has data, and 1.
fn value_numbers(voxel: vec3<i32>) -> vec4<f32> {
    if !voxel_is_valid(voxel) {
        return vec4(0.0, 0.0, 1.0, 0.0);
    }
    return vec4(volume_value(centre_of(voxel)), 1.0, 1.0, 0.0);
}

// Whether a sheet of these sums has data: at least half of its weight.
fn sheet_has_data(sums: vec4<f32>) -> bool {
    return sums.y > 0.0 && sums.y >= 0.5 * sums.z;
}

// All of a ray, from the eye to what the host has drawn, where splats are added as they are.
fn range_of_centres(world: Ray, pixel: vec2<f32>) -> SplatRange {
    let seen = visible_interval(vec2(0.0, ENDLESS), world, pixel);
    return SplatRange(seen, seen, frame.splat_first, frame.splat_last);
}

// What lies in the domain, where sheets are sampled; splats are those of all voxels.
fn range_of_samples(world: Ray, voxel: Ray, pixel: vec2<f32>) -> SplatRange {
    let inside = visible_interval(domain_interval(world, voxel), world, pixel);
    return SplatRange(inside, vec2(-ENDLESS, ENDLESS), vec3(0), vec3<i32>(frame.dims) - 1);
}
