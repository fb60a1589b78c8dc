// A corner of a triangle, where the host draws it.

#import geometry_view
#import geometry_vertices

struct TriangleColor {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec3<f32>,
}

@vertex
fn main(@builtin(vertex_index) index: u32) -> TriangleColor {
    let corner = vertices.all[numbers.all[index]];
    return TriangleColor(vec4(corner.place, 1.0) * view.clip_from_place, corner.color);
}
