// Splatting of scattered points: Gaussian balls of extinction, composited from front to back by the depth of their centres.
// One invocation a pixel, which goes through the list of its block. CPU reference: src/technique/splat/points/reference.rs.

#import drawn_tile
#import beside_layers
#import splat_composite
#import transfer_{transfer}
#import view_points

// Premultiplied colour and alpha.
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let tile = drawn_tile(group);
    let pixel = pixel_in(tile, own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let ray = pixel_ray(vec2<f32>(pixel) + 0.5);
    let list = list_of(pixel);
    var so_far = gathered_before(pixel);
    for (var i = list.x; i < list.y && !is_finished(so_far); i++) {
        let point = listed(i);
        let square = square_of(point, ray);
        if square > frame.splat_reach * frame.splat_reach {
            continue;
        }
        so_far.samples += 1.0;
        // Of points out of reach, which are most, no more is read: drivers on CPUs read word by word.
        let matter = classify(view_points.all[point].value);
        let length = view_points.all[point].length * exp(-0.5 * square);
        so_far = with_matter(so_far, matter.color, matter.extinction, length);
    }
    textureStore(picture, pixel, picture_of(so_far));
    leave_beside(pixel, so_far);
}
