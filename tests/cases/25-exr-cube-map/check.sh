# The same sphere as a panorama and as a cube map of OpenEXR's exrenvmap: equal up to the quarter turn between the middle
# of a panorama (+X here, +Z there) and the faces, not mirrored (nrmse 1.3).
expect 0 bake "$case_dir/latlong.exr" -o latlong.exr --lobe none --mips 1 --size 64 --projection equirect
expect 0 bake "$case_dir/cube.exr" -o cube.exr --lobe none --mips 1 --size 64 --projection equirect --rotation 90
expect 0 compare latlong.exr cube.exr --max nrmse=0.1
