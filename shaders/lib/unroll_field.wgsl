// Sample by sample through the field of points, those of this recording; each goes through the points around it once. Cells
// that have no points around them are left out: what lies there has no data.

// Where samples lie, in cells of the field: x(k) = at + k step.
struct FieldLine {
    at: vec3<f32>,
    step: vec3<f32>,
    steps_per_cell: vec3<f32>,
}

fn field_line(segments: RaySegments) -> FieldLine {
    let line = line_of(segments.lattice, segments.world);
    let first = segments.voxel.origin + line.x * segments.voxel.direction;
    let along = vec4(line.y * segments.voxel.direction, 0.0) * frame.field_from_voxel;
    let tiny = vec3(1e-20);
    let step = select(along, tiny, abs(along) < tiny);
    return FieldLine(vec4(first, 1.0) * frame.field_from_voxel, step, 1.0 / step);
}

fn gathered(before: Accumulator, segments: RaySegments, start: i32) -> Accumulator {
    let line = field_line(segments);
    var so_far = before;
    var k = max(start, segments.lattice.first + i32(frame.part_first));
    let end = min(segments.end, segments.lattice.first + i32(frame.part_end));
    loop {
        k = beyond_empty_cells(line, segments.line, k);
        if k >= end || is_finished(so_far) {
            break;
        }
        let segment = segment_at(segments, k);
        let found = field_at(position_in(segments, segment));
        so_far.samples += 1.0;
        if found.is_there {
            so_far = add(so_far, found.value, segment);
        }
        k++;
    }
    return so_far;
}

// The next sample that lies in a cell with points in it or beside it. Cells are a thousandth wider than points reach: more than
// f32 loses on the way.
fn beyond_empty_cells(line: FieldLine, samples: SampleLine, start: i32) -> i32 {
    let cells = vec3<i32>(frame.field_cells);
    // Behind the starts of all cells, and the end of the last.
    let distances = cells.x * cells.y * cells.z + 1;
    var k = start;
    loop {
        if frame.field_skips == 0u || k < samples.first || k >= samples.end {
            break;
        }
        let cell = clamp(vec3<i32>(floor(line.at + f32(k) * line.step)), vec3(0), cells - 1);
        let distance = i32(field_cells.d[distances + cell.x + cells.x * (cell.y + cells.y * cell.z)]);
        if distance < 2 {
            break;
        }
        let ahead = cell + select(vec3(2 - distance), vec3(distance - 1), line.step > vec3(0.0));
        let leaves = (vec3<f32>(ahead) - line.at) * line.steps_per_cell;
        k = max(k + 1, i32(ceil(min(leaves.x, min(leaves.y, leaves.z)))));
    }
    return k;
}
