// Splats cut by sheets that face the eye: the slabs between planes forward . x = k step (Mueller and Crawfis 1998). A
// slice of voxels reaches into a few of them, which are open; those that end before all of it are closed. CPU reference:
// src/technique/splat/reference.rs.

#import splat_line
#import splat_voxel

// Sheets open at a time, four to a vector of edges.
const MAX_OPEN_SHEETS: u32 = 24u;
// Rounding closes no sheet too early: so much of one.
const SLACK: f32 = 0.0009765625;

// Heights along forward: of the eye, along the ray.
struct SheetHeights {
    origin: f32,
    slope: f32,
}

// Which sheet lies at t, with a fraction.
fn sheet_at(heights: SheetHeights, t: f32) -> f32 {
    return (heights.origin + t * heights.slope) / frame.step_world;
}

// Where sheet k begins.
fn sheet_edge(heights: SheetHeights, k: vec4<f32>) -> vec4<f32> {
    return (k * frame.step_world - heights.origin) / heights.slope;
}

// Of four sheets, how much of a splat lies before their ends, from so much further along.
fn four_edges(line: SplatLine, range: SplatRange, heights: SheetHeights, k: i32, t: f32) -> vec4<f32> {
    let at = sheet_edge(heights, f32(k) + vec4(0.0, 1.0, 2.0, 3.0));
    return line.kappa * (clamp(at, vec4(range.part.x), vec4(range.part.y)) - t);
}

