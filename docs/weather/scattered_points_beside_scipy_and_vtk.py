#!/usr/bin/env python3
"""Scattered points to a grid beside scipy and VTK:
python3 scattered_points_beside_scipy_and_vtk.py target/release/stratavox   (pip install vtk scipy)

The field is sin 4x cos 3y + z^3 at random places of the unit cube. 600 places onto 40^3 voxels say how far values are off, at
voxels in [.2, .8]^3; 100 000 places onto 128^3 voxels say how long it takes. Of stratavox that is the whole of `convert` less that of
one voxel a side, which reads the points too; of the others the interpolation with whatever it has to prepare. The median of three turns, one
after another. Prints a table of Markdown; prepared grids of Delaunay's tetrahedra and trees count.
"""
import gzip
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import vtk
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator, RBFInterpolator
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

FEW, MANY, TURNS = (600, 40), (100_000, 128), 3
OURS = ["shepard", "idw", "nearest", "kernel"]


def field(p):
    return np.sin(4 * p[..., 0]) * np.cos(3 * p[..., 1]) + p[..., 2] ** 3


def table(path, places):
    rows = np.column_stack([places, field(places)])
    np.savetxt(path, rows, fmt="%.17g", delimiter=",", header="x,y,z,value", comments="")


def by_ours(program, folder, name, method, side):
    """Values by z, y, x, the middle of the first voxel, steps along x, y, z, and seconds."""
    out = folder / "field.nrrd"
    words = f"--grid {side}x{side}x{side} --interpolate {method} --force --progress none".split()
    begun = time.perf_counter()
    subprocess.run([program, "convert", folder / name, "-o", out, *words], check=True, capture_output=True)
    seconds = time.perf_counter() - begun
    head, data = out.read_bytes().split(b"\n\n", 1)
    keys = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    numbers = lambda key: np.array(eval(keys[key].replace(") (", "),(")))
    origin, steps = numbers("space origin"), np.diag(numbers("space directions"))
    return np.frombuffer(gzip.decompress(data), np.float32).reshape(side, side, side), origin, steps, seconds


def grid(origin, steps, side):
    z, y, x = np.meshgrid(*[np.arange(side)] * 3, indexing="ij")
    return origin + np.stack([x, y, z], axis=-1) * steps


def by_vtk(make):
    """A filter of VTK that samples onto an image."""

    def run(places, origin, steps, side):
        cloud, points = vtk.vtkPolyData(), vtk.vtkPoints()
        points.SetData(numpy_to_vtk(places, deep=1))
        cloud.SetPoints(points)
        values = numpy_to_vtk(field(places), deep=1)
        values.SetName("value")
        cloud.GetPointData().SetScalars(values)
        image = vtk.vtkImageData()
        image.SetDimensions(side, side, side)
        image.SetOrigin(*origin)
        image.SetSpacing(*steps)
        begun = time.perf_counter()
        out = make(cloud, image)
        seconds = time.perf_counter() - begun
        return vtk_to_numpy(out.GetPointData().GetArray("value")).reshape(side, side, side), seconds

    return run


def point_interpolator(kernel):
    def make(cloud, image):
        kernel.SetKernelFootprintToNClosest()
        kernel.SetNumberOfPoints(16)
        interpolator = vtk.vtkPointInterpolator()
        interpolator.SetInputData(image)
        interpolator.SetSourceData(cloud)
        interpolator.SetKernel(kernel)
        interpolator.Update()
        return interpolator.GetOutput()

    return make


def shepard_method(cloud, image):
    method = vtk.vtkShepardMethod()
    method.SetInputData(cloud)
    method.SetSampleDimensions(*image.GetDimensions())
    method.SetModelBounds(*image.GetBounds())
    method.SetMaximumDistance(0.25)
    method.Update()
    out = method.GetOutput()
    out.GetPointData().GetScalars().SetName("value")
    return out


def by_scipy(make):
    def run(places, origin, steps, side):
        wanted = grid(origin, steps, side).reshape(-1, 3)
        begun = time.perf_counter()
        values = make(places, field(places))(wanted)
        return values.reshape(side, side, side), time.perf_counter() - begun

    return run


OTHERS = {
    "scipy, `NearestNDInterpolator`": by_scipy(NearestNDInterpolator),
    "scipy, `LinearNDInterpolator` (Delaunay)": by_scipy(LinearNDInterpolator),
    "scipy, `RBFInterpolator`, thin plates of 50 neighbours": by_scipy(
        lambda p, f: RBFInterpolator(p, f, neighbors=50, kernel="thin_plate_spline")
    ),
    "VTK, `vtkShepardMethod`, within .25": by_vtk(shepard_method),
    "VTK, `vtkPointInterpolator`, `vtkShepardKernel` of 16": by_vtk(point_interpolator(vtk.vtkShepardKernel())),
    "VTK, `vtkPointInterpolator`, `vtkGaussianKernel` of 16": by_vtk(point_interpolator(vtk.vtkGaussianKernel())),
}
# A system of equations a voxel, or a pass over voxels a point: minutes.
SLOW = {"scipy, `RBFInterpolator`, thin plates of 50 neighbours", "VTK, `vtkShepardMethod`, within .25"}


def main():
    program = str(Path(sys.argv[1]).resolve())
    random = np.random.default_rng(1)
    few, many = (random.random((count, 3)) for count, _ in (FEW, MANY))
    print("| | rms | largest | seconds |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        table(folder / "few.csv", few)
        table(folder / "many.csv", many)

        def row(name, values, origin, steps, seconds):
            places = grid(origin, steps, FEW[1])
            inside = ((places > 0.2) & (places < 0.8)).all(-1)
            off = np.abs(values - field(places))[inside]
            text = f"{seconds:.1f}" if seconds is not None else ""
            print(f"| {name} | {(off**2).mean() ** 0.5:.1e} | {off.max():.1e} | {text} |", flush=True)

        for method in OURS:
            values, origin, steps, _ = by_ours(program, folder, "few.csv", method, FEW[1])
            took = []
            for _ in range(TURNS):
                _, first, step, seconds = by_ours(program, folder, "many.csv", method, MANY[1])
                took.append(seconds - by_ours(program, folder, "many.csv", method, 1)[3])
            row(f"stratavox, `{method}`", values, origin, steps, statistics.median(took))
        for name, run in OTHERS.items():
            values, _ = run(few, origin, steps, FEW[1])
            took = [] if name in SLOW else [run(many, first, step, MANY[1])[1] for _ in range(TURNS)]
            row(name, values, origin, steps, statistics.median(took) if took else None)


main()
