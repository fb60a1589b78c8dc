//! A scene to a picture on the CPU: every technique by its CPU reference, in f32 or f64, no Vulkan anywhere.

mod half_angle;
mod light;
mod material;
mod mixture;
mod normals;
mod samples;

use super::behind;
use super::fade::{faded, stacks_of};
use super::gathered::{grey_of_picture, layers};
use super::sum::sum_of;
use crate::geometry::{Geometry, Seen};
use crate::picture::Picture;
use crate::points::PointField;
use crate::real::{Real, scale};
use crate::resolve::reference::{light_at, premultiplied};
use crate::scene::{Beside, LabelsOver, Scene, positions_in_pixel};
use crate::shaders::Frame;
use crate::technique::composite::Composite;
use crate::technique::faces::{FACE_LENGTH, cut_face, on_face};
use crate::technique::mixture::color_of;
use crate::technique::own_grid::{ChannelGrids, place_in_channel};
use crate::technique::pathtrace::{
    Guide, PathTracing, denoised, guide_of, half_of_path, left_of_half,
};
use crate::technique::reference::{Gathered, Samples, moved};
use crate::technique::shading::shade;
use crate::technique::splat::ViewPoints;
use crate::technique::{
    AlikeCells, Error, GradientSource, InPixel, LightField, Mode, Recording, Role, SampleInputs,
    Settings, isosurface,
};
use crate::transfer::{
    Absorption, PackedWidgets, Points, SlabTable, Table, TransferFunction, classify_by_points,
    classify_by_table, classify_slab,
};
use crate::volume::{Coefficients, Grid, Volume};
use glam::DVec4;
use light::light_of;
use material::{gradient_at, steepness};
use mixture::marks_of_scene;
pub(super) use normals::normals;
use samples::{filtered, filtered_in_slice};

/// The picture of `scene` with all layers that its technique has.
///
/// # Errors
/// Those of the parameters, too many samples or clip planes, and of volumes that cannot be put together.
pub fn render<R: Real>(scene: &Scene) -> Result<Picture, Error> {
    render_with::<R>(scene, None)
}

/// The same with geometry in the picture.
///
/// # Errors
/// Those of [`render`] and of [`check_geometry`](super::check_geometry).
pub fn render_with<R: Real>(scene: &Scene, geometry: Option<&Geometry>) -> Result<Picture, Error> {
    scene.check()?;
    if geometry.is_some() {
        behind::check_geometry(scene.settings)?;
    }
    if let Some(law) = scene.law()? {
        let made = law.volumes(scene.volume)?;
        let [red, beside @ ..] = made.each_ref();
        let classified = Scene {
            volume: red,
            beside: Beside::Classified(&beside),
            ..*scene
        };
        return render_with::<R>(&classified, geometry);
    }
    let labels = scene.labels_over();
    let mut picture = render_unlabeled::<R>(&scene.under_labels(), geometry)?;
    for map in labels {
        if let Some(over) = LabelsOver::new(scene, map) {
            // Labels lie over the geometry too.
            over.lay(scene, map, &mut picture, |scene| {
                render_one::<R>(scene, None)
            })?;
        }
    }
    if let Some(geometry) = geometry {
        behind::bring_nearer(geometry, scene, &mut picture.layers);
        picture.layers.push(behind::lines(geometry, scene));
    }
    Ok(picture)
}

/// The same without labels over it.
fn render_unlabeled<R: Real>(scene: &Scene, geometry: Option<&Geometry>) -> Result<Picture, Error> {
    let stacks = stacks_of(scene);
    if !stacks.is_empty() {
        return faded(stacks.iter().map(|(settings, share)| {
            let picture = render_one::<R>(&Scene { settings, ..*scene }, geometry)?;
            Ok((picture, *share))
        }));
    }
    if scene.mix() == SampleInputs::Channels && scene.settings.mode.is_projection() {
        let pictures = scene.projected().into_iter();
        let mut sum = sum_of(pictures.map(|one| render_one::<R>(&one, None)))?;
        put_over(scene, geometry, &mut sum);
        return Ok(sum);
    }
    render_one::<R>(scene, geometry)
}

