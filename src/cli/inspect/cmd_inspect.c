/* cmd_inspect.c - facet inspect: the contents of models. */
#include "cli/shared/options.h"

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/terminal.h"
#include "cli/shared/verb_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const verb inspect_verb = {
    .name = "inspect",
    .summary = "print what is in a model",
    .arguments = "MODEL|FOLDER...",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "txt",
    .output_hint = ">",
    .description =
        "Reads each MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - "
        "is standard input) and prints counts, bounds, materials, textures, images, cameras, lights, "
        "the extensions and how facet supports them, and the warnings of reading. With -v lists are "
        "printed in full.\n\n"
        "The exit code is 0 if the model can be read, also with warnings (--strict: 1).",
    .examples =
        (const example[]){{"facet inspect helmet.glb", "as text"},
                          {"facet inspect helmet.glb --json | jq .materials", "as JSON"},
                          {"facet inspect --strict models/", "check all models in a folder and below it"},
                          {NULL, NULL}},
    .basics = OPTION_IDS(OPT_JSON, OPT_VERBOSE, OPT_STRICT, OPT_FILES_FROM, OPT_ROOT, OPT_TIME_LIMIT,
                         OPT_MAX_MEMORY),
    .groups =
        (const option_group *const[]){&files_group, &legacy_group, &limits_group, &messages_group, NULL},
};

/* ---- the description as text ---- */

enum { FEW = 20 };

/* ---- members that may be missing ---- */

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static long long integer_of(const json_t *object, const char *key)
{
    return (long long)json_number_value(json_object_get(object, key));
}

static double element_of(const json_t *array, size_t index)
{
    return json_number_value(json_array_get(array, index));
}

/* "1 node", "2 nodes" */
static void add_count(FILE *stream, const char **separator, const json_t *counts, const char *key,
                      const char *one)
{
    long long count = integer_of(counts, key);
    if (!count)
        return;
    const char *many = strncmp(key, "drawn_", 6) == 0 ? key + 6 : key;
    fprintf(stream, "%s%lld %s", *separator, count, count == 1 ? one : many);
    *separator = ", ";
}

static void print_heading(FILE *stream, const char *title, size_t count)
{
    bool has_color = terminal_has_color(stream);
    fprintf(stream, "\n%s%s%s (%zu)\n", has_color ? "\033[1m" : "", title, has_color ? "\033[0m" : "", count);
}

static void print_rest(FILE *stream, size_t count, bool all)
{
    if (!all && count > FEW)
        fprintf(stream, "  ... and %zu more (-v prints all)\n", count - FEW);
}

/* ---- parts ---- */

static void print_counts(FILE *stream, const json_t *counts)
{
    static const char *const stored[][2] = {
        {"scenes", "scene"},   {"nodes", "node"},   {"meshes", "mesh"}, {"primitives", "primitive"},
        {"cameras", "camera"}, {"lights", "light"}, {"skins", "skin"},  {"animations", "animation"}};
    static const char *const geometry[][2] = {
        {"vertices", "vertex"}, {"triangles", "triangle"}, {"lines", "line"}, {"points", "point"}};
    const char *separator = "  holds      ";
    for (size_t i = 0; i < sizeof stored / sizeof *stored; i++)
        add_count(stream, &separator, counts, stored[i][0], stored[i][1]);
    fputs(*separator == ',' ? "\n" : "", stream);
    separator = "  geometry   ";
    for (size_t i = 0; i < sizeof geometry / sizeof *geometry; i++)
        add_count(stream, &separator, counts, geometry[i][0], geometry[i][1]);
    fputs(*separator == ',' ? "\n" : "", stream);
    separator = "  drawn      ";
    add_count(stream, &separator, counts, "drawn_triangles", "triangle");
    separator = *separator == ',' ? " in " : separator;
    add_count(stream, &separator, counts, "instances", "instance");
    fputs(*separator == ',' ? "\n" : "", stream);
}

