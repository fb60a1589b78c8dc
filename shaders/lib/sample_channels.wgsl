// Several things seen in the same place, one number each. Twin: src/technique/mixture.rs.

#import channels

struct Sample {
    values: vec4<f32>,
    has_data: vec4<bool>,
    // By its label.
    is_dimmed: bool,
}

// Labels without data hide what lies there; else one channel with data is enough.
fn has_data(place: Place) -> bool {
    var any_has = false;
    for (var c = 0u; c < frame.channel_count; c++) {
        let has = channel_has_data(c, place);
        if !has && frame.channel_is_labels[c] != 0u {
            return false;
        }
        any_has = any_has || has;
    }
    return any_has;
}

fn sample_at(place: Place, ray_direction: vec3<f32>) -> Sample {
    var found = Sample(vec4(0.0), vec4(false), false);
    for (var c = 0u; c < frame.channel_count; c++) {
        if channel_has_data(c, place) {
            found.values[c] = channel_value(c, place);
            found.has_data[c] = true;
        }
        if frame.channel_is_labels[c] != 0u && channel_is_dimmed(c, place) {
            found.is_dimmed = true;
        }
    }
    return found;
}

fn value_of(sample: Sample) -> f32 {
    return sample.values.x;
}
