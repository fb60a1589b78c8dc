// Light on several volumes in one place: each on the surface across its own gradient, by central differences one voxel of
// the volume before and after (`gradient.wgsl`),
//
//     gradient of channel i, in units of the first:  s_i A^T g_i        s_i = f_0 / f_i,  f the least that is a surface
//
// Of labels g is that of where the label is, e = 1 there and 0 elsewhere, over faces and corners of a cube:
//
//     g_k = (sum of e on the two faces, with sign) / 4 + (sum of e at the eight corners, with sign) / 16
//
// Who imports this also imports where light is known: light or light_unhindered. CPU reference: src/technique/lit_mixture.rs.

#import shade

fn lit_channel(channel: u32, color: vec3<f32>, sample: Sample) -> vec3<f32> {
    // A cut face, seen along no direction, has its own colour.
    if all(sample.ray_direction == vec3(0.0)) {
        return color;
    }
    var slope = vec3(0.0);
    if frame.channel_is_labels[channel] != 0u {
        slope = label_slope(channel, sample);
    } else {
        slope = channel_slope(channel, sample.place);
    }
    let gradient = frame.channel_gradient_scale[channel] * (frame.voxel_from_world * slope).xyz;
    return shade(color, gradient, sample.ray_direction, voxel_of(sample.place));
}

// Nothing where a tap has no data.
fn channel_slope(channel: u32, place: Place) -> vec3<f32> {
    var slope = vec3(0.0);
    var have_data = true;
    // Without lights all light is ambient.
    let taps = select(0u, 6u, frame.light_count != 0u);
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

fn label_slope(channel: u32, sample: Sample) -> vec3<f32> {
    let label = sample.values[channel];
    var slope = vec3(0.0);
    // Faces, and then corners. In a loop: drivers on CPUs look at all channels, and by all filters, for each tap.
    let taps = select(0u, 14u, frame.light_count != 0u);
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
