//! Surfaces from files: what is written is read again, what is wrong is refused, and what no file makes of memory.

use crate::files::{Folder, message};
use crate::memory;
use crate::mutate::{Mutation, Random, mutate};
use glam::{DVec3, Vec3, dvec3, vec3};
use std::panic::{AssertUnwindSafe, catch_unwind};
use stratavox::format::mesh::{MeshFile, is_mesh, read_mesh};
use stratavox::mesh::{Mesh, MeshFormat};
use stratavox::volume::Limits;

/// Bytes of a corner in memory, 48 and when lists grow twice as many for a moment, over the shortest in a file, three times "0 "
/// or three bytes; the rest is the file itself.
const MOST_TIMES: usize = 3 * 48 / 3 + 2;
const BESIDE_BYTES: usize = 1 << 16;

fn read(name: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    let folder = Folder::new();
    let path = folder.write(name, bytes);
    read_mesh(&path, &Limits::default()).map_err(|error| message(&error))
}

/// A tetrahedron far from the origin, in colours.
fn tetrahedron() -> Mesh {
    let at = |x, y, z| dvec3(x, y, z) + dvec3(1000.0, -250.0, 12.5);
    Mesh {
        positions: vec![
            at(0.0, 0.0, 0.0),
            at(4.0, 0.0, 0.0),
            at(0.0, 4.0, 0.0),
            at(0.0, 0.0, 4.0),
        ],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
        colors: vec![
            vec3(1.0, 0.0, 0.0),
            vec3(0.0, 0.5, 0.0),
            vec3(0.0, 0.0, 0.25),
            Vec3::ONE,
        ],
    }
}

fn written(format: MeshFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    tetrahedron().write(format, &mut bytes).expect("written");
    bytes
}

/// Corners of each triangle.
fn corners(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let corner = |i: u32| mesh.positions[i as usize];
    mesh.triangles.iter().map(|t| t.map(corner)).collect()
}

#[test]
fn what_is_written_is_read_again() {
    let truth = tetrahedron();
    for (format, name) in [
        (MeshFormat::Ply, "a.ply"),
        (MeshFormat::Stl, "a.stl"),
        (MeshFormat::Glb, "a.glb"),
    ] {
        let file = read(name, &written(format)).expect(name);
        assert_eq!(corners(&file.mesh), corners(&truth), "{name}");
        assert_eq!(file.normals.len(), file.mesh.positions.len());
        if format == MeshFormat::Stl {
            // Each corner has the normal of its triangle.
            assert_eq!(file.normals[3], vec3(0.0, -1.0, 0.0));
        } else {
            for (found, wanted) in file.normals.iter().zip(truth.normals()) {
                assert!((*found - wanted).length() < 1e-6, "{name}");
            }
        }
        let wanted = if format == MeshFormat::Glb {
            truth.colors.clone()
        } else {
            vec![]
        };
        assert_eq!(file.mesh.colors, wanted, "{name}");
    }
}

const STL: &str = "solid a\nfacet normal 0 0 1\n outer loop\n  vertex 1000 -250 12.5\n  vertex 1004 -250 12.5\n  vertex 1000 -246 1.25e1\n \
                   endloop\nendfacet\nendsolid a\n";

/// A square of four corners and a triangle, faces with a number before them, and an element that nobody asks for.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty uchar red\nproperty float x\nproperty float y\nproperty float z\n\
                   property uchar green\nproperty uchar blue\nelement edge 1\nproperty list uchar int ends\nelement face 2\nproperty short tag\n\
                   property list uchar int vertex_index\nend_header\n255 0 0 0 0 0\n0 1 0 0 255 0\n0 1 1 0 0 255\n0 0 1 0 0 188\n255 2 2 2 255 255\n\
                   2 0 1\n7 4 0 1 2 3\n-7 3 4 1 2\n";

