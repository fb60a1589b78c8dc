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
    let first = max(lattice.first, i32(floor(index_at(lattice, world, inside.x))) - 1);
    let end = min(lattice.first + lattice.count, i32(ceil(index_at(lattice, world, inside.y))) + 2);
    var back = End(0.0, false);
    var back_of = first - 3;
    // A cut face is seen before all slabs.
    let is_cut = enters_a_cut(voxel, interval);
    // The cells know of both ends of slabs whose middles lie on the line.
    let whole = whole_samples(lattice) + vec2(1, -1);
    let line = sample_line(voxel, line_of(lattice, world), vec2(max(whole.x, first), min(whole.y, end)));
    var next = first - i32(is_cut);
    loop {
        let k = skipped(so_far, line, next);
        if k >= end {
            break;
        }
        next = k + 1;
        var slab = slab_of(lattice, world, k);
        if k < first {
            slab = Slab(interval.x, interval.x, FACE_LENGTH);
        }
        let t = 0.5 * (slab.front + slab.back);
        let middle = voxel.origin + t * voxel.direction;
        if slab.length <= 0.0 || !is_in_brick(middle) {
            continue;
        }
        so_far.samples += 1.0;
        var front = back;
        if back_of != k - 1 {
            front = end_at(voxel.origin + slab.front * voxel.direction);
        }
        back = end_at(voxel.origin + slab.back * voxel.direction);
        back_of = k;
        if !front.is_valid || !back.is_valid {
            continue;
        }
        // No light falls along no direction.
        let direction = select(world.direction, vec3(0.0), k < first);
        so_far = add(so_far, Sample(front.value, back.value, middle, direction), Segment(t, slab.length));
        if is_finished(so_far) {
            break;
        }
    }
    return so_far;
}
