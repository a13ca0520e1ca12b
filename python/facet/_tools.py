"""Comparison of images, conversion of models, plots, the shader library."""
import ctypes
import os
import pathlib

from . import _api
from ._calls import Call
from ._fields import fill, keywords_of, mapping, read, to_enum, to_index
from ._image import Image, image_of
from ._library import C, check, path_bytes, take_bytes, text_bytes
from ._scene import Scene


# ---- comparison ----

class Comparison:
    """The difference of an image from a reference: flip, psnr, ssim, rmse, max_error, .. (docs/compare.md), and the
    difference as an Image."""

    def __init__(self, values, difference):
        self.__dict__.update(values)
        self.difference = difference

    def as_dict(self):
        """All numbers by name."""
        return {name: value for name, value in self.__dict__.items() if name != "difference"}

    def __repr__(self):
        return f"<facet.Comparison flip={self.flip:.6f} psnr={self.psnr:.2f} ssim={self.ssim:.6f}>"


@keywords_of(_api.facet_compare_desc, "allocator", "thread_count")
def compare(reference, image, *, mask=None, threads=0, **keywords):
    """Compares an image with a reference: images, arrays or paths. Returns a Comparison: .flip, .psnr, .ssim, .rmse, .."""
    images = [image_of(reference), image_of(image)] + ([image_of(mask)] if mask is not None else [])
    owners = [i._living for i in images]
    desc = fill(_api.facet_compare_desc(thread_count=to_index(threads, "threads")), keywords, "compare")
    if mask is not None:
        desc.mask = owners[2].pointer
    out, difference = _api.facet_comparison(), ctypes.c_void_p()

    def work():
        check(C.compare, owners[0].pointer, owners[1].pointer, desc, out, difference)
        return difference.value

    difference_image = Image._adopt(Call().run(work, C.image_destroy))
    return Comparison(read(out), difference_image)


# ---- conversion ----

@keywords_of(_api.facet_legacy_desc)
def convert(source, output, *, load=None, save=None, **materials):
    """Converts a model file: convert('old.obj', 'new.glb'), convert('model.glb', 'model.obj'). load, save: keywords of
    facet.load() and Scene.save(); others are of Scene.convert_materials(). Returns the conversions of materials."""
    with Scene.load(source, **(load or {})) as scene:
        if pathlib.Path(output).suffix.lower() in (".obj", ".json"):
            scene.convert_materials("ogl1", **materials)
        elif materials:
            scene.convert_materials("metallic-roughness", **materials)
        scene.save(output, **(save or {}))
        return scene.conversions


# ---- plots ----

class Plot:
    """A chart: .data are the bytes of the file, .fits what was fitted."""

    def __init__(self, data, format, fits):
        self.data, self.format, self.fits = data, format, fits

    def save(self, path):
        """Writes the file, whole or not at all. Its extension must be that of the format."""
        wanted = f".{self.format.name.lower()}"
        if pathlib.Path(os.fsdecode(path)).suffix.lower() != wanted:
            raise ValueError(f"the chart is {self.format.name}, but {os.fsdecode(path)} does not end in {wanted}; plot() has the "
                             "keyword format")
        check(C.bytes_save, self.data, len(self.data), path_bytes(path))

    def _repr_svg_(self):
        return self.data.decode() if self.format == _api.PlotFormat.SVG else None

    def _repr_png_(self):
        return self.data if self.format == _api.PlotFormat.PNG else None

    def __repr__(self):
        return f"<facet.Plot, {self.format.name.lower()}, {len(self.data)} bytes>"


def _material(value):
    material = C.plot_material_default()
    if isinstance(value, tuple) and value and isinstance(value[0], Scene):
        scene, number = value
        with scene._reading() as pointer:
            check(C.plot_material_from_scene, pointer, to_index(number, "plot: the material"), _api.PlotModel.PBR, material)
        return material
    return fill(material, mapping(value, "plot: a material"), "plot: material")


@keywords_of(_api.facet_plot_desc, "allocator", "thread_count", "materials", "material_count", "angle_count",
             "angles_rad", "fits")
def plot(kind, *, materials=(), angles_rad=(), format="svg", threads=0, **keywords):
    """A chart of reflectance: 'legacy', 'brdf', 'slice', 'hemisphere', 'lobe', 'terms', 'albedo', 'furnace', 'dfg', 'tone',
    'fresnel' or 'error'. materials: mappings of the fields of facet_plot_material, or (scene, number). format: 'svg', 'pdf',
    'png', 'csv', 'json'. Notebooks show the Plot that it returns."""
    desc = _api.facet_plot_desc(kind=to_enum(_api.PlotKind, kind, "kind"), thread_count=to_index(threads, "threads"))
    fill(desc, keywords, "plot")
    if isinstance(materials, dict):
        materials = [materials]
    rows = [_material(m) for m in materials]
    table = (_api.facet_plot_material * max(1, len(rows)))(*rows)
    angles = (ctypes.c_float * max(1, len(angles_rad)))(*angles_rad)
    fits = (_api.facet_plot_fit * _api.FACET_PLOT_MAX_MATERIALS)()
    desc.material_count, desc.materials = len(rows), table
    desc.angle_count, desc.angles_rad = len(angles_rad), angles
    if desc.has_fit:
        desc.fits = fits
    format = to_enum(_api.PlotFormat, format, "format")
    data = Call().run(lambda: take_bytes(C.plot_encode, desc, format))
    return Plot(data, format, [read(fit) for fit in fits if fit.is_found])


# ---- the shader library ----

@keywords_of(_api.facet_shader_desc, "allocator", "part_count")
def shader_text(*, parts=(), version=None, names="facet"):
    """facet's shading functions as GLSL, or parts of them (shader_parts())."""
    texts = [text_bytes(part, "a part") for part in ([parts] if isinstance(parts, str) else parts)]
    desc = fill(_api.facet_shader_desc(), {"version": version, "names": names}, "shader_text")
    desc.parts = (ctypes.c_char_p * max(1, len(texts)))(*texts)
    desc.part_count = len(texts)
    return take_bytes(C.shader_text, desc).decode()


def shader_parts():
    """The names of the parts of the shader library."""
    return [C.shader_get_part_name(i).decode() for i in range(C.shader_get_part_count())]


# ---- the library ----

def version():
    """'MAJOR.MINOR.PATCH' of the library that runs."""
    return C.version().decode()


def build_report():
    """Version, compiler, libraries, CPU: what a bug report needs."""
    size = C.build_report(None, 0)
    text = ctypes.create_string_buffer(size + 1)
    C.build_report(ctypes.cast(text, ctypes.c_void_p), size + 1)
    return text.value.decode()


def thread_count():
    """The number of CPUs that this process may use."""
    return C.thread_count()