#[test]
fn words_and_polygons_are_read() {
    let file = read("a.stl", STL.as_bytes()).expect("words");
    let [a, _, c] = corners(&file.mesh)[0];
    assert_eq!(
        (a, c),
        (dvec3(1000.0, -250.0, 12.5), dvec3(1000.0, -246.0, 12.5))
    );
    assert_eq!(file.normals, [Vec3::Z; 3]);
    let file = read("a.ply", PLY.as_bytes()).expect("words");
    assert_eq!(file.mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 1, 2]]);
    assert_eq!(file.mesh.positions[2], dvec3(1.0, 1.0, 0.0));
    assert_eq!(file.mesh.colors[1], Vec3::Y);
    // 188 of 255 in sRGB is half of the light: ((188/255 + .055) / 1.055)^2.4.
    let half = ((188.0_f64 / 255.0 + 0.055) / 1.055).powf(2.4);
    assert!((f64::from(file.mesh.colors[3].z) - half).abs() < 1e-6);
    // The same in bytes of the other order.
    let (head, _) = PLY.split_once("end_header\n").expect("a head");
    let head = head.replace("ascii", "binary_big_endian") + "end_header\n";
    let mut bytes = head.into_bytes();
    for ([r, g, b], [x, y, z]) in [
        ([255, 0, 0], [0.0_f32, 0.0, 0.0]),
        ([0, 255, 0], [1.0, 0.0, 0.0]),
        ([0, 0, 255], [1.0, 1.0, 0.0]),
        ([0, 0, 188], [0.0, 1.0, 0.0]),
        ([255, 255, 255], [2.0, 2.0, 2.0]),
    ] {
        bytes.push(r);
        [x, y, z].iter().for_each(|n| bytes.extend(n.to_be_bytes()));
        bytes.extend([g, b]);
    }
    let list = |bytes: &mut Vec<u8>, numbers: &[i32]| {
        bytes.push(numbers.len() as u8);
        numbers.iter().for_each(|n| bytes.extend(n.to_be_bytes()));
    };
    list(&mut bytes, &[0, 1]);
    bytes.extend(7_i16.to_be_bytes());
    list(&mut bytes, &[0, 1, 2, 3]);
    bytes.extend((-7_i16).to_be_bytes());
    list(&mut bytes, &[4, 1, 2]);
    assert_eq!(read("a.ply", &bytes), Ok(file));
}

/// A glTF file of this text and these bytes.
fn glb(text: &str, binary: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text[..]), (b"BIN\0", binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

/// Two nodes with one triangle each, strided corners, bytes for indices, a material.
const GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":1,"scenes":[{},{"nodes":[0]}],"nodes":[
{"children":[1],"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678]},{"mesh":0,"scale":[2,3,-4]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":2},"indices":1,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.25,1]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"},
{"bufferView":0,"byteOffset":12,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],
"bufferViews":[{"buffer":0,"byteLength":48,"byteStride":16},{"buffer":0,"byteOffset":48,"byteLength":4}],"buffers":[{"byteLength":52}]}"#;

fn gltf_bytes() -> Vec<u8> {
    let mut bytes = Vec::new();
    for corner in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]] {
        corner.iter().for_each(|n| bytes.extend(n.to_le_bytes()));
        bytes.extend([255, 51, 0, 255]);
    }
    bytes.extend([2, 1, 0, 0]);
    bytes
}

#[test]
fn nodes_of_gltf_are_placed_by_all_above_them() {
    let file = read("a.glb", &glb(GLTF, &gltf_bytes())).expect("a scene");
    // Scaled, then a quarter turn from x to y, then moved.
    let wanted = [[10.0, 0.0, 0.0], [10.0, 2.0, 0.0], [7.0, 0.0, -4.0]];
    for (found, wanted) in file.mesh.positions.iter().zip(wanted) {
        assert!(
            (*found - DVec3::from_array(wanted)).length() < 1e-7,
            "{found}"
        );
    }
    assert_eq!(file.mesh.triangles, [[2, 1, 0]]);
    let wanted = vec3(0.5, 0.2, 0.0);
    assert!(
        file.mesh
            .colors
            .iter()
            .all(|c| (*c - wanted).length() < 1e-6)
    );
}

