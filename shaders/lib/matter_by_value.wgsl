// What a collision finds in one volume: by its value, and where that is told by its points, three extinctions and light of its own.
// CPU reference: src/technique/pathtrace/reference.rs.

#import path_matter
#import transfer_{transfer}
#import medium
#import holes_{holes}
#import gradient_central

fn is_matter(place: vec3<f32>) -> bool {
    return volume_is_valid(footprint_of(place));
}

fn matter_at(place: vec3<f32>) -> Matter {
    let value = volume_value(place);
    let found = classify(value);
    var matter = Matter(found.color, vec3(found.extinction), vec3(0.0));
    if frame.extinction_is_colored != 0u {
        matter.extinctions = extinctions_at(value);
    }
    if frame.emission_point_count != 0u {
        matter.emission = emission_at(value);
    }
    return matter;
}

fn gradient_met(place: vec3<f32>, u: f32) -> vec3<f32> {
    return gradient_of(central_slope(place));
}
