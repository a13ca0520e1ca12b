#!/usr/bin/env python3
"""boat.py OUT.glb - a launch of 7 m as a glTF file: hull, deck, cabin, mast. Its water line is y = 0, its bow is at +Z.

The hull is lofted through sections: half-breadth, sheer and keel over the length, and a power of the height between them that flares
towards the bow. Needs Python only.
"""
import json
import math
import struct
import sys

LENGTH, STATIONS, ROWS = 7.0, 48, 8
BOOT_TOP = 0.08  # height of the line between the antifouling and the paint above it, m
WHITE, RED, TEAK, GLASS, STEEL, RAIL = range(6)
MATERIALS = [
    ("paint", (0.82, 0.83, 0.8), 0, 0.25),
    ("antifouling", (0.36, 0.03, 0.02), 0, 0.6),
    ("teak", (0.36, 0.18, 0.08), 0, 0.55),
    ("window", (0.01, 0.012, 0.015), 0, 0.05),
    ("steel", (0.6, 0.6, 0.58), 1, 0.3),
    ("rail", (0.03, 0.06, 0.13), 0, 0.35),
]


def half_breadth(s):
    """Of the deck at s from the stern, 0, to the bow, 1, m."""
    if s < 0.42:
        return 1.15 * (1 - 0.2 * ((0.42 - s) / 0.42) ** 2)
    return 1.15 * math.sqrt(max(1 - ((s - 0.42) / 0.58) ** 2.3, 0))


def sheer(s):
    return 0.72 + 0.75 * max(s - 0.25, 0) ** 1.8


def keel(s):
    return -0.55 * (1 - max((s - 0.6) / 0.4, 0) ** 3) - 0.05


def hull_point(s, y):
    """A point of the starboard side at height y."""
    u = (y - keel(s)) / (sheer(s) - keel(s))
    x = half_breadth(s) * max(u, 0) ** (0.32 + 0.75 * s**3)
    rake = 0.75 * s**5 * (y - keel(s))
    return (x, y, LENGTH * (s - 0.5) + rake)


