// Pictures of paths without layers: what only layers tell is not computed.

#import path_layers

fn leaves_layers() -> bool {
    return false;
}

fn with_first(layers: PathLayers, albedo: vec3<f32>, normal: vec3<f32>, depth: f32) -> PathLayers {
    return layers;
}

fn with_light(layers: PathLayers, light: vec3<f32>, scatterings: u32) -> PathLayers {
    return layers;
}

fn with_bounce(layers: PathLayers) -> PathLayers {
    return layers;
}

fn with_sample(layers: PathLayers) -> PathLayers {
    return layers;
}

fn leave_layers(pixel: vec2<u32>, layers: PathLayers, count: f32) {
}
