// How much each cell of the light grid absorbs, one thread a cell. With T_i = exp(-sigma_i L) what matter like that
// at look i lets through over the shortest side L of a cell, and k the part of the cell that no crop and no clip
// plane cuts away:
//
//     A = k mean of (1 - T_i)        sigma = -ln(1 - min(A, 1 - 2^-12)) / L
//
// So a cell half full of something opaque is half transparent, and uniform matter keeps its extinction. Where light is
// asked for inside of matter, sigma is k times the mean of sigma_i: optical depths then grow as evenly as matter does. What
// has no data absorbs nothing. Bricks add their looks one after the other. CPU reference: src/technique/light_field.rs.

#import light_grid
#import brick
#import cells_{layout}
#import matter_{matter=of_one}
#import extinction
#import opacity

@group(0) @binding(27) var<storage, read_write> light_cells: LightNumbers;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) cell: vec3<u32>) {
    if any(cell >= light_grid.cells) {
        return;
    }
    let low = vec3<f32>(cell) * light_grid.cell_voxels;
    let apart = light_grid.cell_voxels / vec3<f32>(light_grid.looks);
    var amount = 0.0;
    for (var z = 0u; z < light_grid.looks.z; z++) {
        for (var y = 0u; y < light_grid.looks.y; y++) {
            for (var x = 0u; x < light_grid.looks.x; x++) {
                amount += amount_of(low + (vec3(f32(x), f32(y), f32(z)) + 0.5) * apart);
            }
        }
    }
    let looks = f32(light_grid.looks.x * light_grid.looks.y * light_grid.looks.z);
    amount *= kept_share(low) / looks;
    let index = cell_index(cell);
    if frame.is_first_brick == 0u {
        amount += amount_in(light_cells.d[index]);
    }
    light_cells.d[index] = select(
        extinction_of(amount, light_grid.cell_length),
        amount,
        light_grid.adds_extinctions != 0u,
    );
}

// Of matter like that at a position; 0 in another brick.
fn amount_of(voxel: vec3<f32>) -> f32 {
    if !is_in_brick(voxel) {
        return 0.0;
    }
    return amount_in(extinction_at(place_at(voxel)));
}

// What is added up: opacity over a cell, or extinction itself.
fn amount_in(extinction: f32) -> f32 {
    return select(
        opacity_over(extinction, light_grid.cell_length),
        extinction,
        light_grid.adds_extinctions != 0u,
    );
}

// Exact for the crop, and for a plane that one axis of the cell stands across.
fn kept_share(low: vec3<f32>) -> f32 {
    let size = light_grid.cell_voxels;
    let inside = min(low + size, frame.domain_max) - max(low, frame.domain_min);
    let parts = clamp(inside / size, vec3(0.0), vec3(1.0));
    var share = parts.x * parts.y * parts.z;
    let center = vec4(low + 0.5 * size, 1.0) * frame.world_from_voxel;
    for (var i = 0u; i < frame.clip_plane_count; i++) {
        let plane = frame.clip_planes[i];
        let height = dot(plane.xyz, center) - plane.w;
        // Along each axis of the cell: (plane, 0) as a covector of voxel space.
        let slopes = abs((frame.world_from_voxel * plane.xyz).xyz);
        share *= clamp(height / dot(slopes, size) + 0.5, 0.0, 1.0);
    }
    return share;
}
