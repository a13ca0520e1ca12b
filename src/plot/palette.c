/* palette.c - see palette.h. */
#include "plot/palette.h"

#include <math.h>

#define RGB(hex)                                                                                             \
    {                                                                                                        \
        ((hex) >> 16) / 255.0, ((hex) >> 8 & 0xff) / 255.0, ((hex)&0xff) / 255.0, 1.0                        \
    }

static const palette_theme LIGHT = {.background = RGB(0xffffff),
                                    .text = RGB(0x1b1d21),
                                    .muted_text = RGB(0x5b6068),
                                    .axis = RGB(0x6e737b),
                                    .grid = RGB(0xdfe2e6),
                                    .minor_grid = RGB(0xf0f1f3)};
static const palette_theme DARK = {.background = RGB(0x16181c),
                                   .text = RGB(0xeceef1),
                                   .muted_text = RGB(0xa4a9b2),
                                   .axis = RGB(0x8b9099),
                                   .grid = RGB(0x363a42),
                                   .minor_grid = RGB(0x25282e)};

const palette_theme *palette_get_theme(bool is_dark)
{
    return is_dark ? &DARK : &LIGHT;
}

/* Okabe and Ito 2008, "Color universal design", in an order in which neighbors differ in hue and
 * lightness; yellow, which is hard to see on white, is last and darker there. */
static const canvas_color ON_LIGHT[PALETTE_COUNT] = {RGB(0x0072b2), RGB(0xd55e00), RGB(0x009e73),
                                                     RGB(0xcc79a7), RGB(0x000000), RGB(0xe69f00),
                                                     RGB(0x56b4e9), RGB(0x8f8a00)};
/* The same hues, the darkest lifted to a contrast of 4.5 or more. */
static const canvas_color ON_DARK[PALETTE_COUNT] = {RGB(0x3f9fe0), RGB(0xf0772b), RGB(0x1fbf8f),
                                                    RGB(0xdd8fbb), RGB(0xffffff), RGB(0xe69f00),
                                                    RGB(0x8fd0f5), RGB(0xf0e442)};

/* Relative luminance of an sRGB color. */
static double luminance(canvas_color c)
{
    const double rgb[3] = {c.r, c.g, c.b}, weights[3] = {0.2126, 0.7152, 0.0722};
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
        sum += weights[i] * (rgb[i] <= 0.04045 ? rgb[i] / 12.92 : pow((rgb[i] + 0.055) / 1.055, 2.4));
    return sum;
}

double palette_contrast(canvas_color a, canvas_color b)
{
    const double la = luminance(a) + 0.05, lb = luminance(b) + 0.05;
    return la > lb ? la / lb : lb / la;
}

/* rgb, moved towards the text color until its contrast suffices. */
static canvas_color own_color(const float rgb[3], bool is_dark)
{
    const palette_theme *theme = palette_get_theme(is_dark);
    double own[3];
    for (int i = 0; i < 3; i++)
        own[i] = isfinite(rgb[i]) ? fmin(fmax((double)rgb[i], 0.0), 1.0) : 0.0;
    canvas_color color = {own[0], own[1], own[2], 1.0};
    for (double t = 0.1; t < 1.0 && palette_contrast(color, theme->background) < PALETTE_MIN_CONTRAST;
         t += 0.1)
        color = (canvas_color){own[0] + t * (theme->text.r - own[0]), own[1] + t * (theme->text.g - own[1]),
                               own[2] + t * (theme->text.b - own[2]), 1.0};
    return color;
}

canvas_color palette_color(const chart_style *style, bool is_dark)
{
    if (style->color < 0)
        return own_color(style->rgb, is_dark);
    return (is_dark ? ON_DARK : ON_LIGHT)[style->color % PALETTE_COUNT];
}

