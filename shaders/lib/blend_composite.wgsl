// What a slice hands to the blending unit: premultiplied colour and alpha of one segment.

#import opacity
#import transfer_{transfer}

fn blend_source(value: f32, length_world: f32) -> vec4<f32> {
    let material = classify(value);
    let opacity = opacity_over(material.extinction, length_world);
    return vec4(opacity * material.color, opacity);
}
