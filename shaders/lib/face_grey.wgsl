// What a cut face is made of. Twin: src/technique/faces.rs.

#import faces
#import color

fn on_face(own: Classified, value: f32) -> Classified {
    if frame.cut_faces != FACES_GREY {
        return own;
    }
    let grey = (value - frame.cut_low) * frame.cut_scale;
    // What is black is open.
    if !(grey > 0.0) {
        return Classified(vec3(0.0), 0.0);
    }
    let srgb = vec3(min(grey, 1.0));
    if frame.color_space_is_display != 0u {
        return Classified(srgb, 1.0);
    }
    return Classified(linear_from_srgb(srgb), 1.0);
}
