//! Surfaces and points of `--with FILE` beside a volume.
//!
//! ```text
//! drawn world from file   heights stretched * shift * transform
//! points of the Earth     their degrees on the map of the volume, their heights in its unit
//! ```

use super::super::{Error, flags::SceneFlags, flags::WithWord, map::OnEarth, progress::Progress};
use super::drawn::{DrawnLines, LineSet};
use super::surface::Surface;
use crate::annotate::{ColorLegend, caption, unit};
use crate::cli::shape::Shape;
use crate::color::decode_srgb;
use crate::format::points::PointFile;
use crate::points::Points;
use crate::transfer::{Classified, Colormap, Window};
use crate::volume::{Grid, Header, Source};
use glam::{DAffine3, DVec3};

/// sRGB of a surface that has no colour.
const GREY: f32 = 0.8;
const COLORMAP: &str = "viridis";

impl DrawnLines {
    /// All surfaces and points of the words.
    pub(super) fn add_shapes(
        &mut self,
        scene: &SceneFlags,
        header: &Header,
        stretch: DVec3,
        progress: &Progress,
    ) -> Result<(), Error> {
        let limits = scene.input.limits();
        let section = &scene.section;
        let in_a_plane = section.half_thickness() == Some(0.0);
        for word in scene.with.shapes() {
            let drawn_from_file = DAffine3::from_scale(stretch) * word.moved(DAffine3::IDENTITY)?;
            let one = word.color.map(|color| color.map(|c| decode_srgb(c as f32)));
            match word.shape(&limits)? {
                Shape::Surface(_) if in_a_plane => {
                    return Err(Error::usage(
                        format!(
                            "--with {} with --section: a plane meets a surface in a line without a width",
                            word.name()
                        ),
                        "--thickness shows what of it lies in a slab",
                    ));
                }
                Shape::Surface(file) => {
                    let grey = [decode_srgb(GREY); 3];
                    let surface = Surface::of(file, drawn_from_file, one, grey);
                    progress.note(&format!(
                        "with {}, {} triangles{}",
                        word.name(),
                        surface.triangles.len(),
                        beside(surface.bounds(), header, stretch)
                    ));
                    self.surfaces.push(surface);
                }
                Shape::Points(_) if scene.section.section.is_some() => {
                    return Err(Error::usage(
                        format!(
                            "--with {} with --section: its spheres are symbols, and no plane cuts them",
                            word.name()
                        ),
                        "leave out one of them",
                    ));
                }
                Shape::Points(file) => {
                    let points = placed(file, word, header)?;
                    let places = points.places().iter();
                    let places = places.map(|&place| drawn_from_file.transform_point3(place));
                    let places: Vec<DVec3> = places.collect();
                    let bounds = [
                        places.iter().copied().fold(DVec3::INFINITY, DVec3::min),
                        places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max),
                    ];
                    progress.note(&format!(
                        "with {}, {} points{}",
                        word.name(),
                        places.len(),
                        beside(bounds, header, stretch)
                    ));
                    let left_out = file.points().len() - places.len();
                    if left_out > 0 {
                        progress.note(&format!(
                            "with {}, points without a place on the map of the volume: {left_out}; they are left out",
                            word.name()
                        ));
                    }
                    let legend = legend(word, &points, file);
                    let planes = scene.sampling.clip_planes()?;
                    let is_kept = |place: DVec3| {
                        let mut planes = planes.iter();
                        planes.all(|plane| plane.normal.dot(place) >= plane.offset)
                    };
                    let color = |value: f64| {
                        let of_value = legend.function.srgb(value);
                        one.unwrap_or(of_value.map(|c| decode_srgb(c as f32)))
                    };
                    let width = scene.point_look.sphere_size;
                    let values = points.values().iter().copied().map(f64::from);
                    let all = places.into_iter().zip(values);
                    let kept = all.filter(|(place, _)| is_kept(*place));
                    self.sets
                        .push(LineSet::of_points(kept, points.value_range(), color, width));
                    if one.is_none() {
                        self.points.get_or_insert(legend);
                    }
                }
            }
        }
        Ok(())
    }
}

/// What to say where nothing of it lies in the box of the volume.
fn beside([low, high]: [DVec3; 2], header: &Header, stretch: DVec3) -> &'static str {
    let grid = Grid {
        dims: header.dims,
        world_from_voxel: DAffine3::from_scale(stretch) * header.world_from_voxel,
    };
    let far = grid.far_corner();
    let corners = (0..8).map(|i| {
        let bit = |k: usize| if i >> k & 1 == 1 { far[k] } else { 0.0 };
        let voxel = DVec3::new(bit(0), bit(1), bit(2));
        grid.world_from_voxel.transform_point3(voxel)
    });
    let (first, last) = corners.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(first, last), corner| (first.min(corner), last.max(corner)),
    );
    match low.cmple(last).all() && high.cmpge(first).all() {
        true => "",
        false => ": it lies outside of the box of the volume",
    }
}

/// The points in the world of the volume.
fn placed(file: &PointFile, word: &WithWord, header: &Header) -> Result<Points, Error> {
    let own = file.header();
    let points = (**file.points()).clone();
    if !own.is_earth {
        return Ok(points);
    }
    let refused = |problem: &str| {
        Error::usage(
            format!("--with {}: {problem}", word.name()),
            "columns x, y, z are places of the world of the volume",
        )
    };
    let on_earth = OnEarth::of(header);
    let on_earth = on_earth.ok_or_else(|| {
        refused("its points have degrees, and the volume has no place on the Earth that is known")
    })?;
    let [Some(along_x), Some(along_y)] = own.degree_lengths else {
        return Err(refused("its points have no degrees"));
    };
    let metres = own.length_metres.zip(header.height_metres());
    let (from, to) =
        metres.ok_or_else(|| refused("its points have heights, and the volume has none"))?;
    let place = |place: &DVec3| {
        let degrees = [place.x / along_x, place.y / along_y];
        let [x, y] = on_earth.place(degrees)?;
        Some(DVec3::new(x, y, place.z * from / to))
    };
    let placed = points.places().iter().zip(points.values());
    let placed = placed.filter_map(|(at, &value)| Some((place(at)?, value)));
    let (places, values): (Vec<DVec3>, Vec<f32>) = placed.unzip();
    let placed = Points::new(places, values, None, None);
    placed.map_err(|problem| refused(&problem.to_string()))
}

/// What the colours of the values mean.
fn legend(word: &WithWord, points: &Points, file: &PointFile) -> ColorLegend {
    let range = Window::of_range(points.value_range());
    let window = word.window.and_then(|[low, high]| Window::new(low, high));
    let map = word.colormap.as_deref();
    let map = map.and_then(|name| name.parse::<Colormap>().ok());
    let map = map.or_else(|| Colormap::from_name(COLORMAP));
    let function = range.grey(Classified::Projection);
    ColorLegend {
        function: match map {
            Some(map) => function.with_colormap(map, window),
            None => function,
        },
        caption: caption(file.header()),
        unit: unit(file.header()),
    }
}
