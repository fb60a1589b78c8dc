// How steep one of several volumes is, per voxel of the first: by central differences, and of labels that of where the label is, e = 1
// there and 0 elsewhere, over faces and corners of a cube,
//
//     g_k = (sum of e on the two faces, with sign) / 4 + (sum of e at the eight corners, with sign) / 16
//
// CPU reference: src/technique/lit_mixture.rs.

#import sample_channels

// Nothing where a tap has no data.
fn channel_slope(channel: u32, place: Place, is_wanted: bool) -> vec3<f32> {
    var slope = vec3(0.0);
    var have_data = true;
    let taps = select(0u, 6u, is_wanted);
    for (var tap = 0u; tap < taps; tap++) {
        let sign = select(1.0, -1.0, (tap & 1u) != 0u);
        var step = vec3(0.0);
        step[tap >> 1u] = sign;
        let at = shifted(place, step);
        have_data = have_data && channel_has_data(channel, at);
        slope[tap >> 1u] += 0.5 * sign * channel_value(channel, at);
    }
    return select(vec3(0.0), slope, have_data);
}

fn label_slope(channel: u32, sample: Sample, is_wanted: bool) -> vec3<f32> {
    let label = sample.values[channel];
    var slope = vec3(0.0);
    // Faces, and then corners. In a loop: drivers on CPUs look at all channels, and by all filters, for each tap.
    let taps = select(0u, 14u, is_wanted);
    for (var tap = 0u; tap < taps; tap++) {
        var step = vec3(0.0);
        step[min(tap, 5u) >> 1u] = select(1.0, -1.0, (tap & 1u) != 0u);
        let corner = tap - 6u;
        if tap > 5u {
            step = select(vec3(1.0), vec3(-1.0), vec3((corner & 1u) != 0u, (corner & 2u) != 0u, (corner & 4u) != 0u));
        }
        let place = shifted(sample.place, step);
        if label_is_there(channel, place) && channel_value(channel, place) == label {
            slope += select(0.25, 0.0625, tap > 5u) * step;
        }
    }
    return slope;
}
