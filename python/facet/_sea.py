"""The ocean."""
import ctypes

from . import _api
from ._calls import Handle
from ._camera import Camera
from ._fields import fill, keywords_of, read, to_index
from ._image import Image, numpy
from ._library import C, check, create, text_bytes
from ._render import Renderer
from ._scene import Scene


class Sea(Handle):
    """A sea: Sea('trade-wind'), Sea(wind_mps=12, bed={'depth_m': 20}). render(sea=...) puts it around a model."""

    _destroy = C.sea_destroy

    @keywords_of(_api.facet_sea_desc, "allocator", "log", "thread_count")
    def __init__(self, preset=None, *, threads=0, **keywords):
        """A sea at time 0, by a preset (Sea.presets()) or facet_sea_default(), and the fields of facet_sea_desc."""
        desc = C.sea_default()
        if preset is not None:
            check(C.sea_preset, text_bytes(preset, "preset"), desc)
        fill(desc, keywords, "Sea")
        desc.thread_count = to_index(threads, "threads")
        self._own(create(C.sea_create, desc))

    @staticmethod
    def presets():
        """The names of presets."""
        return [C.sea_get_preset_name(i).decode() for i in range(C.sea_get_preset_count())]

    def set_time(self, time_s):
        """Moves the waves to any time, s."""
        with self._changing() as pointer:
            check(C.sea_set_time, pointer, time_s)

    @property
    def info(self):
        """Statistics of waves, foam and water, as a dict."""
        with self._reading() as pointer:
            return read(C.sea_get_info(pointer))

    def points(self, positions):
        """The surface at positions (n, 2), pairs of x and z, m: a dict of arrays height_m (n), normal (n, 3), velocity_mps (n),
        jacobian (n)."""
        np = numpy()
        places = np.ascontiguousarray(np.asarray(positions).astype(np.float64, casting="same_kind"))
        if places.shape == (2,):
            places = places[None]
        if places.ndim != 2 or places.shape[1] != 2 or not np.isfinite(places).all():
            raise ValueError(f"positions must be finite numbers of shape (n, 2), but the shape is {places.shape}")
        out = np.zeros((len(places), 6), np.float32)
        with self._reading() as pointer:
            C.sea_get_points(pointer, places.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), len(places),
                             ctypes.cast(out.ctypes.data, ctypes.POINTER(_api.facet_sea_point)))
        return {"height_m": out[:, 0], "normal": out[:, 1:4], "velocity_mps": out[:, 4], "jacobian": out[:, 5]}

    def camera(self, height_m=0.0, azimuth_rad=0.0):
        """A view from above the origin towards azimuth_rad, from +Z towards +X."""
        with self._reading() as pointer:
            struct = C.sea_camera(pointer, height_m, azimuth_rad)
        camera = Camera()
        camera._struct = struct
        return camera

    def maps(self, tile=0):
        """A tile of waves as an Image of displacements with the layers 'normal', 'slope', 'jacobian' and 'foam'."""
        with self._reading() as pointer:
            return Image._adopt(create(C.sea_create_maps, pointer, to_index(tile, "tile"), None))

    @keywords_of(_api.facet_sea_mesh_desc, "allocator")
    def mesh(self, **keywords):
        """A square of the surface, and of the bed, as a Scene."""
        desc = fill(_api.facet_sea_mesh_desc(), keywords, "mesh")
        with self._reading() as pointer:
            return Scene._adopt(create(C.sea_create_mesh, pointer, desc), self)

    def render(self, scene=None, *, exposure_ev="auto", **keywords):
        """An image of the sea, with a scene in it or alone. Keywords as those of Scene.render(); sky={'sun_elevation_rad': 0.4}."""
        with Renderer(scene) as renderer:
            return renderer.render(sea=self, exposure_ev=exposure_ev, **keywords)
