#!/usr/bin/env python3
"""Writes the Python declarations of libfacet from its headers, so that the two cannot differ.

    generate.py --include include --version 0.2.0 --soname libfacet.so.0.2 --stub facet.pyi.in --output DIR

DIR receives
    _api.py          enumerations, structs, functions and the comments of fields, for ctypes
    __init__.pyi     types for editors and mypy: facet.pyi.in with the keywords of each function
    layout_check.c   a program that prints size and offset of every field as the C compiler has them

Needs pycparser, at build time only. The headers are plain C11 without anonymous members and bit fields.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

from pycparser import c_ast, c_parser

FAKE_HEADERS = {
    "stdbool.h": "typedef _Bool bool;\n",
    "stddef.h": "typedef unsigned long size_t;\n",
    "stdint.h": "".join(f"typedef {c} {name};\n" for c, name in [
        ("unsigned char", "uint8_t"), ("unsigned short", "uint16_t"), ("unsigned int", "uint32_t"),
        ("unsigned long", "uint64_t"), ("int", "int32_t"), ("long", "int64_t")]),
}

CTYPES = {
    "bool": "c_bool", "_Bool": "c_bool", "char": "c_char", "unsigned char": "c_ubyte", "int": "c_int",
    "float": "c_float", "double": "c_double", "size_t": "c_size_t", "uint8_t": "c_uint8", "uint16_t": "c_uint16",
    "uint32_t": "c_uint32", "uint64_t": "c_uint64", "int32_t": "c_int32", "int64_t": "c_int64",
}


def fail(message):
    sys.exit(f"generate.py: {message}")


def camel(name):
    """facet_image_format: ImageFormat"""
    return "".join(part.capitalize() for part in name.removeprefix("facet_").split("_"))


# ---- the headers as a syntax tree ----

class Headers:
    """Enumerations, structs and functions in the order of their declaration."""

    def __init__(self, include, compiler):
        with tempfile.TemporaryDirectory() as fake:
            for name, text in FAKE_HEADERS.items():
                (pathlib.Path(fake) / name).write_text(text)
            source = subprocess.run(
                [*compiler.split(), "-E", "-P", "-nostdinc", "-I", fake, "-D__attribute__(x)=", "-x", "c",
                 str(include / "facet" / "facet.h")],
                check=True, capture_output=True, text=True).stdout
        self.enums, self.structs, self.opaque, self.functions, self.constants = {}, {}, [], [], {}
        for node in c_parser.CParser().parse(source).ext:
            if isinstance(node, c_ast.Typedef):
                self.add_type(node)
            elif isinstance(node, c_ast.Decl) and isinstance(node.type, c_ast.FuncDecl):
                self.functions.append(node)
            elif isinstance(node, c_ast.Decl) and isinstance(node.type, c_ast.Enum):
                self.constants.update(self.values_of(node.type)[0])

    def add_type(self, node):
        inner = node.type.type if isinstance(node.type, c_ast.TypeDecl) else None
        if isinstance(inner, c_ast.Enum):
            self.enums[node.name] = self.values_of(inner)
        elif isinstance(inner, c_ast.Struct) and inner.decls is None:
            self.opaque.append(node.name)
        elif isinstance(inner, c_ast.Struct):
            self.structs[node.name] = inner.decls

    def values_of(self, enum):
        """({name: value}, whether the values are bits to be combined)"""
        values, following, are_bits = {}, 0, False
        for item in enum.values.enumerators:
            if item.value is not None:
                following = self.evaluate(item.value, values)
                are_bits |= isinstance(item.value, c_ast.BinaryOp)
            values[item.name] = following
            following += 1
        return values, are_bits

    def evaluate(self, node, known=()):
        if isinstance(node, c_ast.Constant):
            return int(node.value.rstrip("uUlL"), 0)
        if isinstance(node, c_ast.ID):
            for values in (known, self.constants, *(v for v, _ in self.enums.values())):
                if node.name in values:
                    return values[node.name]
        if isinstance(node, c_ast.BinaryOp):
            left, right = self.evaluate(node.left, known), self.evaluate(node.right, known)
            return {"<<": left << right, "|": left | right, "+": left + right, "*": left * right}[node.op]
        return fail(f"an expression in an enumeration or array size is not understood: {node}")

    # ---- C types as expressions of ctypes ----

    def ctype(self, node):
        if isinstance(node, c_ast.TypeDecl):
            return self.named(node.type)
        if isinstance(node, c_ast.ArrayDecl):
            return f"{self.ctype(node.type)} * {self.evaluate(node.dim)}" if node.dim else self.pointer(node.type)
        if isinstance(node, c_ast.PtrDecl):
            return self.pointer(node.type)
        return fail(f"a type is not understood: {node}")

    def named(self, node):
        name = " ".join(node.names)
        if name in self.enums:
            return "c_int"
        if name in self.structs:
            return name
        return CTYPES.get(name) or fail(f"the type {name} is unknown")

    def pointer(self, target):
        if isinstance(target, c_ast.FuncDecl):
            return self.callback(target)
        if isinstance(target, c_ast.TypeDecl):
            name = " ".join(target.type.names)
            if name == "char":
                return "c_char_p" if "const" in target.quals else "c_void_p"
            if name == "void" or name in self.opaque:
                return "c_void_p"
        if isinstance(target, c_ast.ArrayDecl):
            return f"POINTER({self.ctype(target)})"
        return f"POINTER({self.ctype(target)})"

    def callback(self, function):
        return f"CFUNCTYPE({', '.join([self.result(function.type)] + self.arguments(function))})"

    def result(self, node):
        if isinstance(node, c_ast.TypeDecl) and " ".join(node.type.names) == "void":
            return "None"
        return self.ctype(node)

    def arguments(self, function):
        """Arrays as parameters are pointers."""
        types = []
        for parameter in function.args.params if function.args else []:
            if isinstance(parameter.type, c_ast.TypeDecl) and parameter.type.type.names == ["void"]:
                continue
            array = isinstance(parameter.type, c_ast.ArrayDecl)
            types.append(self.pointer(parameter.type.type) if array else self.ctype(parameter.type))
        return types

    def enum_of(self, node):
        """The enumeration of a field, or None."""
        if isinstance(node, c_ast.TypeDecl) and isinstance(node.type, c_ast.IdentifierType):
            name = " ".join(node.type.names)
            return name if name in self.enums else None
        return None


# ---- the comments of fields ----

def field_comments(include):
    """{struct: {field: comment}}: a comment stands above its field or behind it."""
    comments = {}
    for path in sorted((include / "facet").glob("*.h")):
        text = path.read_text()
        for match in re.finditer(r"^typedef struct (\w+) \{\n(.*?)^\} \1;", text, re.S | re.M):
            comments[match[1]] = struct_comments(match[2])
    return comments


def struct_comments(body):
    found, above = {}, ""
    for item in re.finditer(r"/\*(.*?)\*/|([^;/]+);[ \t]*(?:/\*(.*?)\*/)?", body, re.S):
        if item[1] is not None:
            above = clean(item[1])
            continue
        names = re.findall(r"\(\*(\w+)\)", item[2]) or [
            re.search(r"(\w+)\s*(?:\[[^]]*\]\s*)*$", part.strip())[1] for part in item[2].split(",")]
        for name in names:
            found[name] = clean(item[3]) if item[3] else above
        above = ""
    return {name: text for name, text in found.items() if text}


def clean(comment):
    return re.sub(r"\s*\n\s*\*?\s*", " ", comment).strip()


# ---- _api.py ----

def write_api(headers, comments, version, soname, libdir):
    out = ['"""Declarations of libfacet, written by generate.py from its headers: see facet.h."""',
           "from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_float, c_int,",
           "                    c_size_t, c_ubyte, c_uint8, c_uint16, c_uint32, c_uint64, c_void_p)",
           "from enum import IntEnum, IntFlag", "", f'VERSION = "{version}"', f'SONAME = "{soname}"',
           f'LIBRARY_FOLDER = "{libdir}"  # from the prefix of the installation', ""]
    out += ["__all__ = [", *(f'    "{camel(name)}",' for name in headers.enums), "]", ""]
    for name, value in headers.constants.items():
        out.append(f"{name} = {value}")
    out += ["", "", "# ---- enumerations ----", ""]
    for name, (values, are_bits) in headers.enums.items():
        out += ["", f"class {camel(name)}({'IntFlag' if are_bits else 'IntEnum'}):"]
        out += [f"    {short} = {value}" for short, value in short_names(values).items()] + [""]
    out += ["", "# ---- structs ----"]
    for name, fields in headers.structs.items():
        out += ["", "", f"class {name}(Structure):", "    _fields_ = ["]
        out += [f'        ("{field.name}", {headers.ctype(field.type)}),' for field in fields]
        out += ["    ]"]
        enums = {field.name: headers.enum_of(field.type) for field in fields if headers.enum_of(field.type)}
        items = ", ".join(f'"{field}": {camel(enum)}' for field, enum in enums.items())
        out += [f"    ENUMS = {{{items}}}", f"    COMMENTS = {comments.get(name, {})!r}"]
    out += ["", "", "# ---- functions: name, result, arguments ----", "", "FUNCTIONS = ["]
    for function in headers.functions:
        arguments = ", ".join(headers.arguments(function.type))
        out.append(f'    ("{function.name}", {headers.result(function.type.type)}, [{arguments}]),')
    return "\n".join(out + ["]", ""])


def short_names(values):
    """Names without what they have in common: FACET_TONEMAP_AGX: AGX."""
    names = list(values)
    parts = [name.split("_") for name in names]
    common = 0
    while all(len(p) > common + 1 and p[common] == parts[0][common] for p in parts):
        common += 1
    short = ["_".join(p[common:]) for p in parts]
    return {name if not name[0].isdigit() else "N" + name: values[full] for name, full in zip(short, names)}


# ---- layout_check.c ----

def write_layout_check(headers):
    out = ["/* Prints the layout of every struct as this compiler has it; written by generate.py. */",
           "#include <facet/facet.h>", "#include <stdio.h>", "", "int main(void)", "{"]
    for name, fields in headers.structs.items():
        out.append(f'    printf("{name} %zu\\n", sizeof({name}));')
        for field in fields:
            out.append(f'    printf("{name}.{field.name} %zu %zu\\n", offsetof({name}, {field.name}), '
                       f'sizeof((({name} *)0)->{field.name}));')
    for name, (values, _) in headers.enums.items():
        out += [f'    printf("{value} %lld\\n", (long long){value});' for value in values]
    return "\n".join(out + ["    return 0;", "}", ""])


# ---- __init__.pyi ----

SCALARS = {"c_bool": "bool", "c_float": "float", "c_double": "float", "c_char_p": "str"}


def python_type(headers, field):
    enum = headers.enum_of(field.type)
    if enum:
        words = ", ".join(f'"{word_of(short)}"' for short in short_names(headers.enums[enum][0]))
        return f"{camel(enum)} | Literal[{words}]"
    ctype = headers.ctype(field.type)
    if ctype in headers.structs:
        return "Mapping[str, Any]"
    if " * " in ctype:
        return "Sequence[float]"
    return SCALARS.get(ctype, "int" if ctype.startswith("c_u") or ctype == "c_size_t" else "Any")


def word_of(short):
    """ACES_NARKOWICZ: aces-narkowicz"""
    return short.lower().replace("_", "-")


def write_stub(headers, template):
    """Expands lines "<indent>*facet_struct without a b c" to one keyword a line, and "@enums"."""
    out = []
    for line in template.split("\n"):
        match = re.match(r"(\s*)\*(facet_\w+)(?: without (.*))?$", line)
        if match:
            without = set((match[3] or "").split())
            out += [f"{match[1]}{field.name}: {python_type(headers, field)} = ...,"
                    for field in headers.structs[match[2]] if field.name not in without]
            continue
        match = re.match(r"(\s*)@fields (facet_\w+)(?: without (.*))?$", line)
        if match:
            without = set((match[3] or "").split())
            out += [f"{match[1]}{field.name}: {python_type(headers, field)}"
                    for field in headers.structs[match[2]] if field.name not in without]
        elif line == "@enums":
            for name, (values, are_bits) in headers.enums.items():
                out += [f"class {camel(name)}(enum.{'IntFlag' if are_bits else 'IntEnum'}):"]
                out += [f"    {short} = {value}" for short, value in short_names(values).items()]
        else:
            out.append(line)
    return "\n".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--include", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--soname", required=True)
    parser.add_argument("--libdir", default="lib", help="folder of the library, relative to the prefix")
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--stub", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    headers = Headers(arguments.include, arguments.cc)
    comments = field_comments(arguments.include)
    arguments.output.mkdir(parents=True, exist_ok=True)
    for name, text in {
            "_api.py": write_api(headers, comments, arguments.version, arguments.soname, arguments.libdir),
            "layout_check.c": write_layout_check(headers),
            "__init__.pyi": write_stub(headers, arguments.stub.read_text())}.items():
        (arguments.output / name).write_text(text)


if __name__ == "__main__":
    main()
