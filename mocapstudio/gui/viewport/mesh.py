"""VTK meshes whose arrays numpy writes into: changed in place, never rebuilt for a new frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

_NO_SHIFT = 0


class Mesh:
    """One actor of coloured triangles or lines.

    Parameters
    ----------
    lit
        Whether light falls on it; it then has normals.
    width
        Thickness of lines in pixels.
    """

    def __init__(self, *, lit: bool, width: float = 1.0) -> None:
        self._lit = lit
        self._data = vtkPolyData()
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(self._data)
        # The scene is metres across: shifting it for precision costs time and gains nothing.
        mapper.SetVBOShiftScaleMethod(_NO_SHIFT)
        self.actor = vtkActor()
        self.actor.SetMapper(mapper)
        self.actor.PickableOff()
        surface = self.actor.GetProperty()
        surface.SetLineWidth(width)
        surface.SetLighting(lit)
        if lit:
            surface.SetInterpolationToPhong()
            surface.SetAmbient(0.22)
            surface.SetDiffuse(0.86)
            surface.SetSpecular(0.16)
            surface.SetSpecularPower(24.0)
            surface.BackfaceCullingOn()
        self.reshape(0, np.zeros((0, 3), dtype=np.int64))

    def reshape(self, corners: int, cells: NDArray[np.int64], channels: int = 3) -> None:
        """Begin anew with `corners` vertices at the origin.

        Parameters
        ----------
        corners
            How many vertices.
        cells
            (N, 3) triangles or (N, 2) lines.
        channels
            3 for opaque colours, 4 for some that let the background through.
        """
        self.points = np.zeros((corners, 3), np.float32)
        self.normals = np.zeros((corners, 3), np.float32)
        self.colours = np.zeros((corners, channels), np.uint8)
        places = vtkPoints()
        places.SetData(numpy_to_vtk(self.points))
        array = vtkCellArray()
        starts = np.arange(len(cells) + 1, dtype=np.int64) * cells.shape[1]
        array.SetData(
            numpy_to_vtkIdTypeArray(starts, deep=True),
            numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells).ravel(), deep=True),
        )
        self._data.Initialize()
        self._data.SetPoints(places)
        if cells.shape[1] == 3:
            self._data.SetPolys(array)
        else:
            self._data.SetLines(array)
        colours = numpy_to_vtk(self.colours)
        colours.SetName("colours")
        self._data.GetPointData().SetScalars(colours)
        if self._lit:
            self._data.GetPointData().SetNormals(numpy_to_vtk(self.normals))
        self.actor.SetVisibility(corners > 0)

    def changed(self) -> None:
        """Tell VTK that `points`, `normals` or `colours` were written to."""
        self._data.GetPoints().GetData().Modified()
        self._data.GetPoints().Modified()
        self._data.GetPointData().GetScalars().Modified()
        if self._lit:
            self._data.GetPointData().GetNormals().Modified()
        self._data.Modified()

    def positions(self) -> NDArray[np.float32]:
        """(corners, 3) as VTK sees them."""
        result: NDArray[np.float32] = vtk_to_numpy(self._data.GetPoints().GetData())
        return result
