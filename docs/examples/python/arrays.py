"""A surface from numpy arrays, path-traced with a texture: arrays.py IMAGE"""
import sys

import facet
import numpy as np

n = 96
x, z = np.meshgrid(np.linspace(-4, 4, n), np.linspace(-4, 4, n))
r = np.hypot(x, z)
y = 1.5 * np.sinc(r)
vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
faces = np.concatenate([np.stack([i, i + n, i + 1], 1), np.stack([i + 1, i + n, i + n + 1], 1)])

dx, dz = np.gradient(y, x[0], axis=1), np.gradient(y, z[:, 0], axis=0)
normals = np.stack([-dx, np.ones_like(y), -dz], axis=-1).reshape(-1, 3)
uv = np.stack([x, z], axis=-1).reshape(-1, 2) / 8 + 0.5
checks = np.where(np.indices((16, 16)).sum(axis=0)[..., None] % 2, (230, 120, 40), (250, 240, 220)).astype(np.uint8)

scene = facet.Scene.from_arrays(
    vertices,
    faces,
    normals=normals,
    texcoords=uv,
    material={
        "base_color_texture": {"image": checks, "mag_filter": "nearest"},
        "metallic": 0,
        "perceptual_roughness": 0.3,
        "is_double_sided": True,
    },
)
image = scene.render(
    size=(640, 400),
    renderer="path",
    samples=64,
    path={"denoises": True},
    camera=facet.Orbit(azimuth_rad=0.6, polar_rad=1.05, radius_scale=0.9),
    sun={"azimuth_rad": 1.8, "elevation_rad": 0.7, "illuminance_lux": (2.2, 2.0, 1.7)},
    environment_ev=-1.2,
    ground="shadow",
    background="white",
)
image.save(sys.argv[1])
