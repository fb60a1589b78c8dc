// The walk along one ray in slabs: the value where one ends is the value where the next begins. A slab belongs to
// the brick that its middle lies in. CPU reference: src/technique/march.rs.

#import ray
#import host_depth
#import brick
#import drawn_tile
#import faces
#import slab_{lattice}
#import filter_{filter}
#import nearest
#import mask
#import sample_slab
#import mode_{mode}
#import skipped_cells
#import unroll_{light}_slabs

// `before` is what bricks nearer to the eye have gathered.
fn march(pixel: vec2<f32>, tile: RayTile, before: Accumulator) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let interval = visible_interval(domain_interval(world, voxel), world, pixel);
    let inside = counted(brick_interval(voxel, interval), tile);
    if !(interval.x < interval.y && inside.x < inside.y) || is_finished(before) {
        return before;
    }
    let lattice = lattice_of(world, interval, pixel);
    // Slabs in the brick follow one another: the ends are found by looking, the rest needs no look.
    var first = max(lattice.first, i32(floor(index_at(lattice, world, inside.x))) - 1);
    var end = min(lattice.first + lattice.count, i32(ceil(index_at(lattice, world, inside.y))) + 2);
    while first < end && !is_ours(slab_of(lattice, world, first), voxel) {
        first++;
    }
    while first < end && !is_ours(slab_of(lattice, world, end - 1), voxel) {
        end--;
    }
    // A cut face is seen before all slabs.
    let is_cut = enters_a_cut(voxel, interval) && is_in_brick(voxel.origin + interval.x * voxel.direction);
    // The cells know of both ends of slabs whose middles lie on the line. None of these is cut short: a plane may lie outside
    // at each end, and the slab of the next is cut there.
    let whole = whole_samples(lattice) + vec2(2, -2);
    let line = sample_line(voxel, line_of(lattice, world), vec2(max(whole.x, first), min(whole.y, end)));
    let slabs = RaySlabs(world, voxel, lattice, line, interval.x, first, end);
    return gathered(before, slabs, first - i32(is_cut));
}

// Where the slabs of a ray lie, those from `first` to `end` (excluded); before them comes that of a cut face.
struct RaySlabs {
    world: Ray,
    voxel: Ray,
    lattice: Lattice,
    line: SampleLine,
    t_face: f32,
    first: i32,
    end: i32,
}

// What a ray meets at a slab.
struct MetSlab {
    sample: Sample,
    segment: Segment,
    has_data: bool,
}

// Slab k, whatever it is.
fn slab_at(slabs: RaySlabs, k: i32) -> MetSlab {
    var slab = Slab(slabs.t_face, slabs.t_face, FACE_LENGTH);
    if k >= slabs.first {
        slab = slab_of(slabs.lattice, slabs.world, k);
    }
    let front = end_at(place_on(slabs, slab.front));
    let back = end_at(place_on(slabs, slab.back));
    let t = 0.5 * (slab.front + slab.back);
    // No light falls along no direction.
    let direction = select(slabs.world.direction, vec3(0.0), k < slabs.first);
    let sample = Sample(front.value, back.value, place_on(slabs, t), direction);
    return MetSlab(sample, Segment(t, slab.length), front.is_valid && back.is_valid);
}

fn place_on(slabs: RaySlabs, t: f32) -> vec3<f32> {
    return slabs.voxel.origin + t * slabs.voxel.direction;
}

fn is_ours(slab: Slab, voxel: Ray) -> bool {
    let t = 0.5 * (slab.front + slab.back);
    return slab.length > 0.0 && is_in_brick(voxel.origin + t * voxel.direction);
}
