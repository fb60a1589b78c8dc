// What a tentative collision finds: albedo, extinctions per world length of red, green and blue, and radiance that matter sends
// out per world length.

struct Matter {
    color: vec3<f32>,
    extinctions: vec3<f32>,
    emission: vec3<f32>,
}
