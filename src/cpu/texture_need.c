/* texture_need.c - see texture_need.h. */
#include "cpu/texture_need.h"

#include "draw/material_plan.h"
#include "draw/ogl1_setup.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "scene/material_table.h"

#include "cpu/shading_hit.h"

enum {
    TRIANGLE_GRAIN = 1 << 12,
    BINS_PER_LOD = 4,
    BIN_COUNT = 17 * BINS_PER_LOD, /* lod 0 to 16; a texture has 15 mips */
    AREA_UNIT = 256,               /* per pixel: areas are added as integers, in any order */
    IGNORED_PIXELS = 4
};

/* A mip coarser than a part of the image needs is used where its error stays below ERROR_CODES, the root mean square
 * over the pixels that show the texture. An image and its next mip differ by 2 to 8 codes of 255 in most textures
 * (data/models), and by less once they are shaded. Interpolating from the coarser mip alone loses that difference times
 * the missing part of a level. */
static const float ERROR_CODES = 0.5f, CODES_PER_LOD = 8.0f;

/* Magnification by glass that is provided for, in mip levels. */
static const float MAGNIFIED_LODS = 1.0f;

/* Area in the image (pixels times AREA_UNIT) of the triangles that read a texture at a lod. */
typedef struct lod_histogram {
    _Atomic uint64_t bins[BIN_COUNT];
} lod_histogram;

/* One texture as one material reads it. */
typedef struct texture_reader {
    const scene_texture_ref *ref;
    float size[2];  /* texels; 0: reads as white */
    float lod_bias; /* of the footprint */
} texture_reader;

typedef struct need_job {
    const camera_rays *camera;
    const texture_need_desc *desc;
    const render_geometry *geometry;
    bool is_seen_anywhere; /* by refracted or reflected rays */
    texture_reader readers[SCENE_TEXTURE_SLOT_COUNT];
    uint32_t reader_count;
    lod_histogram *histograms; /* per texture */
} need_job;

/* ---- a triangle in the image ---- */

typedef struct projection {
    float x[3], y[3]; /* pixels */
    float nearest;    /* depth, m */
} projection;

/* False: a vertex is not in front of the camera. */
static bool project(const camera_rays *camera, const vec3 p[3], projection *out)
{
    out->nearest = INFINITY;
    for (int i = 0; i < 3; i++) {
        float d[3], at[2], depth;
        store3(p[i] - load3(camera->origin), d);
        if (!camera_rays_project(camera, d, at, &depth))
            return false;
        out->x[i] = at[0];
        out->y[i] = at[1];
        out->nearest = min(out->nearest, depth);
    }
    out->nearest = max(out->nearest, camera->near_m);
    return true;
}

static bool is_outside(const float v[3], float extent)
{
    return (v[0] < 0.0f && v[1] < 0.0f && v[2] < 0.0f) || (v[0] > extent && v[1] > extent && v[2] > extent);
}

/* Area in pixels; 0: outside of the image, or back-face culled. */
static float visible_area(const need_job *job, const projection *p)
{
    float area =
        0.5f * ((p->x[1] - p->x[0]) * (p->y[2] - p->y[0]) - (p->x[2] - p->x[0]) * (p->y[1] - p->y[0]));
    if (job->is_seen_anywhere)
        return fabsf(area);
    if (is_outside(p->x, (float)job->desc->width) || is_outside(p->y, (float)job->desc->height))
        return 0.0f;
    /* y points down: the front, counter-clockwise, has negative area. */
    float facing = job->geometry->is_mirrored ? area : -area;
    return job->geometry->is_double_sided ? fabsf(area) : max(facing, 0.0f);
}

/* ---- texels per metre ---- */

static void texel_edge(const texture_reader *reader, const float *uvs, uint32_t from, uint32_t to,
                       float out[2])
{
    float du = uvs[2 * (size_t)to] - uvs[2 * (size_t)from];
    float dv = uvs[2 * (size_t)to + 1] - uvs[2 * (size_t)from + 1];
    const float *m = reader->ref->transform;
    bool is_transformed = reader->ref->has_transform;
    out[0] = (is_transformed ? m[0] * du + m[1] * dv : du) * reader->size[0];
    out[1] = (is_transformed ? m[3] * du + m[4] * dv : dv) * reader->size[1];
}

/* Square of the smaller stretch of the map from the triangle (m) to texels, but at least a 16th of the
 * larger one, the limit of anisotropic filtering. The squared stretches are the eigenvalues of G^-1 T,
 * where G and T hold the dot products of the triangle's edges in space and in texels. */
