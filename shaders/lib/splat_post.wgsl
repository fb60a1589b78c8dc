// Sheets of values, which are classified (Mueller, Moeller and Crawfis 1999): v = sum of f w / sum of w, a sample that
// stands for the length of its sheet. CPU reference: src/technique/splat/reference.rs.

#import splat_composite
#import splat_voxel
#import transfer_{transfer}
#import distance_map

fn range_of(world: Ray, voxel: Ray, pixel: vec2<f32>) -> SplatRange {
    return range_of_samples(world, voxel, pixel);
}

fn is_kept(voxel: vec3<i32>) -> bool {
    return true;
}

fn numbers_of(voxel: vec3<i32>) -> vec4<f32> {
    return value_numbers(voxel);
}

// The part of a sheet between two edges that lies in the domain.
fn image_segment(range: SplatRange, edges: vec4<f32>, length: f32) -> Segment {
    let cut = vec2(max(edges.x, range.t.x), min(edges.y, range.t.y));
    let is_whole = all(cut == edges.xy);
    return Segment(0.5 * (cut.x + cut.y), select(cut.y - cut.x, length, is_whole));
}

fn with_sheet(so_far: Accumulator, sums: vec4<f32>, segment: Segment) -> Accumulator {
    if segment.length <= 0.0 || !sheet_has_data(sums) {
        return so_far;
    }
    let matter = classify(sums.x / sums.y);
    return with_matter(so_far, matter.color, matter.extinction, segment.length);
}

// Values of single splats are not classified.
fn with_splat(so_far: Accumulator, weight: f32, numbers: vec4<f32>) -> Accumulator {
    return so_far;
}

// Whether the slice that is crossed at t need not be looked at: macro cells around are empty, so far that all sheets that it
// reaches into are made of voxels in them. Neighbouring cells have values in common, so that none between those of
// several is seen either: what such a sheet has of its voxels is classified to nothing.
fn is_passed_by(line: SplatLine, t: f32, reach_voxels: f32) -> bool {
    if frame.cells.x == 0u || frame.channel_has_holes[0] != 0u {
        return false;
    }
    let voxel = across_voxel(line.axis, line.origin + t * line.direction);
    let cell = floor((voxel - frame.cells_origin) / f32(CELL_VOXELS));
    let distance = distance_to_occupied(vec3<i32>(clamp(cell, vec3(0.0), vec3<f32>(frame.cells) - 1.0)));
    return f32(CELL_VOXELS) * f32(distance - 1) >= reach_voxels;
}
