// Central differences of the chosen filter, one voxel before and after (`gradient.wgsl`).

#import frame
#import central_differences_{differences}

// How steep the field is along each grid axis, and whether all of it is known.
struct Slope {
    voxel: vec3<f32>,
    have_data: bool,
}

// Per world length; nothing where a tap has no data.
fn gradient_of(slope: Slope) -> vec3<f32> {
    return select(vec3(0.0), (frame.voxel_from_world * slope.voxel).xyz, slope.have_data);
}
