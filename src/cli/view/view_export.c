/* view_export.c - see view_export.h. One file holds one model; a folder holds a page for each model, an index, and the
 * viewer once. */
#include "cli/view/view_export.h"

#include "cli/render/render_options.h"
#include "cli/render/render_output.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/verb_run.h"
#include "cli/view/page.h"
#include "cli/view/page_preview.h"
#include "cli/view/viewer_package.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NAME_SIZE = 4096, STEM_SIZE = 256 };

typedef struct export_run {
    verb_run base;
    render_options options;
    model_list models;
    viewer_package package;
    const char *target; /* of --html */
    bool is_folder;
    bool keeps_existing;
    char (*stems)[STEM_SIZE]; /* of the pages in a folder, each once; "": the page failed */
    page_light light;
    json_t *pages; /* NULL without --json */
} export_run;

/* ---- the command line ---- */

/* Whether path names a folder: by its last character, or because it is one. */
static bool is_folder(const char *path)
{
    struct stat info;
    size_t length = strlen(path);
    return (length && path[length - 1] == '/') || (stat(path, &info) == 0 && S_ISDIR(info.st_mode));
}

/* Writes "FOLDER/PART" to name, or with three parts "FOLDER/PART/LAST". */
static facet_result join(const export_run *run, const char *part, const char *last, char name[NAME_SIZE],
                         facet_error *error)
{
    size_t length = strlen(run->target);
    const char *slash = length && run->target[length - 1] == '/' ? "" : "/";
    int size = snprintf(name, NAME_SIZE, "%s%s%s%s", run->target, slash, part, last);
    return size >= 0 && size < NAME_SIZE
               ? FACET_OK
               : fail(error, FACET_ERROR_ARGUMENT, "--html: %.200s..: the name is too long", name);
}

static facet_result check_options(const export_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    if (run->target[0] == 0)
        return option_fail(c, OPT_HTML, "the name of a page (page.html) or of a folder (pages/)", error);
    if (run->options.meters_exposure)
        return option_fail(c, OPT_EXPOSURE, "stops or a factor; a page has no light meter", error);
    if (!(run->options.renderer.features & FACET_RENDERER_FEATURE_GL))
        return option_fail(c, OPT_RENDERER, "gl; pages draw with WebGL", error);
    if (is_given(c, OPT_SCRIPT))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--script: it plays in a window, which --html does not open");
    if (run->is_folder) {
        char index[NAME_SIZE];
        TRY(join(run, "index.html", "", index, error));
        return output_check(index, error);
    }
    if (run->models.count > 1)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--html: %s is one file and holds one model; for %zu models name a folder, as in --html pages/",
            run->target, run->models.count);
    return output_check(run->target, error);
}

/* Gives each model of a folder a name for its page: its own without the extension, with a number where that is taken. */
static facet_result name_pages(export_run *run, facet_error *error)
{
    char stem[STEM_SIZE - 16];
    run->stems = calloc(run->models.count, sizeof *run->stems);
    if (!run->stems)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < run->models.count; i++) {
        const char *path = run->models.models[i].path;
        bool is_taken = true;
        if (!output_name_stem(!path ? "facet" : strcmp(path, "-") == 0 ? "model" : path, stem, sizeof stem))
            return fail(error, FACET_ERROR_ARGUMENT, "%s: the name is too long for a page", path);
        for (unsigned n = 1; is_taken; n++) {
            snprintf(run->stems[i], STEM_SIZE, n > 1 ? "%s-%u" : "%s", stem, n);
            is_taken = strcmp(run->stems[i], "index") == 0;
            for (size_t k = 0; k < i && !is_taken; k++)
                is_taken = strcmp(run->stems[k], run->stems[i]) == 0;
        }
    }
    return FACET_OK;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    export_run *run = (export_run *)base;
    command_line *c = base->line;
    run->target = option_text(c, OPT_HTML, "");
    run->is_folder = is_folder(run->target);
    run->keeps_existing = is_given(c, OPT_NO_CLOBBER);
    TRY(model_list_create(c, c->argument_count, &run->models, error));
    TRY(command_line_set(c, option_find_id(c->verb, OPT_RENDERER), "gl", SOURCE_PRESET, error));
    TRY(render_options_read(c, &run->options, error));
    base->limits = run->options.limits;
    TRY(check_options(run, error));
    TRY(name_pages(run, error));
    return viewer_package_find(&run->package, error);
}

/* ---- files ---- */

/* Refuses an output that is an input. scene NULL: none. */
static facet_result check_inputs(const export_run *run, const facet_scene *scene, const char *name,
                                 facet_error *error)
{
    bool is_input = strcmp(name, "-") != 0 && output_exists(name) &&
                    ((scene && facet_scene_has_file(scene, name)) ||
                     render_name_is_input(run->base.line, &run->options, NULL, name));
    for (size_t i = 0; !is_input && output_exists(name) && i < run->models.count; i++)
        is_input = run->models.models[i].path && input_is_same_file(run->models.models[i].path, name);
    return is_input ? fail(error, FACET_ERROR_ARGUMENT,
                           "%s: this input would be overwritten; name another output with --html", name)
                    : FACET_OK;
}

