"""What users get wrong: each gets an exception that names it, and never another file, another image or a crash."""
import copy
import math
import pickle

import facet
import numpy as np
import pytest

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
FACE = [[0, 1, 2]]


def refused(error, message, call, *arguments, **keywords):
    with pytest.raises(error) as caught:
        call(*arguments, **keywords)
    assert message in str(caught.value)


def test_a_null_character_does_not_end_a_path(scene, tmp_path):
    image = scene.render(size=4, samples=1)
    for call in (image.save, scene.save, facet.load, facet.Image.load, facet.Environment.load):
        refused(ValueError, "null character", call, f"{tmp_path}/a.png\0.glb")
    assert not list(tmp_path.iterdir())
    refused(ValueError, "null character", facet.Scene.from_arrays, TRIANGLE, FACE, name="a\0b")
    refused(ValueError, "null character", facet.contact_sheet, [image], labels=["a\0b"])


@pytest.mark.parametrize("keywords, error, message", [
    ({"size": (64.5, 32)}, TypeError, "size must be an integer"), ({"size": (0, 4)}, ValueError, "at least 1"),
    ({"size": -1}, ValueError, "at least 1"), ({"size": "ab"}, TypeError, "size must be"), ({"size": (1, 2, 3)}, ValueError, "has 3"),
    ({"threads": -1}, ValueError, "threads is -1"), ({"samples": "4"}, TypeError, "samples must be an integer"),
    ({"scene_index": -1}, ValueError, "scene_index is -1"), ({"variant": -1}, ValueError, "variant is -1"),
    ({"animations": [-1]}, ValueError, "animations is -1"), ({"camera": -1}, ValueError, "camera is -1"),
    ({"camera": object()}, TypeError, "matrix of 4 x 4"), ({"crop": (-1, 0, 4, 4)}, ValueError, "crop is -1"),
    ({"crop": (0, 0, 1.5, 2)}, TypeError, "crop must be"), ({"energy": None}, TypeError, "energy must be a word"),
    ({"exposure_ev": "bright"}, TypeError, "exposure_ev"), ({"background": "blue"}, ValueError, "'#rrggbb'"),
    ({"background": object()}, TypeError, "background_color must be"),
    ({"background": (1, 2, math.nan)}, facet.ArgumentError, "background: a value is not a finite number"),
    ({"sun": {"illuminance_lux": 3}}, TypeError, "illuminance_lux must be 3 numbers"), ({"sea": "gale"}, TypeError, "must be a Sea"),
])
def test_keywords_of_render(scene, keywords, error, message):
    refused(error, message, scene.render, **{"samples": 1, "size": 4, **keywords})


def test_one_object_is_not_taken_for_another(scene):
    refused(TypeError, "sea must be a Sea", scene.render, size=4, sea=scene)
    refused(TypeError, "not a Scene", scene.render, size=4, environment=scene)
    refused(TypeError, "a Scene is needed", facet.Renderer, facet.Environment.studio())


def test_integers_of_numpy(scene):
    image = scene.render(size=np.int64(8), samples=np.int32(1), threads=np.uint8(1))
    assert image.size == (8, 8) and scene.render(size=np.array([8, 4]), samples=1).size == (8, 4)
    assert scene.render(size=8, samples=1, animations=None).size == (8, 8)
    np.testing.assert_allclose(facet.Environment.constant(np.float32(2)).info["mean"], 2, rtol=1e-3)
    refused(facet.ArgumentError, "camera 5", scene.render, size=8, camera=np.int64(5))


def test_arrays_that_are_no_numbers():
    refused(TypeError, "positions: they are complex128", facet.Scene.from_arrays, TRIANGLE.astype(complex), FACE)
    refused(ValueError, "positions: could not convert", facet.Scene.from_arrays, [["a", "b", "c"]], FACE)
    refused(facet.ArgumentError, "indices: is empty", facet.Scene.from_arrays, TRIANGLE, [])
    refused(TypeError, "needs positions", facet.Scene.from_arrays)
    refused(TypeError, "a mesh must be a mapping", facet.Scene.from_arrays, meshes=[TRIANGLE])
    refused(TypeError, "a node must be a mapping", facet.Scene.from_arrays, TRIANGLE, FACE, nodes=[3])
    refused(TypeError, "material must be a mapping", facet.Scene.from_arrays, TRIANGLE, FACE, material="red")


