"""Scenes from arrays: the images of the same glTF, written here by hand."""
import io
import json
import math
import struct
import types
import zlib

import facet
import numpy as np
import pytest


def ball(segments=24, rings=12):
    """Positions, normals, texture coordinates and triangles of a unit ball."""
    u, v = np.meshgrid(np.linspace(0, 1, segments + 1), np.linspace(0, 1, rings + 1))
    a, p = 2 * np.pi * u.ravel(), np.pi * v.ravel()
    normals = np.stack([np.sin(p) * np.cos(a), np.cos(p), -np.sin(p) * np.sin(a)], axis=1).astype(np.float32)
    i = (np.arange(rings)[:, None] * (segments + 1) + np.arange(segments)[None]).ravel()
    faces = np.concatenate([np.stack([i, i + segments + 1, i + 1], 1),
                            np.stack([i + 1, i + segments + 1, i + segments + 2], 1)]).astype(np.uint32)
    return normals * np.float32(0.8), normals, np.stack([u.ravel(), v.ravel()], axis=1).astype(np.float32), faces


def png(pixels):
    """A PNG file of uint8 (height, width, 4), without a library."""
    height, width, _ = pixels.shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def glb(document, arrays):
    """A .glb file: arrays become buffer views, and float and uint32 arrays accessors, in their order."""
    body, views, accessors = b"", [], []
    for array in arrays:
        data = array if isinstance(array, bytes) else array.tobytes()
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": len(data)})
        body += data + b"\0" * (-len(data) % 4)
        if not isinstance(array, bytes):
            kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[1 if array.dtype == np.uint32 else array.shape[1]]
            accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if array.dtype == np.uint32 else 5126,
                              "count": array.size if kind == "SCALAR" else len(array), "type": kind,
                              "min": array.min(axis=0).tolist() if kind != "SCALAR" else [int(array.min())],
                              "max": array.max(axis=0).tolist() if kind != "SCALAR" else [int(array.max())]})
    document = {"asset": {"version": "2.0"}, "scene": 0, "buffers": [{"byteLength": len(body)}], "bufferViews": views,
                "accessors": accessors, **document}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body)) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(body), b"BIN\0") + body)


def same_images(a, b, **keywords):
    for renderer in ("preview", "path"):
        images = [s.render(size=48, samples=2, renderer=renderer, aovs=["depth", "normal"], **keywords) for s in (a, b)]
        np.testing.assert_array_equal(images[0].pixels, images[1].pixels)
        assert images[0].pixels[:, :, 3].max() > 0
        for name in ("depth", "normal"):
            np.testing.assert_array_equal(images[0].layers[name], images[1].layers[name])


def checks():
    pixels = np.zeros((16, 16, 4), np.uint8)
    pixels[..., 0], pixels[..., 1], pixels[..., 3] = 200, np.arange(16)[:, None] * 16, 255
    pixels[::2, ::2, 2] = 255
    return pixels


def bumps():
    pixels = np.full((16, 16, 4), 255, np.uint8)
    pixels[..., 0] = np.random.default_rng(3).integers(110, 146, (16, 16))
    pixels[..., 1] = 128
    return pixels


def test_a_textured_ball_is_the_same_gltf():
    positions, normals, texcoords, faces = ball()
    document = {
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0.1, 0.2, 0, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.25,
                                                "roughnessFactor": 0.5},
                       "normalTexture": {"index": 1, "scale": 0.75}, "doubleSided": True,
                       "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}}}],
        "textures": [{"source": 0}, {"source": 1}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}, {"bufferView": 5, "mimeType": "image/png"}],
        "extensionsUsed": ["KHR_materials_clearcoat"]}
    by_file = facet.load(glb(document, [positions, normals, texcoords, faces.ravel(), png(checks()), png(bumps())]))
    material = {"base_color_texture": checks(), "metallic": 0.25, "perceptual_roughness": 0.5, "clearcoat": 0.5,
                "normal_texture": bumps(), "normal_scale": 0.75, "is_double_sided": True}
    by_arrays = facet.Scene.from_arrays(positions, faces, normals=normals, texcoords=texcoords, material=material,
                                        transform=[[1, 0, 0, 0.1], [0, 0, 1, 0.2], [0, -1, 0, 0], [0, 0, 0, 1]])
    same_images(by_file, by_arrays)
    material["base_color_texture"] = png(checks())  # the bytes of a file
    same_images(by_file, facet.Scene.from_arrays(positions, faces, normals=normals, texcoords=texcoords, material=material,
                                                 transform=[[1, 0, 0, 0.1], [0, 0, 1, 0.2], [0, -1, 0, 0], [0, 0, 0, 1]]))


