"""Cameras: a place and a direction, a pose, an orbit around the model, or one of the model's file."""
import functools
import math
import numbers
import reprlib

from . import _api
from ._fields import fill, keywords_of, to_index
from ._library import C, check, text_bytes


def matrix_rows(value, what):
    """A matrix of 4 x 4 as rows of floats, from nested sequences or an array."""
    try:
        rows = [[float(x) for x in row] for row in value]
    except TypeError:
        raise TypeError(f"{what} must be a matrix of 4 x 4, but is {reprlib.repr(value)}") from None
    if len(rows) != 4 or any(len(row) != 4 for row in rows):
        raise ValueError(f"{what} must be a matrix of 4 x 4")
    if any(abs(a - b) > 1e-6 for a, b in zip(rows[3], (0, 0, 0, 1))):
        raise ValueError(f"the last row of {what} must be 0 0 0 1; a matrix that multiplies rows must be transposed")
    return rows


class Camera:
    """A camera in world space: Camera(eye=(0, 1, 3), target=(0, 0, 0), fov_y_rad=0.6)."""

    @keywords_of(_api.facet_camera)
    def __init__(self, **keywords):
        """A camera by the fields of facet_camera."""
        self._struct = fill(_api.facet_camera(), keywords, "Camera")

    @classmethod
    def from_pose(cls, pose, fov_y_rad=math.radians(30), **keywords):
        """The camera of a camera-to-world matrix of 4 x 4 (numpy, trimesh, pyrender: columns are axes; OpenGL: it looks along
        its -Z, +Y is up in the image). For OpenCV's convention multiply by diag(1, -1, -1, 1) from the right."""
        m = matrix_rows(pose, "pose")
        eye = [m[k][3] for k in range(3)]
        length = math.sqrt(sum(m[k][2] ** 2 for k in range(3)))
        if not length > 0:
            raise ValueError("pose has no direction: its third column is 0")
        distance = max(1.0, *(abs(x) for x in eye))  # a target 1 m away would round to the eye far from the origin
        target = [eye[k] - distance * m[k][2] / length for k in range(3)]
        return cls(eye=eye, target=target, up=[m[k][1] for k in range(3)], fov_y_rad=fov_y_rad, **keywords)

    @classmethod
    def from_intrinsics(cls, K, size, pose, **keywords):
        """The camera of a matrix of intrinsics of 3 x 3 in pixels for images of size (width, height). Pixels must be square
        and the principal point the center of the image."""
        k = [[float(x) for x in row] for row in K]
        width, height = size
        if not (k[0][0] > 0 and abs(k[0][0] - k[1][1]) <= 1e-3 * k[1][1]):
            raise ValueError(f"the focal lengths must be equal (square pixels), but are {k[0][0]} and {k[1][1]}")
        if abs(k[0][2] - width / 2) > 1 or abs(k[1][2] - height / 2) > 1:
            raise ValueError(f"the principal point must be the center, ({width / 2}, {height / 2}), but is "
                             f"({k[0][2]}, {k[1][2]})")
        return cls.from_pose(pose, 2 * math.atan(height / (2 * k[1][1])), **keywords)

    def __getattr__(self, name):
        struct = self.__dict__.get("_struct")
        if struct is None or name not in struct.COMMENTS and name not in dict(struct._fields_):
            raise AttributeError(name)
        value = getattr(struct, name)
        return tuple(value) if hasattr(value, "__len__") else value

    def __repr__(self):
        shown = ", ".join(f"{name}={tuple(round(x, 4) for x in getattr(self, name))}" for name in ("eye", "target"))
        return f"facet.Camera({shown}, fov_y_rad={self.fov_y_rad:.4f})"

    def _resolve(self, scene, pose, aspect):
        return self._struct


class Orbit:
    """A camera on a sphere around the model that frames it: Orbit(azimuth_rad=0.6, polar_rad=1.2)."""

    @keywords_of(_api.facet_orbit, "log")
    def __init__(self, **keywords):
        """An orbit by the fields of facet_orbit, over facet_orbit_default()."""
        self._struct = C.orbit_default()
        if "target" in keywords:
            keywords = {"has_target": True, **keywords}
        fill(self._struct, keywords, "Orbit")
        self._keywords = dict(keywords)

    def __reduce__(self):
        return functools.partial(Orbit, **self._keywords), ()

    def __repr__(self):
        return f"facet.Orbit(azimuth_rad={self._struct.azimuth_rad:.4f}, polar_rad={self._struct.polar_rad:.4f})"

    def _resolve(self, scene, pose, aspect):
        camera = _api.facet_camera()
        with scene._reading() as pointer:
            check(C.camera_from_orbit, pointer, pose, self._struct, aspect, camera)
        return camera


def camera_of_file(scene, pose, name):
    """Camera by name or number."""
    camera = _api.facet_camera()
    with scene._reading() as pointer:
        index = _api.c_uint32()
        if isinstance(name, str):
            check(C.scene_find_camera, pointer, text_bytes(name, "camera"), index)
        else:
            index.value = to_index(name, "camera")
        check(C.camera_from_scene, pointer, pose, index.value, camera)
    return camera


def resolve(camera, scene, pose, aspect):
    """The facet_camera of whatever a user may give as a camera; None: the library's default."""
    if camera is None:
        return None
    if hasattr(camera, "_resolve"):
        if scene is None and isinstance(camera, Orbit):
            raise ValueError("an Orbit goes around a model; a sea without one needs a Camera")
        return camera._resolve(scene, pose, aspect)
    if isinstance(camera, (numbers.Integral, str)):
        if scene is None:
            raise ValueError("a camera by name is one of the model's file, but there is no model")
        return camera_of_file(scene, pose, camera)
    if hasattr(camera, "keys"):
        return Camera(**camera)._struct
    return Camera.from_pose(camera)._struct
