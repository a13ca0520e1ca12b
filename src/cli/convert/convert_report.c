/* convert_report.c - see convert_report.h. */
#include "cli/convert/convert_report.h"

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/json_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const grade_names[] = {"good", "fair", "poor", "bad"};

conversion_totals conversion_sum(const facet_scene *scene)
{
    conversion_totals t = {.count = facet_scene_get_conversion_count(scene)};
    for (uint32_t i = 0; i < t.count; i++) {
        facet_conversion one = facet_scene_get_conversion(scene, i);
        if (isnan(one.error_graded))
            continue;
        t.grades[one.grade]++;
        t.mean_error += one.error;
        t.mean_display += one.error_display;
        t.mean_drawn += one.error_drawn;
        if (t.told == 0 || one.error_graded > t.worst.error_graded)
            t.worst = one;
        t.told++;
    }
    if (t.told) {
        t.mean_error /= t.told;
        t.mean_display /= t.told;
        t.mean_drawn /= t.told;
    }
    return t;
}

/* ---- for people ---- */

static int compare_errors(const void *a, const void *b)
{
    const facet_conversion *x = a, *y = b;
    double p = isnan(x->error_graded) ? -1.0 : x->error_graded;
    double q = isnan(y->error_graded) ? -1.0 : y->error_graded;
    return p > q ? -1 : p < q ? 1 : strcmp(x->name, y->name);
}

static void print_material(const messages *m, verbosity least, const char *model, const facet_conversion *one)
{
    char drawn[64] = "";
    if (isnan(one->error)) {
        message_at(m, least, "%s: material \"%s\": %s", model, one->name, one->method);
        return;
    }
    if (!isnan(one->error_drawn) && one->grade_drawn != one->grade)
        snprintf(drawn, sizeof drawn, ", as drawn %.3f (%s)", one->error_drawn,
                 grade_names[one->grade_drawn]);
    else if (!isnan(one->error_drawn))
        snprintf(drawn, sizeof drawn, ", as drawn %.3f", one->error_drawn);
    message_at(m, least, "%s: material \"%s\": %s, E %.3f, on a screen %.3f%s (%s, %s)", model, one->name,
               grade_names[one->grade], one->error, one->error_display, drawn, one->method, one->profile);
}

static void print_materials(const messages *m, const char *model, const facet_scene *scene, uint32_t count)
{
    enum { MOST_LINES = 8 }; /* without -v */
    facet_conversion *all = malloc(count * sizeof *all);
    if (!all)
        return;
    for (uint32_t i = 0; i < count; i++)
        all[i] = facet_scene_get_conversion(scene, i);
    qsort(all, count, sizeof *all, compare_errors);
    for (uint32_t i = 0; i < count; i++) {
        bool is_news = i < MOST_LINES && !isnan(all[i].error) && all[i].grade >= FACET_CONVERSION_GRADE_POOR;
        print_material(m, is_news ? VERBOSITY_NORMAL : VERBOSITY_DETAILS, model, &all[i]);
    }
    free(all);
}

void convert_report_print(const messages *m, const char *model, const facet_scene *scene)
{
    conversion_totals t = conversion_sum(scene);
    if (t.count == 0)
        return;
    print_materials(m, model, scene, t.count);
    if (t.told == 0)
        return;
    char grades[128] = "";
    for (int i = 0; i <= FACET_CONVERSION_GRADE_BAD; i++)
        if (t.grades[i]) {
            size_t used = strlen(grades);
            snprintf(grades + used, sizeof grades - used, "%s%u %s", used ? ", " : "", t.grades[i],
                     grade_names[i]);
        }
    char worst[256] = "";
    if (t.worst.error_graded > 0.005)
        snprintf(worst, sizeof worst, "; worst \"%.200s\" with %.3f", t.worst.name, t.worst.error_graded);
    char drawn[64] = "";
    if (!isnan(t.mean_drawn))
        snprintf(drawn, sizeof drawn, ", as OpenGL 1 programs draw %.3f", t.mean_drawn);
    message_at(m, VERBOSITY_NORMAL,
               "%s: %u material%s converted: %s; mean error E %.3f, on a screen %.3f%s%s", model, t.count,
               t.count == 1 ? "" : "s", grades, t.mean_error, t.mean_display, drawn, worst);
}

/* ---- for programs ---- */

json_t *convert_report_json(const facet_scene *scene)
{
    conversion_totals t = conversion_sum(scene);
    if (t.count == 0)
        return json_null();
    json_t *root = json_object();
    json_object_set_new(root, "count", json_integer(t.count));
    for (int i = 0; i <= FACET_CONVERSION_GRADE_BAD; i++)
        json_object_set_new(root, grade_names[i], json_integer(t.grades[i]));
    json_object_set_new(root, "mean_E", t.told ? json_real(t.mean_error) : json_null());
    json_object_set_new(root, "worst", t.told ? report_string_json(t.worst.name) : json_null());
    json_object_set_new(root, "worst_E", t.told ? json_real(t.worst.error) : json_null());
    json_object_set_new(root, "worst_E_display", t.told ? json_real(t.worst.error_display) : json_null());
    bool has_drawn = t.told && !isnan(t.mean_drawn);
    json_object_set_new(root, "mean_E_drawn", has_drawn ? json_real(t.mean_drawn) : json_null());
    json_object_set_new(root, "worst_E_drawn", has_drawn ? json_real(t.worst.error_drawn) : json_null());
    return root;
}

facet_result convert_report_write(const facet_scene *scene, bool is_html, const char *path,
                                  facet_error *error)
{
    char *text = NULL;
    facet_result result = facet_scene_report_conversion(
        scene, is_html ? FACET_REPORT_FORMAT_HTML : FACET_REPORT_FORMAT_JSON, &text, error);
    if (result == FACET_OK)
        result = output_write_bytes(text, strlen(text), path, error);
    facet_text_destroy(text);
    return result;
}
