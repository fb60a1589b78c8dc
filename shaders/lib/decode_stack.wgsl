// Texels of a stack of slices, by where they lie in the brick.

#import cell_grid

@group(0) @binding(1) var stack: texture_2d_array<f32>;

fn decoded_at(texel: vec3<i32>) -> f32 {
    let axis = cell_grid.axis;
    return textureLoad(stack, vec2(texel[(axis + 1u) % 3u], texel[(axis + 2u) % 3u]), texel[axis], 0).x;
}
