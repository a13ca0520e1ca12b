"""Views around a model as one sheet: turntable.py MODEL IMAGE"""
import math
import sys

import facet

scene = facet.load(sys.argv[1])
with facet.Renderer(scene) as renderer:  # keeps textures and BVHs between the images
    views = [
        renderer.render(
            size=160,
            background="white",
            camera=facet.Orbit(azimuth_rad=2 * math.pi * i / 6, fits_all_azimuths=True),
        )
        for i in range(6)
    ]
facet.contact_sheet(views, column_count=6).save(sys.argv[2])
