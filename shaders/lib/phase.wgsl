// Phase functions, per steradian, of the cosine c between the directions of travel before and behind (g > 0 scatters forward):
//
//     isotropic             1 / 4 pi
//     Henyey and Greenstein (1 - g^2) / (4 pi d^(3/2))      d = (1 - g)^2 + 2 g (1 - c)
//     two lobes             f p(g1) + (1 - f) p(g2)
//     Rayleigh              3 (1 + c^2) / 16 pi
//
// CPU reference: src/technique/pathtrace/phase.rs.

#import frame

// f, g1, g2 in path_phase; in w 1 for Rayleigh.
fn phase_value(c: f32) -> f32 {
    if frame.path_phase.w != 0.0 {
        return 3.0 * (1.0 + c * c) / 50.265484;
    }
    let f = frame.path_phase.x;
    return f * lobe(frame.path_phase.y, c) + (1.0 - f) * lobe(frame.path_phase.z, c);
}

fn lobe(g: f32, c: f32) -> f32 {
    let d = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - c);
    return (1.0 - g * g) / (12.566371 * d * sqrt(d));
}

// A cosine with this density, by two numbers from 0 to 1.
fn phase_cosine(lobe_by: f32, u: f32) -> f32 {
    if frame.path_phase.w != 0.0 {
        let z = 4.0 * u - 2.0;
        let a = cube_root(abs(z) + sqrt(z * z + 1.0));
        let c = a - 1.0 / a;
        return select(c, -c, z < 0.0);
    }
    let g = select(frame.path_phase.z, frame.path_phase.y, lobe_by < frame.path_phase.x);
    if abs(g) < 0.5 {
        // The same as below without a division by g.
        let v = 2.0 * u - 1.0;
        let q = 1.0 + g * v;
        return clamp((v + 0.5 * g * (v * v + 3.0) + g * g * v + 0.5 * g * g * g * (v * v - 1.0)) / (q * q), -1.0, 1.0);
    }
    let s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    return clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
}

// Of numbers from 1 to 5, by Newton's steps.
fn cube_root(x: f32) -> f32 {
    var root = 0.6 + 0.4 * x - 0.035 * x * x;
    for (var i = 0; i < 4; i++) {
        root = (2.0 * root + x / (root * root)) / 3.0;
    }
    return root;
}
