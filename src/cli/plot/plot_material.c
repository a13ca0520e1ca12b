/* plot_material.c - see plot_material.h. */
#include "cli/plot/plot_material.h"

#include "cli/shared/failure.h"
#include "cli/shared/value.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* ---- parameters as text ---- */

/* A named parameter of a facet_plot_material. */
typedef struct parameter {
    const char *name;
    facet_plot_model model;
    size_t offset;
    bool is_color, is_angle;
    double minimum, maximum;
} parameter;

#define AT(member) offsetof(facet_plot_material, member)
static const parameter parameters[] = {
    {"color", FACET_PLOT_MODEL_PBR, AT(base_color), .is_color = true},
    {"base-color", FACET_PLOT_MODEL_PBR, AT(base_color), .is_color = true},
    {"metallic", FACET_PLOT_MODEL_PBR, AT(metallic), .maximum = 1},
    {"roughness", FACET_PLOT_MODEL_PBR, AT(perceptual_roughness), .maximum = 1},
    {"ior", FACET_PLOT_MODEL_PBR, AT(ior), .maximum = 100},
    {"specular", FACET_PLOT_MODEL_PBR, AT(specular), .maximum = 1},
    {"specular-color", FACET_PLOT_MODEL_PBR, AT(specular_color), .is_color = true},
    {"clearcoat", FACET_PLOT_MODEL_PBR, AT(clearcoat), .maximum = 1},
    {"clearcoat-roughness", FACET_PLOT_MODEL_PBR, AT(clearcoat_roughness), .maximum = 1},
    {"sheen-color", FACET_PLOT_MODEL_PBR, AT(sheen_color), .is_color = true},
    {"sheen-roughness", FACET_PLOT_MODEL_PBR, AT(sheen_roughness), .maximum = 1},
    {"anisotropy", FACET_PLOT_MODEL_PBR, AT(anisotropy), .maximum = 1},
    {"anisotropy-rotation", FACET_PLOT_MODEL_PBR, AT(anisotropy_rotation_rad), .is_angle = true},
    {"iridescence", FACET_PLOT_MODEL_PBR, AT(iridescence), .maximum = 1},
    {"iridescence-ior", FACET_PLOT_MODEL_PBR, AT(iridescence_ior), .minimum = 1, .maximum = 100},
    {"iridescence-thickness", FACET_PLOT_MODEL_PBR, AT(iridescence_thickness_nm), .maximum = 1e5},
    {"diffuse-roughness", FACET_PLOT_MODEL_PBR, AT(diffuse_roughness), .maximum = 1},
    {"diffuse", FACET_PLOT_MODEL_OGL1, AT(diffuse), .is_color = true},
    {"specular", FACET_PLOT_MODEL_OGL1, AT(ogl1_specular), .is_color = true},
    {"shininess", FACET_PLOT_MODEL_OGL1, AT(shininess), .maximum = 1e6},
};

/* Parses "#808080", "gold"; one linear number for a grey, three with slashes. */
static bool read_color(const char *text, float out[3])
{
    double numbers[3];
    char spaced[128];
    if (value_number(text, &numbers[0])) {
        numbers[1] = numbers[2] = numbers[0];
    } else {
        if (color_parse(text, out))
            return true;
        if (strlen(text) >= sizeof spaced)
            return false;
        memcpy(spaced, text, strlen(text) + 1);
        for (char *c = spaced; (c = strchr(c, '/'));)
            *c = ' ';
        if (!value_numbers(spaced, 3, numbers))
            return false;
    }
    for (int i = 0; i < 3; i++)
        if (!(numbers[i] >= 0.0 && numbers[i] <= 1.0))
            return false;
    for (int i = 0; i < 3; i++)
        out[i] = (float)numbers[i];
    return true;
}

static bool read_value(const parameter *p, const char *text, float *out)
{
    double number;
    if (p->is_color)
        return read_color(text, out);
    if (p->is_angle ? !value_angle(text, &number)
                    : !value_number(text, &number) || number < p->minimum || number > p->maximum)
        return false;
    *out = (float)number;
    return true;
}

static facet_result fail_parameter(const char *text, const char *key, facet_plot_model model,
                                   facet_error *error)
{
    char names[512] = "";
    for (size_t i = 0; i < sizeof parameters / sizeof *parameters; i++) {
        size_t used = strlen(names);
        if (parameters[i].model == model)
            snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", parameters[i].name);
    }
    return fail(error, FACET_ERROR_ARGUMENT,
                "plot: \"%.200s\": there is no parameter \"%.60s\"; the parameters are: %s", text, key,
                names);
}

