//! Points as a view sees them: sorted by depth, and listed by the blocks of the picture that they may be seen in.
//!
//! ```text
//! depth = n . (x - eye)       pixel at depth z: as large as that of the plane at z
//! ```
//!
//! A point is seen in the pixels whose rays pass through its ball of R h'. In perspective its outline is bounded, along
//! each axis of the picture, by the two tangents from the eye to the circle that the ball leaves in the plane of that axis
//! and the forward direction.

use crate::points::Points;
use crate::shaders::LIST_PIXELS;
use crate::technique::{Error, Recording, View};
use glam::{DVec2, DVec3, dvec2};

/// By how much of the lengths in it a ray of the shader passes a point elsewhere: half an ulp of its origin and of the centre,
/// and of their difference; three of the direction's norm, and two of products.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// A point as the shader reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewPoint {
    /// In the world, from the centre of the box.
    pub center: [f32; 3],
    /// 1 / h'.
    pub inverse_std: f32,
    /// f.
    pub value: f32,
    /// sqrt(2 pi) h (h / h')^2: the length of matter along a ray through its centre.
    pub length: f32,
    /// m / (2 pi h'^2): what of it a ray through its centre meets.
    pub density: f32,
}

/// The points of one view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewPoints {
    /// Those that may be seen, from front to back; of equal depths the first of the file first.
    pub points: Vec<ViewPoint>,
    /// For each block, row by row, where its list begins, and the end of the last.
    pub starts: Vec<u32>,
    /// The lists: indices of points, ascending.
    pub lists: Vec<u32>,
}

impl ViewPoints {
    /// Of points that a view's clip planes and crop box leave, by their centres.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where all lists together are too long.
    pub fn new(view: &View, points: &Points) -> Result<Self, Error> {
        let eye = EyeSpace::new(view);
        let reach = super::super::kernel::reach_of(&view.settings.splat);
        let center = view.grid.center();
        let mut seen: Vec<Seen> = (0..points.len())
            .filter_map(|index| {
                let world = points.places()[index] - center;
                is_kept(view, world).then_some(())?;
                let std = f64::from(points.stds()[index]);
                Seen::of(&eye, index, world, std, reach)
            })
            .collect();
        // Stable: ties stay as the file has them.
        seen.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        let [starts, lists] = lists(&seen, eye.blocks)?;
        let shown = |seen: &Seen| {
            let world = points.places()[seen.index] - center;
            let std = f64::from(points.stds()[seen.index]);
            let ratio = std / seen.std;
            let density = f64::from(points.weight(seen.index))
                / (std::f64::consts::TAU * seen.std * seen.std);
            ViewPoint {
                center: world.as_vec3().to_array(),
                inverse_std: seen.std.recip() as f32,
                value: points.values()[seen.index],
                length: (super::reference_length(std) * ratio * ratio) as f32,
                density: density as f32,
            }
        };
        Ok(Self {
            points: seen.iter().map(shown).collect(),
            starts,
            lists,
        })
    }

    /// Points in the longest list.
    fn longest_list(&self) -> u32 {
        let lengths = self.starts.windows(2).map(|ends| ends[1] - ends[0]);
        lengths.max().unwrap_or(0)
    }

    /// `whole` in parts of at most so many points of a list, one after the other: each goes on with what those before have
    /// left.
    pub fn parts(&self, whole: Recording, at_once: u32) -> Vec<Recording> {
        whole.in_parts(
            self.longest_list().max(1).div_ceil(at_once) as usize,
            at_once,
        )
    }

    /// The points that a pixel of a picture so wide may see, from front to back.
    pub fn of_pixel(&self, pixel: [u32; 2], width: u32) -> impl Iterator<Item = &ViewPoint> {
        let [x, y] = pixel.map(|n| n / LIST_PIXELS);
        let block = (x + y * width.div_ceil(LIST_PIXELS)) as usize;
        let list = self.starts[block] as usize..self.starts[block + 1] as usize;
        self.lists[list].iter().map(|&i| &self.points[i as usize])
    }
}

/// Whether crop box and clip planes leave a point of the centred world.
fn is_kept(view: &View, world: DVec3) -> bool {
    let settings = view.settings;
    let of_planes = settings
        .clip_planes
        .iter()
        .all(|plane| plane.normal.dot(world + view.grid.center()) >= plane.offset);
    let of_box = settings.crop.is_none_or(|[low, high]| {
        let voxel = view.world_from_voxel().inverse().transform_point3(world);
        voxel.cmpge(low).all() && voxel.cmplt(high).all()
    });
    of_planes && of_box
}

