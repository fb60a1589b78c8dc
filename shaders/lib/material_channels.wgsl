// Several emitters and absorbers in one place, none of which knows of the others:
//
//     sigma = sum of sigma_i        c = sum of sigma_i c_i / sigma
//
// where a label is dimmed
//
//     sigma = d sigma               c = y + d (c - y),  y the luminance of c
//
// Twin: src/technique/mixture.rs.

#import channel_{transfer}

fn material_of(sample: Sample) -> Classified {
    var light = vec3(0.0);
    var extinction = 0.0;
    for (var c = 0u; c < frame.channel_count; c++) {
        if sample.has_data[c] {
            let one = classify_channel(c, sample.values[c]);
            light += one.extinction * one.color;
            extinction += one.extinction;
        }
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
