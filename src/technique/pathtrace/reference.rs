//! Path tracing on the CPU: CPU reference of `shaders/pathtrace.wgsl`.

use super::SkyPicture;
use super::elementary::{around, turned};
use super::lamp::{is_lamp, light_of_lamp};
use super::layers::PathLayers;
use super::phase::{phase_cosine, phase_value};
use super::random::random_numbers;
use super::sobol::sobol_numbers;
use super::surface::{reflected, reflection, reflection_density};
use super::walk::{Step, Walk};
use crate::ray::{Ray, pixel_ray};
use crate::real::{Real, add, dot, scale};
use crate::shaders::{Frame, MANY_ROUNDS, TURNS_OF_WAY};
use crate::technique::reference::{Gathered, Samples};

/// Numbers of a draw: of the way, of a collision, of the direction behind it and of that to a sky.
const NUMBERS_OF_DRAW: u32 = 4;
const OF_COLLISION: u32 = 1;
const OF_DIRECTION: u32 = 2;
const OF_SKY: u32 = 3;
/// Choices of a path whose numbers fill the square evenly: where in its pixel it begins, where the light of its first collision
/// comes from, and where it goes on there.
const PAIR_OF_PIXEL: u32 = 0;
const PAIR_OF_LIGHT: u32 = 1;
const PAIR_OF_DIRECTION: u32 = 2;
/// Behind so many bounces, weights under `LEAST` end by chance.
const FEWEST_BOUNCES: u32 = 4;
const LEAST: f64 = 0.1;
/// Ways from a surface begin so far before it, in smallest spacings.
const LEAVES_BY: f64 = 1e-3;

/// The mean of the paths of a pixel.
pub(crate) fn pixel<R: Real>(of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
    let frame = of.frame();
    let corner = pixel.map(|x| x.to_i32() as u32);
    let number = corner[1] * frame.extent_pixels[0] + corner[0];
    let mut sum = [R::from_f64(0.0); 4];
    let mut layers = PathLayers::none();
    for sample in frame.path_first..frame.path_first + frame.path_count {
        let key = [number, sample, 0, frame.path_seed];
        let path = Path::traced(of, corner, key, layers);
        let [r, g, b] = path.radiance;
        let alpha = R::from_f64(f64::from(u8::from(path.has_met)));
        let found = [r, g, b, alpha];
        sum = std::array::from_fn(|c| sum[c] + found[c]);
        layers = path.layers;
    }
    let count = R::from_f64(f64::from(frame.path_count));
    Gathered::of_paths(sum.map(|s| s / count), layers.means(count))
}

struct Path<R> {
    weight: [R; 3],
    radiance: [R; 3],
    bounces: u32,
    draw: u32,
    /// Rounds of the shader's loop, so many turns of a way each.
    rounds: u32,
    has_met: bool,
    /// Of its direction, per steradian.
    density: R,
    /// Which of several volumes its last collision is with, by their shares.
    part: R,
    /// Of the pixel so far.
    layers: PathLayers<R>,
}

