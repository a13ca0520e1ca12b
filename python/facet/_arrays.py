"""Scenes from arrays: keywords and numpy arrays to facet_arrays_desc, and objects of trimesh to keywords."""
import ctypes
import numbers
import os

from . import _api
from ._calls import Call
from ._camera import matrix_rows
from ._fields import fill, mapping, to_enum, unknown_keyword
from ._image import numpy
from ._library import C, create, text_bytes

_FLOATS, _INDICES, _DOUBLES = (ctypes.POINTER(t) for t in (ctypes.c_float, ctypes.c_uint32, ctypes.c_double))
_SLOTS = {f"{slot.name.lower()}_texture": slot for slot in _api.TextureSlot if slot.name != "COUNT"}
_USE = ("texcoord", "offset", "rotation_rad", "scale")
_SAMPLER = ("name", "wrap_u", "wrap_v", "mag_filter", "min_filter", "mip_filter")


class Builder:
    """The tables of one scene. What the structs point to is in `keep`."""

    def __init__(self):
        self.np = numpy()
        self.keep = []
        self.textures, self.texture_numbers = [], {}
        self.materials, self.material_numbers = [], {}
        self.meshes, self.cameras, self.lights, self.nodes = [], [], [], []

    # ---- arrays ----

    def floats(self, values, widths, what, count=None):
        """A contiguous float32 array of rows of one of the widths, and its pointer."""
        try:
            array = self.np.asarray(values)
            if array.dtype.kind == "c":
                raise TypeError(f"they are {array.dtype}, not real numbers")
            with self.np.errstate(over="ignore"):  # the library names the number that is infinite
                array = self.np.ascontiguousarray(array, self.np.float32)
        except (TypeError, ValueError) as error:
            raise type(error)(f"{what}: {error}") from None
        if array.ndim != 2 or array.shape[1] not in widths or count is not None and len(array) != count:
            rows = f"{count} rows" if count is not None else "rows"
            raise ValueError(f"{what} must have {rows} of {' or '.join(map(str, widths))} numbers, but its shape is "
                             f"{array.shape}")
        return array, self.pointer(array, _FLOATS)

    def pointer(self, array, kind):
        self.keep.append(array)
        return ctypes.cast(array.ctypes.data, kind)

    def indices(self, values, corners, what):
        array = self.np.asarray(values)
        if array.size and array.dtype.kind not in "ui":
            raise TypeError(f"{what} must be integers, but are {array.dtype}")
        if array.ndim not in (1, 2) or array.ndim == 2 and array.shape[1] != corners:
            raise ValueError(f"{what} must be flat or rows of {corners}, but the shape is {array.shape}")
        if array.size and (array.min() < 0 or array.max() >= 1 << 32):
            raise ValueError(f"{what} must lie in [0, 2^32), but one is {array.min() if array.min() < 0 else array.max()}")
        array = self.np.ascontiguousarray(array, self.np.uint32).ravel()
        return len(array), self.pointer(array, _INDICES)

    def colors(self, values, count, what):
        """Linear RGBA; bytes are sRGB with linear alpha."""
        array = self.np.asarray(values)
        if array.dtype == self.np.uint8:
            table = self.np.array([C.linear_from_srgb(i / 255) for i in range(256)], self.np.float32)
            linear = table[array]
            if array.ndim == 2 and array.shape[1] == 4:
                linear[:, 3] = array[:, 3] / self.np.float32(255)
            array = linear
        elif array.dtype.kind in "iufb" and array.size and (array.min() < -1e-3 or array.max() > 1.001):
            raise ValueError(f"{what} must lie in [0, 1], or be bytes of dtype uint8, but are {array.dtype} from "
                             f"{array.min()} to {array.max()}")
        array, _ = self.floats(array, (3, 4), what, count)
        if array.shape[1] == 3:
            array = self.np.concatenate([array, self.np.ones((len(array), 1), self.np.float32)], axis=1)
        return self.pointer(self.np.ascontiguousarray(array), _FLOATS)

    # ---- textures and materials ----

    def texture(self, value, sampler, what):
        """The number of a texture; the same object gives the same one."""
        key = id(value), tuple(sorted(sampler.items()))
        if key in self.texture_numbers:
            return self.texture_numbers[key]
        self.keep.append(value)  # its id stays its own
        for name in sampler:
            if name not in _SAMPLER:
                raise unknown_keyword(what, name, ["image", *_USE, *_SAMPLER])
        desc = fill(_api.facet_texture_desc(), sampler, what)
        if isinstance(value, (str, os.PathLike)):
            with open(value, "rb") as file:
                value = file.read()
        if isinstance(value, (bytes, bytearray, memoryview)):
            data = ctypes.create_string_buffer(bytes(value), len(value))
            self.keep.append(data)
            desc.bytes, desc.size = ctypes.cast(data, ctypes.c_void_p), len(value)
        else:
            pixels = value.convert("RGBA") if hasattr(value, "convert") and hasattr(value, "getbands") else value
            array = self.np.ascontiguousarray(pixels)
            if array.dtype != self.np.uint8:
                raise TypeError(f"{what} must be an array of uint8 or the bytes of an image file, not of {array.dtype}")
            array = array[:, :, None] if array.ndim == 2 else array
            if array.ndim != 3 or array.shape[2] not in (1, 2, 3, 4):
                raise ValueError(f"{what} must be (height, width, 1 to 4), but its shape is {array.shape}")
            desc.pixels = self.pointer(array, ctypes.c_void_p)
            desc.height, desc.width, desc.channel_count = array.shape
        self.textures.append(desc)
        self.texture_numbers[key] = len(self.textures) - 1
        return len(self.textures) - 1

    def material(self, keywords):
        """The number of a material: a mapping."""
        if id(keywords) in self.material_numbers:
            return self.material_numbers[id(keywords)]
        self.keep.append(keywords)
        out = C.material_default()
        fields = [name for name, _ in out._fields_ if name != "textures"]
        for name, value in mapping(keywords, "material").items():
            if name in _SLOTS:
                self.use(out.textures[_SLOTS[name]], value, f"material: {name}")
            elif name in fields:
                if name in ("base_color", "emissive", "sheen_color", "specular_color", "attenuation_color"):
                    value = _color(value, len(getattr(out, name)))
                fill(out, {name: value}, "material")
            else:
                raise unknown_keyword("material", name, fields + list(_SLOTS))
        self.materials.append(out)
        self.material_numbers[id(keywords)] = len(self.materials) - 1
        return len(self.materials) - 1

    def use(self, use, value, what):
        """A texture, or a mapping with 'image', its transform and its sampler."""
        keywords = dict(value) if hasattr(value, "keys") else {"image": value}
        if "image" not in keywords:
            raise ValueError(f"{what} needs 'image'")
        image = keywords.pop("image")
        sampler = {name: keywords.pop(name) for name in list(keywords) if name not in _USE}
        fill(use, keywords, what)
        use.texture = self.texture(image, sampler, what)
        use.is_used = True

    # ---- meshes ----

    def mesh(self, positions, indices=None, *, normals=None, tangents=None, texcoords=None, colors=None, mode="triangles",
             material=None, name=None):
        primitive = _api.facet_primitive_desc(mode=to_enum(_api.PrimitiveMode, mode, "mode"))
        array, primitive.positions = self.floats(positions, (3,), "positions")
        count = primitive.vertex_count = len(array)
        if indices is not None:
            corners = (3, 2, 1)[primitive.mode]
            primitive.index_count, primitive.indices = self.indices(indices, corners, "indices")
        if normals is not None:
            primitive.normals = self.floats(normals, (3,), "normals", count)[1]
        if tangents is not None:
            primitive.tangents = self.floats(tangents, (4,), "tangents", count)[1]
        for i, values in enumerate(_sets(texcoords)):
            primitive.texcoords[i] = self.floats(values, (2,), "texcoords", count)[1]
        if colors is not None:
            primitive.colors = self.colors(colors, count, "colors")
        if material is not None:
            primitive.has_material, primitive.material = True, self.material(material)
        desc = _api.facet_mesh_desc(primitive_count=1, primitives=ctypes.pointer(primitive))
        desc.name = text_bytes(name, "name") if name else None
        self.meshes.append(desc)
        return len(self.meshes) - 1

    def matrix(self, value, what):
        rows = matrix_rows(value, what)
        return self.pointer(self.np.array(rows).T.ravel().copy(), _DOUBLES)

    def add_mesh(self, keywords, has_nodes):
        keywords = mapping(keywords, "a mesh")
        transform, instances = keywords.pop("transform", None), keywords.pop("instances", None)
        if has_nodes and (transform is not None or instances is not None):
            raise ValueError("transform and instances of a mesh cannot be given beside nodes, which place meshes")
        _check_keywords(self.mesh, keywords)
        number, name = self.mesh(**keywords), keywords.get("name")
        if has_nodes:
            return
        parent = self.node({"name": name, "matrix": transform, **({} if instances is not None else {"mesh": number})})
        for matrix in [] if instances is None else instances:
            self.node({"name": name, "parent": parent, "matrix": matrix, "mesh": number})

    # ---- nodes, cameras, lights ----

    def node(self, keywords):
        desc = _api.facet_node_desc()
        keywords = {name: value for name, value in mapping(keywords, "a node").items() if value is not None}
        for name in ("parent", "mesh", "camera", "light"):
            if name in keywords:
                keywords[f"has_{name}"] = True
        if "matrix" in keywords:
            desc.matrix = self.matrix(keywords.pop("matrix"), "matrix")
        fill(desc, keywords, "node")
        self.nodes.append(desc)
        return len(self.nodes) - 1

    def add(self, kind, table, struct, keywords, has_nodes):
        keywords = mapping(keywords, f"a {kind}")
        pose = keywords.pop("pose", None)
        table.append(fill(struct, keywords, kind))
        if has_nodes and pose is not None:
            raise ValueError(f"the pose of a {kind} cannot be given beside nodes, which place it")
        if not has_nodes:
            self.node({"name": keywords.get("name"), "matrix": pose, kind: len(table) - 1})

    # ---- the scene ----

    def create(self, name, log):
        desc, arrays = _api.facet_scene_desc(), _api.facet_arrays_desc()
        arrays.name = text_bytes(name, "scene_name") if name else None
        for field, kind in (("textures", _api.facet_texture_desc), ("materials", _api.facet_material),
                            ("meshes", _api.facet_mesh_desc), ("cameras", _api.facet_camera_desc),
                            ("lights", _api.facet_light_desc), ("nodes", _api.facet_node_desc)):
            rows = getattr(self, field)
            table = (kind * len(rows))(*rows)
            setattr(arrays, field, table)
            setattr(arrays, ("mesh" if field == "meshes" else field[:-1]) + "_count", len(rows))
        return Call(desc, log=log).run(lambda: create(C.scene_create, arrays, desc), C.scene_destroy)


