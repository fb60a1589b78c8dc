//! The same shapes by the device and by the CPU, from all kinds of eyes.

use super::{Drawn, drawn};
use crate::embed_shared::{Eye, Host, Stage, eyes};
use glam::{DVec3, dvec3};
use stratavox::camera::{Camera, DepthConvention, HostDepth};
use stratavox::geometry::{Corner, Geometry, RoundCone, RoundCones, Triangles, Vertex};
use stratavox::technique::Settings;

const EXTENT: [u32; 2] = [150, 120];
/// Of all pixels may see something else at a border between two things: one in a thousand.
const BORDERS: usize = 18;

/// A line in many pieces.
fn helix(center: DVec3) -> Vec<(DVec3, f64)> {
    let at = |i: u32| {
        let a = f64::from(i) * 0.3;
        let place = dvec3(7.0 * a.cos(), 7.0 * a.sin(), a - 9.0);
        (center + place, 0.3 + 0.01 * f64::from(i))
    };
    (0..60).map(at).collect()
}

/// A helix, a cone of which one end holds the other, a sphere, a long thin cone, and one from behind the eye.
fn lines(stage: &Stage) -> Vec<Vec<(DVec3, f64)>> {
    let (center, eye) = (stage.grid.center(), stage.camera.eye);
    let away = (center - eye).normalize();
    let aside = away.cross(DVec3::Z).normalize();
    vec![
        helix(center),
        vec![
            (center + 3.0 * DVec3::Z, 2.0),
            (center + 3.5 * DVec3::Z, 1.0),
        ],
        vec![(center - 2.0 * away - 5.0 * aside, 3.0)],
        vec![
            (center - 130.0 * aside, 0.2),
            (center + 110.0 * aside + 50.0 * away, 0.2),
        ],
        vec![
            (eye - 20.0 * away + 2.0 * aside, 0.5),
            (center + 9.0 * aside, 0.8),
        ],
    ]
}

fn color(i: usize) -> [f32; 3] {
    [0, 1, 2].map(|c| ((i * (c + 3)) % 7) as f32 / 8.0 + 0.1)
}

fn cones(lines: &[Vec<(DVec3, f64)>]) -> (RoundCones, Vec<RoundCone>) {
    let (mut made, mut each) = (RoundCones::default(), Vec::new());
    for line in lines {
        made.add_line(line.iter().enumerate().map(|(i, &(place, radius))| Vertex {
            place,
            radius,
            color: color(i),
        }));
        let ends = match line.len() {
            1 => vec![[line[0], line[0]]],
            _ => line.windows(2).map(|pair| [pair[0], pair[1]]).collect(),
        };
        each.extend(ends.into_iter().map(|ends| RoundCone {
            ends: ends.map(|end| end.0),
            radii: ends.map(|end| end.1),
        }));
    }
    (made, each)
}

/// The half-spaces before the far plane and behind the near plane, with unit normals. Parallel rays begin on that: it lies a
/// little farther, for all of them to pass it.
fn planes(depth: &HostDepth) -> Vec<(DVec3, f64)> {
    let away = match depth.nearer {
        DepthConvention::Standard => 1.0,
        DepthConvention::Reversed => -1.0,
    };
    let near = away * (depth.z - depth.nearer.near() * depth.w);
    let far = -away * (depth.z - (1.0 - depth.nearer.near()) * depth.w);
    let planes = [near, far].into_iter().filter_map(|row| {
        let length = row.truncate().length();
        (length > 0.0).then(|| (row.truncate() / length, -row.w / length))
    });
    let mut planes: Vec<_> = planes.collect();
    planes[0].1 += 1e-9;
    planes
}

/// What f32 may move along a ray: the ray, of eight operations of numbers up to its length and to the distance from the middle,
/// and the ends of a cone, which lie up to `REACH` from the middle; a surface that is seen under an angle moves by that over its
/// cosine. Solving takes 16 operations of numbers of the size of the radius.
fn moved(origin: DVec3, distance: f64, radius: f64, cosine: f64) -> f64 {
    let rounded = 8.0 * (origin.length() + distance) + REACH + 16.0 * radius;
    rounded * 2f64.powi(-24) / cosine
}

const REACH: f64 = 150.0;

/// What a depth may be off by where the place moves so far: and four roundings of its own.
fn of_depth(depth: &HostDepth, origin: DVec3, direction: DVec3, t: f64, moved: f64) -> f64 {
    let at = |t: f64| depth.of(origin + t * direction);
    let slope = (at(t + moved) - at(t))
        .abs()
        .max((at(t) - at(t - moved)).abs());
    let place = (origin + t * direction).extend(1.0);
    let w = depth.w.dot(place);
    let start = depth.z.dot(origin.extend(1.0)).abs();
    let terms = (start + depth.z.dot(place - origin.extend(1.0)).abs()) / w;
    slope + 4.0 * terms * 2f64.powi(-24)
}

struct Seen {
    host: Host,
    stage: Stage,
}

impl Seen {
    fn new() -> Self {
        let mut stage = Stage::new(Settings::default());
        stage.extent = EXTENT;
        let host = Host::new();
        Self { host, stage }
    }

    fn drawn(&self, shapes: &Geometry, eye: &Eye) -> (Camera, HostDepth, Drawn<'_>) {
        let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        let found = drawn(&self.host, shapes, (&camera, &depth), EXTENT);
        (camera, depth, found)
    }
}

