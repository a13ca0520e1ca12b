"""Environments and tables prefiltered for real-time renderers."""
import ctypes
import operator
import os

from . import _api
from ._calls import Call, Handle
from ._environment import Environment, resolve
from ._fields import fill, keywords_of, read, to_index
from ._image import Image, array_of_view, numpy
from ._library import C, check, create, path_bytes, take_bytes


class Cube(Handle):
    """A prefiltered cube map: cube[level] is an array of (6, size, size, 3); cube.save('environment.ktx2')."""

    _destroy = C.cube_destroy
    _makers = "facet.bake()"

    def __len__(self):
        with self._reading() as pointer:
            return C.cube_get_level_count(pointer)

    def face(self, level, face):
        """float32 (size, size, 3), linear: a read-only view without a copy. Faces +X -X +Y -Y +Z -Z."""
        owner, level = self._living, self._level(level)
        if not 0 <= operator.index(face) < 6:
            raise IndexError(f"there are 6 faces, but not {face}")
        return array_of_view(owner, C.cube_get_face(owner.pointer, level, face))[:, :, :3]

    def _level(self, level):
        """The number of a level; the library does not check it everywhere."""
        if not 0 <= operator.index(level) < len(self):
            raise IndexError(f"there are {len(self)} levels, but not {level}")
        return operator.index(level)

    def __getitem__(self, level):
        return numpy().stack([self.face(level, face) for face in range(6)])

    def roughness(self, level):
        """Perceptual roughness of a level."""
        with self._reading() as pointer:
            return C.cube_get_roughness(pointer, self._level(level))

    @property
    def stats(self):
        """Seconds, samples and the share that was clamped, as a dict."""
        with self._reading() as pointer:
            return read(C.cube_get_stats(pointer))

    @keywords_of(_api.facet_ktx2_desc, "allocator", "thread_count")
    def encode(self, **keywords):
        """The bytes of a KTX2 file."""
        desc = fill(_api.facet_ktx2_desc(), keywords, "encode")
        with self._reading() as pointer:
            return take_bytes(C.cube_encode_ktx2, pointer, desc)

    def save(self, path, **keywords):
        """Writes a KTX2 file; keywords as those of encode()."""
        if not os.fspath(path).lower().endswith(".ktx2"):
            raise ValueError(f"{path}: a cube map is written as .ktx2; unfold() makes an image of a level")
        data = self.encode(**keywords)
        check(C.bytes_save, data, len(data), path_bytes(path))

    def unfold(self, level=0, layout="equirectangular", height=0):
        """A level as one Image."""
        from ._fields import to_enum
        with self._reading() as pointer:
            return Image._adopt(create(C.cube_unfold, pointer, self._level(level), to_enum(_api.Layout, layout, "layout"),
                                        to_index(height, "height"), None))

    def __repr__(self):
        if self._owner is None:
            return "<facet.Cube, closed>"
        return f"<facet.Cube of {C.cube_get_size(self._pointer, 0)} texels, {len(self)} levels>"


@keywords_of(_api.facet_bake_desc, "allocator", "progress", "thread_count")
def bake(environment, *, threads=0, progress=None, **keywords):
    """The prefiltered cube map of an environment: lobe='ggx', 'charlie', 'lambert' or 'none'."""
    environment = environment if isinstance(environment, Environment) else resolve(environment, None, None, True)
    if environment is None:
        raise ValueError("there is no environment to bake")
    desc = fill(_api.facet_bake_desc(thread_count=to_index(threads, "threads")), keywords, "bake")
    call = Call(desc, progress)

    def work():
        with environment._reading() as pointer:
            return create(C.cube_bake, pointer, desc)

    return Cube._adopt(call.run(work, C.cube_destroy))


@keywords_of(_api.facet_dfg_desc, "allocator", "progress", "thread_count")
def bake_dfg(*, threads=0, progress=None, **keywords):
    """A table of directional albedo over N.V (x) and perceptual roughness (y): float32 (size, size, channels)."""
    desc = fill(_api.facet_dfg_desc(thread_count=to_index(threads, "threads")), keywords, "bake_dfg")
    call = Call(desc, progress)
    image = Image._adopt(call.run(lambda: create(C.dfg_bake, desc), C.image_destroy))
    return image.pixels[:, :, :C.dfg_get_channel_count(desc.kind)]


__all__ = ["Cube", "bake", "bake_dfg", "ctypes"]