@pytest.mark.parametrize("colors", [TRIANGLE * 255, (TRIANGLE * 255).astype(int), (TRIANGLE * 65535).astype(np.uint16),
                                    TRIANGLE - 1])
def test_colors_out_of_range(colors):
    refused(ValueError, "colors must lie in [0, 1], or be bytes", facet.Scene.from_arrays, TRIANGLE, FACE, colors=colors)


def test_integers_as_colors():
    pixels = [facet.Scene.from_arrays(TRIANGLE, FACE, colors=c).render(size=8, samples=1).pixels
              for c in (TRIANGLE, TRIANGLE.astype(int).tolist())]
    np.testing.assert_array_equal(*pixels)


@pytest.mark.parametrize("field, value", [("row_stride_bytes", 1 << 40), ("bytes", 1), ("width", 1 << 15), ("pixels", 1)])
def test_memory_of_textures_cannot_be_set(field, value):
    texture = {"image": np.zeros((4, 4, 3), np.uint8), field: value}
    refused(TypeError, f"unexpected keyword '{field}'", facet.Scene.from_arrays, TRIANGLE, FACE, texcoords=TRIANGLE[:, :2],
            material={"base_color_texture": texture})


def test_objects_are_made_by_functions(scene):
    refused(TypeError, "is made by facet.load()", facet.Scene, "model.glb")
    refused(TypeError, "is made by", facet.Image)
    for thing in (scene, scene.render(size=4, samples=1)):
        refused(TypeError, "cannot be pickled", pickle.dumps, thing)
        refused(TypeError, "cannot be pickled", copy.deepcopy, thing)
    image = scene.render(size=4, samples=1)
    twin = copy.copy(image)
    image.close()
    assert twin.size == (4, 4)
    orbit = pickle.loads(pickle.dumps(facet.Orbit(azimuth_rad=0.5, polar_rad=1)))
    assert repr(orbit) == repr(facet.Orbit(azimuth_rad=0.5, polar_rad=1))


def test_sheets_of_arrays(scene):
    image = scene.render(size=16, samples=1)
    np.testing.assert_array_equal(facet.contact_sheet([image, image.pixels]).pixels, facet.contact_sheet([image, image]).pixels)
    refused(TypeError, "a list of images", facet.contact_sheet, image)
    refused(TypeError, "a list of images", facet.contact_sheet, image.pixels)


def test_files_are_what_their_names_say(tmp_path):
    refused(ValueError, "is SVG, but", facet.plot("slice").save, tmp_path / "a.png")
    refused(ValueError, ".ktx2", facet.bake("studio", size=8, samples=1).save, tmp_path / "a.png")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("radiance", [-1, math.nan, math.inf, (1, 1, -1)])
def test_light_that_is_none(radiance):
    refused(facet.ArgumentError, "a radiance of", facet.Environment.constant, radiance)
    refused(facet.ArgumentError, "a radiance of", facet.Environment.gradient, 1, 1, radiance)


def test_points_of_the_sea():
    try:
        sea = facet.Sea("trade-wind", resolution=32)
    except facet.UnsupportedError as error:
        pytest.skip(str(error))
    refused(ValueError, "shape (n, 2)", sea.points, np.zeros((2, 3)))
    refused(ValueError, "finite", sea.points, [[math.nan, 0]])
    assert sea.points([1, 2])["height_m"].shape == (1,)


@pytest.mark.parametrize("level", [-1, 4, 99, 1 << 32])
def test_levels_that_are_none(level):
    cube = facet.bake("studio", size=8, samples=1)
    for call in (cube.roughness, cube.unfold, cube.__getitem__, lambda i: cube.face(i, 0)):
        refused(IndexError, f"there are 4 levels, but not {level}", call, level)
    refused(IndexError, "there are 6 faces", cube.face, 0, 6)
    assert len(list(cube)) == 4 and cube.unfold(1).size == (16, 8)
