"""Light from all directions."""
import ctypes
import numbers
import os

from . import _api
from ._calls import Call, Handle
from ._fields import fill, keywords_of, read
from ._image import Image, load_from, numpy
from ._library import C, check, create


def _numbers(values, count=3):
    values = [float(x) for x in ([values] * count if isinstance(values, numbers.Real) else values)]
    if len(values) != count:
        raise ValueError(f"{count} numbers are needed, not {len(values)}")
    return (ctypes.c_float * count)(*values)


class Environment(Handle):
    """Image-based light, for render(environment=...), bake() and harmonics()."""

    _destroy = C.environment_destroy
    _makers = "Environment.load(), .from_array(), .sky(), .studio(), .constant() or .gradient()"

    @classmethod
    @keywords_of(_api.facet_environment_desc, "allocator", "log")
    def load(cls, source, **keywords):
        """An environment from a path, bytes or a binary file object: .hdr, .exr, .ktx2, or 8-bit formats."""
        desc = fill(_api.facet_environment_desc(), keywords, "load")
        return load_from(cls, source, desc, C.environment_load, C.environment_load_memory)

    @classmethod
    def from_array(cls, pixels, **keywords):
        """An environment from an array of (height, 2 height, 3) or another layout; float: radiance in cd/m^2."""
        with Image.from_array(pixels) as image:
            return cls.load(image.encode("pfm"), **keywords)

    @classmethod
    def studio(cls):
        """The built-in neutral studio."""
        return cls._create(C.environment_create_studio)

    @classmethod
    def constant(cls, radiance):
        """The same radiance, cd/m^2, from everywhere: a number or linear (r, g, b)."""
        return cls._create(C.environment_create_constant, _numbers(radiance))

    @classmethod
    def gradient(cls, zenith, horizon, nadir):
        """Radiance of zenith, horizon and nadir, cd/m^2, numbers or linear (r, g, b)."""
        return cls._create(C.environment_create_gradient, *(_numbers(x) for x in (zenith, horizon, nadir)))

    @classmethod
    @keywords_of(_api.facet_sky_desc)
    def sky(cls, **keywords):
        """A clear sky by day. illuminance_lux=3.14159 makes a white surface 1 cd/m^2; 0 is physical units."""
        return cls._create(C.environment_create_sky, fill(_api.facet_sky_desc(), keywords, "sky"))

    @classmethod
    def _create(cls, function, *arguments):
        desc = _api.facet_environment_desc()
        call = Call(desc)
        return cls._adopt(call.run(lambda: create(function, *arguments, desc), cls._destroy))

    @property
    def info(self):
        """Layout, size, mean and largest radiance, as a dict."""
        info = _api.facet_environment_info()
        with self._reading() as pointer:
            check(C.environment_get_info, pointer, info)
        return read(info)

    @keywords_of(_api.facet_sh_desc, "allocator")
    def harmonics(self, **keywords):
        """Nine spherical harmonics as an array of (9, 3); form: 'radiance', 'irradiance' or 'folded'."""
        desc = fill(_api.facet_sh_desc(), keywords, "harmonics")
        out = numpy().zeros((9, 3), numpy().float32)
        rows = ctypes.cast(out.ctypes.data, ctypes.POINTER(ctypes.c_float * 3))
        with self._reading() as pointer:
            check(C.environment_project_sh, pointer, desc, rows)
        return out

    def bake(self, *, progress=None, **keywords):
        """The prefiltered cube map: a Cube. Keywords as those of facet.bake()."""
        from ._bake import bake
        return bake(self, progress=progress, **keywords)

    def __repr__(self):
        if self._owner is None:
            return "<facet.Environment, closed>"
        info = self.info
        return f"<facet.Environment {info['width']} x {info['height']}>"


def resolve(environment, scene, pose, ignores_scene_lights):
    """(an Environment or None, whether it is a temporary one) of whatever a user may give."""
    if environment is None or isinstance(environment, Environment):
        return environment
    if isinstance(environment, str) and environment == "none":
        return None
    if isinstance(environment, str) and environment in ("auto", "studio", "neutral"):
        if environment == "auto" and scene is not None and not ignores_scene_lights:
            with scene._reading() as pointer:
                if C.scene_has_environment(pointer, pose):
                    return Environment._create(C.environment_create_from_scene, pointer, pose)
        return studio()
    if isinstance(environment, (str, os.PathLike, bytes)) or hasattr(environment, "read"):
        return Environment.load(environment)
    if isinstance(environment, Handle) and not isinstance(environment, Image):
        raise TypeError(f"environment must be an Environment, a path, bytes or an array, not a {type(environment).__name__}")
    return Environment.from_array(environment)


_studio = []


def studio():
    """One studio for all renders, which keeps what they filter of it."""
    if not _studio:
        _studio.append(Environment.studio())
    return _studio[0]