/// Where the rays of a picture are.
struct EyeSpace {
    is_perspective: bool,
    /// The eye, or the ray through the upper left corner.
    origin: DVec3,
    forward: DVec3,
    /// Unit vectors along rows and columns of pixels.
    across: [DVec3; 2],
    /// Length of a pixel along these: in perspective at depth 1.
    pixel: DVec2,
    /// The upper left corner of the picture, in these lengths: in perspective at depth 1.
    corner: DVec2,
    /// How many there are across and down.
    blocks: [u32; 2],
    low_pass: f64,
}

impl EyeSpace {
    fn new(view: &View) -> Self {
        let rays = view.rays();
        let is_perspective = view.camera.projection.is_perspective();
        // In perspective directions end on a plane across the forward direction.
        let depth = rays.direction.dot(rays.forward);
        let [dx, dy] = match is_perspective {
            true => [rays.direction_dx / depth, rays.direction_dy / depth],
            false => [rays.origin_dx, rays.origin_dy],
        };
        let across = [dx.normalize(), dy.normalize()];
        let on_plane = match is_perspective {
            true => rays.direction / depth,
            false => DVec3::ZERO,
        };
        Self {
            is_perspective,
            origin: rays.origin,
            forward: rays.forward,
            across,
            pixel: dvec2(dx.length(), dy.length()),
            corner: dvec2(on_plane.dot(across[0]), on_plane.dot(across[1])),
            blocks: view.extent_pixels.map(|n| n.div_ceil(LIST_PIXELS)),
            low_pass: view.settings.splat.low_pass,
        }
    }
}

/// A point that may be seen.
struct Seen {
    index: usize,
    depth: f64,
    /// h'.
    std: f64,
    /// Columns and rows of blocks, the ends not included.
    blocks: [[u32; 2]; 2],
}

impl Seen {
    fn of(eye: &EyeSpace, index: usize, world: DVec3, std: f64, reach: f64) -> Option<Self> {
        let from_eye = world - eye.origin;
        let depth = from_eye.dot(eye.forward);
        // By its centre; that of NaN is nowhere.
        (depth > 0.0).then_some(())?;
        let at_depth = if eye.is_perspective { depth } else { 1.0 };
        let std = std.max(eye.low_pass * eye.pixel.max_element() * at_depth);
        let lengths = from_eye.length() + world.length() + eye.origin.length();
        let radius = reach * std + ROUNDING * lengths;
        let of_axis = |axis: usize| {
            let lateral = from_eye.dot(eye.across[axis]);
            let ends = match eye.is_perspective {
                true => tangents(lateral, depth, radius),
                false => [lateral - radius, lateral + radius],
            };
            let pixels = ends.map(|end| (end - eye.corner[axis]) / eye.pixel[axis]);
            let block = f64::from(LIST_PIXELS);
            let most = f64::from(eye.blocks[axis]);
            let (first, end) = ((pixels[0] / block).floor(), (pixels[1] / block).ceil());
            let blocks = [first, end].map(|n| n.clamp(0.0, most) as u32);
            (blocks[0] < blocks[1]).then_some(blocks)
        };
        let blocks = [of_axis(0)?, of_axis(1)?];
        Some(Self {
            index,
            depth,
            std,
            blocks,
        })
    }

    fn each_block(&self, across: u32) -> impl Iterator<Item = usize> {
        let [columns, rows] = self.blocks;
        (rows[0]..rows[1])
            .flat_map(move |y| (columns[0]..columns[1]).map(move |x| (x + y * across) as usize))
    }
}

