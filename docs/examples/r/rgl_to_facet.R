# rgl_to_facet.R - between rgl and facet: what materials and lights of an rgl scene are, as JSON.
# To be sourced; needs rgl and jsonlite. docs/r.md explains it.

# The parameters that an object, or (id = NULL) the next one to be made, has: material3d() as a list of what can be
# set. Read-only ones and NULLs are left out.
rgl_material <- function(id = NULL) {
  m <- rgl::material3d(id = id)
  m[setdiff(names(m)[!vapply(m, is.null, NA)], rgl::rgl.material.readonly)]
}

# The name that writeOBJ() gives to object number id of that type: its statement "o".
rgl_object_name <- function(id, type) {
  called <- c(spheres = "sphere", lines = "segments", linestrip = "lines", planes = "triangles")
  paste0(ifelse(type %in% names(called), called[type], type), id)
}

# The lights of the scene, as light3d() takes them. A light that is infinitely far away is stored by its direction
# (sin theta cos phi, sin phi, cos theta cos phi).
rgl_lights <- function() {
  color <- function(rgba) grDevices::rgb(rgba[1], rgba[2], rgba[3])
  degrees <- function(y, x) round(atan2(y, x) * 180 / pi, 5) # rgl keeps the vector as floats
  lapply(rgl::ids3d("lights")$id, function(id) {
    at <- rgl::rgl.attrib(id, "vertices")[1, ]
    flags <- rgl::rgl.attrib(id, "flags")[, 1]
    colors <- rgl::rgl.attrib(id, "colors")
    place <- if (flags[["finite"]]) list(x = at[[1]], y = at[[2]], z = at[[3]])
             else list(theta = degrees(at[[1]], at[[3]]), phi = degrees(at[[2]], sqrt(at[[1]]^2 + at[[3]]^2)))
    c(place, list(viewpoint.rel = flags[["viewpoint"]], ambient = color(colors[1, ]),
                  diffuse = color(colors[2, ]), specular = color(colors[3, ])))
  })
}

# Background and fog, as bg3d() takes them.
rgl_background <- function() {
  id <- rgl::ids3d("background")$id
  if (length(id) == 0)
    return(NULL)
  flags <- rgl::rgl.attrib(id[1], "flags")[, 1]
  scale <- rgl::rgl.attrib(id[1], "fogscale")
  list(fogtype = if (flags[["linear_fog"]]) "linear" else if (flags[["exp_fog"]]) "exp"
                 else if (flags[["exp2_fog"]]) "exp2" else "none",
       fogScale = if (length(scale)) scale[[1]] else 1,
       color = rgl::material3d("color", id = id[1])[1])
}

# writeOBJ(), and one mistake of it put right: where x or z of surface3d() run such that rgl turns the surface over
# (its flag "flipped", as with both increasing), the file's triangles face away from their normals, so that viewers
# light the wrong side. Arguments are writeOBJ()'s.
rgl_write_obj <- function(file, ...) {
  rgl::writeOBJ(file, ...)
  surfaces <- rgl::ids3d()
  surfaces <- surfaces$id[surfaces$type == "surface"]
  flipped <- Filter(function(id) rgl::rgl.attrib(id, "flags")["flipped", 1], surfaces)
  lines <- readLines(file)
  begins <- startsWith(lines, "o ")
  object <- c("", substring(lines[begins], 3))[cumsum(begins) + 1]
  turned <- startsWith(lines, "f ") & object %in% paste0("surface", flipped)
  lines[turned] <- sub("^f (\\S+) (\\S+) (\\S+)$", "f \\1 \\3 \\2", lines[turned])
  writeLines(lines, file)
  invisible(file)
}

# Writes materials and lights of the current scene to file, for "facet ... --parameters FILE" beside the file that
# writeOBJ() makes of the same scene: each object is found by the name that writeOBJ() gives it. Textures are copied
# beside file, so that the folder holds all that is needed.
rgl_materials_json <- function(file, ids = rgl::ids3d()) {
  drawn <- ids[ids$type %in% c("spheres", "triangles", "quads", "surface", "points", "linestrip", "lines", "planes"), ]
  materials <- Map(function(id, type) {
    m <- rgl_material(id)
    if (length(m$texture)) {
      file.copy(m$texture, file.path(dirname(file), basename(m$texture)), overwrite = TRUE)
      m$texture <- basename(m$texture)
    }
    # A list of one, not a string: that is what it is with several objects, too.
    c(list(name = if (nzchar(m$tag)) m$tag else rgl_object_name(id, type),
           objects = list(rgl_object_name(id, type))), m)
  }, drawn$id, as.character(drawn$type))
  json <- list(facet = "ogl1", version = 1, generator = paste("rgl", utils::packageVersion("rgl")), colors = "srgb",
               materials = unname(materials), lights = rgl_lights(), background = rgl_background())
  writeLines(jsonlite::toJSON(json, auto_unbox = TRUE, pretty = TRUE, digits = NA), file)
  invisible(json)
}

# The camera of the scene as rgl drew it last, as options of "facet render": both then show the same. With a NULL device
# nothing was drawn, so that rgl does not know it. The upward axis of the view must be y.
rgl_camera_options <- function() {
  model <- rgl::par3d("modelMatrix")
  eye <- solve(model, c(0, 0, 0, 1))[1:3]
  axis <- solve(model[1:3, 1:3], c(0, 0, -1))
  bounds <- matrix(rgl::par3d("bbox"), 2)
  target <- eye + axis / sum(axis^2) * sum(axis * (colMeans(bounds) - eye))
  sprintf("--eye %s --target %s --fov %.9g", paste(sprintf("%.9g", eye), collapse = ","),
          paste(sprintf("%.9g", target), collapse = ","), 2 * atan(1 / rgl::par3d("projMatrix")[2, 2]) * 180 / pi)
}

# The way back: reads such a file, facet's own as well. Colors that 8 bits do not hold come as three numbers and are
# rounded, because rgl has no others; textures are looked for beside the file.
rgl_materials_read <- function(file) {
  json <- jsonlite::fromJSON(file, simplifyDataFrame = FALSE)
  color <- function(x) if (is.numeric(x)) grDevices::rgb(x[1], x[2], x[3], maxColorValue = max(1, x)) else x
  for (i in seq_along(json$materials)) {
    m <- json$materials[[i]]
    for (key in intersect(names(m), c("color", "ambient", "specular", "emission")))
      m[[key]] <- color(m[[key]])
    if (!is.null(m$shininess))
      m$shininess <- min(m$shininess, 128)
    if (length(m$texture))
      m$texture <- file.path(dirname(file), m$texture)
    json$materials[[i]] <- m
  }
  names(json$materials) <- vapply(json$materials, function(m) if (is.null(m$name)) "" else m$name, "")
  json$lights <- lapply(json$lights, function(l) {
    l <- l[names(l) %in% names(formals(rgl::light3d))]
    for (key in intersect(names(l), c("ambient", "diffuse", "specular")))
      l[[key]] <- color(l[[key]])
    l
  })
  json
}

# What of a material of rgl_materials_read() this version of rgl can set, for do.call(material3d, ..) or as arguments of
# spheres3d() and the others.
rgl_settable <- function(material) {
  material[names(material) %in% setdiff(rgl::rgl.material.names, rgl::rgl.material.readonly)]
}
