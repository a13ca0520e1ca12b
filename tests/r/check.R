# check.R EXAMPLES FACET - in the folder of the example: what went to glTF and back is what was there; what toJSON() makes
# of rgl's own lists is taken; and what facet writes can be set.
options(rgl.useNULL = TRUE)
suppressMessages(library(rgl))
arguments <- commandArgs(TRUE)
source(file.path(arguments[1], "rgl_to_facet.R"))
facet <- function(...) {
  out <- suppressWarnings(system2(arguments[2], c(...), stdout = TRUE, stderr = TRUE))
  if (!is.null(attr(out, "status")))
    stop(paste(c(..., out), collapse = "\n"))
  out
}

before <- rgl_materials_read("scene.json")
after <- rgl_materials_read("back.json")
stopifnot(length(before$materials) == 10, identical(names(before$materials), names(after$materials)))
texture_members <- c("textype", "texmipmap", "texminfilter", "texmagfilter", "texenvmap") # not written without a texture
for (name in names(before$materials)) {
  x <- before$materials[[name]]
  y <- after$materials[[name]]
  if (is.null(x$texture))
    x[texture_members] <- NULL
  stopifnot(identical(sort(names(x)), sort(names(y))), is.null(x$texture) || file.exists(y$texture))
  for (key in setdiff(names(x), "texture"))
    if (!isTRUE(all.equal(x[[key]], y[[key]])))
      stop(name, ": ", key, " was ", format(x[[key]]), " and is ", format(y[[key]]))
}
stopifnot(isTRUE(all.equal(before$lights, after$lights, tolerance = 1e-5)))

# Parameters that are set round-trip through rgl.
invisible(open3d())
for (m in after$materials) {
  id <- do.call(spheres3d, c(list(0, 0, 0), rgl_settable(m)))
  for (key in c("color", "specular", "emission", "ambient", "shininess", "lit", "smooth", "alpha"))
    stopifnot(isTRUE(all.equal(material3d(key, id = id), m[[key]])))
}
clear3d("lights")
for (light in after$lights)
  do.call(light3d, light)
stopifnot(length(rgl_lights()) == 1, isTRUE(all.equal(rgl_lights(), before$lights, tolerance = 1e-5)))

# rgl's values as jsonlite writes them, without help: unboxed or not, lists with names or without, NULLs.
for (auto_unbox in c(TRUE, FALSE)) {
  lists <- list(materials = list(a = material3d(), b = material3d(id = id)),
                lights = list(list(theta = 10, phi = 20, viewpoint.rel = FALSE, diffuse = "gray70"), rgl_lights()[[1]]))
  writeLines(jsonlite::toJSON(lists, auto_unbox = auto_unbox), "plain.json")
  facet("convert", "plain.json", "plain.glb", "--quiet")
  writeLines(jsonlite::toJSON(material3d(), auto_unbox = auto_unbox), "bare.json")
  facet("convert", "scene.obj", "bare.glb", "--parameters", "bare.json", "--quiet")
}
cat("materials, lights and colors: as they were\n")
