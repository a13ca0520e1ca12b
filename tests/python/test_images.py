"""Images: those of the command, as arrays that live as long as they are used."""
import gc
import io
import math
import pathlib
import warnings

import facet
import numpy as np
import pytest
from conftest import SPIN

SIZE = (96, 72)


@pytest.mark.parametrize("options, keywords", [
    ([], {}),
    (["--env", "none", "--sun", "30,40"], {"environment": None, "sun": {
        "azimuth_rad": math.radians(30), "elevation_rad": math.radians(40), "illuminance_lux": [math.pi] * 3}}),
    (["--tone-mapping", "agx", "--exposure", "1"], {"tonemap": "agx", "exposure_ev": 1}),
    (["--renderer", "path", "--samples", "3"], {"renderer": facet.RendererKind.PATH, "samples": 3}),
    (["--orbit", "40,60,90%"], {"camera": facet.Orbit(azimuth_rad=math.radians(40), polar_rad=math.radians(60),
                                                      radius_scale=0.9)}),
])
def test_bytes_are_those_of_the_command(command, scene, tmp_path, options, keywords):
    command("render", "-o", tmp_path / "command.png", "--size", "96x72", "--background", "transparent", "--energy",
            "conserving", *options)
    scene.render(size=SIZE, **keywords).save(tmp_path / "python.png")
    assert (tmp_path / "command.png").read_bytes() == (tmp_path / "python.png").read_bytes()


def test_an_animation_is_that_of_the_command(command, tmp_path):
    command("render", SPIN, "-o", tmp_path / "command.png", "--size", 64, "--time", 0.4, "--energy", "conserving",
            "--background", "white")
    scene = facet.load(SPIN)
    scene.render(size=64, animations=range(len(scene.animations)), time_s=0.4, background="white").save(tmp_path / "python.png")
    assert (tmp_path / "command.png").read_bytes() == (tmp_path / "python.png").read_bytes()


def test_pixels_outlive_the_image(scene):
    image = scene.render(size=SIZE, samples=1, aovs=["depth", "normal"])
    pixels, depth, coded = image.pixels, image.layers["depth"], image.to_uint8()
    assert pixels.shape == (72, 96, 4) and pixels.dtype == np.float32 and not pixels.flags.writeable
    assert depth.shape == (72, 96, 1) and coded.shape == (72, 96, 4) and coded.dtype == np.uint8
    assert set(image.layers) == {"depth", "normal"} and np.shares_memory(pixels, image.pixels)
    copies = pixels.copy(), depth.copy(), coded.copy()
    image.close()
    del image
    gc.collect()
    rubbish = [facet.Scene.builtin().render(size=SIZE, samples=1) for _ in range(3)]  # would reuse freed memory
    for array, copy in zip((pixels, depth, coded), copies):
        np.testing.assert_array_equal(array, copy)
    assert rubbish


def test_a_closed_object_says_so(scene):
    image = scene.render(size=8, samples=1)
    image.close()
    image.close()
    with pytest.raises(ValueError, match="this Image is closed"):
        image.save("never.png")
    assert "closed" in repr(image)
    with facet.Scene.builtin() as other:
        renderer = facet.Renderer(other)
    first = renderer.render(size=8, samples=1)  # the renderer keeps what it needs of the scene
    assert first.size == (8, 8)
    with pytest.raises(ValueError, match="Scene is closed"):
        other.render(size=8)


def test_arrays_on_demand(scene):
    image = scene.render(size=16, samples=1)
    assert isinstance(scene.render(size=16, samples=1, dtype="uint8"), np.ndarray)
    np.testing.assert_array_equal(scene.render(size=16, samples=1, dtype=np.float32), image.pixels)
    np.testing.assert_array_equal(np.asarray(image), image.pixels)
    np.testing.assert_array_equal(np.asarray(image, np.uint8), image.to_uint8())
    np.testing.assert_array_equal(image[3, :, 0], image.pixels[3, :, 0])
    with pytest.raises(ValueError, match="'uint8' or 'float32'"):
        scene.render(size=16, dtype="int16")