def test_flat_triangles_colors_and_default_material_are_the_same_gltf():
    positions, _, _, faces = ball(8, 5)
    colors = np.random.default_rng(5).random((len(positions), 4), np.float32)
    document = {"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2}]}]}
    same_images(facet.load(glb(document, [positions, colors, faces.ravel()])),
                facet.Scene.from_arrays(positions, faces, colors=colors))


def test_lines_and_points_are_the_same_gltf():
    positions = ball(6, 4)[0]
    for mode, number in (("lines", 1), ("points", 0)):
        count = len(positions) - len(positions) % 2
        document = {"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": number}]}]}
        same_images(facet.load(glb(document, [positions[:count]])), facet.Scene.from_arrays(positions[:count], mode=mode))


def test_lights_cameras_and_nodes_are_the_same_gltf():
    positions, normals, _, faces = ball()
    document = {
        "scenes": [{"nodes": [0, 2, 3]}],
        "nodes": [{"children": [1], "translation": [0.2, 0, 0]}, {"mesh": 0, "scale": [1, 0.5, 1]},
                  {"camera": 0, "translation": [0, 0.5, 4]},
                  {"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.5, 0.0, 0.0, math.sqrt(0.75)]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3, "color": [1, 0.5, 0.25]}]}},
        "extensionsUsed": ["KHR_lights_punctual"],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}]}
    by_file = facet.load(glb(document, [positions, normals, faces.ravel()]))
    by_arrays = facet.Scene.from_arrays(
        meshes=[{"positions": positions, "indices": faces, "normals": normals}],
        nodes=[{"translation": (0.2, 0, 0)}, {"parent": 0, "mesh": 0, "scale": (1, 0.5, 1)},
               {"camera": 0, "translation": (0, 0.5, 4)}, {"light": 0, "rotation": (-0.5, 0, 0, math.sqrt(0.75))}],
        cameras=[{"fov_y_rad": 0.6, "near_m": 0.1}],
        lights=[{"type": "directional", "intensity": 3, "color": (1, 0.5, 0.25)}])
    same_images(by_file, by_arrays, camera=0, environment=None)


def test_what_from_arrays_makes_is_saved(tmp_path):
    positions, normals, texcoords, faces = ball()
    scene = facet.Scene.from_arrays(positions, faces, normals=normals, texcoords=texcoords, name="ball",
                                    material={"base_color_texture": checks(), "name": "checks"},
                                    instances=[np.eye(4), np.diag([1, 2, 1, 1])])
    scene.save(tmp_path / "ball.glb")
    again = facet.load(tmp_path / "ball.glb")
    same_images(scene, again)
    assert again.counts["instances"] == 2 and again.describe()["materials"][0]["name"] == "checks"


def test_arrays_of_many_kinds():
    positions, _, _, faces = ball(8, 5)
    wanted = facet.Scene.from_arrays(positions, faces).render(size=24, samples=1).pixels
    for p, f in ((positions.astype(np.float64), faces.astype(np.int64)), (positions.tolist(), faces.tolist()),
                 (np.asfortranarray(positions), faces[:, :].astype(np.uint16)), (positions, faces.ravel())):
        np.testing.assert_array_equal(facet.Scene.from_arrays(p, f).render(size=24, samples=1).pixels, wanted)
    coded, linear = np.full((len(positions), 3), 188, np.uint8), np.full((len(positions), 4), 1, np.float32)
    linear[:, :3] = ((188 / 255 + 0.055) / 1.055) ** 2.4
    a, b = (facet.Scene.from_arrays(positions, faces, colors=c).render(size=24, samples=1) for c in (coded, linear))
    np.testing.assert_allclose(a.pixels, b.pixels, atol=1e-6)


