#!/usr/bin/env python3
"""Writes a wheel of the package with libfacet and the libraries that it needs: wheel.py BUILD FOLDER

BUILD is a build with the shared library and the Python package. The wheel holds everything but glibc, the C++ and the compiler's
runtime, so that it runs on systems with the glibc of this one or a newer one: build it on the oldest that is to be served. The
package loads the libraries from its own folder (facet/_library.py). Their licences are those that their packages install
(/usr/share/doc/*/copyright), which the wheel holds too.
"""
import base64
import ctypes
import hashlib
import os
import pathlib
import platform
import re
import subprocess
import sys
import zipfile

SYSTEM = re.compile(r"^(ld-linux|libc|libm|libdl|libpthread|librt|libgcc_s|libstdc\+\+)[-.]")


def needed(library):
    """The files of the libraries that a library needs, other than those of the system, by soname."""
    lines = subprocess.run(["ldd", library], check=True, capture_output=True, text=True).stdout.splitlines()
    found = {}
    for line in lines:
        match = re.match(r"\s*(\S+) => (/\S+)", line)
        if match and not SYSTEM.match(match[1]):
            found[match[1]] = pathlib.Path(match[2]).resolve()
    return found


def opened(build):
    """The same for the library that libfacet opens to render on the CPU, itself among them."""
    name = re.search(r'^#define FACET_EMBREE_FILE "(.*)"$', (build / "generated" / "build_config.h").read_text(), re.M)[1]
    if not name:  # built without Embree
        return {}
    ctypes.CDLL(name)
    path = pathlib.Path(re.search(rf"/\S*/{re.escape(name)}\S*", pathlib.Path("/proc/self/maps").read_text())[0])
    return {name: path, **needed(path)}


def copyright_of(library):
    """The copyright file of the Debian package that a library is of; None: it is of none."""
    owner = subprocess.run(["dpkg", "-S", str(library)], capture_output=True, text=True)
    path = pathlib.Path("/usr/share/doc") / owner.stdout.split(":")[0] / "copyright"
    return path if owner.returncode == 0 and path.exists() else None


def main():
    build, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    package = build / "python" / "facet"
    declarations = (package / "_api.py").read_text()
    version, soname = (re.search(rf'^{name} = "(.*)"$', declarations, re.M)[1] for name in ("VERSION", "SONAME"))
    library = (build / "src" / "api" / soname).resolve()
    glibc = os.confstr("CS_GNU_LIBC_VERSION").split()[1]
    tag = f"py3-none-manylinux_{glibc.replace('.', '_')}_{platform.machine()}"
    info = f"facet-{version}.dist-info"

    files = {f"facet/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.suffix in (".py", ".pyi")}
    files["facet/py.typed"] = b""
    files[f"facet/{soname}"] = library.read_bytes()
    # each after those that it needs, whose closures are smaller
    libraries = sorted({**needed(library), **opened(build)}.items(), key=lambda item: (len(needed(item[1])), item[0]))
    files["facet/libs/order"] = "".join(f"{name}\n" for name, _ in libraries).encode()
    for name, path in libraries:
        files[f"facet/libs/{name}"] = path.read_bytes()
        if copyright_of(path):
            files[f"{info}/licenses/{name}.txt"] = copyright_of(path).read_bytes()
    licence = pathlib.Path(__file__).resolve().parent.parent / "LICENSE"
    files[f"{info}/licenses/LICENSE"] = licence.read_bytes()
    files[f"{info}/METADATA"] = (f"Metadata-Version: 2.1\nName: facet\nVersion: {version}\n"
                                 "Summary: Physically based rendering of glTF models\nLicense: Apache-2.0\n"
                                 "Requires-Python: >=3.9\nRequires-Dist: numpy\n").encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: facet\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = []
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(data)}")
    files[f"{info}/RECORD"] = ("\n".join(record + [f"{info}/RECORD,,"]) + "\n").encode()

    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"facet-{version}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))  # the same bytes from every run
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    print(path)


if __name__ == "__main__":
    main()
