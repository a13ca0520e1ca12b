#!/usr/bin/env python3
"""still_life.py MODELS OUT.glb - puts Khronos sample assets on a wooden deck, as one glTF file.

MODELS: a folder with core/WaterBottle.glb, materials/ToyCar.glb, .. as in the table below. The file keeps the assets'
materials; animations, variants and cameras are left out. Needs Python only.
"""
import json
import math
import struct
import sys

# model, scale, turn about the upward axis in degrees, place (x, height above the deck, z) in m
PLACES = [
    ("materials/SheenChair", 0.5, 28, (-0.27, 0, -0.16)),
    ("core/WaterBottle", 1.0, -40, (0.03, 0.1302, -0.02)),
    ("materials/GlassVaseFlowers", 1.35, 0, (0.02, 0, 0.02)),
    ("materials/ToyCar", 4.4, -32, (0.4, 0.0713, -0.02)),
    ("materials/SunglassesKhronos", 1.0, 28, (-0.1, 0, 0.25)),
]
LEFT_OUT = ("Flowers1", "GlassAlpha")  # nodes: the second vase, whose glass is alpha blended
PLANKS, PLANK = 31, (0.117, 0.03, 2.4)  # number of planks, and the size of one in m; they are 3 mm apart
HEIGHT = 1.2  # of the deck above the water, m


def read_glb(path):
    """The JSON and the binary chunk of a .glb file."""
    data = open(path, "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def shift_textures(value, offset):
    """Adds offset to the index of each texture below a material."""
    for key, item in value.items():
        if isinstance(item, dict):
            if key.endswith("Texture"):
                item["index"] += offset
            shift_textures(item, offset)


class Builder:
    """A glTF file that grows by whole files."""

    KINDS = ("bufferViews", "accessors", "images", "samplers", "textures", "materials", "meshes", "nodes")

    def __init__(self):
        self.gltf = {kind: [] for kind in self.KINDS}
        self.gltf.update(asset={"version": "2.0", "generator": "still_life.py"}, scene=0, scenes=[{"nodes": []}])
        self.used = set()
        self.binary = bytearray()

    def add(self, path, scale, turn, place):
        """Appends the file's scene below a node that scales, turns and moves it."""
        part, binary = read_glb(path)
        at = {kind: len(self.gltf[kind]) for kind in self.KINDS}
        for view in part["bufferViews"]:
            view["byteOffset"] = view.get("byteOffset", 0) + len(self.binary)
        for accessor in part["accessors"]:
            accessor["bufferView"] += at["bufferViews"]
        for image in part.get("images", []):
            image["bufferView"] += at["bufferViews"]
        for texture in part.get("textures", []):
            self.shift(texture, {"source": "images", "sampler": "samplers"}, at)
            for extension in texture.get("extensions", {}).values():
                self.shift(extension, {"source": "images"}, at)
        for material in part.get("materials", []):
            shift_textures(material, at["textures"])
        for mesh in part["meshes"]:
            for primitive in mesh["primitives"]:
                self.shift(primitive, {"indices": "accessors", "material": "materials"}, at)
                primitive["attributes"] = {k: v + at["accessors"] for k, v in primitive["attributes"].items()}
                primitive.pop("extensions", None)
        for node in part["nodes"]:
            self.shift(node, {"mesh": "meshes"}, at)
            node["children"] = [child + at["nodes"] for child in node.get("children", [])]
            if not node["children"]:
                del node["children"]
            node.pop("camera", None)
            if node.get("name") in LEFT_OUT:
                node.pop("mesh")
        for kind in self.KINDS:
            self.gltf[kind] += part.get(kind, [])
        self.used |= set(part.get("extensionsUsed", [])) - {"KHR_materials_variants"}
        self.binary += binary + bytes(-len(binary) % 4)
        half = math.radians(turn) / 2
        roots = [node + at["nodes"] for node in part["scenes"][part.get("scene", 0)]["nodes"]]
        self.root({"children": roots, "translation": [place[0], place[1] + HEIGHT, place[2]], "scale": [scale] * 3,
                   "rotation": [0, math.sin(half), 0, math.cos(half)]})

    @staticmethod
    def shift(item, members, at):
        for name, kind in members.items():
            if name in item:
                item[name] += at[kind]

    def root(self, node):
        self.gltf["scenes"][0]["nodes"].append(len(self.gltf["nodes"]))
        self.gltf["nodes"].append(node)

    def add_slab(self, size, x, material):
        """Appends a box whose upper side is at HEIGHT and whose middle is at x."""
        positions, normals, indices = [], [], []
        for axis in range(3):
            for sign in (-1, 1):
                u, v = (axis + 1) % 3, (axis + 2) % 3
                for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                    corner, normal = [0, 0, 0], [0, 0, 0]
                    corner[axis], corner[u], corner[v] = sign, a * sign, b
                    normal[axis] = sign
                    positions += [corner[i] * size[i] / 2 for i in range(3)]
                    normals += normal
                first = len(positions) // 3 - 4
                indices += [first, first + 1, first + 2, first, first + 2, first + 3]
        base = len(self.gltf["accessors"])
        half = [s / 2 for s in size]
        for data, kind, count, more in (
            (struct.pack("<72f", *positions), 5126, 24, {"type": "VEC3", "min": [-h for h in half], "max": half}),
            (struct.pack("<72f", *normals), 5126, 24, {"type": "VEC3"}),
            (struct.pack("<36H", *indices), 5123, 36, {"type": "SCALAR"}),
        ):
            self.gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
            self.binary += data
            view = len(self.gltf["bufferViews"]) - 1
            self.gltf["accessors"].append({"bufferView": view, "componentType": kind, "count": count, **more})
        self.gltf["materials"].append(material)
        self.gltf["meshes"].append({"primitives": [{"attributes": {"POSITION": base, "NORMAL": base + 1},
            "indices": base + 2, "material": len(self.gltf["materials"]) - 1}]})
        self.root({"mesh": len(self.gltf["meshes"]) - 1, "translation": [x, HEIGHT - size[1] / 2, 0]})

    def write(self, path):
        self.gltf["buffers"] = [{"byteLength": len(self.binary)}]
        self.gltf["extensionsUsed"] = sorted(self.used)
        text = json.dumps({k: v for k, v in self.gltf.items() if v != []}).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(self.binary), len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


def main():
    models, out = sys.argv[1:]
    builder = Builder()
    for name, scale, turn, place in PLACES:
        builder.add(f"{models}/{name}.glb", scale, turn, place)
    for i in range(PLANKS):
        shade = 0.8 + 0.4 * (i * 0.618 % 1)
        builder.add_slab(PLANK, (i - PLANKS // 2) * (PLANK[0] + 0.003), {"name": f"plank {i}", "pbrMetallicRoughness": {
            "baseColorFactor": [0.33 * shade, 0.23 * shade, 0.15 * shade, 1], "metallicFactor": 0, "roughnessFactor": 0.45}})
    builder.write(out)


main()
