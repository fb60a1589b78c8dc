// Pictures of paths whose layers somebody asks for.

#import path_layers

// Means: albedo and whether there is a first collision; normal and depth; direct light and bounces; indirect light and samples;
// emission.
@group(0) @binding(15) var path_layers: texture_storage_2d_array<rgba32float, write>;

fn leaves_layers() -> bool {
    return true;
}

fn with_first(layers: PathLayers, albedo: vec3<f32>, normal: vec3<f32>, depth: f32) -> PathLayers {
    var next = layers;
    next.albedo += albedo;
    next.normal += normal;
    next.depth += depth;
    next.met += 1.0;
    return next;
}

fn with_light(layers: PathLayers, light: vec3<f32>, scatterings: u32) -> PathLayers {
    var next = layers;
    if scatterings == 0u {
        next.emission += light;
    } else if scatterings == 1u {
        next.direct += light;
    } else {
        next.indirect += light;
    }
    return next;
}

fn with_bounce(layers: PathLayers) -> PathLayers {
    var next = layers;
    next.bounces += 1.0;
    return next;
}

fn with_sample(layers: PathLayers) -> PathLayers {
    var next = layers;
    next.samples += 1.0;
    return next;
}

fn leave_layers(pixel: vec2<u32>, layers: PathLayers, count: f32) {
    textureStore(path_layers, pixel, 0u, vec4(layers.albedo, layers.met) / count);
    textureStore(path_layers, pixel, 1u, vec4(layers.normal, layers.depth) / count);
    textureStore(path_layers, pixel, 2u, vec4(layers.direct, layers.bounces) / count);
    textureStore(path_layers, pixel, 3u, vec4(layers.indirect, layers.samples) / count);
    textureStore(path_layers, pixel, 4u, vec4(layers.emission, 0.0) / count);
}
