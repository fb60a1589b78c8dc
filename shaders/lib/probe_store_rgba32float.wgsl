@group(0) @binding(0) var stored: texture_storage_2d<rgba32float, write>;

alias Number = f32;
