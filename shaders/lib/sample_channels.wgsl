// Several things seen in the same place, one number each. CPU reference: src/technique/mixture.rs.

#import channels

struct Sample {
    values: vec4<f32>,
    has_data: vec4<bool>,
    // By its label.
    is_dimmed: bool,
    place: Place,
    // That of the pixel's ray, in world space, a unit vector.
    ray_direction: vec3<f32>,
}

// Labels without data hide what lies there; else one channel with data is enough. A channel that is opaque by
// another one has data where both have.
fn has_data(place: Place) -> bool {
    var any_has = false;
    var before_has = false;
    for (var c = 0u; c < frame.channel_count; c++) {
        let has = channel_has_data(c, place);
        if !has && frame.channel_is_labels[c] != 0u {
            return false;
        }
        let has_all = has && (before_has || frame.channel_is_opacity[c] == 0u);
        any_has = any_has || (has_all && !is_opaque_by_next(c));
        before_has = has;
    }
    return any_has;
}

fn sample_at(place: Place, ray_direction: vec3<f32>) -> Sample {
    var found = Sample(vec4(0.0), vec4(false), false, place, ray_direction);
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
