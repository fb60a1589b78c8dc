// Channels on grids of their own, each whole in one texture, as the volume is:
//
//     p' = A p        p in voxels of the volume, p' in those of the channel
//
// A channel has data in the box of its grid alone, but for one that lies on the grid of the volume. CPU reference: src/technique/own_grid.rs.

#import own_{filter}
#import footprint
#import colors_of_channels

fn value_in(values: Values, channel: u32, place: Place) -> f32 {
    let own = place_in_channel(channel, place);
    let coding = channel_coding(channel);
    // Nothing lies between two labels.
    if frame.channel_is_labels[channel] != 0u {
        let index = own_nearest_footprint(own, dims_of_channel(channel)).min;
        return value_from_code(coding, code_from_texel(coding, textureLoad(values, index, 0).x));
    }
    return filtered_on_own(values, coding, own);
}

fn channel_footprint(channel: u32, place: Place) -> Footprint {
    let own = place_in_channel(channel, place);
    let dims = dims_of_channel(channel);
    if frame.channel_is_labels[channel] != 0u {
        return own_nearest_footprint(own, dims);
    }
    return own_footprint(own, dims);
}

fn is_in_channel(channel: u32, place: Place) -> bool {
    let own = place_in_channel(channel, place);
    let is_inside = all(own >= vec3(0.0)) && all(own <= dims_of_channel(channel));
    return frame.channel_dims[channel].w == 0.0 || is_inside;
}

fn place_in_channel(channel: u32, place: Place) -> vec3<f32> {
    let p = vec4(place, 1.0);
    let row = 3u * channel;
    return vec3(
        dot(frame.channel_from_voxel[row], p),
        dot(frame.channel_from_voxel[row + 1u], p),
        dot(frame.channel_from_voxel[row + 2u], p),
    );
}

fn dims_of_channel(channel: u32) -> vec3<f32> {
    return frame.channel_dims[channel].xyz;
}

// The voxel that a position lies in.
fn own_nearest_footprint(own: vec3<f32>, dims: vec3<f32>) -> Footprint {
    let index = clamp(vec3<i32>(floor(own)), vec3(0), vec3<i32>(dims) - 1);
    return Footprint(index, index);
}
