"""Images: pixels and layers as numpy arrays that share the library's memory."""
import ctypes
import os
import struct
from collections.abc import Mapping

from . import _api
from ._calls import Call, Handle
from ._fields import fill, keywords_of, read, to_enum
from ._library import C, check, create, path_bytes, take_bytes, text_bytes


def numpy():
    try:
        import numpy as module
    except ImportError as error:
        raise ImportError("arrays of facet need numpy (Debian: python3-numpy)") from error
    return module


class _Memory:
    """Memory of the library, in the protocol of numpy: an array made from it keeps `owner` alive."""

    def __init__(self, owner, address, shape, strides, typestr):
        self._owner = owner
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": typestr, "strides": strides,
                                    "data": (address, True)}  # read-only


def array_of_view(owner, view):
    """A facet_image_view as an array of (height, width, channels) without a copy."""
    address = ctypes.cast(view.pixels, ctypes.c_void_p).value
    shape = (view.height, view.width, view.channel_count)
    if address is None:
        raise ValueError("a compact image has no pixels; load it without is_compact")
    return numpy().asarray(_Memory(owner, address, shape, (view.row_stride_bytes, 4 * view.channel_count, 4), "<f4"))


class Layers(Mapping):
    """The layers of an image by name: 'depth', 'normal', .. as read-only arrays (height, width, channels)."""

    def __init__(self, image):
        self._image = image
        with image._reading() as pointer:
            self._names = {C.image_get_layer(pointer, i).name.decode(): i
                           for i in range(1, C.image_get_layer_count(pointer))}

    def __getitem__(self, name):
        return self._image._layer(self._names[name])

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)

    def __repr__(self):
        return f"<layers {', '.join(self._names) or 'none'}>"


class Image(Handle):
    """An image. numpy sees it as an array: np.asarray(image), plt.imshow(image.to_uint8()), image[:, :, 3].

    pixels    float32 (height, width, 4), linear Rec.709, premultiplied, read-only; shares the library's memory
    layers    the AOVs of a render by name, in the same form
    to_uint8  uint8 (height, width, 4), sRGB, straight alpha: what a .png file has
    """

    _destroy = C.image_destroy
    _makers = "Scene.render(), Image.load() or Image.from_array()"

    @classmethod
    def from_array(cls, pixels):
        """An image from a copy of an array (height, width, 1, 3 or 4) or (height, width): float: linear, premultiplied;
        uint8: sRGB, straight alpha."""
        np = numpy()
        array = np.asarray(pixels)
        if array.ndim == 0:
            raise TypeError(f"an image is an array of (height, width, 1, 3 or 4), not a {type(pixels).__name__}")
        if array.ndim == 2:
            array = array[:, :, None]
        if array.ndim != 3 or array.shape[2] not in (1, 3, 4):
            raise ValueError(f"an image is an array of (height, width, 1, 3 or 4), not of {array.shape}")
        if array.dtype == np.uint8:
            array = _linear(array)
        elif array.dtype.kind != "f":
            raise TypeError(f"an image is an array of float or uint8, not of {array.dtype}")
        array = np.ascontiguousarray(array, np.float32)
        view = _api.facet_image_view(width=array.shape[1], height=array.shape[0], channel_count=array.shape[2])
        view.pixels = array.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
        return cls._adopt(create(C.image_create, view, None))

    @classmethod
    def load(cls, source, **keywords):
        """An image from a path, bytes or a binary file object: PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF, DDS, HDR, EXR,
        PFM."""
        desc = fill(_api.facet_image_load_desc(), keywords, "Image.load")
        return load_from(cls, source, desc, C.image_load, C.image_load_memory)

    def _layer(self, index):
        owner = self._living
        with self._reading() as pointer:
            return array_of_view(owner, C.image_get_layer(pointer, index))

    @property
    def pixels(self):
        """float32 (height, width, 4), linear, premultiplied: a read-only view without a copy, valid as long as it is used."""
        return self._layer(0)

    @property
    def layers(self):
        """The further layers by name: a mapping of read-only arrays."""
        return Layers(self)

    @property
    def _view(self):
        with self._reading() as pointer:
            return C.image_get_layer(pointer, 0)

    @property
    def shape(self):
        view = self._view
        return view.height, view.width, view.channel_count

    @property
    def size(self):
        """(width, height)"""
        view = self._view
        return view.width, view.height

    @property
    def is_for_display(self):
        """Whether it was read from a display-referred file, as PNG."""
        with self._reading() as pointer:
            return C.image_is_for_display(pointer)

    @property
    def stats(self):
        """Work and seconds of the render that made the image, as a dict."""
        with self._reading() as pointer:
            return read(C.image_get_render_stats(pointer))

    def __array__(self, dtype=None, copy=None):
        np = numpy()
        if dtype is not None and np.dtype(dtype) == np.uint8:
            return self.to_uint8()
        array = self.pixels
        return array.astype(dtype) if dtype is not None and array.dtype != dtype else array.copy() if copy else array

    def __getitem__(self, index):
        return self.pixels[index]

    def __repr__(self):
        if self._owner is None:
            return "<facet.Image, closed>"
        height, width, channels = self.shape
        return f"<facet.Image {width} x {height}, {channels} channels{', ' + ', '.join(self.layers) if self.layers else ''}>"

    def to_uint8(self):
        """uint8 (height, width, 4), sRGB, straight alpha, as plt.imshow() and PIL.Image.fromarray() want it."""
        data, size = ctypes.POINTER(ctypes.c_ubyte)(), ctypes.c_size_t()
        desc = _api.facet_image_save_desc(format=_api.ImageFormat.RAW)
        height, width, _ = self.shape
        with self._reading() as pointer:
            check(C.image_encode, pointer, desc, data, size)
        address = ctypes.cast(data, ctypes.c_void_p).value
        owner = _Bytes._adopt(address)
        memory = _Memory(owner._living, address, (height, width, 4), (4 * width, 4, 1), "|u1")
        return numpy().asarray(memory)

    @keywords_of(_api.facet_image_save_desc, "allocator")
    def save(self, path, **keywords):
        """Writes an image file, whole or not at all; the extension decides: .png .jpg .webp .exr .hdr .pfm. An .exr has all
        layers."""
        desc = fill(_api.facet_image_save_desc(), keywords, "Image.save")
        with self._reading() as pointer:
            check(C.image_save, pointer, path_bytes(path), desc)

    @keywords_of(_api.facet_image_save_desc, "allocator", "format")
    def encode(self, format="png", **keywords):
        """The bytes of an image file."""
        desc = fill(_api.facet_image_save_desc(), {"format": format, **keywords}, "Image.encode")
        with self._reading() as pointer:
            return take_bytes(C.image_encode, pointer, desc)

    def id_colors(self, layer):
        """A layer of IDs, 'object' or 'material', in false color; the image also needs the layer 'instance'."""
        with self._reading() as pointer:
            return Image._adopt(create(C.image_create_id_colors, pointer, text_bytes(layer, "layer"), None))

    def _repr_png_(self):
        return self.encode("png")