/// Lays geometry over the picture of a mode that projects.
fn put_over(scene: &Scene, geometry: Option<&Geometry>, picture: &mut Picture) {
    if let Some(geometry) = geometry.filter(|_| scene.settings.mode.is_projection()) {
        behind::put_over(scene, picture, |at| behind::seen(geometry, scene, at));
    }
}

/// Paths in two halves, and what both say without noise.
fn render_denoised<R: Real>(scene: &Scene) -> Result<Picture, Error> {
    let path = &scene.settings.path;
    let of_paths = |first_sample, samples| {
        let settings = &Settings {
            path: PathTracing {
                first_sample,
                samples,
                denoise: false,
                ..path.clone()
            },
            ..scene.settings.clone()
        };
        render_gathered::<R>(&Scene { settings, ..*scene }, None)
    };
    let mut halves: [Option<OfPaths<R>>; 2] = [None, None];
    let mut traced = 0;
    while traced < path.samples {
        let number = path.first_sample + traced;
        let count = left_of_half(number).min(path.samples - traced);
        let (picture, gathered) = of_paths(number, count)?;
        let half = &mut halves[half_of_path(number)];
        *half = Some(match half.take() {
            None => (picture, gathered, count),
            Some(before) => joined(before, (picture, gathered, count)),
        });
        traced += count;
    }
    let [Some(first), Some(second)] = halves else {
        // All are of one half, which does not tell what is noise.
        let (picture, _) = of_paths(path.first_sample, path.samples)?;
        return Ok(picture);
    };
    let (first, of_first, in_first) = first;
    let (second, of_second, in_second) = second;
    let counts = [in_first, in_second];
    let guides = [&of_first, &of_second].map(|half| guides_of(half));
    let pixels = denoised(
        [&first.pixels, &second.pixels],
        [&guides[0], &guides[1]],
        first.width as usize,
    );
    let pairs = of_first.into_iter().zip(of_second);
    let all: Vec<_> = pairs.map(|both| mean_of_paths(both, counts)).collect();
    let layers = layers(scene, &all)?;
    Ok(Picture {
        pixels,
        layers,
        ..first
    })
}

/// A picture of so many paths, and what they have left for it.
type OfPaths<R> = (Picture, Vec<Gathered<R>>, u32);

/// The mean of all paths of both.
fn joined<R: Real>((a, of_a, in_a): OfPaths<R>, (b, of_b, in_b): OfPaths<R>) -> OfPaths<R> {
    let counts = [in_a, in_b];
    let [u, v] = counts.map(|count| f64::from(count) / f64::from(in_a + in_b));
    let mean = |(a, b): (&[f32; 4], &[f32; 4])| {
        std::array::from_fn(|c| (u * f64::from(a[c]) + v * f64::from(b[c])) as f32)
    };
    let pixels = a.pixels.iter().zip(&b.pixels).map(mean).collect();
    let gathered = of_a.into_iter().zip(of_b);
    let gathered = gathered.map(|both| mean_of_paths(both, counts)).collect();
    (Picture { pixels, ..a }, gathered, in_a + in_b)
}

/// What paths leave for the filter.
fn guides_of<R: Real>(gathered: &[Gathered<R>]) -> Vec<Guide> {
    let guide = |g: &Gathered<R>| guide_of(&g.paths.unwrap_or_default());
    gathered.iter().map(guide).collect()
}

