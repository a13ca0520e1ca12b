/* svg_canvas.c - the canvas written as SVG, for builds without cairo: shapes as paths, text as text. Only FACET_PLOT_FORMAT_SVG;
 * see canvas.h. */
#include "plot/canvas.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "base/text.h"
#include "base/utf8.h"
#include "image/image.h"

enum { MAX_DEPTH = 8 };

struct canvas {
    canvas_desc desc;
    text file, path;           /* path: the d attribute so far */
    bool has_point;            /* the path has a current point */
    uint32_t clips;            /* in the file */
    int depth;                 /* of canvas_save() */
    int groups[MAX_DEPTH + 1]; /* that clips opened, by depth */
};

/* ---- text: its width ---- */

/* Advances of U+0020 to U+007E in DejaVu Sans and DejaVu Sans Bold, 1/2048 of the size. A viewer that has neither stretches
 * another font to these widths (textLength). */
static const uint16_t ADVANCES[2][95] = {
    {651,  821,  942,  1716, 1303, 1946, 1597, 563,  799,  799,  1024, 1716, 651,  739,  651,  690,
     1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 690,  690,  1716, 1716, 1716, 1087,
     2048, 1401, 1405, 1430, 1577, 1294, 1178, 1587, 1540, 604,  604,  1343, 1141, 1767, 1532, 1612,
     1235, 1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403, 1251, 1403, 799,  690,  799,  1716, 1024,
     1024, 1255, 1300, 1126, 1300, 1260, 721,  1300, 1298, 569,  569,  1186, 569,  1995, 1298, 1253,
     1300, 1300, 842,  1067, 803,  1298, 1212, 1675, 1212, 1212, 1075, 1303, 690,  1303, 1716},
    {713,  934,  1067, 1716, 1425, 2052, 1786, 627,  936,  936,  1071, 1716, 778,  850,  778,  748,
     1425, 1425, 1425, 1425, 1425, 1425, 1425, 1425, 1425, 1425, 819,  819,  1716, 1716, 1716, 1188,
     2048, 1585, 1561, 1503, 1700, 1399, 1399, 1681, 1714, 762,  762,  1587, 1305, 2038, 1714, 1741,
     1501, 1741, 1577, 1475, 1397, 1663, 1585, 2259, 1579, 1483, 1485, 936,  748,  936,  1716, 1024,
     1024, 1382, 1466, 1214, 1466, 1389, 891,  1466, 1458, 702,  702,  1362, 702,  2134, 1458, 1407,
     1466, 1466, 1010, 1219, 979,  1458, 1335, 1892, 1321, 1335, 1192, 1458, 748,  1458, 1716}};

/* Other characters that charts have, as UTF-8. */
static const struct {
    char bytes[4];
    uint16_t advances[2];
} OTHERS[] = {{"\xc2\xb0", {1024, 1024}},     {"\xc2\xb2", {821, 897}},       {"\xc2\xb7", {651, 778}},
              {"\xc3\x97", {1716, 1716}},     {"\xe2\x80\x93", {1024, 1024}}, {"\xe2\x80\xa6", {2048, 2048}},
              {"\xe2\x88\x92", {1716, 1716}}, {"\xce\xb1", {1350, 1407}},     {"\xce\xb8", {1253, 1407}}};

static unsigned advance_of(const char *s, size_t length, bool is_bold)
{
    if (length == 1 && s[0] >= 0x20 && s[0] < 0x7f)
        return ADVANCES[is_bold][s[0] - 0x20];
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++)
        if (strlen(OTHERS[i].bytes) == length && memcmp(s, OTHERS[i].bytes, length) == 0)
            return OTHERS[i].advances[is_bold];
    return length > 2 ? 2048 : 1300; /* mostly ideographs, and letters */
}

double canvas_text_width(canvas *c, canvas_font font, const char *string)
{
    (void)c;
    unsigned width = 0;
    for (const char *s = string; *s;) {
        size_t length = utf8_length(s, SIZE_MAX);
        length = length ? length : 1;
        width += advance_of(s, length, font.is_bold);
        s += length;
    }
    return font.size * width / 2048.0;
}

/* ---- numbers and colors ---- */

/* px in hundredths, without trailing zeros. */
static void add_px(text *t, double px)
{
    const double limited = fmin(fmax(px, -1e6), 1e6);
    long hundredths = lround(limited * 100.0);
    const char *sign = hundredths < 0 ? "-" : "";
    hundredths = hundredths < 0 ? -hundredths : hundredths;
    char digits[24];
    int length = snprintf(digits, sizeof digits, "%s%ld.%02ld", sign, hundredths / 100, hundredths % 100);
    while (digits[length - 1] == '0')
        length--;
    text_add_bytes(t, digits, (size_t)(length - (digits[length - 1] == '.')));
}

