/* gl_rays.c - see gl_rays.h. */
#include "gl/scene/gl_rays.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "draw/corner_slopes.h"
#include "gl/core/gl_api.h"
#include "gl/scene/gl_bvh.h"
#include "shade/lang/lang_c_load.h"

/* The texture, in texels of four floats: rays.glsl reads it. A texel for the header, two per node (the children of an
 * inner node are in sequence), TRIANGLE_TEXELS per triangle in the order of leaves, ROW_TEXELS per material. Integers are floats, exact up to 2^24. */
enum { WIDTH = 2048, TRIANGLE_TEXELS = 8, ROW_TEXELS = 8, FLOATS = 4 };

/* What a ray does at a material. */
typedef enum row_kind { ROW_OPAQUE, ROW_UNLIT, ROW_MASKED, ROW_BLENDED, ROW_WALL, ROW_VOLUME } row_kind;

/* ---- triangles ---- */

static bool is_traced(const render_geometry *g)
{
    return g->primitive->mode == SCENE_TRIANGLES && !g->legacy;
}

static size_t count_triangles(const gl_scene *scene)
{
    size_t count = 0;
    for (uint32_t i = 0; i < scene->geometries.count; i++)
        if (is_traced(&scene->geometries.items[i]))
            count += scene->geometries.items[i].primitive->index_count / 3;
    return count;
}

typedef struct source {
    uint32_t geometry, triangle;
} source;

static row_kind kind_of(const render_geometry *g, const material_plan *plan)
{
    if (g->is_see_through && g->material->alpha_mode == SCENE_ALPHA_BLEND)
        return ROW_BLENDED;
    if (plan->is_volume)
        return ROW_VOLUME;
    if (plan->lets_rays_through)
        return ROW_WALL;
    if (g->is_see_through)
        return ROW_MASKED;
    return g->is_lit ? ROW_OPAQUE : ROW_UNLIT;
}

/* Corners in world space, m, counter-clockwise from outside. */
static const uint32_t *corners_of(const render_geometry *g, uint32_t triangle, uint32_t corners[3], vec3 p[3])
{
    const uint32_t *in = g->primitive->indices + 3 * (size_t)triangle;
    for (int i = 0; i < 3; i++) {
        float at[3];
        corners[i] = in[g->is_mirrored && i ? 3 - i : i];
        mat4_transform_point(g->world, g->positions + 3 * (size_t)corners[i], at);
        p[i] = load3(at);
    }
    return corners;
}

static vec3 unit_normal(const render_geometry *g, uint32_t vertex, vec3 Ng)
{
    if (!g->normals)
        return Ng;
    vec3 n = load3(g->normals + 3 * (size_t)vertex);
    const float *m = g->normal_matrix;
    return normalize_or(vec3(dot(load3(m), n), dot(load3(m + 3), n), dot(load3(m + 6), n)), Ng);
}

static void put(float *texel, vec3 v, float w)
{
    store3(v, texel);
    texel[3] = w;
}

/* Coordinates of the base color's texture at a corner. */
static void put_texcoord(float *out, const render_geometry *g, uint32_t vertex)
{
    static const float identity[6] = {1, 0, 0, 0, 1, 0};
    const scene_texture_ref *ref = &g->material->textures[gl_material_sheet_slot(g->material)];
    const float *row = ref->has_transform ? ref->transform : identity;
    if (ref->texture == SCENE_NONE || ref->texcoord >= g->primitive->texcoord_count)
        return;
    const float *uv = g->primitive->texcoords[ref->texcoord] + 2 * (size_t)vertex;
    for (int i = 0; i < 2; i++)
        out[i] = row[3 * i] * uv[0] + row[3 * i + 1] * uv[1] + row[3 * i + 2];
}

/* A triangle: corner and edges for the intersection, the normals of its corners, texture coordinates. Three of the
 * fourth components are the mean of its vertex colors. */
