// Matter in a light of which this part is left: without surfaces.

#import transfer_{transfer}
#import dimmed

fn lit_material_of(value: Sample, light: f32) -> Classified {
    let material = classify(value);
    return Classified(dimmed(material.color, plainly_lit(material.color), light), material.extinction);
}
