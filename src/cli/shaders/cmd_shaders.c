/* cmd_shaders.c - facet shaders: the shader library as GLSL, for other programs. */
#include "cli/shared/options.h"

#include "cli/shared/command_line.h"
#include "cli/shared/failure.h"
#include "cli/shared/messages.h"
#include "cli/shared/output.h"
#include "cli/shared/suggest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const verb shaders_verb = {
    .name = "shaders",
    .summary = "print the shader library as GLSL, for other renderers",
    .arguments = "[PART...]",
    .max_arguments = SIZE_MAX,
    .output_types = "glsl",
    .words = OPTION_WORDS(
        "constants", "color", "brdf", "fresnel", "sampling", "sobol", "pixel_filter", "diffuse",
        "diffuse_sample", "footprint", "surface", "light", "area_light", "ibl", "sheen", "clearcoat",
        "anisotropy", "iridescence", "dispersion", "transmission", "glass", "volume", "sky", "water_surface",
        "water_means", "glint", "water", "water_place", "water_crest", "water_facets", "water_legacy",
        "water_caustic", "specular_aa", "specular_glossiness", "ground", "layers", "layers_direct",
        "layers_ibl", "layers_lobes", "material", "layers_sample", "surface_sample", "phong", "tonemap"),
    .description =
        "Prints the functions of facet's shader library as one GLSL file, or the named parts of it "
        "with all that they use. It has no main(): other programs put it before their own shader, in "
        "any stage. Compiled as C, the same text runs in facet's CPU renderers; every function is "
        "tested to give the same numbers in both.\n\n"
        "facet shaders --list lists the parts; each comment states what a function takes and "
        "returns, and the source of its formula.",
    .examples = (const example[]){{"facet shaders -o facet.glsl", "all of it, for WebGL 2 and OpenGL ES 3"},
                                  {"facet shaders --glsl 460 brdf fresnel -o ggx.glsl",
                                   "two parts, for desktop OpenGL"},
                                  {"facet shaders --glsl none tonemap | cat head.glsl - main.glsl > my.frag",
                                   "between other shader texts"},
                                  {NULL, NULL}},
    .groups =
        (const option_group *const[]){OPTION_GROUP("Options", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_GLSL, OPT_NAMES,
                                                   OPT_LIST, OPT_QUIET, OPT_HELP, OPT_HELP_ALL),
                                      NULL},
};

/* In the order of --glsl's choices. */
static const char *const versions[] = {"300 es",   "310 es",   "320 es",   "330 core",
                                       "410 core", "450 core", "460 core", NULL};

/* Accepts file names as names of parts: fresnel, fresnel.h, shade/fresnel.h. */
static void trim(const char *argument, char name[64])
{
    const char *slash = strrchr(argument, '/');
    snprintf(name, 64, "%s", slash ? slash + 1 : argument);
    char *dot = strrchr(name, '.');
    if (dot && strcmp(dot, ".h") == 0)
        *dot = 0;
}

static void list_parts(void)
{
    for (uint32_t i = 0; i < facet_shader_get_part_count(); i++)
        puts(facet_shader_get_part_name(i));
}

static facet_result write_text(const command_line *c, facet_error *error)
{
    enum { MAX_PARTS = 64 };
    static char names[MAX_PARTS][64];
    const char *parts[MAX_PARTS];
    if (c->argument_count > MAX_PARTS)
        return fail(error, FACET_ERROR_ARGUMENT, "shaders: %zu parts: there are only %u", c->argument_count,
                    facet_shader_get_part_count());
    for (size_t i = 0; i < c->argument_count; i++) {
        trim(c->arguments[i], names[i]);
        parts[i] = names[i];
    }
    const char *path = option_text(c, OPT_OUTPUT, "-");
    facet_result result = output_check(path, error);
    if (result != FACET_OK)
        return result;
    if (is_given(c, OPT_NO_CLOBBER) && output_exists(path)) {
        if (!is_given(c, OPT_QUIET))
            fprintf(stderr, "%s: kept, since it exists\n", path);
        return FACET_OK;
    }
    const facet_shader_desc desc = {.version = versions[option_choice(c, OPT_GLSL, 0)],
                                    .parts = parts,
                                    .part_count = (uint32_t)c->argument_count,
                                    .names = (facet_shader_names)option_choice(c, OPT_NAMES, 0)};
    unsigned char *bytes = NULL;
    size_t size = 0;
    result = facet_shader_text(&desc, &bytes, &size, error);
    if (result == FACET_OK)
        result = output_write_bytes(bytes, size, path, error);
    facet_bytes_destroy(bytes);
    return result;
}

int cmd_shaders(command_line *c)
{
    facet_error error = {0};
    facet_result result = FACET_OK;
    if (is_given(c, OPT_LIST))
        list_parts();
    else
        result = write_text(c, &error);
    if (result == FACET_OK)
        return EXIT_DONE;
    bool names_no_file = result == FACET_ERROR_ARGUMENT || result == FACET_ERROR_MEMORY;
    message_error("%s%s%s", names_no_file ? "facet: " : "", error.message,
                  result == FACET_ERROR_ARGUMENT ? "; facet shaders --list lists them" : "");
    return exit_code_of(result);
}
