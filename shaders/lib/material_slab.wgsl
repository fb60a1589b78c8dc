// What a slab is made of: the mean between the values at its two ends, lit in its middle (one gradient a slab).

#import transfer_slabs
#import {light=unlit}_between

fn material_of(slab: Sample) -> Classified {
    let own = classify_slab(slab.front, slab.back);
    if own.extinction == 0.0 {
        return own;
    }
    return Classified(lit_at(own.color, slab.middle, slab.ray_direction), own.extinction);
}
