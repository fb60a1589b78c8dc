// One number a sample, and where it was taken: its gradient is made where it is wanted, six more taps.

#import holes_{holes}

struct Sample {
    value: f32,
    place: Place,
    // That of the pixel's ray, in world space, a unit vector.
    ray_direction: vec3<f32>,
}

fn has_data(place: Place) -> bool {
    return volume_is_valid(footprint_of(place));
}

fn sample_at(place: Place, ray_direction: vec3<f32>) -> Sample {
    return Sample(volume_value(place), place, ray_direction);
}

fn value_of(sample: Sample) -> f32 {
    return sample.value;
}
