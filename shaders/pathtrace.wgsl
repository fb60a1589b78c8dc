// Path tracing of a medium with surfaces (Kajiya and Von Herzen 1984; Kajiya 1986). Of one path, from the eye on:
//
//     tentative collisions  t += -ln(1 - u) / majorant           (null collisions, Woodcock et al. 1965)
//     one is real with      P = extinction / majorant            W *= albedo
//     light                 L += W p(c) E T                      T: product of 1 - P along the way (ratio tracking, Novak et al. 2014)
//     it leaves             L += W sky
//     matter shines         L += W E / majorant                  at each tentative collision
//     a surface is met with P = its opacity                      T *= 1 - opacity
//
// Of three extinctions one majorant and one chance, by what they would take of the weights (Kutz et al. 2017):
//
//     P = a / (a + b)       a = mean of W sigma                  b = mean of W (majorant - sigma)
//     real   W *= sigma / majorant / P                           null   W *= (1 - sigma / majorant) / (1 - P)
//
// The picture is the mean over paths. One loop over rounds: what is rare, collisions and ends of paths, comes once a round, behind
// some turns of the way to the next one. Drivers on CPUs go through all that stands in a loop at each of its turns, whatever is asked,
// and on others the invocations of a group are seldom at the same. Lanes that have ended a path go on with the next.
// CPU reference: src/technique/pathtrace/reference.rs.

#import host_depth
#import drawn_tile
#import filter_{filter}
#import mask
#import matter_{found}
#import distance_map
#import majorants
#import random
#import sobol
#import elementary
#import phase
#import surface
#import sky
#import lamp
#import crossing_{levels}
#import leave_{layers}

// Mean radiance of paths, and which part of them has met matter: of n paths behind b others
//
//     mean += (sum of the n - n mean) / (b + n)
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, read_write>;

// What an invocation is at: a path on its way, or a shadow ray; matter that a path has met; light that has been looked for there; a
// path that has left, one that has ended, the end of all.
const PATH: u32 = 0u;
const SHADOW: u32 = 1u;
const MET: u32 = 2u;
const SCATTER: u32 = 3u;
const LEFT: u32 = 4u;
const NEXT: u32 = 5u;
const LAST: u32 = 6u;

// Turns of a way in a round, at most.
const TURNS_OF_WAY: u32 = 8u;

// Numbers of a draw: of the way, of a collision, of the direction behind it and of that to a sky. They differ in low bits:
// numbers that pcg4d makes of keys that differ in the highest bits alone are correlated.
const NUMBERS_OF_DRAW: u32 = 4u;
const OF_COLLISION: u32 = 1u;
const OF_DIRECTION: u32 = 2u;
const OF_SKY: u32 = 3u;

// Choices of a path whose numbers fill the square evenly: where in its pixel it begins, where the light of its first collision comes
// from, and where it goes on there.
const PAIR_OF_PIXEL: u32 = 0u;
const PAIR_OF_LIGHT: u32 = 1u;
const PAIR_OF_DIRECTION: u32 = 2u;

// Behind so many bounces, weights under LEAST end by chance.
const FEWEST_BOUNCES: u32 = 4u;
const LEAST: f32 = 0.1;

// Paths that end by chance behind as many rounds as these do so slowly: drivers leave room for it.
const MANY_ROUNDS: u32 = 224u;

// Ways from a surface begin so far before it, in smallest spacings.
const LEAVES_BY: f32 = 1e-3;

struct Walk {
    world: Ray,
    voxel: Ray,
    t: f32,
    end: f32,
    // Of the collision that it is at.
    majorant: f32,
    levels: AmongLevels,
}

struct Path {
    weight: vec3<f32>,
    radiance: vec3<f32>,
    bounces: u32,
    // Turns so far: the number of the next draw.
    draw: u32,
    rounds: u32,
    has_met: bool,
    // Of its direction, per steradian.
    density: f32,
}

