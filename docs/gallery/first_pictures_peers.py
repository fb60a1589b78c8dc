"""Draws six volumes without any choice of a person, by stratavox and by VTK (9.7 with numpy and Pillow) with three defaults.

    python docs/gallery/first_pictures_peers.py target/release/stratavox FOLDER_OF_VOLUMES PICTURE.png

Columns:
    stratavox       render INPUT
    VTK             vtkSmartVolumeMapper, vtkVolumeProperty and vtkRenderer as they are made, ResetCamera
    as ParaView     Cool to Warm over the range, opacity 0 to 1 along it per approximate cell length, no shade, the camera
                    reset, its background
    as napari       grey maximum intensity projection between the least and the largest value, looked at along the slices
                    from the first one, the first row above, fitted to .95 of the canvas
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import vtk
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
from PIL import Image, ImageDraw, ImageFont
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

PROGRAM, VOLUMES, PAGE = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
INPUTS = [
    ("CT of a head", "ct-cranium/cranium.nrrd", None),
    ("CT of a torso", "ct-torso/torso-2x.mha", None),
    ("MR of a head", "mri-mni152/mni152-t1.nii.gz", None),
    ("nuclei, fluorescence", "tiff-nuclei/img3d.tif", None),
    ("PET", "dicom-pet", None),
    ("specific humidity", "met-ifs-ml/forecast_ml.nc", "q"),
]
WIDTH, HEIGHT, HEADING = 400, 300, 26


def run(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


def ours(path, variable, folder):
    words = ["--variable", variable] if variable else []
    run("render", VOLUMES / path, *words, "--size", f"{WIDTH}x{HEIGHT}", "--force", "--progress", "none", "-o", folder / "a.png")
    return Image.open(folder / "a.png").convert("RGB")


def data(path, variable, folder):
    words = ["--variable", variable] if variable else []
    run("convert", VOLUMES / path, *words, "-o", folder / "volume.npy", "--force")
    facts = json.loads(run("info", VOLUMES / path, *words, "--json"))
    array = np.nan_to_num(np.load(folder / "volume.npy").astype(np.float32))
    made = vtk.vtkImageData()
    made.SetDimensions(*array.shape[::-1])
    made.SetSpacing(*facts["spacing"])
    made.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(array).reshape(-1), deep=1))
    return made


def by_vtk(image, kind):
    volume, scene, window = vtk.vtkVolume(), vtk.vtkRenderer(), vtk.vtkRenderWindow()
    mapper, look = vtk.vtkSmartVolumeMapper(), vtk.vtkVolumeProperty()
    mapper.SetInputData(image)
    low, high = image.GetScalarRange()
    if kind == "paraview":
        color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
        color.SetColorSpaceToDiverging()
        for share, rgb in [(0, (0.231373, 0.298039, 0.752941)), (0.5, (0.865, 0.865, 0.865)), (1, (0.705882, 0.0156863, 0.14902))]:
            color.AddRGBPoint(low + share * (high - low), *rgb)
        opacity.AddPoint(low, 0)
        opacity.AddPoint(high, 1)
        look.SetColor(color)
        look.SetScalarOpacity(opacity)
        look.SetInterpolationTypeToLinear()
        look.SetScalarOpacityUnitDistance(image.GetLength() / image.GetNumberOfCells() ** (1 / 3))
        scene.SetBackground(0.32, 0.34, 0.43)
    if kind == "napari":
        grey = vtk.vtkColorTransferFunction()
        grey.AddRGBPoint(low, 0, 0, 0)
        grey.AddRGBPoint(high, 1, 1, 1)
        look.SetColor(grey)
        look.SetScalarOpacity(opaque(low, high))
        look.SetInterpolationTypeToLinear()
        mapper.SetBlendModeToMaximumIntensity()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    scene.AddVolume(volume)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(WIDTH, HEIGHT)
    window.AddRenderer(scene)
    scene.ResetCamera()
    if kind == "napari":
        x0, x1, y0, y1, z0, _ = image.GetBounds()
        camera = scene.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetPosition((x0 + x1) / 2, (y0 + y1) / 2, z0 - 10 * image.GetLength())
        camera.SetViewUp(0, -1, 0)
        camera.SetParallelScale(max(y1 - y0, (x1 - x0) * HEIGHT / WIDTH) / 2 / 0.95)
        scene.ResetCameraClippingRange()
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(HEIGHT, WIDTH, -1)
    return Image.fromarray(np.ascontiguousarray(pixels[::-1, :, :3]))


def opaque(low, high):
    made = vtk.vtkPiecewiseFunction()
    made.AddPoint(low, 1)
    made.AddPoint(high, 1)
    return made


def main():
    columns = ["stratavox", "VTK", "as ParaView", "as napari"]
    page = Image.new("RGB", (WIDTH * len(columns), HEADING + len(INPUTS) * (HEIGHT + HEADING)), "white")
    pen, font = ImageDraw.Draw(page), ImageFont.load_default(16)
    for k, heading in enumerate(columns):
        pen.text((k * WIDTH + 8, 3), heading, "black", font)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for row, (name, path, variable) in enumerate(INPUTS):
            top = HEADING + row * (HEIGHT + HEADING)
            pen.text((8, top + 3), name, "black", font)
            image = data(path, variable, folder)
            tiles = [ours(path, variable, folder), *(by_vtk(image, kind) for kind in ["vtk", "paraview", "napari"])]
            for k, tile in enumerate(tiles):
                page.paste(tile, (k * WIDTH, top + HEADING))
    page.resize((page.width * 5 // 8, page.height * 5 // 8), Image.LANCZOS).save(PAGE, optimize=True)


main()
