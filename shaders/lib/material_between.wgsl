// What a sample between two slices is made of.

#import transfer_{transfer}
#import {light=unlit}_between

fn material_of(sample: Sample) -> Classified {
    let own = classify(sample.value);
    if own.extinction == 0.0 {
        return own;
    }
    return Classified(lit_at(own.color, sample.voxel, sample.ray_direction), own.extinction);
}
