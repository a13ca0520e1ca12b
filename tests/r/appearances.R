# appearances.R EXAMPLES FOLDER - small scenes that differ in one thing each, drawn by rgl (which needs a display) and
# saved for facet, each in a folder of its own: rgl.png, camera.txt, scene.obj, scene.json.
options(rgl.useNULL = FALSE)
suppressMessages(library(rgl))
arguments <- commandArgs(TRUE)
source(file.path(arguments[1], "rgl_to_facet.R"))

ball <- subdivision3d(icosahedron3d(), 3)
ball$vb[1:3, ] <- ball$vb[1:3, ] / rep(sqrt(colSums(ball$vb[1:3, ]^2)), each = 3)
ball$vb[4, ] <- 1
ball$normals <- ball$vb
textured <- ball
textured$texcoords <- rbind(atan2(ball$vb[1, ], ball$vb[3, ]) / pi / 2 + 0.5, 0.5 + ball$vb[2, ] / 2)

# Three spheres in a row away from the eye.
row_of <- function(..., of = ball)
  for (i in -1:1)
    shade3d(translate3d(of, 2.2 * i, 0, -2 * i), ...)

scene <- function(name, draw, lights = list(list(theta = 20, phi = 35)), fogtype = "none") {
  folder <- file.path(arguments[2], name)
  dir.create(folder)
  open3d()
  par3d(windowRect = c(0, 0, 256, 256), FOV = 30, userMatrix = rotationMatrix(0.35, 1, 0, 0))
  clear3d("lights")
  for (light in lights)
    do.call(light3d, light)
  bg3d("gray90", fogtype = fogtype)
  draw()
  snapshot3d(file.path(folder, "rgl.png"), webshot = FALSE)
  writeLines(rgl_camera_options(), file.path(folder, "camera.txt"))
  rgl_write_obj(file.path(folder, "scene.obj"))
  rgl_materials_json(file.path(folder, "scene.json"))
  close3d()
}
steel <- function() row_of(color = "steelblue")

scene("plain", steel)
scene("two_lights", function() row_of(color = "white", specular = "gray50", ambient = "steelblue", emission = "gray10"),
      list(list(theta = -60, phi = 10, diffuse = "red", specular = "blue", ambient = "gray20"),
           list(theta = 50, phi = 60, diffuse = "gray50", viewpoint.rel = FALSE)))
scene("world_light", steel, list(list(theta = 20, phi = 35, viewpoint.rel = FALSE)))
scene("point_light", steel, list(list(x = 0, y = 3, z = 3, viewpoint.rel = FALSE)))
scene("point_light_of_view", steel, list(list(x = 2, y = 1, z = -8)))
for (type in c("linear", "exp", "exp2"))
  scene(paste0("fog_", type), steel, fogtype = type)
scene("unlit", function() row_of(color = "steelblue", lit = FALSE))
# A mesh without normals: with normals, glShadeModel(GL_FLAT) would take the light of each triangle's last corner.
scene("flat", function() row_of(color = "steelblue", smooth = FALSE, of = subdivision3d(icosahedron3d(), 1)))
scene("texture", function() row_of(color = "tomato", specular = "gray50", of = textured,
                                   texture = system.file("textures/rgl2.png", package = "rgl")))
scene("translucent", function() row_of(color = "steelblue", alpha = 0.5))
