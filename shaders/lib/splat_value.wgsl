// One number a ray: the extreme of the sheets whose middles lie in the domain, or the sum of all splats along the ray.
// CPU reference: src/technique/splat/reference.rs.

#import splat_voxel
#import mode_{mode}

// Sums have no extreme.
fn is_sum() -> bool {
    return frame.extreme_sign == 0.0;
}

fn range_of(world: Ray, voxel: Ray, pixel: vec2<f32>) -> SplatRange {
    if is_sum() {
        return range_of_centres(world, pixel);
    }
    return range_of_samples(world, voxel, pixel);
}

fn is_kept(voxel: vec3<i32>) -> bool {
    return !is_sum() || is_inside_clips(voxel);
}

fn numbers_of(voxel: vec3<i32>) -> vec4<f32> {
    return value_numbers(voxel);
}

// A sheet that begins and ends there, with its middle.
fn image_segment(range: SplatRange, edges: vec4<f32>, length: f32) -> Segment {
    let is_inside = range.t.x <= edges.z && edges.z < range.t.y;
    return Segment(edges.z, select(0.0, length, is_inside));
}

fn with_sheet(so_far: Accumulator, sums: vec4<f32>, segment: Segment) -> Accumulator {
    if segment.length <= 0.0 || !sheet_has_data(sums) {
        return so_far;
    }
    return add(so_far, sums.x / sums.y, segment);
}

fn with_splat(so_far: Accumulator, weight: f32, numbers: vec4<f32>) -> Accumulator {
    if numbers.y <= 0.0 {
        return so_far;
    }
    return add(so_far, numbers.x, Segment(0.0, weight));
}

// Values are projected whatever they look like.
fn is_passed_by(line: SplatLine, t: f32, reach_voxels: f32) -> bool {
    return false;
}
