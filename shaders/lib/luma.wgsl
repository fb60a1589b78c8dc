// ITU-R BT.709, of sRGB numbers.

fn luma(srgb: vec3<f32>) -> f32 {
    return 0.2126 * srgb.x + 0.7152 * srgb.y + 0.0722 * srgb.z;
}
