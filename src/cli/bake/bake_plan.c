/* bake_plan.c - the cube maps and files of facet bake. */
#define _DEFAULT_SOURCE
#include "cli/bake/bake_plan.h"

#include "cli/bake/bake_names.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* ---- cube maps and files ---- */

static facet_result add(bake_plan *plan, const char *path, const bake_file *what, facet_error *error)
{
    return bake_plan_add_file(plan, path, what) ? FACET_OK
                                                : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
}

/* Adds the images of a cube map: one per level, or six. */
static facet_result add_images(const bake_options *o, bake_plan *plan, const char *pattern, const char *stem,
                               bake_file what, facet_error *error)
{
    const uint32_t level_count = plan->cubes[what.cube].desc.level_count;
    const bool has_faces =
        o->has_projection ? o->projection == FACET_LAYOUT_FACES : bake_name_has_face(pattern);
    const bool is_stdout = strcmp(pattern, "-") == 0;
    const bool is_one_level = level_count > 1 && o->level >= 0; /* --level; irradiance has one level anyway */
    const bool has_levels = level_count > 1 && !is_one_level;
    facet_result result = FACET_OK;
    if (is_stdout && (has_levels || has_faces))
        return fail(error, FACET_ERROR_ARGUMENT,
                    has_faces ? "--output: standard output takes one image, not faces"
                              : "--output: standard output takes one image; choose it with --level, or give "
                                "--format ktx2 for all");
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

/* Adds a cube map and its files by pattern. */
typedef struct wanted_cube {
    const char *option; /* "--diffuse" */
    const char *pattern;
    facet_bake_desc desc;
    bool is_main; /* the format is that of --format */
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
                    "%s: PNG holds values up to 1 only; give --rgbm RANGE, or write .ktx2, .exr or .hdr (an "
                    "image to look at: --preview)",
                    w->option);
    if (container != CONTAINER_KTX2 && w->is_main && o->has_texels)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--format: texel formats are those of .ktx2 files, not of \"%s\"", w->pattern);
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
    TRY(check_container(o, w, container, error));
    const bake_file what = {.container = container,
                            .content = BAKE_CUBE,
                            .cube = bake_plan_add_cube(plan, &w->desc, is_verified),
                            .texels = o->has_texels ? o->texels : FACET_TEXEL_FORMAT_RGBA16F,
                            .table_channel = -1};
    if (container != CONTAINER_KTX2)
        return add_images(o, plan, w->pattern, stem, what, error);
    if (!is_stdout && !bake_name_expand(w->pattern, stem, -1, false, -1, name))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the name \"%.100s..\" is too long", w->option,
                    w->pattern);
    return add(plan, name, &what, error);
}

/* Adds the files of --sh and --preview. */
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
                    "--sheen: with --lobe lambert it would have one level only; write irradiance with "
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
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--format: texel formats are those of .ktx2 files, not of \"%s\"", path);
    return add(plan, path, &what, error);
}

/* The stem of default names. */
static bool find_stem(const bake_options *o, char *stem, size_t size)
{
    const char *name = o->is_table ? "dfg" : o->has_faces ? "cube" : bake_input_name(o);
    if (!o->is_table && !o->has_faces && o->environment.kind == ENVIRONMENT_FACES)
        name = "cube";
    return output_name_stem(name, stem, size);
}

/* Refuses names with unknown placeholders, and the name of a file for --layout. */
static facet_result check_patterns(const bake_options *o, facet_error *error)
{
    const struct {
        const char *place, *pattern;
    } names[] = {{"--output", o->output},
                 {"--diffuse", o->diffuse},
                 {"--sheen", o->sheen},
                 {"--sh", o->sh},
                 {"--preview", o->preview}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i].pattern)
            TRY(output_name_check(names[i].place, names[i].pattern, "stem level face", error));
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

/* ---- checks ---- */

/* Checks that a folder exists and is writable, or can be created. */
static facet_result check_folder(const char *folder, facet_error *error)
{
    struct stat info;
    char above[BAKE_NAME_SIZE + 4];
    if (stat(folder, &info) == 0) {
        if (!S_ISDIR(info.st_mode))
            return fail(error, FACET_ERROR_WRITE, "%s: it is not a folder, which --layout fills", folder);
        return access(folder, W_OK | X_OK) == 0
                   ? FACET_OK
                   : fail(error, FACET_ERROR_WRITE, "%s: the folder cannot be written to: %s", folder,
                          strerror(errno));
    }
    snprintf(above, sizeof above, "%s", folder);
    size_t length = strlen(above);
    while (length > 1 && above[length - 1] == '/')
        above[--length] = 0;
    return output_check(above, error); /* checked like a file */
}

