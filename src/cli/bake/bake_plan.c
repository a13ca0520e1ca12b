/* bake_plan.c - which cube maps facet bake makes and which files become of them. */
#define _DEFAULT_SOURCE
#include "cli/bake/bake_plan.h"

#include "cli/bake/bake_layout.h"
#include "cli/bake/bake_names.h"
#include "cli/shared/failure.h"
#include "cli/shared/output_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- lists ---- */

uint32_t bake_plan_add_cube(bake_plan *plan, const facet_bake_desc *desc, bool is_verified)
{
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        const facet_bake_desc *d = &plan->cubes[i].desc;
        if (d->lobe == desc->lobe && d->size == desc->size && d->level_count == desc->level_count &&
            d->mapping == desc->mapping) {
            plan->cubes[i].is_verified = plan->cubes[i].is_verified || is_verified;
            return i;
        }
    }
    plan->cubes[plan->cube_count] = (bake_cube){.desc = *desc, .is_verified = is_verified};
    return plan->cube_count++;
}

bake_file *bake_plan_add_file(bake_plan *plan, const char *path, const bake_file *what)
{
    if (plan->file_count == plan->file_capacity) {
        size_t capacity = plan->file_capacity ? 2 * plan->file_capacity : 16;
        bake_file *grown = realloc(plan->files, capacity * sizeof *grown);
        if (!grown)
            return NULL;
        plan->files = grown;
        plan->file_capacity = capacity;
    }
    char *copy = strdup(path);
    if (!copy)
        return NULL;
    bake_file *file = &plan->files[plan->file_count++];
    *file = *what;
    file->path = copy;
    return file;
}

void bake_plan_destroy(bake_plan *plan)
{
    for (size_t i = 0; i < plan->file_count; i++) {
        bake_file *file = &plan->files[i];
        if (file->is_text)
            free(file->bytes);
        else
            facet_bytes_destroy(file->bytes);
        free(file->path);
    }
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        facet_cube_destroy(plan->cubes[i].cube);
        facet_cube_destroy(plan->cubes[i].mirrored);
    }
    for (size_t i = 0; i < plan->folder_count; i++)
        free(plan->folders[i]);
    free(plan->files);
    *plan = (bake_plan){0};
}

/* ---- what is asked for ---- */

static facet_result add(bake_plan *plan, const char *path, const bake_file *what, facet_error *error)
{
    return bake_plan_add_file(plan, path, what) ? FACET_OK
                                                : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
}

/* The pictures of a cube map: one per level, or six. */
static facet_result add_pictures(const bake_options *o, bake_plan *plan, const char *pattern,
                                 const char *stem, bake_file what, facet_error *error)
{
    const uint32_t level_count = plan->cubes[what.cube].desc.level_count;
    const bool has_faces =
        o->has_projection ? o->projection == FACET_LAYOUT_FACES : bake_name_has_face(pattern);
    const bool is_stdout = strcmp(pattern, "-") == 0;
    const bool is_one_level = level_count > 1 && o->level >= 0; /* --level; irradiance has one anyway */
    const bool has_levels = level_count > 1 && !is_one_level;
    facet_result result = FACET_OK;
    if (is_stdout && (has_levels || has_faces))
        return fail(error, FACET_ERROR_ARGUMENT,
                    has_faces ? "--output: standard output takes one picture, not faces"
                              : "--output: standard output takes one picture; say "
                                "which with --level, or --format ktx2 for all");
    if (!has_faces && bake_name_has_face(pattern))
        return fail(error, FACET_ERROR_ARGUMENT, "--projection: \"%s\" has a place for a {face}; faces",
                    pattern);
    for (uint32_t level = 0; level < level_count && result == FACET_OK; level++)
        for (int face = has_faces ? 0 : -1; face < (has_faces ? 6 : 0) && result == FACET_OK; face++) {
            char name[BAKE_NAME_SIZE] = "-";
            if (is_one_level && level != (uint32_t)o->level)
                continue;
            if (!is_stdout && !bake_name_expand(pattern, stem, (int)level, has_levels, face, name))
                return fail(error, FACET_ERROR_ARGUMENT, "--output: the name \"%.100s..\" is too long",
                            pattern);
            what.content = has_faces ? BAKE_FACE : BAKE_LEVEL;
            what.projection = o->projection;
            what.level = level;
            what.face = has_faces ? (uint32_t)face : 0;
            result = add(plan, name, &what, error);
        }
    return result;
}

