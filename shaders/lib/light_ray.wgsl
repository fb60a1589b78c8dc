// What comes through to a position along a straight line from there, from a light or from beyond the end of the domain:
//
//     T = exp(-sum of sigma_j h_j)        at (j + 1/2) h; the last, shorter segment at its own middle
//
// Four samples at once, so that loops have a fourth of the turns, which some drivers count. What empty space leaves out
// would have added nothing. CPU reference: src/technique/scattered_light.rs.

#import ray
#import distance_map

struct LightRay {
    voxel: Ray,
    // World length to the light or to the end of the domain, and how many whole steps lie before that.
    reach: f32,
    whole: i32,
}

fn through_to(world: Ray, voxel: vec3<f32>, far: f32) -> f32 {
    let along = Ray(voxel, vec4(world.direction, 0.0) * frame.voxel_from_world);
    let reach = min(domain_interval(world, along).y, far);
    if !(reach > 0.0) {
        return 1.0;
    }
    let ray = LightRay(along, reach, i32(floor(reach / frame.step_world)));
    let line = sample_line(along, vec2(0.5 * frame.step_world, frame.step_world), vec2(0, ray.whole));
    var depth = 0.0;
    var k = 0;
    loop {
        k = behind_nothing(line, k);
        if k > ray.whole || depth > frame.scattering_depth {
            break;
        }
        let first = depth_of(ray, k);
        let second = depth_of(ray, k + 1);
        let third = depth_of(ray, k + 2);
        let fourth = depth_of(ray, k + 3);
        depth += first;
        depth += select(second, 0.0, depth > frame.scattering_depth);
        depth += select(third, 0.0, depth > frame.scattering_depth);
        depth += select(fourth, 0.0, depth > frame.scattering_depth);
        k += 4;
    }
    return exp(-depth);
}

// Optical depth of a segment; none beyond the last.
fn depth_of(ray: LightRay, k: i32) -> f32 {
    let start = f32(min(k, ray.whole)) * frame.step_world;
    let is_whole = k < ray.whole;
    let length = select(ray.reach - start, frame.step_world, is_whole);
    let t = select(start + 0.5 * length, (f32(k) + 0.5) * frame.step_world, is_whole);
    let place = ray.voxel.origin + t * ray.voxel.direction;
    let is_there = (k <= ray.whole) & has_data(place);
    return select(0.0, classify(volume_value(place)).extinction * length, is_there);
}

fn behind_nothing(line: SampleLine, start: i32) -> i32 {
    var k = start;
    loop {
        if !may_skip(line, k) {
            break;
        }
        let cell = cell_of(line, k);
        let distance = distance_to_occupied(cell);
        if distance == 0 {
            break;
        }
        k = first_sample_beyond(line, k, cell, distance);
    }
    return k;
}