static void put_triangle(float *out, const render_geometry *g, row_kind kind, uint32_t triangle)
{
    uint32_t corners[3];
    vec3 p[3], n[3], slopes[3], color = vec3(1.0f);
    corners_of(g, triangle, corners, p);
    vec3 Ng = normalize_or(cross(p[1] - p[0], p[2] - p[0]), vec3(0.0f, 0.0f, 1.0f));
    for (int i = 0; i < 3; i++)
        n[i] = unit_normal(g, corners[i], Ng);
    if (kind >= ROW_WALL) {
        corner_slopes(p, n, Ng, slopes);
        for (int i = 0; i < 3; i++)
            n[i] = Ng + slopes[i];
    }
    if (g->primitive->colors) {
        color = vec3(0.0f);
        for (int i = 0; i < 3; i++)
            color += load3(g->primitive->colors + 4 * (size_t)corners[i]) * (1.0f / 3.0f);
    }
    bool shows_back = g->is_double_sided || kind == ROW_VOLUME;
    put(out, p[0], (float)g->material_id);
    put(out + FLOATS, p[1] - p[0], shows_back ? 1.0f : 0.0f);
    put(out + 2 * FLOATS, p[2] - p[0], (float)kind);
    for (int i = 0; i < 3; i++) {
        put(out + (3 + i) * FLOATS, n[i], color[i]);
        put_texcoord(out + 6 * FLOATS + 2 * i, g, corners[i]);
    }
}

/* ---- materials ---- */

static float mean_of(const gl_material_set *materials, const scene_material *m, scene_texture_slot slot,
                     int c)
{
    float mean[4];
    gl_material_mean(materials, m, slot, mean);
    return mean[c];
}

static vec3 factor_of(const gl_material_set *materials, const scene_material *m, scene_texture_slot slot,
                      const float factor[3])
{
    return load3(factor) * vec3(mean_of(materials, m, slot, 0), mean_of(materials, m, slot, 1),
                                mean_of(materials, m, slot, 2));
}

/* How the opacity of a texel counts: at least the cutoff of a mask; -1: blended; 0: opaque. */
static float cutoff_of(const render_geometry *g)
{
    if (!g->is_see_through)
        return 0.0f;
    return g->material->alpha_mode == SCENE_ALPHA_BLEND ? -1.0f : g->material->alpha_cutoff;
}

/* A material: factors, of which those on its sheet (gl_material_sheet()) are multiplied by texels, the others by
 * the means of their textures. */
static void put_row(float *out, const gl_material_set *materials, const render_geometry *g,
                    const gl_material_sheet *sheet, vec3 place)
{
    const scene_material *m = g->material;
    const scene_texture_slot map = SCENE_METALLIC_ROUGHNESS_TEXTURE,
                             glossy = SCENE_SPECULAR_GLOSSINESS_TEXTURE;
    bool is_glossy = m->extensions & SCENE_SPECULAR_GLOSSINESS;
    float roughness =
        is_glossy ? 1.0f - m->glossiness * mean_of(materials, m, glossy, 3) : m->perceptual_roughness;
    float occlusion =
        1.0f + m->occlusion_strength * (mean_of(materials, m, SCENE_OCCLUSION_TEXTURE, 0) - 1.0f);
    bool scatters = m->extensions & SCENE_VOLUME_SCATTER;
    put(out, load3(m->base_color), m->transmission);
    put(out + FLOATS, load3(m->attenuation_color), fminf(m->attenuation_distance, 1e30f));
    put(out + 2 * FLOATS,
        vec3(m->ior, roughness, is_glossy ? 0.0f : m->metallic * mean_of(materials, m, map, 2)),
        cutoff_of(g));
    put(out + 3 * FLOATS, factor_of(materials, m, SCENE_EMISSIVE_TEXTURE, m->emissive) * m->emissive_strength,
        m->dispersion);
    put(out + 4 * FLOATS, factor_of(materials, m, SCENE_SPECULAR_COLOR_TEXTURE, m->specular_color),
        m->specular * mean_of(materials, m, SCENE_SPECULAR_TEXTURE, 3));
    put(out + 5 * FLOATS, scatters ? load3(m->multiscatter_color) : vec3(0.0f), m->scatter_anisotropy);
    put(out + 6 * FLOATS, vec3(m->thickness * g->scale, occlusion, m->base_color[3]),
        scene_material_has(m, SCENE_NORMAL_TEXTURE) || material_plan_layers(m) ? 1.0f : 0.0f);
    put(out + 7 * FLOATS, place, sheet->is_nearest ? 1.0f : 0.0f);
}

/* ---- the texture ---- */

typedef struct layout {
    size_t triangles, rows, end; /* first texels */
    size_t *sheets;              /* per material: the same; 0: not placed yet */
    gl_material_sheet *sizes;    /* per material */
} layout;

