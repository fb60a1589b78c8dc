//! From the flags of `--annotate` and what the volume's file says to what is drawn over its pictures.

use super::{
    Error,
    flags::{Classification, ScaleWord, SceneFlags, WithWord},
    flow::DrawnLines,
    load::open,
    look::View,
    renderer::Renderer,
    scene_inputs::SceneInputs,
};
use crate::{
    annotate::{Annotation, Facts, Seen, caption, unit},
    picture::{Picture, PictureFormat},
    technique::Mode,
    volume::Header,
};

/// Of the flags, and of what the volume's file says; `None` where none is asked for.
pub fn annotation(
    scene: &SceneFlags,
    header: &Header,
    mode: Mode,
) -> Result<Option<Annotation>, Error> {
    let flags = &scene.annotate;
    let Some(marks) = &flags.annotate else {
        return Ok(None);
    };
    flags.check()?;
    let input = &scene.input;
    let file = input.file().and_then(std::path::Path::file_name);
    let file = file.map(|name| name.to_string_lossy().into_owned());
    let name = file.or(input.path.clone()).unwrap_or_default();
    let mut facts = Facts::of(header, &name);
    if let Some(word) = scene.modes.paint(mode) {
        facts.paint = Some(paint(scene, word)?);
    }
    if scene.with.volumes().next().is_some() {
        let own = scene
            .channels
            .channel
            .len()
            .max(scene.channels.channels.len())
            .max(1);
        facts.channels.resize(own, String::new());
        if own == 1 {
            facts.channels = vec![name];
        }
        facts
            .channels
            .extend(scene.with.volumes().map(WithWord::name));
    }
    Ok(Some(Annotation {
        marks: marks.clone(),
        size: flags.annotate_size,
        color: flags
            .annotate_color
            .and_then(|word| word.0)
            .map(|color| color.0),
        is_log: flags.colormap_scale == Some(ScaleWord::Log),
        facts,
    }))
}

/// Of what colours surfaces, another variable of the file or another number of its voxels.
fn paint(scene: &SceneFlags, word: &str) -> Result<(String, Option<String>), Error> {
    if word.parse::<u32>().is_ok() {
        return Ok((format!("component {word}"), None));
    }
    let mut input = scene.input.clone();
    input.variable = Some(word.to_owned());
    let source = open(&input, &input.limits())?;
    let header = source.header();
    Ok((caption(header), unit(header)))
}

/// Lays a picture over `background`, and over both what is drawn over its view.
pub fn finish(
    picture: &mut Picture,
    annotation: Option<&Annotation>,
    shown: &SceneInputs,
    view: &View,
    renderer: &mut Renderer,
    background: Option<[f64; 4]>,
    format: PictureFormat,
) -> Result<(), Error> {
    let behind = annotation.and_then(|annotation| annotation.transmittance(picture));
    if format == PictureFormat::Png {
        picture.apply_tone(view.scene.picture.tone());
    }
    if let Some(background) = background {
        picture.over_background(background);
    }
    let Some(annotation) = annotation else {
        return Ok(());
    };
    let (classification, camera, parts) = (&shown.classification, &view.camera, shown.parts());
    // The bar of a projection needs the range of what this picture projects.
    let needs_range = annotation.marks.bar && *classification == Classification::RangeOfPicture;
    let projected = needs_range.then(|| renderer.projected_range(camera));
    let seen = Seen {
        camera,
        settings: &view.settings,
        function: classification
            .function()
            .filter(|_| !view.scene.hides_volume()),
        geometry: shown.lines().map(DrawnLines::legend).unwrap_or_default(),
        beside: parts.beside(),
        grid: shown.volume.grid(),
        height_factor: shown.height_factor,
        time: f64::from(view.scene.input.time(&shown.header)?.0),
        projected: projected.transpose()?,
    };
    Ok(annotation.put(picture, behind.as_deref(), &seen, format)?)
}
