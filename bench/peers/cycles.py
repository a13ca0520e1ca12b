# cycles.py - renders a glTF model with Blender's Cycles as `facet render --renderer path` does: same camera, light,
# bounces, filter; nothing clamped, blurred or denoised. Prints the seconds (of the clock, of
# processors) from the model in memory to the image.
#     blender -b --factory-startup -P cycles.py -- MODEL OUT.exr [-e LIGHT.hdr] [--samples N] [--size N] [--bounces N]
#         [--seed N] [--threads N] [--eye X,Y,Z --target X,Y,Z --fov DEGREES]
# Without --eye: the file's camera. Run by cycles.sh; made for Blender 3.4 with python3-numpy.
import argparse
import math
import sys
import time

import bpy
import numpy
from mathutils import Vector


numpy.bool = bool  # Blender 3.4's glTF importer is older than Debian's numpy


def arguments():
    p = argparse.ArgumentParser(prog="cycles.py")
    p.add_argument("model")
    p.add_argument("output")
    p.add_argument("-e", "--env")
    p.add_argument("--samples", type=int, default=64)
    p.add_argument("--size", type=int, default=512)
    p.add_argument("--bounces", type=int, default=12)
    p.add_argument("--seed", type=int, default=0)
    p.add_argument("--threads", type=int, default=2)
    p.add_argument("--eye")
    p.add_argument("--target", default="0,0,0")
    p.add_argument("--fov", type=float, default=30.0)
    return p.parse_args(sys.argv[sys.argv.index("--") + 1:])


def from_y_up(text):
    x, y, z = (float(v) for v in text.split(","))
    return Vector((x, -z, y))


def set_camera(scene, a):
    if not a.eye:
        scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
        return
    eye = from_y_up(a.eye)
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(a.fov)
    data.clip_start = 0.01
    scene.camera = bpy.data.objects.new("camera", data)
    scene.camera.location = eye
    scene.camera.rotation_euler = (from_y_up(a.target) - eye).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(scene.camera)


def set_light(scene, path):
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    nodes = scene.world.node_tree.nodes
    background = nodes["Background"]
    if not path:
        background.inputs["Color"].default_value = (0, 0, 0, 1)
        return
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(path)
    scene.world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    # As large as the image: what Cycles chooses by itself is smaller.
    scene.world.cycles.sampling_method = "MANUAL"
    scene.world.cycles.sample_map_resolution = texture.image.size[0]


def set_render(scene, a):
    r = scene.render
    r.engine = "CYCLES"
    r.resolution_x = r.resolution_y = a.size
    r.resolution_percentage = 100
    r.threads_mode = "FIXED"
    r.threads = a.threads
    r.film_transparent = False
    r.image_settings.file_format = "OPEN_EXR"
    r.image_settings.color_mode = "RGBA"
    r.image_settings.color_depth = "32"
    c = scene.cycles
    c.device = "CPU"
    c.samples = a.samples
    c.seed = a.seed
    c.use_adaptive_sampling = False
    c.use_denoising = False
    c.use_auto_tile = False
    c.pixel_filter_type = "BOX"
    c.filter_width = 1.0
    c.max_bounces = a.bounces
    c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = c.volume_bounces = a.bounces
    c.caustics_reflective = c.caustics_refractive = True
    c.blur_glossy = 0.0
    c.sample_clamp_direct = c.sample_clamp_indirect = 0.0
    c.light_sampling_threshold = 0.0


def main():
    a = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.import_scene.gltf(filepath=a.model)
    set_camera(scene, a)
    set_light(scene, a.env)
    set_render(scene, a)
    start, cpu_start = time.monotonic(), time.process_time()
    bpy.ops.render.render()
    seconds, cpu = time.monotonic() - start, time.process_time() - cpu_start
    bpy.data.images["Render Result"].save_render(a.output, scene=scene)
    print("cycles: %.3f s, CPU %.3f s" % (seconds, cpu))


main()
