// The walk along one ray that every compute pass shares. The lattice says where, the filter what, the
// mode what for, and which part of the way cannot matter. CPU reference: src/technique/march.rs.

#import ray
#import host_depth
#import brick
#import drawn_tile
#import faces
#import lattice_{lattice}
#import filter_{filter=field}
#import nearest
#import mask
#import sample_{inputs}
#import mode_{mode}
#import skipped_{space=cells}
#import unroll_{inputs}

// `before` is what bricks nearer to the eye have gathered.
fn march(pixel: vec2<f32>, tile: RayTile, before: Accumulator) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let interval = visible_interval(domain_interval(world, voxel), world, pixel);
    var so_far = before;
    let inside = counted(brick_interval(voxel, interval), tile);
    if !(interval.x < interval.y && inside.x < inside.y) || is_finished(before) {
        return so_far;
    }
    let lattice = lattice_of(world, interval, pixel);
    // Samples in the brick follow one another: the ends are found by looking, the rest needs no look.
    var first = max(lattice.first, i32(floor(index_at(lattice, world, inside.x))) - 1);
    var end = min(lattice.first + lattice.count, i32(ceil(index_at(lattice, world, inside.y))) + 2);
    while first < end && !is_ours(segment_of(lattice, world, first), voxel) {
        first++;
    }
    while first < end && !is_ours(segment_of(lattice, world, end - 1), voxel) {
        end--;
    }
    // A cut face is seen before all samples.
    let is_cut = enters_a_cut(voxel, interval) && is_in_brick(voxel.origin + interval.x * voxel.direction);
    let whole = whole_samples(lattice);
    let line = sample_line(voxel, line_of(lattice, world), vec2(max(whole.x, first), min(whole.y, end)));
    let segments = RaySegments(world, voxel, lattice, line, interval.x, first, end);
    return gathered(so_far, segments, first - i32(is_cut));
}

// Where the samples of a ray lie, those from `first` to `end` (excluded); before them comes that of a cut face.
struct RaySegments {
    world: Ray,
    voxel: Ray,
    lattice: Lattice,
    line: SampleLine,
    t_face: f32,
    first: i32,
    end: i32,
}

// With sample k, whatever it is.
fn accumulate_sample(before: Accumulator, segments: RaySegments, k: i32) -> Accumulator {
    let segment = segment_at(segments, k);
    var so_far = before;
    so_far.samples += 1.0;
    if !has_data(position_in(segments, segment)) {
        return so_far;
    }
    return add(so_far, sample_in(segments, k, segment), segment);
}

fn segment_at(segments: RaySegments, k: i32) -> Segment {
    if k < segments.first {
        return Segment(segments.t_face, FACE_LENGTH);
    }
    return segment_of(segments.lattice, segments.world, k);
}

fn position_in(segments: RaySegments, segment: Segment) -> vec3<f32> {
    return segments.voxel.origin + segment.t * segments.voxel.direction;
}

fn sample_in(segments: RaySegments, k: i32, segment: Segment) -> Sample {
    // No light falls along no direction.
    let direction = select(segments.world.direction, vec3(0.0), k < segments.first);
    return sample_at(position_in(segments, segment), direction);
}

fn is_ours(segment: Segment, voxel: Ray) -> bool {
    return segment.length > 0.0 && is_in_brick(voxel.origin + segment.t * voxel.direction);
}
