@group(0) @binding(0) var stored: texture_storage_2d<rgba16sint, write>;

alias Number = i32;
