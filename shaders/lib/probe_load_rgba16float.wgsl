@group(0) @binding(0) var loaded: texture_storage_2d<rgba16float, read>;

alias Number = f32;
