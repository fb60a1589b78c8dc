// The walk along one ray that every compute pass shares. The lattice says where, the filter what, the
// mode what for. Twin: src/technique/march.rs.

#import ray
#import lattice_{lattice}
#import filter_{filter}
#import holes_{holes}
#import mode_{mode}

fn march(pixel: vec2<f32>) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let interval = domain_interval(world, voxel);
    var so_far = begin();
    if !(interval.x < interval.y) {
        return so_far;
    }
    let lattice = lattice_of(world, interval);
    for (var k = lattice.first; k < lattice.first + lattice.count; k++) {
        let segment = segment_of(lattice, world, k);
        if segment.length <= 0.0 {
            continue;
        }
        so_far.samples += 1.0;
        let position = voxel.origin + segment.t * voxel.direction;
        if !footprint_is_valid(footprint_of(position)) {
            continue;
        }
        so_far = add(so_far, value_at(position), segment);
        if is_finished(so_far) {
            break;
        }
    }
    return so_far;
}
