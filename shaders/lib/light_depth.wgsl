// What comes through to a place inside of matter, from the light volume: optical depths are interpolated between nodes,
//
//     T = exp(sum over corners of w ln T_corner)
//
// and not what comes through: exact in uniform matter, and where something opaque begins as dark inside of a cell as light
// that is followed there. CPU reference: src/technique/light_field.rs.

#import light

// ln 2^-24: nothing is darker.
const DARKEST: f32 = -16.635532;

fn scattered_light(bundle: u32, voxel: vec3<f32>, is_on: bool) -> f32 {
    let cell = light_cell(bundle, voxel);
    let corners = select(0u, 8u, is_on);
    var exponent = 0.0;
    for (var i = 0u; i < corners; i++) {
        let corner = light_corner(cell, i);
        exponent += corner.weight * max(log(max(corner.open, 1e-30)), DARKEST);
    }
    return exp(exponent);
}
