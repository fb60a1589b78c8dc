//! Words of a film that go against each other.

use super::shots::{self, Film, FilmFrame};
use crate::{
    cli::{Error, flags::SceneFlags, scene_inputs},
    volume::Header,
};

/// Refuses a fit where keys say where the camera stands.
pub fn frame(scene: &SceneFlags, film: &Film) -> Result<(), Error> {
    if scene.camera.frame.is_some() && film.places_the_camera() {
        return Err(Error::usage(
            "--frame fits the camera to the volume, and a key says `eye`, `target`, `zoom` or `view_height`",
            "leave out --frame, or these words of the keys",
        ));
    }
    Ok(())
}

/// Refuses what changes one number a voxel where several are seen.
pub fn several(scene: &SceneFlags, header: &Header, shots: &[FilmFrame]) -> Result<(), Error> {
    let is_still = shots::still_time(shots).is_some();
    let is_between = |shot: &FilmFrame| shot.time.fract() != 0.0;
    if scene.input.stream
        && let Some(number) = shots.iter().position(is_between)
    {
        let time = shots[number].time;
        return Err(Error::usage(
            format!(
                "--stream: frame {number} shows time {time}, and between times there are no bricks"
            ),
            "whole times: --times; --fit draws reduced volumes that fit into memory",
        ));
    }
    let several = scene_inputs::shows_several(scene, header)?;
    if !is_still && !several && scene.labels.label_tf.is_some() {
        return Err(Error::usage(
            "--label-tf: labels of INPUT are drawn of one time",
            "--time N takes one time; --labels FILE lays a map over all of them",
        ));
    }
    let is_same = |shot: &FilmFrame| shot.classification == scene.classification;
    if several && !shots.iter().all(is_same) {
        return Err(Error::usage(
            "`window` and `tf` of keyframes are for one number a voxel, and several are drawn",
            "say it of each for the whole film: --channel 0,color=cyan,window=0:100",
        ));
    }
    Ok(())
}
