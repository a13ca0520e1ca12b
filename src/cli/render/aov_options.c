/* aov_options.c - see aov_options.h. */
#include "cli/render/aov_options.h"

#include <stdio.h>
#include <string.h>

#include "cli/shared/failure.h"

static const uint32_t path_only = FACET_AOV_VARIANCE | FACET_AOV_SAMPLES;

static const struct aov_name {
    const char *name;
    uint32_t aovs;
} aov_names[] = {{"depth", FACET_AOV_DEPTH},
                 {"normal", FACET_AOV_NORMAL},
                 {"albedo", FACET_AOV_ALBEDO},
                 {"material", FACET_AOV_MATERIAL_ID},
                 {"object", FACET_AOV_OBJECT_ID},
                 {"instance", FACET_AOV_INSTANCE_ID},
                 {"uv", FACET_AOV_UV},
                 {"occlusion", FACET_AOV_OCCLUSION},
                 {"variance", FACET_AOV_VARIANCE},
                 {"samples", FACET_AOV_SAMPLES},
                 {"cryptomatte", FACET_AOV_CRYPTOMATTE},
                 {"crypto-object", FACET_AOV_CRYPTO_OBJECT},
                 {"crypto-material", FACET_AOV_CRYPTO_MATERIAL},
                 {"crypto-instance", FACET_AOV_CRYPTO_INSTANCE}};
enum { AOV_NAMES = sizeof aov_names / sizeof *aov_names };

static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (; *list; list += *list == ',') {
        size_t here = strcspn(list, ",");
        if (here == length && memcmp(list, word, length) == 0)
            return true;
        list += here;
    }
    return false;
}

/* All that the renderer has, except for what a continued picture cannot have. */
static uint32_t all_aovs(const render_options *o)
{
    uint32_t all = 0;
    for (size_t i = 0; i < AOV_NAMES; i++)
        all |= aov_names[i].aovs;
    if (o->desc.renderer != FACET_RENDERER_KIND_PATH)
        all &= ~path_only;
    if (o->desc.path.resumes)
        all &= ~(uint32_t)FACET_AOV_CRYPTOMATTE;
    return all;
}

/* "depth, normal and uv" of what a renderer has. */
static void list_names(uint32_t aovs, char *list, size_t size)
{
    size_t used = 0;
    for (size_t i = 0; i < AOV_NAMES; i++)
        if ((aov_names[i].aovs & aovs) == aov_names[i].aovs && used < size)
            used += (size_t)snprintf(list + used, size - used, "%s%s", used ? ", " : "", aov_names[i].name);
}

static facet_result check_renderer(const char *text, const render_options *o, facet_error *error)
{
    static const char *const renderers[] = {"preview", "path", "gl"};
    uint32_t all = all_aovs(o);
    for (size_t i = 0; i < AOV_NAMES; i++) {
        if (!has_word(text, aov_names[i].name) || (aov_names[i].aovs & ~all) == 0)
            continue;
        if (o->desc.path.resumes && aov_names[i].aovs & FACET_AOV_CRYPTOMATTE)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--aov: a checkpoint does not keep %s; render it without --resume",
                        aov_names[i].name);
        char list[256] = "";
        list_names(all, list, sizeof list);
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--aov: %s is a layer of --renderer path only; --renderer %s has %s, or all",
                    aov_names[i].name, renderers[o->desc.renderer], list);
    }
    return FACET_OK;
}

/* A .png holds one layer of IDs: false colors, which are lossless, in place of the image. */
static facet_result read_id_layer(const char *text, render_options *out, facet_error *error)
{
    static const uint32_t ids = FACET_AOV_OBJECT_ID | FACET_AOV_MATERIAL_ID | FACET_AOV_INSTANCE_ID;
    bool is_png = out->save.format == FACET_IMAGE_FORMAT_PNG && out->video == VIDEO_NONE;
    for (size_t i = 0; i < AOV_NAMES && is_png; i++)
        if (strcmp(text, aov_names[i].name) == 0 && aov_names[i].aovs & ids) {
            out->id_layer = aov_names[i].name;
            out->desc.aovs = aov_names[i].aovs | FACET_AOV_INSTANCE_ID;
            return FACET_OK;
        }
    return fail(
        error, FACET_ERROR_ARGUMENT,
        "--aov: only .exr files hold layers beside the image, write -o NAME.exr; a .png holds one of object, "
        "material and instance alone, in false color");
}

facet_result aov_options_read(const command_line *c, render_options *out, facet_error *error)
{
    const char *text = option_text(c, OPT_AOV, "");
    bool is_exr =
        out->save.format == FACET_IMAGE_FORMAT_EXR || out->save.format == FACET_IMAGE_FORMAT_EXR_FLOAT;
    if (*text && !is_exr)
        return read_id_layer(text, out, error);
    facet_result result = check_renderer(text, out, error);
    if (result != FACET_OK)
        return result;
    if (has_word(text, "all"))
        out->desc.aovs = all_aovs(out);
    for (size_t i = 0; i < AOV_NAMES; i++)
        if (has_word(text, aov_names[i].name))
            out->desc.aovs |= aov_names[i].aovs;
    return FACET_OK;
}
