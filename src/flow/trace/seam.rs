//! A line that goes around the globe, in pieces that each lie on the map.
//!
//! ```text
//! turn k = floor((x - low) / (high - low)),   drawn x = x - k (high - low)
//! ```
//!
//! Where two neighbours are of different turns, one piece ends at the seam and the next begins at its other side, both at
//! the place where their chord meets it.

use crate::flow::line::Vertex;

/// The vertices on the map, and the numbers of those that begin a new piece.
pub(super) fn split(way: Vec<Vertex>, seam: Option<[f64; 2]>) -> (Vec<Vertex>, Vec<usize>) {
    let Some([low, high]) = seam else {
        return (way, Vec::new());
    };
    let period = high - low;
    let turn = |vertex: &Vertex| ((vertex.place.x - low) / period).floor();
    let mut vertices: Vec<Vertex> = Vec::with_capacity(way.len());
    let mut breaks = Vec::new();
    let mut last: Option<Vertex> = None;
    for vertex in way {
        let here = turn(&vertex);
        if let Some(before) = last
            && turn(&before) != here
        {
            let meets = low + turn(&before).max(here) * period;
            let part = (meets - before.place.x) / (vertex.place.x - before.place.x);
            let at = |x: f64| {
                let mut place = before.place + part * (vertex.place - before.place);
                place.x = x;
                Vertex {
                    place,
                    time: before.time + part * (vertex.time - before.time),
                    speed: before.speed + part * (vertex.speed - before.speed),
                }
            };
            let [leaves, enters] = match here > turn(&before) {
                true => [high, low],
                false => [low, high],
            };
            vertices.push(at(leaves));
            breaks.push(vertices.len());
            vertices.push(at(enters));
        }
        let mut drawn = vertex;
        drawn.place.x -= here * period;
        vertices.push(drawn);
        last = Some(vertex);
    }
    (vertices, breaks)
}

#[cfg(test)]
mod tests;
