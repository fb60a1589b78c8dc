// Lights at a place, one by one. As a light of colour 1 far away, whose irradiance is pi, a sphere of radius R at distance r,
// of radiance L, gives at a point, from directions that are drawn evenly from the cone that it fills,
//
//     colour = L 2 w,  w = 1 - cosine of half the cone = s / (1 + sqrt(1 - s)),  s = (R / r)^2        L = colour d^2 / R^2
//
// d its distance from what the camera is turned to, where its light is that of its colour. In the sphere light comes from
// all around. A disc shines from one side, L = colour (d^2 + R^2) / R^2, and is drawn by the sphere around it: directions that
// miss it bring nothing, so that no point, however near, has more than the sphere gives. CPU reference:
// src/technique/pathtrace/lamp.rs.

#import frame
#import elementary

struct LampLight {
    way: vec3<f32>,
    // World length to where the light begins.
    reach: f32,
    color: vec3<f32>,
}

fn is_lamp(i: u32) -> bool {
    return frame.light_directions[i].w != 0.0;
}

fn light_of_lamp(i: u32, place: vec3<f32>, numbers: vec2<f32>) -> LampLight {
    let lamp = frame.lamps[i];
    let to_lamp = frame.light_directions[i].xyz - place;
    let squared = max(dot(to_lamp, to_lamp), 1e-30);
    let part = lamp.w * lamp.w / squared;
    let is_inside = part >= 1.0;
    let cone = select(part / (1.0 + sqrt(max(1.0 - part, 0.0))), 2.0, is_inside);
    let aside = numbers.x * cone;
    let way = around(to_lamp / sqrt(squared), 1.0 - aside, numbers.y);
    // Half of the chord that the direction cuts from the sphere.
    let chord = sqrt(max(lamp.w * lamp.w - squared * aside * (2.0 - aside), 0.0));
    let middle = sqrt(squared) * (1.0 - aside);
    let color = 2.0 * cone * frame.light_colors[i].xyz;
    if all(lamp.xyz == vec3(0.0)) {
        return LampLight(way, middle + select(-chord, chord, is_inside), color);
    }
    let t = dot(lamp.xyz, to_lamp) / dot(lamp.xyz, way);
    let beside = t * way - to_lamp;
    let is_met = dot(lamp.xyz, way) < 0.0 && t > 0.0 && dot(beside, beside) <= lamp.w * lamp.w;
    return LampLight(way, t, select(vec3(0.0), color, is_met));
}