#[test]
fn lies_and_files_of_other_kinds_are_refused_by_what_is_wrong() {
    let ply = |from: &str, to: &str| read("a.ply", PLY.replacen(from, to, 1).as_bytes());
    let stl = |from: &str, to: &str| read("a.stl", STL.replacen(from, to, 1).as_bytes());
    let glb =
        |from: &str, to: &str| read("a.glb", &glb(&GLTF.replacen(from, to, 1), &gltf_bytes()));
    let mut long = written(MeshFormat::Stl);
    long[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut version = written(MeshFormat::Glb);
    version[4] = 1;
    for (found, wanted) in [
        (
            ply("vertex 5", "vertex 4000000000"),
            "ply field `vertex 7`: wanted a number more",
        ),
        (
            ply("4 0 1 2 3", "4 0 1 2 5"),
            "ply field `face 0`: wanted numbers of corners under 5, found `0 2 5`",
        ),
        (
            ply("3 4 1 2", "2 4 1"),
            "ply field `face 1`: wanted three corners at least, found `2`",
        ),
        (
            ply("4 0 1 2 3", "255 0 1 2 3"),
            "ply field `face 0: length of vertex_index`: wanted 0 to",
        ),
        (
            ply("vertex_index", "corners"),
            "no `property list vertex_indices`",
        ),
        (
            ply("property float z", "property float w"),
            "no `property x, y and z`",
        ),
        (
            ply("0 1 0 0 255 0", "0 nan 0 0 255 0"),
            "ply field `vertex 1`: wanted three finite numbers",
        ),
        (
            ply("element face 2", "element tristrips 2"),
            "strips of triangles",
        ),
        (
            stl("vertex 1004 -250 12.5", "vertex 1004 -250"),
            "stl field `line 5`: wanted facet",
        ),
        (
            stl("vertex 1004 -250 12.5\n", "\n"),
            "stl field `line 8`: wanted three corners before it, found `2`",
        ),
        (
            stl("1.25e1", "1.25e999"),
            "stl field `line 8`: wanted three finite numbers",
        ),
        (stl("endsolid a\n", ""), "stl field `end`: wanted endsolid"),
        (
            read("a.stl", &long),
            "stl field `length`: wanted the 214748364834 bytes that 4294967295 triangles take",
        ),
        (
            read("a.stl", b"hello"),
            "stl field `length`: wanted 84 bytes at least, or a text that begins with solid",
        ),
        (
            read("a.stl", b"solid\nendsolid\n"),
            "stl field `triangles`: wanted one at least, found `none`",
        ),
        (
            read("a.glb", &version),
            "glb field `version`: wanted 2, found `1`",
        ),
        (
            glb("\"count\":3", "\"count\":300000000"),
            "glb field `POSITION`: wanted rows of 12 bytes inside of its view",
        ),
        (
            glb("\"children\":[1]", "\"children\":[1,1]"),
            "glb field `nodes[1]`: wanted a node of 2, under one parent",
        ),
        (
            glb("\"children\":[1]", "\"children\":[0]"),
            "glb field `nodes[0]`: wanted a node of 2, under one parent",
        ),
        (
            glb("\"scene\":1", "\"scene\":2"),
            "glb field `scene`: wanted one of the scenes",
        ),
        (
            glb("\"rotation\":[0,", "\"rotation\":[1,"),
            "glb field `nodes[0].rotation`: wanted a unit quaternion",
        ),
        (
            glb("\"indices\":1,", "\"indices\":1,\"mode\":5,"),
            "primitives other than triangles",
        ),
        (
            glb(
                "{\"asset\"",
                "{\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"",
            ),
            "extension KHR_draco_mesh_compression",
        ),
        (
            glb(
                "[{\"byteLength\":52}]",
                "[{\"byteLength\":52,\"uri\":\"a.bin\"}]",
            ),
            "a buffer in a file of its own",
        ),
    ] {
        let message = found.expect_err(wanted);
        assert!(message.contains(wanted), "{message}\nwanted: {wanted}");
    }
    // Parts that are used again take the memory of each use.
    let children: Vec<String> = (1..=400).map(|n| n.to_string()).collect();
    let nodes = ",{\"mesh\":0}".repeat(399);
    let text = GLTF.replace("[1],\"tr", &format!("[{}],\"tr", children.join(",")));
    let text = text.replace(
        "\"scale\":[2,3,-4]}",
        &format!("\"scale\":[2,3,-4]}}{nodes}"),
    );
    let folder = Folder::new();
    let path = folder.write("many.glb", self::glb(&text, &gltf_bytes()));
    let limits = |max_bytes| Limits {
        max_bytes,
        ..Limits::default()
    };
    let many = read_mesh(&path, &limits(400 * 156)).expect("room for all");
    assert_eq!(many.mesh.triangles.len(), 400);
    let refused = message(&read_mesh(&path, &limits(400 * 156 - 1)).expect_err("no room"));
    assert!(refused.contains("62400"), "{refused}");
}

#[test]
fn a_ply_file_is_a_surface_where_it_has_faces() {
    let folder = Folder::new();
    let kind = |name: &str, text: &str| is_mesh(&folder.write(name, text), &Limits::default());
    assert_eq!(kind("a.ply", PLY).ok(), Some(true));
    let points = PLY.replace("element face 2", "element face 0");
    assert_eq!(kind("a.ply", &points).ok(), Some(false));
    assert_eq!(kind("a.STL", STL).ok(), Some(true));
    assert_eq!(kind("a.csv", "x,y,z,v\n0,0,0,1\n").ok(), Some(false));
}

fn bases() -> Vec<Vec<u8>> {
    vec![
        written(MeshFormat::Ply),
        written(MeshFormat::Stl),
        written(MeshFormat::Glb),
        // The name of a solid may be shorter in a file that is cut.
        STL.replace("endsolid a\n", "endsolid").into_bytes(),
        PLY.as_bytes().to_vec(),
        glb(GLTF, &gltf_bytes()),
    ]
}

#[test]
fn no_cut_file_is_a_surface() {
    for (nth, base) in bases().iter().enumerate() {
        for length in 0..base.len() {
            assert!(
                read("a", &base[..length]).is_err(),
                "base {nth} cut at {length}"
            );
        }
    }
}

#[test]
fn surfaces_survive_mutations() {
    let count = crate::survive::mutations();
    let folder = Folder::new();
    let (mut refused, mut given, mut most) = (0_u64, 0_u64, 0.0_f64);
    let bases = bases();
    for number in 0..count {
        let mut random = Random::new(number);
        let base = &bases[(number % bases.len() as u64) as usize];
        let (bytes, mutation) = mutate(base, &mut random);
        let path = folder.write("a", &bytes);
        memory::start();
        let found = catch_unwind(AssertUnwindSafe(|| read_mesh(&path, &Limits::default())));
        let memory = memory::peak_since_start();
        let found = found.unwrap_or_else(|_| panic!("mutation {number}, {mutation:?}: a panic"));
        most = most.max(memory as f64 / (bytes.len() + BESIDE_BYTES) as f64);
        assert!(
            memory <= MOST_TIMES * bytes.len() + BESIDE_BYTES,
            "mutation {number}, {mutation:?}: {memory} bytes of memory for {}",
            bytes.len()
        );
        match found {
            Err(_) => refused += 1,
            Ok(MeshFile { mesh, normals }) => {
                given += 1;
                let corners = mesh.positions.len();
                assert!(
                    mesh.positions.iter().all(|p| p.is_finite()),
                    "mutation {number}"
                );
                assert!(normals.len() == corners && normals.iter().all(|n| n.is_normalized()));
                assert!(mesh.colors.is_empty() || mesh.colors.len() == corners);
                let mut numbers = mesh.triangles.iter().flatten();
                assert!(
                    numbers.all(|&n| (n as usize) < corners),
                    "mutation {number}"
                );
                assert!(mutation != Mutation::Cut, "mutation {number}: a cut file");
            }
        }
    }
    println!("{count} mutations, {refused} refused, {given} read, {most:.2} times the bytes");
    assert!(refused > count / 4 && (given > 0 || count < 1000));
}
