/* bake_layout.c - the files that engines load, by their names and conventions.
 *
 * filament  gltf_viewer and the web viewer load FOLDER/NAME_ibl.ktx and NAME_skybox.ktx, NAME being the folder's: KTX 1, texels
 *           R11F_G11F_B10F, levels down to 16 texels with Filament's mapping, harmonics as text under the key "sh". With
 *           --format hdr or exr the faces one by one, as cmgen names them.
 * khronos   lambertian/diffuse.ktx2, ggx/specular.ktx2, charlie/sheen.ktx2 and the tables beside them, as the folders of
 *           glTF-Sample-Environments; panorama.hdr for versions of the viewer that filter by themselves.
 * three     environment.hdr for HDRLoader; pmrem.ktx2, levels as three.js' PMREMGenerator filters them since r182; px.hdr ..
 *           nz.hdr for HDRCubeTextureLoader; sh.json for LightProbe. three.js looks up cube maps from files with x negated. */
#define _DEFAULT_SOURCE
#include "cli/bake/bake_plan.h"

#include "cli/bake/bake_names.h"
#include "cli/shared/failure.h"

#include <stdio.h>
#include <string.h>

#define HALF_PI 1.57079632679489662f

/* State of a layout being added, with the first failure. */
typedef struct adding {
    const bake_options *options;
    const char *folder;
    bake_plan *plan;
    bool has_failed;
} adding;

static void add(adding *a, const char *name, bake_file what)
{
    char path[BAKE_NAME_SIZE];
    what.table_channel = what.content == BAKE_TABLE ? what.table_channel : -1;
    if (!bake_name_join(a->folder, name, path) || !bake_plan_add_file(a->plan, path, &what))
        a->has_failed = true;
}

static void add_folder(adding *a, const char *name)
{
    char path[BAKE_NAME_SIZE];
    bool fits = *name ? bake_name_join(a->folder, name, path) : strlen(a->folder) < sizeof path;
    if (!*name && fits)
        memcpy(path, a->folder, strlen(a->folder) + 1);
    char *copy = fits ? strdup(path) : NULL;
    if (copy)
        a->plan->folders[a->plan->folder_count++] = copy;
    else
        a->has_failed = true;
}

static uint32_t add_cube(adding *a, facet_lobe lobe, uint32_t size, uint32_t level_count)
{
    facet_bake_desc desc = a->options->bake;
    desc.lobe = lobe;
    desc.size = size;
    desc.level_count = level_count;
    return bake_plan_add_cube(a->plan, &desc, a->options->is_verified && lobe != FACET_LOBE_NONE);
}

/* Adds the six faces of a level: m3_px.hdr, or px.hdr without a level number. */
static void add_faces(adding *a, uint32_t cube_index, uint32_t level, bool has_number,
                      bake_container container, bool is_mirrored)
{
    char prefix[16] = "";
    if (has_number)
        snprintf(prefix, sizeof prefix, "m%u_", level);
    for (uint32_t face = 0; face < 6; face++) {
        char name[64];
        snprintf(name, sizeof name, "%s%s.%s", prefix, bake_face_names[face],
                 bake_container_extension(container));
        add(a, name,
            (bake_file){.content = BAKE_FACE,
                        .container = container,
                        .cube = cube_index,
                        .level = level,
                        .face = face,
                        .is_mirrored = is_mirrored});
    }
}

static void add_filament(adding *a)
{
    const bake_options *o = a->options;
    char folder_name[BAKE_NAME_SIZE], name[BAKE_NAME_SIZE + 16];
    uint32_t ibl = add_cube(a, FACET_LOBE_GGX, o->bake.size, o->bake.level_count);
    uint32_t skybox = add_cube(a, FACET_LOBE_NONE, o->bake.size, 1);
    bake_name_of_folder(a->folder, folder_name);
    add_folder(a, "");
    if (o->container != CONTAINER_FROM_NAME) {
        for (uint32_t level = 0; level < o->bake.level_count; level++)
            add_faces(a, ibl, level, true, o->container, false);
        add_faces(a, skybox, 0, false, o->container, false);
    } else {
        const bake_file file = {
            .content = BAKE_CUBE, .container = CONTAINER_KTX1, .texels = FACET_TEXEL_FORMAT_B10G11R11};
        bake_file one = file;
        one.cube = ibl;
        snprintf(name, sizeof name, "%s_ibl.ktx", folder_name);
        add(a, name, one);
        one.cube = skybox;
        snprintf(name, sizeof name, "%s_skybox.ktx", folder_name);
        add(a, name, one);
    }
    add(a, "sh.txt", (bake_file){.content = BAKE_SH, .container = CONTAINER_TEXT});
    a->plan->has_sh = true;
}