static facet_result set_parameter(const char *text, const char *key, const char *value,
                                  facet_plot_material *out, facet_error *error)
{
    for (size_t i = 0; i < sizeof parameters / sizeof *parameters; i++) {
        const parameter *p = &parameters[i];
        if (p->model != out->model || strcasecmp(p->name, key) != 0)
            continue;
        if (read_value(p, value, (float *)(void *)((char *)out + p->offset)))
            return FACET_OK;
        if (p->is_color)
            return fail(
                error, FACET_ERROR_ARGUMENT,
                "plot: \"%.200s\": %s: \"%.60s\" is not a color: #rrggbb, a CSS name, a grey or r/g/b "
                "from 0 to 1",
                text, p->name, value);
        if (p->is_angle)
            return fail(error, FACET_ERROR_ARGUMENT, "plot: \"%.200s\": %s: \"%.60s\" is not an angle", text,
                        p->name, value);
        return fail(error, FACET_ERROR_ARGUMENT,
                    "plot: \"%.200s\": %s: \"%.60s\" is not a number from %g to %g", text, p->name, value,
                    p->minimum, p->maximum);
    }
    return fail_parameter(text, key, out->model, error);
}

/* Names of models; OpenGL 1's highlight is Blinn's, which many call Phong's. */
static bool find_model(const char *word, size_t length, facet_plot_model *out)
{
    static const struct {
        const char *name;
        facet_plot_model model;
    } names[] = {{"pbr", FACET_PLOT_MODEL_PBR},          {"gltf", FACET_PLOT_MODEL_PBR},
                 {"ggx", FACET_PLOT_MODEL_PBR},          {"ogl1", FACET_PLOT_MODEL_OGL1},
                 {"phong", FACET_PLOT_MODEL_OGL1},       {"blinn", FACET_PLOT_MODEL_OGL1},
                 {"blinn-phong", FACET_PLOT_MODEL_OGL1}, {"opengl1", FACET_PLOT_MODEL_OGL1}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strlen(names[i].name) == length && strncasecmp(word, names[i].name, length) == 0) {
            *out = names[i].model;
            return true;
        }
    return false;
}

/* "ogl1,diffuse=..", "roughness=..". */
static facet_result read_parameters(const char *text, facet_plot_material *out, facet_error *error)
{
    char copy[1024];
    if (strlen(text) >= sizeof copy)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: a material of more than %zu characters",
                    sizeof copy - 1);
    memcpy(copy, text, strlen(text) + 1);
    *out = facet_plot_material_default();
    bool is_first = true;
    for (char *word = copy, *next; word; word = next, is_first = false) {
        next = strchr(word, ',');
        if (next)
            *next++ = 0;
        char *value = strchr(word, '='), *colon = strchr(word, ':');
        if (colon && is_first && find_model(word, (size_t)(colon - word), &out->model)) {
            size_t length = (size_t)(colon - word);
            return fail(error, FACET_ERROR_ARGUMENT,
                        "plot: \"%.200s\": write a comma after %.*s: %.*s,%.200s", text, (int)length, text,
                        (int)length, text, text + length + 1);
        }
        if (!value && is_first && find_model(word, strlen(word), &out->model))
            continue;
        if (!value)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "plot: \"%.200s\": \"%.60s\" is not a parameter; NAME=VALUE was expected", text,
                        word);
        *value++ = 0;
        facet_result result = set_parameter(text, word, value, out, error);
        if (result != FACET_OK)
            return result;
    }
    return FACET_OK;
}

static void write_value(const parameter *p, const float *value, char *text, size_t size)
{
    size_t used = strlen(text);
    bool is_grey = !p->is_color || (memcmp(value, value + 1, sizeof *value) == 0 &&
                                    memcmp(value, value + 2, sizeof *value) == 0);
    if (is_grey)
        snprintf(text + used, size - used, ",%s=%.6g", p->name, (double)value[0]);
    else
        snprintf(text + used, size - used, ",%s=%.6g/%.6g/%.6g", p->name, (double)value[0], (double)value[1],
                 (double)value[2]);
}

void plot_material_write(const facet_plot_material *m, char *text, size_t size)
{
    const facet_plot_material defaults = facet_plot_material_default();
    snprintf(text, size, "%s", m->model == FACET_PLOT_MODEL_OGL1 ? "ogl1" : "pbr");
    for (size_t i = 0; i < sizeof parameters / sizeof *parameters; i++) {
        const parameter *p = &parameters[i];
        bool is_synonym = i > 0 && parameters[i - 1].offset == p->offset;
        float value[3], usual[3];
        size_t bytes = (p->is_color ? 3 : 1) * sizeof *value;
        memcpy(value, (const char *)m + p->offset, bytes);
        memcpy(usual, (const char *)&defaults + p->offset, bytes);
        if (p->model == m->model && !is_synonym && !p->is_angle && memcmp(value, usual, bytes) != 0)
            write_value(p, value, text, size);
    }
}