def test_images_from_arrays_round_trip(tmp_path):
    pixels = np.random.default_rng(1).random((5, 7, 4), np.float32)
    pixels[:, :, :3] *= pixels[:, :, 3:]
    np.testing.assert_array_equal(facet.Image.from_array(pixels).pixels, pixels)
    assert facet.Image.from_array(pixels[::2, ::3]).shape == (3, 3, 4)  # not contiguous
    coded = np.random.default_rng(2).integers(0, 256, (6, 4, 3), np.uint8)
    image = facet.Image.from_array(coded)
    np.testing.assert_array_equal(image.to_uint8()[:, :, :3], coded)
    image.save(tmp_path / "a.png")
    again = facet.Image.load(tmp_path / "a.png")
    np.testing.assert_array_equal(again.to_uint8()[:, :, :3], coded)
    assert again.is_for_display and image.encode("png") == (tmp_path / "a.png").read_bytes()
    with pytest.raises(ValueError, match="an image is an array of"):
        facet.Image.from_array(np.zeros((2, 2, 5)))
    with pytest.raises(TypeError, match="float or uint8"):
        facet.Image.from_array(np.zeros((2, 2, 3), int))


def test_models_from_paths_bytes_and_file_objects(tmp_path):
    with facet.load(SPIN) as scene:
        scene.save(tmp_path / "spin.glb")
    wanted = facet.load(tmp_path / "spin.glb").render(size=24, samples=1, dtype="uint8")
    data = (tmp_path / "spin.glb").read_bytes()
    with open(tmp_path / "spin.glb", "rb") as file:
        scenes = [facet.load(str(tmp_path / "spin.glb")), facet.load(data), facet.load(memoryview(data)),
                  facet.load(io.BytesIO(data)), facet.load(file)]
    for scene in scenes:
        np.testing.assert_array_equal(scene.render(size=24, samples=1, dtype="uint8"), wanted)
    with pytest.raises(TypeError, match="binary mode"):
        facet.load(io.StringIO("text"))
    with pytest.raises(TypeError, match="a path, bytes or a binary file object"):
        facet.load(7)


def test_errors_are_the_sentences_of_the_library(scene, tmp_path):
    with pytest.raises(facet.ReadError, match="cannot be opened") as caught:
        facet.load(tmp_path / "missing.glb")
    assert isinstance(caught.value, OSError) and str(caught.value).startswith(str(tmp_path))
    with pytest.raises(facet.InvalidError):
        facet.load(b"glTF\2\0\0\0 but cut off")
    with pytest.raises(facet.ArgumentError, match="there is no camera"):
        scene.render(camera="nothing")
    with pytest.raises(facet.WriteError):
        scene.render(size=8, samples=1).save(tmp_path / "no" / "folder.png")


def test_keywords_that_are_nearly_right(scene):
    for keywords, message in (({"sampels": 3}, r"render\(\) got an unexpected keyword 'sampels'; did you mean 'samples'?"),
                              ({"path": {"denoise": True}}, "did you mean 'denoises'?"),
                              ({"sun": {"azimut_rad": 1}}, "did you mean 'azimuth_rad'?")):
        with pytest.raises(TypeError) as caught:
            scene.render(**keywords)
        assert message.replace("\\", "") in str(caught.value)
    for keywords, message in (({"tonemap": "neutra"}, "did you mean 'neutral'?"), ({"samples": -1}, "at least 0"),
                              ({"samples": 1 << 40}, "below 2^32"), ({"crop": [1, 2]}, "must have 4 numbers"),
                              ({"aovs": ["dept"]}, "'dept'"), ({"tonemap": facet.Energy.GLTF}, "facet.Tonemap")):
        with pytest.raises(ValueError) as caught:
            scene.render(**keywords)
        assert message in str(caught.value)


def test_warnings_are_pythons(tmp_path):
    (tmp_path / "a.obj").write_text("mtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")
    with pytest.warns(facet.FacetWarning, match="missing.mtl") as caught:
        facet.load(tmp_path / "a.obj")
    assert caught[0].filename == __file__
    messages = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        facet.load(tmp_path / "a.obj", log=lambda level, text: messages.append((level, text)))
    assert any(level is facet.LogLevel.WARNING and "missing.mtl" in text for level, text in messages)