impl<R: Real> Path<R> {
    fn traced(
        of: &impl Samples<R>,
        corner: [u32; 2],
        mut key: [u32; 4],
        layers: PathLayers<R>,
    ) -> Self {
        let frame = of.frame();
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let [x, y] = sobol_numbers::<R>(key, PAIR_OF_PIXEL);
        let [.., u, v] = random_numbers::<R>(key);
        let [across, down] = corner.map(|n| R::from_f64(n.into()));
        let ray = pixel_ray(frame, [across + x, down + y]);
        let mut walk = Walk::along(frame, through_lens(frame, ray, [u, v]), None);
        let mut path = Self {
            weight: [one; 3],
            radiance: [zero; 3],
            bounces: 0,
            draw: 1,
            rounds: 0,
            has_met: false,
            density: zero,
            part: zero,
            layers,
        };
        while let Some((color, place)) = path.collide(of, &mut walk, &mut key) {
            if frame.path_bounces == 0 && frame.emission_point_count == 0 {
                path.radiance = times(path.weight, color);
                path.layers.add_light(path.radiance, 0);
            }
            let albedo = R::from_f32(frame.path_albedo);
            let albedo = color.map(|c| c * albedo);
            key[2] += OF_COLLISION;
            let numbers = path.numbers_of_bounce(key, PAIR_OF_LIGHT);
            let incoming = walk.world.direction;
            let normal = match walk.levels.has_crossed() {
                true => Some(walk.levels.normal(frame, incoming)),
                false => normal_at(of, place, incoming, [numbers[0], path.part]),
            };
            if !path.has_met {
                path.layers.add_first(albedo, normal, walk.t);
            }
            path.has_met = true;
            if path.bounces == frame.path_bounces {
                return path;
            }
            let (mut from, rank) = (walk.world.at(walk.t), walk.levels.before);
            if let (true, Some(normal)) = (walk.levels.has_crossed(), normal) {
                let by = R::from_f64(LEAVES_BY) * R::from_f32(frame.smallest_spacing);
                from = add(from, scale(normal, by));
            }
            let at = Collision {
                place: from,
                incoming,
                normal,
                albedo,
                sky: of.settings().path.sky_picture.as_ref(),
            };
            if !at.is_coated(frame) {
                path.weight = std::array::from_fn(|c| path.weight[c] * albedo[c]);
            }
            key[2] = NUMBERS_OF_DRAW * path.draw + OF_SKY;
            let (way, light, reach) = at.light(frame, numbers, key);
            if (0..3).any(|c| path.weight[c] * light[c] > zero) {
                let way = Ray {
                    origin: from,
                    direction: way,
                };
                let mut walk = Walk::along(frame, way, rank);
                walk.end = walk.end.min(reach);
                let through = path.through(of, walk, &mut key);
                let brought = times(times(path.weight, light), through);
                path.radiance = add(path.radiance, brought);
                path.layers.add_light(brought, path.bounces + 1);
            }
            key[2] = NUMBERS_OF_DRAW * path.draw + OF_DIRECTION;
            let numbers = path.numbers_of_bounce(key, PAIR_OF_DIRECTION);
            path.bounces += 1;
            path.layers.add_bounce();
            let (direction, weight) = at.scattered(frame, numbers);
            path.density = at.density(frame, direction);
            path.weight = std::array::from_fn(|c| path.weight[c] * weight[c]);
            let kept = path.kept(frame, numbers[0]);
            path.weight = scale(path.weight, kept);
            if path.weight.iter().all(|&w| w <= zero) {
                return path;
            }
            let next = Ray {
                origin: from,
                direction,
            };
            walk = Walk::along(frame, next, rank);
        }
        let sky = times(path.weight, path.sky(of, walk.world.direction));
        path.radiance = add(path.radiance, sky);
        if path.has_met {
            path.layers.add_light(sky, path.bounces);
        }
        path.has_met |= frame.path_sky_shown != 0;
        path
    }

    /// What comes from where the path leaves: of a picture by the balance heuristic.
    fn sky(&self, of: &impl Samples<R>, way: [R; 3]) -> [R; 3] {
        let frame = of.frame();
        if !self.has_met && frame.path_sky_shown == 0 {
            return [R::from_f64(0.0); 3];
        }
        let even = frame.path_sky.map(R::from_f32);
        let Some(picture) = &of.settings().path.sky_picture else {
            return even;
        };
        let (found, density) = picture.at(frame, way);
        let part = match self.has_met {
            true => {
                let kinds = R::from_f64((frame.light_count + 1).into());
                self.density / (self.density + density / kinds)
            }
            false => R::from_f64(1.0),
        };
        std::array::from_fn(|c| found[c] * even[c] * part)
    }

