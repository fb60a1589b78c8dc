// Two-sided light of Blinn and Phong on the surface that stands across the gradient (`sampling.md` 7):
//
//     c (o ambient + diffuse sum of t L |n.l|) + specular sum of t L |n.h|^shininess        h = (l + v) / |l + v|
//
// with L the light's colour, l the way to it, v the way to the eye; o and t what comes through from all around and
// from the light, 1 without occlusion and shadows (light.wgsl). Where the gradient is flat there is no surface and the
// colour stays, as far as light comes there: c (o a + (1 - a) sum of t L / sum of L), a = min(ambient, 1). The two are
// mixed by the gradient's magnitude g: w surface + (1 - w) flat, w = g / (g + half_gradient).
// Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
// Who imports this also imports where that light is known: light or light_unhindered. CPU reference: src/technique/shading.rs.

#import frame
#import norm

// At a position in voxel space.
fn shade(color: vec3<f32>, gradient: vec3<f32>, ray_direction: vec3<f32>, voxel: vec3<f32>) -> vec3<f32> {
    let ambient_light = ambient_at(voxel, ray_direction);
    let steepness = norm(gradient);
    let is_flat = !(steepness >= frame.flat_gradient) || steepness == 0.0;
    if is_flat && frame.has_shadows == 0u {
        return ambient_light * color;
    }
    let normal = gradient / select(steepness, 1.0, is_flat);
    var lit = frame.ambient * ambient_light * color;
    var all = vec3(0.0);
    var there = vec3(0.0);
    for (var i = 0u; i < frame.light_count; i++) {
        let light = frame.light_directions[i];
        // A headlight shines along the ray.
        let towards_light = select(light.xyz, -ray_direction, light.w != 0.0);
        let halfway = towards_light - ray_direction;
        // Behind the surface and against the eye no halfway stands out.
        let facing = abs(dot(normal, halfway)) / max(norm(halfway), 1e-6);
        let diffuse = frame.diffuse * abs(dot(normal, towards_light));
        let specular = frame.specular * pow(min(facing, 1.0), frame.shininess);
        let arriving = lamp_at(i, voxel) * frame.light_colors[i].xyz;
        lit += arriving * (diffuse * color + specular);
        all += frame.light_colors[i].xyz;
        there += arriving;
    }
    var even = ambient_light * color;
    if frame.has_shadows != 0u {
        // A colour that no light has is missing nothing.
        let shares = select(vec3(1.0), there / max(all, vec3(1e-6)), all > vec3(1e-6));
        let ambient = min(frame.ambient, 1.0);
        even = color * (ambient * ambient_light + (1.0 - ambient) * shares);
    }
    // Where the half gradient is 0 this is 1 whatever a division is rounded to.
    let surface = select(1.0 - frame.half_gradient / (steepness + frame.half_gradient), 0.0, is_flat);
    return (1.0 - surface) * even + surface * lit;
}