class _Bytes(Handle):
    @staticmethod
    def _destroy(address):
        C.bytes_destroy(ctypes.cast(address, ctypes.POINTER(ctypes.c_ubyte)))


def _linear(array):
    """Straight sRGB of 8 bits to premultiplied linear floats."""
    np = numpy()
    table = np.array([C.linear_from_srgb(i / 255) for i in range(256)], np.float32)
    out = table[array]
    if array.shape[2] == 4:
        alpha = array[:, :, 3:] / np.float32(255)
        out = np.concatenate([out[:, :, :3] * alpha, alpha], axis=2)
    return out


def contents(source):
    """(bytes, name) of bytes or a binary file object; None: source is a path."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        return bytes(source), "(memory)"
    if hasattr(source, "read"):
        data = source.read()
        if not isinstance(data, (bytes, bytearray)):
            raise TypeError("the file object must be opened in binary mode: open(path, 'rb')")
        name = getattr(source, "name", None)
        return bytes(data), name if isinstance(name, str) else "(memory)"
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"a path, bytes or a binary file object is needed, not a {type(source).__name__}")
    return None


def load_from(cls, source, desc, from_path, from_memory, call=None):
    """An object from a path, bytes or a file object, by a pair of functions of the library."""
    call = call or Call(desc)
    memory = contents(source)

    def work():
        if memory is None:
            return create(from_path, path_bytes(source), desc)
        data, name = memory
        return create(from_memory, data, len(data), name.encode("utf-8", "surrogateescape"), desc)

    return cls._adopt(call.run(work, cls._destroy))


def image_of(value):
    """An Image of whatever a user may give: an Image, an array, or what Image.load() reads."""
    if isinstance(value, Image):
        return value
    if hasattr(value, "__array_interface__") or isinstance(value, (list, tuple)):
        return Image.from_array(value)
    return Image.load(value)


@keywords_of(_api.facet_contact_sheet_desc, "allocator", "log", "labels")
def contact_sheet(images, *, labels=None, **keywords):
    """Images of one size in rows, with a label below each (needs cairo): images, arrays or paths."""
    desc = fill(_api.facet_contact_sheet_desc(), keywords, "contact_sheet")
    if isinstance(images, (Image, str, bytes)) or getattr(images, "ndim", 4) < 4:
        raise TypeError("contact_sheet() needs a list of images, not one image")
    images = [image_of(image) for image in images]
    if labels is not None:
        texts = [text_bytes(label, "a label") for label in labels]
        if len(texts) != len(images):
            raise ValueError(f"there are {len(images)} images, but {len(texts)} labels")
        desc.labels = (ctypes.c_char_p * len(texts))(*texts)
    call = Call(desc)
    owners = [image._living for image in images]
    pointers = (ctypes.c_void_p * len(images))(*(owner.pointer for owner in owners))
    return Image._adopt(call.run(lambda: create(C.image_create_sheet, pointers, len(images), desc), Image._destroy))


def srgb_color(text):
    """'#rrggbb', '#rgb', 'white' or 'black' as linear numbers; None: no color."""
    text = {"white": "#fff", "black": "#000"}.get(text.lower(), text)
    digits = text[1:]
    if not text.startswith("#") or len(digits) not in (3, 6) or digits.strip("0123456789abcdefABCDEF"):
        return None
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    return tuple(C.linear_from_srgb(byte / 255) for byte in struct.unpack("3B", bytes.fromhex(digits)))


__all__ = ["Image", "Layers", "contact_sheet", "to_enum"]
