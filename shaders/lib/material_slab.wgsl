// What a slab is made of: the mean between the values at its two ends.

#import transfer_slabs

fn material_of(slab: Sample) -> Classified {
    return classify_slab(slab.front, slab.back);
}
