// Light on a volume of colours: on the surface across the gradient of what its opacity is classified by, in units of the
// first volume. Who imports this also imports where light is known: light or light_unhindered.
// CPU reference: src/technique/lit_mixture.rs.

#import shade

fn lit_color(color: vec3<f32>, sample: Sample) -> vec3<f32> {
    // A cut face, seen along no direction, has its own colour.
    if all(sample.ray_direction == vec3(0.0)) {
        return color;
    }
    var slope = vec3(0.0);
    var have_data = true;
    // Without lights all light is ambient.
    let taps = select(0u, 6u, frame.light_count != 0u);
    for (var tap = 0u; tap < taps; tap++) {
        let sign = select(1.0, -1.0, (tap & 1u) != 0u);
        var step = vec3(0.0);
        step[tap >> 1u] = sign;
        let at = shifted(sample.place, step);
        have_data = have_data && has_data(at);
        slope[tap >> 1u] += 0.5 * sign * sample_at(at, sample.ray_direction).value;
    }
    let scale = frame.channel_gradient_scale[select(0u, 3u, frame.channel_count == 4u)];
    let gradient = select(vec3(0.0), scale * (frame.voxel_from_world * slope).xyz, have_data);
    return shade(color, gradient, sample.ray_direction, voxel_of(sample.place));
}
