// Which patches of a slicer's slices are drawn: one thread for each square of the picture and each batch of slices, and
// one entry for a block of squares that are all drawn (patch_grid.wgsl).
//
// The rays of the four corners of a square, taken without making them unit vectors,
//
//     x(s) = o + s d        s = rise / slope on a plane
//
// are the corners of all rays of the square: on a view-aligned plane every sample lies in the quadrangle of the four,
// because x is affine in the pixel; on a slice of a stack too, because x is projective in the pixel and its
// denominator, the slope, has one sign. Between two planes each ray is a line. So all samples of a patch lie in the
// hull of eight points, and in the box around them. A patch is left out where no macro cell may have matter that meets
// this box and comes near the planes. The box is widened by a pixel, for places in it that rays go through, and by what
// f32 loses. Samples that are left out would have added nothing at all, and which patch a pixel belongs to is a matter
// of whole numbers: the picture is the same to the bit (`sampling.md` 5).
//
// CPU reference: none, but pictures with it and without are the same.

#import distance_map
#import patch_{planes}
#import patch_entry

// More cells than these are not looked at: a patch so large is drawn. With BATCH_LAYERS times as many, and their rows,
// loops take fewer turns than llvmpipe grants.
const MAX_CELLS: i32 = 1024;

// One draw without indices, as Vulkan reads it.
struct Draw {
    vertices: atomic<u32>,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

struct Draws {
    d: array<Draw>,
}

struct Patches {
    d: array<u32>,
}

@group(0) @binding(39) var<storage, read_write> draws: Draws;
@group(0) @binding(40) var<storage, read_write> patches_listed: Patches;

// Blocks of squares in a workgroup, side by side; a block has as many members as a batch has layers.
const BLOCKS: u32 = 2u;
const MEMBERS: u32 = BLOCK_SIDE * BLOCK_SIDE;
// Set where a square lies in the picture.
const PRESENT: u32 = BATCH_LAYERS;

// The layers in which each square is drawn, a bit a layer.
var<workgroup> layers_by_member: array<array<u32, MEMBERS>, BLOCKS>;
// The squares that are drawn in each layer, a bit a member.
var<workgroup> members_by_layer: array<array<u32, BATCH_LAYERS>, BLOCKS>;
// Where the entries of each block begin.
var<workgroup> begins: array<u32, BLOCKS>;

struct CornerRay {
    world: Ray,
    voxel: Ray,
    slope: f32,
}

@compute @workgroup_size(8, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let grid = patch_grid();
    let block = own.x / BLOCK_SIDE;
    let member = own.x % BLOCK_SIDE + BLOCK_SIDE * own.y;
    var layers = 0u;
    if all(id.xy < grid) {
        layers = layers_of(id) | 1u << PRESENT;
    }
    layers_by_member[block][member] = layers;
    workgroupBarrier();
    members_by_layer[block][member] = members_in(block, member);
    let all_members = members_in(block, PRESENT);
    workgroupBarrier();
    if member == 0u {
        var count = 0u;
        for (var layer = 0u; layer < BATCH_LAYERS; layer++) {
            count += entries_of(members_by_layer[block][layer], all_members);
        }
        let before = atomicAdd(&draws.d[id.z].vertices, count * entry_vertices()) / entry_vertices();
        begins[block] = id.z * batch_capacity() + before;
    }
    if all(id.xy == vec2(0u)) {
        draws.d[id.z].first_vertex = id.z * batch_capacity() * entry_vertices();
    }
    workgroupBarrier();
    // In the order of slices: a pixel is in one entry of each layer.
    let square = id.x + grid.x * id.y;
    var next = begins[block];
    for (var layer = 0u; layer < BATCH_LAYERS; layer++) {
        let drawn = members_by_layer[block][layer];
        let entry = square * BATCH_LAYERS + layer;
        let is_block = is_one_entry(drawn, all_members);
        if is_block && drawn != 0u && member == 0u {
            patches_listed.d[next] = entry | BLOCK;
        } else if !is_block && (drawn & (1u << member)) != 0u {
            patches_listed.d[next + countOneBits(drawn & ((1u << member) - 1u))] = entry;
        }
        next += entries_of(drawn, all_members);
    }
}

// The squares of a block that have a bit, a bit a member.
fn members_in(block: u32, bit: u32) -> u32 {
    var members = 0u;
    for (var member = 0u; member < MEMBERS; member++) {
        members |= ((layers_by_member[block][member] >> bit) & 1u) << member;
    }
    return members;
}

// How many entries a layer of a block takes.
fn entries_of(drawn: u32, all_members: u32) -> u32 {
    return select(countOneBits(drawn), min(drawn, 1u), is_one_entry(drawn, all_members));
}

fn is_one_entry(drawn: u32, all_members: u32) -> bool {
    return drawn == all_members && blocks_can_be_drawn();
}

// The layers of a batch in which a square is drawn, a bit a layer.
fn layers_of(id: vec3<u32>) -> u32 {
    var rays: array<CornerRay, 4>;
    var slopes = vec2(3.4e38, -3.4e38);
    for (var i = 0u; i < 4u; i++) {
        rays[i] = corner_ray(id.xy, vec2(i & 1u, i >> 1u));
        slopes = vec2(min(slopes.x, rays[i].slope), max(slopes.y, rays[i].slope));
    }
    // Nothing is known of rays that run along the slices.
    let is_known = frame.cells.x != 0u && (slopes.x > least_slope() || slopes.y < -least_slope());
    var layers = 0u;
    for (var layer = 0u; layer < BATCH_LAYERS; layer++) {
        let first = (id.z * BATCH_LAYERS + layer) * LAYER_SLICES;
        if first >= frame.slice_count {
            break;
        }
        var is_drawn = true;
        if is_known {
            let planes = planes_of(first, min(first + LAYER_SLICES, frame.slice_count));
            var low = vec3(3.4e38);
            var high = vec3(-3.4e38);
            var farthest = -3.4e38;
            for (var i = 0u; i < 8u; i++) {
                let ray = rays[i >> 1u];
                let s = plane_rise(ray.world, ray.voxel, planes[i & 1u]) / ray.slope;
                let voxel = ray.voxel.origin + s * ray.voxel.direction;
                low = min(low, voxel);
                high = max(high, voxel);
                farthest = max(farthest, s);
            }
            // Nothing behind the eye is seen.
            is_drawn = farthest > -0.5 * frame.smallest_spacing && may_have_matter(low, high, planes);
        }
        layers |= select(0u, 1u << layer, is_drawn);
    }
    return layers;
}

// The ray at a corner of a square and a pixel around it.
fn corner_ray(square: vec2<u32>, corner: vec2<u32>) -> CornerRay {
    let pixel = vec2<f32>((square + corner) * frame.patch_pixels) + 2.0 * vec2<f32>(corner) - 1.0;
    let world = Ray(
        frame.origin + pixel.x * frame.origin_dx + pixel.y * frame.origin_dy,
        frame.direction + pixel.x * frame.direction_dx + pixel.y * frame.direction_dy,
    );
    let voxel = voxel_ray(world);
    return CornerRay(world, voxel, plane_slope(world, voxel));
}

// The lowest and the highest plane of instances `first` to `end` (excluded), or the ends of their slabs.
fn planes_of(first: u32, end: u32) -> vec2<f32> {
    let a = slice_of(first);
    let b = slice_of(end - 1u);
    var planes = vec2(min(a, b), max(a, b));
    if first < frame.slice_turn && frame.slice_turn < end {
        let c = slice_of(frame.slice_turn - 1u);
        let d = slice_of(frame.slice_turn);
        planes = vec2(min(planes.x, min(c, d)), max(planes.y, max(c, d)));
    }
    return vec2<f32>(planes) + vec2(-1.0, 1.0) * frame.patch_reach_planes;
}

// Whether any cell does that meets the box of voxel space and what lies between two planes.
fn may_have_matter(box_low: vec3<f32>, box_high: vec3<f32>, planes: vec2<f32>) -> bool {
    let cell = f32(CELL_VOXELS);
    let reach = vec3(frame.patch_reach_voxels);
    let low = max(box_low, frame.domain_min) - reach;
    let high = min(box_high, frame.domain_max) + reach;
    let cells = vec3<f32>(frame.cells);
    let from_cell = floor((low - frame.cells_origin) / cell);
    let to_cell = floor((high - frame.cells_origin) / cell);
    if any(low > high) || any(to_cell < vec3(0.0)) || any(from_cell >= cells) {
        return false;
    }
    let first = vec3<i32>(clamp(from_cell, vec3(0.0), cells - 1.0));
    let last = vec3<i32>(clamp(to_cell, vec3(0.0), cells - 1.0));
    let counts = last - first + 1;
    if counts.x > MAX_CELLS || counts.y > MAX_CELLS || counts.z > MAX_CELLS
        || counts.x * counts.y > MAX_CELLS || counts.x * counts.y * counts.z > MAX_CELLS {
        return true;
    }
    for (var z = first.z; z <= last.z; z++) {
        for (var y = first.y; y <= last.y; y++) {
            // No cell that is nearer than the distance has any.
            for (var x = first.x; x <= last.x;) {
                let distance = distance_to_occupied(vec3(x, y, z));
                let center = frame.cells_origin + (vec3(f32(x), f32(y), f32(z)) + 0.5) * cell;
                if distance == 0 && is_at_planes(center, 0.5 * cell + frame.patch_reach_voxels, planes) {
                    return true;
                }
                x += max(distance, 1);
            }
        }
    }
    return false;
}
