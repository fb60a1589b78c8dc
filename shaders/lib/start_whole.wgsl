// The first step of each ray begins where it enters.

fn start_of(interval: vec2<f32>, pixel: vec2<f32>) -> f32 {
    return interval.x;
}
