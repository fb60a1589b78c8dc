// What colours a surface: its own colour.

fn painted(index: u32, place: Place) -> vec3<f32> {
    return frame.level_colors[index].xyz;
}
