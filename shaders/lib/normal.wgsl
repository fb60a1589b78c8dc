// The distribution function of the normal distribution, Phi, by 7.1.26 of Abramowitz and Stegun, whose error function is
// off by 1.5e-7 at most. With t = 1 / (1 + p x / sqrt(2)):
//
//     1 - Phi(x) = t (a1 + t (a2 + t (a3 + t (a4 + t a5)))) e^(-x^2 / 2) / 2        x >= 0
//
// CPU reference: src/technique/splat/line.rs.

fn normal(x: vec4<f32>) -> vec4<f32> {
    let t = 1.0 / (1.0 + 0.231641888 * abs(x));
    let sum = 0.127414796 + t * (-0.142248368 + t * (0.7107068705 + t * (-0.7265760135 + t * 0.5307027145)));
    let tail = t * sum * exp(-0.5 * (x * x));
    return select(tail, 1.0 - tail, x > vec4(0.0));
}
