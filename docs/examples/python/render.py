"""Renders a model to a PNG file: render.py MODEL IMAGE"""
import sys

import facet

scene = facet.load(sys.argv[1])
image = scene.render(size=(512, 512), environment="studio", aovs=["depth", "normal"], background="white")
image.save(sys.argv[2])

depth = image.layers["depth"][:, :, 0]
print(f"{image.pixels.shape}, {image.pixels.dtype}; nearest point {depth.min():.3f} m")