/// Of so many paths and so many others.
fn mean_of_paths<R: Real>((a, b): (Gathered<R>, Gathered<R>), counts: [u32; 2]) -> Gathered<R> {
    let all = f64::from(counts[0]) + f64::from(counts[1]);
    let [u, v] = counts.map(|count| f64::from(count) / all);
    let colors = std::array::from_fn(|c| {
        R::from_f64(u) * a.accumulation[c] + R::from_f64(v) * b.accumulation[c]
    });
    let mean = |a: f32, b: f32| (u * f64::from(a) + v * f64::from(b)) as f32;
    let [a, b] = [a, b].map(|g| g.paths.unwrap_or_default());
    let images = std::array::from_fn(|i| std::array::from_fn(|c| mean(a[i][c], b[i][c])));
    Gathered::of_paths(colors, images)
}

fn render_one<R: Real>(scene: &Scene, geometry: Option<&Geometry>) -> Result<Picture, Error> {
    let settings = scene.settings;
    if settings.technique.traces_paths() && settings.path.denoise {
        return render_denoised::<R>(scene);
    }
    let (picture, _) = render_gathered::<R>(scene, geometry)?;
    Ok(picture)
}

/// The picture, and what the rays through the middles of pixels have left for it.
fn render_gathered<R: Real>(
    scene: &Scene,
    geometry: Option<&Geometry>,
) -> Result<(Picture, Vec<Gathered<R>>), Error> {
    R::begin();
    let grid = scene.volume.grid();
    let mode = scene.settings.mode;
    // What the device has in place of the voxels of interpolating splines.
    let axes = scene.view(&grid, [0.0; 2]).texture_layout().filtered_axes();
    let spline = scene.settings.filter.spline();
    let coefficients = spline.map(|spline| Coefficients::new(scene.volume, spline, axes));
    let read = coefficients.as_ref().map(Coefficients::volume);
    let source = scene.settings.gradient_source();
    let source = source.filter(|_| scene.has_gradients());
    let of_gradients = source.and_then(GradientSource::spline);
    let of_gradients =
        of_gradients.map(|spline| Coefficients::new(scene.volume, spline, [true; 3]));
    let of_gradients = of_gradients
        .as_ref()
        .map_or(scene.volume, Coefficients::volume);
    let gradients = source.map(|_| of_gradients);
    let light = light_of::<R>(scene, read, gradients, &grid)?;
    let field = scene.point_field();
    let gathered = |in_pixel: InPixel, seen: Option<&Seen>| -> Result<_, Error> {
        let rays =
            ReferenceRays::new(scene, read, light.as_ref(), field.as_ref(), &grid, in_pixel)?;
        let mut rays = ReferenceRays { gradients, ..rays };
        if let Some(seen) = seen {
            rays.end_at(in_pixel, seen);
        }
        if scene.settings.is_half_angle() {
            let [_, light] = scene.view(&grid, in_pixel).half_angle_on_cpu()?;
            return Ok(rays.gather_in_light(&light));
        }
        Ok(rays.gather_all())
    };
    let geometry_behind = geometry.filter(|_| !mode.is_projection());
    let look = |in_pixel| geometry_behind.map(|geometry| behind::seen(geometry, scene, in_pixel));
    let seen_of_centers = look(InPixel::CENTER);
    let centers = gathered(InPixel::CENTER, seen_of_centers.as_ref())?;
    let transfer = match scene.transfer {
        Some(transfer) => transfer.clone(),
        None => grey_of_picture(mode, &centers),
    };
    let space = scene.settings.color_space;
    let points = Points::new(&transfer, Absorption::Opacity, space);
    let is_shared = scene.settings.technique.is_warped() && mode.projects_one_place();
    let resolve = |g: &Gathered<R>| {
        R::begin();
        let [red, green, blue, alpha] =
            premultiplied(mode, g.accumulation, |v| classify_by_points(&points, v));
        let lit = [g.light * red, g.light * green, g.light * blue, alpha];
        match is_shared {
            // `resolve_covered.wgsl`.
            true => lit.map(|number| g.accumulation[1] * number),
            false => lit,
        }
    };

    let per_side = scene.settings.rays_per_side;
    let weight = R::from_f64(1.0 / f64::from(per_side * per_side));
    let mut pixels = vec![[R::from_f64(0.0); 4]; centers.len()];
    for in_pixel in positions_in_pixel(scene.settings) {
        let (found, seen) = if in_pixel == InPixel::CENTER {
            (centers.clone(), seen_of_centers.clone())
        } else {
            let seen = look(in_pixel);
            (gathered(in_pixel, seen.as_ref())?, seen)
        };
        let mut colors: Vec<_> = found.iter().map(resolve).collect();
        if let Some(seen) = seen {
            behind::put(&seen, &mut colors, space);
        }
        for (pixel, color) in pixels.iter_mut().zip(colors) {
            let color = color.map(R::ended);
            *pixel = std::array::from_fn(|c| pixel[c] + weight * color[c]);
        }
    }
    let [width, height] = scene.extent_pixels;
    let mut picture = Picture {
        width,
        height,
        pixels: pixels.iter().map(|pixel| pixel.map(R::to_f32)).collect(),
        color_space: space,
        layers: layers(scene, &centers)?,
    };
    put_over(scene, geometry, &mut picture);
    Ok((picture, centers))
}