static void print_bounds(FILE *stream, const json_t *bounds)
{
    const json_t *low = json_object_get(bounds, "min"), *high = json_object_get(bounds, "max");
    if (!json_is_array(low) || !json_is_array(high)) {
        fprintf(stream, "  size       nothing to see\n");
        return;
    }
    double a[3], b[3], size = 0.0, farthest = 0.0;
    for (size_t i = 0; i < 3; i++) {
        a[i] = element_of(low, i);
        b[i] = element_of(high, i);
        size = fmax(size, b[i] - a[i]);
        farthest = fmax(farthest, fmax(fabs(a[i]), fabs(b[i])));
    }
    /* four significant digits relative to the size of the model */
    int digits = size > 0.0 && farthest > 100.0 * size ? 4 + (int)ceil(log10(farthest / size)) : 4;
    digits = digits < 15 ? digits : 15;
    fprintf(stream, "  size       %.4g x %.4g x %.4g m, from (%.*g, %.*g, %.*g) to (%.*g, %.*g, %.*g)\n",
            b[0] - a[0], b[1] - a[1], b[2] - a[2], digits, a[0], digits, a[1], digits, a[2], digits, b[0],
            digits, b[1], digits, b[2]);
}

/* Writes "base_color 0, normal 2": the texture members with their texture numbers. */
static void list_textures(const json_t *object, char *text, size_t size)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        static const char *const suffixes[] = {"_texture", "Texture"};
        size_t length = strlen(key), used = strlen(text);
        if (!json_object_get(value, "texture"))
            continue;
        for (int i = 0; i < 2; i++) {
            size_t end = strlen(suffixes[i]);
            if (length > end && strcmp(key + length - end, suffixes[i]) == 0)
                length -= end;
        }
        snprintf(text + used, size - used, "%s%.*s %lld", used ? ", " : "", (int)length, key,
                 integer_of(value, "texture"));
    }
}

/* Writes ", clearcoat, sheen": the extensions of the material. */
static void list_extensions(const json_t *material, char *text, size_t size)
{
    static const char prefix[] = "KHR_materials_";
    const char *key;
    json_t *value;
    text[0] = 0;
    json_object_foreach(json_object_get(material, "extensions"), key, value)
    {
        size_t used = strlen(text);
        bool has_prefix = strncmp(key, prefix, sizeof prefix - 1) == 0;
        snprintf(text + used, size - used, ", %s", key + (has_prefix ? sizeof prefix - 1 : 0));
    }
}

