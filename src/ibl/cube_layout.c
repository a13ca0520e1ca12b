/* cube_layout.c - see cube_layout.h. */
#include "ibl/cube_layout.h"

#include <string.h>

#include "base/result.h"
#include "ibl/sphere.h"

/* A layout of six faces: the cell of each in a grid of columns x rows, and whether it is rotated by 180
 * degrees. */
typedef struct unfolding {
    uint32_t columns, rows;
    struct {
        unsigned char column, row;
        bool is_turned;
    } faces[6];
    const char *name;
} unfolding;

static const unfolding unfoldings[] = {
    [FACET_LAYOUT_CROSS_HORIZONTAL] = {4,
                                       3,
                                       {{2, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 2, 0}, {1, 1, 0}, {3, 1, 0}},
                                       "a horizontal cross (4:3)"},
    [FACET_LAYOUT_CROSS_VERTICAL] = {3,
                                     4,
                                     {{2, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 2, 0}, {1, 1, 0}, {1, 3, 1}},
                                     "a vertical cross (3:4)"},
    [FACET_LAYOUT_STRIP_HORIZONTAL] = {6,
                                       1,
                                       {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}},
                                       "a horizontal strip (6:1)"},
    [FACET_LAYOUT_STRIP_VERTICAL] = {1,
                                     6,
                                     {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 3, 0}, {0, 4, 0}, {0, 5, 0}},
                                     "a vertical strip (1:6)"},
    [FACET_LAYOUT_FACES] = {0},
};

static const unfolding *find_unfolding(facet_layout layout)
{
    return (unsigned)layout <= FACET_LAYOUT_FACES && unfoldings[layout].columns ? &unfoldings[layout] : NULL;
}

bool layout_is_faces(facet_layout layout)
{
    return find_unfolding(layout) || layout == FACET_LAYOUT_FACES;
}

facet_layout layout_detect(uint32_t width, uint32_t height)
{
    if (width == 2 * (uint64_t)height)
        return FACET_LAYOUT_EQUIRECTANGULAR;
    for (int i = FACET_LAYOUT_CROSS_HORIZONTAL; i <= FACET_LAYOUT_STRIP_VERTICAL; i++)
        if ((uint64_t)width * unfoldings[i].rows == (uint64_t)height * unfoldings[i].columns &&
            width % unfoldings[i].columns == 0)
            return (facet_layout)i;
    return FACET_LAYOUT_AUTO;
}

facet_result layout_check(facet_layout layout, uint32_t width, uint32_t height, const char *name,
                          facet_error *error)
{
    const unfolding *u = find_unfolding(layout);
    bool fits = u ? width % u->columns == 0 && height % u->rows == 0 && width / u->columns == height / u->rows
                  : layout != FACET_LAYOUT_OCTAHEDRAL || width == height;
    if (fits && width && height)
        return FACET_OK;
    return fail(error, FACET_ERROR_INVALID, "%s: %u x %u texels are not %s", name, width, height,
                u ? u->name : "an octahedral image (1:1)");
}

/* Position in the image of texel (x, y) of a face. */
static size_t unfolded_texel(const unfolding *u, uint32_t size, uint32_t face, uint32_t x, uint32_t y)
{
    if (u->faces[face].is_turned) {
        x = size - 1 - x;
        y = size - 1 - y;
    }
    return ((size_t)u->faces[face].row * size + y) * u->columns * size +
           (size_t)u->faces[face].column * size + x;
}

/* ---- reading ---- */

static void read_faces(const image *panorama, const unfolding *u, cube *c)
{
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < c->size; y++)
            for (uint32_t x = 0; x < c->size; x++) {
                const float *from = (const float *)panorama->pixels +
                                    panorama->channel_count * unfolded_texel(u, c->size, face, x, y);
                *cube_texel(c, face, (int)x, (int)y) = (rgbx){from[0], from[1], from[2], 0.0f};
            }
}

