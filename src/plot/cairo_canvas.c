/* cairo_canvas.c - the canvas drawn by cairo; see canvas.h. */
#include "plot/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/library.h"
#include "base/memory.h"
#include "base/result.h"
#include "base/text.h"
#include "image/image.h"

/* ---- libcairo, opened when something is drawn: linking it with its X11 and font libraries would delay every
 * start of a program by milliseconds ---- */

/* clang-format off */
#define CAIRO_FUNCTIONS(F, out) \
    F(out, cairo_image_surface_create_for_data, image_surface_create_for_data) \
    F(out, cairo_svg_surface_create_for_stream, svg_surface_create_for_stream) \
    F(out, cairo_svg_surface_set_document_unit, svg_surface_set_document_unit) \
    F(out, cairo_pdf_surface_create_for_stream, pdf_surface_create_for_stream) \
    F(out, cairo_pdf_surface_set_metadata, pdf_surface_set_metadata) \
    F(out, cairo_surface_finish, surface_finish) F(out, cairo_surface_flush, surface_flush) \
    F(out, cairo_surface_destroy, surface_destroy) F(out, cairo_surface_status, surface_status) \
    F(out, cairo_status_to_string, status_to_string) F(out, cairo_create, create) \
    F(out, cairo_destroy, destroy) F(out, cairo_status, status) F(out, cairo_save, save) \
    F(out, cairo_restore, restore) F(out, cairo_clip, clip) F(out, cairo_translate, translate) \
    F(out, cairo_scale, scale) F(out, cairo_rotate, rotate) F(out, cairo_new_path, new_path) \
    F(out, cairo_move_to, move_to) F(out, cairo_line_to, line_to) F(out, cairo_arc, arc) \
    F(out, cairo_rectangle, rectangle) F(out, cairo_close_path, close_path) \
    F(out, cairo_set_source_rgba, set_source_rgba) F(out, cairo_set_source_surface, set_source_surface) \
    F(out, cairo_get_source, get_source) F(out, cairo_pattern_set_filter, pattern_set_filter) \
    F(out, cairo_set_line_width, set_line_width) F(out, cairo_set_line_join, set_line_join) \
    F(out, cairo_set_line_cap, set_line_cap) F(out, cairo_set_dash, set_dash) \
    F(out, cairo_stroke, stroke) F(out, cairo_fill, fill) F(out, cairo_paint, paint) \
    F(out, cairo_select_font_face, select_font_face) F(out, cairo_set_font_size, set_font_size) \
    F(out, cairo_font_options_create, font_options_create) \
    F(out, cairo_font_options_destroy, font_options_destroy) \
    F(out, cairo_font_options_set_antialias, font_options_set_antialias) \
    F(out, cairo_font_options_set_hint_style, font_options_set_hint_style) \
    F(out, cairo_font_options_set_hint_metrics, font_options_set_hint_metrics) \
    F(out, cairo_set_font_options, set_font_options) F(out, cairo_text_extents, text_extents) \
    F(out, cairo_show_text, show_text)
/* clang-format on */

/* Members have cairo's names without "cairo_"; {0} is none. */
typedef struct cairo_library {
    void *handle;
    CAIRO_FUNCTIONS(LIBRARY_MEMBER, )
} cairo_library;

/* {0} is allowed; leaves {0} */
static void cairo_library_close(cairo_library *l)
{
    if (l->handle)
        dlclose(l->handle);
    *l = (cairo_library){0};
}

/* soname: "libcairo.so.2". FACET_ERROR_SYSTEM: it is not installed, or lacks a function. */
static facet_result cairo_library_open(const char *soname, cairo_library *out, facet_error *error)
{
    *out = (cairo_library){0};
    const library_symbol symbols[] = {CAIRO_FUNCTIONS(LIBRARY_SYMBOL, out)};
    /* libcairo stays loaded: its font libraries keep caches that unloading would leak. */
    const library_desc desc = {
        .subject = "plot",
        .advice = ", which draws SVG, PDF and PNG, is not installed; install it (Debian: libcairo2) or write "
                  "CSV, which needs no graphics library",
        .version = "; cairo 1.16 or later was expected (CSV needs no graphics library)",
        .missing = FACET_ERROR_SYSTEM,
        .stays = true,
        .symbols = symbols,
        .symbol_count = sizeof symbols / sizeof *symbols};
    facet_result result = library_open(soname, &desc, &out->handle, error);
    if (result != FACET_OK)
        cairo_library_close(out);
    return result;
}

/* ---- SVG files ---- */

/* Prefixes of the ids that cairo numbers during its lifetime. */
static const char *const COUNTED[] = {"surface", "image"};
enum { COUNTED_COUNT = 2 };

