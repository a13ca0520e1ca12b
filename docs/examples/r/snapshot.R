# snapshot.R - rgl's own picture of scene.R, for comparison. Needs a display; without one:
#     xvfb-run -s "-screen 0 1024x768x24" Rscript snapshot.R [FOLDER [fine]]
# writes rgl.png and camera.txt (options of "facet render") into FOLDER, beside what scene.R writes.
options(rgl.useNULL = FALSE)
here <- sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE))
here <- if (length(here)) dirname(here) else "."
source(file.path(here, "scene.R"))
snapshot3d(file.path(folder, "rgl.png"), webshot = FALSE)
writeLines(rgl_camera_options(), file.path(folder, "camera.txt"))
