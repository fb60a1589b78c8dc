//! Numbers of a row of pixels, computed with at once. Counted by hand: ranges and iterators take most of the time of a build
//! that inlines little.

/// Adds to each number what `of` says of its index.
#[inline(always)]
pub(super) fn add(numbers: &mut [f32], of: impl Fn(usize) -> f32) {
    let mut i = 0;
    while i < numbers.len() {
        numbers[i] += of(i);
        i += 1;
    }
}

/// Sets each number to that.
#[inline(always)]
pub(super) fn set(numbers: &mut [f32], of: impl Fn(usize) -> f32) {
    let mut i = 0;
    while i < numbers.len() {
        numbers[i] = of(i);
        i += 1;
    }
}
