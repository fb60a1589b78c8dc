@group(0) @binding(0) var stored: texture_storage_2d<r32float, write>;

alias Number = f32;