    /// Numbers of a draw, of which those of the first bounce end with a pair of choices that fill the square evenly.
    fn numbers_of_bounce(&self, key: [u32; 4], pair: u32) -> [R; 4] {
        let [a, b, c, d] = random_numbers(key);
        let [c, d] = match self.bounces {
            0 => sobol_numbers(key, pair),
            _ => [c, d],
        };
        [a, b, c, d]
    }

    /// The next numbers of the path.
    fn draw(&mut self, key: &mut [u32; 4]) -> [R; 4] {
        key[2] = NUMBERS_OF_DRAW * self.draw;
        self.draw += 1;
        random_numbers(*key)
    }

    /// Colour and place (voxel space) of the next real collision; `None`: the walk has left.
    fn collide(
        &mut self,
        of: &impl Samples<R>,
        walk: &mut Walk<R>,
        key: &mut [u32; 4],
    ) -> Option<([R; 3], [R; 3])> {
        for turn in 0.. {
            self.count_round(turn);
            let [u, v, w, _] = self.draw(key);
            self.part = w;
            let Some((found, place)) = Matter::behind(of, walk, u)? else {
                continue;
            };
            self.count(walk);
            let Matter {
                color,
                chances,
                shine,
            } = found;
            let light = times(self.weight, shine);
            self.radiance = add(self.radiance, light);
            self.layers.add_light(light, self.bounces);
            let chance = self.chance(of.frame(), chances);
            let one = R::from_f64(1.0);
            let is_real = v < chance;
            if of.frame().extinction_is_colored != 0 {
                let (taken, part) = match is_real {
                    true => (chances, chance),
                    false => (chances.map(|c| one - c), one - chance),
                };
                self.weight = times(self.weight, taken.map(|c| c / part));
            }
            if is_real {
                return Some((color, place));
            }
        }
        None
    }

    /// That a tentative collision is a real one.
    fn chance(&self, frame: &Frame, chances: [R; 3]) -> R {
        if frame.extinction_is_colored == 0 {
            return chances[0];
        }
        let real = dot(self.weight, chances);
        let one = R::from_f64(1.0);
        real / (real + dot(self.weight, chances.map(|c| one - c)))
    }

    /// What comes through along a walk: ratio tracking, and roulette where little does.
    fn through(&mut self, of: &impl Samples<R>, mut walk: Walk<R>, key: &mut [u32; 4]) -> [R; 3] {
        let (zero, one, least) = (R::from_f64(0.0), R::from_f64(1.0), R::from_f64(LEAST));
        let mut through = [one; 3];
        for turn in 0.. {
            self.count_round(turn);
            let [u, v, ..] = self.draw(key);
            let Some(found) = Matter::behind(of, &mut walk, u) else {
                return through;
            };
            let Some((Matter { chances, .. }, _)) = found else {
                continue;
            };
            self.count(&walk);
            through = times(through, chances.map(|c| one - c));
            let most = through[0].max(through[1].max(through[2]));
            if most < least {
                let part = if v * least < most { least / most } else { zero };
                through = scale(through, part);
            }
            if through.iter().all(|&t| t <= zero) {
                break;
            }
        }
        through
    }

    /// Counts the rounds that a walk begins.
    fn count_round(&mut self, turn: u32) {
        if turn.is_multiple_of(TURNS_OF_WAY) {
            self.rounds += 1;
        }
    }

    /// Counts what a walk has found, where it is no surface.
    fn count(&mut self, walk: &Walk<R>) {
        if !walk.levels.has_crossed() {
            self.layers.add_sample();
        }
    }

    /// What the weight is multiplied by; 0: the path ends.
    fn kept(&self, frame: &Frame, u: R) -> R {
        let (one, least) = (R::from_f64(1.0), R::from_f64(LEAST));
        let most = self.weight[0].max(self.weight[1].max(self.weight[2]));
        let mut part = one;
        if self.bounces >= FEWEST_BOUNCES && most < least {
            part = most / least;
        }
        if self.rounds > frame.path_rounds {
            let is_slow = frame.path_rounds >= MANY_ROUNDS;
            part = part * R::from_f64(if is_slow { 0.875 } else { 0.5 });
        }
        match u < part {
            true => one / part,
            false => R::from_f64(0.0),
        }
    }
}

