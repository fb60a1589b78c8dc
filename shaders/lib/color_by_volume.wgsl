// What colours a surface: another volume on the same grid, by a function of its own; the surface's own colour where
// that volume has no data.

#import channels
#import transfer_points

fn surface_color(index: u32, place: Place) -> vec3<f32> {
    if !channel_has_data(1u, place) {
        return frame.level_colors[index].xyz;
    }
    return classify(channel_value(1u, place)).color;
}
