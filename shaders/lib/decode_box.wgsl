// Texels of a volume as 3D textures, by where they lie in the brick.

@group(0) @binding(1) var volume: texture_3d<f32>;

fn decoded_at(texel: vec3<i32>) -> f32 {
    return textureLoad(volume, texel, 0).x;
}