/// The smallest and the largest u / z of a circle of radius `r` around (u, z); all where it reaches the eye's plane.
fn tangents(u: f64, z: f64, r: f64) -> [f64; 2] {
    if z <= 1.000_001 * r {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let (angle, half) = (u.atan2(z), (r / u.hypot(z)).asin());
    [(angle - half).tan(), (angle + half).tan()]
}

/// Where the list of each block begins, and the lists.
fn lists(seen: &[Seen], [across, down]: [u32; 2]) -> Result<[Vec<u32>; 2], Error> {
    let mut starts = vec![0_u64; (across * down) as usize + 1];
    for block in seen.iter().flat_map(|seen| seen.each_block(across)) {
        starts[block + 1] += 1;
    }
    for block in 1..starts.len() {
        starts[block] += starts[block - 1];
    }
    let count = starts[starts.len() - 1];
    Error::unless(
        count <= MOST_LISTED,
        "the number of points in blocks of the picture",
        "2^28 at most: a smaller picture has fewer",
        count as f64,
    )?;
    let starts: Vec<u32> = starts.iter().map(|&start| start as u32).collect();
    let mut next = starts.clone();
    let mut lists = vec![0; count as usize];
    for (i, seen) in seen.iter().enumerate() {
        for block in seen.each_block(across) {
            lists[next[block] as usize] = i as u32;
            next[block] += 1;
        }
    }
    Ok([starts, lists])
}

/// A gibibyte of lists.
const MOST_LISTED: u64 = 1 << 28;

#[cfg(test)]
mod tests {
    use super::super::reference::square_of;
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::ray::pixel_ray;
    use crate::shaders::Frame;
    use crate::technique::splat::{Splat, kernel::reach_of};
    use crate::technique::{InPixel, Settings};
    use crate::volume::Grid;
    use glam::{DAffine3, dvec3};

    const EXTENT: [u32; 2] = [61, 53];

    /// As the shader finds it, whose rays from far away are off by pixels.
    #[test]
    fn what_a_ray_passes_is_listed_however_far_the_eye() {
        let mut state = 7_u32;
        let mut unit = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / 16_777_216.0
        };
        let count = 300;
        let places = (0..count).map(|_| 10.0 * dvec3(unit(), unit(), unit()));
        let places: Vec<_> = places.collect();
        let stds = vec![0.01; count];
        let points = Points::new(places, vec![1.0; count], Some(stds), None).expect("points");
        let grid = Grid {
            dims: [10; 3],
            world_from_voxel: DAffine3::IDENTITY,
        };
        let settings = Settings {
            splat: Splat::of_points(),
            ..Settings::default()
        };
        let reach = reach_of(&settings.splat);
        let mut met = 0;
        for distance in [3.0, 30.0, 1e4, 1e6, 1e7_f64] {
            let degrees = 2.0 * (5.0 / distance).atan().to_degrees();
            for projection in [
                Projection::Perspective {
                    fov_degrees: degrees,
                },
                Projection::Orthographic { view_height: 11.0 },
            ] {
                let camera = Camera {
                    eye: dvec3(5.0, 5.0, 5.0) + distance * dvec3(0.6, -0.64, 0.48),
                    target: dvec3(5.0, 5.0, 5.0),
                    up: DVec3::Z,
                    projection,
                    zoom: 1.0,
                };
                let view = View {
                    grid: &grid,
                    camera: &camera,
                    extent_pixels: EXTENT,
                    in_pixel: InPixel::CENTER,
                    settings: &settings,
                };
                let seen = ViewPoints::new(&view, &points).expect("lists");
                let rays = view.rays();
                let numbers = |v: DVec3| v.as_vec3().to_array();
                let mut frame: Frame = bytemuck::Zeroable::zeroed();
                frame.origin = numbers(rays.origin);
                frame.origin_dx = numbers(rays.origin_dx);
                frame.origin_dy = numbers(rays.origin_dy);
                frame.direction = numbers(rays.direction);
                frame.direction_dx = numbers(rays.direction_dx);
                frame.direction_dy = numbers(rays.direction_dy);
                for [x, y] in (0..EXTENT[1]).flat_map(|y| (0..EXTENT[0]).map(move |x| [x, y])) {
                    let ray = pixel_ray(&frame, [x as f32 + 0.5, y as f32 + 0.5]);
                    let is_met = |point: &ViewPoint| {
                        square_of(point, &ray).is_some_and(|b| f64::from(b) <= reach * reach)
                    };
                    let all = seen.points.iter().filter(|point| is_met(point)).count();
                    let listed = seen.of_pixel([x, y], EXTENT[0]);
                    let listed = listed.filter(|point| is_met(point)).count();
                    assert_eq!(listed, all, "{projection:?} from {distance}: {x}, {y}");
                    met += all;
                }
            }
        }
        assert!(met > 10_000, "hardly anything was met: {met}");
    }
}
