// The extinction of a colour, as a composite has it (material_colors.wgsl): of its alpha where it has one, else of its luma;
// of classified voxels what they say. 0 for no data. CPU reference: src/offscreen/reference/light.rs.

#import channels
#import luma
#import transfer_{transfer}

fn extinction_at(place: Place) -> f32 {
    for (var c = 0u; c < frame.channel_count; c++) {
        if !channel_has_data(c, place) {
            return 0.0;
        }
    }
    let last = channel_value(frame.channel_count - 1u, place);
    if frame.colors_are_classified != 0u {
        return last / frame.reference_length;
    }
    var value = last;
    if frame.channel_count == 3u {
        value = luma(vec3(channel_value(0u, place), channel_value(1u, place), last));
    }
    return classify(value).extinction;
}