def test_bad_arrays_get_one_sentence():
    positions, normals, _, faces = ball(8, 5)
    with pytest.raises(facet.ArgumentError, match=r"meshes\[0\].primitives\[0\].indices: number 1 is 999, but there are"):
        facet.Scene.from_arrays(positions, [[0, 999, 1]])
    with pytest.raises(facet.ArgumentError, match="positions: number 0 is nan"):
        facet.Scene.from_arrays(positions * np.nan, faces)
    for error, message, keywords in (
            (ValueError, "positions must have rows of 3 numbers", {"positions": positions[:, :2]}),
            (ValueError, "must lie in", {"indices": [[0, -1, 1]]}),
            (TypeError, "must be integers", {"indices": [[0.0, 1.0, 2.0]]}),
            (ValueError, "normals must have 54 rows of 3", {"normals": normals[:-1]}),
            (ValueError, "mode is 'quads'", {"mode": "quads"}),
            (TypeError, "did you mean 'base_color'", {"material": {"basecolor": (1, 0, 0)}}),
            (TypeError, "did you mean 'base_color_texture'", {"material": {"base_color_textur": checks()}}),
            (TypeError, "did you mean 'normals'", {"normal": normals}),
            (TypeError, "array of uint8", {"material": {"base_color_texture": checks() / 255}}),
            (ValueError, "its shape is", {"material": {"base_color_texture": checks()[None]}}),
            (ValueError, "metallic: is 2, but must lie in", {"material": {"metallic": 2}}),
            (ValueError, "matrix of 4 x 4", {"transform": np.eye(3)})):
        with pytest.raises(error) as caught:
            facet.Scene.from_arrays(**{"positions": positions, "indices": faces, **keywords})
        assert message in str(caught.value)
    with pytest.raises(TypeError, match="needs positions"):
        facet.Scene.from_arrays(indices=faces)


# ---- trimesh, which Debian 12 lacks: objects with its attributes ----

def mesh_of_trimesh(kind, **visual):
    positions, normals, _, faces = ball()
    return types.SimpleNamespace(vertices=positions, faces=faces, vertex_normals=normals,
                                 visual=types.SimpleNamespace(kind=kind, **visual))


def test_objects_of_trimesh():
    positions, normals, texcoords, faces = ball()
    picture = types.SimpleNamespace(convert=lambda mode: checks(), getbands=lambda: "RGBA")  # of Pillow
    material = types.SimpleNamespace(baseColorFactor=np.array([255, 255, 255, 255], np.uint8), baseColorTexture=picture,
                                     metallicFactor=0.25, roughnessFactor=0.5, doubleSided=True, alphaMode="OPAQUE",
                                     alphaCutoff=None, emissiveFactor=None, name="checks")
    uv = np.stack([texcoords[:, 0], 1 - texcoords[:, 1]], axis=1)
    mesh = mesh_of_trimesh("texture", uv=uv, material=material)
    wanted = facet.Scene.from_arrays(positions, faces, normals=normals, texcoords=np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1),
                                     material={"base_color_texture": checks(), "metallic": 0.25, "perceptual_roughness": 0.5,
                                               "is_double_sided": True})
    same_images(facet.Scene.from_trimesh(mesh), wanted)

    colors = np.random.default_rng(7).integers(0, 256, (len(faces), 4), np.uint8)
    assert facet.Scene.from_trimesh(mesh_of_trimesh("face", face_colors=colors)).counts["vertices"] == 3 * len(faces)
    assert facet.Scene.from_trimesh(mesh_of_trimesh(None)).counts["triangles"] == len(faces)
    vertex = np.full((len(positions), 4), 200, np.uint8)
    assert facet.Scene.from_trimesh(mesh_of_trimesh("vertex", vertex_colors=vertex)).render(size=8, samples=1)

    class Graph(dict):
        nodes_geometry = ["left", "right"]

    graph = Graph(left=(np.eye(4), "ball"), right=(np.array([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]), "ball"))
    scene = facet.Scene.from_trimesh(types.SimpleNamespace(geometry={"ball": mesh}, graph=graph))
    assert scene.counts["instances"] == 2 and scene.counts["meshes"] == 1
    assert scene.bounds()[1][0] == pytest.approx(3.8, abs=1e-3)
    with pytest.raises(TypeError, match="a trimesh.Trimesh or trimesh.Scene"):
        facet.Scene.from_trimesh(io.BytesIO())
