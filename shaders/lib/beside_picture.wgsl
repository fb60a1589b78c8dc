// Pictures of one brick of which nobody asks for a layer: what only layers tell is not computed.

fn leave_beside(pixel: vec2<u32>, found: Accumulator) {
}

fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    return begin();
}
