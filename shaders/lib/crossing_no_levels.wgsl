// No surfaces.

#import among_levels

fn entered(at: AmongLevels, voxel: Ray, t: f32, may_cross: bool) -> AmongLevels {
    return at;
}

fn may_cross_in(cell: vec3<i32>) -> bool {
    return false;
}

fn nearer_end(at: AmongLevels, t: f32, reach: f32, end: f32) -> f32 {
    return reach;
}

fn moved(at: AmongLevels, voxel: Ray, start: f32, end: f32) -> AmongLevels {
    return at;
}

fn reached(at: AmongLevels, end: f32) -> f32 {
    return end;
}

fn has_crossed(at: AmongLevels) -> bool {
    return false;
}
