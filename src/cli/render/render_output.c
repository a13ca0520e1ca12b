/* render_output.c - see render_output.h. */
#include "cli/render/render_output.h"

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/terminal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

facet_result render_checkpoint_name(const render_options *o, const model_name *model, uint32_t number,
                                    char *name, size_t size, facet_error *error)
{
    *name = 0;
    if (!o->checkpoint || output_name_expand(o->checkpoint, model, &number, name, size))
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "--checkpoint: the name for %s is too long",
                input_name(model->path));
}

facet_result render_name(const render_options *o, const model_name *model, uint32_t number, char *name,
                         size_t size, facet_error *error)
{
    if (o->is_stdout) {
        memcpy(name, "-", 2);
        return FACET_OK;
    }
    char pattern[64];
    const char *used = o->output;
    if (!used) {
        snprintf(pattern, sizeof pattern, o->is_sequence && !o->video ? "{stem}_####.%s" : "{stem}.%s",
                 o->video == VIDEO_Y4M ? "y4m" : render_extension(o->save.format));
        used = pattern;
    }
    if (!output_name_expand(used, model, &number, name, size))
        return fail(error, FACET_ERROR_ARGUMENT, "--output: the name for %s is too long",
                    input_name(model->path));
    return FACET_OK;
}

bool render_name_is_input(const command_line *c, const render_options *o, const char *model, const char *name)
{
    const char *config_path = option_text(c, OPT_CONFIG, NULL);
    if (o->is_stdout || o->keeps_existing || !output_exists(name))
        return false;
    return (model && strcmp(model, "-") != 0 && input_is_same_file(model, name)) ||
           environment_input_is_file(&o->environment, name) ||
           (config_path && input_is_same_file(name, config_path));
}

/* A checkpoint replaces an earlier checkpoint only, which is checked when that is read. */
static facet_result check_checkpoint(const command_line *c, const render_options *o, const model_name *model,
                                     const char *image, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    facet_result result = render_checkpoint_name(o, model, 1, name, sizeof name, error);
    if (result != FACET_OK || !o->checkpoint)
        return result;
    result = output_check(name, error);
    if (result == FACET_OK && output_exists(name) &&
        (render_name_is_input(c, o, model->path, name) ||
         (output_exists(image) && input_is_same_file(name, image))))
        result = fail(error, FACET_ERROR_ARGUMENT,
                      "--checkpoint: %s is an input or the image itself and would be overwritten", name);
    return result;
}

/* Checks the first image of a model. */
static facet_result check_model(const command_line *c, const render_options *o, const model_name *model,
                                output_claim *claim, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    TRY(render_name(o, model, 1, name, sizeof name, error));
    TRY(output_check(name, error));
    if (render_name_is_input(c, o, model->path, name))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: this input would be overwritten; name another output with -o", name);
    TRY(check_checkpoint(c, o, model, name, error));
    claim->identity = output_identity(name);
    return claim->identity ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
}

facet_result render_names_check(const command_line *c, const render_options *o, model_list *models,
                                facet_error *error)
{
    size_t count = models->count;
    output_claim *claims = calloc(count, sizeof *claims);
    facet_result result = claims ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        claims[i].model = i;
        result = check_model(c, o, &models->models[i], &claims[i], error);
    }
    if (result == FACET_OK && !o->is_stdout)
        model_list_find_clashes(models, claims, count);
    for (size_t i = 0; claims && i < count; i++)
        free(claims[i].identity);
    free(claims);
    return result;
}

facet_result render_write(const render_options *o, const facet_image *image, const char *name,
                          const facet_allocator *allocator, video *frames, facet_error *error)
{
    if (frames)
        return video_add(frames, image, allocator, o->limits.thread_count, error);
    facet_image_save_desc save = o->save;
    save.allocator = *allocator;
    if (interrupt_signal() && facet_image_get_render_stats(image).is_partial)
        save.tag = NULL; /* what has the tag is complete */
    if (!o->id_layer)
        return output_write(image, name, &save, error);
    facet_image *colors = NULL;
    facet_result result = facet_image_create_id_colors(image, o->id_layer, allocator, &colors, error);
    if (result == FACET_OK)
        result = output_write(colors, name, &save, error);
    facet_image_destroy(colors);
    return result;
}

