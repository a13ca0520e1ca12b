/* legacy_peers.c - error of the materials of converted models against those of the source OBJ file.
 *
 *     legacy_peers OLD.obj NAME=NEW.glb ...
 *
 * Prints one line per NEW: materials found by name, mean and largest E and E_display (docs/legacy.md, "The
 * error"). The file's colors count as linear, as in the other converters. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/model_file.h"
#include "legacy/convert_surface.h"
#include "legacy/fit.h"

static facet_scene *load(const char *path)
{
    facet_scene *scene = NULL;
    facet_error error;
    const facet_scene_desc desc = {.legacy.colors = FACET_LEGACY_COLORS_LINEAR};
    if (model_file_load(path, &desc, &scene, &error) != FACET_OK)
        fprintf(stderr, "%s\n", error.message);
    return scene;
}

/* SCENE_NONE: none. */
static uint32_t find_material(const facet_scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (strcmp(scene->materials[i].name, name) == 0)
            return i;
    return SCENE_NONE;
}

static bool is_black_surface(const ogl1_surface *s)
{
    float most = 0.0f;
    for (int i = 0; i < 3; i++)
        most = fmaxf(most, fmaxf(s->diffuse[i], s->specular[i]));
    return most < 0.001f;
}

static void compare(const fit_metric *metric, const facet_scene *old, const facet_scene *new,
                    const char *name)
{
    double sum = 0.0, sum_display = 0.0, worst = 0.0;
    uint32_t count = 0;
    const char *worst_name = "";
    for (uint32_t i = 0; i < old->material_count; i++) {
        uint32_t k = find_material(new, old->materials[i].name);
        ogl1_surface source;
        pbr_surface made;
        if (k == SCENE_NONE)
            continue;
        legacy_surface_of_ogl1(&old->legacy->materials[i], FACET_LEGACY_COLORS_LINEAR, &source);
        legacy_surface_of_pbr(&new->materials[k], &made);
        if (is_black_surface(&source)) /* the relative error is undefined */
            continue;
        fit_error error = fit_compare(metric, &source, &made, FIT_FROM_OGL1);
        sum += error.E;
        sum_display += error.E_display;
        if (error.E >= worst) {
            worst = error.E;
            worst_name = old->materials[i].name;
        }
        count++;
    }
    if (count)
        printf("  %-12s %3u materials  E %.3f  E_display %.3f  worst %.3f %s\n", name, count, sum / count,
               sum_display / count, worst, worst_name);
    else
        printf("  %-12s no material has its name\n", name);
}

int main(int argc, char **argv)
{
    facet_scene *old = argc > 2 ? load(argv[1]) : NULL;
    fit_metric *metric = NULL;
    if (!old || !old->legacy || fit_metric_create(NULL, PBR_CORRELATED, &metric, NULL) != FACET_OK) {
        fprintf(stderr, "legacy_peers: OLD.obj NAME=NEW.glb ... was expected\n");
        return 2;
    }
    printf("%s\n", argv[1]);
    for (int i = 2; i < argc; i++) {
        char *path = strchr(argv[i], '=');
        if (!path)
            continue;
        *path++ = 0;
        facet_scene *new = load(path);
        if (new)
            compare(metric, old, new, argv[i]);
        scene_destroy(new);
    }
    fit_metric_destroy(metric);
    scene_destroy(old);
    return 0;
}
