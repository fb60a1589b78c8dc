// A round cone in a host's picture: where the ray of a pixel meets it, lit from the eye, and its depth there.
//
//     colour   (A + D |n . d|) c + S |n . d|^30
//
// It is solid: the host's near plane cuts it, and the cut is seen. What lies behind the far plane is not. CPU reference:
// src/geometry/seen.rs.

#import geometry_view
#import round_cone

const CONE_AMBIENT: f32 = 0.3;
const CONE_DIFFUSE: f32 = 0.7;
const CONE_SPECULAR: f32 = 0.2;

struct Drawn {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) first: vec4<f32>,
    @location(1) @interpolate(flat) second: vec4<f32>,
    @location(2) @interpolate(flat) first_color: vec3<f32>,
    @location(3) @interpolate(flat) second_color: vec3<f32>,
) -> Drawn {
    let ray = ray_at(position.xy);
    let begin = near_distance(ray);
    var hit = met_cone(ray, first, second);
    let cut = part_inside(ray.origin + begin * ray.direction, first, second);
    if cut >= 0.0 {
        hit = Hit(true, begin, direction_of(view.near), cut);
    }
    let depth = depth_at(ray, hit.distance);
    if !hit.is_met || hit.distance < begin || is_beyond_far(depth) {
        discard;
    }
    let facing = min(abs(dot(hit.normal, ray.direction)), 1.0);
    let to2 = facing * facing;
    let to4 = to2 * to2;
    let to8 = to4 * to4;
    let shine = CONE_SPECULAR * (to8 * to8 * to8 * to4 * to2);
    let own = first_color + hit.part * (second_color - first_color);
    let lit = min((CONE_AMBIENT + CONE_DIFFUSE * facing) * own + shine, vec3(1.0));
    return Drawn(opaque(lit), clamp(depth, 0.0, 1.0));
}