def test_cameras(scene):
    orbit = facet.Orbit(azimuth_rad=0.5, polar_rad=1.2)
    by_orbit = scene.render(size=SIZE, samples=1, camera=orbit, aovs=["depth"])
    pose = np.eye(4)
    pose[:3, 3] = 0.4, 3.0, 25.0
    by_pose = scene.render(size=SIZE, samples=1, camera=pose)
    focal = 72 / (2 * math.tan(math.radians(15)))
    K = [[focal, 0, 48], [0, focal, 36], [0, 0, 1]]
    by_intrinsics = scene.render(size=SIZE, samples=1, camera=facet.Camera.from_intrinsics(K, SIZE, pose))
    assert facet.compare(by_pose, by_intrinsics).max_error < 1e-3
    camera = facet.Camera(eye=(0.4, 3, 25), target=(0.4, 3, 0), fov_y_rad=math.radians(30))
    assert facet.compare(by_pose, scene.render(size=SIZE, samples=1, camera=camera)).max_error < 1e-3
    assert facet.compare(by_pose, by_orbit).max_error > 0.1
    with pytest.raises(ValueError, match="principal point"):
        facet.Camera.from_intrinsics([[focal, 0, 10], [0, focal, 36], [0, 0, 1]], SIZE, pose)
    with pytest.raises(ValueError, match="0 0 0 1"):
        scene.render(camera=pose.T)


def test_a_renderer_gives_the_images_of_the_scene(scene):
    with facet.Renderer(scene) as renderer:
        for azimuth in (0.0, 1.0):
            camera = facet.Orbit(azimuth_rad=azimuth)
            np.testing.assert_array_equal(renderer.render(size=32, samples=1, camera=camera).pixels,
                                          scene.render(size=32, samples=1, camera=camera).pixels)
        assert math.isfinite(facet.exposure_from_ev100(renderer.meter(size=32)))


def test_open_gl_where_it_is(scene):
    try:
        image = scene.render(size=SIZE, renderer="gl")
    except (facet.MachineError, facet.UnsupportedError) as error:
        pytest.skip(str(error))
    assert facet.compare(scene.render(size=SIZE), image).flip < 0.1  # edges have other samples
    with facet.Renderer(scene) as renderer:  # its images come from different threads
        np.testing.assert_array_equal(renderer.render(size=32, renderer="gl").pixels,
                                      renderer.render(size=32, renderer="gl").pixels)


def test_environments(tmp_path):
    flat = facet.Environment.from_array(np.full((8, 16, 3), 0.5, np.float32))
    np.testing.assert_allclose(flat.info["mean"], 0.5, rtol=1e-3)
    np.testing.assert_allclose(facet.Environment.constant(2).info["mean"], 2.0, rtol=1e-3)
    sh = facet.Environment.constant(1).harmonics(form="irradiance")
    np.testing.assert_allclose(sh[0], math.pi * 2 * math.sqrt(math.pi), rtol=1e-3)
    sky = facet.Environment.sky(sun_elevation_rad=0.5, illuminance_lux=math.pi, height=32)
    assert sky.info["height"] == 32
    facet.Image.from_array(np.ones((8, 16, 3), np.float32)).save(tmp_path / "white.hdr")
    scene = facet.Scene.builtin()
    a = scene.render(size=16, samples=1, environment=tmp_path / "white.hdr")
    b = scene.render(size=16, samples=1, environment=facet.Environment.load((tmp_path / "white.hdr").read_bytes()))
    np.testing.assert_array_equal(a.pixels, b.pixels)


def test_backgrounds(scene):
    far = facet.Camera(eye=(0, 3, 60), target=(0, 3, 0), fov_y_rad=0.5)
    assert scene.render(size=8, camera=far, samples=1).pixels[0, 0, 3] == 0
    assert tuple(scene.render(size=8, camera=far, samples=1, background="#ff8000").to_uint8()[0, 0]) == (255, 128, 0, 255)
    assert tuple(scene.render(size=8, camera=far, samples=1, background=(1, 0, 0)).to_uint8()[0, 0]) == (255, 0, 0, 255)
    assert scene.render(size=8, camera=far, samples=1, background="environment").pixels[0, 0, 3] == 1


def test_comparison(scene, command, tmp_path):
    a, b = scene.render(size=32, samples=1), scene.render(size=32, samples=1, exposure_ev=0.5)
    c = facet.compare(a, b, space="display")
    assert 0 < c.flip < 1 and 10 < c.psnr < 60 and not c.is_equal and c.difference.size == (32, 32)
    assert facet.compare(a, a).is_equal and facet.compare(a.pixels, a).is_equal
    a.save(tmp_path / "a.png"), b.save(tmp_path / "b.png")
    from_files = facet.compare(tmp_path / "a.png", tmp_path / "b.png")
    assert from_files.flip == pytest.approx(c.flip, abs=0.01) and set(from_files.as_dict()) >= {"flip", "ssim", "psnr"}
    with pytest.raises(facet.ArgumentError):
        facet.compare(a, np.zeros((3, 3, 4), np.float32))


