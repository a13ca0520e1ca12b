"""A sea at four times of a day, exposed by the light meter: sea.py IMAGE"""
import sys

import facet

sea = facet.Sea("trade-wind")
camera = sea.camera(height_m=4, azimuth_rad=0.5)
views = [
    sea.render(size=(320, 180), camera=camera, sky={"sun_elevation_rad": elevation})
    for elevation in (0.05, 0.2, 0.5, 1.0)
]
facet.contact_sheet(views, column_count=2).save(sys.argv[1])