/* The numbers of one prefix in order of appearance. */
typedef struct id_list {
    unsigned long *ids;
    size_t count, capacity;
} id_list;

/* The position of id in the list, from 1; 0: out of memory. */
static size_t renumber(id_list *list, const facet_allocator *allocator, unsigned long id)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->ids[i] == id)
            return i + 1;
    if (!mem_reserve(allocator, (void **)&list->ids, &list->capacity, list->count + 1, sizeof *list->ids))
        return 0;
    list->ids[list->count++] = id;
    return list->count;
}

/* The prefix at p that a number follows; -1: none. */
static int counted_at(const char *p, const char *end)
{
    for (int i = 0; i < COUNTED_COUNT; i++) {
        size_t length = strlen(COUNTED[i]);
        if ((size_t)(end - p) > length && memcmp(p, COUNTED[i], length) == 0 && p[length] >= '0' &&
            p[length] <= '9')
            return i;
    }
    return -1;
}

static bool copy_renumbered(text *out, const char *from, const char *end, id_list lists[COUNTED_COUNT])
{
    const char *copied = from;
    for (const char *p = from; p < end; p++) {
        if (*p != '"' && *p != '#') /* id="image5", xlink:href="#image5", url(#image5) */
            continue;
        int name = counted_at(p + 1, end);
        if (name < 0)
            continue;
        const char *digits = p + 1 + strlen(COUNTED[name]), *after = digits;
        unsigned long id = 0;
        for (; after < end && *after >= '0' && *after <= '9'; after++)
            id = 10 * id + (unsigned long)(*after - '0');
        size_t number = renumber(&lists[name], &out->allocator, id);
        if (number == 0)
            return false;
        text_add_bytes(out, copied, (size_t)(digits - copied));
        text_addf(out, "%zu", number);
        copied = after;
        p = after - 1;
    }
    text_add_bytes(out, copied, (size_t)(end - copied));
    return true;
}

static void add_title(text *out, const char *title)
{
    text_add(out, "\n<title>");
    for (const char *p = title; *p; p++)
        if (*p == '<')
            text_add(out, "&lt;");
        else if (*p == '>')
            text_add(out, "&gt;");
        else if (*p == '&')
            text_add(out, "&amp;");
        else
            text_add_bytes(out, p, 1);
    text_add(out, "</title>");
}

/* Renumbers the ids of images and groups from 1, since cairo counts on from file to file and the same
 * drawing would have different bytes, and adds <title> (UTF-8; NULL, "": none) for screen readers and
 * tooltips, since cairo writes text as outlines. False: out of memory; svg is unchanged. */
static bool tidy_svg(text *svg, const char *title)
{
    if (!svg->data)
        return true;
    text out = {.allocator = svg->allocator};
    id_list lists[COUNTED_COUNT] = {0};
    const char *end = svg->data + svg->length, *root = strstr(svg->data, "<svg");
    const char *head = root ? strchr(root, '>') : NULL;
    head = head ? head + 1 : svg->data;
    text_add_bytes(&out, svg->data, (size_t)(head - svg->data));
    if (title && *title && root)
        add_title(&out, title);
    bool is_done = copy_renumbered(&out, head, end, lists) && !out.has_failed;
    for (int i = 0; i < COUNTED_COUNT; i++)
        mem_free(lists[i].ids);
    if (!is_done) {
        text_destroy(&out);
        return false;
    }
    text_destroy(svg);
    *svg = out;
    return true;
}

/* ---- the canvas ---- */

struct canvas {
    cairo_library cairo;
    canvas_desc desc;
    cairo_surface_t *surface;
    cairo_t *context;
    uint32_t *pixels; /* PNG */
    text file;        /* SVG, PDF: the output of cairo */
    bool has_failed;  /* out of memory in a function that returns nothing */
};

/* Points are 1/72 inch, pixels 1/96. */
static const double POINTS_PER_PIXEL = 0.75;

static cairo_status_t write_bytes(void *user, const unsigned char *bytes, unsigned size)
{
    text *file = user;
    text_add_bytes(file, bytes, size);
    return file->has_failed ? CAIRO_STATUS_WRITE_ERROR : CAIRO_STATUS_SUCCESS;
}

