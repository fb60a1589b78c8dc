// Matter in a light of which this part is left: without surfaces.

#import transfer_{transfer}
#import shadowed

fn lit_material_of(value: Sample, light: f32) -> Classified {
    let material = classify(value);
    return Classified(shadowed(material.color, plainly_lit(material.color), light), material.extinction);
}
