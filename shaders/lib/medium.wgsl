// What a transfer function says of matter that scatters light, by its points: extinctions per world length of red, green and
// blue, of opacity where nothing else is said, and radiance per world length. CPU reference: src/transfer/points.rs.

#import points
#import extinction

fn extinctions_at(value: f32) -> vec3<f32> {
    let first = frame.color_point_count;
    let found = between_points(value, first, frame.opacity_point_count, frame.interpolation_is_step);
    let of_opacity = vec3(extinction_of(found.y, frame.reference_length));
    // No branch, as in `between_points`.
    return select(of_opacity, found.yzw / frame.reference_length, frame.opacity_is_extinction != 0u);
}

fn emission_at(value: f32) -> vec3<f32> {
    let first = frame.color_point_count + frame.opacity_point_count;
    return between_points(value, first, frame.emission_point_count, frame.interpolation_is_step).yzw;
}
