// The colour of matter that a part T of a light L reaches, a the ambient part of the material:
//
//     lit(T) = a c + T (lit(1) - a c)        lit(1) = c (a + (1 - a) L), or what the law of Blinn and Phong says
//
// so the ambient part stays in the deepest shadow. Twin: src/technique/slices_3d/half_angle/reference.rs.

#import frame

fn dimmed(color: vec3<f32>, lit: vec3<f32>, light: f32) -> vec3<f32> {
    let ambient = frame.ambient * color;
    return ambient + light * (lit - ambient);
}

// Without surfaces.
fn plainly_lit(color: vec3<f32>) -> vec3<f32> {
    return color * (frame.ambient + (1.0 - frame.ambient) * frame.light_colors[0].xyz);
}
