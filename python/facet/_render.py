"""Rendering: keywords to facet_render_desc, and the renderer that keeps what images of one scene share."""
import ctypes
import math
import numbers

from . import _api
from . import _camera, _environment
from ._calls import Call, Handle
from ._fields import fill, keywords_of, to_enum, to_index
from ._image import Image, numpy, srgb_color
from ._library import C, check, create, text_bytes

# Keywords with a meaning beyond the field of that name, or in place of several fields.
_REPLACED = ("allocator", "width", "height", "pose", "thread_count", "meters_exposure", "exposure_ev", "background_color",
             "part")


def make_pose(scene, keep, index=None, variant=None, animations=(), time_s=0.0):
    """facet_pose_desc of names or numbers."""
    pose = _api.facet_pose_desc(time_s=time_s)

    def find(function, name, what):
        number = ctypes.c_uint32()
        with scene._reading() as pointer:
            check(function, pointer, text_bytes(name, what), number)
        return number.value

    def number_of(value, function, what):
        return find(function, value, what) if isinstance(value, str) else to_index(value, what)

    if index is not None:
        pose.has_scene_index, pose.scene_index = True, number_of(index, C.scene_find_scene, "scene_index")
    if variant is not None:
        pose.has_variant, pose.variant = True, number_of(variant, C.scene_find_variant, "variant")
    if isinstance(animations, (str, numbers.Integral)):
        animations = [animations]
    found = [number_of(a, C.scene_find_animation, "animations") for a in animations or ()]
    if found:
        table = (ctypes.c_uint32 * len(found))(*found)
        keep.append(table)
        pose.animation_count = len(found)
        pose.animations = table
    return pose


def _size(size):
    if size is None:
        return 0, 0
    sides = [size, size] if isinstance(size, numbers.Number) else list(size)
    if len(sides) != 2:
        raise ValueError(f"size must be (width, height) or one number, but has {len(sides)}")
    return tuple(to_index(side, "size", least=1) for side in sides)


def _set_background(desc, background):
    color = srgb_color(background) if isinstance(background, str) else None
    if color is None and not isinstance(background, (str, int)):
        color = background
    if color is None:
        words = {"env": "environment"}
        if isinstance(background, str) and background not in (*words, "environment", "transparent"):
            raise ValueError(f"background is '{background}', but must be 'transparent', 'environment', 'white', 'black', '#rrggbb' "
                             "or linear (r, g, b)")
        desc.background = to_enum(_api.Background, words.get(background, background), "background")
    else:
        fill(desc, {"background": "color", "background_color": color}, "background")


class Request:
    """The desc of one render, with everything that it points to."""

    def __init__(self, scene, where, *, size=None, environment="auto", camera=None, background="transparent",
                 exposure_ev=0.0, scene_index=None, variant=None, animations=(), time_s=0.0, threads=0, progress=None,
                 log=None, sea=None, **fields):
        self.desc = desc = _api.facet_render_desc()
        self.keep = []
        desc.width, desc.height = _size(size)
        desc.thread_count = to_index(threads, "threads")
        desc.energy = _api.Energy.CONSERVING
        is_ogl1 = fields.get("shading") in ("ogl1", _api.Shading.OGL1)
        desc.tonemap = _api.Tonemap.NONE if is_ogl1 else _api.Tonemap.AGX if sea is not None else _api.Tonemap.NEUTRAL
        _set_background(desc, background)
        desc.meters_exposure = exposure_ev == "auto"
        if not desc.meters_exposure:
            fill(desc, {"exposure_ev": exposure_ev}, where)
        fill(desc, fields, where)
        self.pose = make_pose(scene, self.keep, scene_index, variant, animations, time_s)
        desc.pose = self.pose
        width, height = desc.width or 1024, desc.height or 768
        if camera is not None:
            self.camera = _camera.resolve(camera, scene, self.pose, width / height)
            desc.camera = ctypes.pointer(self.camera)
        if sea is not None and getattr(sea, "_destroy", None) is not C.sea_destroy:  # its pointer would be taken for a sea
            raise TypeError(f"sea must be a Sea, but is a {type(sea).__name__}")
        self.sea = sea
        self.environment = None
        if sea is None and not is_ogl1:
            self.environment = _environment.resolve(environment, scene, self.pose, desc.ignores_scene_lights)
        elif environment not in ("auto", None):
            self.environment = _environment.resolve(environment, scene, self.pose, True)
        if self.environment is not None:
            desc.environment = self.environment._pointer
        if sea is not None:
            desc.sea = sea._pointer
        self.call = Call(desc, progress, log)

    def run(self, renderer, scene):
        """The image; a thread of its own does the work."""

        def work():
            with _reading(self.environment), _reading(self.sea), _reading(scene), renderer._changing() as pointer:
                return create(C.renderer_render, pointer, self.desc)

        return Image._adopt(self.call.run(work, C.image_destroy))

    def meter(self, renderer, scene):
        ev100 = ctypes.c_double()

        def work():
            with _reading(self.environment), _reading(self.sea), _reading(scene), renderer._changing() as pointer:
                check(C.renderer_meter, pointer, self.desc, ev100)
            return ev100.value

        return self.call.run(work)


