// Light on several volumes in one place: each on the surface across its own gradient, by central differences one voxel of
// the volume before and after (`gradient.wgsl`),
//
//     gradient of channel i, in units of the first:  s_i A^T g_i        s_i = f_0 / f_i,  f the least that is a surface
//
// Who imports this also imports where light is known: light or light_unhindered. CPU reference: src/technique/lit_mixture.rs.

#import shade
#import slope_of_channels

fn lit_channel(channel: u32, color: vec3<f32>, sample: Sample) -> vec3<f32> {
    // A cut face, seen along no direction, has its own colour.
    if all(sample.ray_direction == vec3(0.0)) {
        return color;
    }
    // Without lights all light is ambient.
    var slope = vec3(0.0);
    if frame.channel_is_labels[channel] != 0u {
        slope = label_slope(channel, sample, frame.light_count != 0u);
    } else {
        slope = channel_slope(channel, sample.place, frame.light_count != 0u);
    }
    let gradient = frame.channel_gradient_scale[channel] * (frame.voxel_from_world * slope).xyz;
    return shade(color, gradient, sample.ray_direction, voxel_of(sample.place));
}
