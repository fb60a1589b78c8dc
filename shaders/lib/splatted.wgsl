// What the splats of a volume are to the ray of a pixel. `before` is what was gathered before.

#import host_depth
#import splat_line
#import splat_{sheets}

fn splatted(pixel: vec2<f32>, before: Accumulator) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let range = range_of(world, voxel, pixel);
    if !(range.t.x < range.t.y) || is_finished(before) {
        return before;
    }
    return splatted_along(world, splat_line(voxel), range, before);
}
