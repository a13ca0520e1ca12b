# facet_page.R - rgl scenes in web pages, drawn by facet. To be sourced after rgl_to_facet.R, which is beside it; needs rgl, jsonlite and
# the command facet with its viewer for browsers. docs/r.md explains it.
#     facet_page("scene.html")     the current scene as one file that opens anywhere
#     facet_widget()               the same inside an R Markdown document, a Quarto page or Shiny (needs htmlwidgets)

# Runs facet; what it says becomes R's messages and errors. facet: the command, options("facet") or the one in PATH.
facet_run <- function(words, facet = getOption("facet", "facet")) {
  said <- suppressWarnings(system2(facet, shQuote(words), stdout = TRUE, stderr = TRUE))
  if (!is.null(attr(said, "status")))
    stop(paste(c(said, if (!length(said)) paste(facet, "cannot be run")), collapse = "\n"), call. = FALSE)
  for (line in said) message(line)
}

# The camera of the scene as options of facet, also with a NULL device, which has drawn nothing: the direction and the angle of
# view of par3d(), at the distance from which rgl shows the whole scene.
rgl_view_options <- function() {
  turn <- solve(rgl::par3d("userMatrix")[1:3, 1:3])
  bounds <- matrix(rgl::par3d("bbox"), 2)
  center <- colMeans(bounds)
  fov <- max(rgl::par3d("FOV"), 1)
  radius <- max(sqrt(sum(apply(bounds, 2, diff)^2)) / 2, 1e-6)
  eye <- center + turn[, 3] / sqrt(sum(turn[, 3]^2)) * radius / sin(fov * pi / 360) * rgl::par3d("zoom")
  up <- if (abs(turn[3, 2]) > abs(turn[2, 2])) "z" else "y"
  numbers <- function(x) paste(sprintf("%.9g", x), collapse = ",")
  c(paste0("--eye=", numbers(eye)), paste0("--target=", numbers(center)), "--fov", sprintf("%.9g", fov), "--up", up)
}

# The scene as facet draws it by default: by its own lights, on its own background, with rgl's camera.
rgl_page_options <- function() {
  background <- rgl_background()$color
  c("--env", "none", "--tone-mapping", "none", rgl_view_options(),
    if (length(background)) c("--background", grDevices::rgb(t(grDevices::col2rgb(background)), maxColorValue = 255)))
}

# Writes the current scene to folder as scene.glb, and returns its path.
facet_scene <- function(folder, ids = rgl::ids3d(), facet = getOption("facet", "facet")) {
  object <- file.path(folder, "scene.obj")
  parameters <- file.path(folder, "scene.json")
  model <- file.path(folder, "scene.glb")
  rgl_write_obj(object, withNormals = TRUE, withTextures = TRUE, separateObjects = TRUE)
  rgl_materials_json(parameters, ids)
  facet_run(c("convert", object, model, "--parameters", parameters, "--keep-sources", "--quiet"), facet)
  model
}

# Writes the current scene as a page of one file. options: of "facet view", as c("--env", "neutral"), after those of the scene.
facet_page <- function(file = "scene.html", options = character(), title = "rgl", ids = rgl::ids3d(),
                       facet = getOption("facet", "facet")) {
  folder <- tempfile("facet")
  dir.create(folder)
  on.exit(unlink(folder, recursive = TRUE))
  facet_run(c("view", facet_scene(folder, ids, facet), rgl_page_options(), options, "--title", title, "--html", path.expand(file),
              "--quiet"), facet)
  invisible(file)
}

# ---- widgets ----

# The folder of facet's viewer: FACET_WEB, where the command is installed, or its build tree.
facet_web_folder <- function(facet = getOption("facet", "facet")) {
  command <- dirname(normalizePath(Sys.which(facet), mustWork = FALSE))
  places <- c(Sys.getenv("FACET_WEB"), file.path(command, c("../share/facet/web", "../../../web/dist")))
  found <- places[nzchar(places) & file.exists(file.path(places, "pages/widget.js"))]
  if (!length(found))
    stop("facet's viewer for browsers is not installed; FACET_WEB names its folder, build/web/dist of ./run web --build", call. = FALSE)
  normalizePath(found[1])
}

# What a page of facet holds: the view, the files of the model (gzip as base64), and the preview.
facet_page_parts <- function(file) {
  text <- paste(readLines(file, encoding = "UTF-8"), collapse = "\n")
  find <- function(pattern) regmatches(text, gregexpr(pattern, text, perl = TRUE))[[1]]
  inside <- function(element) sub("</script>$", "", sub("^<script[^>]*>", "", element))
  files <- find("<script [^>]*data-path=\"[^\"]*\">[^<]*</script>")
  list(view = jsonlite::fromJSON(inside(find("<script [^>]*id=\"view\">[^<]*</script>")), simplifyVector = FALSE),
       files = lapply(files, function(element)
         list(path = sub(".*data-path=\"([^\"]*)\".*", "\\1", substr(element, 1, 2000)), data = inside(element))),
       preview = sub("\".*", "", sub(".*<img id=\"preview\" src=\"", "", find("<img id=\"preview\" src=\"[^\"]*\""))))
}

# The current scene as an htmlwidget. All widgets of a document share one copy of the viewer. Where a document becomes PDF or Word, it is a
# picture by "facet render".
facet_widget <- function(options = character(), width = NULL, height = NULL, elementId = NULL, title = "rgl scene",
                         ids = rgl::ids3d(), facet = getOption("facet", "facet")) {
  if (!requireNamespace("htmlwidgets", quietly = TRUE))
    stop("facet_widget() needs the package htmlwidgets; facet_page() writes a page without it", call. = FALSE)
  folder <- tempfile("facet")
  dir.create(folder)
  on.exit(unlink(folder, recursive = TRUE))
  if (requireNamespace("knitr", quietly = TRUE) && isTRUE(getOption("knitr.in.progress")) && !knitr::is_html_output())
    return(facet_picture(options, ids = ids, facet = facet))
  page <- file.path(folder, "page.html")
  facet_page(page, options, title, ids, facet)
  viewer <- htmltools::htmlDependency("facet-viewer", "1", src = c(file = file.path(facet_web_folder(facet), "pages")),
                                      script = "widget.js", all_files = FALSE)
  sizes <- htmlwidgets::sizingPolicy(defaultWidth = 640, defaultHeight = 480, padding = 0, viewer.fill = TRUE, browser.fill = TRUE,
                                     knitr.figure = TRUE)
  htmlwidgets::createWidget("facet", facet_page_parts(page), width, height, sizes, package = "facet", dependencies = viewer,
                            elementId = elementId)
}

# A picture of the current scene by "facet render", for documents that are printed. size: pixels.
facet_picture <- function(options = character(), file = NULL, size = c(1280, 960), ids = rgl::ids3d(),
                          facet = getOption("facet", "facet")) {
  folder <- tempfile("facet")
  dir.create(folder)
  on.exit(unlink(folder, recursive = TRUE))
  if (is.null(file))
    file <- tempfile("facet", if (isTRUE(getOption("knitr.in.progress"))) "." else tempdir(), ".png")
  facet_run(c("render", facet_scene(folder, ids, facet), rgl_page_options(), options, "--size", paste(size, collapse = "x"),
              "--output", file, "--quiet"), facet)
  if (isTRUE(getOption("knitr.in.progress"))) knitr::include_graphics(file) else invisible(file)
}
