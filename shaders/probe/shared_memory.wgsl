// Sums of all numbers up to each, in a workgroup of 128: shared memory, and barriers between its steps
// (Hillis and Steele 1986).

struct Numbers {
    d: array<u32>,
}

@group(0) @binding(0) var<storage, read> numbers: Numbers;
@group(0) @binding(1) var<storage, read_write> sums: Numbers;

var<workgroup> kept: array<u32, 128>;

@compute @workgroup_size(128)
fn main(@builtin(local_invocation_index) local: u32, @builtin(global_invocation_id) id: vec3<u32>) {
    var sum = numbers.d[id.x];
    kept[local] = sum;
    workgroupBarrier();
    for (var step = 1u; step < 128u; step *= 2u) {
        var other = 0u;
        if local >= step {
            other = kept[local - step];
        }
        workgroupBarrier();
        sum += other;
        kept[local] = sum;
        workgroupBarrier();
    }
    sums.d[id.x] = sum;
}
