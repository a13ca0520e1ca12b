/* compare_metrics.c - see compare_metrics.h. */
#include "cli/compare/compare_metrics.h"

#include "cli/shared/failure.h"
#include "cli/shared/terminal.h"
#include "cli/shared/value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const compare_metric compare_metrics[COMPARE_METRIC_COUNT] = {
    {"flip", false, FACET_METRIC_FLIP, true, "mean FLIP: 0 the same, 1 as different as can be to an eye"},
    {"flip-max", false, FACET_METRIC_FLIP, true, "largest FLIP of a pixel"},
    {"ssim", true, FACET_METRIC_SSIM, true, "structural similarity of luminance: 1 the same"},
    {"ssim-channels", true, FACET_METRIC_SSIM, true, "the same, mean over the channels"},
    {"psnr", true, 0, true, "peak signal to noise ratio, dB"},
    {"mse", false, 0, true, "mean squared error"},
    {"rmse", false, 0, true, "its root"},
    {"mse-relative", false, 0, true, "mean of squared error over the squared reference"},
    {"rmse-relative", false, 0, false, "its root"},
    {"nrmse", false, 0, true, "rmse over the root mean square of the reference"},
    {"mae", false, 0, true, "mean absolute error"},
    {"bias", false, 0, true, "mean of B - A"},
    {"max", false, 0, true, "largest absolute error of a channel"},
    {"p50", false, 0, true, "error that half of the pixels do not exceed"},
    {"p95", false, 0, true, "error that 95 % do not exceed"},
    {"p99", false, 0, true, "error that 99 % do not exceed"},
    {"p99.9", false, 0, true, "error that 99.9 % do not exceed"},
    {"percentile", false, 0, false, "error that the share of --percentile does not exceed"},
    {"differing", false, 0, true, "pixels that differ by more than the threshold"},
    {"differing-share", false, 0, true, "their share"},
};

double compare_metric_value(const facet_comparison *c, int metric)
{
    const double values[COMPARE_METRIC_COUNT] = {
        c->flip,          c->flip_max,       c->ssim,         c->ssim_channels,           c->psnr,
        c->mse,           c->rmse,           c->mse_relative, c->rmse_relative,           c->nrmse,
        c->mae,           c->bias,           c->max_error,    c->percentile_50,           c->percentile_95,
        c->percentile_99, c->percentile_999, c->percentile,   (double)c->differing_count, c->differing_share};
    return values[metric];
}

/* ---- reading ---- */

static int find_metric(const char *name, size_t length)
{
    for (int i = 0; i < COMPARE_METRIC_COUNT; i++)
        if (strlen(compare_metrics[i].name) == length && memcmp(compare_metrics[i].name, name, length) == 0)
            return i;
    return -1;
}

static facet_result set_limit(compare_wish *w, int metric, bool is_max, double limit, facet_error *error)
{
    const compare_metric *m = &compare_metrics[metric];
    if (m->is_similarity == is_max)
        return fail(error, FACET_ERROR_ARGUMENT,
                    is_max ? "--max: %s grows with similarity; write --min %s=%g"
                           : "--min: %s shrinks with similarity; write --max %s=%g",
                    m->name, m->name, limit);
    compare_limit *l = &w->limits[metric];
    if (is_max) {
        l->has_max = true;
        l->max = limit;
    } else {
        l->has_min = true;
        l->min = limit;
    }
    w->has_limits = true;
    return FACET_OK;
}

/* The metric of a limit without a name: the only one of --metric. */
static facet_result only_metric(const compare_wish *w, const char *label, const char *text, int *metric,
                                facet_error *error)
{
    int count = 0;
    for (int i = 0; i < COMPARE_METRIC_COUNT; i++)
        if (w->is_chosen[i]) {
            *metric = i;
            count++;
        }
    if (count == 1)
        return FACET_OK;
    return fail(
        error, FACET_ERROR_ARGUMENT,
        "%s: the limit %.40s names no metric; write %s NAME=%.40s, as flip=0.02, or choose one with --metric",
        label, text, label, text);
}

