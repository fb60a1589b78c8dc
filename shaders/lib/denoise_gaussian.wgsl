// One of the three passes of a separable Gaussian: sum of w(|k|) f(x + k e).

#import denoise

fn filtered(index: vec3<i32>) -> f32 {
    var sum = weight_of(0) * number_at(index);
    for (var k = 1; k <= denoise.radius; k++) {
        var step = vec3(0);
        step[denoise.axis] = k;
        sum += weight_of(k) * (number_at(index - step) + number_at(index + step));
    }
    return sum;
}
