// What paths leave beside their picture: sums over the paths of a pixel.
//
//     picture = emission + direct + indirect + sky that the eye sees
//
// CPU reference: src/technique/pathtrace/layers.rs.

struct PathLayers {
    // Of the first real collision of each path: its albedo, the normal of the surface there towards the eye (0: in the medium), its
    // distance along the ray, and whether there is one.
    albedo: vec3<f32>,
    normal: vec3<f32>,
    depth: f32,
    met: f32,
    // Light that was scattered never (what matter shines), once, and more often.
    emission: vec3<f32>,
    direct: vec3<f32>,
    indirect: vec3<f32>,
    // How often paths are scattered, and tentative collisions of them and of their shadow rays.
    bounces: f32,
    samples: f32,
}