#[test]
fn cones_are_what_the_cpu_sees_of_them_cut_by_the_hosts_planes() {
    let all = Seen::new();
    let (cones, each) = cones(&lines(&all.stage));
    let ends = || each.iter().flat_map(|cone| cone.ends);
    let low = ends().fold(DVec3::INFINITY, DVec3::min);
    let middle = 0.5 * (low + ends().fold(DVec3::NEG_INFINITY, DVec3::max));
    assert!(ends().all(|end| end.distance(middle) < REACH));
    let shapes = Geometry::from(cones);
    for eye in eyes(&all.stage) {
        let (camera, depth, found) = all.drawn(&shapes, &eye);
        let planes = planes(&depth);
        let wanted = shapes.seen_cut(&camera, EXTENT, [0.0; 2], &planes);
        let rays = camera.rays(EXTENT);
        let far = 1.0 - eye.nearer.near();
        let (mut borders, mut met, mut cut, mut worst) = (0, 0, 0, 0.0f64);
        for i in 0..wanted.distances.len() {
            let t = wanted.distances[i];
            let is_drawn = found.pixels[i][3] == 1.0;
            if t.is_infinite() || !is_drawn {
                borders += usize::from(t.is_finite() || is_drawn);
                assert!(is_drawn || f64::from(found.depths[i]) == far);
                continue;
            }
            met += 1;
            let [x, y] = [i % 150, i / 150].map(|n| n as f64 + 0.5);
            let (origin, direction) = rays.at(x, y);
            // Which cone it is, and how it is seen.
            let mut nearest = each.iter().rev().filter_map(|cone| {
                let hit = cone.hit(origin, direction)?;
                (hit.distance == t).then(|| (cone.radii, hit.normal.dot(direction).abs()))
            });
            let (radii, cosine) = nearest.next().unwrap_or_else(|| {
                cut += 1;
                (each[0].radii, planes[0].0.dot(direction).abs())
            });
            let [small, large] = [radii[0].min(radii[1]), radii[0].max(radii[1])];
            let moved = moved(origin - middle, t, large, cosine);
            let allowed = of_depth(&depth, origin, direction, t, moved);
            let off = (f64::from(found.depths[i]) - depth.of(origin + t * direction)).abs();
            // The normal turns with the place, and with it the cosine; rounding of f32 colours.
            let of_color = (0.7 + 0.2 * 30.0) * moved / (small * cosine) + 2f64.powi(-20);
            let colors =
                (0..3).map(|c| (found.pixels[i][c] - f64::from(wanted.pixels[i][c])).abs());
            let ratio = (off / allowed).max(colors.fold(0.0, f64::max) / of_color);
            match ratio <= 1.0 {
                true => worst = worst.max(ratio),
                false => borders += 1,
            }
        }
        println!(
            "{}: {met} pixels, {cut} of cuts, {borders} at borders, {worst:.2} of what is allowed",
            eye.name
        );
        assert!(met > 1200, "{}: {met} pixels", eye.name);
        assert!(
            borders <= BORDERS,
            "{}: {borders} pixels are other ones",
            eye.name
        );
        assert!(
            cut > 0 || !eye.name.contains("far"),
            "{}: nothing is cut",
            eye.name
        );
    }
}

#[test]
fn triangles_are_what_the_cpu_sees_of_them_and_the_nearer_of_both_is_seen() {
    let all = Seen::new();
    let (center, eye) = (all.stage.grid.center(), all.stage.camera.eye);
    let away = (center - eye).normalize();
    let aside = away.cross(DVec3::Z).normalize();
    let corner = |place: DVec3, i: usize| Corner {
        place,
        color: color(i),
    };
    let mut shapes = Geometry::default();
    let mut sheet = Triangles::default();
    // Through the middle, and past the eye.
    let corners = [
        corner(center - 12.0 * aside - 9.0 * DVec3::Z, 1),
        corner(center + 12.0 * aside - 9.0 * DVec3::Z, 2),
        corner(center + 9.0 * DVec3::Z, 4),
        corner(eye - 5.0 * away - 2.0 * DVec3::Z, 5),
    ];
    sheet.add(&corners, [[0, 1, 2], [0, 1, 3]]);
    shapes.triangles = sheet;
    shapes
        .cones
        .add_line(helix(center).into_iter().map(|(place, radius)| Vertex {
            place,
            radius,
            color: [0.0, 1.0, 0.0],
        }));
    for eye in eyes(&all.stage) {
        let (camera, depth, found) = all.drawn(&shapes, &eye);
        let wanted = shapes.seen_cut(&camera, EXTENT, [0.0; 2], &planes(&depth));
        let rays = camera.rays(EXTENT);
        let (mut borders, mut met) = (0, 0);
        for i in 0..wanted.distances.len() {
            let t = wanted.distances[i];
            let is_drawn = found.pixels[i][3] == 1.0;
            if t.is_infinite() || !is_drawn {
                borders += usize::from(t.is_finite() || is_drawn);
                continue;
            }
            met += 1;
            let [x, y] = [i % 150, i / 150].map(|n| n as f64 + 0.5);
            let (origin, direction) = rays.at(x, y);
            let off = (f64::from(found.depths[i]) - depth.of(origin + t * direction)).abs();
            let colors =
                (0..3).map(|c| (found.pixels[i][c] - f64::from(wanted.pixels[i][c])).abs());
            // Corners of triangles lie on a grid of at least a sixteenth of a pixel, which moves colours between them, and depths,
            // by what a pixel changes them.
            borders += usize::from(off > 2e-3 || colors.fold(0.0, f64::max) > 2e-2);
        }
        println!("{}: {met} pixels, {borders} at borders", eye.name);
        assert!(met > 3000, "{}: {met} pixels", eye.name);
        // Edges of triangles move by the grid of their corners.
        assert!(
            borders <= 4 * BORDERS,
            "{}: {borders} pixels are other ones",
            eye.name
        );
    }
}