/* Creates the surface of the format; false: out of memory. */
static bool create_surface(canvas *c)
{
    const double width = c->desc.width, height = c->desc.height;
    switch (c->desc.format) {
    case FACET_PLOT_FORMAT_SVG:
        c->surface = c->cairo.svg_surface_create_for_stream(write_bytes, &c->file, width, height);
        c->cairo.svg_surface_set_document_unit(c->surface, CAIRO_SVG_UNIT_PX);
        return true;
    case FACET_PLOT_FORMAT_PDF:
        c->surface = c->cairo.pdf_surface_create_for_stream(write_bytes, &c->file, width * POINTS_PER_PIXEL,
                                                            height * POINTS_PER_PIXEL);
        /* the time of writing would change the bytes */
        c->cairo.pdf_surface_set_metadata(c->surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
        c->cairo.pdf_surface_set_metadata(c->surface, CAIRO_PDF_METADATA_CREATOR, "facet");
        if (c->desc.title && *c->desc.title)
            c->cairo.pdf_surface_set_metadata(c->surface, CAIRO_PDF_METADATA_TITLE, c->desc.title);
        return true;
    default:
        c->pixels = mem_zalloc(&c->desc.allocator, (size_t)c->desc.width * c->desc.height, 4);
        if (c->pixels)
            c->surface = c->cairo.image_surface_create_for_data(
                (unsigned char *)c->pixels, CAIRO_FORMAT_ARGB32, (int)c->desc.width, (int)c->desc.height,
                (int)(4 * c->desc.width));
        return c->pixels != NULL;
    }
}

/* Text that is equal at every size and in every format, independent of desktop settings. */
static void set_font(canvas *c)
{
    cairo_font_options_t *options = c->cairo.font_options_create();
    c->cairo.font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    c->cairo.font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    c->cairo.font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    c->cairo.set_font_options(c->context, options);
    c->cairo.font_options_destroy(options);
}

facet_result canvas_create(const canvas_desc *desc, canvas **out, facet_error *error)
{
    *out = NULL;
    if (desc->width < 1 || desc->height < 1 || desc->width > CANVAS_MAX_SIZE ||
        desc->height > CANVAS_MAX_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: %u x %u pixels; 1 to %d were expected each way",
                    desc->width, desc->height, CANVAS_MAX_SIZE);
    canvas *c = mem_zalloc(&desc->allocator, 1, sizeof *c);
    if (!c)
        return fail_memory(error, "canvas", sizeof *c);
    c->desc = *desc;
    c->file.allocator = desc->allocator;
    facet_result result =
        cairo_library_open(desc->library ? desc->library : FACET_CAIRO_SONAME, &c->cairo, error);
    if (result != FACET_OK) {
        mem_free(c);
        return result;
    }
    if (!create_surface(c)) {
        canvas_destroy(c);
        return fail_memory(error, "pixels of a plot", (size_t)desc->width * desc->height * 4);
    }
    c->context = c->cairo.create(c->surface); /* never NULL; errors stay in it until the end */
    if (desc->format == FACET_PLOT_FORMAT_PDF)
        c->cairo.scale(c->context, POINTS_PER_PIXEL, POINTS_PER_PIXEL);
    c->cairo.set_line_join(c->context, CAIRO_LINE_JOIN_ROUND);
    set_font(c);
    *out = c;
    return FACET_OK;
}

void canvas_destroy(canvas *c)
{
    if (!c)
        return;
    if (c->context)
        c->cairo.destroy(c->context);
    if (c->surface)
        c->cairo.surface_destroy(c->surface);
    mem_free(c->pixels);
    text_destroy(&c->file);
    cairo_library_close(&c->cairo);
    mem_free(c);
}

/* cairo's premultiplied 0xAARRGGBB, opaque, as PNG. */
static facet_result encode_png(canvas *c, unsigned char **bytes, size_t *size, facet_error *error)
{
    image rgb;
    facet_result result =
        image_create(&c->desc.allocator, c->desc.width, c->desc.height, 3, IMAGE_U8, &rgb, error);
    if (result != FACET_OK)
        return result;
    rgb.is_srgb = true;
    const size_t count = (size_t)c->desc.width * c->desc.height;
    unsigned char *out = rgb.pixels;
    for (size_t i = 0; i < count; i++, out += 3) {
        out[0] = (unsigned char)(c->pixels[i] >> 16);
        out[1] = (unsigned char)(c->pixels[i] >> 8);
        out[2] = (unsigned char)c->pixels[i];
    }
    result = image_encode(&rgb, IMAGE_CODEC_PNG,
                          &(image_encode_desc){.allocator = c->desc.allocator, .compression = 6}, bytes, size,
                          error);
    image_destroy(&rgb);
    return result;
}

static facet_result take_file(canvas *c, unsigned char **bytes, size_t *size, facet_error *error)
{
    if (c->desc.format == FACET_PLOT_FORMAT_SVG && !tidy_svg(&c->file, c->desc.title))
        return fail_memory(error, "SVG", c->file.length);
    *bytes = (unsigned char *)c->file.data;
    *size = c->file.length;
    c->file = (text){.allocator = c->desc.allocator};
    return FACET_OK;
}

/* Ends the drawing and returns its error. */
static facet_result finish_drawing(canvas *c, facet_error *error)
{
    cairo_status_t status = c->cairo.status(c->context);
    if (status == CAIRO_STATUS_SUCCESS && c->pixels)
        c->cairo.surface_flush(c->surface);
    else
        c->cairo.surface_finish(c->surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = c->cairo.surface_status(c->surface);
    if (c->has_failed || c->file.has_failed || status == CAIRO_STATUS_NO_MEMORY)
        return fail_memory(error, "plot", c->file.length);
    if (status != CAIRO_STATUS_SUCCESS)
        return fail(error, FACET_ERROR_SYSTEM, "plot: cairo: %s", c->cairo.status_to_string(status));
    return FACET_OK;
}

facet_result canvas_finish(canvas *c, unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    TRY(finish_drawing(c, error));
    return c->pixels ? encode_png(c, bytes, size, error) : take_file(c, bytes, size, error);
}

facet_result canvas_read(canvas *c, const uint32_t **pixels, facet_error *error)
{
    *pixels = c->pixels;
    return finish_drawing(c, error);
}

bool canvas_is_raster(const canvas *c)
{
    return c->pixels != NULL;
}

void canvas_save(canvas *c)
{
    c->cairo.save(c->context);
}

void canvas_restore(canvas *c)
{
    c->cairo.restore(c->context);
}

void canvas_move_to(canvas *c, double x, double y)
{
    c->cairo.move_to(c->context, x, y);
}

void canvas_line_to(canvas *c, double x, double y)
{
    c->cairo.line_to(c->context, x, y);
}

void canvas_rectangle(canvas *c, double x, double y, double width, double height)
{
    c->cairo.rectangle(c->context, x, y, width, height);
}

void canvas_arc(canvas *c, double x, double y, double radius, double from_rad, double to_rad)
{
    c->cairo.arc(c->context, x, y, radius, from_rad, to_rad);
}

void canvas_close(canvas *c)
{
    c->cairo.close_path(c->context);
}

void canvas_clip(canvas *c)
{
    c->cairo.clip(c->context);
}

static void set_color(canvas *c, canvas_color color)
{
    c->cairo.set_source_rgba(c->context, color.r, color.g, color.b, color.a);
}

void canvas_fill(canvas *c, canvas_color color)
{
    set_color(c, color);
    c->cairo.fill(c->context);
}

void canvas_draw(canvas *c, const canvas_stroke *stroke)
{
    set_color(c, stroke->color);
    c->cairo.set_line_width(c->context, stroke->width);
    c->cairo.set_line_cap(c->context, stroke->is_butt ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
    c->cairo.set_dash(c->context, stroke->dash, stroke->dash_count, stroke->dash_offset);
    c->cairo.stroke(c->context);
}

static void select_font(canvas *c, canvas_font font)
{
    /* if this family is missing, fontconfig takes its sans-serif */
    c->cairo.select_font_face(c->context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                              font.is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    c->cairo.set_font_size(c->context, font.size);
}

double canvas_text_width(canvas *c, canvas_font font, const char *string)
{
    cairo_text_extents_t extents = {0};
    select_font(c, font);
    c->cairo.text_extents(c->context, string, &extents);
    return extents.x_advance;
}

void canvas_text(canvas *c, double x, double y, double angle_rad, canvas_font font, canvas_color color,
                 const char *string)
{
    c->cairo.save(c->context);
    c->cairo.translate(c->context, x, y);
    if (angle_rad != 0.0)
        c->cairo.rotate(c->context, angle_rad);
    select_font(c, font);
    set_color(c, color);
    c->cairo.move_to(c->context, 0.0, 0.0);
    c->cairo.show_text(c->context, string);
    c->cairo.new_path(c->context);
    c->cairo.restore(c->context);
}

void canvas_image(canvas *c, double x, double y, double width, double height, uint32_t *pixels,
                  uint32_t pixel_width, uint32_t pixel_height)
{
    cairo_surface_t *source =
        c->cairo.image_surface_create_for_data((unsigned char *)pixels, CAIRO_FORMAT_ARGB32, (int)pixel_width,
                                               (int)pixel_height, (int)(4 * pixel_width));
    c->cairo.save(c->context);
    c->cairo.translate(c->context, x, y);
    c->cairo.scale(c->context, width / pixel_width, height / pixel_height);
    c->cairo.set_source_surface(c->context, source, 0.0, 0.0);
    /* for PNG, pixels align with pixels */
    c->cairo.pattern_set_filter(c->cairo.get_source(c->context),
                                c->pixels ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
    c->cairo.paint(c->context);
    c->cairo.restore(c->context);
    c->has_failed = c->has_failed || c->cairo.surface_status(source) == CAIRO_STATUS_NO_MEMORY;
    c->cairo.surface_finish(source); /* cairo copies the pixels of the caller if it keeps them */
    c->cairo.surface_destroy(source);
}
