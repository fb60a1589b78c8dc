//! Lines, where they end, and why.

use super::field::Absence;
use glam::DVec3;
use std::ops::Range;

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
    /// It came too near to another line.
    Crowded,
}

impl End {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 10] = [
        Self::Absence(Absence::Domain),
        Self::Absence(Absence::Ground),
        Self::Absence(Absence::NoData),
        Self::Absence(Absence::Pole),
        Self::Stagnation,
        Self::Closed,
        Self::Length,
        Self::Time,
        Self::Vertices,
        Self::Crowded,
    ];

    /// The word of files and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Absence(Absence::Domain) => "domain",
            Self::Absence(Absence::Ground) => "ground",
            Self::Absence(Absence::NoData) => "no-data",
            Self::Absence(Absence::Pole) => "pole",
            Self::Stagnation => "stagnation",
            Self::Closed => "closed",
            Self::Length => "length",
            Self::Time => "time",
            Self::Vertices => "vertices",
            Self::Crowded => "crowded",
        }
    }

    /// The number of files: 1 for `domain`, and so on in the order of [`Self::ALL`].
    pub fn number(self) -> u8 {
        let at = Self::ALL.iter().position(|&other| other == self);
        at.map_or(0, |at| at as u8 + 1)
    }
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
    /// Numbers of the vertices that begin a new piece: the line has no chord to them.
    pub breaks: Vec<usize>,
    /// Why it begins where it does, and why it ends; `None` where it was not followed that way.
    pub ends: [Option<End>; 2],
}

impl Line {
    /// The vertices of each piece that has a chord.
    pub fn pieces(&self) -> impl Iterator<Item = &[Vertex]> {
        self.piece_ranges().map(|range| &self.vertices[range])
    }

    /// The numbers of its vertices, of each piece that has a chord.
    pub fn piece_ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let starts = std::iter::once(0).chain(self.breaks.iter().copied());
        let ends = self.breaks.iter().copied().chain([self.vertices.len()]);
        starts
            .zip(ends)
            .map(|(start, end)| start..end)
            .filter(|range| range.len() > 1)
    }
}
