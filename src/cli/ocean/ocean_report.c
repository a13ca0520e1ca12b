/* ocean_report.c - see ocean_run.h: the sea as text and as JSON. */
#include "cli/ocean/ocean_run.h"

#include <math.h>
#include <stdio.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

static void print_rgb(const char *what, const double rgb[3], const char *unit)
{
    printf("%-18s %.4g %.4g %.4g%s\n", what, rgb[0], rgb[1], rgb[2], unit);
}

/* As in --wind: degrees from +Z towards +X. */
static double wind_azimuth(const facet_sea_desc *d)
{
    return remainder(90.0 - round((double)d->wind_direction_rad / DEGREE * 1e4) * 1e-4, 360.0);
}

void ocean_report_print(const ocean_run *run)
{
    const facet_sea_desc *d = &run->options.sea;
    facet_sea_info i = facet_sea_get_info(run->sea);
    printf("%-18s %g m/s towards %g degrees", "wind", (double)d->wind_mps, wind_azimuth(d));
    if (isinf(d->fetch_m))
        printf(" without limit of fetch\n");
    else
        printf(" over %g km\n", 1e-3 * (double)d->fetch_m);
    printf("%-18s %.3g m\n", "significant height", i.height_m);
    if (i.height_m > 0.0)
        printf("%-18s %.3g s, %.3g m\n", "peak", i.peak_period_s, i.peak_length_m);
    printf("%-18s %.4g along the wind, %.4g across; %.4g, %.4g of it in tiles\n", "slope variance",
           i.slope_variance[0], i.slope_variance[1], i.resolved_slope_variance[0],
           i.resolved_slope_variance[1]);
    printf("%-18s %.3g %%\n", "foam", 100.0 * i.foam_coverage);
    printf("%-18s %.5g, %.4g %% reflected straight down\n", "index of refraction", i.ior,
           100.0 * pow((i.ior - 1.0) / (i.ior + 1.0), 2.0));
    print_rgb("absorption", i.absorption, " 1/m");
    print_rgb("scattering", i.scattering, " 1/m");
    print_rgb("backscattering", i.backscattering, " 1/m");
    print_rgb("reflectance", i.reflectance, " of deep water");
    if (d->bed.depth_m > 0.0f)
        printf("%-18s %g m below, rising %g\n", "bed", (double)d->bed.depth_m, (double)d->bed.slope);
    for (uint32_t t = 0; t < i.tile_count; t++)
        printf("%s %u%*s %.4g m, turned by %.0f degrees\n", "tile", t, 12, "", i.tile_length_m[t],
               i.tile_turn_rad[t] / DEGREE);
}

static json_t *rgb_json(const double rgb[3])
{
    return json_pack("[f, f, f]", rgb[0], rgb[1], rgb[2]);
}

json_t *ocean_report_json(const ocean_run *run)
{
    const facet_sea_desc *d = &run->options.sea;
    facet_sea_info i = facet_sea_get_info(run->sea);
    json_t *tiles = json_array();
    for (uint32_t t = 0; t < i.tile_count; t++)
        json_array_append_new(tiles, json_pack("{s:f, s:f, s:i}", "length_m", i.tile_length_m[t], "turn_rad",
                                               i.tile_turn_rad[t], "samples", (int)d->resolution));
    json_t *fetch = isinf(d->fetch_m) ? json_null() : json_real((double)d->fetch_m);
    return json_pack(
        "{s:f, s:f, s:o, s:f, s:f, s:f, s:f, s:[f, f], s:[f, f], s:f, s:f, s:o, s:o, s:o, s:o, s:f, s:o}",
        "wind_mps", (double)d->wind_mps, "wind_azimuth_deg", wind_azimuth(d), "fetch_m", fetch, "choppiness",
        (double)d->choppiness, "height_m", i.height_m, "peak_period_s", i.peak_period_s, "peak_length_m",
        i.peak_length_m, "slope_variance", i.slope_variance[0], i.slope_variance[1],
        "resolved_slope_variance", i.resolved_slope_variance[0], i.resolved_slope_variance[1],
        "foam_coverage", i.foam_coverage, "ior", i.ior, "absorption", rgb_json(i.absorption), "scattering",
        rgb_json(i.scattering), "backscattering", rgb_json(i.backscattering), "reflectance",
        rgb_json(i.reflectance), "bed_depth_m", (double)d->bed.depth_m, "tiles", tiles);
}

static json_t *numbers_json(const float *numbers, size_t count)
{
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(list, json_real((double)numbers[i]));
    return list;
}

json_t *ocean_report_image_json(const ocean_run *run, const image_report *p)
{
    json_t *all = report_image_json(p);
    const facet_camera camera = ocean_run_camera(run, &run->options);
    if (!all || run->options.sweep) /* whose images have their own values each */
        return all;
    json_object_set_new(all, "ev100", json_real(run->ev100));
    json_object_set_new(all, "exposure", json_real((double)facet_exposure_from_ev100(run->ev100)));
    json_object_set_new(all, "time_s", json_real(run->time_s));
    json_object_set_new(all, "camera",
                        json_pack("{s:o, s:o, s:f}", "eye", numbers_json(camera.eye, 3), "target",
                                  numbers_json(camera.target, 3), "fov_y_rad", (double)camera.fov_y_rad));
    json_t *matrices = json_array();
    for (uint32_t i = 0; i < run->options.model_count; i++)
        json_array_append_new(matrices, numbers_json(run->models[i].pose, 16));
    if (run->model)
        json_object_set(all, "model_matrix", json_array_get(matrices, 0));
    if (run->options.model_count > 1)
        json_object_set(all, "model_matrices", matrices);
    json_decref(matrices);
    return all;
}
