//! Light that goes through several volumes: the device against its CPU reference, and mixtures that are the same matter as
//! one volume.

mod one_matter;
mod references;

use super::*;
use crate::occlusion;

/// Shots in which light is taken away, turn by turn by occlusion, by shadows, and by both with everything that cuts.
fn dim_shots(mode: Mode) -> impl Iterator<Item = PictureCase> {
    let shots = small_shots(GRID(), mode).into_iter().enumerate();
    shots.map(|(i, shot)| shot.with(|settings| occlusion::dim(settings, i % 3)))
}
