@group(0) @binding(0) var loaded: texture_storage_2d<rgba32sint, read>;

alias Number = i32;