/* A cube map that is to be written to pattern. */
typedef struct wanted_cube {
    const char *option; /* "--diffuse" */
    const char *pattern;
    facet_bake_desc desc;
    bool is_main; /* --format says what it is */
} wanted_cube;

static facet_result check_container(const bake_options *o, const wanted_cube *w, bake_container container,
                                    facet_error *error)
{
    if (container == CONTAINER_KTX1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: \"%s\": KTX 1 is written by --layout filament; otherwise .ktx2 was expected",
                    w->option, w->pattern);
    if (container != CONTAINER_KTX2 && !(container >= CONTAINER_EXR && container <= CONTAINER_PNG))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" does not end in .ktx2, .exr, .hdr, .pfm or .png",
                    w->option, w->pattern);
    if (container == CONTAINER_PNG && o->rgbm_range <= 0.0f)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: PNG holds numbers up to 1 only; give --rgbm RANGE, or write .ktx2, .exr or .hdr "
                    "(a picture to look at: --preview)",
                    w->option);
    if (container != CONTAINER_KTX2 && w->is_main && o->has_texels)
        return fail(error, FACET_ERROR_ARGUMENT, "--format: texels are chosen of .ktx2 files, not of \"%s\"",
                    w->pattern);
    return FACET_OK;
}

static facet_result add_cube_files(const bake_options *o, bake_plan *plan, const char *stem,
                                   const wanted_cube *w, facet_error *error)
{
    const bool is_stdout = strcmp(w->pattern, "-") == 0;
    const bool is_verified = o->is_verified && w->desc.lobe != FACET_LOBE_NONE;
    char name[BAKE_NAME_SIZE] = "-";
    bake_container container = bake_container_of(w->pattern);
    if (w->is_main && o->container)
        container = o->container;
    else if (is_stdout)
        container = CONTAINER_KTX2;
    facet_result result = check_container(o, w, container, error);
    if (result != FACET_OK)
        return result;
    const bake_file what = {.container = container,
                            .content = BAKE_CUBE,
                            .cube = bake_plan_add_cube(plan, &w->desc, is_verified),
                            .texels = o->has_texels ? o->texels : FACET_TEXEL_FORMAT_RGBA16F,
                            .table_channel = -1};
    if (container != CONTAINER_KTX2)
        return add_pictures(o, plan, w->pattern, stem, what, error);
    if (!is_stdout && !bake_name_expand(w->pattern, stem, -1, false, -1, name))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the name \"%.100s..\" is too long", w->option,
                    w->pattern);
    return add(plan, name, &what, error);
}

/* --sh and --preview. */
static facet_result add_one(bake_plan *plan, const char *place, const char *pattern, const char *stem,
                            const char *expected, bake_container first, bake_container last, bake_file what,
                            facet_error *error)
{
    char name[BAKE_NAME_SIZE];
    what.container = bake_container_of(pattern);
    what.table_channel = -1;
    if (what.container < first || what.container > last)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" does not end in %s", place, pattern, expected);
    if (!bake_name_expand(pattern, stem, -1, false, -1, name))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the name \"%.100s..\" is too long", place, pattern);
    return add(plan, name, &what, error);
}

static facet_result add_side_files(const bake_options *o, bake_plan *plan, const char *stem,
                                   facet_error *error)
{
    wanted_cube sheen = {.option = "--sheen", .pattern = o->sheen, .desc = o->bake};
    wanted_cube diffuse = {.option = "--diffuse", .pattern = o->diffuse, .desc = o->bake};
    facet_result result = FACET_OK;
    sheen.desc.lobe = FACET_LOBE_CHARLIE;
    diffuse.desc.lobe = FACET_LOBE_LAMBERT;
    diffuse.desc.size = o->bake.size < 64 ? o->bake.size : 64;
    diffuse.desc.level_count = 1;
    if (o->sheen && o->bake.lobe == FACET_LOBE_LAMBERT)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--sheen: beside --lobe lambert it would have one level, too; write irradiance with "
                    "--diffuse FILE");
    if (o->sheen)
        result = add_cube_files(o, plan, stem, &sheen, error);
    if (result == FACET_OK && o->diffuse)
        result = add_cube_files(o, plan, stem, &diffuse, error);
    if (result == FACET_OK && o->sh)
        result = add_one(plan, "--sh", o->sh, stem, ".json, .h or .txt", CONTAINER_JSON, CONTAINER_TEXT,
                         (bake_file){.content = BAKE_SH}, error);
    if (result == FACET_OK && o->preview)
        result = add_one(
            plan, "--preview", o->preview, stem, ".png, .jpg or .webp", CONTAINER_PNG, CONTAINER_WEBP,
            (bake_file){.content = BAKE_SHEET, .cube = bake_plan_add_cube(plan, &o->bake, o->is_verified)},
            error);
    plan->has_sh = plan->has_sh || o->sh;
    return result;
}

