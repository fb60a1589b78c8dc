// Functions that drivers compute each in their own way, by sums and products alone. CPU reference:
// src/technique/pathtrace/elementary.rs.

// -ln(x) of 2^-24 <= x <= 1: ln m = 2 artanh s, s = (m - 1) / (m + 1), for the m in [sqrt(1/2), sqrt(2)) with x = m 2^e.
fn minus_ln(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    var exponent = f32(bits >> 23u) - 127.0;
    var m = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    if m >= 1.4142135 {
        m *= 0.5;
        exponent += 1.0;
    }
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let series = 1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0))));
    return -(exponent * 0.6931472 + 2.0 * s * series);
}

// Cosine and sine of a part of a turn, 0 to 1: Taylor's series within an eighth of a turn.
fn turned(part: f32) -> vec2<f32> {
    let quarter = floor(4.0 * part + 0.5);
    let x = 6.2831855 * (part - 0.25 * quarter);
    let q = x * x;
    let c = 1.0 + q * (-1.0 / 2.0 + q * (1.0 / 24.0 + q * (-1.0 / 720.0 + q * (1.0 / 40320.0))));
    let s = x * (1.0 + q * (-1.0 / 6.0 + q * (1.0 / 120.0 + q * (-1.0 / 5040.0 + q * (1.0 / 362880.0)))));
    switch u32(quarter) & 3u {
        case 0u: {
            return vec2(c, s);
        }
        case 1u: {
            return vec2(-s, c);
        }
        case 2u: {
            return vec2(-c, -s);
        }
        default: {
            return vec2(s, -c);
        }
    }
}

// Which part of a turn a vector points to from x on, -1/2 to 1/2: of half the angle, tan h = y / (x + norm), twice, then
// Taylor's series.
fn turn_of(vector: vec2<f32>) -> f32 {
    let half = vec2(abs(vector.x) + sqrt(dot(vector, vector)), abs(vector.y));
    let t = half.y / max(half.x + sqrt(dot(half, half)), 1e-30);
    let q = t * t;
    let series = 1.0 + q * (-1.0 / 3.0 + q * (1.0 / 5.0 + q * (-1.0 / 7.0 + q * (1.0 / 9.0 + q * (-1.0 / 11.0)))));
    let quarter = 0.63661977 * t * series;
    let turn = select(0.5 - quarter, quarter, vector.x >= 0.0);
    return select(-turn, turn, vector.y >= 0.0);
}

// The direction at this cosine and part of a turn around a unit vector (Duff et al., "Building an Orthonormal Basis,
// Revisited", JCGT 6(1), 2017).
fn around(axis: vec3<f32>, cosine: f32, part: f32) -> vec3<f32> {
    let side = select(-1.0, 1.0, axis.z >= 0.0);
    let a = -1.0 / (side + axis.z);
    let b = axis.x * axis.y * a;
    let first = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    let second = vec3(b, side + axis.y * axis.y * a, -axis.y);
    let sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    let turn = sine * turned(part);
    return turn.x * first + turn.y * second + cosine * axis;
}
