/* compare_metrics.h - the metrics of facet compare, limits on them, and their report. */
#ifndef CLI_COMPARE_METRICS_H
#define CLI_COMPARE_METRICS_H

#include <stdio.h>
#include <jansson.h>
#include "cli/shared/command_line.h"

enum { COMPARE_METRIC_COUNT = 20 };

typedef struct compare_metric {
    const char *name;
    bool is_similarity;  /* grows with similarity */
    unsigned skip;       /* FACET_METRIC_* that it needs; 0: always measured */
    bool is_in_table;    /* printed without --metric */
    const char *meaning; /* for people */
} compare_metric;

/* In the order of the words of --metric. */
extern const compare_metric compare_metrics[COMPARE_METRIC_COUNT];

double compare_metric_value(const facet_comparison *c, int metric);

typedef struct compare_limit {
    bool has_max, has_min;
    double max, min;
} compare_limit;

/* Metrics to print, and limits. */
typedef struct compare_wish {
    bool is_chosen[COMPARE_METRIC_COUNT]; /* by --metric */
    bool has_choice, has_limits;
    compare_limit limits[COMPARE_METRIC_COUNT];
} compare_wish;

/* Reads --metric, --max and --min. Fails with FACET_ERROR_ARGUMENT. */
facet_result compare_wish_read(const command_line *c, compare_wish *out, facet_error *error);
/* The metrics to skip, for facet_compare_desc. */
uint32_t compare_wish_skipped(const compare_wish *w);

/* Whether the limits of a metric hold; those of unmeasured metrics do not. */
bool compare_limit_holds(const compare_wish *w, int metric, double value);

/* Prints the chosen metrics, or the main ones. */
void compare_report_table(FILE *stream, const compare_wish *wish, const facet_comparison *c,
                          bool has_percentile);

/* Writes "flip 0.051 is more than 0.02, .." for the limits that do not hold; "" if all hold. */
void compare_report_failures(const compare_wish *wish, const facet_comparison *c, char *text, size_t size);

/* Members of the JSON object: space, size, metrics, limits; NULL: no memory. NaN and infinity are null. */
json_t *compare_report_json(const compare_wish *wish, const facet_comparison *c);

#endif