// Where a path has met matter, while its light is looked for.
struct Collision {
    place: vec3<f32>,
    direction: vec3<f32>,
    // 0: in the medium.
    normal: vec3<f32>,
    albedo: vec3<f32>,
    // What arrives if nothing is in the way, and the part of it that does.
    light: vec3<f32>,
    through: vec3<f32>,
    // World length to where it comes from.
    reach: f32,
    // Which side of surfaces it is on.
    rank: i32,
    // A random number of its own, which of several volumes it is in.
    met_by: f32,
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let pixel = pixel_in(drawn_tile(group), own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let number = pixel.y * frame.extent_pixels.x + pixel.x;
    let end = frame.path_first + frame.path_count;
    var sum = vec4(0.0);
    var sample = frame.path_first;
    var key = vec4(number, 0u, 0u, frame.path_seed);
    var state = NEXT;
    var path: Path;
    var walk: Walk;
    var at: Collision;
    var layers: PathLayers;
    loop {
        if state == MET {
            let is_last = path.bounces == frame.path_bounces;
            let draw = NUMBERS_OF_DRAW * (path.draw - 1u);
            var numbers: vec4<f32>;
            if !is_last || (leaves_layers() && !path.has_met) {
                key.z = draw + OF_COLLISION;
                numbers = numbers_of_bounce(key, PAIR_OF_LIGHT, path.bounces);
                at.place = walk.world.origin + walk.t * walk.world.direction;
                at.direction = walk.world.direction;
                at.rank = walk.levels.rank;
                if has_crossed(walk.levels) {
                    at.normal = facing((frame.voxel_from_world * walk.levels.slope).xyz, at.direction);
                    at.place += LEAVES_BY * frame.smallest_spacing * at.normal;
                    at.rank = walk.levels.before;
                } else {
                    let place = walk.voxel.origin + walk.t * walk.voxel.direction;
                    at.normal = normal_at(place, at.direction, vec2(numbers.x, at.met_by));
                }
            }
            if !path.has_met {
                layers = with_first(layers, at.albedo, at.normal, walk.t);
            }
            path.has_met = true;
            state = NEXT;
            if !is_last {
                at.through = vec3(1.0);
                if !is_coated(at) {
                    path.weight *= at.albedo;
                }
                key.z = NUMBERS_OF_DRAW * path.draw + OF_SKY;
                let to_light = light_at(&at, numbers, key);
                state = SCATTER;
                if any(path.weight * at.light > vec3(0.0)) {
                    walk = walk_from(at, to_light);
                    walk.end = min(walk.end, at.reach);
                    state = SHADOW;
                }
            }
        }
        if state == SCATTER {
            key.z = NUMBERS_OF_DRAW * path.draw + OF_DIRECTION;
            let numbers = numbers_of_bounce(key, PAIR_OF_DIRECTION, path.bounces);
            path.bounces++;
            layers = with_bounce(layers);
            let next = scattered(at, numbers);
            path.weight *= next.weight;
            path.density = next.density;
            path.weight *= kept(path, numbers.x);
            walk = walk_from(at, next.direction);
            state = select(NEXT, PATH, any(path.weight > vec3(0.0)));
        }
        if state == LEFT {
            let light = path.weight * sky_of(path, walk.world.direction);
            path.radiance += light;
            if path.has_met {
                layers = with_light(layers, light, path.bounces);
            }
            path.has_met = path.has_met || frame.path_sky_shown != 0u;
            state = NEXT;
        }
        if state == NEXT {
            sum += vec4(path.radiance, f32(path.has_met));
            state = LAST;
            if sample != end {
                key.y = sample;
                key.z = 0u;
                sample++;
                let in_pixel = sobol_numbers(key, PAIR_OF_PIXEL);
                let on_lens = random_numbers(key).zw;
                walk = walk_along(through_lens(pixel_ray(vec2<f32>(pixel) + in_pixel), on_lens));
                let visible = visible_interval(vec2(walk.t, walk.end), walk.world, vec2<f32>(pixel));
                walk.t = visible.x;
                walk.end = visible.y;
                path = Path(vec3(1.0), vec3(0.0), 0u, 1u, 0u, false, 0.0);
                state = PATH;
            }
        }
        // Not where the last path ends: llvmpipe of Mesa 22 counted that path again in the rounds of others.
        if state == LAST {
            break;
        }
        path.rounds++;
        for (var turn = 0u; turn < TURNS_OF_WAY && state <= SHADOW; turn++) {
            key.z = NUMBERS_OF_DRAW * path.draw;
            path.draw++;
            let u = random_numbers(key);
            let is_tentative = step_by(&walk, u.x);
            // Of each colour, that a tentative collision is a real one.
            var chances = vec3(0.0);
            var color = vec3(0.0);
            let place = walk.voxel.origin + walk.t * walk.voxel.direction;
            if is_tentative {
                layers = with_sample(layers);
            }
            if is_tentative && is_matter(place) {
                let matter = matter_at(place);
                chances = min(matter.extinctions * frame.path_density / walk.majorant, vec3(1.0));
                color = matter.color;
                if frame.emission_point_count != 0u && state == PATH {
                    let light = path.weight * matter.emission / walk.majorant;
                    path.radiance += light;
                    layers = with_light(layers, light, path.bounces);
                }
            }
            let is_crossed = has_crossed(walk.levels);
            if is_crossed {
                let level = frame.level_colors[crossed_level(walk.levels)];
                chances = vec3(level.w);
                color = level.xyz;
            }
            let chance = chance_of(path.weight, chances);
            let has_left = !is_tentative && !is_crossed && walk.t >= walk.end;
            if state == SHADOW {
                at.through *= 1.0 - chances;
                let most = max(at.through.x, max(at.through.y, at.through.z));
                if most < LEAST {
                    at.through *= select(0.0, LEAST / most, u.y * LEAST < most);
                }
                if has_left || all(at.through == vec3(0.0)) {
                    let light = path.weight * at.light * at.through;
                    path.radiance += light;
                    layers = with_light(layers, light, path.bounces + 1u);
                    state = SCATTER;
                }
            } else if has_left {
                state = LEFT;
            } else if u.y < chance {
                path.weight *= of_colors(chances, chance);
                // Without bounces matter shines: by itself, or in its colours.
                if frame.path_bounces == 0u && frame.emission_point_count == 0u {
                    path.radiance = path.weight * color;
                    layers = with_light(layers, path.radiance, 0u);
                }
                at.albedo = color * frame.path_albedo;
                at.met_by = u.z;
                state = MET;
            } else {
                path.weight *= of_colors(1.0 - chances, 1.0 - chance);
            }
        }
    }
    var mean = vec4(0.0);
    if frame.path_before != 0u {
        mean = textureLoad(picture, pixel);
    }
    let count = f32(frame.path_count);
    textureStore(picture, pixel, mean + (sum - count * mean) / (f32(frame.path_before) + count));
    leave_layers(pixel, layers, count);
}

// Numbers of a draw, of which those of the first bounce end with a pair of choices that fill the square evenly.
fn numbers_of_bounce(key: vec4<u32>, pair: u32, bounces: u32) -> vec4<f32> {
    let numbers = random_numbers(key);
    return vec4(numbers.xy, select(numbers.zw, sobol_numbers(key, pair), bounces == 0u));
}

// Rays through a thin lens meet where they meet the plane of focus.
fn through_lens(ray: Ray, numbers: vec2<f32>) -> Ray {
    if frame.path_focus == 0.0 {
        return ray;
    }
    let at_focus = frame.path_focus / dot(frame.forward, ray.direction) * ray.direction;
    let place = sqrt(numbers.x) * turned(numbers.y);
    let beside = place.x * frame.path_lens_right + place.y * frame.path_lens_up;
    return Ray(ray.origin + beside, direction_of(at_focus - beside));
}

// The part of a ray that lies in the domain.
fn walk_along(world: Ray) -> Walk {
    let voxel = voxel_ray(world);
    let interval = domain_interval(world, voxel);
    return Walk(world, voxel, interval.x, interval.y, frame.path_majorant, from_rank(UNKNOWN));
}

// On from a collision, on the side of surfaces that it is on.
fn walk_from(at: Collision, way: vec3<f32>) -> Walk {
    var walk = walk_along(Ray(at.place, way));
    walk.levels = from_rank(at.rank);
    return walk;
}

// On to the next tentative collision, or to a surface, or to where the next cell begins or the domain ends. Distances of collisions have no
// memory: in each piece of a ray they are drawn anew.
fn step_by(walk: ptr<function, Walk>, u: f32) -> bool {
    let voxel = (*walk).voxel;
    var reach = (*walk).end;
    var may_cross = true;
    if frame.cells.x != 0u {
        let in_cells = (voxel.origin + (*walk).t * voxel.direction - frame.cells_origin) / f32(CELL_VOXELS);
        let cell = vec3<i32>(clamp(in_cells, vec3(0.0), vec3<f32>(frame.cells) - 1.0));
        let distance = distance_to_occupied(cell);
        let radius = max(distance, 1);
        let tiny = vec3(1e-20);
        let along = select(voxel.direction, tiny, abs(voxel.direction) < tiny);
        let planes = vec3<f32>(cell + select(vec3(1 - radius), vec3(radius), along > vec3(0.0)));
        let leaves = (planes * f32(CELL_VOXELS) + frame.cells_origin - voxel.origin) / along;
        let leave = min(leaves.x, min(leaves.y, leaves.z));
        // A little beyond, so that rounding leaves no ray where it is.
        reach = min(reach, max(leave, (*walk).t) + frame.smallest_spacing / 1024.0);
        (*walk).majorant = select(majorant_of(cell), 0.0, distance > 0);
        may_cross = distance == 0 && may_cross_in(cell);
    }
    (*walk).levels = entered((*walk).levels, voxel, (*walk).t, may_cross && (*walk).t < (*walk).end);
    reach = nearer_end((*walk).levels, (*walk).t, reach, (*walk).end);
    if (*walk).majorant <= 0.0 {
        walk_to(walk, reach);
        return false;
    }
    let t = (*walk).t + minus_ln(1.0 - u) / (*walk).majorant;
    walk_to(walk, min(t, reach));
    return t < reach && !has_crossed((*walk).levels);
}

fn walk_to(walk: ptr<function, Walk>, end: f32) {
    (*walk).levels = moved((*walk).levels, (*walk).voxel, (*walk).t, end);
    (*walk).t = reached((*walk).levels, end);
}

// That a tentative collision is a real one: by what all colours would take of the weights.
fn chance_of(weight: vec3<f32>, chances: vec3<f32>) -> f32 {
    if frame.extinction_is_colored == 0u {
        return chances.x;
    }
    let real = dot(weight, chances);
    return real / (real + dot(weight, 1.0 - chances));
}

// What a choice makes of the weights that all colours have taken by one chance.
fn of_colors(chances: vec3<f32>, chance: f32) -> vec3<f32> {
    return select(vec3(1.0), chances / chance, frame.extinction_is_colored != 0u);
}

// The normal of a surface at a collision, on the side that the path comes from; 0: it is one in the medium.
fn normal_at(place: vec3<f32>, direction: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    if frame.path_surface == 0.0 {
        return vec3(0.0);
    }
    let gradient = gradient_met(place, u.y);
    let steepness = sqrt(dot(gradient, gradient));
    if steepness <= frame.flat_gradient || u.x >= 1.0 - exp(-frame.path_surface * steepness) {
        return vec3(0.0);
    }
    return facing(gradient, direction);
}

// Along a gradient, on the side that the path comes from.
fn facing(gradient: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let normal = gradient / sqrt(dot(gradient, gradient));
    return select(normal, -normal, dot(normal, direction) > 0.0);
}

// One of the lights: the way to it, and in `light` what it gives if nothing is in the way. A light of colour 1 gives a white
// surface across its way radiance 1: irradiance pi.
fn light_at(at: ptr<function, Collision>, numbers: vec4<f32>, key: vec4<u32>) -> vec3<f32> {
    (*at).light = vec3(0.0);
    (*at).reach = 3.4e38;
    let count = light_kinds();
    if count == 0u {
        return vec3(0.0);
    }
    let i = min(u32(numbers.y * f32(count)), count - 1u);
    var way: vec3<f32>;
    var irradiance: vec3<f32>;
    if i == frame.light_count {
        way = sky_drawn(vec4(numbers.z, random_numbers(key).yzw));
        let of_sky = sky_at(way);
        let both = of_sky.density + f32(count) * scattering_density(*at, way);
        irradiance = select(vec3(0.0), of_sky.radiance / (3.1415927 * both), of_sky.density > 0.0);
    } else if is_lamp(i) {
        let lamp = light_of_lamp(i, (*at).place, numbers.zw);
        way = lamp.way;
        irradiance = lamp.color;
        (*at).reach = lamp.reach;
    } else {
        way = around(frame.light_directions[i].xyz, 1.0 - numbers.z * frame.path_light_size, numbers.w);
        irradiance = frame.light_colors[i].xyz;
    }
    var part = vec3(3.1415927 * phase_value(dot((*at).direction, way)));
    if any((*at).normal != vec3(0.0)) {
        part = reflected((*at).normal, -(*at).direction, way, (*at).albedo);
    }
    (*at).light = f32(count) * part * irradiance;
    return way;
}

// Lights, and a sky that directions are drawn to.
fn light_kinds() -> u32 {
    return frame.light_count + select(0u, 1u, has_sky_picture());
}

// What comes from where a path leaves. Directions to the sky are drawn at collisions too: the balance heuristic (Veach 1997),
// p / (p + p'), of the densities of both ways to the same direction.
fn sky_of(path: Path, way: vec3<f32>) -> vec3<f32> {
    if !path.has_met && frame.path_sky_shown == 0u {
        return vec3(0.0);
    }
    let of_sky = sky_at(way);
    if !path.has_met || !has_sky_picture() {
        return of_sky.radiance;
    }
    return of_sky.radiance * path.density / (path.density + of_sky.density / f32(light_kinds()));
}

// How often a path goes on in a direction, per steradian.
fn scattering_density(at: Collision, way: vec3<f32>) -> f32 {
    if any(at.normal != vec3(0.0)) {
        return reflection_density(at.normal, -at.direction, way);
    }
    return phase_value(dot(at.direction, way));
}

// Where the path goes on: by the phase function, or as a surface reflects.
fn scattered(at: Collision, numbers: vec4<f32>) -> Reflection {
    if any(at.normal != vec3(0.0)) {
        return reflection(at.normal, -at.direction, at.albedo, numbers);
    }
    let cosine = phase_cosine(numbers.y, numbers.z);
    return Reflection(around(at.direction, cosine, numbers.w), vec3(1.0), phase_value(cosine));
}

// Whether its albedo is only a part of what is reflected there.
fn is_coated(at: Collision) -> bool {
    return frame.path_f0 > 0.0 && any(at.normal != vec3(0.0));
}

// Roulette: what the weight is multiplied by, 0 where the path ends. Paths of very many rounds end by chance too.
fn kept(path: Path, u: f32) -> f32 {
    let most = max(path.weight.x, max(path.weight.y, path.weight.z));
    var part = 1.0;
    if path.bounces >= FEWEST_BOUNCES && most < LEAST {
        part = most / LEAST;
    }
    if path.rounds > frame.path_rounds {
        part *= select(0.5, 0.875, frame.path_rounds >= MANY_ROUNDS);
    }
    if part == 1.0 {
        return 1.0;
    }
    return select(0.0, 1.0 / part, u < part);
}
