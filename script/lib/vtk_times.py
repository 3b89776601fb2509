"""Times of VTK for the scene of 256 voxels, drawn at 512 x 512: orbit without and with shadows, and a moving light.

python vtk_times.py VOLUME.nrrd [FRAMES]
"""

import statistics
import sys
import time

import vtk


def scene(path, shadows):
    reader = vtk.vtkNrrdReader()
    reader.SetFileName(path)
    reader.Update()
    mapper = vtk.vtkGPUVolumeRayCastMapper()
    mapper.SetInputConnection(reader.GetOutputPort())
    if shadows:
        mapper.SetGlobalIlluminationReach(1.0)
        mapper.SetVolumetricScatteringBlending(1.0)
    low, high = reader.GetOutput().GetScalarRange()
    opacity = vtk.vtkPiecewiseFunction()
    color = vtk.vtkColorTransferFunction()
    for share, alpha in [(0.0, 0.0), (0.25, 0.0), (0.45, 0.8), (1.0, 0.95)]:
        opacity.AddPoint(low + share * (high - low), alpha)
    color.AddRGBPoint(low, 0.9, 0.7, 0.5)
    color.AddRGBPoint(high, 0.9, 0.85, 0.8)
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetScalarOpacity(opacity)
    volume.GetProperty().SetColor(color)
    volume.GetProperty().ShadeOn()
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer = vtk.vtkRenderer()
    renderer.AddVolume(volume)
    light = vtk.vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPosition(2, 1, 3)
    renderer.AutomaticLightCreationOff()
    renderer.AddLight(light)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(512, 512)
    window.AddRenderer(renderer)
    renderer.ResetCamera()
    return window, renderer, light


def median_ms(window, change, frames):
    took = []
    # The first frame uploads the volume and compiles shaders.
    for frame in range(frames + 1):
        change(frame)
        begun = time.perf_counter()
        window.Render()
        window.WaitForCompletion()
        took.append((time.perf_counter() - begun) * 1000)
    return statistics.median(took[1:])


def main(path, frames):
    print(f"VTK {vtk.vtkVersion.GetVTKVersion()}")
    for name, shadows in [("orbit, shaded, without shadows", False), ("orbit with shadows", True)]:
        window, renderer, _ = scene(path, shadows)
        print(f"{name}: {median_ms(window, lambda _: renderer.GetActiveCamera().Azimuth(2), frames):.3g} ms")
    window, _, light = scene(path, True)
    print(f"moving light: {median_ms(window, lambda frame: light.SetPosition(2, 0.1 * frame, 3), frames):.3g} ms")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20)