/* Copies the file at path to FOLDER/PART/NAME. */
static facet_result copy_file(const export_run *run, const facet_scene *scene, const char *path,
                              const char *part, const char *name, facet_error *error)
{
    char output[NAME_SIZE];
    file_bytes bytes = {0};
    TRY(join(run, part, name, output, error));
    TRY(check_inputs(run, scene, output, error));
    TRY(file_open(path, 0, &run->base.allocator, &bytes, error));
    facet_result result = output_write_bytes(bytes.data, bytes.size, output, error);
    file_close(&bytes);
    return result;
}

/* Copies the viewer to the folder: the files that pages/files.txt of the package names, a line each. */
static facet_result copy_viewer(export_run *run, facet_error *error)
{
    file_bytes list = {0};
    char path[2 * NAME_SIZE], name[256];
    TRY(viewer_package_open(&run->package, "pages/files.txt", &run->base.allocator, &list, error));
    facet_result result = FACET_OK;
    for (const char *line = (const char *)list.data; *line && result == FACET_OK;) {
        size_t length = strcspn(line, "\n");
        snprintf(name, sizeof name, "%.*s", (int)length, line);
        snprintf(path, sizeof path, "%s/%s", run->package.folder, name);
        if (length)
            result = copy_file(run, NULL, path, "", name, error);
        line += length + (line[length] == '\n');
    }
    file_close(&list);
    return result;
}

/* ---- a page ---- */

/* A model and its page. */
typedef struct page_run {
    export_run *run;
    const model_name *model;
    const char *stem; /* of a page in a folder */
    facet_scene *scene;
    page page;
    char title[STEM_SIZE];
    char output[NAME_SIZE];
    unsigned char *preview;
    size_t size; /* of the page in bytes */
} page_run;

static facet_result fill(page_run *p, const char *template, text *out, facet_error *error)
{
    export_run *run = p->run;
    file_bytes file = {0};
    TRY(viewer_package_open(&run->package, template, &run->base.allocator, &file, error));
    facet_result result = page_fill(&p->page, (const char *)file.data, file.size, out, error);
    file_close(&file);
    return result;
}

static facet_result write_page(page_run *p, const char *template, facet_error *error)
{
    text html = {.allocator = p->run->base.allocator};
    facet_result result = fill(p, template, &html, error);
    if (result == FACET_OK)
        result = output_write_bytes(html.data, html.length, p->output, error);
    p->size = html.length;
    text_destroy(&html);
    return result;
}

/* Writes the page and, beside it, its preview and the files of its model. */
static facet_result write_beside(page_run *p, facet_error *error)
{
    export_run *run = p->run;
    char preview_url[STEM_SIZE + 16], model_url[STEM_SIZE + 16], preview[NAME_SIZE];
    snprintf(preview_url, sizeof preview_url, "previews/%s.png", p->stem);
    snprintf(model_url, sizeof model_url, "models/%s/", p->stem);
    p->page.preview_url = preview_url;
    p->page.model_url = model_url;
    p->page.light_url = "light/";
    for (size_t i = 0; i < p->page.files.count; i++) {
        const page_file *file = &p->page.files.items[i];
        TRY(copy_file(run, p->scene, file->path, file->is_light ? p->page.light_url : model_url, file->name,
                      error));
    }
    TRY(join(run, preview_url, "", preview, error));
    TRY(check_inputs(run, p->scene, preview, error));
    TRY(output_write_bytes(p->page.preview, p->page.preview_size, preview, error));
    return write_page(p, "pages/model.html", error);
}

static void name_title(page_run *p)
{
    const char *given = option_text(p->run->base.line, OPT_TITLE, NULL);
    const char *path = p->model->path;
    p->page.title = given && !p->run->is_folder ? given : p->title;
    if (!output_name_stem(!path                    ? "facet"
                          : strcmp(path, "-") == 0 ? "model"
                                                   : path,
                          p->title, sizeof p->title))
        snprintf(p->title, sizeof p->title, "%.200s", path);
}

/* Whether the page holds the model as it was read instead of its files. */
static bool is_written(const page_run *p)
{
    const char *path = p->model->path;
    return path && (!facet_scene_get_file(p->scene, 0) || page_reads_otherwise(p->run->base.line));
}

/* Makes the page of a loaded model. */
static facet_result make_page(page_run *p, facet_error *error)
{
    export_run *run = p->run;
    const environment_input *light = is_given(run->base.line, OPT_ENV) ? &run->options.environment : NULL;
    TRY(check_inputs(run, p->scene, p->output, error));
    name_title(p);
    p->page.line = run->base.line;
    p->page.scene = p->scene;
    p->page.package = &run->package;
    const page_files_desc desc = {.scene = p->scene,
                                  .path = p->model->path,
                                  .is_written = is_written(p),
                                  .stem = p->title,
                                  .environment = light};
    TRY(page_files_create(&desc, &p->page.files, error));
    TRY(page_preview_render(&run->base, &run->options, &run->light, p->scene, p->model->path, p->output,
                            &p->preview, &p->page.preview_size, error));
    p->page.preview = p->preview;
    messages_flush(&run->base.messages);
    TRY(interrupt_check(p->output, error));
    return run->is_folder ? write_beside(p, error) : write_page(p, "pages/single.html", error);
}