class _Nothing:
    def __enter__(self):
        return None

    def __exit__(self, *_):
        pass


def _reading(handle):
    return _Nothing() if handle is None else handle._reading()


def finish(image, dtype):
    """The image itself, or what numpy sees of it."""
    if dtype is None:
        return image
    kind = numpy().dtype(dtype)
    if kind == "uint8":
        return image.to_uint8()
    if kind == "float32":
        return image.pixels
    raise ValueError(f"dtype must be 'uint8' or 'float32', not {kind}")


class Renderer(Handle):
    """Renders several images of one scene, and keeps what they share: textures, tangents, BVHs, OpenGL programs. Each
    image equals that of Scene.render().

    with facet.Renderer(scene) as renderer:
        images = [renderer.render(camera=facet.Orbit(azimuth_rad=a)) for a in angles]
    """

    _destroy = C.renderer_destroy

    def __init__(self, scene):
        self._scene = None
        if scene is None:
            self._own(create(C.renderer_create, None, None))
        elif getattr(scene, "_destroy", None) is not C.scene_destroy:
            raise TypeError(f"a Scene is needed, not a {type(scene).__name__}")
        else:
            self._scene = scene._alias()
            with scene._reading() as pointer:
                self._own(create(C.renderer_create, pointer, None), scene)

    @keywords_of(_api.facet_render_desc, *_REPLACED)
    def render(self, *, size=None, environment="auto", camera=None, aovs=(), background="transparent", exposure_ev=0.0,
               scene_index=None, variant=None, animations=(), time_s=0.0, threads=0, progress=None, log=None, sea=None,
               dtype=None, **keywords):
        """An image of the scene: Image, or an array where dtype is 'uint8' or 'float32'.

        size          (width, height) in pixels, or one number for a square; 1024 x 768
        environment   'auto' (the model's own, else the studio), 'studio', 'none', an Environment, a path, bytes, or an array
        camera        a Camera, an Orbit, a camera-to-world matrix of 4 x 4, or a camera of the file by name or number
        aovs          further layers: 'depth', ['normal', 'albedo'], ..: image.layers
        background    'transparent', 'environment', '#rrggbb', 'white', 'black', or linear (r, g, b)
        exposure_ev   stops, or 'auto'
        scene_index, variant, animations   of the file, by name or number; time_s of the animations
        threads       0: all
        progress      progress(stage, fraction), from another thread; returning False cancels
        log           log(level, text); without it warnings become FacetWarning
        """
        request = Request(self._scene, "render", size=size, environment=environment, camera=camera, aovs=aovs,
                          background=background, exposure_ev=exposure_ev, scene_index=scene_index, variant=variant,
                          animations=animations, time_s=time_s, threads=threads, progress=progress, log=log, sea=sea,
                          **keywords)
        return finish(request.run(self, self._scene), dtype)

    def meter(self, **keywords):
        """EV at ISO 100 that render() with the same keywords would be exposed for; exposure_from_ev100() makes an exposure_ev of
        it. Meter sequences once."""
        return Request(self._scene, "meter", **keywords).meter(self, self._scene)


def exposure_from_ev100(ev100):
    """The exposure_ev of a camera that is set to ev100."""
    return C.exposure_from_ev100(ev100)


def renderers():
    """What each renderer can do: {'preview': {'aovs': .., 'samples': (draft, normal, final), ..}, ..}"""
    found = {}
    for kind in _api.RendererKind:
        info = C.renderer_get_info(kind)
        if info.name:
            found[info.name.decode()] = {"features": _api.RendererFeature(info.features), "aovs": _api.Aov(info.aovs),
                                         "samples": tuple(info.samples[i] for i in (1, 0, 2)),
                                         "max_samples": info.max_samples}
    return found


__all__ = ["Renderer", "exposure_from_ev100", "math", "renderers"]
