// The norm of a vector and its direction. `length`, `normalize` and `mix` are instructions that a driver expands in a way
// of its own in each program. Written out, their arithmetic is rounded alike in all of them
// (`shaders/no_contraction.rs`).

fn norm(vector: vec3<f32>) -> f32 {
    return sqrt(dot(vector, vector));
}

fn direction_of(vector: vec3<f32>) -> vec3<f32> {
    return vector * inverseSqrt(dot(vector, vector));
}