static facet_texel_format table_texels(facet_dfg_kind kind)
{
    static const facet_texel_format by_channels[] = {FACET_TEXEL_FORMAT_R16F, FACET_TEXEL_FORMAT_RG16F,
                                                     FACET_TEXEL_FORMAT_RGBA16F};
    return by_channels[facet_dfg_get_channel_count(kind) - 1];
}

static facet_result add_table(const bake_options *o, bake_plan *plan, const char *path, facet_error *error)
{
    bake_file what = {.content = BAKE_TABLE,
                      .container = o->container ? o->container : bake_container_of(path),
                      .texels = o->has_texels ? o->texels : table_texels(o->table),
                      .table = o->table,
                      .table_channel = -1};
    if (o->has_texels && strcmp(path, "-") == 0)
        what.container = CONTAINER_KTX2;
    switch (what.container) {
    case CONTAINER_KTX2:
    case CONTAINER_EXR:
    case CONTAINER_EXR_FLOAT:
    case CONTAINER_PFM:
    case CONTAINER_PNG:
    case CONTAINER_HEADER:
        break;
    default:
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: a table is .ktx2, .exr, .png (16 bits), .pfm or .h, not \"%s\"", path);
    }
    if (o->has_texels && what.container != CONTAINER_KTX2)
        return fail(error, FACET_ERROR_ARGUMENT, "--format: texels are chosen of .ktx2 files, not of \"%s\"",
                    path);
    return add(plan, path, &what, error);
}

/* What outputs are called after. */
static bool find_stem(const bake_options *o, char *stem, size_t size)
{
    const char *name = o->is_table ? "dfg" : o->has_faces ? "cube" : bake_input_name(o);
    if (!o->is_table && !o->has_faces && o->environment.kind == ENVIRONMENT_FACES)
        name = "cube";
    return output_name_stem(name, stem, size);
}

/* Outputs whose names say something that they do not mean. */
static facet_result check_patterns(const bake_options *o, facet_error *error)
{
    const char *const patterns[] = {o->output, o->diffuse, o->sheen, o->sh, o->preview};
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        size_t length = 0;
        const char *unknown = patterns[i] ? bake_name_find_unknown(patterns[i], &length) : NULL;
        if (unknown)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "bake: \"%.200s\": %.*s stands for nothing; {stem}, {level} and {face} do",
                        patterns[i], (int)(length < 40 ? length : 40), unknown);
    }
    if (o->layout != BAKE_LAYOUT_NONE && o->output && bake_container_of(o->output) != CONTAINER_FROM_NAME)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--layout: it fills a folder, and \"%.200s\" is the name of a file", o->output);
    return FACET_OK;
}

facet_result bake_plan_make(const bake_options *o, bake_plan *out, facet_error *error)
{
    char stem[1024], own_name[1100];
    *out = (bake_plan){0};
    if (check_patterns(o, error) != FACET_OK)
        return FACET_ERROR_ARGUMENT;
    if (!find_stem(o, stem, sizeof stem))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "bake: the name of the environment is too long; name outputs");
    if (o->layout != BAKE_LAYOUT_NONE) {
        out->has_own_name = !o->output;
        facet_result result = bake_layout_add(o, stem, out, error);
        return result == FACET_OK ? add_side_files(o, out, stem, error) : result;
    }
    const char *output = o->output;
    const bool has_side = o->diffuse || o->sheen || o->sh || o->preview;
    if (!output && !has_side) {
        snprintf(own_name, sizeof own_name, "%s.%s", stem,
                 bake_container_extension(o->container ? o->container : CONTAINER_KTX2));
        output = own_name;
        out->has_own_name = true;
    }
    if (o->is_table)
        return add_table(o, out, output, error);
    facet_result result = FACET_OK;
    if (output)
        result = add_cube_files(
            o, out, stem,
            &(wanted_cube){.option = "--output", .pattern = output, .desc = o->bake, .is_main = true}, error);
    return result == FACET_OK ? add_side_files(o, out, stem, error) : result;
}

const char *bake_plan_subject(const bake_plan *plan)
{
    const char *path = plan->folder_count ? plan->folders[0]
                       : plan->file_count ? plan->files[0].path
                                          : "bake";
    return strcmp(path, "-") == 0 ? "stdout" : path;
}
