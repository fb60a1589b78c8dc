// The colour of a sample, sRGB numbers from 0 to 1, and what its opacity is classified by: alpha, where red,
// green and blue come multiplied with it, else luma. Interpolated as they are stored and decoded afterwards.
// CPU reference: src/technique/mixture.rs.

#import channels
#import luma

struct Sample {
    srgb: vec3<f32>,
    value: f32,
    place: Place,
    // That of the pixel's ray, in world space, a unit vector.
    ray_direction: vec3<f32>,
}

fn has_data(place: Place) -> bool {
    for (var c = 0u; c < frame.channel_count; c++) {
        if !channel_has_data(c, place) {
            return false;
        }
    }
    return true;
}

fn sample_at(place: Place, ray_direction: vec3<f32>) -> Sample {
    let values = colors_at(place);
    let color = values.xyz;
    if frame.channel_count == 3u {
        return Sample(color, luma(color), place, ray_direction);
    }
    let alpha = values.w;
    // What is transparent has no colour.
    return Sample(clamp(color / max(alpha, 1e-6), vec3(0.0), vec3(1.0)), alpha, place, ray_direction);
}

fn value_of(sample: Sample) -> f32 {
    return sample.value;
}
