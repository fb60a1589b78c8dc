// What a cut face is made of. CPU reference: src/technique/faces.rs.

#import faces
#import color

// Greys leave as negative sRGB numbers, and become colours where the ray ends: powers are expensive, and drivers on CPUs run
// both sides of an `if` for each sample.
fn on_face(own: Classified, value: f32) -> Classified {
    if frame.cut_faces != FACES_GREY {
        return own;
    }
    let grey = (value - frame.cut_low) * frame.cut_scale;
    // What is black is open.
    if !(grey > 0.0) {
        return Classified(vec3(0.0), 0.0);
    }
    return Classified(vec3(-min(grey, 1.0)), 1.0);
}

fn face_color(color: vec3<f32>) -> vec3<f32> {
    if frame.cut_faces != FACES_GREY || color.x >= 0.0 {
        return color;
    }
    if frame.color_space_is_display != 0u {
        return -color;
    }
    return linear_from_srgb(-color);
}
