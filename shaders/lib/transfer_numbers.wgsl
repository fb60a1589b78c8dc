// What a transfer function is made of: src/resident/transfer.rs.

struct TransferNumbers {
    // Control points of one function or of several, then what gradients make of the first.
    d: array<vec4<f32>>,
}

@group(0) @binding(5) var<storage, read> transfer_numbers: TransferNumbers;
