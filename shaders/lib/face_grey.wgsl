// What a cut face is made of. Twin: src/technique/faces.rs.

#import faces
#import color

// The grey is an sRGB number still: decoded once a ray, not at every sample.
fn on_face(own: Classified, value: f32) -> Classified {
    if frame.cut_faces != FACES_GREY {
        return own;
    }
    let grey = (value - frame.cut_low) * frame.cut_scale;
    // What is black is open.
    return Classified(vec3(clamp(grey, 0.0, 1.0)), select(0.0, 1.0, grey > 0.0));
}

fn is_grey_face(face: Classified) -> bool {
    return frame.cut_faces == FACES_GREY && face.extinction > 0.0;
}

// As it is blended.
fn blended_grey(srgb: vec3<f32>) -> vec3<f32> {
    if frame.color_space_is_display != 0u {
        return srgb;
    }
    return linear_from_srgb(srgb);
}
