// Six trilinear values from ten texels, where six look-ups take twelve: with v the voxels i-1 .. i+2 of each axis,
// held at the edges of the grid, and w how far from i to i+1,
//
//     before = lerp(v[i-1], v[i], w)        between = lerp(v[i], v[i+1], w)        after = lerp(v[i+1], v[i+2], w)
//
// the slope along an axis is (after - before) / 2 of what is between along the others. The four rows beside the place
// hold all of x, of the eight around them only what is between counts. i is that of the place as it is: beyond the
// outermost centres values are held, and slopes are not those there.

#import footprint_texels

fn central_slope(place: Place) -> Slope {
    let last = vec3<i32>(frame.dims) - 1;
    let lattice = place - 0.5;
    let below = floor(lattice);
    let weight = lattice - below;
    let i = vec3<i32>(below);
    let v0 = vec3<u32>(clamp(i - 1, vec3(0), last));
    let v1 = vec3<u32>(clamp(i, vec3(0), last));
    let v2 = vec3<u32>(clamp(i + 1, vec3(0), last));
    let v3 = vec3<u32>(clamp(i + 2, vec3(0), last));
    let grid = grid_of_texels();
    let row = row_of(grid, v1.y);
    let row_before = row_of(grid, v0.y);
    let row_after = row_of(grid, v3.y);
    let z = vec4(layer_of(grid, v0.z), layer_of(grid, v1.z), layer_of(grid, v2.z), layer_of(grid, v3.z));

    // Where the upper voxel is held, the lower one is it.
    let held = vec2(v2.x == v1.x, v2.y == v1.y);
    let four = Four(column_of(v0.x), column_of(v2.x), v1.x == v0.x, v3.x == v2.x, weight.x);
    let front_first = upper_held(face_of(four.first, row, z.y), held.y);
    let front_third = upper_held(face_of(four.third, row, z.y), held.y);
    let back_first = upper_held(face_of(four.first, row, z.z), held.y);
    let back_third = upper_held(face_of(four.third, row, z.z), held.y);
    let low_front = four_at(four, front_first.low, front_third.low);
    let high_front = four_at(four, front_first.high, front_third.high);
    let low_back = four_at(four, back_first.low, back_third.low);
    let high_back = four_at(four, back_first.high, back_third.high);
    let x = column_of(v1.x);
    let part = select(weight.x, 0.0, held.x);
    let before_y = vec2(across(face_of(x, row_before, z.y).low, part), across(face_of(x, row_before, z.z).low, part));
    let after_y = vec2(across(face_of(x, row_after, z.y).low, part), across(face_of(x, row_after, z.z).low, part));
    let front_before = upper_held(face_of(x, row, z.x), held.y);
    let back_after = upper_held(face_of(x, row, z.w), held.y);
    let before_z = vec2(across(front_before.low, part), across(front_before.high, part));
    let after_z = vec2(across(back_after.low, part), across(back_after.high, part));

    // Before and after along x, before and after along y by z, before and after along z by y.
    let front = vec2(low_front.between, high_front.between);
    let back = vec2(low_back.between, high_back.between);
    let along_x = lerp(
        lerp(low_front.slope, high_front.slope, weight.y),
        lerp(low_back.slope, high_back.slope, weight.y),
        weight.z,
    );
    let low = vec2(front.x, back.x);
    let high = vec2(front.y, back.y);
    let across_y = (high + weight.y * (after_y - high)) - (before_y + weight.y * (low - before_y));
    let across_z = (back + weight.z * (after_z - back)) - (before_z + weight.z * (front - before_z));
    let slope = vec3(along_x, lerp(across_y.x, across_y.y, weight.z), lerp(across_z.x, across_z.y, weight.y));
    return Slope(0.5 * volume_coding().slope * slope, neighbours_are_valid(place));
}

// Four voxels of a row: where the first and the third begin a face, whether the second and the fourth are held there,
// and how far the place lies from the second to the third.
struct Four {
    first: Along,
    third: Along,
    second_is_first: bool,
    fourth_is_third: bool,
    weight: f32,
}

// What lies between the middle two, and what comes after less what comes before.
struct AlongRow {
    between: f32,
    slope: f32,
}

fn four_at(four: Four, low: vec2<f32>, high: vec2<f32>) -> AlongRow {
    let second = select(low.y, low.x, four.second_is_first);
    let fourth = select(high.y, high.x, four.fourth_is_third);
    let before = lerp(low.x, second, four.weight);
    let after = lerp(high.x, fourth, four.weight);
    return AlongRow(lerp(second, high.x, four.weight), after - before);
}

fn across(ends: vec2<f32>, weight: f32) -> f32 {
    return lerp(ends.x, ends.y, weight);
}

fn upper_held(face: Face, is_held: bool) -> Face {
    return Face(face.low, select(face.high, face.low, is_held));
}

// Neither a loop nor a branch where there is nothing to ask: drivers on CPUs keep them.
fn neighbours_are_valid(place: Place) -> bool {
    return volume_is_valid(footprint_of(shifted(place, vec3(1.0, 0.0, 0.0))))
        & volume_is_valid(footprint_of(shifted(place, vec3(-1.0, 0.0, 0.0))))
        & volume_is_valid(footprint_of(shifted(place, vec3(0.0, 1.0, 0.0))))
        & volume_is_valid(footprint_of(shifted(place, vec3(0.0, -1.0, 0.0))))
        & volume_is_valid(footprint_of(shifted(place, vec3(0.0, 0.0, 1.0))))
        & volume_is_valid(footprint_of(shifted(place, vec3(0.0, 0.0, -1.0))));
}
