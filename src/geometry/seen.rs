//! What a camera sees of geometry: a colour and a distance a pixel.
//!
//! ```text
//! colour of a cone       (A + D |n . v|) c + S |n . v|^e        a light at the eye, v the way to it
//! colour of a triangle   c, as it is
//! ```
//!
//! The picture is cut into rows of tiles that are shared out among the machine's cores; of each shape the pixels of its
//! bounds are tried. The nearest hit stays, so the order of shapes does not matter but where two are equally near: there the
//! first stays, cones before triangles.

use super::{Corner, Geometry, Hit, RoundCone, bounds::Bounds, triangle::triangle_hit};
use crate::camera::Camera;
use glam::DVec3;
use std::ops::Range;

/// What the light at the eye leaves of a surface that is seen from the side.
const AMBIENT: f64 = 0.3;
/// What it adds where it is seen from the front.
const DIFFUSE: f64 = 0.7;
/// How bright its reflection is, and how sharp.
const SPECULAR: f64 = 0.2;
const EXPONENT: i32 = 30;
/// Rows of pixels that a worker takes at a time.
const BAND: u32 = 16;

/// The first surface along the ray of each pixel, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Linear colour, alpha 1 where something is met and all zero elsewhere.
    pub pixels: Vec<[f32; 4]>,
    /// World length along the ray from its origin; infinite where nothing is met.
    pub distances: Vec<f64>,
    /// The number of the line that is met ([`super::RoundCones::add_line_of`]); 0 where that is none.
    pub lines: Vec<u32>,
}

impl Seen {
    /// In memory.
    pub const BYTES_PER_PIXEL: u64 =
        (size_of::<[f32; 4]>() + size_of::<f64>() + size_of::<u32>()) as u64;
}

/// One of all.
#[derive(Clone, Copy)]
enum Shape {
    /// By the number of the segment.
    Cone(usize),
    /// By its number.
    Triangle(usize),
}

/// One of all, with all that it takes to meet it.
enum Placed {
    /// With the colours of its ends.
    Cone(RoundCone, [[f32; 3]; 2]),
    Triangle([Corner; 3]),
}

/// A shape with the pixels that may see it.
struct Candidate {
    shape: Shape,
    columns: Range<u32>,
    rows: Range<u32>,
}

impl Geometry {
    /// What `camera` sees in a picture of so many pixels, by rays through a place in each pixel, counted from its centre.
    pub fn seen(&self, camera: &Camera, extent: [u32; 2], at: [f64; 2]) -> Seen {
        self.seen_cut(camera, extent, at, &[])
    }