class Mesh:
    """Grids of points, smooth inside; a primitive per material."""

    def __init__(self):
        self.parts = {}

    def grid(self, material, rows, flipped=False):
        """rows: lists of points; their front is where the next row is up and the next column is to the right."""
        positions, normals, indices = self.parts.setdefault(material, ([], [], []))
        first, height, width = len(positions), len(rows), len(rows[0])
        sign = -1 if flipped else 1
        for j in range(height):
            for i in range(width):
                across = subtract(rows[j][min(i + 1, width - 1)], rows[j][max(i - 1, 0)])
                up = subtract(rows[min(j + 1, height - 1)][i], rows[max(j - 1, 0)][i])
                n = cross(across, up)
                length = math.hypot(*n) or 1
                positions.append(rows[j][i])
                normals.append(tuple(sign * c / length for c in n))
        for j in range(height - 1):
            for i in range(width - 1):
                a = first + j * width + i
                corners = [a, a + 1, a + width, a + width, a + 1, a + width + 1]
                indices += corners[::-1] if flipped else corners

    def both_sides(self, material, rows):
        """The grid and its mirror image in x = 0."""
        self.grid(material, rows)
        self.grid(material, [[(-x, y, z) for x, y, z in row] for row in rows], flipped=True)

    def quad(self, material, a, b, c, d):
        self.grid(material, [[a, b], [d, c]])

    def tapered_box(self, material, bottom, top):
        """bottom, top: (x, y, z back, z front) of half the box, symmetric in x."""
        (x0, y0, b0, f0), (x1, y1, b1, f1) = bottom, top
        low = [(x0, y0, f0), (x0, y0, b0), (-x0, y0, b0), (-x0, y0, f0)]
        high = [(x1, y1, f1), (x1, y1, b1), (-x1, y1, b1), (-x1, y1, f1)]
        for i in range(4):
            k = (i + 1) % 4
            self.quad(material, low[i], low[k], high[k], high[i])
        self.quad(material, high[0], high[1], high[2], high[3])
        self.quad(material, low[3], low[2], low[1], low[0])

    def tube(self, material, a, b, radius_a, radius_b):
        """Along y, with a top."""
        ring = [(math.cos(t), math.sin(t)) for t in (2 * math.pi * i / 16 for i in range(17))]
        rows = [[(p[0] + r * c, p[1], p[2] - r * s) for c, s in ring] for p, r in ((a, radius_a), (b, radius_b), (b, 0))]
        self.grid(material, rows)

    def write(self, path):
        gltf = {"asset": {"version": "2.0", "generator": "boat.py"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0, "name": "boat"}], "accessors": [], "bufferViews": [], "meshes": [{"primitives": []}],
                "materials": [{"name": name, "doubleSided": True, "pbrMetallicRoughness": {
                    "baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}}
                    for name, color, metallic, roughness in MATERIALS]}
        binary = bytearray()

        def add(data, component, count, kind, **more):
            gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            gltf["accessors"].append({"bufferView": len(gltf["bufferViews"]) - 1, "componentType": component,
                                      "count": count, "type": kind, **more})
            binary.extend(data)
            return len(gltf["accessors"]) - 1

        for material, (positions, normals, indices) in sorted(self.parts.items()):
            flat = [struct.unpack("<f", struct.pack("<f", c))[0] for p in positions for c in p]
            bounds = {"min": [min(flat[k::3]) for k in range(3)], "max": [max(flat[k::3]) for k in range(3)]}
            gltf["meshes"][0]["primitives"].append({"material": material, "attributes": {
                "POSITION": add(struct.pack(f"<{len(flat)}f", *flat), 5126, len(positions), "VEC3", **bounds),
                "NORMAL": add(struct.pack(f"<{len(flat)}f", *(c for n in normals for c in n)), 5126, len(normals), "VEC3")},
                "indices": add(struct.pack(f"<{len(indices)}I", *indices), 5125, len(indices), "SCALAR")})
        gltf["buffers"] = [{"byteLength": len(binary)}]
        text = json.dumps(gltf).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(binary), len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def heights(low, high):
    return [low + (high - low) * j / ROWS for j in range(ROWS + 1)]


def main():
    mesh = Mesh()
    stations = [1 - (1 - i / STATIONS) ** 1.5 for i in range(STATIONS + 1)]
    for material, low, high in ((RED, keel, lambda s: BOOT_TOP), (WHITE, lambda s: BOOT_TOP, sheer)):
        columns = [[hull_point(s, y) for y in heights(low(s), high(s))] for s in stations]
        mesh.both_sides(material, [[column[j] for column in columns[::-1]] for j in range(ROWS + 1)])
        transom = [hull_point(0, y) for y in heights(low(0), high(0))]  # flat
        mesh.grid(material, [[(-x, y, z), (x, y, z)] for x, y, z in transom], flipped=True)
    rim = [hull_point(s, sheer(s)) for s in stations]
    deck = [[(x * k / 6, y - 0.06 + 0.05 * (1 - (k / 6) ** 2), z) for x, y, z in rim] for k in range(-6, 7)]
    mesh.grid(TEAK, deck)
    rail = [[(x + dx * min(x / 0.1, 1), y + dy, z) for x, y, z in rim[::-1]] for dx, dy in ((0.02, -0.12), (0.045, -0.05), (0.03, 0.03), (-0.04, 0.03))]
    mesh.both_sides(RAIL, rail)
    mesh.tapered_box(WHITE, (0.72, 0.64, -1.7, 0.75), (0.62, 1.5, -1.6, 0.35))
    mesh.tapered_box(WHITE, (0.76, 1.5, -1.95, 0.6), (0.72, 1.57, -1.9, 0.55))
    for x, z0, z1 in ((0.672, -1.45, -0.75), (0.672, -0.6, 0.2)):
        window = [(x + 0.022, 1.02, z1), (x + 0.022, 1.02, z0), (x - 0.018, 1.38, z0), (x - 0.018, 1.38, z1 - 0.12)]
        mesh.quad(GLASS, *window)
        mesh.quad(GLASS, *[(-a, b, c) for a, b, c in window[::-1]])
    for side in (-1, 1):
        low, high = sorted((0.06 * side, 0.58 * side))
        mesh.quad(GLASS, (low, 1.02, 0.59), (high, 1.02, 0.59), (high * 0.94, 1.38, 0.425), (low * 0.94, 1.38, 0.425))
    mesh.tube(STEEL, (0, 1.57, -0.8), (0, 3.2, -0.9), 0.035, 0.02)
    for x, y, z in rim[4:-6:6]:
        for side in (-1, 1):
            mesh.tube(STEEL, (side * (x - 0.06), y, z), (side * (x - 0.06), y + 0.45, z), 0.014, 0.014)
    mesh.write(sys.argv[1])


main()
