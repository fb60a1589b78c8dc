// The field of scattered points: what is made of those within R of a place (`src/points/field.rs`, which is the CPU reference).
//
//     mean = sum of m f W / sum of m W       density = sum of m W / N       W = (1 - r)^4 (4 r + 1), r = |x - x_s| / R < 1
//
// Points are sorted into cells, wider than R, and those of three cells in a row follow each other.

#import box

struct FieldPoints {
    // Of each point x, y, z in cells, its value and its weight.
    d: array<f32>,
}

struct FieldCells {
    // Where the points of each cell begin, the end of the last, and how far each cell is from the next one with points.
    d: array<u32>,
}

@group(0) @binding(49) var<storage, read> field_points: FieldPoints;
@group(0) @binding(50) var<storage, read> field_cells: FieldCells;

const POINT_NUMBERS: u32 = 5u;

struct FieldValue {
    value: f32,
    // A point is near.
    is_there: bool,
}

// As filters of voxels have it.
fn filtered(values: Values, coding: Coding, place: vec3<f32>) -> f32 {
    return field_at(place).value;
}

fn field_at(place: Place) -> FieldValue {
    let at = vec4(place, 1.0) * frame.field_from_voxel;
    let cells = vec3<i32>(frame.field_cells);
    let home = vec3<i32>(floor(at));
    // Beyond the cells around them all no point is near.
    if any(home < vec3(-1)) || any(home > cells) {
        return FieldValue(0.0, false);
    }
    let low = clamp(home - 1, vec3(0), cells - 1);
    let high = clamp(home + 1, vec3(0), cells - 1);
    var sum = 0.0;
    var weights = 0.0;
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            let row = cells.x * (y + cells.y * z);
            let end = field_cells.d[row + high.x + 1];
            for (var i = field_cells.d[row + low.x]; i < end; i++) {
                let n = POINT_NUMBERS * i;
                let point = vec3(field_points.d[n], field_points.d[n + 1u], field_points.d[n + 2u]);
                let off = (point - at) * frame.field_scale;
                let square = dot(off, off);
                if square < 1.0 {
                    let r = sqrt(square);
                    let rest = 1.0 - r;
                    let squared = rest * rest;
                    let weight = field_points.d[n + 4u] * (squared * squared * (4.0 * r + 1.0));
                    sum += weight * field_points.d[n + 3u];
                    weights += weight;
                }
            }
        }
    }
    if !(weights > 0.0) {
        return FieldValue(0.0, false);
    }
    if frame.field_density != 0.0 {
        return FieldValue(weights * frame.field_density, true);
    }
    return FieldValue(sum / weights, true);
}