def _sets(texcoords):
    if texcoords is None:
        return []
    if isinstance(texcoords, (list, tuple)) and len(texcoords) and getattr(texcoords[0], "ndim", 0) == 2:
        if len(texcoords) > _api.FACET_MAX_TEXCOORDS:
            raise ValueError(f"there are {len(texcoords)} sets of texcoords; at most {_api.FACET_MAX_TEXCOORDS} are read")
        return texcoords
    return [texcoords]


def _color(value, length):
    """A number for grey; RGB for RGBA."""
    if isinstance(value, str) or not hasattr(value, "__iter__") and not isinstance(value, numbers.Real):
        return value
    values = [value] * 3 if isinstance(value, numbers.Real) else list(value)
    return values + [1.0] if length == 4 and len(values) == 3 else values


def _check_keywords(function, keywords):
    names = [name for name in function.__func__.__code__.co_varnames[:function.__func__.__code__.co_argcount +
                                                                     function.__func__.__code__.co_kwonlyargcount]
             if name != "self"] + ["transform", "instances"]
    for name in keywords:
        if name not in names:
            raise unknown_keyword("from_arrays", name, names)


def create_scene(positions, indices, keywords):
    """The pointer of Scene.from_arrays()."""
    keywords = dict(keywords)
    if positions is None and indices is None and not keywords:
        raise TypeError("from_arrays() needs positions, or meshes=[..]")
    name, log = keywords.pop("scene_name", None), keywords.pop("log", None)
    meshes = list(keywords.pop("meshes", ()))
    nodes = keywords.pop("nodes", None)
    cameras, lights = keywords.pop("cameras", ()), keywords.pop("lights", ())
    builder = Builder()
    if positions is not None:
        meshes.insert(0, {"positions": positions, "indices": indices, **keywords})
    elif keywords or indices is not None:
        _check_keywords(builder.mesh, keywords)
        raise TypeError("from_arrays() needs positions for them: " + ", ".join(keywords or ["indices"]))
    for mesh in meshes:
        builder.add_mesh(mesh, nodes is not None)
    for node in nodes or ():
        builder.node(node)
    for camera in cameras:
        builder.add("camera", builder.cameras, _api.facet_camera_desc(), camera, nodes is not None)
    for light in lights:
        builder.add("light", builder.lights, _api.facet_light_desc(), light, nodes is not None)
    return builder.create(name, log)