    /// The same of what lies in all of these half-spaces, `normal . x >= offset` in the world, with unit normals. The cones
    /// are solid: cuts through them are seen. Triangles are sheets, and symbols stay whole.
    pub fn seen_cut(
        &self,
        camera: &Camera,
        extent: [u32; 2],
        at: [f64; 2],
        planes: &[(DVec3, f64)],
    ) -> Seen {
        let bounds = Bounds::new(camera, extent, at);
        let [width, height] = extent;
        let bands = height.div_ceil(BAND) as usize;
        let mut of_band: Vec<Vec<Candidate>> = (0..bands).map(|_| Vec::new()).collect();
        let cones = (0..self.cones.len()).map(|segment| {
            let (cone, _) = self.cones.cone(segment);
            let spheres = [0, 1].map(|k| (cone.ends[k], cone.radii[k]));
            (Shape::Cone(segment), bounds.of(spheres))
        });
        let triangles = (0..self.triangles.len()).map(|triangle| {
            let corners = self.triangles.corners(triangle).map(|corner| corner.place);
            (Shape::Triangle(triangle), bounds.of_triangle(corners))
        });
        for (shape, found) in cones.chain(triangles) {
            let Some([columns, rows]) = found else {
                continue;
            };
            for band in rows.start / BAND..rows.end.div_ceil(BAND) {
                let [first, end] = [band * BAND, (band + 1) * BAND];
                of_band[band as usize].push(Candidate {
                    shape,
                    columns: columns.clone(),
                    rows: rows.start.max(first)..rows.end.min(end),
                });
            }
        }
        let count = width as usize * height as usize;
        let mut seen = Seen {
            pixels: vec![[0.0; 4]; count],
            distances: vec![f64::INFINITY; count],
            lines: vec![0; count],
        };
        let rays = camera.rays(extent);
        let size = (width * BAND) as usize;
        let work = seen
            .pixels
            .chunks_mut(size.max(1))
            .zip(seen.distances.chunks_mut(size.max(1)))
            .zip(seen.lines.chunks_mut(size.max(1)));
        let work = std::sync::Mutex::new(work.zip(&of_band).enumerate());
        let draw = || {
            loop {
                let next = work.lock().expect("no worker panics").next();
                let Some((band, (((pixels, distances), lines), shapes))) = next else {
                    return;
                };
                let top = band as u32 * BAND;
                for candidate in shapes {
                    let shape = self.placed(candidate.shape);
                    let line = self.line_of(candidate.shape);
                    let planes = if self.is_whole(candidate.shape) {
                        &[]
                    } else {
                        planes
                    };
                    for y in candidate.rows.clone() {
                        for x in candidate.columns.clone() {
                            let place = [x, y].map(|n| f64::from(n) + 0.5);
                            let (origin, direction) = rays.at(place[0] + at[0], place[1] + at[1]);
                            let i = ((y - top) * width + x) as usize;
                            let nearer = shape.nearer([origin, direction], planes, distances[i]);
                            if let Some((distance, color)) = nearer {
                                (distances[i], pixels[i], lines[i]) = (distance, color, line);
                            }
                        }
                    }
                }
            }
        };
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
        std::thread::scope(|scope| {
            for _ in 1..threads.min(bands) {
                scope.spawn(draw);
            }
            draw();
        });
        seen
    }

    /// The number of its line.
    fn line_of(&self, shape: Shape) -> u32 {
        match shape {
            Shape::Cone(segment) => self.cones.segments[segment].line,
            Shape::Triangle(_) => 0,
        }
    }

    /// Whether no plane cuts it.
    fn is_whole(&self, shape: Shape) -> bool {
        matches!(shape, Shape::Cone(segment) if self.cones.segments[segment].is_whole)
    }

    fn placed(&self, shape: Shape) -> Placed {
        match shape {
            Shape::Cone(segment) => {
                let (cone, colors) = self.cones.cone(segment);
                Placed::Cone(cone, colors)
            }
            Shape::Triangle(triangle) => Placed::Triangle(self.triangles.corners(triangle)),
        }
    }
}

impl Placed {
    /// How far along a ray what the planes leave of it is met, and its colour there, where that is nearer than something
    /// else.
    fn nearer(
        &self,
        [origin, direction]: [DVec3; 2],
        planes: &[(DVec3, f64)],
        nearest: f64,
    ) -> Option<(f64, [f32; 4])> {
        match self {
            Self::Cone(cone, colors) => {
                let hit = first_of(cone, origin, direction, planes)?;
                let color = || lit(mixed(*colors, hit.part), hit.normal.dot(direction));
                (hit.distance < nearest).then(|| (hit.distance, color()))
            }
            Self::Triangle(corners) => {
                let hit = triangle_hit(corners.map(|corner| corner.place), origin, direction)?;
                let place = origin + hit.distance * direction;
                if planes
                    .iter()
                    .any(|&(normal, offset)| normal.dot(place) < offset)
                {
                    return None;
                }
                let color = || {
                    let [r, g, b] = [0, 1, 2].map(|c| {
                        let own = corners.map(|corner| f64::from(corner.color[c]));
                        (0..3).map(|k| hit.weights[k] * own[k]).sum::<f64>() as f32
                    });
                    [r, g, b, 1.0]
                };
                (hit.distance < nearest).then(|| (hit.distance, color()))
            }
        }
    }
}

