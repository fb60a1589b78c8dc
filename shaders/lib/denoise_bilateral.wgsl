// A mean of neighbours that are near in place and in number (Tomasi and Manduchi 1998).

#import denoise

fn filtered(index: vec3<i32>) -> f32 {
    let here = number_at(index);
    let reach = denoise.radius;
    var sum = 0.0;
    var weights = 0.0;
    for (var z = -reach; z <= reach; z++) {
        for (var y = -reach; y <= reach; y++) {
            for (var x = -reach; x <= reach; x++) {
                // The mean is taken of differences: equal numbers stay exactly what they are.
                let difference = number_at(index + vec3(x, y, z)) - here;
                let near = weight_of(x) * weight_of(y) * weight_of(z);
                let weight = near * exp(-difference * difference * denoise.difference_factor);
                sum += weight * difference;
                weights += weight;
            }
        }
    }
    return here + sum / weights;
}
