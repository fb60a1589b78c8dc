#!/usr/bin/env python3
"""Scattered points to a grid beside scipy and VTK:
python3 scattered_points_beside_scipy_and_vtk.py target/release/stratavox   (pip install vtk scipy)

The field is sin 4x cos 3y + z^3 at random places of the unit cube. 600 places onto 40^3 voxels say how far values are off, at
voxels in [.2, .8]^3; 100 000 places onto 128^3 voxels say how long it takes. Of stratavox that is the whole of `convert` less that of
one voxel a side, which reads the points too; of the others the interpolation with whatever it has to prepare. The median of three turns, one
after another. Prints a table of Markdown; prepared grids of Delaunay's tetrahedra and trees count.

A second table compares what must be equal, without times: Shepard's weights by the formulas of both programs, the mass of
densities by kernels that differ, and values between voxels, along lines and by vtkProbeFilter.
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
from scipy.spatial import cKDTree
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

FEW, MANY, TURNS = (600, 40), (100_000, 128), 3
SPH_STEP = 0.05
OURS = ["shepard", "idw", "nearest", "kernel"]


def field(p):
    return np.sin(4 * p[..., 0]) * np.cos(3 * p[..., 1]) + p[..., 2] ** 3


def table(path, places):
    rows = np.column_stack([places, field(places)])
    np.savetxt(path, rows, fmt="%.17g", delimiter=",", header="x,y,z,value", comments="")


def volume(path):
    """Values by z, y, x of the first time, the middle of the first voxel, and steps along x, y, z."""
    head, data = path.read_bytes().split(b"\n\n", 1)
    keys = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    numbers = lambda key: np.array(eval(keys[key].replace(" none", "").replace(") (", "),(")))
    origin, steps = numbers("space origin"), np.diag(numbers("space directions"))
    sizes = [int(n) for n in keys["sizes"].split()]
    values = np.frombuffer(gzip.decompress(data), np.float32).reshape(-1, *sizes[2::-1])
    return values[0], origin, steps


def by_ours(program, folder, name, method, side):
    """That, and seconds."""
    out = folder / "field.nrrd"
    words = f"--grid {side}x{side}x{side} --interpolate {method} --force --progress none".split()
    begun = time.perf_counter()
    subprocess.run([program, "convert", folder / name, "-o", out, *words], check=True, capture_output=True)
    seconds = time.perf_counter() - begun
    return *volume(out), seconds


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


def inverse_distances(places, wanted, weight):
    """Means of the 16 nearest by a weight of distances and that of the next; where a point is, its value."""
    distances, which = cKDTree(places).query(wanted, 17)
    near, following = distances[:, :16], distances[:, 16:]
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = weight(near, following)
        means = (weights * field(places)[which[:, :16]]).sum(1) / weights.sum(1)
    return np.where(near[:, 0] == 0, field(places)[which[:, 0]], means)


def sph(cloud, image):
    """Sums of W s^3, whose radius VTK has by its spatial step s, and which it takes for the volume of a point; all values are 1."""
    ones = numpy_to_vtk(np.ones(cloud.GetNumberOfPoints()), deep=1)
    ones.SetName("value")
    cloud.GetPointData().SetScalars(ones)
    kernel = vtk.vtkSPHQuinticKernel()
    kernel.SetSpatialStep(SPH_STEP)
    interpolator = vtk.vtkSPHInterpolator()
    interpolator.SetInputData(image)
    interpolator.SetSourceData(cloud)
    interpolator.SetKernel(kernel)
    interpolator.ComputeShepardSumOff()
    interpolator.Update()
    return interpolator.GetOutput()


def probed(values, origin, steps, places):
    """Values of an image at places, by VTK."""
    image, cloud, points = vtk.vtkImageData(), vtk.vtkPolyData(), vtk.vtkPoints()
    image.SetDimensions(*values.shape[::-1])
    image.SetOrigin(*origin)
    image.SetSpacing(*steps)
    scalars = numpy_to_vtk(values.ravel().astype(float), deep=1)
    scalars.SetName("value")
    image.GetPointData().SetScalars(scalars)
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(places, deep=1))
    cloud.SetPoints(points)
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(cloud)
    probe.SetSourceData(image)
    probe.Update()
    data = probe.GetOutput().GetPointData()
    is_valid = vtk_to_numpy(data.GetArray(probe.GetValidPointMaskArrayName())) > 0
    return vtk_to_numpy(data.GetArray("value")), is_valid


def equal(program, folder, few):
    """The second table."""
    print("\n| | off |\n|---|---|")
    row = lambda name, off: print(f"| {name} | {off:.1e} |", flush=True)
    ours, origin, steps, _ = by_ours(program, folder, "few.csv", "idw", FEW[1])
    wanted = grid(origin, steps, FEW[1]).reshape(-1, 3)
    formula = inverse_distances(few, wanted, lambda d, r: ((r - d) / (r * d)) ** 2)
    row("stratavox, `idw`, and its formula in numpy", np.nanmax(np.abs(ours.ravel() - formula)))
    theirs, _ = by_vtk(point_interpolator(vtk.vtkShepardKernel()))(few, origin, steps, FEW[1])
    formula = inverse_distances(few, wanted, lambda d, _: d**-2.0)
    row("VTK, `vtkShepardKernel` of 16, and w = 1/d^2 in numpy", np.abs(theirs.ravel() - formula).max())

    # All kernels lie inside of the grid; the reach is that of VTK's, three steps.
    inside = 0.25 + 0.5 * few
    np.savetxt(folder / "inside.csv", np.column_stack([inside, np.ones(len(inside))]), fmt="%.17g", delimiter=",", header="x,y,z,value", comments="")
    ours, _, steps, _ = by_ours(program, folder, "inside.csv", "density --reach 0.15", 100)
    row("stratavox, `density`: its sum over the number of points, less 1", abs(np.nansum(ours) * steps.prod() / len(inside) - 1))
    step = 0.01
    theirs, _ = by_vtk(sph)(inside, np.full(3, step / 2), np.full(3, step), 100)
    row("VTK, `vtkSPHInterpolator`, quintic kernel: the same", abs(theirs.sum() * (step / SPH_STEP) ** 3 / len(inside) - 1))

    words = "--flow stream --flow-seeds random:50 --flow-color temperature --force --progress none".split()
    run = lambda *words: subprocess.run([program, "convert", "phantom:storm,n=32", *words], check=True, capture_output=True)
    run("-o", folder / "lines.csv", *words)
    run("-o", folder / "warm.nrrd", "--variable", "temperature", "--force")
    rows = np.genfromtxt(folder / "lines.csv", delimiter=",", names=True)
    places = np.column_stack([rows["x"], rows["y"], rows["z"]])
    theirs, is_valid = probed(*volume(folder / "warm.nrrd"), places)
    off = np.abs(theirs - rows["value"])[is_valid] / np.abs(theirs[is_valid])
    row(f"values along {is_valid.sum()} vertices of lines, and `vtkProbeFilter` there, parts of them", off.max())


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
        equal(program, folder, few)


main()
