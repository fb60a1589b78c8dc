// A box of voxels, both ends included.

struct Footprint {
    min: vec3<i32>,
    max: vec3<i32>,
}