/* ---- files ---- */

static facet_result append(plot_materials *m, const facet_plot_material *one, facet_error *error)
{
    if (m->count == FACET_PLOT_MAX_MATERIALS)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: more than %d materials; name some with #NAME",
                    FACET_PLOT_MAX_MATERIALS);
    m->items[m->count++] = *one;
    return FACET_OK;
}

static facet_result add_scene(plot_materials *m, const facet_scene *scene, const char *file, const char *name,
                              facet_error *error)
{
    uint32_t count = facet_scene_get_counts(scene).materials, found = 0;
    char names[512] = "";
    facet_result result = FACET_OK;
    facet_plot_model model =
        facet_scene_has_legacy_materials(scene) ? FACET_PLOT_MODEL_OGL1 : FACET_PLOT_MODEL_PBR;
    for (uint32_t i = 0; i < count && result == FACET_OK; i++) {
        facet_plot_material one;
        result = facet_plot_material_from_scene(scene, i, model, &one, error);
        size_t used = strlen(names);
        if (result == FACET_OK && one.label)
            snprintf(names + used, sizeof names - used, "%s\"%s\"", used ? ", " : "", one.label);
        if (result != FACET_OK || (name && strcmp(one.label ? one.label : "", name) != 0))
            continue;
        result = append(m, &one, error);
        found++;
    }
    if (result == FACET_OK && found == 0)
        result = name ? fail(error, FACET_ERROR_ARGUMENT, "%s: there is no material \"%s\"; there %s %s",
                             file, name, count == 1 ? "is" : "are", names[0] ? names : "none with a name")
                      : fail(error, FACET_ERROR_ARGUMENT, "%s: it has no materials", file);
    return result;
}

static facet_result add_file(plot_materials *m, const char *text, const facet_scene_desc *desc,
                             facet_error *error)
{
    char file[4096];
    const char *mark = strrchr(text, '#');
    size_t length = mark ? (size_t)(mark - text) : strlen(text);
    if (length >= sizeof file || m->scene_count == FACET_PLOT_MAX_MATERIALS)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: too many files, or too long a name");
    memcpy(file, text, length);
    file[length] = 0;
    facet_scene *scene = NULL;
    TRY(facet_scene_load(file, desc, &scene, error));
    m->scenes[m->scene_count++] = scene;
    return add_scene(m, scene, file, mark ? mark + 1 : NULL, error);
}

/* ---- all ---- */

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcasecmp(text + length - end_length, end) == 0;
}

/* "ogl1", "pbr,...". */
static bool begins_with_model(const char *text)
{
    facet_plot_model model;
    return find_model(text, strcspn(text, ","), &model);
}

bool plot_material_is_parameters(const char *text)
{
    return strchr(text, '=') || begins_with_model(text);
}

facet_result plot_materials_add(plot_materials *m, const char *text, const facet_scene_desc *desc,
                                facet_error *error)
{
    facet_plot_material one = facet_plot_material_default();
    if (ends_with(text, ".binary")) {
        one.model = FACET_PLOT_MODEL_MERL;
        one.path = text;
        return append(m, &one, error);
    }
    if (!plot_material_is_parameters(text))
        return add_file(m, text, desc, error);
    facet_result result = read_parameters(text, &one, error);
    return result == FACET_OK ? append(m, &one, error) : result;
}

facet_result plot_materials_add_options(plot_materials *m, const command_line *c, facet_error *error)
{
    facet_plot_material one = facet_plot_material_default();
    const char *list = option_text(c, OPT_ROUGHNESS, NULL);
    const char *color = option_text(c, OPT_BASE_COLOR, NULL);
    one.metallic = (float)option_number(c, OPT_METALLIC, 0.0);
    if (color && !read_color(color, one.base_color))
        return option_fail(c, OPT_BASE_COLOR, "a color: #rrggbb, a CSS name, a grey or r/g/b from 0 to 1",
                           error);
    if (!list)
        return is_given(c, OPT_METALLIC) || color ? append(m, &one, error) : FACET_OK;
    for (const char *at = list; *at;) {
        double roughness;
        if (!scan_number(&at, &roughness) || roughness < 0.0 || roughness > 1.0 || (*at && *at != ','))
            return option_fail(c, OPT_ROUGHNESS, "a list of numbers from 0 to 1, as 0.1,0.3", error);
        at += *at == ',';
        one.perceptual_roughness = (float)roughness;
        facet_result result = append(m, &one, error);
        if (result != FACET_OK)
            return result;
    }
    return FACET_OK;
}

void plot_materials_destroy(plot_materials *m)
{
    for (uint32_t i = 0; i < m->scene_count; i++)
        facet_scene_destroy(m->scenes[i]);
    *m = (plot_materials){0};
}
