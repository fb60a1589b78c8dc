// The transfer function by its control points, exactly (`sampling.md` 4): opacity per reference length,
// and colour, linear between points in sRGB numbers. At equal values the later point wins.
// CPU reference: src/transfer/points.rs.

#import frame
#import color
#import transfer_numbers

fn opacity_at(value: f32) -> f32 {
    return between_points(value, frame.color_point_count, frame.opacity_point_count, frame.interpolation_is_step).y;
}

fn color_at(value: f32) -> vec3<f32> {
    return shown(between_points(value, 0u, frame.color_point_count, frame.interpolation_is_step).yzw);
}

// A colour as it is blended.
fn shown(srgb: vec3<f32>) -> vec3<f32> {
    return select(linear_from_srgb(srgb), srgb, frame.color_space_is_display != 0u);
}

// Interpolates numbers[first .. first + count] at a value: colour points (value, red, green, blue) come first, then
// opacity points (value, opacity, 0, 0). Of none all are 0: what stands there is something else. Without branches, which a
// driver may take long to compile in a loop (`docs/conformance.md`).
fn between_points(value: f32, first: u32, count: u32, is_step: u32) -> vec4<f32> {
    // Invariant: points before `low` are at or below the value, points from `high` on are above it.
    var low = first;
    var high = first + count;
    while low < high {
        let middle = (low + high) / 2u;
        if transfer_numbers.d[middle].x <= value {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    let is_between = low != first && low != first + count && is_step == 0u;
    let at = select(max(low, first + 1u) - 1u, 0u, count == 0u);
    let left = transfer_numbers.d[at];
    let right = transfer_numbers.d[select(at, low, is_between)];
    let part = (value - left.x) / (right.x - left.x);
    let found = select(left, left + part * (right - left), is_between);
    return select(found, vec4(0.0), count == 0u);
}
