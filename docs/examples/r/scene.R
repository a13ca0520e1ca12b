# scene.R - the worked example of docs/r.md: a few materials in rgl, saved for facet.
#     Rscript scene.R [FOLDER [fine]]
# writes scene.obj, scene.json and a texture into FOLDER (the present one). fine: triangles smaller than pixels.
if (is.null(getOption("rgl.useNULL"))) options(rgl.useNULL = TRUE)
suppressMessages(library(rgl))
here <- sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE))
source(file.path(if (length(here)) dirname(here) else ".", "rgl_to_facet.R"))
folder <- c(commandArgs(TRUE), ".")[1]
is_fine <- identical(commandArgs(TRUE)[2], "fine")
dir.create(folder, showWarnings = FALSE, recursive = TRUE)

# A ball with one normal per vertex, which is what every renderer agrees on.
ball <- subdivision3d(icosahedron3d(), if (is_fine) 5 else 3)
ball$vb[1:3, ] <- ball$vb[1:3, ] / rep(sqrt(colSums(ball$vb[1:3, ]^2)), each = 3)
ball$vb[4, ] <- 1
ball$normals <- ball$vb

invisible(open3d())
par3d(windowRect = c(0, 0, 512, 512), FOV = 30, userMatrix = rotationMatrix(0.35, 1, 0, 0))
clear3d("lights")
light3d(theta = 20, phi = 35)
bg3d("gray90")

# The vignette's own question: the same color, ever larger shininess.
shininess <- c(5, 20, 50, 120)
for (i in seq_along(shininess))
  shade3d(translate3d(ball, 2.2 * (i - 2.5), 1.2, 0), color = "steelblue", shininess = shininess[i],
          tag = paste("shininess", shininess[i]))
# The specular color is the other half of a highlight.
specular <- c("black", "gray10", "gray50", "gold")
for (i in seq_along(specular))
  shade3d(translate3d(ball, 2.2 * (i - 2.5), -1.2, 0), color = "tomato", specular = specular[i],
          tag = paste("specular", specular[i]))
# A surface with a texture, and spheres as spheres3d() makes them.
grid <- seq(-4.4, 4.4, length.out = if (is_fine) 301 else 41)
height <- outer(grid, grid, function(x, z) 0.25 * sin(2 * x) * cos(2 * z) - 3)
s <- (grid - min(grid)) / diff(range(grid))
surface3d(grid, height, grid, color = "white", specular = "gray30", shininess = 30,
          texture = system.file("textures/rgl2.png", package = "rgl"),
          texture_s = outer(s, s, function(a, b) a), texture_t = outer(s, s, function(a, b) 1 - b),
          tag = "ground")
if (!is_fine) # rgl draws its own tessellation of these
  spheres3d(c(-3, 0, 3), -2, 3, radius = 0.5, color = "darkseagreen", emission = "gray10", tag = "small")

rgl_write_obj(file.path(folder, "scene.obj"), withNormals = TRUE, withTextures = TRUE, separateObjects = TRUE)
rgl_materials_json(file.path(folder, "scene.json"))