# ---- trimesh ----

def _unit(value):
    """Factors of trimesh, which are bytes or floats, as floats."""
    array = numpy().asarray(value)
    return array / 255.0 if array.dtype.kind in "ui" else array.astype(float)


def _trimesh_color(value, count):
    """Bytes are what a display shows, floats are glTF's linear factors."""
    array = numpy().asarray(value)
    values = [float(x) for x in _unit(array)][:count]
    if array.dtype.kind in "ui":
        values[:3] = [C.linear_from_srgb(x) for x in values[:3]]
    return values + [1.0] * (count - len(values))


_TRIMESH_TEXTURES = {"baseColorTexture": "base_color_texture", "metallicRoughnessTexture": "metallic_roughness_texture",
                     "normalTexture": "normal_texture", "occlusionTexture": "occlusion_texture",
                     "emissiveTexture": "emissive_texture"}


def _trimesh_material(material):
    out = {}
    if hasattr(material, "baseColorFactor") or hasattr(material, "metallicFactor"):  # PBRMaterial
        for theirs, ours in _TRIMESH_TEXTURES.items():
            if getattr(material, theirs, None) is not None:
                out[ours] = getattr(material, theirs)
        if getattr(material, "baseColorFactor", None) is not None:
            out["base_color"] = _trimesh_color(material.baseColorFactor, 4)
        if getattr(material, "emissiveFactor", None) is not None:
            out["emissive"] = _trimesh_color(material.emissiveFactor, 3)
        for theirs, ours in (("metallicFactor", "metallic"), ("roughnessFactor", "perceptual_roughness"),
                             ("alphaCutoff", "alpha_cutoff"), ("doubleSided", "is_double_sided")):
            if getattr(material, theirs, None) is not None:
                out[ours] = getattr(material, theirs)
        if getattr(material, "alphaMode", None):
            out["alpha_mode"] = material.alphaMode.lower()
    else:  # SimpleMaterial: a diffuse surface
        out.update(metallic=0.0, perceptual_roughness=0.8)
        if getattr(material, "image", None) is not None:
            out["base_color_texture"] = material.image
        elif getattr(material, "diffuse", None) is not None:
            out["base_color"] = _trimesh_color(material.diffuse, 4)
    if getattr(material, "name", None):
        out["name"] = material.name
    return out


