"""VTK's fixed-point ray caster on one thread: a picture for every azimuth read.

caster.py painted|scalars FILE NX NY NZ Z_SPACING WIDTH ELEVATION PIXELS_BETWEEN_RAYS

`painted` takes opacity and grey, a byte each, voxel by voxel; `scalars` takes int16 and shades them by the light at the
observer. For every line on standard input, an azimuth in degrees, it writes "milliseconds 3" and a newline, and then
WIDTH x WIDTH x 3 bytes of linear RGB, the top row first. Needs the package vtk and, without a display, libosmesa6.
"""

import math
import os
import sys
import time

os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
import numpy
import vtk
from vtk.util import numpy_support

kind, path = sys.argv[1:3]
size = tuple(int(n) for n in sys.argv[3:6])
z_spacing, width, elevation, between = (
    float(sys.argv[6]), int(sys.argv[7]), math.radians(float(sys.argv[8])), float(sys.argv[9]))
vtk.vtkMultiThreader.SetGlobalMaximumNumberOfThreads(1)
vtk.vtkMultiThreader.SetGlobalDefaultNumberOfThreads(1)

image = vtk.vtkImageData()
image.SetDimensions(*size)
image.SetSpacing(1.0, 1.0, z_spacing)
look = vtk.vtkVolumeProperty()
look.SetInterpolationTypeToLinear()
look.SetScalarOpacityUnitDistance(1.0)
opacity = vtk.vtkPiecewiseFunction()
if kind == "painted":
    pairs = numpy.fromfile(path, "u1").reshape(-1, 2)
    voxels = pairs[:, [1, 1, 1, 0]].copy()
    array = numpy_support.numpy_to_vtk(voxels, deep=True, array_type=vtk.VTK_UNSIGNED_CHAR)
    look.IndependentComponentsOff()
    look.ShadeOff()
    opacity.AddPoint(0, 0)
    opacity.AddPoint(255, 1)
else:
    array = numpy_support.numpy_to_vtk(numpy.fromfile(path, "<i2"), deep=True)
    color = vtk.vtkColorTransferFunction()
    # The bone of the task, in linear light.
    color.AddRGBPoint(0, 1.0, 0.847, 0.604)
    look.SetColor(color)
    look.ShadeOn()
    look.SetAmbient(0.25)
    look.SetDiffuse(0.7)
    look.SetSpecular(0.2)
    look.SetSpecularPower(20)
    opacity.AddPoint(1324, 0)
    opacity.AddPoint(1724, 1)
image.GetPointData().SetScalars(array)
look.SetScalarOpacity(opacity)

mapper = vtk.vtkFixedPointVolumeRayCastMapper()
mapper.SetNumberOfThreads(1)
mapper.AutoAdjustSampleDistancesOff()
mapper.LockSampleDistanceToInputSpacingOff()
mapper.SetImageSampleDistance(between)
mapper.SetSampleDistance(1.0)
mapper.SetInteractiveSampleDistance(1.0)
mapper.SetInputData(image)
volume = vtk.vtkVolume()
volume.SetMapper(mapper)
volume.SetProperty(look)
scene = vtk.vtkRenderer()
scene.AddVolume(volume)
window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetMultiSamples(0)
window.SetSize(width, width)
window.AddRenderer(scene)
middle = [(n - 1) * spacing / 2 for n, spacing in zip(size, (1.0, 1.0, z_spacing))]
camera = scene.GetActiveCamera()


def frame(azimuth):
    """Milliseconds of the picture from an azimuth in degrees."""
    turn = math.radians(azimuth)
    toward = (math.sin(turn) * math.cos(elevation), -math.cos(turn) * math.cos(elevation), math.sin(elevation))
    camera.ParallelProjectionOn()
    camera.SetParallelScale(128)
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(at + 600 * way for at, way in zip(middle, toward)))
    camera.SetViewUp(0, 0, 1)
    camera.SetClippingRange(200, 1000)
    start = time.perf_counter()
    window.Render()
    return (time.perf_counter() - start) * 1e3


def pixels():
    """The picture in the window, the top row first."""
    grabbed = vtk.vtkWindowToImageFilter()
    grabbed.SetInput(window)
    grabbed.ReadFrontBufferOff()
    grabbed.ShouldRerenderOff()
    grabbed.Update()
    values = numpy_support.vtk_to_numpy(grabbed.GetOutput().GetPointData().GetScalars())
    return values.reshape(width, width, 3)[::-1].tobytes()


for line in sys.stdin:
    took = frame(float(line))
    sys.stdout.buffer.write(f"{took:.6f} 3\n".encode() + pixels())
    sys.stdout.buffer.flush()