/// The rays of all pixels of a picture.
struct ReferenceRays<'a, R> {
    scene: &'a Scene<'a>,
    volumes: Vec<&'a Volume>,
    roles: Vec<Role>,
    /// What gradients are made of, where that is not values as the filter makes them.
    gradients: Option<&'a Volume>,
    /// Which voxels of label maps are dimmed, by their channels.
    marks: Vec<(usize, Volume)>,
    /// One a transfer function; none in a projecting mode, which classifies when it resolves.
    classifiers: Vec<Classifier>,
    /// What colours surfaces by another volume.
    paint: Option<Points>,
    /// Of a picture of light that scatters, what the function says of it.
    medium: Option<Points>,
    /// What the gradient makes of the only function, where it makes something.
    widgets: Option<PackedWidgets>,
    frame: Frame,
    /// Where one sample stands for others, where steps adapt.
    alike: Option<AlikeCells>,
    /// What comes through to samples, where occlusion or shadows are asked for.
    light: Option<&'a LightField<R>>,
    /// The scattered points that are splatted.
    points: Option<ViewPoints>,
    /// The field of scattered points that rays are cast through.
    field: Option<&'a PointField>,
    /// Slices to draw; a ray caster has none.
    slices: u32,
    /// The depths at which the rays of pixels end, where something is drawn beside the volume.
    ends: Option<Vec<f32>>,
}

/// Conformance pictures search the points, the others look into the table: both as the shaders do.
enum Classifier {
    Table(Table),
    Points(Points),
    /// The same table in both, with the integrals of slabs.
    Slabs(SlabTable),
}