facet_result layout_read(const image *panorama, facet_layout layout, const char *name,
                         const facet_allocator *allocator, uint32_t thread_count, cube *out,
                         facet_error *error)
{
    *out = (cube){0};
    if (layout == FACET_LAYOUT_AUTO)
        layout = layout_detect(panorama->width, panorama->height);
    if (layout == FACET_LAYOUT_AUTO || layout == FACET_LAYOUT_FACES)
        return fail(error, FACET_ERROR_INVALID, "%s: %u x %u texels do not fit any layout of a cube map",
                    name, panorama->width, panorama->height);
    TRY(layout_check(layout, panorama->width, panorama->height, name, error));
    const unfolding *u = find_unfolding(layout);
    facet_result result =
        cube_create(u ? panorama->width / u->columns : (panorama->height + 1) / 2, allocator, out, error);
    if (result == FACET_OK && u) {
        read_faces(panorama, u, out);
    } else if (result == FACET_OK) {
        sphere source = sphere_of_image(
            layout == FACET_LAYOUT_OCTAHEDRAL ? SPHERE_OCTAHEDRON : SPHERE_EQUIRECT, panorama);
        sphere target = sphere_of_cube(out);
        result = sphere_resample(&source, NULL, allocator, thread_count, &target, error);
    }
    if (result == FACET_OK)
        cube_fill_borders(out);
    else
        cube_destroy(out);
    return result;
}

static void swap_texels(image *i, size_t a, size_t b)
{
    unsigned char kept[16];
    const size_t size = image_texel_size(i);
    unsigned char *first = (unsigned char *)i->pixels + a * size,
                  *second = (unsigned char *)i->pixels + b * size;
    memcpy(kept, first, size);
    memcpy(first, second, size);
    memcpy(second, kept, size);
}

/* ImfEnvmap.h: +Y and -Y have +X to the right and are flipped vertically compared to OpenGL; the other faces
 * are mirrored. */
void layout_flip_inside_faces(image *strip)
{
    const size_t n = strip->width;
    for (size_t face = 0; face < 6; face++) {
        const bool is_pole = face == 2 || face == 3;
        const size_t first = face * n * n;
        for (size_t y = 0; y < (is_pole ? n / 2 : n); y++)
            for (size_t x = 0; x < (is_pole ? n : n / 2); x++)
                swap_texels(strip, first + y * n + x,
                            first + (is_pole ? (n - 1 - y) * n + x : y * n + n - 1 - x));
    }
}

/* ---- writing ---- */

static void write_faces(const cube *c, const unfolding *u, image *out)
{
    memset(out->pixels, 0, out->height * image_row_size(out));
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < c->size; y++)
            for (uint32_t x = 0; x < c->size; x++) {
                rgbx texel = *cube_texel(c, face, (int)x, (int)y);
                texel[3] = 1.0f;
                ((rgbx *)out->pixels)[unfolded_texel(u, c->size, face, x, y)] = texel;
            }
}

facet_result layout_write(const cube *c, facet_layout layout, uint32_t height,
                          const facet_allocator *allocator, uint32_t thread_count, image *out,
                          facet_error *error)
{
    *out = (image){0};
    const unfolding *u = find_unfolding(layout);
    if (!u && layout != FACET_LAYOUT_EQUIRECTANGULAR && layout != FACET_LAYOUT_OCTAHEDRAL)
        return fail(error, FACET_ERROR_ARGUMENT, "layout %d does not fit in one image", (int)layout);
    height = u ? u->rows * c->size : height ? height : 2 * c->size;
    uint32_t width = u ? u->columns * c->size : layout == FACET_LAYOUT_OCTAHEDRAL ? height : 2 * height;
    if (height > UINT32_MAX / 2)
        return fail(error, FACET_ERROR_ARGUMENT, "an image of %u rows is not written", height);
    TRY(image_create(allocator, width, height, 4, IMAGE_F32, out, error));
    if (u) {
        write_faces(c, u, out);
        return FACET_OK;
    }
    cube faces = *c;
    sphere source = sphere_of_cube(&faces);
    sphere target =
        sphere_of_image(layout == FACET_LAYOUT_OCTAHEDRAL ? SPHERE_OCTAHEDRON : SPHERE_EQUIRECT, out);
    facet_result result = sphere_resample(&source, NULL, allocator, thread_count, &target, error);
    if (result != FACET_OK)
        image_destroy(out);
    return result;
}