static float least_density2(const float G[3], const float t1[2], const float t2[2])
{
    float T[3] = {t1[0] * t1[0] + t1[1] * t1[1], t1[0] * t2[0] + t1[1] * t2[1],
                  t2[0] * t2[0] + t2[1] * t2[1]};
    float det_G = G[0] * G[2] - G[1] * G[1];
    float cross_t = t1[0] * t2[1] - t1[1] * t2[0];
    float trace = (G[2] * T[0] - 2.0f * G[1] * T[1] + G[0] * T[2]) / det_G;
    float determinant = cross_t * cross_t / det_G;
    float largest = 0.5f * (trace + sqrt(max(trace * trace - 4.0f * determinant, 0.0f)));
    return largest > 0.0f ? max(determinant / largest, largest / 256.0f) : 0.0f;
}

static int bin_of_lod(float lod)
{
    return (int)(clamp(lod, 0.0f, 16.0f) * (float)BINS_PER_LOD);
}

static void count_triangles(void *context, size_t begin, size_t end)
{
    const need_job *job = context;
    const render_geometry *g = job->geometry;
    uint64_t areas[SCENE_TEXTURE_SLOT_COUNT][BIN_COUNT] = {{0}};
    for (size_t i = begin; i < end; i++) {
        const uint32_t *corner = render_geometry_triangle(g, (uint32_t)i);
        vec3 p[3];
        for (int k = 0; k < 3; k++) {
            float v[3];
            render_geometry_corner(g, corner[k], v);
            p[k] = load3(v);
        }
        vec3 e1 = p[1] - p[0];
        vec3 e2 = p[2] - p[0];
        float G[3] = {dot(e1, e1), dot(e1, e2), dot(e2, e2)};
        if (!(G[0] * G[2] - G[1] * G[1] > 0.0f))
            continue;
        projection projected;
        float area = INFINITY;
        float pixel = 0.0f;
        if (project(job->camera, p, &projected)) {
            area = visible_area(job, &projected);
            pixel = camera_rays_pixel_size(job->camera, projected.nearest);
        }
        if (!(area > 0.0f))
            continue;
        uint64_t weight = (uint64_t)(min(area, 1e9f) * (float)AREA_UNIT);
        for (uint32_t k = 0; k < job->reader_count; k++) {
            const texture_reader *reader = &job->readers[k];
            const float *uvs = g->primitive->texcoords[reader->ref->texcoord];
            float t1[2];
            float t2[2];
            texel_edge(reader, uvs, corner[0], corner[1], t1);
            texel_edge(reader, uvs, corner[0], corner[2], t2);
            float footprint2 = least_density2(G, t1, t2) * pixel * pixel;
            float lod = 0.5f * log2(max(footprint2, 1e-30f)) + reader->lod_bias;
            areas[k][bin_of_lod(lod)] += weight;
        }
    }
    for (uint32_t k = 0; k < job->reader_count; k++)
        for (int bin = 0; bin < BIN_COUNT; bin++)
            if (areas[k][bin])
                atomic_fetch_add(&job->histograms[job->readers[k].ref->texture].bins[bin], areas[k][bin]);
}

/* ---- readers ---- */

typedef struct reader_list {
    const facet_scene *scene;
    need_job *job;
    texture_use *uses;
    bool *must_be_whole; /* per texture */
    bool *is_exact;      /* per texture: no coarser mip may replace another */
} reader_list;

static void add_reader(reader_list *list, const scene_texture_ref *ref, bool as_color, float footprint)
{
    texture_use *use = &list->uses[ref->texture];
    const scene_texture *texture = &list->scene->textures[ref->texture];
    const render_geometry *g = list->job->geometry;
    use->is_read_as_color = use->is_read_as_color || as_color;
    use->is_read_as_data = use->is_read_as_data || !as_color;
    texture_reader reader = {
        .ref = ref, .lod_bias = log2f(footprint) - (list->job->is_seen_anywhere ? MAGNIFIED_LODS : 0.0f)};
    if (!texture_full_size(list->scene, ref->texture, reader.size))
        return;
    /* Points and lines have no footprint; a sampler may ignore it. */
    if (g->primitive->mode != SCENE_TRIANGLES || texture->mip_filter == SCENE_MIP_NONE ||
        ref->texcoord >= g->primitive->texcoord_count) {
        list->must_be_whole[ref->texture] = true;
        return;
    }
    if (texture->mip_filter == SCENE_MIP_NEAREST)
        reader.lod_bias -= 0.5f; /* rounded to the finer of two mips */
    list->job->readers[list->job->reader_count++] = reader;
}

