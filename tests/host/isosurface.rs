//! Surfaces against what is known of them: their area, what they enclose, and that they have no cracks.

use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use stratavox::camera::{Camera, Projection};
use stratavox::isosurface::{Border, isosurface};
use stratavox::mesh::{Mesh, MeshFormat};
use stratavox::offscreen::reference;
use stratavox::picture::{Layer, LayerKind};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{Level, Mode, Settings};
use stratavox::volume::{Rescale, Volume, Voxels, sample};

fn volume(dims: [u32; 3], affine: DAffine3, value: impl Fn(DVec3) -> f32) -> Volume {
    let mut voxels = Vec::new();
    for z in 0..dims[2] {
        for y in 0..dims[1] {
            for x in 0..dims[0] {
                voxels.push(value(DVec3::new(x.into(), y.into(), z.into()) + 0.5));
            }
        }
    }
    let voxels = Voxels::F32(voxels);
    Volume::from_voxels(dims, affine, voxels, Rescale::default(), None).expect("a volume")
}

fn surface(volume: &Volume, level: f64, border: Border) -> Mesh {
    isosurface(volume, level, border).expect("room for its corners")
}

/// How often each side of a triangle is walked in its direction.
fn sides(mesh: &Mesh) -> HashMap<[u32; 2], u32> {
    let mut counts = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for side in [[a, b], [b, c], [c, a]] {
            *counts.entry(side).or_insert(0) += 1;
        }
    }
    counts
}

/// Sides that no neighbour walks the other way.
fn open_sides(mesh: &Mesh) -> Vec<[u32; 2]> {
    let sides = sides(mesh);
    assert!(
        sides.values().all(|&n| n == 1),
        "a side belongs to two triangles that lie alike"
    );
    let is_open = |&[a, b]: &[u32; 2]| !sides.contains_key(&[b, a]);
    sides.keys().copied().filter(is_open).collect()
}

/// Numbers that look random, the same on each run.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[test]
fn a_sphere_has_the_area_and_the_volume_of_a_sphere() {
    let pi = std::f64::consts::PI;
    let radius = 9.3;
    let center = DVec3::new(12.1, 11.8, 12.4);
    let ball = volume([24; 3], DAffine3::IDENTITY, |p| {
        (radius - p.distance(center)) as f32
    });
    let mesh = surface(&ball, 0.0, Border::Open);
    assert_eq!(open_sides(&mesh).len(), 0);
    // Linear interpolation over a step of 1 puts a corner at most 1 / (8 R) inside. The circle around what one cell
    // cuts out has at most the radius sqrt(3) / 2, so its plane is no nearer to the middle than sqrt(R^2 - 3/4).
    let nearest = (1.0 - 0.125 / (radius * radius)) * (1.0 - 0.75 / (radius * radius)).sqrt();
    let area = mesh.area() / (4.0 * pi * radius.powi(2)) - 1.0;
    let inside = mesh.volume() / (4.0 / 3.0 * pi * radius.powi(3)) - 1.0;
    assert!((nearest.powi(2) - 1.0..0.0).contains(&area), "area {area}");
    assert!(
        (nearest.powi(3) - 1.0..0.0).contains(&inside),
        "volume {inside}"
    );
    // The plane of a circle of that radius leans so far from the sphere at its rim.
    let most_turned = (0.75_f64.sqrt() / radius).asin().to_degrees();
    for (position, normal) in mesh.positions.iter().zip(mesh.normals()) {
        let outward = (*position - center).normalize();
        let turned = outward
            .dot(normal.as_dvec3())
            .clamp(-1.0, 1.0)
            .acos()
            .to_degrees();
        assert!(turned < most_turned, "{turned} degrees at {position}");
    }
}

#[test]
fn every_corner_lies_on_the_level_of_the_trilinear_field() {
    let mut random = noise(3);
    let values: Vec<f32> = (0..7 * 6 * 5).map(|_| random() as f32).collect();
    let rough = volume([7, 6, 5], DAffine3::IDENTITY, |p| {
        values[p.x as usize + 7 * (p.y as usize + 6 * p.z as usize)]
    });
    let mesh = surface(&rough, 0.5, Border::Open);
    assert!(mesh.positions.len() > 200, "{}", mesh.positions.len());
    for position in &mesh.positions {
        let value: f64 = sample::linear(&rough, position.to_array()).expect("valid");
        assert!((value - 0.5).abs() < 1e-7, "{value} at {position}");
    }
}

