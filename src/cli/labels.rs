//! A label map over a volume: read, brought to the volume's grid, given colours, and cut.

use super::{
    Error, exaggerate, flags::SceneFlags, load::say_what_was_lost, progress::Progress,
    scene_inputs::Other, timings::Loaded, untrusted,
};
use crate::{
    format,
    technique::{Mode, Role},
    transfer::{LIT_LABEL_OPACITY, LabelTable, TransferFunction},
    volume::{
        Grid, Rescale, TimeComponent, Volume, VolumeSelection, Voxels, is_same_grid,
        labels::{dim, hide, labels_of, on_grid},
    },
};
use glam::DVec3;

/// What is left of the opacity of labels that lie over a picture: both are seen.
pub const LABEL_OVER_OPACITY: f64 = 0.5;
/// Names that are said, at most.
const NAMES: usize = 4;
/// More unnamed labels than atlases have: numbers that were measured, perhaps.
const MANY: usize = 150;

/// The map that `--labels` names, on `grid`, with what it looks like. The volume is drawn so much higher than it is,
/// and the map with it.
pub fn read(
    scene: &SceneFlags,
    grid: &Grid,
    height_factor: f64,
    mode: Mode,
    progress: &Progress,
) -> Result<Other, Error> {
    let flags = &scene.labels;
    let path = flags.labels.as_deref().expect("asked for");
    let refused = |problem: &str| Error::Input {
        path: path.to_owned(),
        problem: problem.to_owned(),
    };
    let table = flags.table()?;
    let limits = scene.input.limits();
    let source = match scene.input.untrusted {
        true => untrusted::open(path, None, &VolumeSelection::default(), &limits)?,
        false => format::open(path, &VolumeSelection::default(), &limits)?,
    };
    let header = source.header();
    if header.components != 1 || header.times != 1 {
        return Err(refused(
            "a label map holds one number a voxel, of one time; this file holds several",
        ));
    }
    let (mut map, loaded) = Loaded::volume(source.as_ref(), TimeComponent::default(), &limits)?;
    progress.loaded(loaded);
    map.world_from_voxel = exaggerate::stretched(map.world_from_voxel, height_factor);
    say_what_was_lost(&map, "labels", progress);
    let mut map = placed(map, grid, progress).ok_or_else(|| {
        refused("no voxel of the volume lies in the label map: they do not overlap")
    })?;
    let present = labels_of(&map)
        .ok_or_else(|| refused("wanted whole numbers, the names of at most 2048 things"))?;
    let function = if flags.only_cut() {
        nothing()
    } else {
        let mut table = table.clone().unwrap_or_default();
        let lit = scene.is_auto().then_some(LIT_LABEL_OPACITY);
        let of_composite = table.opacity.or(flags.label_opacity).or(lit);
        let is_over = mode != Mode::Composite;
        table.opacity = if is_over { Some(1.0) } else { of_composite };
        let mut function = table.function(present.keys().copied(), diagonal(&map));
        if is_over {
            let share = flags.label_opacity.unwrap_or(LABEL_OVER_OPACITY);
            let points = function.opacity.iter_mut();
            points.for_each(|point| point.opacity *= share);
        }
        function
    };
    say_names(&present, table.as_ref(), &function, progress);
    let hides = table.as_ref().is_some_and(|table| table.hides);
    if flags.shows_some() || hides {
        let is_shown =
            |label: i64| flags.shows(label) && !(hides && function.opacity(label as f64) == 0.0);
        hide(&mut map, is_shown);
    }
    let is_dimmed = |label: &i64| flags.dims(table.as_ref(), *label);
    if present.keys().any(is_dimmed) {
        dim(&mut map, |label| is_dimmed(&label));
    }
    Ok(Other {
        volume: map,
        function,
        role: Role::Labels,
    })
}

/// Hides in `volume` what the map hides: modes but composite show what is left.
pub fn hide_in(volume: &mut Volume, map: &Volume) {
    let Some(shown) = &map.validity else {
        return;
    };
    let hidden = Volume {
        voxels: Voxels::U8(shown.iter().map(|mark| u8::from(*mark == 0)).collect()),
        rescale: Rescale::default(),
        validity: None,
        unit: None,
        ..*map
    };
    // Beyond the map nothing is hidden.
    let (hidden, _) = on_grid(&hidden, &volume.grid());
    let mut mask = volume.validity.take();
    let marks = mask.get_or_insert_with(|| vec![1; hidden.voxels.len()]);
    for (i, mark) in marks.iter_mut().enumerate() {
        if hidden.voxels.stored(i) != 0.0 {
            *mark = 0;
        }
    }
    volume.validity = mask;
}

/// World length of the diagonal of the grid.
pub fn diagonal(volume: &Volume) -> f64 {
    let far = DVec3::from_array(volume.dims.map(f64::from));
    volume.world_from_voxel.transform_vector3(far).length()
}

/// The map on the grid; `None` where they do not meet.
fn placed(map: Volume, grid: &Grid, progress: &Progress) -> Option<Volume> {
    let is_same = is_same_grid(grid, &map.grid());
    if is_same && map.validity.is_none() {
        return Some(Volume {
            world_from_voxel: grid.world_from_voxel,
            ..map
        });
    }
    let (moved, share) = on_grid(&map, grid);
    if !is_same {
        progress.note(&format!(
            "the label map lies on another grid: each voxel of the volume takes the label that its centre lies in; \
             the map covers {:.0} % of them",
            100.0 * share
        ));
    }
    (share > 0.0).then_some(moved)
}

fn say_names(
    present: &std::collections::BTreeMap<i64, u64>,
    table: Option<&LabelTable>,
    function: &TransferFunction,
    progress: &Progress,
) {
    let drawn = present
        .keys()
        .filter(|&&label| function.opacity(label as f64) > 0.0);
    let name = |label: &i64| {
        let known = table.and_then(|table| table.labels.get(label));
        let name = known.map(|label| label.name.as_str()).unwrap_or_default();
        format!("{label} {name}").trim_end().to_owned()
    };
    let names: Vec<String> = drawn.map(name).collect();
    let more = if names.len() > NAMES { ", ..." } else { "" };
    let first = names[..names.len().min(NAMES)].join(", ");
    progress.note(&match names.len() {
        0 => format!(
            "the label map holds {} labels, none is drawn",
            present.len()
        ),
        n => format!("{n} labels are drawn: {first}{more}"),
    });
    if names.len() > MANY && table.is_none() {
        progress.note("so many labels without names: is the map a scan and no map of labels?");
    }
}

/// No colour and no opacity anywhere.
fn nothing() -> TransferFunction {
    LabelTable::default().function([0].into_iter(), 512.0)
}
