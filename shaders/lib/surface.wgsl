// How a surface reflects: Lambert, or matter under a rough dielectric (Ashikhmin and Shirley 2000 over GGX, Walter et al. 2007).
// w to the eye, w' to the light, n the normal, m = n . w, m' = n . w', h the half vector, a = roughness^2:
//
//     pi f m' = albedo m'                                                                              f0 = 0
//     pi f m' = pi m' (28 albedo / 23 pi (1 - f0) (1 - (1 - m/2)^5) (1 - (1 - m'/2)^5) + D V F)        else
//     D = a^2 / (pi ((n . h)^2 (a^2 - 1) + 1)^2)    F = f0 + (1 - f0) (1 - w . h)^5 (Schlick 1994)
//     V = 1/2 / (m' s(m) + m s(m'))                 s(m) = sqrt(a^2 + (1 - a^2) m^2) (Heitz 2014)
//
// Half vectors are drawn among those that the eye sees (Dupuy and Benyoub 2023). CPU reference:
// src/technique/pathtrace/surface.rs.

#import frame
#import norm
#import elementary

// The least chance that a direction is drawn by the coat.
const LEAST_OF_COAT: f32 = 0.25;

fn fifth_power(x: f32) -> f32 {
    let q = x * x;
    return q * q * x;
}

// Of light that is mirrored: f0 straight across, 1 along the surface.
fn fresnel(cosine: f32) -> f32 {
    return frame.path_f0 + (1.0 - frame.path_f0) * fifth_power(max(1.0 - cosine, 0.0));
}

fn masking(cosine: f32) -> f32 {
    let a = frame.path_alpha;
    return sqrt(a * a + (1.0 - a * a) * cosine * cosine);
}

// The density of half vectors by how far they lie off the normal.
fn half_vectors(cosine: f32) -> f32 {
    let a = frame.path_alpha;
    let d = cosine * cosine * (a * a - 1.0) + 1.0;
    return a * a / (3.1415927 * d * d);
}

// pi f m': what of a light of colour 1 comes to the eye. For f0 = 0 without its albedo.
fn reflected(normal: vec3<f32>, to_eye: vec3<f32>, to_light: vec3<f32>, albedo: vec3<f32>) -> vec3<f32> {
    let light = dot(normal, to_light);
    if frame.path_f0 == 0.0 {
        return vec3(max(light, 0.0));
    }
    let eye = dot(normal, to_eye);
    if light <= 0.0 || eye <= 0.0 {
        return vec3(0.0);
    }
    let between = direction_of(to_eye + to_light);
    let coat = half_vectors(dot(normal, between)) * 0.5 / (light * masking(eye) + eye * masking(light))
        * fresnel(dot(to_eye, between));
    let below = 28.0 / 23.0 * (1.0 - frame.path_f0)
        * (1.0 - fifth_power(1.0 - 0.5 * eye)) * (1.0 - fifth_power(1.0 - 0.5 * light));
    return light * (below * albedo + 3.1415927 * coat);
}

struct Reflection {
    direction: vec3<f32>,
    // f m' over the density of directions; of Lambert without its albedo.
    weight: vec3<f32>,
    // Per steradian.
    density: f32,
}

// How often a direction is drawn, per steradian.
fn reflection_density(normal: vec3<f32>, to_eye: vec3<f32>, way: vec3<f32>) -> f32 {
    let lambert = max(dot(normal, way), 0.0) / 3.1415927;
    if frame.path_f0 == 0.0 {
        return lambert;
    }
    let eye = dot(normal, to_eye);
    let by_coat = chance_of_coat(eye);
    let between = direction_of(to_eye + way);
    let coat = 0.5 * half_vectors(dot(normal, between)) / (eye + masking(eye));
    return by_coat * coat + (1.0 - by_coat) * lambert;
}

fn chance_of_coat(cosine: f32) -> f32 {
    return LEAST_OF_COAT + (1.0 - LEAST_OF_COAT) * fresnel(cosine);
}

// A direction, and what a path that goes on there is multiplied by.
fn reflection(normal: vec3<f32>, to_eye: vec3<f32>, albedo: vec3<f32>, numbers: vec4<f32>) -> Reflection {
    let lambert = around(normal, sqrt(1.0 - numbers.z), numbers.w);
    if frame.path_f0 == 0.0 {
        return Reflection(lambert, vec3(1.0), dot(normal, lambert) / 3.1415927);
    }
    let eye = dot(normal, to_eye);
    let by_coat = chance_of_coat(eye);
    let way = select(lambert, mirrored(normal, to_eye, numbers.zw), numbers.y < by_coat);
    let light = dot(normal, way);
    if light <= 0.0 || eye <= 0.0 {
        return Reflection(way, vec3(0.0), 0.0);
    }
    let density = reflection_density(normal, to_eye, way);
    return Reflection(way, reflected(normal, to_eye, way, albedo) / (3.1415927 * density), density);
}

// By a half vector of those that the eye sees: of a sphere that is flattened to the ellipsoid of the normals.
fn mirrored(normal: vec3<f32>, to_eye: vec3<f32>, numbers: vec2<f32>) -> vec3<f32> {
    let up = dot(normal, to_eye);
    let stretched = direction_of(frame.path_alpha * (to_eye - up * normal) + up * normal);
    let height = dot(normal, stretched);
    let of_sphere = around(normal, (1.0 - numbers.x) * (1.0 + height) - height, numbers.y) + stretched;
    let h = dot(normal, of_sphere);
    let between = direction_of(frame.path_alpha * (of_sphere - h * normal) + h * normal);
    return 2.0 * dot(to_eye, between) * between - to_eye;
}
