// The median of the 27 numbers around a voxel.

#import denoise

fn filtered(index: vec3<i32>) -> f32 {
    // Sorted from the smallest; the median is the fourteenth of 27: the larger ones need not be kept.
    var least: array<f32, 14>;
    var count = 0;
    for (var i = 0; i < 27; i++) {
        let number = number_at(index + vec3(i % 3, i / 3 % 3, i / 9) - 1);
        var k = min(count, 13);
        if count == 14 && number >= least[13] {
            continue;
        }
        while k > 0 && least[k - 1] > number {
            least[k] = least[k - 1];
            k--;
        }
        least[k] = number;
        count = min(count + 1, 14);
    }
    return least[13];
}
