// Where the first step of a ray begins: where it enters, or by a part of a step earlier.

#import jitter

fn start_of(interval: vec2<f32>, pixel: vec2<f32>) -> f32 {
    if frame.is_jittered != 0u {
        return interval.x + (jitter_of(pixel) - 1.0) * frame.step_world;
    }
    return interval.x;
}
