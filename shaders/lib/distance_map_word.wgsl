// DistanceMap of macro cells lie in words, a byte each, lowest first: a word has neighbours along x, and the last of a row
// what is left of it. A brick's words begin where its cells do, so that there are more words than are used.

const CELLS_PER_WORD: u32 = 4u;
// In place of a distance: there is matter, and samples look alike.
const HOMOGENEOUS: u32 = 255u;

fn words_along(cells: vec3<u32>) -> u32 {
    return (cells.x + CELLS_PER_WORD - 1u) / CELLS_PER_WORD;
}

// Where the word at `place` lies, its first number that of words along x.
fn distance_map_word(first: u32, cells: vec3<u32>, place: vec3<u32>) -> u32 {
    return first + place.x + words_along(cells) * (place.y + cells.y * place.z);
}

fn distances_in(word: u32) -> vec4<u32> {
    return (vec4(word) >> vec4(0u, 8u, 16u, 24u)) & vec4(255u);
}

fn packed(distances: vec4<u32>) -> u32 {
    return distances.x | (distances.y << 8u) | (distances.z << 16u) | (distances.w << 24u);
}
