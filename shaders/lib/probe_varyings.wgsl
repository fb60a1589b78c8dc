struct Varyings {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(perspective) perspective: f32,
    @location(1) @interpolate(linear) linear: f32,
    @location(2) @interpolate(flat) first: f32,
}
