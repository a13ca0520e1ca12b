"""Keywords to fields of structs: words for enumerations, mappings for structs, names that are nearly right."""
import ctypes
import difflib
import functools
import inspect
import operator
import os
from enum import IntEnum, IntFlag

from . import _api


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
    return kind(operator.index(value))


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


def _set(struct, name, kind, value, what, keep):
    if name in struct.ENUMS:
        value = to_enum(struct.ENUMS[name], value, what)
    elif name in FLAGS:
        value = to_flags(FLAGS[name], value, what)
    elif kind in _INTEGERS:
        value = operator.index(value)
        if not 0 <= value < 1 << _INTEGERS[kind]:
            raise ValueError(f"{what} is {value}, but must be at least 0 and below 2^{_INTEGERS[kind]}")
    elif isinstance(kind, type) and issubclass(kind, ctypes.Structure):
        if isinstance(value, kind):
            setattr(struct, name, value)
        elif hasattr(value, "keys"):
            fill(getattr(struct, name), value, what, keep)
        else:
            raise TypeError(f"{what} must be a mapping, but is a {type(value).__name__}")
        return
    elif isinstance(kind, type) and issubclass(kind, ctypes.Array):
        value = [float(x) if kind._type_ is ctypes.c_float else x for x in value]
        if len(value) != kind._length_:
            raise ValueError(f"{what} must have {kind._length_} numbers, but has {len(value)}")
        value = kind(*value)
    elif kind is ctypes.c_char_p:
        value = None if value is None else os.fsencode(value)
    elif kind is ctypes.c_void_p and hasattr(value, "_pointer"):
        keep.append(value)
        value = value._pointer
    elif kind is ctypes.c_bool:
        value = bool(value)
    try:
        setattr(struct, name, value)
    except TypeError as error:
        raise TypeError(f"{what}: {error}") from None


def fill(struct, keywords, where, keep):
    """Sets fields of a struct by their names. keep receives what must live as long as the struct."""
    kinds = dict(struct._fields_)
    for name, value in keywords.items():
        if name not in kinds:
            raise unknown_keyword(where, name, list(kinds))
        _set(struct, name, kinds[name], value, f"{where}: {name}", keep)
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


__all__ = ["IntEnum", "IntFlag", "fill", "keywords_of", "read", "to_enum", "to_flags", "unknown_keyword", "word"]