static void print_materials(FILE *stream, const json_t *materials, bool all)
{
    size_t count = json_array_size(materials);
    if (!count)
        return;
    print_heading(stream, "Materials", count);
    table t = {.column_count = 7};
    static const char *const titles[] = {"#",         "name", "base color", "metallic",
                                         "roughness", "kind", "textures"};
    for (size_t i = 0; i < 7; i++)
        table_add(&t, "%s", titles[i]);
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *m = json_array_get(materials, i), *color = json_object_get(m, "base_color");
        char textures[512] = "", extensions[256];
        const char *key;
        json_t *extension;
        list_textures(m, textures, sizeof textures);
        json_object_foreach(json_object_get(m, "extensions"), key, extension)
            list_textures(extension, textures, sizeof textures);
        list_extensions(m, extensions, sizeof extensions);
        table_add(&t, "%zu", i);
        table_add(&t, "%s", text_of(m, "name"));
        table_add(&t, "%.3g %.3g %.3g %.3g", element_of(color, 0), element_of(color, 1), element_of(color, 2),
                  element_of(color, 3));
        table_add(&t, "%.3g", number_of(m, "metallic"));
        table_add(&t, "%.3g", number_of(m, "roughness"));
        table_add(&t, "%s%s%s", text_of(m, "alpha_mode"),
                  json_is_true(json_object_get(m, "double_sided")) ? ", double sided" : "", extensions);
        table_add(&t, "%s", textures);
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

/* Writes "0.8 0.8 0.8"; "-" if it is not given. */
static void add_legacy_color(table *t, const json_t *m, const char *key)
{
    const json_t *color = json_object_get(m, key);
    if (json_array_size(color) == 3)
        table_add(t, "%.3g %.3g %.3g", element_of(color, 0), element_of(color, 1), element_of(color, 2));
    else
        table_add(t, "-");
}

static void add_legacy_number(table *t, const json_t *m, const char *key)
{
    if (json_is_number(json_object_get(m, key)))
        table_add(t, "%.4g", number_of(m, key));
    else
        table_add(t, "-");
}

/* Prints the OpenGL 1 and MTL materials of the file. */
static void print_legacy(FILE *stream, const json_t *legacy, bool all)
{
    const json_t *materials = json_object_get(legacy, "materials");
    size_t count = json_array_size(materials);
    if (!count)
        return;
    print_heading(stream, "OpenGL 1 materials", count);
    table t = {.column_count = 7};
    static const char *const titles[] = {"#", "name", "diffuse", "specular", "shininess", "illum", "maps"};
    for (size_t i = 0; i < 7; i++)
        table_add(&t, "%s", titles[i]);
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *m = json_array_get(materials, i);
        char maps[512] = "";
        const char *key;
        json_t *map;
        json_object_foreach(json_object_get(m, "maps"), key, map)
        {
            size_t used = strlen(maps);
            snprintf(maps + used, sizeof maps - used, "%s%s", used ? ", " : "", key);
        }
        table_add(&t, "%zu", i);
        table_add(&t, "%s", text_of(m, "name"));
        add_legacy_color(&t, m, "diffuse");
        add_legacy_color(&t, m, "specular");
        add_legacy_number(&t, m, "shininess");
        add_legacy_number(&t, m, "illum");
        table_add(&t, "%s", maps);
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

/* "1.2 MiB", "26 KiB" */
static const char *size_text(double bytes, char text[32])
{
    const double kib = 1024.0, mib = 1048576.0;
    if (bytes >= mib)
        snprintf(text, 32, "%.1f MiB", bytes / mib);
    else
        snprintf(text, 32, "%.0f KiB", bytes > 0.0 && bytes < kib ? 1.0 : bytes / kib);
    return text;
}

static void print_images(FILE *stream, const json_t *images, bool all)
{
    size_t count = json_array_size(images);
    if (!count)
        return;
    print_heading(stream, "Images", count);
    table t = {.column_count = 5};
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *image = json_array_get(images, i);
        long long width = integer_of(image, "width"), height = integer_of(image, "height");
        table_add(&t, "%zu", i);
        table_add(&t, "%s", text_of(image, "name"));
        table_add(&t, "%s", text_of(image, "mime_type"));
        if (width && height)
            table_add(&t, "%lldx%lld", width, height);
        else
            table_add(&t, "unreadable");
        char size[32];
        table_add(&t, "%s", size_text(number_of(image, "bytes"), size));
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

/* Prints the image of each texture, unless all have the same number as their texture. */
static void print_textures(FILE *stream, const json_t *textures, bool all)
{
    size_t count = json_array_size(textures);
    if (!count)
        return;
    print_heading(stream, "Textures", count);
    table t = {.column_count = 4};
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *texture = json_array_get(textures, i), *image = json_object_get(texture, "image");
        table_add(&t, "%zu", i);
        if (json_is_integer(image))
            table_add(&t, "image %lld", (long long)json_integer_value(image));
        else
            table_add(&t, "no image");
        table_add(&t, "%s %s", text_of(texture, "wrap_u"), text_of(texture, "wrap_v"));
        table_add(&t, "%s", text_of(texture, "name"));
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

/* Prints the tree of files that the model refers to. */
static void print_externals(FILE *stream, const json_t *list, bool all)
{
    size_t count = json_array_size(list);
    if (!count)
        return;
    print_heading(stream, "External assets", count);
    table t = {.column_count = 3};
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *item = json_array_get(list, i);
        long long nodes = integer_of(item, "nodes"), depth = integer_of(item, "depth");
        table_add(&t, "%*s%s", (int)(2 * (depth < 16 ? depth : 16)), "", text_of(item, "name"));
        table_add(&t, "%lld node%s", nodes, nodes == 1 ? "" : "s");
        table_add(&t, "%s", text_of(item, "file"));
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

/* Prints cameras, lights and scenes, which options refer to. */
static void print_named(FILE *stream, const json_t *list, const char *title, bool all)
{
    size_t count = json_array_size(list);
    if (!count)
        return;
    print_heading(stream, title, count);
    table t = {.column_count = 3};
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *item = json_array_get(list, i);
        table_add(&t, "%zu", i);
        table_add(&t, "%s", text_of(item, "type"));
        table_add(&t, "%s", text_of(item, "name"));
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

static void print_animations(FILE *stream, const json_t *animations, bool all)
{
    size_t count = json_array_size(animations);
    if (!count)
        return;
    print_heading(stream, "Animations", count);
    table t = {.column_count = 4};
    for (size_t i = 0; i < count && (all || i < FEW); i++) {
        const json_t *animation = json_array_get(animations, i);
        table_add(&t, "%zu", i);
        table_add(&t, "%.4g s to %.4g s", number_of(animation, "begin"), number_of(animation, "end"));
        size_t channels = json_array_size(json_object_get(animation, "channels"));
        table_add(&t, "%zu channel%s", channels, channels == 1 ? "" : "s");
        table_add(&t, "%s", text_of(animation, "name"));
    }
    table_print(&t, stream, 2);
    print_rest(stream, count, all);
}

static void print_variants(FILE *stream, const json_t *variants)
{
    size_t count = json_array_size(variants);
    if (!count)
        return;
    print_heading(stream, "Variants", count);
    table t = {.column_count = 2};
    for (size_t i = 0; i < count; i++) {
        table_add(&t, "%zu", i);
        table_add(&t, "%s", json_string_value(json_array_get(variants, i)));
    }
    table_print(&t, stream, 2);
}

static void print_memory(FILE *stream, const json_t *memory)
{
    char a[32], b[32], c[32];
    fprintf(stream, "  memory     geometry %s", size_text(number_of(memory, "geometry_bytes"), a));
    if (integer_of(memory, "image_file_bytes"))
        fprintf(stream, ", images %s in files, %s as texels",
                size_text(number_of(memory, "image_file_bytes"), b),
                size_text(number_of(memory, "image_texel_bytes"), c));
    fputc('\n', stream);
}

/* Whether value contains key ("extras", "metadata") at any depth. */
static bool has_metadata(const json_t *value, const char *wanted)
{
    const char *key;
    json_t *element;
    size_t index;
    bool found = json_object_get(value, wanted) != NULL;
    if (json_is_array(value))
        json_array_foreach(value, index, element) found = found || has_metadata(element, wanted);
    else
        json_object_foreach((json_t *)value, key, element) found = found || has_metadata(element, wanted);
    return found;
}

static void print_extensions(FILE *stream, const json_t *extensions)
{
    size_t count = json_array_size(extensions);
    if (!count)
        return;
    print_heading(stream, "Extensions", count);
    table t = {.column_count = 3};
    for (size_t i = 0; i < count; i++) {
        const json_t *e = json_array_get(extensions, i);
        table_add(&t, "%s", text_of(e, "name"));
        table_add(&t, "%s", text_of(e, "state"));
        table_add(&t, "%s", json_is_true(json_object_get(e, "required")) ? "required" : "");
    }
    table_print(&t, stream, 2);
}

static void print_messages(FILE *stream, const char *name, const char *heading, const json_t *list)
{
    size_t count = json_array_size(list);
    if (!count)
        return;
    print_heading(stream, heading, count);
    table t = {.column_count = 1};
    size_t length = strlen(name);
    for (size_t i = 0; i < count; i++) {
        const char *text = json_string_value(json_array_get(list, i));
        bool has_name = strncmp(text, name, length) == 0 && strncmp(text + length, ": ", 2) == 0;
        table_add(&t, "%s", text + (has_name ? length + 2 : 0));
    }
    table_print(&t, stream, 2);
}

/* Prints the result of facet_scene_describe_json() for the model name (docs/inspect.md has the members).
 * Lists end after 20 rows unless all. Missing members are skipped. */
static void print_text(FILE *stream, const char *name, const json_t *model, bool all)
{
    const json_t *asset = json_object_get(model, "asset");
    fprintf(stream, "%s\n", name);
    table t = {.column_count = 2};
    static const char *const members[] = {"version", "generator", "copyright"};
    for (size_t i = 0; i < 3; i++)
        if (*text_of(asset, members[i])) {
            table_add(&t, "%-9s", i ? members[i] : "glTF");
            table_add(&t, "%s", text_of(asset, members[i]));
        }
    table_print(&t, stream, 2);
    print_counts(stream, json_object_get(model, "counts"));
    print_bounds(stream, json_object_get(model, "bounds"));
    print_memory(stream, json_object_get(model, "memory"));
    bool has_extras = has_metadata(model, "extras"), has_xmp = has_metadata(model, "metadata");
    if (has_extras || has_xmp)
        fprintf(stream, "  metadata   %s%s%s; --json shows it\n", has_extras ? "extras" : "",
                has_extras && has_xmp ? ", " : "", has_xmp ? "XMP" : "");
    if (json_array_size(json_object_get(model, "scenes")) > 1)
        print_named(stream, json_object_get(model, "scenes"), "Scenes", all);
    print_externals(stream, json_object_get(model, "external_assets"), all);
    print_materials(stream, json_object_get(model, "materials"), all);
    print_legacy(stream, json_object_get(model, "legacy"), all);
    print_textures(stream, json_object_get(model, "textures"), all);
    print_images(stream, json_object_get(model, "images"), all);
    print_named(stream, json_object_get(model, "cameras"), "Cameras", all);
    print_named(stream, json_object_get(model, "lights"), "Lights", all);
    print_animations(stream, json_object_get(model, "animations"), all);
    print_variants(stream, json_object_get(model, "variants"));
    print_extensions(stream, json_object_get(model, "extensions"));
    print_messages(stream, name, "Warnings", json_object_get(model, "warnings"));
    print_messages(stream, name, "Notes", json_object_get(model, "notes"));
}

/* ---- the run ---- */

typedef struct inspect_run {
    verb_run base;
    model_list models;
} inspect_run;

/* Prints the description of a loaded scene, JSON text. */
static facet_result print_description(const inspect_run *run, const char *model, const char *text,
                                      facet_error *error)
{
    if (is_given(run->base.line, OPT_JSON)) {
        puts(text);
        return FACET_OK;
    }
    json_error_t problem;
    json_t *root = json_loads(text, JSON_ALLOW_NUL, &problem);
    if (!root)
        return fail(error, FACET_ERROR_BUG, "%s: its description is not valid JSON: %s", input_name(model),
                    problem.text);
    print_text(stdout, input_name(model), root, is_given(run->base.line, OPT_VERBOSE));
    json_decref(root);
    return FACET_OK;
}

static facet_result inspect_model(inspect_run *run, const char *model, facet_error *error)
{
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    facet_scene *scene = NULL;
    char *text = NULL;
    interrupt_begin_reading(input_name(model));
    facet_result result = input_load(model, &desc, &scene, error);
    if (result == FACET_OK)
        result = facet_scene_describe_json(scene, &text, error);
    if (result == FACET_OK)
        result = print_description(run, model, text, error);
    interrupt_end();
    facet_text_destroy(text);
    facet_scene_destroy(scene);
    return result;
}

static facet_result inspect_one(verb_run *base, size_t i, facet_error *error)
{
    inspect_run *run = (inspect_run *)base;
    const char *model = run->models.models[i].path;
    if (i > 0 && !is_given(base->line, OPT_JSON))
        putchar('\n');
    facet_result result = inspect_model(run, model, error);
    if (result != FACET_OK)
        failure_complete(error, input_name(model), base->limits.max_memory_bytes);
    return result;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    command_line *c = base->line;
    if (c->argument_count == 0 && !is_given(c, OPT_FILES_FROM))
        return fail(error, FACET_ERROR_ARGUMENT, "inspect: which model? facet inspect helmet.glb");
    TRY(limits_read(c, &base->limits, error));
    return model_list_create(c, c->argument_count, &((inspect_run *)base)->models, error);
}

static facet_result inspect(verb_run *base, facet_error *error)
{
    (void)error;
    base->messages.verbosity = VERBOSITY_QUIET; /* the description lists the warnings */
    verb_run_models(base, &((inspect_run *)base)->models, inspect_one);
    return FACET_OK;
}

static void destroy(verb_run *base)
{
    model_list_destroy(&((inspect_run *)base)->models);
}

int cmd_inspect(command_line *c)
{
    static const verb_work work = {read_line, inspect, NULL, destroy}; /* it prints an object per model */
    inspect_run run = {.models = {.count = 0}};
    return verb_run_all(&run.base, c, &work);
}
