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
    if frame.color_space_is_display != 0u {
        return srgb;
    }
    return linear_from_srgb(srgb);
}

// Interpolates numbers[first .. first + count] at a value: colour points (value, red, green, blue) come first, then
// opacity points (value, opacity, 0, 0). Of none all are 0: what stands there is something else. No branch asks for that: a driver
// takes twice as long to compile for each one in a loop (`docs/conformance.md`).
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
    if low == first {
        let lowest = transfer_numbers.d[select(first, 0u, count == 0u)];
        return select(lowest, vec4(0.0), count == 0u);
    }
    let left = transfer_numbers.d[low - 1u];
    if low == first + count || is_step != 0u {
        return left;
    }
    let right = transfer_numbers.d[low];
    let part = (value - left.x) / (right.x - left.x);
    return left + part * (right - left);
}
