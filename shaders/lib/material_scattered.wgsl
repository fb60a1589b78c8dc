// Light that matter scatters once on its way to the eye (Kajiya and Von Herzen 1984). In place of its colour a sample has
//
//     S = albedo (sum over lights of p(c) E T + T_sky sky)        E = pi colour,  c between the directions of travel
//
// Where light is not followed from here on, T comes from the light volume. CPU reference: src/technique/scattered_light.rs.

#import transfer_{transfer}
#import light_depth
#import light_ray
#import phase

fn material_of(sample: Sample) -> Classified {
    let material = classify(sample.value);
    // What is transparent shows no light, and a cut face, seen along no direction, its own colour.
    if material.extinction == 0.0 || all(sample.ray_direction == vec3(0.0)) {
        return material;
    }
    let voxel = voxel_of(sample.place);
    var light = scattered_light(0u, voxel, frame.occlusion_strength != 0.0) * frame.path_sky;
    for (var i = 0u; i < frame.light_count; i++) {
        let way = frame.light_directions[i].xyz;
        var through = 1.0;
        if frame.scattering_depth == 0.0 {
            through = scattered_light(frame.shadow_bundle + i, voxel, frame.has_shadows != 0u);
        } else {
            through = through_to(voxel, way);
        }
        let part = 3.1415927 * phase_value(dot(sample.ray_direction, way)) * through;
        light += part * frame.light_colors[i].xyz;
    }
    return Classified(frame.path_albedo * material.color * light, material.extinction);
}
