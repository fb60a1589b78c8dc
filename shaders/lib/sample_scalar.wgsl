// One number a sample.

#import holes_{holes}

alias Sample = f32;

fn has_data(place: Place) -> bool {
    return volume_is_valid(footprint_of(place));
}

fn sample_at(place: Place, ray_direction: vec3<f32>) -> Sample {
    return volume_value(place);
}

fn value_of(sample: Sample) -> f32 {
    return sample;
}
