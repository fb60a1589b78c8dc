// Each splat by itself: slices, rows and columns from front to back. CPU reference: src/technique/splat/reference.rs.

#import splat_line
#import splat_voxel

fn splatted_along(world: Ray, line: SplatLine, range: SplatRange, before: Accumulator) -> Accumulator {
    var so_far = before;
    let slices = splat_slices(line, range, line.reach + plane_length(world));
    let end = min(slices.count, i32(frame.part_end));
    for (var i = i32(frame.part_first); i < end && !is_finished(so_far); i++) {
        let m = slices.first + i * slices.step;
        let t = crossing(line, m);
        let rectangle = splat_rectangle(line, range, t);
        var forth = FIRST_PLACE;
        for (var n = 0; n < rectangle.count.x * rectangle.count.y && !is_finished(so_far); n++) {
            forth = next_place(forth, rectangle.count.x);
            let at = select(forth, rectangle.count - 1 - forth, line.direction.xy < vec2(0.0));
            let w = rectangle.offset + vec2<f32>(at);
            let square = splat_square(line, w);
            let voxel = voxel_across(line.axis, vec3(rectangle.first + at, m));
            if square > frame.splat_reach * frame.splat_reach || !is_kept(voxel) {
                continue;
            }
            so_far.samples += 1.0;
            let part = part_within(line, range, t + dot(line.drift, w));
            so_far = with_splat(so_far, part * splat_weight(line, square), numbers_of(voxel));
        }
    }
    return so_far;
}
