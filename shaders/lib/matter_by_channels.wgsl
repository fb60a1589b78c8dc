// What a collision finds in several volumes on one grid, as a composite has it there (material_channels.wgsl). It is one with
// channel i by the chance
//
//     sigma_i / sum of sigma_i
//
// whose gradient is that of the surface. CPU reference: src/offscreen/reference/mixture.rs.

#import path_matter
#import sample_channels
#import material_channels
#import slope_of_channels

fn is_matter(place: vec3<f32>) -> bool {
    return has_data(place);
}

fn matter_at(place: vec3<f32>) -> Matter {
    let found = material_of(sample_at(place, vec3(0.0)));
    return Matter(found.color, vec3(found.extinction), vec3(0.0));
}

// In units of the first channel.
fn gradient_met(place: vec3<f32>, u: f32) -> vec3<f32> {
    let sample = sample_at(place, vec3(0.0));
    var sum = 0.0;
    for (var c = 0u; c < frame.channel_count; c++) {
        sum += own_extinction(c, sample);
    }
    var left = u * sum;
    var met = 0u;
    for (var c = 0u; c < frame.channel_count; c++) {
        let own = own_extinction(c, sample);
        if own > 0.0 && left >= 0.0 {
            met = c;
        }
        left -= own;
    }
    var slope = vec3(0.0);
    if frame.channel_is_labels[met] != 0u {
        slope = label_slope(met, sample, true);
    } else {
        slope = channel_slope(met, place, true);
    }
    return frame.channel_gradient_scale[met] * (frame.voxel_from_world * slope).xyz;
}

// 0 of a channel that says no more than a colour.
fn own_extinction(channel: u32, sample: Sample) -> f32 {
    let is_opacity = frame.channel_is_opacity[channel] != 0u;
    let before_has = channel > 0u && sample.has_data[max(channel, 1u) - 1u];
    if !sample.has_data[channel] || is_opaque_by_next(channel) || (is_opacity && !before_has) {
        return 0.0;
    }
    return classify_channel(channel, sample.values[channel]).extinction;
}
