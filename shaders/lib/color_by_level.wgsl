// What colours a surface: the colour of its level.

fn surface_color(index: u32, place: Place) -> vec3<f32> {
    return frame.level_colors[index].xyz;
}