fn times<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    std::array::from_fn(|c| a[c] * b[c])
}

/// What a tentative collision finds.
struct Matter<R> {
    color: [R; 3],
    /// Of each colour, that it is a real one.
    chances: [R; 3],
    /// What matter sends out there, of a path of weight 1.
    shine: [R; 3],
}

impl<R: Real> Matter<R> {
    /// A step of a walk on, and what is found where it ends (voxel space): nothing where that is no more than the end of a
    /// cell. `None`: the walk has left.
    fn behind(of: &impl Samples<R>, walk: &mut Walk<R>, u: R) -> Option<Option<(Self, [R; 3])>> {
        let step = walk.step(of, u);
        let place = walk.voxel.at(walk.t);
        match step {
            Step::Left => None,
            Step::On => Some(None),
            Step::Tentative => Some(Some((Self::at(of, place), place))),
            Step::Surface => Some(Some((Self::of_surface(of.frame(), walk)?, place))),
        }
    }

    fn of_surface(frame: &Frame, walk: &Walk<R>) -> Option<Self> {
        let [r, g, b, opacity] = walk.levels.surface(frame)?;
        Some(Self {
            color: [r, g, b],
            chances: [opacity; 3],
            shine: [R::from_f64(0.0); 3],
        })
    }

    /// In voxel space.
    fn at(of: &impl Samples<R>, place: [R; 3]) -> Self {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        // Unlit, along no direction.
        let Some([r, g, b, extinction]) = of.material(place, [zero; 3]) else {
            return Self {
                color: [zero; 3],
                chances: [zero; 3],
                shine: [zero; 3],
            };
        };
        let frame = of.frame();
        let [density, majorant] = [frame.path_density, frame.path_majorant].map(R::from_f32);
        let value = of.value(place);
        let extinctions = match value.filter(|_| frame.extinction_is_colored != 0) {
            Some(value) => of.extinctions(value),
            None => [extinction; 3],
        };
        let emission = value.map_or([zero; 3], |value| of.emission(value));
        Self {
            color: [r, g, b],
            chances: extinctions.map(|sigma| (sigma * density / majorant).min(one)),
            shine: emission.map(|e| e / majorant),
        }
    }
}

/// The normal of a surface, on the side that the path comes from; `None`: in the medium.
fn normal_at<R: Real>(
    of: &impl Samples<R>,
    place: [R; 3],
    incoming: [R; 3],
    [u, part]: [R; 2],
) -> Option<[R; 3]> {
    let frame = of.frame();
    if frame.path_surface == 0.0 {
        return None;
    }
    let one = R::from_f64(1.0);
    let gradient = of.gradient_met(place, part);
    let steepness = dot(gradient, gradient).sqrt();
    let chance = one - (-R::from_f32(frame.path_surface) * steepness).exp();
    if steepness <= R::from_f32(frame.flat_gradient) || u >= chance {
        return None;
    }
    let normal = scale(gradient, one / steepness);
    let is_behind = dot(normal, incoming) > R::from_f64(0.0);
    Some(if is_behind {
        scale(normal, -one)
    } else {
        normal
    })
}

/// Where a path has met matter.
struct Collision<'a, R> {
    /// In world space.
    place: [R; 3],
    /// Of travel.
    incoming: [R; 3],
    /// `None`: in the medium.
    normal: Option<[R; 3]>,
    albedo: [R; 3],
    sky: Option<&'a SkyPicture>,
}

