// What comes from a point to a segment of a ray. The light of a point falls as 1 / r^2, which is far from even over a segment
// that passes near. Of one from a to b along the ray, h = b - a long, with the point at the distance d from the ray, the mean is
//
//     1/h integral of dt / (d^2 + t^2) = (atan(b / d) - atan(a / d)) / (d h) = atan2(d h, d^2 + a b) / (d h)
//
// and with r the distance of the middle, a b = r^2 - d^2 - h^2 / 4: no difference of two angles that are alike. d is h / 100 at
// least. Angles are those of lib/elementary.wgsl. CPU reference: src/technique/scattered_light.rs.

#import frame
#import elementary

const LEAST_OF_STEP: f32 = 0.01;

// The mean of 1 / r^2 over the segment of a ray with this direction, from whose middle the point lies at `to_light`.
fn mean_of_falloff(to_light: vec3<f32>, ray_direction: vec3<f32>) -> f32 {
    let h = frame.step_world / max(abs(dot(frame.forward, ray_direction)), frame.least_slope);
    let along = dot(to_light, ray_direction);
    let beside = to_light - along * ray_direction;
    let d = max(sqrt(dot(beside, beside)), LEAST_OF_STEP * h);
    let product = along * along - 0.25 * h * h;
    return 6.2831855 * turn_of(vec2(d * d + product, d * h)) / (d * h);
}
