// Scattered points projected: one number a ray, which a resolve classifies once. CPU reference:
// src/technique/splat/points/reference.rs.

#import drawn_tile
#import lattice
#import mode_{mode}
#import view_points

// Standard deviations around its centre in which an extreme counts, squared.
const EXTREME_SQUARE: f32 = 4.0;

// Projected value, weight (0: nothing was met), depth (negative: none), points.
@group(0) @binding(6) var accumulation: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let tile = drawn_tile(group);
    let pixel = pixel_in(tile, own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let ray = pixel_ray(vec2<f32>(pixel) + 0.5);
    let list = list_of(pixel);
    let reach = select(EXTREME_SQUARE, frame.splat_reach * frame.splat_reach, frame.extreme_sign == 0.0);
    var so_far = begin();
    if frame.is_first_brick == 0u {
        let before = textureLoad(accumulation, pixel);
        so_far = Accumulator(before.x, before.y, before.z, before.w);
    }
    for (var i = list.x; i < list.y; i++) {
        let point = listed(i);
        let square = square_of(point, ray);
        if square > reach {
            continue;
        }
        so_far.samples += 1.0;
        let density = view_points.all[point].density * exp(-0.5 * square);
        so_far = add(so_far, view_points.all[point].value, Segment(0.0, density));
    }
    textureStore(accumulation, pixel, vec4(so_far.value, so_far.weight, -1.0, so_far.samples));
}