fn splatted_along(world: Ray, line: SplatLine, range: SplatRange, before: Accumulator) -> Accumulator {
    var so_far = before;
    let heights = SheetHeights(dot(frame.forward, world.origin), dot(frame.forward, world.direction));
    let margin = line.reach + plane_length(world);
    let whole = splat_slices(line, range, margin);
    if whole.count <= 0 {
        return so_far;
    }
    let front = max(range.t.x, crossing(line, whole.first) - line.reach);
    let back = min(range.t.y, crossing(line, whole.first + whole.step * (whole.count - 1)) + line.reach);
    let nearest = i32(floor(sheet_at(heights, front)));
    let farthest = i32(ceil(sheet_at(heights, back))) - 1;
    var first = nearest + i32(frame.part_first);
    let last = nearest + min(farthest - nearest, i32(frame.part_end) - 1);
    if first > last {
        return so_far;
    }
    // Of a part, the slices that reach into its sheets. A splat is counted where its slice begins.
    let is_front = frame.part_first == 0u;
    let begin_t = sheet_edge(heights, vec4(f32(first))).x;
    let end_t = sheet_edge(heights, vec4(f32(last + 1))).x;
    var of_part = range;
    of_part.t = vec2(select(begin_t, range.t.x, is_front), select(end_t, range.t.y, last == farthest));
    let slices = splat_slices(line, of_part, margin);
    let counted = vec2(select(f32(first), -ENDLESS, is_front), select(f32(last + 1), ENDLESS, last == farthest));
    let reach_voxels = passed_reach(line, plane_length(world));
    // The first is the nearest. Places are named by constants, so that they can be registers.
    var open = array<vec4<f32>, MAX_OPEN_SHEETS>();
    for (var i = 0; i < slices.count; i++) {
        let m = slices.first + i * slices.step;
        let t = crossing(line, m);
        let reached = sheet_at(heights, t - line.reach) - SLACK;
        while first <= last && f32(first + 1) <= reached {
            so_far = with_image_sheet(so_far, world, heights, range, first, open[0]);
            if is_finished(so_far) {
                return so_far;
            }
            open = shifted_sheets(open);
            first++;
        }
        if is_passed_by(line, t, reach_voxels) {
            continue;
        }
        let is_counted = select(0.0, 1.0, counted.x <= reached && reached < counted.y);
        let edges_0 = four_edges(line, range, heights, first + 1, t);
        let edges_1 = four_edges(line, range, heights, first + 5, t);
        let edges_2 = four_edges(line, range, heights, first + 9, t);
        let edges_3 = four_edges(line, range, heights, first + 13, t);
        let edges_4 = four_edges(line, range, heights, first + 17, t);
        let edges_5 = four_edges(line, range, heights, first + 21, t);
        let begin = four_edges(line, range, heights, first, t).x;
        let end = line.kappa * line.reach;
        let rectangle = splat_rectangle(line, range, t);
        var at = FIRST_PLACE;
        for (var n = 0; n < rectangle.count.x * rectangle.count.y; n++) {
            at = next_place(at, rectangle.count.x);
            let w = rectangle.offset + vec2<f32>(at);
            let square = splat_square(line, w);
            let voxel = voxel_across(line.axis, vec3(rectangle.first + at, m));
            if square > frame.splat_reach * frame.splat_reach || !is_kept(voxel) {
                continue;
            }
            so_far.samples += is_counted;
            let numbers = splat_weight(line, square) * numbers_of(voxel);
            let densest = line.kappa * dot(line.drift, w);
            // Rounding makes no weight negative: a sheet lies between its voxels.
            var lower = part_before(vec4(begin - densest)).x;
            var upper = part_before(edges_0 - densest);
            var part = max(upper - vec4(lower, upper.xyz), vec4(0.0));
            open[0] += part.x * numbers;
            open[1] += part.y * numbers;
            open[2] += part.z * numbers;
            open[3] += part.w * numbers;
            // Sheets beyond the reach of the slice have no part of it.
            if edges_0.w < end {
                lower = upper.w;
                upper = part_before(edges_1 - densest);
                part = max(upper - vec4(lower, upper.xyz), vec4(0.0));
                open[4] += part.x * numbers;
                open[5] += part.y * numbers;
                open[6] += part.z * numbers;
                open[7] += part.w * numbers;
            }
            if edges_1.w < end {
                lower = upper.w;
                upper = part_before(edges_2 - densest);
                part = max(upper - vec4(lower, upper.xyz), vec4(0.0));
                open[8] += part.x * numbers;
                open[9] += part.y * numbers;
                open[10] += part.z * numbers;
                open[11] += part.w * numbers;
            }
            if edges_2.w < end {
                lower = upper.w;
                upper = part_before(edges_3 - densest);
                part = max(upper - vec4(lower, upper.xyz), vec4(0.0));
                open[12] += part.x * numbers;
                open[13] += part.y * numbers;
                open[14] += part.z * numbers;
                open[15] += part.w * numbers;
            }
            if edges_3.w < end {
                lower = upper.w;
                upper = part_before(edges_4 - densest);
                part = max(upper - vec4(lower, upper.xyz), vec4(0.0));
                open[16] += part.x * numbers;
                open[17] += part.y * numbers;
                open[18] += part.z * numbers;
                open[19] += part.w * numbers;
            }
            if edges_4.w < end {
                lower = upper.w;
                upper = part_before(edges_5 - densest);
                part = max(upper - vec4(lower, upper.xyz), vec4(0.0));
                open[20] += part.x * numbers;
                open[21] += part.y * numbers;
                open[22] += part.z * numbers;
                open[23] += part.w * numbers;
            }
        }
    }
    while first <= last && !is_finished(so_far) {
        so_far = with_image_sheet(so_far, world, heights, range, first, open[0]);
        open = shifted_sheets(open);
        first++;
    }
    return so_far;
}

fn shifted_sheets(open: array<vec4<f32>, MAX_OPEN_SHEETS>) -> array<vec4<f32>, MAX_OPEN_SHEETS> {
    return array<vec4<f32>, MAX_OPEN_SHEETS>(
        open[1], open[2], open[3], open[4], open[5], open[6], open[7], open[8],
        open[9], open[10], open[11], open[12], open[13], open[14], open[15], open[16],
        open[17], open[18], open[19], open[20], open[21], open[22], open[23], vec4(0.0),
    );
}

fn with_image_sheet(
    so_far: Accumulator,
    world: Ray,
    heights: SheetHeights,
    range: SplatRange,
    k: i32,
    sums: vec4<f32>,
) -> Accumulator {
    let edges = sheet_edge(heights, f32(k) + vec4(0.0, 1.0, 0.5, 0.0));
    return with_sheet(so_far, sums, image_segment(range, edges, plane_length(world)));
}