def test_baking(tmp_path, command):
    cube = facet.bake("studio", size=16, samples=32)
    assert cube[0].shape == (6, 16, 16, 3) and cube.roughness(0) == 0 and cube.roughness(len(cube) - 1) == 1
    cube.save(tmp_path / "cube.ktx2")
    assert (tmp_path / "cube.ktx2").read_bytes()[1:7] == b"KTX 20"
    with pytest.raises(IndexError):
        cube.face(99, 0)
    assert cube.unfold(0, "cross-horizontal").size == (64, 48)
    assert facet.bake_dfg(kind="filament", size=16).shape == (16, 16, 3)
    face = facet.bake(facet.Environment.constant(1), size=8, lobe="lambert").face(0, 0)
    gc.collect()
    np.testing.assert_allclose(face, 1.0, rtol=1e-2)  # after its cube is gone


def test_conversion(tmp_path):
    with pytest.warns(facet.FacetWarning):
        rows = facet.convert(SPIN, tmp_path / "spin.obj")
    assert rows and rows[0]["grade"] in list(facet.ConversionGrade) and (tmp_path / "spin.mtl").exists()
    facet.convert(tmp_path / "spin.obj", tmp_path / "again.glb")
    assert facet.load(tmp_path / "again.glb").counts["triangles"] == facet.load(SPIN).counts["triangles"]
    scene = facet.load(tmp_path / "spin.obj")
    assert scene.describe()["counts"]["materials"] >= 1 and scene.report("json").startswith("{")
    assert str(tmp_path / "spin.obj") in scene.files


def test_plots_and_shaders(tmp_path):
    plot = facet.plot("brdf", materials={"metallic": 1, "perceptual_roughness": 0.3}, format="csv")
    assert b"," in plot.data
    plot.save(tmp_path / "a.csv")
    assert (tmp_path / "a.csv").read_bytes() == plot.data
    fits = facet.plot("slice", materials=[{"metallic": 1, "perceptual_roughness": 0.3}], has_fit=True, format="csv").fits
    assert fits[0]["fitted"]["shininess"] > 1
    assert "D_GGX" in facet.shader_text(parts="brdf", version="330") and "brdf" in facet.shader_parts()


def test_scenes_move_and_join(scene):
    a, b = facet.Scene.builtin(), facet.Scene.builtin()
    low, high = a.bounds()
    b.place([[1, 0, 0, 40], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    a.append(b)
    assert a.bounds()[1][0] == pytest.approx(high[0] + 40, abs=1e-3)
    a.place(np.eye(4), part=1)
    assert a.bounds()[1][0] == pytest.approx(high[0], abs=1e-3) and a.bounds()[0][0] == pytest.approx(low[0], abs=1e-3)
    with pytest.raises(ValueError, match="Scene is closed"):
        b.bounds()
    with pytest.raises(ValueError, match="cannot be appended to itself"):
        a.append(a)
    assert a.counts["instances"] == 2 * scene.counts["instances"]


def test_the_sea():
    try:
        sea = facet.Sea("trade-wind", resolution=64)
    except facet.UnsupportedError as error:
        pytest.skip(str(error))
    points = sea.points([[0, 0], [3, 4]])
    assert points["normal"].shape == (2, 3) and np.allclose(np.linalg.norm(points["normal"], axis=1), 1, atol=1e-5)
    sea.set_time(2.0)
    assert not np.array_equal(points["height_m"], sea.points([[0, 0], [3, 4]])["height_m"])
    image = sea.render(size=(48, 27), sky={"sun_elevation_rad": 0.4}, camera=sea.camera(4.0, 0.6), samples=1)
    assert image.pixels[-1].mean() > 0 and sea.info["height_m"] > 1
    assert sea.maps(0).layers["normal"].shape == (64, 64, 3) and sea.mesh(samples=8).counts["triangles"] > 90
    assert "gale" in facet.Sea.presets()


def test_paths_that_are_no_text(tmp_path):
    name = pathlib.Path(str(tmp_path)) / "grün \udcff.png"
    facet.Scene.builtin().render(size=8, samples=1).save(name)
    assert facet.Image.load(name).size == (8, 8)
