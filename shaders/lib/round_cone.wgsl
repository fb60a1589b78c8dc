// Where a ray meets a round cone, the hull of two spheres, first.
//
//     u = b - a,  c = a + s u the place of the axis that is nearest to the ray,  r = r_a - s dr,  dr = r_a - r_b
//     v = o - c,  o moved along the ray to where it is nearest to c;  d2 = u.u - dr^2   (d2 <= 0: one sphere holds the other)
//     side     d2 |v + t d|^2 - y^2 + 2 y dr r - u.u r^2 = 0,  y = u.(v + t d)
//              where 0 < s + (y - r dr) / d2 < 1:  between the circles in which the cone touches the spheres
//     spheres  t = -m - sqrt(r^2 - |v - m d|^2),  m = d.v,  v from their centres
//
// Both origins are moved so that f32 loses nothing far away, nor along a cone that is long for its radius. CPU reference:
// src/geometry/round_cone.rs, which moves that of the ray alone.

struct Hit {
    is_met: bool,
    distance: f32,
    normal: vec3<f32>,
    // Between the ends: 0 at the first, 1 at the second.
    part: f32,
}

const NO_HIT = Hit(false, 0.0, vec3(0.0), 0.0);

// A ray that is nearer to the direction of the axis, by the square of the sine, is as near to all of it.
const PARALLEL: f32 = 1e-6;

fn met_sphere(away: vec3<f32>, direction: vec3<f32>, radius: f32, part: f32) -> Hit {
    let m = dot(direction, away);
    let across = away - m * direction;
    let h = radius * radius - dot(across, across);
    if h < 0.0 {
        return NO_HIT;
    }
    let t = -m - sqrt(h);
    return Hit(true, t, (away + t * direction) / radius, part);
}

// Ends are centres and radii.
fn met_cone(ray: Ray, first: vec4<f32>, second: vec4<f32>) -> Hit {
    let d = ray.direction;
    let u = second.xyz - first.xyz;
    let dr = first.w - second.w;
    let uu = dot(u, u);
    let ud = dot(u, d);
    let middle = 0.5 * (first.xyz + second.xyz);
    let to_middle = dot(middle - ray.origin, d);
    let beside = middle - (ray.origin + to_middle * d);
    let slanted = uu - ud * ud;
    let nearest = clamp(0.5 - dot(u, beside) / slanted, 0.0, 1.0);
    let s = select(0.5, nearest, slanted > PARALLEL * uu);
    let from_middle = (s - 0.5) * u;
    let moved = dot(beside + from_middle, d);
    let start = to_middle + moved;
    let v = moved * d - beside - from_middle;
    let r = first.w - s * dr;
    let d2 = uu - dr * dr;
    if d2 > 0.0 {
        let uv = dot(u, v);
        let k2 = d2 - ud * ud;
        let k1 = d2 * dot(d, v) - uv * ud + ud * dr * r;
        let k0 = d2 * dot(v, v) - uv * uv + 2.0 * uv * dr * r - uu * r * r;
        let h = k1 * k1 - k0 * k2;
        if h < 0.0 {
            return NO_HIT;
        }
        // Along the axis of a cylinder there is no side.
        let t = (-sqrt(h) - k1) / k2;
        let y = uv - r * dr + t * ud;
        let part = s + y / d2;
        if k2 != 0.0 && part > 0.0 && part < 1.0 {
            return Hit(true, start + t, direction_of(d2 * (v + t * d) - y * u), part);
        }
    }
    var nearer = met_sphere(v + s * u, d, first.w, 0.0);
    let other = met_sphere(v - (1.0 - s) * u, d, second.w, 1.0);
    if other.is_met && !(nearer.is_met && nearer.distance <= other.distance) {
        nearer = other;
    }
    nearer.distance += start;
    return nearer;
}

// Between the ends, where the cone holds a place; -1 where it does not. With y along the axis and h beside it the sphere of the
// hull that is nearest lies at y - h k / sqrt(1 - k^2), k = dr / |u|.
fn part_inside(place: vec3<f32>, first: vec4<f32>, second: vec4<f32>) -> f32 {
    let away = place - first.xyz;
    let u = second.xyz - first.xyz;
    let length = norm(u);
    let along = u / max(length, 1e-30);
    let slope = clamp((first.w - second.w) / max(length, 1e-30), -1.0, 1.0);
    let y = dot(away, along);
    let beside = norm(away - y * along);
    var nearest = y - beside * slope / sqrt(max(1.0 - slope * slope, 1e-30));
    // One sphere holds the other.
    if abs(slope) >= 1.0 {
        nearest = select(length, 0.0, slope > 0.0);
    }
    let x = clamp(nearest, 0.0, length);
    let part = x / max(length, 1e-30);
    let radius = first.w + (second.w - first.w) * part;
    let off = away - x * along;
    return select(-1.0, part, dot(off, off) <= radius * radius);
}