/// Where a ray meets what the planes leave of a cone.
fn first_of(
    cone: &RoundCone,
    origin: DVec3,
    direction: DVec3,
    planes: &[(DVec3, f64)],
) -> Option<Hit> {
    let (mut begin, mut end, mut face) = (0.0, f64::INFINITY, DVec3::ZERO);
    for &(normal, offset) in planes {
        let (height, slope) = (normal.dot(origin) - offset, normal.dot(direction));
        let meets = -height / slope;
        if slope > 0.0 && meets > begin {
            (begin, face) = (meets, normal);
        } else if slope < 0.0 {
            end = meets.min(end);
        } else if slope == 0.0 && height < 0.0 {
            return None;
        }
    }
    let hit = match begin == 0.0 {
        true => cone.hit(origin, direction),
        false => cone.hit_after(origin, direction, begin, face),
    };
    hit.filter(|hit| hit.distance <= end)
}

fn mixed([a, b]: [[f32; 3]; 2], part: f64) -> [f32; 3] {
    std::array::from_fn(|c| a[c] + part as f32 * (b[c] - a[c]))
}

/// How bright a dull surface is under a light at the eye, by the cosine between its normal and the way to the eye.
pub(crate) fn dull(facing: f64) -> f64 {
    AMBIENT + DIFFUSE * facing.abs().min(1.0)
}