impl<R: Real> Collision<'_, R> {
    /// Whether its albedo is only a part of what is reflected there.
    fn is_coated(&self, frame: &Frame) -> bool {
        frame.path_f0 > 0.0 && self.normal.is_some()
    }

    /// The way to one of the lights, what it gives if nothing is in the way, and how far it is.
    fn light(&self, frame: &Frame, numbers: [R; 4], key: [u32; 4]) -> ([R; 3], [R; 3], R) {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let kinds = frame.light_count + u32::from(self.sky.is_some());
        if kinds == 0 {
            return ([zero; 3], [zero; 3], zero);
        }
        let count = R::from_f64(kinds.into());
        let i = ((numbers[1] * count).to_i32() as u32).min(kinds - 1) as usize;
        let vector = |[x, y, z, _]: [f32; 4]| [x, y, z].map(R::from_f32);
        let mut reach = R::from_f32(f32::MAX);
        let (way, color) = match self.sky {
            Some(sky) if i == frame.light_count as usize => {
                let [_, chance, height, turn] = random_numbers(key);
                let way = sky.drawn(frame, [numbers[2], chance, height, turn]);
                let (radiance, density) = sky.at(frame, way);
                let both = density + count * self.density(frame, way);
                let pi = R::from_f64(std::f64::consts::PI);
                let color = match density > zero {
                    true => {
                        let factor = frame.path_sky.map(R::from_f32);
                        std::array::from_fn(|c| radiance[c] * factor[c] / (pi * both))
                    }
                    false => [zero; 3],
                };
                (way, color)
            }
            _ if is_lamp(frame, i) => {
                let lamp = light_of_lamp(frame, i, self.place, [numbers[2], numbers[3]]);
                reach = lamp.reach;
                (lamp.way, lamp.color)
            }
            _ => {
                let cosine = one - numbers[2] * R::from_f32(frame.path_light_size);
                let way = around(vector(frame.light_directions[i]), cosine, numbers[3]);
                (way, vector(frame.light_colors[i]))
            }
        };
        let part = match self.normal {
            Some(normal) => reflected(
                frame,
                [normal, scale(self.incoming, -one), way],
                self.albedo,
            ),
            None => {
                let phase = phase_value(frame, dot(self.incoming, way));
                [R::from_f64(std::f64::consts::PI) * phase; 3]
            }
        };
        let light = std::array::from_fn(|c| count * part[c] * color[c]);
        (way, light, reach)
    }

    /// How often the path goes on in a direction, per steradian.
    fn density(&self, frame: &Frame, way: [R; 3]) -> R {
        match self.normal {
            Some(normal) => {
                let to_eye = scale(self.incoming, R::from_f64(-1.0));
                reflection_density(frame, [normal, to_eye, way])
            }
            None => phase_value(frame, dot(self.incoming, way)),
        }
    }

    /// Where the path goes on, and what its weight is multiplied by.
    fn scattered(&self, frame: &Frame, numbers: [R; 4]) -> ([R; 3], [R; 3]) {
        let one = R::from_f64(1.0);
        match self.normal {
            Some(normal) => {
                let to_eye = scale(self.incoming, -one);
                reflection(frame, [normal, to_eye], self.albedo, numbers)
            }
            None => {
                let cosine = phase_cosine(frame, numbers[1], numbers[2]);
                (around(self.incoming, cosine, numbers[3]), [one; 3])
            }
        }
    }
}

/// Rays through a thin lens meet where they meet the plane of focus.
fn through_lens<R: Real>(frame: &Frame, ray: Ray<R>, [u, v]: [R; 2]) -> Ray<R> {
    if frame.path_focus == 0.0 {
        return ray;
    }
    let vector = |v: [f32; 3]| v.map(R::from_f32);
    let ahead = dot(vector(frame.forward), ray.direction);
    let at_focus = scale(ray.direction, R::from_f32(frame.path_focus) / ahead);
    let [x, y] = turned(v).map(|t| u.sqrt() * t);
    let beside = add(
        scale(vector(frame.path_lens_right), x),
        scale(vector(frame.path_lens_up), y),
    );
    let towards = add(at_focus, scale(beside, R::from_f64(-1.0)));
    let norm = dot(towards, towards).sqrt();
    Ray {
        origin: add(ray.origin, beside),
        direction: scale(towards, R::from_f64(1.0) / norm),
    }
}