static void add_attribute_px(text *t, const char *name, double px)
{
    text_addf(t, " %s=\"", name);
    add_px(t, px);
    text_add(t, "\"");
}

static unsigned code_of(double value)
{
    return (unsigned)(fmin(fmax(value, 0.0), 1.0) * 255.0 + 0.5);
}

/* name: fill or stroke. */
static void add_color(text *t, const char *name, canvas_color color)
{
    text_addf(t, " %s=\"#%02x%02x%02x\"", name, code_of(color.r), code_of(color.g), code_of(color.b));
    if (color.a < 1.0)
        text_addf(t, " %s-opacity=\"%.3g\"", name, color.a);
}

/* ---- the file ---- */

facet_result canvas_create(const canvas_desc *desc, canvas **out, facet_error *error)
{
    *out = NULL;
    if (desc->format != FACET_PLOT_FORMAT_SVG)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "plot: this build draws no PDF and PNG; build it with cairo 1.16 or later (Debian: "
                    "libcairo2-dev), "
                    "or write SVG, CSV or JSON");
    if (desc->width < 1 || desc->height < 1 || desc->width > CANVAS_MAX_SIZE ||
        desc->height > CANVAS_MAX_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: %u x %u pixels; sides from 1 to %d were expected",
                    desc->width, desc->height, CANVAS_MAX_SIZE);
    canvas *c = mem_zalloc(&desc->allocator, 1, sizeof *c);
    if (!c)
        return fail_memory(error, "canvas", sizeof *c);
    c->desc = *desc;
    c->file.allocator = c->path.allocator = desc->allocator;
    text_addf(&c->file,
              "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" viewBox=\"0 0 %u %u\" "
              "role=\"img\" "
              "font-family=\"'DejaVu Sans', Verdana, sans-serif\" fill=\"none\" stroke-linejoin=\"round\">\n",
              desc->width, desc->height, desc->width, desc->height);
    if (desc->title && *desc->title) {
        text_add(&c->file, "<title>");
        text_add_html(&c->file, desc->title);
        text_add(&c->file, "</title>\n");
    }
    *out = c;
    return FACET_OK;
}

void canvas_destroy(canvas *c)
{
    if (!c)
        return;
    text_destroy(&c->file);
    text_destroy(&c->path);
    mem_free(c);
}

facet_result canvas_finish(canvas *c, unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    text_add(&c->file, "</svg>\n");
    if (c->file.has_failed || c->path.has_failed)
        return fail_memory(error, "SVG", c->file.length);
    *bytes = (unsigned char *)c->file.data;
    *size = c->file.length;
    c->file = (text){.allocator = c->desc.allocator};
    return FACET_OK;
}

facet_result canvas_read(canvas *c, const uint32_t **pixels, facet_error *error)
{
    (void)c;
    *pixels = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "plot: this build draws no pixels; build it with cairo");
}

bool canvas_is_raster(const canvas *c)
{
    (void)c;
    return false;
}

/* ---- paths ---- */

static void add_point(canvas *c, const char *command, double x, double y)
{
    text_add(&c->path, command);
    add_px(&c->path, x);
    text_add(&c->path, " ");
    add_px(&c->path, y);
    c->has_point = true;
}

void canvas_move_to(canvas *c, double x, double y)
{
    add_point(c, "M", x, y);
}

void canvas_line_to(canvas *c, double x, double y)
{
    add_point(c, c->has_point ? "L" : "M", x, y);
}

void canvas_close(canvas *c)
{
    text_add(&c->path, "Z");
}

void canvas_rectangle(canvas *c, double x, double y, double width, double height)
{
    add_point(c, "M", x, y);
    add_point(c, "L", x + width, y);
    add_point(c, "L", x + width, y + height);
    add_point(c, "L", x, y + height);
    canvas_close(c);
}

/* Parts of less than half a circle, which have one meaning. */
void canvas_arc(canvas *c, double x, double y, double radius, double from_rad, double to_rad)
{
    const double turn = 6.283185307179586;
    while (to_rad < from_rad)
        to_rad += turn;
    const int parts = (int)fmin(ceil((to_rad - from_rad) / (turn / 3.0) + 1e-9), 1000.0);
    canvas_line_to(c, x + radius * cos(from_rad), y + radius * sin(from_rad));
    for (int i = 1; i <= parts; i++) {
        const double angle = from_rad + (to_rad - from_rad) * i / parts;
        text_add(&c->path, "A");
        add_px(&c->path, radius);
        text_add(&c->path, " ");
        add_px(&c->path, radius);
        add_point(c, " 0 0 1 ", x + radius * cos(angle), y + radius * sin(angle));
    }
}

static void end_path(canvas *c)
{
    c->path.length = 0;
    c->has_point = false;
}