#[test]
fn no_field_however_rough_gives_a_surface_with_cracks() {
    let mut ambiguous = 0;
    for seed in 0..200 {
        let mut random = noise(seed);
        let values: Vec<f32> = (0..6 * 6 * 6).map(|_| random() as f32).collect();
        let rough = volume([6; 3], DAffine3::IDENTITY, |p| {
            values[p.x as usize + 6 * (p.y as usize + 6 * p.z as usize)]
        });
        let closed = surface(&rough, 0.5, Border::Closed);
        assert_eq!(open_sides(&closed).len(), 0, "seed {seed}");
        assert!(
            closed.volume() > 0.0 && closed.volume() < 216.0,
            "{}",
            closed.volume()
        );
        let open = surface(&rough, 0.5, Border::Open);
        for side in open_sides(&open) {
            let on_box = |i: u32| {
                let p = open.positions[i as usize].to_array();
                [0, 1, 2].map(|k| p[k].abs() < 1e-9 || (p[k] - 6.0).abs() < 1e-9)
            };
            let [a, b] = side.map(on_box);
            assert!(
                (0..3).any(|k| a[k] && b[k]),
                "seed {seed}: a crack inside the box"
            );
        }
        ambiguous += open.triangles.len();
    }
    println!("{ambiguous} triangles of rough fields");
}

#[test]
fn a_full_volume_that_is_closed_is_the_grid_box_wherever_it_lies() {
    let shear = DMat3::from_cols(
        DVec3::new(0.5, 0.1, 0.0),
        DVec3::new(0.2, -2.0, 0.3),
        DVec3::new(0.0, 0.4, 3.0),
    );
    let affine = DAffine3::from_mat3_translation(shear, DVec3::new(100.0, -40.0, 7.0));
    let full = volume([4, 3, 2], affine, |_| 1.0);
    let mesh = surface(&full, 0.5, Border::Closed);
    let wanted = 24.0 * shear.determinant().abs();
    assert!(shear.determinant() < 0.0, "the mirrored case");
    assert!(
        (mesh.volume() - wanted).abs() < 1e-9 * wanted,
        "{}",
        mesh.volume()
    );
    assert_eq!(open_sides(&mesh).len(), 0);
    assert_eq!(surface(&full, 0.5, Border::Open).triangles.len(), 0);
    assert_eq!(surface(&full, 1.5, Border::Closed).triangles.len(), 0);
}

#[test]
fn voxels_without_data_have_no_surface() {
    let field = |p: DVec3| {
        if p.x < 2.0 {
            f32::NAN
        } else {
            (p.y - 2.2) as f32
        }
    };
    let holed = volume([6, 5, 4], DAffine3::IDENTITY, field);
    let mesh = surface(&holed, 0.0, Border::Open);
    let lowest = mesh
        .positions
        .iter()
        .map(|p| p.x)
        .fold(f64::INFINITY, f64::min);
    assert_eq!(lowest, 2.5);
    // From x = 2.5 to the grid box at 6, all of z: a plane.
    assert!((mesh.area() - 3.5 * 4.0).abs() < 1e-6, "{}", mesh.area());
}

