/* matte.c - see matte.h. */
#include "film/matte.h"

#include <stdio.h>
#include <string.h>

#include "base/hash.h"

static const struct {
    uint32_t aov;
    const char *name;
} kinds[MATTE_KINDS] = {{FACET_AOV_CRYPTO_OBJECT, "CryptoObject"},
                        {FACET_AOV_CRYPTO_MATERIAL, "CryptoMaterial"},
                        {FACET_AOV_CRYPTO_INSTANCE, "CryptoInstance"}};

matte_layers matte_find(film *f)
{
    matte_layers m = {.aovs = 0};
    for (uint32_t kind = 0; kind < MATTE_KINDS; kind++)
        for (uint32_t i = 0; i < MATTE_RANKS / 2; i++) {
            char name[32];
            snprintf(name, sizeof name, "%s%02u", kinds[kind].name, i);
            film_layer *layer = film_find(f, name);
            if (!layer)
                break;
            m.aovs |= kinds[kind].aov;
            m.pixels[kind][i] = layer->pixels;
        }
    return m;
}

void matte_clear(const matte_layers *m, size_t pixel_count)
{
    for (uint32_t kind = 0; kind < MATTE_KINDS; kind++)
        for (uint32_t i = 0; i < MATTE_RANKS / 2; i++)
            if (m->pixels[kind][i])
                memset(m->pixels[kind][i], 0, pixel_count * 4 * sizeof(float));
}

/* ---- a pixel ---- */

/* ID and coverage of a rank. */
static float *get_rank(const matte_layers *m, uint32_t kind, size_t pixel, uint32_t rank)
{
    return m->pixels[kind][rank / 2] + 4 * pixel + 2 * (rank % 2);
}

static void add_to(const matte_layers *m, uint32_t kind, size_t pixel, float id, float weight)
{
    float *smallest = get_rank(m, kind, pixel, 0);
    for (uint32_t rank = 0; rank < MATTE_RANKS; rank++) {
        float *r = get_rank(m, kind, pixel, rank);
        if (r[0] == 0.0f || r[0] == id) { /* 0 is not an ID */
            r[0] = id;
            r[1] += weight;
            return;
        }
        if (r[1] < smallest[1])
            smallest = r;
    }
    if (weight > smallest[1]) {
        smallest[0] = id;
        smallest[1] = weight;
    }
}

void matte_add(const matte_layers *m, size_t pixel, const float ids[MATTE_KINDS], float weight)
{
    for (uint32_t kind = 0; kind < MATTE_KINDS; kind++)
        if (m->pixels[kind][0] && weight != 0.0f)
            add_to(m, kind, pixel, ids[kind], weight);
}

/* Equal coverages are ordered by ID, so that nothing depends on the order of samples. */
static bool is_before(const float a[2], const float b[2])
{
    return a[1] > b[1] || (a[1] == b[1] && a[0] > b[0]);
}

static void sort_ranks(float ranks[MATTE_RANKS][2])
{
    for (uint32_t i = 1; i < MATTE_RANKS; i++) {
        float moved[2] = {ranks[i][0], ranks[i][1]};
        uint32_t k = i;
        for (; k > 0 && is_before(moved, ranks[k - 1]); k--)
            memcpy(ranks[k], ranks[k - 1], sizeof moved);
        memcpy(ranks[k], moved, sizeof moved);
    }
}

void matte_finish(const matte_layers *m, size_t pixel, float scale)
{
    for (uint32_t kind = 0; kind < MATTE_KINDS; kind++) {
        if (!m->pixels[kind][0])
            continue;
        float ranks[MATTE_RANKS][2];
        for (uint32_t rank = 0; rank < MATTE_RANKS; rank++) {
            const float *r = get_rank(m, kind, pixel, rank);
            float share = r[1] * scale;
            ranks[rank][1] = share > 0.0f ? (share < 1.0f ? share : 1.0f) : 0.0f;
            ranks[rank][0] = ranks[rank][1] > 0.0f ? r[0] : 0.0f;
        }
        sort_ranks(ranks);
        for (uint32_t rank = 0; rank < MATTE_RANKS; rank++)
            memcpy(get_rank(m, kind, pixel, rank), ranks[rank], sizeof ranks[rank]);
    }
}

/* ---- metadata ---- */

void matte_text_name(uint32_t kind, uint32_t i, char name[MATTE_TEXT_NAME_SIZE])
{
    static const char *const keys[MATTE_TEXTS] = {"name", "hash", "conversion", "manifest"};
    const char *layer = kinds[kind].name; /* the prefix: the first 7 digits of the hash of the layer's name */
    snprintf(name, MATTE_TEXT_NAME_SIZE, "cryptomatte/%.7x/%s", murmur3(layer, strlen(layer), 0) >> 4,
             keys[i]);
}

facet_result matte_describe(film *f, uint32_t kind, const char *manifest, const facet_allocator *allocator,
                            facet_error *error)
{
    const char *const values[MATTE_TEXTS] = {kinds[kind].name, "MurmurHash3_32", "uint32_to_float32",
                                             manifest};
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < MATTE_TEXTS && result == FACET_OK; i++) {
        char name[MATTE_TEXT_NAME_SIZE];
        matte_text_name(kind, i, name);
        result = film_add_text(f, name, values[i], allocator, error);
    }
    return result;
}