/* NAME=X,NAME=X or X. */
static facet_result read_limits(const command_line *c, option_id id, compare_wish *w, facet_error *error)
{
    const bool is_max = id == OPT_MAX;
    const char *label = is_max ? "--max" : "--min";
    const char *at = option_text(c, id, NULL);
    while (at && *at) {
        const size_t length = strcspn(at, ",");
        const char *equals = memchr(at, '=', length);
        const char *number = equals ? equals + 1 : at;
        char text[64];
        double limit;
        int metric = equals ? find_metric(at, (size_t)(equals - at)) : 0;
        if (metric < 0)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "%s: there is no metric \"%.*s\"; facet help compare lists the metrics", label,
                        (int)(equals - at), at);
        snprintf(text, sizeof text, "%.*s", (int)(length - (size_t)(number - at)), number);
        if (!value_number(text, &limit))
            return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is not a number; NAME=X was expected, as %s",
                        label, text, is_max ? "flip=0.02" : "psnr=40");
        facet_result result = equals ? FACET_OK : only_metric(w, label, text, &metric, error);
        if (result == FACET_OK)
            result = set_limit(w, metric, is_max, limit, error);
        if (result != FACET_OK)
            return result;
        at += length;
        at += *at == ',';
    }
    return FACET_OK;
}

facet_result compare_wish_read(const command_line *c, compare_wish *out, facet_error *error)
{
    *out = (compare_wish){0};
    for (const char *at = option_text(c, OPT_METRIC, NULL); at && *at; at += *at == ',') {
        const size_t length = strcspn(at, ",");
        const int metric = find_metric(at, length);
        if (metric >= 0) /* checked by the option table */
            out->is_chosen[metric] = out->has_choice = true;
        at += length;
    }
    facet_result result = read_limits(c, OPT_MAX, out, error);
    if (result == FACET_OK)
        result = read_limits(c, OPT_MIN, out, error);
    const int percentile = find_metric("percentile", strlen("percentile"));
    const compare_limit *l = &out->limits[percentile];
    if (result == FACET_OK && (out->is_chosen[percentile] || l->has_max) && !is_given(c, OPT_PERCENTILE))
        result = fail(error, FACET_ERROR_ARGUMENT, "--metric: percentile needs --percentile P");
    return result;
}

uint32_t compare_wish_skipped(const compare_wish *w)
{
    unsigned needed = 0;
    bool has_any = w->has_choice || w->has_limits;
    for (int i = 0; i < COMPARE_METRIC_COUNT; i++)
        if (!has_any || w->is_chosen[i] || w->limits[i].has_max || w->limits[i].has_min)
            needed |= compare_metrics[i].skip;
    return (FACET_METRIC_FLIP | FACET_METRIC_SSIM) & ~needed;
}

bool compare_limit_holds(const compare_wish *w, int metric, double value)
{
    const compare_limit *l = &w->limits[metric];
    if (compare_metrics[metric].is_similarity)
        return !l->has_min || value >= l->min;
    return !l->has_max || fabs(value) <= l->max; /* the magnitude of a bias */
}

/* ---- reports ---- */

/* Formats a value with six digits; counts in full. */
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
                c->space == FACET_COMPARE_SPACE_LINEAR ? "as light" : "as display values",
                c->is_equal ? "equal" : "different");
    table_print(&t, stream, wish->has_choice ? 0 : 2);
    if (!wish->has_choice && c->space == FACET_COMPARE_SPACE_LINEAR)
        fprintf(stream, "psnr and ssim: for a peak of %.6g\n", c->peak);
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
                                 c->invalid_count == 1 ? "%llu pixel is not finite in one image"
                                                       : "%llu pixels are not finite in one image",
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
