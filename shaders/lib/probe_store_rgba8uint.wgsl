@group(0) @binding(0) var stored: texture_storage_2d<rgba8uint, write>;

alias Number = u32;
