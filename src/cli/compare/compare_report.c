/* compare_report.c - see compare_report.h. */
#include "cli/compare/compare_report.h"

#include "cli/shared/table.h"

#include <math.h>
#include <string.h>

/* A value with six digits; counts to the last one. */
static void format_value(const facet_comparison *c, int metric, char text[32])
{
    const double value = compare_metric_value(c, metric);
    if (isnan(value))
        snprintf(text, 32, "-");
    else if (strcmp(compare_metrics[metric].name, "differing") == 0)
        snprintf(text, 32, "%.0f", value);
    else
        snprintf(text, 32, "%.6g", value);
}

void compare_report_table(FILE *stream, const compare_wish *wish, const facet_comparison *c,
                          bool has_percentile)
{
    const bool is_percentile_shown = has_percentile && !wish->has_choice;
    table t = {.column_count = wish->has_choice ? 2 : 3};
    for (int i = 0; i < COMPARE_METRIC_COUNT; i++) {
        const compare_metric *m = &compare_metrics[i];
        const bool is_percentile = strcmp(m->name, "percentile") == 0;
        if (wish->has_choice ? !wish->is_chosen[i]
                             : !m->is_in_table && !(is_percentile && is_percentile_shown))
            continue;
        char value[32];
        format_value(c, i, value);
        table_add(&t, "%s", m->name);
        table_add(&t, "%s", value);
        if (!wish->has_choice)
            table_add(&t, "%s", m->meaning);
    }
    if (!wish->has_choice)
        fprintf(stream, "%u x %u pixels, %s, %s\n", c->width, c->height,
                c->space == FACET_COMPARE_SPACE_LINEAR ? "as light" : "as a display shows them",
                c->is_equal ? "equal" : "different");
    table_print(&t, stream, wish->has_choice ? 0 : 2);
    if (!wish->has_choice && c->space == FACET_COMPARE_SPACE_LINEAR)
        fprintf(stream, "psnr and ssim: of the largest value, %.6g\n", c->peak);
    if (!wish->has_choice && c->is_flip_hdr)
        fprintf(stream, "flip: the largest of %u exposures from %+.2f to %+.2f stops\n",
                c->flip_exposure_count, c->flip_start_ev, c->flip_stop_ev);
    if (!wish->has_choice && c->differing_count)
        fprintf(stream, "the largest error is at %u,%u\n", c->max_x, c->max_y);
}

/* ---- limits ---- */

static bool has_limit(const compare_wish *w, int metric)
{
    return w->limits[metric].has_max || w->limits[metric].has_min;
}

void compare_report_failures(const compare_wish *wish, const facet_comparison *c, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    if (wish->has_limits && c->invalid_count)
        used += (size_t)snprintf(text, size,
                                 c->invalid_count == 1 ? "%llu pixel is not finite in one of them"
                                                       : "%llu pixels are not finite in one of them",
                                 (unsigned long long)c->invalid_count);
    for (int i = 0; i < COMPARE_METRIC_COUNT && used < size; i++) {
        const double value = compare_metric_value(c, i);
        if (!has_limit(wish, i) || compare_limit_holds(wish, i, value))
            continue;
        const bool is_max = wish->limits[i].has_max;
        const double limit = is_max ? wish->limits[i].max : wish->limits[i].min;
        char number[32];
        format_value(c, i, number);
        if (isnan(value))
            used += (size_t)snprintf(text + used, size - used, "%s%s cannot be measured", used ? ", " : "",
                                     compare_metrics[i].name);
        else
            used += (size_t)snprintf(text + used, size - used, "%s%s %s is %s than %.6g", used ? ", " : "",
                                     compare_metrics[i].name, number, is_max ? "more" : "less", limit);
    }
}

/* ---- JSON ---- */

static json_t *number_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *limits_json(const compare_wish *wish, const facet_comparison *c)
{
    json_t *list = json_array();
    for (int i = 0; i < COMPARE_METRIC_COUNT; i++) {
        if (!has_limit(wish, i))
            continue;
        const compare_limit *l = &wish->limits[i];
        const double value = compare_metric_value(c, i);
        json_array_append_new(list,
                              json_pack("{s:s, s:f, s:o, s:b}", "metric", compare_metrics[i].name,
                                        l->has_max ? "max" : "min", l->has_max ? l->max : l->min, "value",
                                        number_json(value), "holds",
                                        (int)(compare_limit_holds(wish, i, value) && !c->invalid_count)));
    }
    return list;
}

json_t *compare_report_json(const compare_wish *wish, const facet_comparison *c)
{
    json_t *metrics = json_object();
    for (int i = 0; i < COMPARE_METRIC_COUNT; i++) {
        const double value = compare_metric_value(c, i);
        const bool is_count = strcmp(compare_metrics[i].name, "differing") == 0;
        json_object_set_new(metrics, compare_metrics[i].name,
                            is_count ? json_integer((json_int_t)c->differing_count) : number_json(value));
    }
    json_t *exposures = json_null();
    if (c->is_flip_hdr)
        exposures = json_pack("{s:f, s:f, s:I}", "start", c->flip_start_ev, "stop", c->flip_stop_ev, "count",
                              (json_int_t)c->flip_exposure_count);
    json_t *largest =
        c->differing_count ? json_pack("[I, I]", (json_int_t)c->max_x, (json_int_t)c->max_y) : json_null();
    return json_pack("{s:I, s:I, s:s, s:I, s:I, s:b, s:o, s:o, s:o, s:f, s:{s:I, s:I, s:I}, s:o}", "width",
                     (json_int_t)c->width, "height", (json_int_t)c->height, "space",
                     c->space == FACET_COMPARE_SPACE_LINEAR ? "linear" : "display", "channels",
                     (json_int_t)c->channel_count, "pixels", (json_int_t)c->pixel_count, "equal",
                     (int)c->is_equal, "metrics", metrics, "flip_exposures", exposures, "max_at", largest,
                     "peak", c->peak, "nonfinite", "a", (json_int_t)c->nonfinite_a, "b",
                     (json_int_t)c->nonfinite_b, "invalid", (json_int_t)c->invalid_count, "limits",
                     limits_json(wish, c));
}
