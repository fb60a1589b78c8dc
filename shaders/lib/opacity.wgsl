// Opacity of a segment: alpha = 1 - exp(-sigma d). Under 0.01 the series, because 1 - exp(-x) cancels
// (`sampling.md` 4). CPU reference: src/transfer/law.rs.

fn opacity_over(extinction: f32, length_world: f32) -> f32 {
    let depth = extinction * length_world;
    if depth < 0.01 {
        return depth * (1.0 - depth * (0.5 - depth / 6.0));
    }
    return 1.0 - exp(-depth);
}
