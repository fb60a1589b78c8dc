// Two-sided light of Blinn and Phong on the surface that stands across the gradient (`sampling.md` 7):
//
//     c (ambient + diffuse sum of L |n.l|) + specular sum of L |n.h|^shininess        h = (l + v) / |l + v|
//
// with L the light's colour, l the way to it, v the way to the eye. Where the gradient is flat there is no surface
// and the colour stays. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
// Twin: src/technique/shading.rs.

#import frame

fn shade(color: vec3<f32>, gradient: vec3<f32>, ray_direction: vec3<f32>) -> vec3<f32> {
    let steepness = length(gradient);
    if !(steepness >= frame.flat_gradient) || steepness == 0.0 {
        return color;
    }
    let normal = gradient / steepness;
    var lit = frame.ambient * color;
    for (var i = 0u; i < frame.light_count; i++) {
        let light = frame.light_directions[i];
        // A headlight shines along the ray.
        let towards_light = select(light.xyz, -ray_direction, light.w != 0.0);
        let halfway = towards_light - ray_direction;
        // Behind the surface and against the eye no halfway stands out.
        let facing = abs(dot(normal, halfway)) / max(length(halfway), 1e-6);
        let diffuse = frame.diffuse * abs(dot(normal, towards_light));
        let specular = frame.specular * pow(min(facing, 1.0), frame.shininess);
        lit += frame.light_colors[i].xyz * (diffuse * color + specular);
    }
    return lit;
}
