"""libfacet itself: finding it, binding its functions, and its errors as exceptions."""
import ctypes
import os
import pathlib

from . import _api


class Error(Exception):
    """An operation of facet failed; the message is the library's sentence. `result` is the facet.Result."""

    result = _api.Result.ERROR_BUG


class ArgumentError(Error, ValueError):
    """An argument is out of range or contradicts another."""


class ReadError(Error, OSError):
    """An input cannot be read: it is missing, permission is denied, I/O fails."""


class InvalidError(Error, ValueError):
    """An input was read and is not valid."""


class UnsupportedError(Error):
    """An input needs a feature that facet or this build lacks."""


class WriteError(Error, OSError):
    """An output cannot be written."""


class LimitError(Error):
    """A limit that the caller set is exceeded: file size, texture size, time."""


class OutOfMemoryError(Error, MemoryError):
    """Out of memory."""


class MachineError(Error):
    """The machine lacks something: a display, a graphics driver, a library."""


class CancelledError(Error):
    """The progress callback returned False."""


class BugError(Error):
    """An internal check failed; please report it."""


class FacetWarning(UserWarning):
    """Something is lost or approximated, and the operation goes on."""


_ERRORS = {
    _api.Result.ERROR_ARGUMENT: ArgumentError,
    _api.Result.ERROR_READ: ReadError,
    _api.Result.ERROR_INVALID: InvalidError,
    _api.Result.ERROR_UNSUPPORTED: UnsupportedError,
    _api.Result.ERROR_WRITE: WriteError,
    _api.Result.ERROR_LIMIT: LimitError,
    _api.Result.ERROR_MEMORY: OutOfMemoryError,
    _api.Result.ERROR_SYSTEM: MachineError,
    _api.Result.ERROR_CANCELLED: CancelledError,
    _api.Result.ERROR_BUG: BugError,
}
for _result, _error in _ERRORS.items():
    _error.result = _result


def _candidates():
    """FACET_LIBRARY alone where it is set; else the library beside this package (a wheel), that of the same
    prefix, that of the system."""
    named = os.environ.get("FACET_LIBRARY")
    if named:
        return [named]
    package = pathlib.Path(__file__).resolve().parent
    places = [package / _api.SONAME]
    if len(package.parents) > 3:
        places.append(package.parents[3] / _api.LIBRARY_FOLDER / _api.SONAME)
    return [str(place) for place in places if place.exists()] + [_api.SONAME]


def _load_libraries_of_wheel():
    """Loads the libraries that libfacet of a wheel needs. The dynamic linker then finds them by their names."""
    folder = pathlib.Path(__file__).resolve().parent / "libs"
    if (folder / "order").exists():
        for name in (folder / "order").read_text().split():
            _kept.append(ctypes.CDLL(str(folder / name)))


_kept = []


def _open():
    path = _candidates()[0]
    try:
        if not os.environ.get("FACET_LIBRARY"):
            _load_libraries_of_wheel()
        library = ctypes.CDLL(path)
        library.facet_version.restype = ctypes.c_char_p
    except (OSError, AttributeError) as error:
        raise ImportError(f"libfacet cannot be opened: {error}; install it (Debian: libfacet), or name the file in "
                          "FACET_LIBRARY") from error
    found = library.facet_version().decode()
    if found.split(".")[:2] != _api.VERSION.split(".")[:2]:
        wanted = ".".join(_api.VERSION.split(".")[:2])
        raise ImportError(f"{path} is libfacet {found}, but this package needs {wanted}: structs differ between minor "
                          "versions; install both of one version")
    return library


class _Functions:
    """The functions by their names without facet_."""

    def __init__(self, library):
        for name, result, arguments in _api.FUNCTIONS:
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
            setattr(self, name.removeprefix("facet_"), function)


C = _Functions(_open())


def check(function, *arguments):
    """Calls a function that ends in a facet_error, and raises its error."""
    error = _api.facet_error()
    result = function(*arguments, error)
    if result != _api.Result.OK:
        raise _ERRORS.get(result, Error)(error.message.decode("utf-8", "replace"))


def create(function, *arguments):
    """The pointer that a function writes to its last argument before the facet_error."""
    out = ctypes.c_void_p()
    check(function, *arguments, out)
    return out.value


def take_bytes(function, *arguments):
    """Bytes that the library made: a copy."""
    data, size = ctypes.POINTER(ctypes.c_ubyte)(), ctypes.c_size_t()
    check(function, *arguments, data, size)
    try:
        return ctypes.string_at(data, size.value)
    finally:
        C.bytes_destroy(data)


def take_text(function, *arguments):
    """Text that the library made: a copy."""
    pointer = create(function, *arguments)
    try:
        return ctypes.string_at(pointer).decode()
    finally:
        C.text_destroy(pointer)


def text_bytes(text, what):
    """Text or a path for the library, where a null character would end it."""
    try:
        data = os.fsencode(text)
    except TypeError:
        raise TypeError(f"{what} must be text, but is a {type(text).__name__}") from None
    if b"\0" in data:
        raise ValueError(f"{what} has a null character: {text!r}")
    return data


def path_bytes(path):
    return text_bytes(path, "the path")