static facet_result load_and_make(page_run *p, facet_error *error)
{
    export_run *run = p->run;
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    interrupt_begin_reading(input_name(p->model->path));
    facet_result result =
        input_load_shaded(p->model->path, &desc, run->options.desc.shading, &p->scene, error);
    interrupt_end();
    if (result == FACET_OK)
        result = make_page(p, error);
    facet_bytes_destroy(p->preview);
    page_files_destroy(&p->page.files);
    facet_scene_destroy(p->scene);
    return result;
}

static void report(const page_run *p, bool is_kept)
{
    export_run *run = p->run;
    const char *name = strcmp(p->output, "-") == 0 ? "stdout" : p->output;
    if (is_kept)
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: kept, since it exists", name);
    else
        message_at(&run->base.messages, VERBOSITY_DETAILS, "%s: %.2f MB", name, 1e-6 * (double)p->size);
    if (run->pages)
        json_array_append_new(run->pages, json_pack("{s:o, s:o, s:I, s:b}", "model",
                                                    report_string_json(input_name(p->model->path)), "output",
                                                    report_string_json(p->output), "bytes",
                                                    (json_int_t)p->size, "kept", (int)is_kept));
}

static facet_result export_one(verb_run *base, size_t i, facet_error *error)
{
    export_run *run = (export_run *)base;
    page_run p = {.run = run, .model = &run->models.models[i], .stem = run->stems[i]};
    facet_result result = FACET_OK;
    if (run->is_folder)
        result = join(run, p.stem, ".html", p.output, error);
    else
        snprintf(p.output, sizeof p.output, "%s", run->target);
    bool is_kept = result == FACET_OK && run->keeps_existing && output_exists(p.output);
    if (result == FACET_OK && !is_kept)
        result = load_and_make(&p, error);
    if (result == FACET_OK) {
        report(&p, is_kept);
        return result;
    }
    failure_complete(error, input_name(p.model->path), base->limits.max_memory_bytes);
    run->stems[i][0] = 0;
    return result;
}

/* ---- the folder ---- */

/* The links of the index. */
static void add_links(const export_run *run, text *out)
{
    for (size_t i = 0; i < run->models.count; i++) {
        if (!run->stems[i][0])
            continue;
        text_add(out, "<li><a href=\"");
        text_add_url(out, run->stems[i]);
        text_add(out, ".html\"><img src=\"previews/");
        text_add_url(out, run->stems[i]);
        text_add(out, ".png\" alt=\"\" loading=\"lazy\"><span>");
        text_add_html(out, run->stems[i]);
        text_add(out, "</span></a></li>\n");
    }
}

static facet_result write_index(export_run *run, facet_error *error)
{
    char name[NAME_SIZE];
    file_bytes file = {0};
    text links = {.allocator = run->base.allocator}, html = {.allocator = run->base.allocator};
    TRY(join(run, "index.html", "", name, error));
    TRY(check_inputs(run, NULL, name, error));
    TRY(viewer_package_open(&run->package, "pages/index.html", &run->base.allocator, &file, error));
    add_links(run, &links);
    const page p = {.line = run->base.line,
                    .title = option_text(run->base.line, OPT_TITLE, "Models"),
                    .links = links.data ? links.data : "",
                    .preview_url = "",
                    .model_url = ""};
    facet_result result = page_fill(&p, (const char *)file.data, file.size, &html, error);
    if (result == FACET_OK)
        result = output_write_bytes(html.data, html.length, name, error);
    text_destroy(&links);
    text_destroy(&html);
    file_close(&file);
    return result;
}

/* ---- the run ---- */

static facet_result export_all(verb_run *base, facet_error *error)
{
    export_run *run = (export_run *)base;
    run->pages = is_given(base->line, OPT_JSON) ? json_array() : NULL;
    if (run->options.note[0])
        message_at(&base->messages, VERBOSITY_NORMAL, "%s", run->options.note);
    if (run->is_folder)
        TRY(copy_viewer(run, error));
    verb_run_models(base, &run->models, export_one);
    if (!run->is_folder || base->is_interrupted || base->failure_count == run->models.count)
        return FACET_OK;
    return write_index(run, error);
}

static void add_json(const verb_run *base, json_t *root)
{
    json_object_set(root, "pages", ((const export_run *)base)->pages);
}

static void destroy(verb_run *base)
{
    export_run *run = (export_run *)base;
    json_decref(run->pages);
    facet_environment_destroy(run->light.environment);
    model_list_destroy(&run->models);
    free(run->stems);
}

int view_export(command_line *c)
{
    static const verb_work work = {read_line, export_all, add_json, destroy};
    export_run run = {.options = {.output = NULL}};
    return verb_run_all(&run.base, c, &work);
}