static void add_khronos(adding *a)
{
    const bake_options *o = a->options;
    const uint32_t size = o->bake.size, levels = o->bake.level_count;
    const facet_texel_format texels = o->has_texels ? o->texels : FACET_TEXEL_FORMAT_RGBA16F;
    const struct {
        const char *folder, *name;
        facet_lobe lobe;
        uint32_t size, levels;
    } cubes[] = {{"ggx", "ggx/specular.ktx2", FACET_LOBE_GGX, size, levels},
                 {"charlie", "charlie/sheen.ktx2", FACET_LOBE_CHARLIE, size, levels},
                 {"lambertian", "lambertian/diffuse.ktx2", FACET_LOBE_LAMBERT, size < 64 ? size : 64, 1}};
    static const struct {
        const char *name;
        facet_dfg_kind kind;
        int channel;
    } tables[] = {{"lut_ggx.png", FACET_DFG_KIND_CORRELATED, -1},
                  {"lut_charlie.png", FACET_DFG_KIND_CHARLIE_NEUBELT, 2},
                  {"lut_sheen_E.png", FACET_DFG_KIND_CHARLIE, 0}};
    add_folder(a, "");
    for (size_t i = 0; i < sizeof cubes / sizeof *cubes; i++) {
        add_folder(a, cubes[i].folder);
        add(a, cubes[i].name,
            (bake_file){.content = BAKE_CUBE,
                        .container = CONTAINER_KTX2,
                        .cube = add_cube(a, cubes[i].lobe, cubes[i].size, cubes[i].levels),
                        .texels = texels});
    }
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        add(a, tables[i].name,
            (bake_file){.content = BAKE_TABLE,
                        .container = CONTAINER_PNG,
                        .table = tables[i].kind,
                        .table_channel = tables[i].channel});
    add(a, "panorama.hdr",
        (bake_file){.content = BAKE_LEVEL,
                    .container = CONTAINER_HDR,
                    .cube = add_cube(a, FACET_LOBE_NONE, size, 1),
                    .projection = FACET_LAYOUT_EQUIRECTANGULAR});
}

static void add_three(adding *a)
{
    const bake_options *o = a->options;
    uint32_t cube_index = add_cube(a, FACET_LOBE_NONE, o->bake.size, 1);
    add_folder(a, "");
    add(a, "environment.hdr",
        (bake_file){.content = BAKE_LEVEL,
                    .container = CONTAINER_HDR,
                    .cube = cube_index,
                    .projection = FACET_LAYOUT_EQUIRECTANGULAR});
    add(a, "pmrem.ktx2",
        (bake_file){.content = BAKE_CUBE,
                    .container = CONTAINER_KTX2,
                    .cube = add_cube(a, FACET_LOBE_GGX, o->bake.size, o->bake.level_count),
                    .texels = o->has_texels ? o->texels : FACET_TEXEL_FORMAT_RGBA16F,
                    .is_mirrored = true});
    add_faces(a, cube_index, 0, false, CONTAINER_HDR, true);
    add(a, "sh.json", (bake_file){.content = BAKE_SH, .container = CONTAINER_JSON});
    a->plan->has_sh = true;
}

facet_result bake_layout_add(const bake_options *o, const char *stem, bake_plan *plan, facet_error *error)
{
    static void (*const adders[])(adding *) = {NULL, add_filament, add_khronos, add_three};
    char folder[BAKE_NAME_SIZE];
    adding a = {.options = o, .folder = folder, .plan = plan};
    if (bake_name_expand(o->output ? o->output : stem, stem, -1, false, -1, folder))
        adders[o->layout](&a);
    else
        a.has_failed = true;
    return a.has_failed
               ? fail(error, FACET_ERROR_ARGUMENT, "--output: the name \"%.100s..\" is too long", a.folder)
               : FACET_OK;
}

float bake_layout_turn(const bake_options *o, const facet_environment_info *info)
{
    const bool is_file = o->environment.kind == ENVIRONMENT_FILE && !o->has_faces;
    return o->layout == BAKE_LAYOUT_FILAMENT && is_file && info->layout == FACET_LAYOUT_EQUIRECTANGULAR
               ? -HALF_PI
               : 0.0f;
}
