//! Splatting of scattered points: each is a Gaussian ball of its own width (Zwicker et al. 2001, "EWA splatting").
//!
//! ```text
//! b^2 = |x_s - closest point of the ray|^2 / h'^2        h'^2 = max(h_s^2, (rho p)^2), p the pixel at its depth
//! xray           sum of m f F         F = e^(-b^2 / 2) / (2 pi h'^2): its integral over all rays of a parallel bundle is 1
//! average        sum of m f F / sum of m F
//! mip, minip     extreme of f where b <= 2
//! composite      depth sigma(f) sqrt(2 pi) h (h / h')^2 e^(-b^2 / 2), from front to back by the depth of centres
//! ```
//!
//! A view has its points sorted, and a list of those that each block of 4 x 4 pixels may see ([`ViewPoints`]); a compute
//! pass goes through the list of its block. Opacity does not depend on the order of points, colour does.

mod gpu;
pub(super) mod reference;
mod view_points;

pub use gpu::GpuViewPoints;
pub use view_points::ViewPoints;

use crate::gpu::Error;
use crate::technique::gather::{Gather, GatherDesc, RayPass, rays_of};

/// World lengths that the opacity of a point of standard deviation h is for: sqrt(2 pi) h, so that a ray through its
/// centre has it.
pub(crate) fn reference_length(std: f64) -> f64 {
    std::f64::consts::TAU.sqrt() * std
}

/// The pass over the points of each pixel.
pub(super) fn gather(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    let mode = desc.settings.mode;
    let pass = if mode.is_projection() {
        let name = format!("splat_points_projection.{}", mode.shader_key());
        RayPass::projection_everywhere(desc.gpu, &name)?
    } else {
        let transfer = match desc.variant.transfer {
            "points" => "points",
            _ => "table",
        };
        RayPass::picture_everywhere(desc.gpu, &format!("splat_points.{transfer}"))?
    };
    Ok(rays_of(desc.gpu, pass))
}
