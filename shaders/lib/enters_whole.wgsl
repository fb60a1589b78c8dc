// Pictures without cut faces.

#import ray

fn enters_a_cut(voxel: Ray, interval: vec2<f32>) -> bool {
    return false;
}
