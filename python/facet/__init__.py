"""facet: physically based rendering of glTF, OBJ, STL and PLY models, on the CPU and with OpenGL.

    import facet

    scene = facet.load("helmet.glb")                         # a path, bytes or a file object
    image = scene.render(size=(512, 512), environment="studio", aovs=["depth", "normal"])
    image.save("helmet.png")
    image.pixels                                             # float32 (512, 512, 4), linear, premultiplied
    image.to_uint8()                                         # uint8 (512, 512, 4), sRGB
    image.layers["depth"]                                    # float32 (512, 512, 1), m

    facet.Scene.from_arrays(vertices, faces).render(renderer="path", samples=64, path={"denoises": True})

Keywords are the fields of the structs of libfacet, with enumerations as words ("path") or members
(facet.RendererKind.PATH), structs as mappings, angles in rad, lengths in m, colors linear. help(facet.Scene.render) lists
them. Errors are facet.Error and its subclasses, which also are ValueError, OSError or MemoryError. Calls release the GIL, and
Ctrl-C ends them. docs/python.md is the guide.
"""
from . import _api
from ._api import *  # enumerations; names without facet_ of structs stay in _api
from ._bake import Cube, bake, bake_dfg
from ._camera import Camera, Orbit
from ._environment import Environment
from ._image import Image, contact_sheet
from ._library import (ArgumentError, BugError, CancelledError, Error, FacetWarning, InvalidError, LimitError, MachineError,
                       OutOfMemoryError, ReadError, UnsupportedError, WriteError)
from ._render import Renderer, exposure_from_ev100, renderers
from ._scene import Scene, load
from ._sea import Sea
from ._tools import (Comparison, Plot, build_report, compare, convert, plot, shader_parts, shader_text, thread_count,
                     version)

__version__ = _api.VERSION

for _value in list(globals().values()):  # names in messages and documentation are those that users import
    if isinstance(_value, type) and _value.__module__.startswith("facet."):
        _value.__module__ = "facet"
