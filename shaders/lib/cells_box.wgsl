// Voxels in 3D textures.

#import filter_{filter}
#import nearest
#import mask

fn place_at(voxel: vec3<f32>) -> Place {
    return voxel;
}
