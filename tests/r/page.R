# page.R EXAMPLES FACET FOLDER - docs/examples/r/facet_page.R: a page, a picture, and if htmlwidgets is there, a page of two widgets, the second
# one in a box that is not displayed; tests/web/export.mjs opens it.
options(rgl.useNULL = TRUE)
suppressMessages(library(rgl))
arguments <- commandArgs(TRUE)
source(file.path(arguments[1], "rgl_to_facet.R"))
source(file.path(arguments[1], "facet_page.R"))
options(facet = arguments[2])
folder <- arguments[3]

invisible(open3d())
par3d(FOV = 30)
clear3d("lights")
light3d(theta = 20, phi = 35)
bg3d("gray90")
shade3d(translate3d(cube3d(), 1, 0, 0), color = "steelblue", shininess = 20)
shade3d(translate3d(tetrahedron3d(), -2, 1, 0), color = "tomato", specular = "black")
view3d(theta = 30, phi = 20, fov = 30)

facet_page(file.path(folder, "page.html"), title = "rgl <scene>")
parts <- facet_page_parts(file.path(folder, "page.html"))
stopifnot(parts$view$model == "scene.glb", parts$view$title == "rgl <scene>", parts$view$options$env == "none",
          parts$view$options$background == "#E5E5E5", length(parts$files) == 1, parts$files[[1]]$path == "scene.glb",
          startsWith(parts$preview, "data:image/png;base64,iVBOR"))
facet_picture(file = file.path(folder, "widget_gl.png"), size = c(400, 300), options = c("--renderer", "gl"))
failure <- tryCatch(facet_page(file.path(folder, "none/none.html"), c("--orbit", "up")), error = conditionMessage)
stopifnot(grepl("--eye|--orbit", failure))

if (!requireNamespace("htmlwidgets", quietly = TRUE)) {
  cat("no widgets: the package htmlwidgets is not here\n")
} else {
  widget <- facet_widget(width = 400, height = 300)
  stopifnot(inherits(widget, "htmlwidget"))
  html <- htmltools::tagList(facet_widget(width = 400, height = 300), htmltools::div(id = "later", style = "display: none", widget))
  htmltools::save_html(html, file.path(folder, "widgets.html"), libdir = file.path(folder, "lib"))
}
cat("a page, a picture and widgets\n")
