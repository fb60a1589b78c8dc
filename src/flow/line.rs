//! Lines, where they end, and why.

use super::field::Absence;
use glam::DVec3;

/// Which way from the seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Both: the seed lies inside of the line.
    #[default]
    Both,
    /// Along the velocity.
    Forward,
    /// Against it.
    Backward,
}

/// Why a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// There is no velocity farther on.
    Absence(Absence),
    /// It is a million times slower than the fast places of the field, or stays where it is.
    Stagnation,
    /// It came back to its seed, and is closed.
    Closed,
    /// It is as long as lines may be.
    Length,
    /// It was followed for as long as was asked for, or to the last time of the field.
    Time,
    /// It has as many vertices as lines may have.
    Vertices,
}

/// How far lines are followed, each way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// World length.
    pub length: f64,
    /// Seconds.
    pub duration: f64,
    /// Vertices.
    pub vertices: usize,
    /// What a step may be off by, in cells.
    pub tolerance: f64,
}

impl Default for Limits {
    /// 4000 vertices, a thousandth of a cell a step.
    fn default() -> Self {
        Self {
            length: f64::INFINITY,
            duration: f64::INFINITY,
            vertices: 4000,
            tolerance: 1e-3,
        }
    }
}

/// A place of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// In the world, before heights are exaggerated.
    pub place: DVec3,
    /// Seconds; of a stream line those since its seed, negative before it.
    pub time: f64,
    /// True speed, m/s where that is known.
    pub speed: f64,
}

/// A line through a seed, along the velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Number of its seed.
    pub seed: usize,
    /// In the order of time; none where there is no velocity at the seed.
    pub vertices: Vec<Vertex>,
    /// Why it begins where it does, and why it ends; `None` where it was not followed that way.
    pub ends: [Option<End>; 2],
}
