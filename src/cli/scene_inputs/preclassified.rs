//! `--preclassified`: what goes with voxels that are classified before they are interpolated.

use super::super::{
    Error,
    flags::{Classification, Component, SceneFlags},
};
use super::{Others, SceneInputs};
use crate::technique::{CutFaces, Lattice, Mode, Settings};

/// What can be said wrong before anything is opened.
pub fn check(scene: &SceneFlags, settings: &Settings) -> Result<(), Error> {
    if !scene.sampling.preclassified {
        return Ok(());
    }
    let refused = |found: &str, hint| {
        Err(Error::usage(
            format!("--preclassified is for one number a voxel in --mode composite, and {found}"),
            hint,
        ))
    };
    let several = scene.channels.are_given() || scene.input.component == Some(Component::All);
    if settings.mode != Mode::Composite {
        refused("this is another mode", "leave out --mode")
    } else if matches!(settings.cut_faces, Some(CutFaces::Grey(_))) {
        refused(
            "the greys of --cut-faces=LO,HI are of values",
            "--cut-faces shows the colours of the picture",
        )
    } else if scene.labels.labels.is_some() {
        refused("--labels lies over it", "leave out --labels")
    } else if scene.with.volumes().next().is_some() {
        refused("--with lies beside it", "leave out --with")
    } else if scene.opacity.are_given() {
        refused("other numbers make it opaque", "leave out one of them")
    } else if settings.smooth || settings.lattice == Lattice::Jitter {
        refused(
            "--smooth and --jitter sample values",
            "leave out --preclassified",
        )
    } else if several {
        refused("several are drawn", "--component 0 takes one")
    } else {
        Ok(())
    }
}

/// The same volume, whose voxels are to be classified.
pub fn classified(shown: SceneInputs) -> Result<SceneInputs, Error> {
    let Classification::Function(function) = &shown.classification else {
        unreachable!("only integrals have no function yet")
    };
    if function.uses_gradient() {
        return Err(Error::usage(
            "--preclassified classifies voxels by their value, and widgets and gradient opacity need a gradient",
            "leave out --preclassified, or take a function of the value alone",
        ));
    }
    Ok(SceneInputs {
        others: Others::Preclassified,
        ..shown
    })
}
