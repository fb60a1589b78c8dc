//! The variants of the table: those behind `stratavox bench`, the defaults of each technique and mode as a graphics
//! card draws them (linear filter by the sampler, points of the function in a table), and the passes before and after.

/// Shaders that are listed, the other stage of a raster pipeline beside them. Compute shaders stand alone.
pub const ROWS: &[(&str, &[&str])] = &[
    (
        "",
        &[
            // Rays that composite and leave the picture alone: filters, missing data; light and opacity by gradients;
            // adaptive steps, several numbers a voxel.
            "raycast.composite.ray.linear.none.table.picture",
            "raycast.composite.ray.nearest.none.table.picture",
            "raycast.composite.ray.kernel.none.table.picture",
            "raycast.composite.ray.spline.none.table.picture",
            "raycast.composite.ray.linear.mask.table.picture",
            "raycast.composite.shaded.ray.linear.none.table.picture",
            "raycast.composite.gradient_opacity.ray.linear.none.table.picture",
            "raycast.composite.scalar_gradient.ray.linear.none.table.picture",
            "raycast.composite.adaptive.ray.linear.none.table.picture",
            "raycast.composite.channels.ray.linear.none.table.picture",
            "raycast.composite.colors.ray.linear.none.table.picture",
            // The same with depths and other layers; along the lattices of slices.
            "raycast.composite.ray.linear.none.table",
            "raycast.composite.shaded.ray.linear.none.table",
            "raycast.composite.scalar_gradient.ray.linear.none.table",
            "raycast.composite.planes.linear.none.table",
            "raycast.composite.stack.linear.none.table",
            // Slabs, and projections with the ranges of cells that they skip by.
            "raycast_slab.composite.ray.linear.none",
            "raycast.mida.ray.linear.none.table",
            "raycast.mida.scalar_gradient.ray.linear.none.table",
            "projection.mip.ray.linear.none",
            "projection.mip.ray.nearest.none",
            "projection.mip.ray.kernel.none",
            "projection.mip.planes.linear.none",
            "projection.minip.ray.linear.none",
            "projection.sum.ray.linear.none",
            "projection.lmip.ray.linear.none",
            "projection.attenuated_mip.ray.linear.none",
            "projection_cells.mip.none",
            "isosurface.linear.none",
            "isosurface.nearest.none",
            "isosurface.kernel.none",
            "isosurface.volume.linear.none",
            // Before a picture.
            "ray_tiles.distances.picture",
            "ray_tiles.box.picture",
            "ray_tiles.box.mida",
            "ray_tiles.box.number",
            "macro_cells.box",
            "macro_cells.stack",
            "distance_map",
            "slice_patches.view",
            "slice_patches.stack",
            "precompute_gradients.box",
            "light_volume",
            "merge.over",
            "warp.mean",
        ],
    ),
    (
        "slices_3d_cover",
        &[
            "slices_3d.composite.linear.none.table",
            "slices_3d.composite.kernel.none.table",
            "slices_3d.composite.scalar_gradient.linear.none.table",
            "slices_3d.composite.channels.linear.none.table",
            "slices_3d.number.linear.none",
            "slices_3d_slab.composite.linear.none",
            "slices_3d_half.linear.none.table",
        ],
    ),
    (
        "slices_2d_cover",
        &[
            "slices_2d.composite.linear.none.table",
            "slices_2d.composite.scalar_gradient.linear.none.table",
            "slices_2d.number.linear.none",
        ],
    ),
    (
        "slices_3d.composite.linear.none.table",
        &["slices_3d_cover", "slice_patches_cover"],
    ),
    (
        "resolve_cover",
        &["resolve.picture", "resolve.value", "resolve.mean"],
    ),
];

/// The most rows that a table may have: it is to be read.
pub const MOST_ROWS: usize = 60;

/// Each row: the other stage, where there is one, and the shader.
pub fn rows() -> impl Iterator<Item = (Option<&'static str>, &'static str)> {
    ROWS.iter().flat_map(|&(beside, shaders)| {
        let beside = (!beside.is_empty()).then_some(beside);
        shaders.iter().map(move |&shader| (beside, shader))
    })
}
