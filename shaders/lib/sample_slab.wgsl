// The values at both ends of a slab. It has data where both ends have.

#import holes_{holes}

struct Sample {
    front: f32,
    back: f32,
    // Its middle, in voxel space.
    middle: vec3<f32>,
    // That of the pixel's ray, in world space, a unit vector.
    ray_direction: vec3<f32>,
}

struct End {
    value: f32,
    is_valid: bool,
}

fn end_at(place: Place) -> End {
    if !volume_is_valid(footprint_of(place)) {
        return End(0.0, false);
    }
    return End(volume_value(place), true);
}

fn value_of(sample: Sample) -> f32 {
    return sample.front;
}
