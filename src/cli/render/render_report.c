/* render_report.c - what facet render did. */
#include "cli/render/render_report.h"

#include "cli/shared/interrupt.h"
#include "cli/shared/terminal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Per pixel, the mean. */
static double samples_taken(const picture_report *p)
{
    double pixels = (double)p->width * p->height;
    return p->stats.samples && pixels > 0.0 ? (double)p->stats.samples / pixels : p->samples;
}

void report_partial(messages *m, const picture_report *p, const char *resume_with)
{
    if (!p->stats.is_partial)
        return;
    char text[1200];
    const char *checkpoint = resume_with ? resume_with : "";
    const facet_log log = messages_log(m);
    snprintf(text, sizeof text, "%.400s: the image is partial: %s after %.1f of %u samples per pixel%s%.400s",
             strcmp(p->output, "-") == 0 ? "stdout" : p->output,
             interrupt_signal() ? "interrupted" : "the time limit came", samples_taken(p), p->samples,
             *checkpoint ? "; --resume goes on with " : "", checkpoint);
    log.message(log.user, FACET_LOG_LEVEL_WARNING, text);
}

void report_picture(const messages *m, const picture_report *p, bool is_news)
{
    if (strcmp(p->output, "-") == 0)
        is_news = false;
    verbosity least = is_news || terminal_is(stderr) ? VERBOSITY_NORMAL : VERBOSITY_DETAILS;
    const char *name = strcmp(p->output, "-") == 0 ? "stdout" : p->output;
    if (p->is_kept) {
        message_at(m, VERBOSITY_NORMAL, "%s: kept; it was there already", name);
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

json_t *report_picture_json(const picture_report *p)
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
