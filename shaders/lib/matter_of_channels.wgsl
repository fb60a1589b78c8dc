// The extinction of several volumes in one place, as a composite has it there (material_channels.wgsl):
//
//     sigma = d sum of sigma_i        d the dim of a shadowed label, else 1
//
// 0 where labels have no data; a channel that is opaque by the next one has the extinction of the next one's value, where
// both have data. CPU reference: src/offscreen/reference/light.rs.

#import channels
#import channel_{transfer}

fn extinction_at(place: Place) -> f32 {
    var extinction = 0.0;
    var left = 1.0;
    var before_has = false;
    for (var c = 0u; c < frame.channel_count; c++) {
        let has = channel_has_data(c, place);
        if frame.channel_is_labels[c] != 0u {
            if !has {
                return 0.0;
            }
            if channel_is_dimmed(c, place) {
                left = frame.dim;
            }
        }
        let is_there = has && (before_has || frame.channel_is_opacity[c] == 0u);
        if is_there && !is_opaque_by_next(c) {
            extinction += classify_channel(c, channel_value(c, place)).extinction;
        }
        before_has = has;
    }
    return left * extinction;
}
