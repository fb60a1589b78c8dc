//! One cell: which of its edges the surface crosses, and in which order around each piece of surface.
//!
//! Corner c lies at (c & 1, c >> 1 & 1, c >> 2). Edge e runs along axis e / 4 from the corner that the bits of
//! e % 4 give for the two axes behind it.

/// The corners of edge `e`, lower coordinate first.
pub(super) const fn corners_of_edge(e: usize) -> [usize; 2] {
    let axis = e / 4;
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    let from = (e % 2) << u | (e / 2 % 2) << v;
    [from, from | 1 << axis]
}

const fn edge_between(a: usize, b: usize) -> usize {
    let mut e = 0;
    loop {
        let [from, to] = corners_of_edge(e);
        if from == a && to == b || from == b && to == a {
            return e;
        }
        e += 1;
    }
}

/// Corners of each face, counter-clockwise as seen from outside the cell.
const FACES: [[usize; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

/// Edges of each face: edge i runs from corner i to the next.
const FACE_EDGES: [[usize; 4]; 6] = {
    let mut edges = [[0; 4]; 6];
    let mut face = 0;
    while face < 6 {
        let mut i = 0;
        while i < 4 {
            edges[face][i] = edge_between(FACES[face][i], FACES[face][(i + 1) % 4]);
            i += 1;
        }
        face += 1;
    }
    edges
};

/// The two faces that each edge lies in, as bits.
const FACES_OF_EDGE: [u8; 12] = {
    let mut faces = [0; 12];
    let mut face = 0;
    while face < 6 {
        let mut i = 0;
        while i < 4 {
            faces[FACE_EDGES[face][i]] |= 1 << face;
            i += 1;
        }
        face += 1;
    }
    faces
};

/// True where a line between points on two edges lies in a face: the cell behind it may have the same line.
pub(super) fn share_a_face(a: u8, b: u8) -> bool {
    FACES_OF_EDGE[a as usize] & FACES_OF_EDGE[b as usize] != 0
}

const NONE: u8 = u8::MAX;

/// Calls `piece` with the edges around each piece of the surface, counter-clockwise as seen from the side of lower
/// values. `values` are those of the corners less the level.
pub(super) fn pieces(values: [f64; 8], mut piece: impl FnMut(&[u8])) {
    let mut next = [NONE; 12];
    for (face, edges) in FACES.iter().zip(&FACE_EDGES) {
        let [a, b, c, d] = face.map(|corner| values[corner]);
        let inside = [a, b, c, d].map(|value| value >= 0.0);
        // The saddle is (ac - bd) / (a + c - b - d), whose denominator has the sign of a and c.
        let joins_inside = if inside[0] {
            a * c >= b * d
        } else {
            a * c <= b * d
        };
        // A line of the surface joins the place where a walk around the face leaves the inside with one where it
        // comes back: with the next, around an outside corner, or, of two, with the last, around an inside one.
        for i in 0..4 {
            if !inside[i] || inside[(i + 1) % 4] {
                continue;
            }
            let step = |n: usize| (i + n) % 4;
            let enters = |n: &usize| !inside[step(*n)] && inside[step(*n + 1)];
            let partner = if joins_inside {
                (1..4).find(enters)
            } else {
                (1..4).rev().find(enters)
            };
            if let Some(n) = partner {
                next[edges[step(n)]] = edges[i] as u8;
            }
        }
    }
    let mut around = [0; 12];
    for first in 0..12 {
        let mut count = 0;
        let mut at = first;
        while next[at] != NONE {
            around[count] = at as u8;
            count += 1;
            at = std::mem::replace(&mut next[at], NONE) as usize;
        }
        if count >= 3 {
            piece(&around[..count]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces_of(inside: u8, high: f64, low: f64) -> Vec<Vec<u8>> {
        let values = std::array::from_fn(|c| if inside >> c & 1 == 1 { high } else { low });
        let mut found = Vec::new();
        pieces(values, |around| found.push(around.to_vec()));
        found
    }

    #[test]
    fn every_crossed_edge_is_in_one_piece_and_no_other_edge_is() {
        for inside in 0..=255 {
            for (high, low) in [(1.0, -2.0), (2.0, -1.0)] {
                let mut seen: Vec<u8> = pieces_of(inside, high, low).concat();
                seen.sort_unstable();
                let crossed: Vec<u8> = (0..12)
                    .filter(|&e| {
                        let [a, b] = corners_of_edge(e as usize);
                        (inside >> a & 1) != (inside >> b & 1)
                    })
                    .collect();
                assert_eq!(seen, crossed, "{inside:08b}");
            }
        }
    }

    #[test]
    fn a_saddle_over_the_level_joins_what_is_inside() {
        // Corners 0 and 3 of the lower face.
        assert_eq!(pieces_of(0b1001, 1.0, -2.0).len(), 2);
        assert_eq!(pieces_of(0b1001, 2.0, -1.0).len(), 1);
        // The other diagonal.
        assert_eq!(pieces_of(0b0110, 1.0, -2.0).len(), 2);
        assert_eq!(pieces_of(0b0110, 2.0, -1.0).len(), 1);
    }
}
