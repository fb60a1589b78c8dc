// The colour of matter that a part T of a light L reaches, a the ambient part of the material:
//
//     lit(T) = s + T (lit(1) - s)        s = a c, at most lit(1)
//     lit(1) = c (a + (1 - a) L), or what the law of Blinn and Phong says
//
// so the ambient part stays in the deepest shadow, and no shadow is brighter than the light.
// CPU reference: src/technique/slices_3d/half_angle/reference.rs.

#import frame

fn shadowed(color: vec3<f32>, lit: vec3<f32>, light: f32) -> vec3<f32> {
    let ambient = min(frame.ambient * color, lit);
    return ambient + light * (lit - ambient);
}

// Without surfaces.
fn plainly_lit(color: vec3<f32>) -> vec3<f32> {
    let ambient = min(frame.ambient, 1.0);
    return color * (ambient + (1.0 - ambient) * frame.light_colors[0].xyz);
}
