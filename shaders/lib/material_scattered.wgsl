// Light that matter scatters once on its way to the eye (Kajiya and Von Herzen 1984). In place of its colour a sample has
//
//     S = albedo (sum over lights of p(c) E T + T_sky sky) + emission / sigma
//
// with E = pi colour and c between the directions of travel, and of a point pi colour d^2 times the mean of 1 / r^2 over its segment, d the distance where that is pi colour. Where light is
// not followed from here on, T comes from the light volume. CPU reference: src/technique/scattered_light.rs.

#import transfer_{transfer}
#import light_depth
#import light_ray
#import phase
#import point_light
#import medium

// Optical depth of a step of matter that only shines: so little that its light is emission d, and that nothing is in the way.
const LEAST_DEPTH: f32 = 1.0 / 16777216.0;

fn material_of(sample: Sample) -> Classified {
    let material = classify(sample.value);
    // A cut face, seen along no direction, shows its own colour.
    if all(sample.ray_direction == vec3(0.0)) {
        return material;
    }
    var source = vec3(0.0);
    if material.extinction > 0.0 {
        source = material.color * light_from_lights(sample);
    }
    if frame.emission_point_count == 0u {
        return Classified(source, material.extinction);
    }
    let extinction = max(material.extinction, LEAST_DEPTH / frame.step_world);
    return Classified(source + emission_at(sample.value) / extinction, extinction);
}

// Of albedo 1.
fn light_from_lights(sample: Sample) -> vec3<f32> {
    let voxel = voxel_of(sample.place);
    let place = vec4(voxel, 1.0) * frame.world_from_voxel;
    var light = scattered_light(0u, voxel, frame.occlusion_strength != 0.0) * frame.path_sky;
    for (var i = 0u; i < frame.light_count; i++) {
        var way = frame.light_directions[i].xyz;
        var reach = 3.4e38;
        var part = 3.1415927;
        if frame.light_directions[i].w != 0.0 {
            let to_light = way - place;
            reach = max(sqrt(dot(to_light, to_light)), 1e-15);
            way = to_light / reach;
            part *= mean_of_falloff(to_light, sample.ray_direction);
        }
        if frame.scattering_depth == 0.0 {
            part *= scattered_light(frame.shadow_bundle + i, voxel, frame.has_shadows != 0u);
        } else {
            part *= through_to(Ray(place, way), voxel, reach);
        }
        light += part * phase_value(dot(sample.ray_direction, way)) * frame.light_colors[i].xyz;
    }
    return frame.path_albedo * light;
}
