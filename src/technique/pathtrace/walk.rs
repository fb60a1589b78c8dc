//! On the way of a path: from one tentative collision to the next, or to a surface. CPU reference of `shaders/pathtrace.wgsl`.
//!
//! ```text
//! t += -ln(1 - u) / majorant
//! ```

use super::elementary::minus_ln;
use super::levels::AmongLevels;
use crate::ray::{Ray, domain_interval, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::reference::Samples;

/// The part of a ray that lies in the domain.
pub(super) struct Walk<R> {
    pub world: Ray<R>,
    pub voxel: Ray<R>,
    pub t: R,
    pub end: R,
    pub levels: AmongLevels<R>,
}

impl<R: Real> Walk<R> {
    /// From a place that has so many levels at or under it.
    pub fn along(frame: &Frame, world: Ray<R>, rank: Option<usize>) -> Self {
        let voxel = voxel_ray(frame, &world);
        let [t, end] = domain_interval(frame, &world, &voxel);
        Self {
            world,
            voxel,
            t,
            end,
            levels: AmongLevels::from_rank(rank),
        }
    }

    /// On to the next tentative collision, or to a surface, or to where the next cell begins or the domain ends.
    pub fn step(&mut self, of: &impl Samples<R>, u: R) -> Step {
        let frame = of.frame();
        let one = R::from_f64(1.0);
        let reach = match frame.level_count {
            0 => self.end,
            _ if self.t >= self.end => {
                self.levels = AmongLevels::from_rank(None);
                self.end
            }
            _ => self.levels.enter(of, &self.voxel, self.t).min(self.end),
        };
        let t = match frame.path_majorant > 0.0 {
            true => self.t + minus_ln(one - u) / R::from_f32(frame.path_majorant),
            false => reach,
        };
        self.t = self.levels.step(of, &self.voxel, [self.t, t.min(reach)]);
        match t < reach {
            _ if self.levels.has_crossed() => Step::Surface,
            true => Step::Tentative,
            false if self.t >= self.end => Step::Left,
            false => Step::On,
        }
    }
}

/// What a step of a walk ends at.
pub(super) enum Step {
    On,
    Tentative,
    Surface,
    Left,
}
