// The walk along one ray that every compute pass shares. The lattice says where, the filter what, the
// mode what for, and which part of the way cannot matter. Twin: src/technique/march.rs.

#import ray
#import brick
#import faces
#import empty_space
#import lattice_{lattice}
#import filter_{filter}
#import nearest
#import mask
#import sample_{mix}
#import mode_{mode}

// `before` is what bricks nearer to the eye have gathered.
fn march(pixel: vec2<f32>, before: Accumulator) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let interval = domain_interval(world, voxel);
    var so_far = before;
    let inside = brick_interval(voxel, interval);
    if !(interval.x < interval.y && inside.x < inside.y) || is_finished(before) {
        return so_far;
    }
    let lattice = lattice_of(world, interval, pixel);
    let first = max(lattice.first, i32(floor(index_at(lattice, world, inside.x))) - 1);
    let end = min(lattice.first + lattice.count, i32(ceil(index_at(lattice, world, inside.y))) + 2);
    // A cut face is seen before all samples.
    let is_cut = enters_a_cut(voxel, interval);
    var k = first - i32(is_cut);
    loop {
        var is_face = false;
        var segment = Segment(0.0, 0.0);
        var position = vec3(0.0);
        // On to the next sample that may count. A loop of its own: where rays are drawn side by side, none waits for
        // another's sample.
        loop {
            if k >= end {
                break;
            }
            is_face = k < first;
            segment = segment_of(lattice, world, k);
            if is_face {
                segment = Segment(interval.x, FACE_LENGTH);
            }
            position = voxel.origin + segment.t * voxel.direction;
            let room = empty_room(so_far, position);
            if room == 0u || is_face {
                break;
            }
            k = max(k + 1, i32(ceil(index_at(lattice, world, end_of_room(voxel, position, room)))));
        }
        if k >= end {
            break;
        }
        k++;
        if segment.length <= 0.0 || !is_in_brick(position) {
            continue;
        }
        so_far.samples += 1.0;
        if !has_data(position) {
            continue;
        }
        // No light falls along no direction.
        let direction = select(world.direction, vec3(0.0), is_face);
        so_far = add(so_far, sample_at(position, direction), segment);
        if is_finished(so_far) {
            break;
        }
    }
    return so_far;
}
