// One number a sample, that of the field of points.

alias Sample = f32;

fn has_data(place: Place) -> bool {
    return field_at(place).is_there;
}

fn sample_at(place: Place, ray_direction: vec3<f32>) -> Sample {
    return field_at(place).value;
}

fn value_of(sample: Sample) -> f32 {
    return sample;
}
