#!/usr/bin/env python3
"""Stream lines beside those of VTK: python3 stream_lines_beside_vtk.py target/release/stratavox   (pip install vtk numpy)

The wind is that of Arnold, Beltrami and Childress on 256^3 points, u = A sin z + C cos y, v = B sin x + A cos z,
w = C sin y + B cos x, once around the box; both programs read the same .vti file and begin at the same 1000 places. Lines go
forward for 100 cells at most. What is true is the classic method of Runge and Kutta of order 4 along the same trilinear field by steps
of a fiftieth of a cell. Prints a table of Markdown: how far vertices lie from the true lines, and the time that lines take: of VTK that of Update(), of stratavox that of
`convert` less that of one seed. Both by turns, five times, the median.
"""
import csv
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

N, SEEDS, LENGTH, TURNS = 256, 1000, 100.0, 5


def wind(path):
    x = np.linspace(0, 2 * np.pi, N)
    z, y, x = np.meshgrid(x, x, x, indexing="ij")
    a, b, c = 3**0.5, 2**0.5, 1.0
    parts = a * np.sin(z) + c * np.cos(y), b * np.sin(x) + a * np.cos(z), c * np.sin(y) + b * np.cos(x)
    image = vtk.vtkImageData()
    image.SetDimensions(N, N, N)
    for name, part in zip("uvw", parts):
        values = numpy_to_vtk(part.astype(np.float32).ravel(), deep=1)
        values.SetName(name)
        image.GetPointData().AddArray(values)
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.Write()
    vectors = np.stack([part.astype(np.float32).ravel() for part in parts], axis=1)
    vectors = numpy_to_vtk(vectors, deep=1)
    vectors.SetName("wind")
    image.GetPointData().SetVectors(vectors)
    return image


def true_lines(image, seeds, step=0.02, kept=5):
    """By length along the line, of each seed; values beyond the outer voxels are theirs."""
    field = vtk_to_numpy(image.GetPointData().GetVectors()).reshape(N, N, N, 3)

    def way(p):
        p = np.clip(p, 0, N - 1)
        i = np.minimum(p.astype(int), N - 2)
        t = p - i
        v = 0
        for corner in np.ndindex(2, 2, 2):
            x, y, z = (i + corner).T
            weight = np.prod(np.where(corner, t, 1 - t), axis=1)
            v = v + weight[:, None] * field[z, y, x]
        return v / np.linalg.norm(v, axis=1)[:, None]

    p, places = seeds.copy(), [seeds.copy()]
    # A little longer than lines are, so that their ends have a true place beside them.
    for n in range(round((LENGTH + 1) / step)):
        a = way(p)
        b = way(p + step / 2 * a)
        c = way(p + step / 2 * b)
        d = way(p + step * c)
        p = p + step / 6 * (a + 2 * b + 2 * c + d)
        if n % kept == kept - 1:
            places.append(p)
    return np.stack(places, axis=1)


def by_vtk(image, seeds):
    """Lines, and seconds."""
    points = vtk.vtkPoints()
    for seed in seeds:
        points.InsertNextPoint(*seed)
    source = vtk.vtkPolyData()
    source.SetPoints(points)
    tracer = vtk.vtkStreamTracer()
    tracer.SetInputData(image)
    tracer.SetSourceData(source)
    tracer.SetIntegratorTypeToRungeKutta45()
    tracer.SetIntegrationDirectionToForward()
    tracer.SetIntegrationStepUnit(vtk.vtkStreamTracer.CELL_LENGTH_UNIT)
    # The length unit of a cell is its diagonal.
    tracer.SetInitialIntegrationStep(0.5 / 3**0.5)
    tracer.SetMinimumIntegrationStep(0.01 / 3**0.5)
    tracer.SetMaximumIntegrationStep(1 / 3**0.5)
    tracer.SetMaximumError(1e-8)
    tracer.SetMaximumNumberOfSteps(100_000)
    tracer.SetMaximumPropagation(LENGTH)
    tracer.SetTerminalSpeed(1e-12)
    tracer.SetComputeVorticity(False)
    begun = time.perf_counter()
    tracer.Update()
    seconds = time.perf_counter() - begun
    out = tracer.GetOutput()
    places = vtk_to_numpy(out.GetPoints().GetData()).astype(np.float64)
    of_seed = vtk_to_numpy(out.GetCellData().GetArray("SeedIds"))
    lines, cell = {}, vtk.vtkIdList()
    lists = out.GetLines()
    lists.InitTraversal()
    for seed in of_seed:
        lists.GetNextCell(cell)
        lines[int(seed)] = places[[cell.GetId(i) for i in range(cell.GetNumberOfIds())]]
    return lines, seconds


def by_ours(program, folder, seeds, name):
    """Lines, and seconds of the whole command."""
    with open(folder / f"{name}.csv", "w") as file:
        file.write("x,y,z\n")
        file.writelines(f"{x!r},{y!r},{z!r}\n" for x, y, z in seeds.tolist())
    words = "--flow stream --wind u,v,w --flow-direction forward --force --progress none".split()
    words += ["--flow-seeds", f"{name}.csv", "--flow-length", str(LENGTH), "-o", f"{name}.lines.csv"]
    begun = time.perf_counter()
    subprocess.run([program, "convert", "wind.vti", *words], cwd=folder, check=True, capture_output=True)
    seconds = time.perf_counter() - begun
    lines = {}
    with open(folder / f"{name}.lines.csv") as file:
        for row in csv.DictReader(file):
            lines.setdefault(int(row["line"]), []).append([float(row[k]) for k in "xyz"])
    return {k: np.array(line) for k, line in lines.items()}, seconds


def distances(places, line):
    """Of each place to a polyline."""
    a, d = line[:-1], np.diff(line, axis=0)
    length = np.maximum((d * d).sum(1), 1e-300)
    t = np.clip(((places[:, None] - a) * d).sum(2) / length, 0, 1)
    return np.linalg.norm(places[:, None] - a - t[..., None] * d, axis=2).min(1)


def main():
    program = str(Path(sys.argv[1]).resolve())
    seeds = np.random.default_rng(1).uniform(40, N - 41, (SEEDS, 3)).astype(np.float32).astype(np.float64)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        image = wind(folder / "wind.vti")
        true = true_lines(image, seeds)
        times = [[], []]
        for _ in range(TURNS):
            ours, of_all = by_ours(program, folder, seeds, "all")
            _, of_one = by_ours(program, folder, seeds[:1], "one")
            times[0].append(of_all - of_one)
            theirs, seconds = by_vtk(image, seeds)
            times[1].append(seconds)
    print("| | vertices | largest distance | root of the mean square | seconds |\n|---|---|---|---|---|")
    for name, lines, seconds in zip(["stratavox", f"VTK {vtk.VTK_VERSION}"], [ours, theirs], times):
        assert sorted(lines) == list(range(SEEDS)), f"{name}: a seed without a line"
        off = np.concatenate([distances(lines[k], true[k]) for k in range(SEEDS)])
        rms = (off**2).mean() ** 0.5
        print(f"| {name} | {len(off)} | {off.max():.1e} | {rms:.1e} | {statistics.median(seconds):.2f} |")


main()