static bool is_read(const command_line *c, const bake_options *o, const char *path)
{
    const char *config_path = option_text(c, OPT_CONFIG, NULL);
    if (config_path && input_is_same_file(path, config_path))
        return true;
    for (int i = 0; o->has_faces && i < 6; i++)
        if (input_is_same_file(path, o->faces[i]))
            return true;
    return !o->has_faces && !o->is_table && environment_input_is_file(&o->environment, path);
}

static int compare_identities(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Refuses two outputs that are the same file. */
static facet_result check_twice(const bake_plan *plan, facet_error *error)
{
    char **identities = calloc(plan->file_count + 1, sizeof *identities);
    facet_result result = identities ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < plan->file_count && result == FACET_OK; i++) {
        identities[i] = output_identity(plan->files[i].path);
        if (!identities[i])
            result = fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    }
    if (result == FACET_OK)
        qsort(identities, plan->file_count, sizeof *identities, compare_identities);
    for (size_t i = 1; i < plan->file_count && result == FACET_OK; i++)
        if (strcmp(identities[i - 1], identities[i]) == 0)
            result = fail(error, FACET_ERROR_ARGUMENT, "bake: two outputs have the name %s",
                          strchr(identities[i], '/') + 1);
    for (size_t i = 0; identities && i < plan->file_count; i++)
        free(identities[i]);
    free(identities);
    return result;
}

/* Drops cube maps whose files are all kept. */
static void drop_idle_cubes(bake_plan *plan)
{
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        bool is_needed = false;
        for (size_t f = 0; f < plan->file_count; f++) {
            const bake_file *file = &plan->files[f];
            bool is_of_cube = file->content <= BAKE_FACE || file->content == BAKE_SHEET;
            is_needed = is_needed || (is_of_cube && file->cube == i && !file->is_kept);
        }
        if (!is_needed)
            plan->cubes[i].desc.size = 0;
    }
}

/* Refuses options of a file type that is not written. */
static facet_result check_idle_options(const command_line *c, const bake_plan *plan, facet_error *error)
{
    bool has_image = false, has_png = false, has_ktx2 = false, has_sh = false;
    for (size_t i = 0; i < plan->file_count; i++) {
        const bake_file *file = &plan->files[i];
        const bool is_image = file->content == BAKE_LEVEL || file->content == BAKE_FACE;
        has_image = has_image || is_image;
        has_png = has_png || (is_image && file->container == CONTAINER_PNG);
        has_ktx2 = has_ktx2 || file->container == CONTAINER_KTX2;
        has_sh = has_sh || file->content == BAKE_SH;
    }
    const struct {
        option_id id;
        bool is_of_use;
        const char *what;
    } rules[] = {{OPT_PROJECTION, has_image, "an image (.exr .hdr .pfm .png)"},
                 {OPT_LEVEL, has_image, "an image (.exr .hdr .pfm .png)"},
                 {OPT_RGBM, has_png, "a .png file"},
                 {OPT_ZSTD, has_ktx2, "a .ktx2 file"},
                 {OPT_SH_WINDOW, has_sh, "--sh"}};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (is_given(c, rules[i].id) && !rules[i].is_of_use)
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it needs %s",
                        option_find_id(c->verb, rules[i].id)->name, rules[i].what);
    return FACET_OK;
}

facet_result bake_plan_check(const command_line *c, const bake_options *o, bake_plan *plan,
                             facet_error *error)
{
    facet_result result = check_idle_options(c, plan, error);
    for (size_t i = 0; i < plan->folder_count && result == FACET_OK; i++)
        if (i == 0 || access(plan->folders[0], F_OK) == 0)
            result = check_folder(plan->folders[i], error);
    for (size_t i = 0; i < plan->file_count && result == FACET_OK; i++) {
        bake_file *file = &plan->files[i];
        const bool exists = strcmp(file->path, "-") != 0 && output_exists(file->path);
        result = output_check(file->path, error);
        file->is_kept = result == FACET_OK && o->keeps_existing && exists;
        if (result == FACET_OK && exists && !file->is_kept && is_read(c, o, file->path))
            result = fail(error, FACET_ERROR_ARGUMENT,
                          "%s: this input would be overwritten; name another output", file->path);
    }
    if (result == FACET_OK)
        result = check_twice(plan, error);
    drop_idle_cubes(plan);
    return result;
}
