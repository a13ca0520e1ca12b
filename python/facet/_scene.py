"""Models: loading, inspecting, posing, saving, rendering."""
import ctypes
import functools
import inspect
import json

from . import _api, _arrays
from ._calls import Call, Handle
from ._camera import matrix_rows
from ._fields import fill, keywords_of, read, to_enum, to_index
from ._image import load_from
from ._library import C, check, create, path_bytes, take_text
from ._render import Renderer, make_pose


class Scene(Handle):
    """A model: facet.load(path), Scene.from_arrays(), Scene.from_trimesh(), Scene.builtin()."""

    _destroy = C.scene_destroy
    _makers = "facet.load(), Scene.from_arrays(), Scene.from_trimesh() or Scene.builtin()"

    # ---- making ----

    @classmethod
    @keywords_of(_api.facet_scene_desc, "allocator", "log", "files", "thread_count")
    def load(cls, source, *, threads=0, log=None, **keywords):
        """A scene from a path, bytes or a binary file object: .glb, .gltf, .obj, .stl, .ply, rgl's .json. Files beside a model from
        memory need root, their folder."""
        desc = fill(_api.facet_scene_desc(thread_count=to_index(threads, "threads")), keywords, "load")
        return load_from(cls, source, desc, C.scene_load, C.scene_load_memory, Call(desc, log=log))

    @classmethod
    def builtin(cls):
        """The built-in scene: spheres over roughness and metallic, and a few materials."""
        return cls._adopt(create(C.scene_create_builtin, None))

    @classmethod
    def from_arrays(cls, positions=None, indices=None, **keywords):
        """A scene from arrays, which are copied.

        facet.Scene.from_arrays(vertices, faces)
        facet.Scene.from_arrays(vertices, faces, texcoords=uv, material={"base_color_texture": pixels, "metallic": 0})

        positions    (n, 3), m; +Y up
        indices      (m, 3) or flat; None: vertices in order. mode='lines': (m, 2), 'points'
        normals      (n, 3); without them triangles are flat
        tangents     (n, 4); without them they are computed where a normal texture needs them
        texcoords    (n, 2), or a list of sets; (0, 0) is the top left of an image
        colors       (n, 3) or (n, 4), linear, [0, 1]; uint8: sRGB
        material     a mapping of the fields of facet_material, and of textures: base_color_texture, normal_texture, ..: arrays
                     of uint8 (height, width, 1 to 4), or the bytes of an image file
        transform    4 x 4; instances: (k, 4, 4)
        meshes       several at once: a list of mappings with the keywords above
        nodes, cameras, lights   lists of mappings of the fields of facet_node_desc, .. (docs/python.md)
        """
        return cls._adopt(_arrays.create_scene(positions, indices, keywords))

    @classmethod
    def from_trimesh(cls, mesh, **keywords):
        """A scene from a trimesh.Trimesh or trimesh.Scene: vertices, faces, normals where they are stored, vertex colors,
        texture coordinates and textures (PBRMaterial, SimpleMaterial), and the transforms of a scene."""
        return cls.from_arrays(**_arrays.from_trimesh(mesh), **keywords)

    # ---- what is known ----

    @property
    def counts(self):
        """Numbers of nodes, meshes, materials, triangles, .., as a dict."""
        with self._reading() as pointer:
            return read(C.scene_get_counts(pointer))

    def describe(self):
        """Everything that facet inspect --json prints, as a dict."""
        with self._reading() as pointer:
            return json.loads(take_text(C.scene_describe_json, pointer))

    def bounds(self, *, scene_index=None, variant=None, animations=(), time_s=0.0):
        """((x, y, z), (x, y, z)) of what is drawn, m; None: nothing."""
        low, high = (ctypes.c_float * 3)(), (ctypes.c_float * 3)()
        keep = []
        desc = make_pose(self, keep, scene_index, variant, animations, time_s)
        with self._reading() as pointer:
            return (tuple(low), tuple(high)) if C.scene_get_bounds(pointer, desc, low, high) else None

    @property
    def origin(self):
        """The origin of world space in the coordinates of the file, m: 0 unless the model is far from it."""
        out = (ctypes.c_double * 3)()
        with self._reading() as pointer:
            C.scene_get_origin(pointer, out)
        return tuple(out)

    @property
    def animations(self):
        """[{'name': .., 'begin_s': .., 'end_s': ..}, ..]"""
        with self._reading() as pointer:
            count = C.scene_get_counts(pointer).animations
            return [read(C.scene_get_animation(pointer, i)) for i in range(count)]

    @property
    def files(self):
        """The files that the scene was read from."""
        with self._reading() as pointer:
            found = []
            while (path := C.scene_get_file(pointer, len(found))) is not None:
                found.append(path)
        return [path.decode("utf-8", "surrogateescape") for path in found]

    def __repr__(self):
        if self._owner is None:
            return "<facet.Scene, closed>"
        counts = self.counts
        return f"<facet.Scene of {counts['drawn_triangles']} triangles, {counts['materials']} materials>"

    # ---- changing ----

    def place(self, matrix, part=0):
        """Moves the model, or one of several parts, by a matrix of 4 x 4 from where it was loaded."""
        rows = matrix_rows(matrix, "matrix")
        columns = (ctypes.c_float * 16)(*(rows[row][column] for column in range(4) for row in range(4)))
        with self._changing() as pointer:
            check(C.scene_place_part, pointer, to_index(part, "part"), columns)

    def append(self, other):
        """Appends all of another scene, which becomes the next part of this one and is closed."""
        if not isinstance(other, Scene):
            raise TypeError(f"a Scene is needed, not a {type(other).__name__}")
        if other is self:
            raise ValueError("a scene cannot be appended to itself")
        with other._changing() as theirs, self._changing() as pointer:
            check(C.scene_append, pointer, theirs)
            other._owner.release.detach()
            other._owner = None

    @keywords_of(_api.facet_legacy_desc)
    def convert_materials(self, to, **keywords):
        """Converts all materials: to 'metallic-roughness', 'specular-glossiness' or 'ogl1', which adds those of OpenGL 1 beside.
        Returns the conversions with their errors, a dict per material."""
        desc = fill(_api.facet_legacy_desc(), keywords, "convert_materials")
        log = _LogOnly()
        call = Call(log)

        def work():
            with self._changing() as pointer:
                check(C.scene_convert_materials, pointer, to_enum(_api.MaterialModel, to, "to"), desc, log.log)

        call.run(work)
        return self.conversions

    @property
    def conversions(self):
        """The last conversion of materials, that of loading included: a dict per material."""
        with self._reading() as pointer:
            return [read(C.scene_get_conversion(pointer, i)) for i in range(C.scene_get_conversion_count(pointer))]

    def report(self, format="json"):
        """The last conversion as text: 'json' or 'html'."""
        with self._reading() as pointer:
            return take_text(C.scene_report_conversion, pointer, to_enum(_api.ReportFormat, format, "format"))

    @keywords_of(_api.facet_scene_save_desc, "allocator", "log", "progress", "thread_count")
    def save(self, path, *, threads=0, progress=None, log=None, **keywords):
        """Writes the scene: .glb, .gltf, .obj or rgl's .json, by the extension. The last two need convert_materials('ogl1')."""
        desc = fill(_api.facet_scene_save_desc(thread_count=to_index(threads, "threads")), keywords, "save")
        call = Call(desc, progress, log)

        def work():
            with self._reading() as pointer:
                check(C.scene_save, pointer, path_bytes(path), desc)

        call.run(work)

    # ---- images ----

    @functools.wraps(Renderer.render)
    def render(self, **keywords):
        with Renderer(self) as renderer:
            return renderer.render(**keywords)

    render.__signature__ = inspect.signature(Renderer.render)


class _LogOnly:
    """A facet_log in the form of a desc."""

    _fields_ = [("log", _api.facet_log)]

    def __init__(self):
        self.log = _api.facet_log()


load = Scene.load