static void add_path(canvas *c)
{
    text_add(&c->file, "<path d=\"");
    text_add_bytes(&c->file, c->path.data, c->path.length);
    text_add(&c->file, "\"");
    end_path(c);
}

void canvas_fill(canvas *c, canvas_color color)
{
    add_path(c);
    add_color(&c->file, "fill", color);
    text_add(&c->file, "/>\n");
}

void canvas_draw(canvas *c, const canvas_stroke *stroke)
{
    if (c->path.length == 0)
        return;
    add_path(c);
    text *t = &c->file;
    add_color(t, "stroke", stroke->color);
    add_attribute_px(t, "stroke-width", stroke->width);
    if (!stroke->is_butt)
        text_add(t, " stroke-linecap=\"round\"");
    for (int i = 0; i < stroke->dash_count; i++) {
        text_add(t, i ? " " : " stroke-dasharray=\"");
        add_px(t, stroke->dash[i]);
    }
    if (stroke->dash_count) {
        text_add(t, "\"");
        add_attribute_px(t, "stroke-dashoffset", stroke->dash_offset);
    }
    text_add(t, "/>\n");
}

/* ---- clips: groups that end with canvas_restore() ---- */

void canvas_save(canvas *c)
{
    if (c->depth < MAX_DEPTH)
        c->groups[++c->depth] = 0;
}

void canvas_restore(canvas *c)
{
    for (; c->groups[c->depth] > 0; c->groups[c->depth]--)
        text_add(&c->file, "</g>\n");
    if (c->depth > 0)
        c->depth--;
}

void canvas_clip(canvas *c)
{
    text_addf(&c->file, "<clipPath id=\"clip%u\">", ++c->clips);
    add_path(c);
    text_addf(&c->file, "/></clipPath>\n<g clip-path=\"url(#clip%u)\">\n", c->clips);
    c->groups[c->depth]++;
}

/* ---- text and images ---- */

void canvas_text(canvas *c, double x, double y, double angle_rad, canvas_font font, canvas_color color,
                 const char *string)
{
    text *t = &c->file;
    text_add(t, "<text");
    add_attribute_px(t, "x", x);
    add_attribute_px(t, "y", y);
    if (angle_rad != 0.0) {
        text_addf(t, " transform=\"rotate(%.6g ", angle_rad * 57.29577951308232);
        add_px(t, x);
        text_add(t, " ");
        add_px(t, y);
        text_add(t, ")\"");
    }
    add_attribute_px(t, "font-size", font.size);
    if (font.is_bold)
        text_add(t, " font-weight=\"bold\"");
    add_attribute_px(t, "textLength", canvas_text_width(c, font, string));
    text_add(t, " lengthAdjust=\"spacingAndGlyphs\"");
    add_color(t, "fill", color);
    text_add(t, ">");
    text_add_html(t, string);
    text_add(t, "</text>\n");
}

/* premultiplied 0xAARRGGBB as straight RGBA. */
static void straighten(const uint32_t *from, size_t count, unsigned char *to)
{
    for (size_t i = 0; i < count; i++, to += 4) {
        const uint32_t alpha = from[i] >> 24;
        for (int k = 0; k < 3; k++) {
            const uint32_t value = from[i] >> (16 - 8 * k) & 255;
            const uint32_t straight = alpha ? (value * 255 + alpha / 2) / alpha : 0;
            to[k] = (unsigned char)(straight < 255 ? straight : 255);
        }
        to[3] = (unsigned char)alpha;
    }
}

void canvas_image(canvas *c, double x, double y, double width, double height, uint32_t *pixels,
                  uint32_t pixel_width, uint32_t pixel_height)
{
    image rgba;
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_result result =
        image_create(&c->desc.allocator, pixel_width, pixel_height, 4, IMAGE_U8, &rgba, NULL);
    if (result == FACET_OK) {
        rgba.is_srgb = true;
        straighten(pixels, (size_t)pixel_width * pixel_height, rgba.pixels);
        result = image_encode(&rgba, IMAGE_CODEC_PNG,
                              &(image_encode_desc){.allocator = c->desc.allocator, .compression = 1}, &bytes,
                              &size, NULL);
        image_destroy(&rgba);
    }
    if (result == FACET_OK) {
        text *t = &c->file;
        text_add(t, "<image preserveAspectRatio=\"none\"");
        add_attribute_px(t, "x", x);
        add_attribute_px(t, "y", y);
        add_attribute_px(t, "width", width);
        add_attribute_px(t, "height", height);
        text_add(t, " href=\"data:image/png;base64,");
        text_add_base64(t, bytes, size);
        text_add(t, "\"/>\n");
    }
    c->file.has_failed = c->file.has_failed || result != FACET_OK;
    mem_free(bytes);
}