def _trimesh_mesh(mesh, materials):
    np = numpy()
    out = {"positions": mesh.vertices, "indices": mesh.faces}
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    if getattr(mesh, "vertex_normals", None) is not None:
        out["normals"] = mesh.vertex_normals
    if kind == "texture":
        if getattr(visual, "uv", None) is not None:
            uv = np.asarray(visual.uv, np.float32)
            out["texcoords"] = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)  # trimesh: v points up
        material = visual.material
        out["material"] = materials.setdefault(id(material), _trimesh_material(material))
    else:
        out["material"] = materials.setdefault(None, {"metallic": 0.0, "perceptual_roughness": 0.6})
    if kind == "vertex":
        out["colors"] = np.asarray(visual.vertex_colors)
    elif kind == "face":  # a vertex per corner
        faces = np.asarray(mesh.faces)
        out.update(positions=np.asarray(mesh.vertices)[faces].reshape(-1, 3), indices=None,
                   colors=np.repeat(np.asarray(visual.face_colors), 3, axis=0))
        out.pop("normals", None)
    return out


def from_trimesh(mesh):
    """The keywords of Scene.from_arrays() for a trimesh.Trimesh or trimesh.Scene, by their attributes."""
    materials = {}
    if hasattr(mesh, "geometry") and hasattr(mesh, "graph"):
        names, meshes = {}, []
        for name, geometry in mesh.geometry.items():
            if hasattr(geometry, "faces"):
                names[name] = len(meshes)
                meshes.append({**_trimesh_mesh(geometry, materials), "name": name})
        nodes = []
        for node in mesh.graph.nodes_geometry:
            transform, name = mesh.graph[node]
            if name in names:
                nodes.append({"name": str(node), "matrix": transform, "mesh": names[name]})
        return {"meshes": meshes, "nodes": nodes}
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return _trimesh_mesh(mesh, materials)
    raise TypeError(f"a trimesh.Trimesh or trimesh.Scene is needed, not a {type(mesh).__name__}")
