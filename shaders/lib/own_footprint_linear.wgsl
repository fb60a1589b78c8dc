// The voxels with a weight in trilinear interpolation of a whole texture.

fn own_footprint(own: vec3<f32>, dims: vec3<f32>) -> Footprint {
    return linear_footprint(own, dims);
}