impl<'a, R: Real> ReferenceRays<'a, R> {
    /// `read`: what is filtered in place of the volume, where there is but one.
    fn new(
        scene: &'a Scene<'a>,
        read: Option<&'a Volume>,
        light: Option<&'a LightField<R>>,
        field: Option<&'a PointField>,
        grid: &'a Grid,
        in_pixel: InPixel,
    ) -> Result<Self, Error> {
        let view = scene.view(grid, in_pixel);
        let space = scene.settings.color_space;
        let classifier = |function: Option<&TransferFunction>| {
            let function = function.ok_or(Error::NoTransferFunction)?;
            let absorption = scene.absorption(function);
            Ok(if scene.settings.preintegrated {
                Classifier::Slabs(SlabTable::new(function, absorption, space))
            } else if scene.settings.conformance {
                Classifier::Points(Points::new(function, absorption, space))
            } else {
                Classifier::Table(Table::new(function, absorption, space))
            })
        };
        let classifiers = if scene.settings.mode.has_value() {
            Vec::new()
        } else {
            let functions = scene.transfers().into_iter();
            functions.map(classifier).collect::<Result<_, Error>>()?
        };
        let widgets = scene.transfer.filter(|_| scene.mix().uses_gradient());
        let widgets = widgets.map(|f| PackedWidgets::new(f, scene.length_of(f), space));
        let Recording {
            mut frame, slices, ..
        } = view.on_cpu()?;
        let grids = scene.volumes().into_iter().map(Volume::grid);
        let ChannelGrids { from_voxel, dims } = ChannelGrids::new(&scene.volume.grid(), grids);
        (frame.channel_from_voxel, frame.channel_dims) = (from_voxel, dims);
        let ranges = scene.volumes().into_iter().map(|volume| volume.value_range);
        frame.channel_gradient_scale = view.gradient_scales(ranges.zip(scene.roles()));
        frame.flat_gradient = view.flat_gradient(scene.volume.value_range);
        frame.reference_length = scene.reference_length() as f32;
        let medium = scene.transfer.filter(|_| scene.settings.scatters());
        let medium = medium.map(|f| Points::new(f, scene.absorption(f), space));
        if let (Some(points), Some(function)) = (&medium, scene.transfer) {
            let medium = function.medium.as_ref();
            let is_colored = medium.is_some_and(|medium| medium.has_colored_extinction());
            frame.emission_point_count = points.emission_count;
            frame.extinction_is_colored = is_colored.into();
        }
        scene.tell_paths(&mut frame, u32::MAX)?;
        if let Some(field) = field {
            view.tell_field(field, &mut frame);
        }
        Ok(Self {
            scene,
            volumes: read.map_or_else(|| scene.volumes(), |read| vec![read]),
            roles: scene.roles(),
            gradients: None,
            marks: marks_of_scene(scene),
            classifiers,
            paint: paint_of(scene),
            medium,
            widgets,
            alike: scene
                .alike()
                .map(|alike| AlikeCells::new(scene.volume, &alike)),
            frame,
            light,
            points: match scene.beside {
                Beside::Points(points) if scene.settings.field.is_none() => {
                    Some(ViewPoints::new(&view, points)?)
                }
                _ => None,
            },
            field,
            slices,
            ends: None,
        })
    }

    /// Ends rays at what is seen.
    fn end_at(&mut self, in_pixel: InPixel, seen: &Seen) {
        let depth = behind::line_of_sight(self.scene);
        let row = |row: DVec4| row.as_vec4().to_array();
        let centered = depth.centered(self.scene.volume.grid().center());
        self.frame.has_host_depth = 1;
        (self.frame.host_z, self.frame.host_w) = (row(centered.z), row(centered.w));
        self.ends = Some(behind::depths(&depth, self.scene, in_pixel, seen));
    }

