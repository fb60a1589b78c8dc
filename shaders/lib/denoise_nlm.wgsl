// A mean of numbers that look alike with what is around them (Buades, Coll and Morel 2005): with D the mean of squared
// differences of two patches of 3^3 voxels,
//
//     f(x) + sum of w (f(y) - f(x)) / sum of w        w = exp(-D / h^2),  the own weight the largest of the others

#import denoise

fn filtered(index: vec3<i32>) -> f32 {
    let here = number_at(index);
    var own: array<f32, 27>;
    for (var i = 0; i < 27; i++) {
        own[i] = number_at(index + in_patch(i));
    }
    // What lies around is searched as far as a whole patch still fits.
    let reach = denoise.radius - 1;
    var sum = 0.0;
    var weights = 0.0;
    var largest = 0.0;
    for (var z = -reach; z <= reach; z++) {
        for (var y = -reach; y <= reach; y++) {
            for (var x = -reach; x <= reach; x++) {
                if x == 0 && y == 0 && z == 0 {
                    continue;
                }
                let there = index + vec3(x, y, z);
                var apart = 0.0;
                for (var i = 0; i < 27; i++) {
                    let difference = number_at(there + in_patch(i)) - own[i];
                    apart += difference * difference;
                }
                let weight = exp(-apart * denoise.difference_factor);
                sum += weight * (number_at(there) - here);
                weights += weight;
                largest = max(largest, weight);
            }
        }
    }
    // Where nothing is alike the number stays.
    if largest == 0.0 {
        return here;
    }
    return here + sum / (weights + largest);
}

fn in_patch(i: i32) -> vec3<i32> {
    return vec3(i % 3, i / 3 % 3, i / 9) - 1;
}
