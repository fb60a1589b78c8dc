// The axis that a ray runs along most. CPU reference: src/lattice.rs.

// Of axes whose slopes differ by less the lowest is taken: rounding does not choose among those that are equal.
const MAIN_AXIS_SHARE: f32 = 0.9999847412109375;

fn main_axis_of(direction: vec3<f32>) -> u32 {
    let slopes = abs(direction);
    let enough = MAIN_AXIS_SHARE * max(slopes.x, max(slopes.y, slopes.z));
    return select(select(2u, 1u, slopes.y >= enough), 0u, slopes.x >= enough);
}