fn lit(color: [f32; 3], facing: f64) -> [f32; 4] {
    let facing = facing.abs().min(1.0);
    let [own, shine] = [dull(facing), SPECULAR * facing.powi(EXPONENT)];
    let [r, g, b] = color.map(|c| (f64::from(c) * own + shine).min(1.0) as f32);
    [r, g, b, 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use crate::geometry::{RoundCones, Triangles, Vertex};
    use glam::dvec3;

    fn camera(projection: Projection) -> Camera {
        Camera {
            eye: dvec3(1.0, -7.0, 2.0),
            target: dvec3(0.2, 0.1, 0.0),
            up: DVec3::Z,
            projection,
            zoom: 1.0,
        }
    }

    /// Of radius 1 in the origin.
    fn ball() -> RoundCones {
        let mut cones = RoundCones::default();
        cones.add_line([Vertex {
            place: DVec3::ZERO,
            radius: 1.0,
            color: [0.5; 3],
        }]);
        cones
    }

    /// Straight down on the origin, a tenth a pixel of 40.
    fn above() -> Camera {
        Camera {
            eye: dvec3(0.0, 0.0, 9.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: 4.0 },
            zoom: 1.0,
        }
    }

    fn projections() -> [Projection; 2] {
        [
            Projection::Orthographic { view_height: 4.0 },
            Projection::Perspective { fov_degrees: 40.0 },
        ]
    }

    /// A helix, a sphere in it, and a line that passes beside the eye.
    fn cones() -> RoundCones {
        let mut cones = RoundCones::default();
        let vertex = |place, radius| Vertex {
            place,
            radius,
            color: [0.8, 0.4, 0.1],
        };
        cones.add_line((0..40).map(|i| {
            let a = f64::from(i) * 0.3;
            vertex(
                dvec3(a.cos(), a.sin(), a / 6.0 - 1.0),
                0.03 + 0.002 * f64::from(i),
            )
        }));
        cones.add_line([vertex(DVec3::ZERO, 0.4)]);
        cones.add_line([
            vertex(dvec3(1.4, -9.0, 2.2), 0.1),
            vertex(dvec3(0.4, -3.0, 0.2), 0.2),
        ]);
        cones
    }

    #[test]
    fn bounds_leave_out_no_pixel_that_sees_something() {
        let cones = cones();
        for projection in projections() {
            let camera = camera(projection);
            let (extent, at) = ([61, 47], [0.25, -0.4]);
            let seen = Geometry::from(cones.clone()).seen(&camera, extent, at);
            let rays = camera.rays(extent);
            let mut hits = 0;
            for (i, found) in seen.distances.iter().enumerate() {
                let [x, y] = [i % 61, i / 61].map(|n| n as f64 + 0.5);
                let (origin, direction) = rays.at(x + at[0], y + at[1]);
                let all = (0..cones.len()).filter_map(|k| cones.cone(k).0.hit(origin, direction));
                let wanted = all.map(|hit| hit.distance).fold(f64::INFINITY, f64::min);
                assert_eq!(*found, wanted, "{projection:?}, pixel {i}");
                hits += usize::from(wanted.is_finite());
            }
            assert!(hits > 200, "{hits}");
        }
    }

    #[test]
    fn planes_leave_a_ball_its_cap_and_its_cut() {
        let cones = ball();
        let camera = above();
        // Between heights 0.2 and 0.5, to the right of 0.1.
        let planes = [(DVec3::Z, 0.2), (DVec3::NEG_Z, -0.5), (DVec3::X, 0.1)];
        let seen = Geometry::from(cones).seen_cut(&camera, [40, 40], [0.0; 2], &planes);
        let facing = AMBIENT + DIFFUSE;
        let (mut cut, mut cap) = (0, 0);
        for (i, (pixel, distance)) in seen.pixels.iter().zip(&seen.distances).enumerate() {
            let [x, y] = [i % 40, i / 40].map(|n| (n as f64 + 0.5) / 10.0 - 2.0);
            let height = (1.0 - x * x - y * y).max(0.0).sqrt();
            match height {
                height if x < 0.1 || height < 0.2 => assert!(distance.is_infinite()),
                height if height > 0.5 => {
                    assert!((distance - 8.5).abs() < 1e-12, "{distance}");
                    let wanted = 0.5 * facing + SPECULAR;
                    assert!((f64::from(pixel[0]) - wanted).abs() < 1e-6);
                    cut += 1;
                }
                height => {
                    assert!((distance - (9.0 - height)).abs() < 1e-12, "{distance}");
                    cap += 1;
                }
            }
        }
        assert!(cut > 80 && cap > 10, "{cut} and {cap} pixels");
    }

    #[test]
    fn a_sphere_is_a_disc_as_large_as_it_is_and_as_bright_as_its_law() {
        let cones = ball();
        let camera = above();
        let seen = Geometry::from(cones).seen(&camera, [40, 40], [0.0; 2]);
        for (i, (pixel, distance)) in seen.pixels.iter().zip(&seen.distances).enumerate() {
            let [x, y] = [i % 40, i / 40].map(|n| (n as f64 + 0.5) / 10.0 - 2.0);
            let height = 1.0 - x * x - y * y;
            if height < 0.0 {
                assert_eq!((*pixel, *distance), ([0.0; 4], f64::INFINITY));
                continue;
            }
            let facing = height.sqrt();
            assert!((distance - (9.0 - facing)).abs() < 1e-12);
            let wanted = 0.5 * (AMBIENT + DIFFUSE * facing) + SPECULAR * facing.powi(EXPONENT);
            assert!((f64::from(pixel[0]) - wanted).abs() < 1e-6);
        }
    }

    /// A plane of four corners whose colours are their places, around the eye and below it.
    #[test]
    fn a_plane_is_seen_up_to_its_horizon_and_its_colours_are_linear() {
        let (half, height) = (500.0, 1.7);
        let corner = |x: f64, y: f64| Corner {
            place: dvec3(half * x, half * y, 0.0),
            color: [0.5 + 0.5 * x as f32, 0.5 + 0.5 * y as f32, 0.25],
        };
        let corners = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        let mut triangles = Triangles::default();
        triangles.add(&corners[..1], []);
        triangles.add(&corners, [[0, 1, 2], [0, 2, 3]]);
        let geometry = Geometry {
            triangles,
            ..Geometry::default()
        };
        for projection in projections() {
            for pitch in [-0.2, -0.9, 0.0] {
                let eye = dvec3(3.0, -11.0, height);
                let camera = Camera {
                    eye,
                    target: eye + dvec3(0.3, 1.0, pitch),
                    up: DVec3::Z,
                    projection,
                    zoom: 1.0,
                };
                let (extent, at) = ([53, 41], [-0.3, 0.2]);
                let seen = geometry.seen(&camera, extent, at);
                let rays = camera.rays(extent);
                let mut met = 0;
                for (i, (pixel, distance)) in seen.pixels.iter().zip(&seen.distances).enumerate() {
                    let [x, y] = [i % 53, i / 53].map(|n| n as f64 + 0.5);
                    let (origin, direction) = rays.at(x + at[0], y + at[1]);
                    let wanted = -origin.z / direction.z;
                    let place = origin + wanted * direction;
                    let [s, t] = [place.x / half, place.y / half];
                    let is_met = wanted > 0.0 && s.abs() <= 1.0 && t.abs() <= 1.0;
                    if !is_met {
                        assert_eq!((*pixel, *distance), ([0.0; 4], f64::INFINITY), "pixel {i}");
                        continue;
                    }
                    met += 1;
                    // A ray that nearly lies in the plane meets it far away.
                    let part = 1e-12 / direction.z.abs() + 1e-12;
                    assert!(
                        (distance / wanted - 1.0).abs() < part,
                        "{projection:?}, pixel {i}"
                    );
                    let wanted = [0.5 + 0.5 * s, 0.5 + 0.5 * t, 0.25, 1.0];
                    for c in 0..4 {
                        assert!((f64::from(pixel[c]) - wanted[c]).abs() < 1e-6, "pixel {i}");
                    }
                }
                assert!(met > 600 || pitch == 0.0, "{projection:?}, {pitch}: {met}");
            }
        }
    }

    #[test]
    fn planes_cut_triangles_and_what_lies_behind_them_is_seen() {
        let sheet = |height: f64, red: f32| {
            [[-9.0, -9.0], [9.0, -9.0], [0.0, 30.0]].map(|[x, y]| Corner {
                place: dvec3(x, y, height),
                color: [red, 0.0, 0.0],
            })
        };
        let mut geometry = Geometry::default();
        geometry.triangles.add(&sheet(1.0, 0.75), [[0, 1, 2]]);
        geometry.triangles.add(&sheet(0.0, 0.25), [[0, 1, 2]]);
        // What lies to the right, and below y + z = 2.
        let planes = [
            (DVec3::X, 0.0),
            (dvec3(0.0, -1.0, -1.0).normalize(), -(2.0_f64.sqrt())),
        ];
        let seen = geometry.seen_cut(&above(), [40, 40], [0.0; 2], &planes);
        for (i, (pixel, distance)) in seen.pixels.iter().zip(&seen.distances).enumerate() {
            let [x, y] = [i % 40, i / 40].map(|n| (n as f64 + 0.5) / 10.0 - 2.0);
            // Rows go down.
            let wanted = match -y {
                _ if x < 0.0 => (0.0, f64::INFINITY),
                y if y < 1.0 => (0.75, 8.0),
                y if y < 2.0 => (0.25, 9.0),
                _ => (0.0, f64::INFINITY),
            };
            assert_eq!(f64::from(pixel[0]), wanted.0, "pixel {i}");
            let is_there = *distance == wanted.1 || (distance - wanted.1).abs() < 1e-12;
            assert!(is_there, "pixel {i}: {distance}");
        }
    }

    #[test]
    fn the_nearer_of_a_cone_and_a_triangle_is_seen() {
        let mut geometry = Geometry::default();
        geometry.cones.add_line([Vertex {
            place: DVec3::ZERO,
            radius: 1.0,
            color: [0.0, 1.0, 0.0],
        }]);
        let corner = |x: f64, y: f64, z: f64| Corner {
            place: dvec3(x, y, z),
            color: [1.0, 0.0, 0.0],
        };
        // Through the sphere on the left, behind it on the right.
        let corners = [
            corner(-9.0, -9.0, 3.0),
            corner(9.0, -9.0, -3.0),
            corner(0.0, 30.0, 0.0),
        ];
        geometry.triangles.add(&corners, [[2, 1, 0]]);
        let camera = above();
        let seen = geometry.seen(&camera, [40, 40], [0.0; 2]);
        for (i, (pixel, distance)) in seen.pixels.iter().zip(&seen.distances).enumerate() {
            let [x, y] = [i % 40, i / 40].map(|n| (n as f64 + 0.5) / 10.0 - 2.0);
            let plane = -x / 3.0;
            let sphere = (1.0 - x * x - y * y).max(-1.0).sqrt();
            let (is_sphere, height) = (sphere > plane, sphere.max(plane));
            assert!((distance - (9.0 - height)).abs() < 1e-12);
            assert_eq!(pixel[1] > 0.0 && pixel[0] < 0.5, is_sphere, "pixel {i}");
        }
    }
}
