// Several emitters and absorbers in one place, none of which knows of the others:
//
//     sigma = sum of sigma_i        c = sum of sigma_i c_i / sigma
//
// A channel that is opaque by the next one has c_i of its own value, sigma_i of the next one's. Where a label is shadowed
//
//     sigma = d sigma               c = y + d (c - y),  y the luminance of c
//
// CPU reference: src/technique/mixture.rs.

#import channel_{transfer}
#import mixture_{light=unlit}_channels

fn material_of(sample: Sample) -> Classified {
    var light = vec3(0.0);
    var extinction = 0.0;
    var color_before = vec3(0.0);
    var before_has = false;
    for (var c = 0u; c < frame.channel_count; c++) {
        let has = sample.has_data[c];
        if has {
            let one = classify_channel(c, sample.values[c]);
            let is_opacity = frame.channel_is_opacity[c] != 0u;
            if (before_has || !is_opacity) && !is_opaque_by_next(c) {
                let color = select(one.color, color_before, is_opacity);
                // What is transparent shows no light: no gradient is made for it.
                if one.extinction != 0.0 {
                    light += one.extinction * lit_channel(c, color, sample);
                }
                extinction += one.extinction;
            }
            color_before = one.color;
        }
        before_has = has;
    }
    if extinction == 0.0 {
        return Classified(vec3(0.0), 0.0);
    }
    let color = light / extinction;
    if sample.is_dimmed {
        let grey = dot(color, vec3(0.2126, 0.7152, 0.0722));
        return Classified(grey + frame.dim * (color - grey), frame.dim * extinction);
    }
    return Classified(color, extinction);
}