    /// All pixels, rows shared out among the machine's cores.
    fn gather_all(&self) -> Vec<Gathered<R>> {
        let [width, height] = self.scene.extent_pixels;
        let threads = std::thread::available_parallelism()
            .map_or(1, |n| n.get() as u32)
            .min(height.max(1));
        let rows = |first: u32| {
            let mine = (first..height).step_by(threads as usize);
            mine.map(|y| (0..width).map(|x| self.gather(x, y)).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        let mut shares = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|first| scope.spawn(move || rows(first)))
                .collect();
            let joined = workers
                .into_iter()
                .map(|worker| worker.join().expect("a pixel does not panic"));
            joined.map(Vec::into_iter).collect::<Vec<_>>()
        });
        (0..height as usize)
            .flat_map(|y| shares[y % threads as usize].next().expect("every row"))
            .collect()
    }

    fn gather(&self, x: u32, y: u32) -> Gathered<R> {
        R::begin();
        let pixel = [x, y].map(|n| R::from_f64(f64::from(n)) + R::from_f64(0.5));
        let found = match self.scene.settings.mode {
            Mode::Iso => self.surfaces(pixel),
            mode if mode.is_projection() => {
                let found = self.samples(pixel);
                let light = found.depth.map(|t| light_at(&self.frame, t));
                Gathered {
                    light: light.unwrap_or(found.light),
                    ..found
                }
            }
            _ => self.composite(pixel),
        };
        Gathered {
            accumulation: found.accumulation.map(R::ended),
            depth: found.depth.map(R::ended),
            ..found
        }
    }

    /// The surfaces that a ray meets.
    fn surfaces(&self, pixel: [R; 2]) -> Gathered<R> {
        let (frame, filter) = (&self.frame_of(pixel), self.scene.settings.filter);
        let value_at = |p| filtered(self.volumes[0], filter, p);
        let lit = |own: [R; 3], p, ray_direction| {
            let other = self.volumes.get(1).zip(self.paint.as_ref());
            let color = other.and_then(|(volume, points)| {
                let own = place_in_channel(frame, 1, p)?;
                let [r, g, b, _] = classify_by_points(points, filtered(volume, filter, own)?);
                Some([r, g, b])
            });
            let color = color.unwrap_or(own);
            let lamps = self.lamps(p, ray_direction);
            if frame.light_count == 0 {
                return scale(color, lamps.ambient(frame));
            }
            let gradient = self.gradient(p, |step| value_at(moved(p, step)));
            shade(frame, color, gradient, &lamps)
        };
        let found = isosurface::surfaces(frame, pixel, value_at, lit);
        Gathered::of_surfaces(found)
    }

    /// Emission and absorption of what the volumes are made of together, behind what a cut has laid bare.
    fn composite(&self, pixel: [R; 2]) -> Gathered<R> {
        let Some((t, p)) = cut_face(&self.frame_of(pixel), pixel) else {
            return self.samples(pixel);
        };
        // No light falls along no direction.
        let own = self.material(p, [R::from_f64(0.0); 3]);
        let mut face = Composite::default();
        if let Some(own) = own {
            let material = on_face(&self.frame, own, self.value_on_face(p));
            face.add(material, R::from_f32(FACE_LENGTH), t);
        }
        if face.transmittance == R::from_f64(0.0) {
            return Gathered::of_composite((face, 1));
        }
        let mut found = self.samples(pixel);
        found.samples += 1.0;
        found
    }

    /// What the greys of a cut face are of: the first volume, or what the opacity of colours is classified by.
    fn value_on_face(&self, p: [R; 3]) -> R {
        let zero = R::from_f64(0.0);
        let number = |volume: &Volume| {
            let found = filtered(volume, self.scene.settings.filter, p);
            found.unwrap_or(zero)
        };
        match (self.scene.beside, &self.volumes[..]) {
            (Beside::Colors(_), [r, g, b, rest @ ..]) => {
                let alpha = rest.first().map(|alpha| number(alpha));
                color_of([r, g, b].map(|c| number(c)), alpha).1
            }
            _ => number(self.volumes[0]),
        }
    }

    fn samples(&self, pixel: [R; 2]) -> Gathered<R> {
        self.scene.settings.technique.pixel(self, pixel)
    }

    fn classified(&self, channel: usize, value: R) -> [R; 4] {
        match &self.classifiers[channel] {
            Classifier::Table(table) => classify_by_table(table, value),
            Classifier::Points(points) => classify_by_points(points, value),
            Classifier::Slabs(slabs) => classify_slab(slabs, value, value),
        }
    }
}

/// The function of the volume that colours surfaces.
fn paint_of(scene: &Scene) -> Option<Points> {
    let function = scene.transfers().get(1).copied().flatten();
    let function = function.filter(|_| scene.settings.mode == Mode::Iso)?;
    let absorption = Absorption::Extinction {
        reference_length: scene.length_of(function),
    };
    let space = scene.settings.color_space;
    Some(Points::new(function, absorption, space))
}