static void add_legacy_readers(reader_list *list, const texture_need_desc *desc)
{
    const render_geometry *g = list->job->geometry;
    const legacy_material *m = g->legacy;
    uint32_t maps = ogl1_maps(g, desc->ogl1->variant);
    for (int i = 0; i < LEGACY_MAP_COUNT; i++) {
        legacy_map_slot slot = (legacy_map_slot)i;
        if (!(maps >> slot & 1))
            continue;
        bool is_opacity = slot == LEGACY_OPACITY_MAP || slot == LEGACY_DIFFUSE_MAP;
        list->is_exact[m->maps[slot].ref.texture] |= is_opacity && g->is_see_through;
        add_reader(list, &m->maps[slot].ref, ogl1_map_is_color(m, slot, desc->ogl1->is_linear),
                   is_opacity && g->is_see_through ? desc->opacity_footprint : desc->footprint);
        if (ogl1_map_is_spherical(m, slot))
            list->must_be_whole[m->maps[slot].ref.texture] = true;
    }
}

static void add_readers(reader_list *list, const texture_need_desc *desc)
{
    const render_geometry *g = list->job->geometry;
    const scene_material *m = g->material;
    list->job->reader_count = 0;
    if (g->legacy) {
        add_legacy_readers(list, desc);
        return;
    }
    uint32_t textures = material_plan_textures(g);
    if (desc->is_opacity_only)
        textures &= g->is_see_through ? 1u << SCENE_BASE_COLOR_TEXTURE : 0u;
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (textures >> slot & 1) {
            list->is_exact[m->textures[slot].texture] |=
                slot == SCENE_BASE_COLOR_TEXTURE && g->is_see_through;
            add_reader(list, &m->textures[slot], material_textures[slot].is_color,
                       slot == SCENE_BASE_COLOR_TEXTURE && g->is_see_through ? desc->opacity_footprint
                                                                             : desc->footprint);
        }
}

/* The finest relevant lod. */
static float min_lod(const lod_histogram *h)
{
    uint64_t area = 0;
    for (int bin = 0; bin < BIN_COUNT; bin++) {
        area += atomic_load(&h->bins[bin]);
        if (area > (uint64_t)IGNORED_PIXELS * AREA_UNIT)
            return (float)bin / (float)BINS_PER_LOD;
    }
    return (float)(BIN_COUNT - 1) / (float)BINS_PER_LOD;
}

/* The coarsest level whose error is allowed, though some of the area needs a finer one. */
static float allowed_lod(const lod_histogram *h)
{
    const float allowed = (ERROR_CODES / CODES_PER_LOD) * (ERROR_CODES / CODES_PER_LOD);
    for (int level = 16; level > 0; level--) {
        double area = 0.0, error = 0.0;
        for (int bin = 0; bin < BIN_COUNT; bin++) {
            const double a = (double)atomic_load(&h->bins[bin]);
            const double missing = (double)level - (double)bin / BINS_PER_LOD;
            area += a;
            error += missing > 0.0 ? a * missing * missing : 0.0;
        }
        if (error <= (double)allowed * area)
            return (float)level;
    }
    return 0.0f;
}

facet_result texture_need(const facet_scene *scene, const render_geometry_set *set, const camera_rays *camera,
                          const texture_need_desc *desc, const facet_allocator *allocator, texture_use *uses,
                          facet_error *error)
{
    lod_histogram *histograms = mem_zalloc(allocator, scene->texture_count, sizeof *histograms);
    bool *must_be_whole = mem_zalloc(allocator, scene->texture_count, 2 * sizeof *must_be_whole);
    bool *is_exact = must_be_whole ? must_be_whole + scene->texture_count : NULL;
    facet_result result = FACET_OK;
    if (!histograms || !must_be_whole) {
        result = fail_memory(error, "textures", scene->texture_count * sizeof *histograms);
        goto done;
    }
    memset(uses, 0, scene->texture_count * sizeof *uses);
    bool is_seen_anywhere = false;
    for (uint32_t i = 0; i < set->count; i++)
        is_seen_anywhere =
            is_seen_anywhere ||
            (!set->items[i].legacy && (material_plan_layers(set->items[i].material) & LAYER_TRANSMISSION));
    for (uint32_t i = 0; i < set->count; i++) {
        if (set->items[i].is_far_copy) /* nearer copies have the same material */
            continue;
        need_job job = {.camera = camera,
                        .desc = desc,
                        .geometry = &set->items[i],
                        .is_seen_anywhere = is_seen_anywhere,
                        .histograms = histograms};
        reader_list list = {
            .scene = scene, .job = &job, .uses = uses, .must_be_whole = must_be_whole, .is_exact = is_exact};
        add_readers(&list, desc);
        if (job.reader_count)
            parallel_for(desc->thread_count, job.geometry->primitive->index_count / 3, TRIANGLE_GRAIN,
                         count_triangles, &job);
    }
    for (uint32_t i = 0; i < scene->texture_count; i++)
        uses[i].min_lod = must_be_whole[i] ? 0.0f
                          : is_exact[i] || desc->keeps_all_texels
                              ? min_lod(&histograms[i])
                              : max(min_lod(&histograms[i]), allowed_lod(&histograms[i]));
done:
    mem_free(histograms);
    mem_free(must_be_whole);
    return result;
}
