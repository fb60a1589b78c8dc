//! The names of what settings choose.

use super::{Filter, FilterBy, Lattice, Order, SkipBy};
use crate::named::named;

named!(Filter {
    Linear "linear" "",
    Nearest "nearest" "",
    Quadratic "quadratic" "quadratic B-spline through the voxels",
    Cubic "cubic" "cubic B-spline through the voxels, the most exact",
    QuadraticSmooth "quadratic-smooth" "quadratic B-spline of the voxels: never rings, blurs more than linear",
    CubicSmooth "cubic-smooth" "cubic B-spline of the voxels: never rings, blurs most",
    CatmullRom "catmull-rom" "Catmull-Rom cubic through the voxels",
});

named!(FilterBy {
    Auto "auto" "fetch for rays where the driver is llvmpipe, whose sampler is slower; else sampler",
    Sampler "sampler" "the device's sampler, whose weights have some 8 bits on graphics cards",
    Fetch "fetch" "the shader, with weights in floats",
});

named!(Lattice {
    Ray "ray" "",
    Planes "planes" "",
    Jitter "jitter" "",
    Bresenham "bresenham" "",
});

named!(SkipBy {
    Cells "cells" "",
    Octree "octree" "",
    Runs "runs" "",
});

named!(Order {
    BackToFront "back-to-front" "",
    FrontToBack "front-to-back" "",
});