/// Where a ray meets a triangle, as its t (Moeller and Trumbore 1997).
fn met([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let normal = direction.cross(ac);
    let det = ab.dot(normal);
    if det == 0.0 {
        return None;
    }
    let from_a = origin - a;
    let u = from_a.dot(normal) / det;
    let across = from_a.cross(ab);
    let v = direction.dot(across) / det;
    let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    is_inside.then(|| ac.dot(across) / det)
}

#[test]
fn rays_meet_the_mesh_where_they_meet_the_surface_on_an_oblique_grid() {
    let matrix = DMat3::from_cols(
        DVec3::new(1.1, 0.2, -0.1),
        DVec3::new(-0.3, 0.9, 0.2),
        DVec3::new(0.1, 0.3, 1.6),
    );
    let affine = DAffine3::from_mat3_translation(matrix, DVec3::new(25.0, -8.0, 100.0));
    let (middle, radius) = (DVec3::splat(11.0), 8.0);
    let ball = volume([22; 3], affine, |p| (p.distance(middle) - radius) as f32);
    let mesh = surface(&ball, 0.0, Border::Open);
    let center = affine.transform_point3(middle);
    let camera = Camera {
        eye: center + 60.0 * DVec3::new(0.5, -0.7, 0.4),
        target: center,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_degrees: 25.0 },
        zoom: 1.0,
    };
    let mut settings = Settings {
        mode: Mode::Iso,
        conformance: true,
        ..Settings::default()
    };
    settings.per_mode.levels = vec![Level {
        value: 0.0,
        srgb: [1.0; 3],
        opacity: 1.0,
    }];
    let scene = Scene {
        volume: &ball,
        transfer: None,
        beside: Beside::Nothing,
        camera: &camera,
        extent_pixels: [24, 20],
        settings: &settings,
    };
    let picture = reference::render::<f64>(&scene).expect("a picture");
    let is_depth = |layer: &&Layer| layer.kind == LayerKind::Depth;
    let depths = &picture.layers.iter().find(is_depth).expect("depths").values;
    let rays = camera.rays(scene.extent_pixels);
    let corner = |i: u32| mesh.positions[i as usize];
    let voxel_from_world = affine.inverse();
    let mut seen = 0;
    for (i, &depth) in depths.iter().enumerate() {
        let [x, y] = [i % 24, i / 24].map(|n| n as f64 + 0.5);
        let (origin, direction) = rays.at(x, y);
        let of_triangle = |of: &[u32; 3]| met(of.map(corner), origin, direction);
        let first = mesh.triangles.iter().filter_map(of_triangle);
        let first = first.fold(f64::INFINITY, f64::min);
        // How steeply the ray meets the ball, where it meets it.
        let [o, d] = [
            voxel_from_world.transform_point3(origin),
            voxel_from_world.transform_vector3(direction),
        ];
        let way = (middle - o).dot(d) / d.length_squared();
        let aside = (o + way * d).distance(middle);
        if aside > 0.85 * radius {
            continue;
        }
        seen += 1;
        // Triangles and trilinear interpolation each lie up to 3 / (8 R) voxels from the ball (the sagitta of a cell's
        // diagonal), and the ray goes through that at an angle. A step in t is so many voxels.
        let cosine = (1.0 - (aside / radius).powi(2)).sqrt();
        let allowed = 2.0 * 3.0 / (8.0 * radius) / cosine / d.length();
        let off = (f64::from(depth) - first).abs();
        assert!(
            off <= allowed,
            "pixel {i}: {depth} and {first}, allowed {allowed}"
        );
    }
    assert!(seen > 60, "{seen} rays");
}

#[test]
fn a_file_holds_the_triangles() {
    let ball = volume([8; 3], DAffine3::from_translation(DVec3::splat(1e5)), |p| {
        (2.7 - p.distance(DVec3::splat(4.0))) as f32
    });
    let mesh = surface(&ball, 0.0, Border::Open);
    let written = |format| {
        let mut bytes = Vec::new();
        mesh.write(format, &mut bytes).expect("written to memory");
        bytes
    };
    let [corners, triangles] = [mesh.positions.len(), mesh.triangles.len()];

    let ply = written(MeshFormat::Ply);
    let text = String::from_utf8_lossy(&ply);
    assert!(text.contains(&format!("element vertex {corners}\n")));
    let header = ply
        .windows(11)
        .position(|w| w == b"end_header\n")
        .expect("a header")
        + 11;
    assert_eq!(ply.len(), header + 36 * corners + 13 * triangles);
    let first: [f64; 3] = std::array::from_fn(|k| {
        f64::from_le_bytes(ply[header + 8 * k..][..8].try_into().expect("8 bytes"))
    });
    assert_eq!(DVec3::from_array(first), mesh.positions[0]);

    let stl = written(MeshFormat::Stl);
    assert_eq!(stl.len(), 84 + 50 * triangles);
    assert!(!stl.starts_with(b"solid"));
    assert_eq!(stl[80..84], (triangles as u32).to_le_bytes());

    let glb = written(MeshFormat::Glb);
    let number =
        |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("4 bytes")) as usize;
    assert_eq!(
        (&glb[..4], number(4), number(8)),
        (&b"glTF"[..], 2, glb.len())
    );
    let json_bytes = number(12);
    let json: serde_json::Value = serde_json::from_slice(&glb[20..20 + json_bytes]).expect("JSON");
    assert_eq!(json["accessors"][0]["count"], corners);
    assert_eq!(json["accessors"][2]["count"], 3 * triangles);
    let binary = 20 + json_bytes + 8;
    assert_eq!(number(binary - 8), glb.len() - binary);
    assert_eq!(json["buffers"][0]["byteLength"], glb.len() - binary);
    let origin = json["nodes"][0]["translation"][0]
        .as_f64()
        .expect("a number");
    let x = f32::from_le_bytes(glb[binary..binary + 4].try_into().expect("4 bytes"));
    // Told from the middle, a hundred kilometres away cost no digits.
    assert!((origin + f64::from(x) - mesh.positions[0].x).abs() < 1e-6);
}
