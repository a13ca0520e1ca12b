/* part_split.c - the pixels and samples of a part. */
#include "base/result.h"
#include "path/path_film.h"
#include "render/part.h"

enum { GRID = 16 }; /* pixels: the tiles of the path tracer */

static uint32_t cells_of(uint32_t size)
{
    return (size + GRID - 1) / GRID;
}

static uint32_t limit(uint32_t x, uint32_t least, uint32_t most)
{
    return x < least ? least : x > most ? most : x;
}

/* Reduces the rectangle r to part index of count, by halving its longer side again and again, in proportion to the
 * parts on either side. It has at least count cells of the grid. */
static void halve(uint32_t r[4], uint32_t index, uint32_t count)
{
    while (count > 1) {
        int side = r[2] >= r[3] ? 0 : 1;
        uint32_t cells = cells_of(r[2 + side]), across = cells_of(r[3 - side]);
        uint32_t parts = count / 2;
        uint32_t first = limit((uint32_t)(((uint64_t)cells * parts + count / 2) / count), 1, cells - 1);
        uint64_t room = (uint64_t)(cells - first) * across;
        uint32_t least = room < count ? count - (uint32_t)room : 0;
        uint64_t most = (uint64_t)first * across;
        parts = limit(parts, least, most < count ? (uint32_t)most : count);
        uint32_t size = first * GRID;
        if (index < parts) {
            r[2 + side] = size;
            count = parts;
        } else {
            r[side] += size;
            r[2 + side] -= size;
            index -= parts;
            count -= parts;
        }
    }
}

static facet_result check(const facet_render_desc *d, facet_error *error)
{
    const facet_part_desc *p = &d->part;
    const renderer_row *r = renderer_get(d->renderer);
    bool is_path = r->info.features & FACET_RENDERER_FEATURE_PATH;
    if (p->index >= p->count || (unsigned)p->split > FACET_PART_SPLIT_SAMPLES)
        return fail(error, FACET_ERROR_ARGUMENT, "part: %u of %u, split %d: there is no such part", p->index,
                    p->count, (int)p->split);
    if (r->info.features & FACET_RENDERER_FEATURE_GL)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "part: OpenGL does not render parts of an image; use the preview or path tracing");
    if (d->path.noise > 0.0f && is_path)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "part: with adaptive sampling (noise) the samples of a pixel depend on pixels of other "
                    "parts; leave it "
                    "out");
    if (p->split == FACET_PART_SPLIT_TILES)
        return FACET_OK;
    if (!is_path)
        return fail(error, FACET_ERROR_ARGUMENT, "part: only path tracing is divided by samples");
    if (d->aovs & FACET_AOV_CRYPTOMATTE)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "part: the ranks of Cryptomatte depend on all samples of a pixel; divide the image into tiles");
    return FACET_OK;
}

facet_result part_narrow(const facet_render_desc *whole, facet_render_desc *part, facet_error *error)
{
    const facet_part_desc *p = &whole->part;
    uint64_t cells = (uint64_t)cells_of(whole->crop[2]) * cells_of(whole->crop[3]);
    TRY(check(whole, error));
    *part = *whole;
    part->path.keeps_cancelled = false;
    part->path.pass = NULL;
    if (p->split == FACET_PART_SPLIT_SAMPLES) {
        if (p->count > whole->samples)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "an image of %u samples per pixel has at most that many parts, not %u",
                        whole->samples, p->count);
        return FACET_OK;
    }
    if (p->count > cells)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "an image of %u x %u pixels has at most %llu parts, of %d x %d pixels, not %u",
                    whole->crop[2], whole->crop[3], (unsigned long long)cells, (int)GRID, (int)GRID,
                    p->count);
    halve(part->crop, p->index, p->count);
    return FACET_OK;
}

uint32_t part_aovs(const facet_render_desc *desc)
{
    bool is_path = renderer_get(desc->renderer)->info.features & FACET_RENDERER_FEATURE_PATH;
    return is_path ? desc->aovs & ~(uint32_t)PATH_FILM_AOVS : desc->aovs;
}
