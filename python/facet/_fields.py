"""Keywords to fields of structs: words for enumerations, mappings for structs, names that are nearly right."""
import ctypes
import difflib
import functools
import inspect
import operator
import reprlib
from enum import IntEnum, IntFlag

from . import _api
from ._library import text_bytes


def unknown_keyword(where, name, names):
    near = difflib.get_close_matches(name, names, 1, 0.5)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    return TypeError(f"{where}() got an unexpected keyword '{name}'{hint}")


def word(member):
    """Tonemap.ACES_NARKOWICZ: 'aces-narkowicz'"""
    return member.name.lower().replace("_", "-")


def to_enum(kind, value, what):
    """A member of an enumeration from itself, its word or its number."""
    if isinstance(value, str):
        name = value.upper().replace("-", "_").replace(" ", "_").replace(".", "_")
        if name in kind.__members__:
            return kind[name]
        words = ", ".join(word(member) for member in kind)
        near = difflib.get_close_matches(value.lower(), [word(member) for member in kind], 1)
        hint = f" (did you mean '{near[0]}'?)" if near else ""
        raise ValueError(f"{what} is '{value}', but must be one of {words}{hint}")
    if isinstance(value, IntEnum) and not isinstance(value, kind):
        raise ValueError(f"{what} must be a facet.{kind.__name__}, but is a facet.{type(value).__name__}")
    if not hasattr(value, "__index__"):
        raise TypeError(f"{what} must be a word or a facet.{kind.__name__}, but is a {type(value).__name__}")
    return kind(operator.index(value))


def to_index(value, what, least=0, bits=32):
    """An integer for an unsigned field, where ctypes would wrap what does not fit."""
    try:
        value = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} must be an integer, but is a {type(value).__name__}") from None
    if not least <= value < 1 << bits:
        raise ValueError(f"{what} is {value}, but must be at least {least} and below 2^{bits}")
    return value


def mapping(value, what):
    """A copy of a mapping as a dict."""
    if not hasattr(value, "keys"):
        raise TypeError(f"{what} must be a mapping, but is a {type(value).__name__}")
    return dict(value)


def _numbers(value, kind, what):
    """A field of several numbers."""
    convert = float if kind._type_ in (ctypes.c_float, ctypes.c_double) else lambda x: to_index(x, what)
    try:
        numbers = list(value)
        if len(numbers) != kind._length_:
            raise ValueError(f"{what} must have {kind._length_} numbers, but has {len(numbers)}")
        return kind(*map(convert, numbers))
    except TypeError:
        raise TypeError(f"{what} must be {kind._length_} numbers, but is {reprlib.repr(value)}") from None


def to_flags(kind, value, what):
    """Bits from themselves, a word, or several words: 'depth', ['depth', 'normal']"""
    if isinstance(value, str):
        value = [value]
    if isinstance(value, int):
        return kind(value)
    bits = kind(0)
    for item in value:
        if isinstance(item, str):
            name = item.upper().replace("-", "_")
            name = name if name in kind.__members__ else name + "_ID"
            if name not in kind.__members__:
                words = ", ".join(word(member) for member in kind.__members__.values())
                raise ValueError(f"{what} has '{item}', but knows only {words}")
            item = kind[name]
        bits |= kind(item)
    return bits


FLAGS = {"aovs": _api.Aov, "skipped_metrics": _api.Metric}
_INTEGERS = {ctypes.c_uint8: 8, ctypes.c_uint16: 16, ctypes.c_uint32: 32, ctypes.c_uint64: 64, ctypes.c_size_t: 64}


def _set(struct, name, kind, value, what):
    if name in struct.ENUMS:
        value = to_enum(struct.ENUMS[name], value, what)
    elif name in FLAGS:
        value = to_flags(FLAGS[name], value, what)
    elif kind in _INTEGERS:
        value = to_index(value, what, bits=_INTEGERS[kind])
    elif isinstance(kind, type) and issubclass(kind, ctypes.Structure):
        if isinstance(value, kind):
            setattr(struct, name, value)
        else:
            fill(getattr(struct, name), mapping(value, what), what)
        return
    elif isinstance(kind, type) and issubclass(kind, ctypes.Array):
        value = _numbers(value, kind, what)
    elif kind is ctypes.c_char_p:
        value = None if value is None else text_bytes(value, what)
    elif kind is ctypes.c_bool:
        value = bool(value)
    try:
        setattr(struct, name, value)
    except TypeError as error:
        raise TypeError(f"{what}: {error}") from None


def fill(struct, keywords, where):
    """Sets fields of a struct by their names."""
    kinds = dict(struct._fields_)
    for name, value in keywords.items():
        if name not in kinds:
            raise unknown_keyword(where, name, list(kinds))
        _set(struct, name, kinds[name], value, f"{where}: {name}")
    return struct


def read(struct):
    """The fields of a result as a dict: enumerations as members, arrays as tuples, text as str."""
    out = {}
    for name, kind in struct._fields_:
        value = getattr(struct, name)
        if name in struct.ENUMS:
            value = struct.ENUMS[name](value)
        elif isinstance(value, ctypes.Structure):
            value = read(value)
        elif isinstance(value, ctypes.Array):
            value = tuple(tuple(v) if isinstance(v, ctypes.Array) else v for v in value)
        elif isinstance(value, bytes):
            value = value.decode("utf-8", "replace")
        out[name] = value
    return out


def keywords_of(struct, *without):
    """Decorates a function with **keywords that become fields of a struct: help() and editors then show them with the
    comments of the C header."""

    def decorate(function):
        own = [p for p in inspect.signature(function).parameters.values() if p.kind is not p.VAR_KEYWORD]
        taken = {p.name for p in own} | set(without)
        fields = [name for name, _ in struct._fields_ if name not in taken]
        parameters = own + [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=...) for name in fields]
        function.__signature__ = inspect.Signature(parameters)
        lines = [f"    {name}: {struct.COMMENTS[name]}" if name in struct.COMMENTS else f"    {name}"
                 for name in fields]
        text = inspect.cleandoc(function.__doc__ or "")
        function.__doc__ = f"{text}\n\nFurther keywords, as the fields of {struct.__name__}:\n" + "\n".join(lines)
        names = [p.name for p in parameters]

        @functools.wraps(function)
        def checked(*arguments, **keywords):
            for name in keywords:
                if name not in names:
                    raise unknown_keyword(function.__name__, name, names)
            return function(*arguments, **keywords)

        return checked

    return decorate


__all__ = ["IntEnum", "IntFlag", "fill", "keywords_of", "mapping", "read", "to_enum", "to_flags", "to_index",
           "unknown_keyword", "word"]