/* ---- reports ---- */

/* Mean samples per pixel. */
static double samples_taken(const image_report *p)
{
    double pixels = (double)p->width * p->height;
    return p->stats.samples && pixels > 0.0 ? (double)p->stats.samples / pixels : p->samples;
}

void report_partial(messages *m, const image_report *p, const char *resume_with)
{
    if (!p->stats.is_partial)
        return;
    const char *checkpoint = resume_with ? resume_with : "";
    const facet_log log = messages_log(m);
    log_warning(&log, "%.400s: the image is partial: %s after %.1f of %u samples per pixel%s%.400s",
                strcmp(p->output, "-") == 0 ? "stdout" : p->output,
                interrupt_signal() ? "interrupted" : "the time limit was reached", samples_taken(p),
                p->samples, *checkpoint ? "; --resume continues " : "", checkpoint);
}

void report_image(const messages *m, const image_report *p, bool is_news)
{
    if (strcmp(p->output, "-") == 0)
        is_news = false;
    verbosity least = is_news || terminal_is(stderr) ? VERBOSITY_NORMAL : VERBOSITY_DETAILS;
    const char *name = strcmp(p->output, "-") == 0 ? "stdout" : p->output;
    if (p->is_kept) {
        message_at(m, VERBOSITY_NORMAL, "%s: kept, since it exists", name);
        return;
    }
    const facet_render_stats *s = &p->stats;
    double drawn = samples_taken(p);
    message_at(m, least, "%s: %ux%u, %.4g %s, %.2f s", name, p->width, p->height, drawn,
               drawn < 1.5 ? "sample" : "samples", p->total_s);
    if (s->samples)
        message_at(m, VERBOSITY_DETAILS, "%s: %.1f of %u samples per pixel on average, %.2f M rays/s", name,
                   drawn, p->samples, 1e-6 * (double)s->rays / s->shade_s);
    message_at(
        m, VERBOSITY_TIMINGS,
        "%s: load %.1f ms, textures %.1f ms, geometry %.1f ms, light %.1f ms, shade %.1f ms, render %.1f ms, "
        "save %.1f ms; %u threads",
        name, 1e3 * p->load_s, 1e3 * s->textures_s, 1e3 * s->geometry_s, 1e3 * s->light_s, 1e3 * s->shade_s,
        1e3 * s->total_s, 1e3 * p->save_s, s->thread_count);
}

json_t *report_image_json(const image_report *p)
{
    const facet_render_stats *s = &p->stats;
    if (p->is_kept)
        return json_pack("{s:o, s:o, s:b}", "model", report_string_json(p->model), "output",
                         report_string_json(p->output), "kept", 1);
    return json_pack("{s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}, "
                     "s:I, s:I, s:I, s:I, s:f, s:b, s:f}",
                     "model", report_string_json(p->model), "output", report_string_json(p->output), "width",
                     (json_int_t)p->width, "height", (json_int_t)p->height, "samples", (json_int_t)p->samples,
                     "rays", (json_int_t)s->rays, "shades", (json_int_t)s->shades, "seconds", "total",
                     p->total_s, "load", p->load_s, "textures", s->textures_s, "geometry", s->geometry_s,
                     "light", s->light_s, "shade", s->shade_s, "render", s->total_s, "denoise", s->denoise_s,
                     "save", p->save_s, "decoded_texels", (json_int_t)s->decoded_texels, "threads",
                     (json_int_t)s->thread_count, "light_samples", (json_int_t)s->samples, "dropped_samples",
                     (json_int_t)s->dropped_samples, "samples_taken", samples_taken(p), "partial",
                     (int)s->is_partial, "exposure", p->exposure_ev);
}
