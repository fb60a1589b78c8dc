// Volumes of colour bring their own; the transfer function says how opaque it is. Classified voxels bring both.
// CPU reference: src/technique/mixture.rs.

#import color
#import transfer_{transfer}
#import mixture_{light=unlit}_colors

fn material_of(sample: Sample) -> Classified {
    let own = own_material_of(sample);
    if own.extinction == 0.0 {
        return own;
    }
    return Classified(lit_color(own.color, sample), own.extinction);
}

fn own_material_of(sample: Sample) -> Classified {
    if frame.colors_are_classified != 0u {
        return Classified(sample.srgb, sample.value / frame.reference_length);
    }
    let extinction = classify(sample.value).extinction;
    if frame.color_space_is_display != 0u {
        return Classified(sample.srgb, extinction);
    }
    return Classified(linear_from_srgb(sample.srgb), extinction);
}