canvas_stroke palette_stroke(const chart_style *style, bool is_dark, double scale)
{
    /* in line widths; round caps lengthen strokes and shorten gaps by one width */
    static const double DASHES[4][4] = {{0.0}, {3.0, 3.6}, {0.01, 2.2}, {5.0, 2.6, 0.01, 2.6}};
    static const int COUNTS[4] = {0, 2, 2, 4};
    const int dash = (int)((unsigned)style->dash % 4);
    const double width =
        style->width > 0.0f && isfinite(style->width) ? fmin((double)style->width, 100.0) : 1.75;
    canvas_stroke stroke = {
        .color = palette_color(style, is_dark), .width = width * scale, .dash_count = COUNTS[dash]};
    if (dash == 2)
        stroke.width *= 1.2; /* dots have less ink than lines */
    for (int i = 0; i < COUNTS[dash]; i++)
        stroke.dash[i] = DASHES[dash][i] * stroke.width;
    return stroke;
}

/* Every fifth of the 256 colors of the published table. */
static const double VIRIDIS[][3] = {
    {0.267004, 0.004874, 0.329415}, {0.273809, 0.031497, 0.358853}, {0.278791, 0.062145, 0.386592},
    {0.281924, 0.089666, 0.412415}, {0.283197, 0.115680, 0.436115}, {0.282623, 0.140926, 0.457517},
    {0.280255, 0.165693, 0.476498}, {0.276194, 0.190074, 0.493001}, {0.270595, 0.214069, 0.507052},
    {0.263663, 0.237631, 0.518762}, {0.255645, 0.260703, 0.528312}, {0.246811, 0.283237, 0.535941},
    {0.237441, 0.305202, 0.541921}, {0.227802, 0.326594, 0.546532}, {0.218130, 0.347432, 0.550038},
    {0.208623, 0.367752, 0.552675}, {0.199430, 0.387607, 0.554642}, {0.190631, 0.407061, 0.556089},
    {0.182256, 0.426184, 0.557120}, {0.174274, 0.445044, 0.557792}, {0.166617, 0.463708, 0.558119},
    {0.159194, 0.482237, 0.558073}, {0.151918, 0.500685, 0.557587}, {0.144759, 0.519093, 0.556572},
    {0.137770, 0.537492, 0.554906}, {0.131172, 0.555899, 0.552459}, {0.125394, 0.574318, 0.549086},
    {0.121148, 0.592739, 0.544641}, {0.119423, 0.611141, 0.538982}, {0.121380, 0.629492, 0.531973},
    {0.128087, 0.647749, 0.523491}, {0.140210, 0.665859, 0.513427}, {0.157851, 0.683765, 0.501686},
    {0.180653, 0.701402, 0.488189}, {0.208030, 0.718701, 0.472873}, {0.239374, 0.735588, 0.455688},
    {0.274149, 0.751988, 0.436601}, {0.311925, 0.767822, 0.415586}, {0.352360, 0.783011, 0.392636},
    {0.395174, 0.797475, 0.367757}, {0.440137, 0.811138, 0.340967}, {0.487026, 0.823929, 0.312321},
    {0.535621, 0.835785, 0.281908}, {0.585678, 0.846661, 0.249897}, {0.636902, 0.856542, 0.216620},
    {0.688944, 0.865448, 0.182725}, {0.741388, 0.873449, 0.149561}, {0.793760, 0.880678, 0.120005},
    {0.845561, 0.887322, 0.099702}, {0.896320, 0.893616, 0.096335}, {0.945636, 0.899815, 0.112838},
    {0.993248, 0.906157, 0.143936}};

/* Catmull-Rom between b and c. */
static double cubic(double a, double b, double c, double d, double t)
{
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

canvas_color palette_viridis(double t)
{
    enum { LAST = sizeof VIRIDIS / sizeof *VIRIDIS - 1 };
    const double place = fmin(fmax(t, 0.0), 1.0) * LAST;
    const int i = place < LAST ? (int)place : LAST - 1;
    double rgb[3];
    for (int k = 0; k < 3; k++) {
        const double b = VIRIDIS[i][k], c = VIRIDIS[i + 1][k];
        const double a = i > 0 ? VIRIDIS[i - 1][k] : 2.0 * b - c;
        const double d = i + 2 <= LAST ? VIRIDIS[i + 2][k] : 2.0 * c - b;
        rgb[k] = cubic(a, b, c, d, place - i);
    }
    return (canvas_color){rgb[0], rgb[1], rgb[2], 1.0};
}
