// What a slice hands to the blending unit: premultiplied colour and alpha of one segment.

#import opacity
#import material_{inputs}

fn blend_source(sample: Sample, length_world: f32) -> vec4<f32> {
    let material = material_of(sample);
    let opacity = opacity_over(material.extinction, length_world);
    return vec4(opacity * material.color, opacity);
}
