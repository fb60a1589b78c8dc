// All invocations at one place: a ticket for each, the largest, the smallest, bits set and bits flipped.

struct Numbers {
    d: array<u32>,
}

struct Shared {
    next: atomic<u32>,
    largest: atomic<u32>,
    smallest: atomic<u32>,
    set_bits: atomic<u32>,
    flipped_bits: atomic<u32>,
    exchanged: atomic<u32>,
}

@group(0) @binding(0) var<storage, read> numbers: Numbers;
@group(0) @binding(1) var<storage, read_write> tickets: Numbers;
@group(0) @binding(2) var<storage, read_write> together: Shared;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let number = numbers.d[id.x];
    tickets.d[id.x] = atomicAdd(&together.next, 1u);
    atomicMax(&together.largest, number);
    atomicMin(&together.smallest, number);
    atomicOr(&together.set_bits, number);
    atomicXor(&together.flipped_bits, number);
    // One of them alone finds what was there at first.
    if atomicCompareExchangeWeak(&together.exchanged, 7u, 8u).exchanged {
        atomicAdd(&together.exchanged, 100u);
    }
}
