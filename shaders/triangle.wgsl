// A triangle in a host's picture, in the colour that is linear between those of its corners. CPU reference:
// src/geometry/triangle.rs.

#import geometry_view

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec3<f32>,
) -> @location(0) vec4<f32> {
    return opaque(color);
}
