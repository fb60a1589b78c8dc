// The colour of the triangle.

@fragment
fn main(@location(0) @interpolate(flat) color: vec4<f32>) -> @location(0) vec4<f32> {
    return color;
}
