"""The declarations are those of the headers, the types those of the package."""
import ast
import ctypes
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

import facet
import pytest
from facet import _api

PACKAGE = pathlib.Path(facet.__file__).parent
COMPILER = shutil.which("cc")


@pytest.mark.skipif(not COMPILER, reason="no C compiler")
def test_layouts_are_those_of_the_compiler(tmp_path):
    program = tmp_path / "layout"
    subprocess.run([COMPILER, "-std=c11", "-I", os.environ["FACET_TEST_INCLUDE"], PACKAGE / "layout_check.c", "-o", program],
                   check=True)
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    constants = {}
    for kind in (getattr(_api, name) for name in _api.__all__):
        constants.update({(kind.__name__, member.name): member.value for member in kind.__members__.values()})
    checked = 0
    for line in lines:
        name, *numbers = line.split()
        numbers = [int(n) for n in numbers]
        if name.startswith("FACET_"):
            continue
        struct, _, field = name.partition(".")
        kind = getattr(_api, struct)
        found = ([getattr(kind, field).offset, getattr(kind, field).size] if field else [ctypes.sizeof(kind)])
        assert found == numbers, name
        checked += 1
    assert checked > 600 and len(constants) > 150
    names = {line.split()[0]: int(line.split()[1]) for line in lines if line.startswith("FACET_")}
    assert names["FACET_TONEMAP_AGX"] == facet.Tonemap.AGX
    assert names["FACET_AOV_CRYPTO_INSTANCE"] == facet.Aov.CRYPTO_INSTANCE
    assert sorted(names.values()) == sorted(constants.values())


def test_every_function_is_there():
    text = "".join(path.read_text() for path in pathlib.Path(os.environ["FACET_TEST_INCLUDE"], "facet").glob("*.h"))
    assert len(_api.FUNCTIONS) == len(re.findall(r"^FACET_API \w", text, re.M)) > 100


def parameters(function):
    return {p.name for p in inspect.signature(function).parameters.values()} - {"self", "cls"}


def check_function(node, owner, where):
    function = inspect.getattr_static(owner, node.name)
    function = getattr(function, "__func__", function)
    if isinstance(function, property):
        return
    arguments = node.args
    stub = {a.arg for a in arguments.posonlyargs + arguments.args + arguments.kwonlyargs} - {"self", "cls"}
    runtime = parameters(function)
    if arguments.kwarg or "keywords" in runtime or arguments.vararg:
        return
    assert stub == runtime, f"{where}.{node.name}: {stub ^ runtime}"


def test_the_stub_is_the_package():
    tree = ast.parse((PACKAGE / "__init__.pyi").read_text())
    checked = 0
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            check_function(node, facet, "facet")
            checked += 1
        elif isinstance(node, ast.ClassDef) and hasattr(facet, node.name):
            owner = getattr(facet, node.name)
            for item in node.body:
                if isinstance(item, ast.FunctionDef):
                    assert hasattr(owner, item.name), f"{node.name}.{item.name}"
                    check_function(item, owner, node.name)
                    checked += 1
    stubs = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    public = {name for name, value in vars(facet).items() if not name.startswith("_") and not inspect.ismodule(value)}
    assert public <= stubs, public - stubs
    assert checked > 70


def test_everything_has_a_docstring():
    for name in (n for n in vars(facet) if not n.startswith("_")):
        value = getattr(facet, name)
        if inspect.isclass(value) and value.__module__ == "facet":
            for member, function in vars(value).items():
                if inspect.isfunction(function) and not member.startswith("_"):
                    assert inspect.getdoc(getattr(value, member)), f"{name}.{member}"
        elif inspect.isfunction(value):
            assert value.__doc__, name
    assert "[0, 1]" in facet.Scene.render.__doc__ and "samples: " in facet.Scene.render.__doc__


@pytest.mark.skipif(not shutil.which("mypy"), reason="no mypy")
def test_types_of_the_examples(tmp_path):
    examples = sorted((pathlib.Path(os.environ["FACET_TEST_TOP"]) / "docs/examples/python").glob("*.py"))
    result = subprocess.run(["mypy", "--strict", "--cache-dir", tmp_path, *examples],
                            env={**os.environ, "MYPYPATH": str(PACKAGE.parent)}, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout


def test_the_page_runs(tmp_path):
    top = pathlib.Path(os.environ["FACET_TEST_TOP"])
    subprocess.run([sys.executable, top / "docs/examples/python/page.py", top / "docs/python.md", tmp_path / "page"], check=True)
    written = {path.stem for path in (tmp_path / "page").glob("*.jpg")}
    shown = set(re.findall(r"pictures/python_(\w+)\.jpg", (top / "docs/python.md").read_text()))
    assert written == shown


def test_errors_name_what_they_are():
    assert facet.ReadError.__module__ == "facet"
    assert issubclass(facet.ReadError, OSError) and issubclass(facet.ArgumentError, ValueError)
    assert issubclass(facet.OutOfMemoryError, MemoryError) and facet.ReadError.result == facet.Result.ERROR_READ


FAKE = 'const char *facet_version(void) { return "0.99.0"; }'


@pytest.mark.skipif(not COMPILER, reason="no C compiler")
def test_another_minor_version_is_refused(tmp_path, script):
    (tmp_path / "fake.c").write_text(FAKE)
    library = tmp_path / "libfake.so"
    subprocess.run([COMPILER, "-shared", "-fPIC", tmp_path / "fake.c", "-o", library], check=True)
    result = script("import facet", FACET_LIBRARY=str(library))
    assert "is libfacet 0.99.0, but this package needs" in result.stderr and "ImportError" in result.stderr


def test_a_missing_library_is_named(script):
    result = script("import facet", FACET_LIBRARY="/nowhere/libfacet.so")
    assert "libfacet cannot be opened" in result.stderr and "FACET_LIBRARY" in result.stderr


@pytest.mark.skipif(not shutil.which("ldd"), reason="no ldd")
def test_a_wheel_brings_its_libraries(tmp_path, script):
    top = pathlib.Path(os.environ["FACET_TEST_TOP"])
    made = subprocess.run([sys.executable, top / "python/wheel.py", PACKAGE.parent.parent, tmp_path / "wheel"], check=True,
                          capture_output=True, text=True).stdout.strip()
    with zipfile.ZipFile(made) as wheel:
        assert wheel.testzip() is None
        wheel.extractall(tmp_path / "site")
    result = script("""
import re
import facet
assert len(facet.Scene.builtin().render(size=16, samples=1).encode("png")) > 100
print(sorted(set(re.findall(r"(\\S*libembree\\S*)", open("/proc/self/maps").read()))))
""", FACET_LIBRARY="", PYTHONPATH=str(tmp_path / "site"))
    assert result.returncode == 0, result.stderr
    assert f"{tmp_path}/site/facet/libs/libembree" in result.stdout and "/usr/lib" not in result.stdout


def test_numpy_is_optional(script):
    text = """
import sys
sys.modules["numpy"] = None
import facet
image = facet.Scene.builtin().render(size=16, samples=1)
assert len(image.encode("png")) > 100
try:
    image.pixels
except ImportError as error:
    print(error)
"""
    result = script(text)
    assert result.returncode == 0 and "numpy (Debian: python3-numpy)" in result.stdout, result.stderr


