// View-aligned slicing, the cover: plane forward . x = (k + 1/2) step, cut with the enlarged domain.
//
// Six vertices by the table of Rezk-Salama and Kolb ("A Vertex Program for Efficient Box-Plane
// Intersection", VMV 2005): corners are numbered from the one nearest the eye along three paths to the
// farthest one; the plane meets each path once. CPU reference: src/technique/slices_3d/cover.rs.

#import frame
#import vertex_{parameters}

// Corner j of the box as steps along x, y, z from the nearest corner.
const CORNERS = array<vec3<f32>, 8>(
    vec3(0.0, 0.0, 0.0),
    vec3(1.0, 0.0, 0.0),
    vec3(0.0, 1.0, 0.0),
    vec3(0.0, 0.0, 1.0),
    vec3(1.0, 0.0, 1.0),
    vec3(1.0, 1.0, 0.0),
    vec3(0.0, 1.0, 1.0),
    vec3(1.0, 1.0, 1.0),
);

// Vertex i: a path of three edges from corner 0 to corner 7; odd vertices try an edge of their own before it.
const EDGES = array<array<vec2<u32>, 4>, 6>(
    array(vec2(0u, 1u), vec2(1u, 4u), vec2(4u, 7u), vec2(4u, 7u)),
    array(vec2(1u, 5u), vec2(0u, 1u), vec2(1u, 4u), vec2(4u, 7u)),
    array(vec2(0u, 2u), vec2(2u, 5u), vec2(5u, 7u), vec2(5u, 7u)),
    array(vec2(2u, 6u), vec2(0u, 2u), vec2(2u, 5u), vec2(5u, 7u)),
    array(vec2(0u, 3u), vec2(3u, 6u), vec2(6u, 7u), vec2(6u, 7u)),
    array(vec2(3u, 4u), vec2(0u, 3u), vec2(3u, 6u), vec2(6u, 7u)),
);

// Four triangles of the hexagon.
const FAN = array<u32, 12>(0u, 1u, 2u, 0u, 2u, 3u, 0u, 3u, 4u, 0u, 4u, 5u);

@vertex
fn main(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> Vertex {
    let plane = frame.slice_first + i32(instance) * frame.slice_direction;
    let height = (f32(plane) + 0.5) * frame.step_world;
    var fan = FAN;
    // A slab around the eye reaches into the picture from a plane behind it.
    if abs(height - dot(frame.forward, frame.origin)) < frame.cover_eye_reach {
        // Corners 0 to 3 of the hexagon; the others fall together with the last.
        let turn = min(fan[corner], 3u);
        let is_right = turn == 1u || turn == 2u;
        return vertex_of(vec4(select(-1.0, 1.0, is_right), select(-1.0, 1.0, turn >= 2u), frame.host_near, 1.0), plane, 1.0);
    }
    let world = plane_vertex(fan[corner], height);
    return vertex_of(vec4(world, 1.0) * frame.clip_from_world, plane, 1.0);
}

// Where plane forward . x = height meets the edges of vertex i. Heights rise along a path, so its first
// edge that ends above the plane is the one, however the division rounds. A plane that misses the box
// brings all six vertices to one corner.
fn plane_vertex(i: u32, height: f32) -> vec3<f32> {
    var edges = EDGES;
    for (var e = 0u; e < 4u; e++) {
        let a = box_corner(edges[i][e].x);
        let b = box_corner(edges[i][e].y);
        let rise = dot(frame.forward, b - a);
        let part = (height - dot(frame.forward, a)) / max(rise, 1e-20);
        let is_own_edge = e == 0u && i % 2u == 1u;
        if part <= 1.0 && (part >= 0.0 || !is_own_edge) {
            return a + max(part, 0.0) * (b - a);
        }
    }
    return box_corner(7u);
}

// Corner j in world space, counted from the corner with the smallest forward . x.
fn box_corner(j: u32) -> vec3<f32> {
    var corners = CORNERS;
    let rises = frame.forward_voxel >= vec3(0.0);
    let near = select(frame.cover_max, frame.cover_min, rises);
    let far = select(frame.cover_min, frame.cover_max, rises);
    return vec4(select(near, far, corners[j] != vec3(0.0)), 1.0) * frame.world_from_voxel;
}