/* Places a sheet for each material that is traced. */
static void place_sheets(const gl_scene *scene, const gl_material_set *materials, layout *at)
{
    for (uint32_t i = 0; i < scene->geometries.count; i++) {
        const render_geometry *g = &scene->geometries.items[i];
        if (!is_traced(g) || at->sheets[g->material_id])
            continue;
        at->sizes[g->material_id] = gl_material_sheet_size(materials, g->material);
        at->sheets[g->material_id] = at->end;
        at->end += (size_t)at->sizes[g->material_id].width * at->sizes[g->material_id].height;
    }
}

/* A node, whose children are the pair of this number. */
static void put_node(float *out, const gl_bvh_node *n, size_t pair)
{
    put(out, load3(n->low), n->count ? (float)n->first : (float)pair);
    put(out + FLOATS, load3(n->high), (float)n->count);
}

/* The pairs of children in the order of their parents. Pair 0 is the root, and one that no ray hits. */
static void put_nodes(float *out, const gl_bvh *bvh)
{
    const gl_bvh_node *nodes = bvh->nodes;
    size_t pair = 1; /* of the next inner node */
    put_node(out, &nodes[0], 1);
    put(out + 2 * FLOATS, vec3(1e30f), 0.0f);
    put(out + 3 * FLOATS, vec3(1e30f), 1.0f);
    for (uint32_t i = 0; i < bvh->node_count; i++) {
        if (nodes[i].count)
            continue;
        uint32_t children[2] = {i + 1, nodes[i + 1].next};
        size_t below = pair + 1;
        for (int c = 0; c < 2; c++) {
            put_node(out + 4 * FLOATS * pair + 2 * FLOATS * c, &nodes[children[c]], below);
            below += (nodes[children[c]].next - children[c]) / 2; /* inner nodes of the subtree */
        }
        pair++;
    }
}

static void fill(const gl_scene *scene, const gl_material_set *materials, const source *sources,
                 const gl_bvh *bvh, layout *at, float *out)
{
    const render_geometry *items = scene->geometries.items;
    put(out, vec3((float)at->triangles, (float)at->rows, 0.0f), 0.0f);
    put_nodes(out + FLOATS, bvh);
    for (uint32_t i = 0; i < bvh->count; i++) {
        const source *s = &sources[bvh->order[i]];
        put_triangle(out + FLOATS * (at->triangles + TRIANGLE_TEXELS * (size_t)i), &items[s->geometry],
                     kind_of(&items[s->geometry], &scene->plans.items[s->geometry]), s->triangle);
    }
    for (uint32_t i = 0; i < scene->geometries.count; i++) {
        uint32_t m = items[i].material_id;
        if (!is_traced(&items[i]) || !at->sizes[m].width)
            continue;
        put_row(out + FLOATS * (at->rows + ROW_TEXELS * (size_t)m), materials, &items[i], &at->sizes[m],
                vec3((float)at->sheets[m], (float)at->sizes[m].width, (float)at->sizes[m].height));
        gl_material_sheet_read(materials, items[i].material, &at->sizes[m], out + FLOATS * at->sheets[m]);
        at->sizes[m].width = 0; /* done */
    }
}

static facet_result upload(gl_rays *r, const float *texels, size_t height, facet_error *error)
{
    if (!r->texture)
        glGenTextures(1, &r->texture);
    gl_rays_bind(r);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, WIDTH, (GLsizei)height, 0, GL_RGBA, GL_FLOAT, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return gl_context_check(r->context, "triangles for rays", error);
}

/* sources and their boxes, lowest and highest corner. */
static void find_boxes(const gl_scene *scene, source *sources, float *boxes)
{
    size_t count = 0;
    for (uint32_t i = 0; i < scene->geometries.count; i++) {
        const render_geometry *g = &scene->geometries.items[i];
        for (uint32_t k = 0; is_traced(g) && k < g->primitive->index_count / 3; k++, count++) {
            uint32_t corners[3];
            vec3 p[3];
            corners_of(g, k, corners, p);
            sources[count] = (source){i, k};
            store3(min(min(p[0], p[1]), p[2]), boxes + 6 * count);
            store3(max(max(p[0], p[1]), p[2]), boxes + 6 * count + 3);
        }
    }
}

