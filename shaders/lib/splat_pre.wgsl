// Splats of classified voxels (Westover 1990), of which optical depths are added up, not opacities:
//
//     alpha = 1 - exp(-sum of sigma w)        colour = sum of sigma c w / sum of sigma w
//
// so that alpha is the same whatever the sheets are. CPU reference: src/technique/splat/reference.rs.

#import splat_composite
#import splat_voxel
#import channels

fn range_of(world: Ray, voxel: Ray, pixel: vec2<f32>) -> SplatRange {
    return range_of_centres(world, pixel);
}

fn is_kept(voxel: vec3<i32>) -> bool {
    return is_inside_clips(voxel);
}

// sigma c d0 and sigma d0.
fn numbers_of(voxel: vec3<i32>) -> vec4<f32> {
    if !voxel_is_valid(voxel) {
        return vec4(0.0);
    }
    let place = centre_of(voxel);
    return vec4(
        channel_value(0u, place),
        channel_value(1u, place),
        channel_value(2u, place),
        channel_value(3u, place),
    );
}

// Sheets are where their splats are.
fn image_segment(range: SplatRange, edges: vec4<f32>, length: f32) -> Segment {
    return Segment(0.0, length);
}

fn with_sheet(so_far: Accumulator, sums: vec4<f32>, segment: Segment) -> Accumulator {
    if sums.w <= 0.0 {
        return so_far;
    }
    return with_matter(so_far, sums.xyz / sums.w, sums.w / frame.reference_length, 1.0);
}

fn with_splat(so_far: Accumulator, weight: f32, numbers: vec4<f32>) -> Accumulator {
    return with_sheet(so_far, weight * numbers, Segment(0.0, 0.0));
}

// Of classified voxels no cells are known.
fn is_passed_by(line: SplatLine, t: f32, reach_voxels: f32) -> bool {
    return false;
}
