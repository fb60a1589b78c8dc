// Splats of a slice of the stack together: axis-aligned sheets (Westover 1990). Colours jump where another stack is
// taken. CPU reference: src/technique/splat/reference.rs.

#import splat_line
#import splat_voxel

fn splatted_along(world: Ray, line: SplatLine, range: SplatRange, before: Accumulator) -> Accumulator {
    var so_far = before;
    let slices = splat_slices(line, range, line.reach + plane_length(world));
    let reach_voxels = passed_reach(line, plane_length(world));
    let end = min(slices.count, i32(frame.part_end));
    for (var i = i32(frame.part_first); i < end && !is_finished(so_far); i++) {
        let m = slices.first + i * slices.step;
        let t = crossing(line, m);
        if is_passed_by(line, t, reach_voxels) {
            continue;
        }
        let rectangle = splat_rectangle(line, range, t);
        var sums = vec4(0.0);
        var at = FIRST_PLACE;
        for (var n = 0; n < rectangle.count.x * rectangle.count.y; n++) {
            at = next_place(at, rectangle.count.x);
            let w = rectangle.offset + vec2<f32>(at);
            let square = splat_square(line, w);
            let voxel = voxel_across(line.axis, vec3(rectangle.first + at, m));
            if square > frame.splat_reach * frame.splat_reach || !is_kept(voxel) {
                continue;
            }
            so_far.samples += 1.0;
            let part = part_within(line, range, t + dot(line.drift, w));
            sums += part * (splat_weight(line, square) * numbers_of(voxel));
        }
        let is_inside = range.t.x <= t && t < range.t.y;
        so_far = with_sheet(so_far, sums, Segment(t, select(0.0, 1.0 / abs(line.direction.z), is_inside)));
    }
    return so_far;
}