static facet_result make_texture(gl_rays *r, const gl_scene *scene, const gl_material_set *materials,
                                 const source *sources, const gl_bvh *bvh, facet_error *error)
{
    size_t material_count = (size_t)scene->scene->material_count + 1, size = 0;
    layout at = {.triangles = 1 + 2 * ((size_t)bvh->node_count + 1),
                 .sheets = mem_zalloc(&r->allocator, material_count, sizeof *at.sheets),
                 .sizes = mem_zalloc(&r->allocator, material_count, sizeof *at.sizes)};
    float *texels = NULL;
    at.rows = at.triangles + TRIANGLE_TEXELS * (size_t)bvh->count;
    at.end = at.rows + ROW_TEXELS * material_count;
    if (at.sheets && at.sizes) {
        place_sheets(scene, materials, &at);
        size = (at.end + WIDTH - 1) / WIDTH * WIDTH;
        texels = mem_zalloc(&r->allocator, size, FLOATS * sizeof *texels);
    }
    facet_result result = FACET_OK;
    if (texels) {
        fill(scene, materials, sources, bvh, &at, texels);
        result = upload(r, texels, size / WIDTH, error);
    } else {
        result = fail_memory(error, "triangles for rays", size * FLOATS * sizeof *texels);
    }
    mem_free(texels);
    mem_free(at.sheets);
    mem_free(at.sizes);
    return result;
}

static facet_result build(gl_rays *r, const gl_scene *scene, const gl_material_set *materials, size_t count,
                          facet_error *error)
{
    gl_bvh bvh = {.nodes = NULL};
    source *sources = mem_alloc(&r->allocator, count, sizeof *sources);
    float *boxes = mem_alloc(&r->allocator, count, 6 * sizeof *boxes);
    facet_result result = FACET_OK;
    if (!sources || !boxes)
        result = fail_memory(error, "triangles for rays", count * 6 * sizeof *boxes);
    if (result == FACET_OK) {
        find_boxes(scene, sources, boxes);
        result = gl_bvh_build(boxes, (uint32_t)count, &r->allocator, &bvh, error);
    }
    mem_free(boxes);
    if (result == FACET_OK)
        result = make_texture(r, scene, materials, sources, &bvh, error);
    mem_free(sources);
    gl_bvh_destroy(&bvh);
    return result;
}

/* ---- all ---- */

facet_result gl_rays_update(gl_rays *r, const gl_scene *scene, const gl_material_set *materials,
                            bool is_needed, const facet_log *log, facet_error *error)
{
    if (!is_needed || r->revision == scene->revision)
        return FACET_OK;
    size_t count = count_triangles(scene);
    r->is_ready = false;
    if (count > GL_RAYS_MAX_TRIANGLES && !r->is_reported)
        log_warning(log, "%s: OpenGL traces no rays through glass: %zu triangles, more than %d",
                    scene->scene->source, count, (int)GL_RAYS_MAX_TRIANGLES);
    r->is_reported |= count > GL_RAYS_MAX_TRIANGLES;
    if (count > 0 && count <= GL_RAYS_MAX_TRIANGLES) {
        TRY(build(r, scene, materials, count, error));
        r->is_ready = true;
    }
    r->revision = scene->revision;
    return FACET_OK;
}

uint64_t gl_rays_features(const gl_rays *r, bool traces)
{
    return r->is_ready ? gl_program_feature(GL_MAIN_SURFACE, traces ? "IS_TRACING" : "IS_TRACED") : 0;
}

void gl_rays_bind(const gl_rays *r)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_RAYS);
    glBindSampler(GL_UNIT_RAYS, 0);
    glBindTexture(GL_TEXTURE_2D, r->texture);
}

facet_result gl_rays_draw_depth(gl_programs *programs, const gl_mesh_set *meshes,
                                const gl_material_set *materials, gl_pass pass, facet_error *error)
{
    uint32_t count, program;
    const gl_batch *batches = gl_mesh_batches(meshes, pass, &count);
    TRY(gl_programs_get(programs, (gl_program_key){GL_MAIN_SHADOW, 0}, &program, error));
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside || batches[i].geometry->is_see_through)
            continue;
        gl_material_bind(materials, &batches[i]);
        glUseProgram(program);
        gl_mesh_draw(meshes, &batches[i]);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    return FACET_OK;
}

void gl_rays_destroy(gl_rays *r)
{
    if (r->texture)
        glDeleteTextures(1, &r->texture);
    *r = (gl_rays){.context = r->context, .allocator = r->allocator};
}
