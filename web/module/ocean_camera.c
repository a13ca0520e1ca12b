/* ocean_camera.c - the camera of the ocean page: turned, raised and zoomed by setting the options that say the same. */
#include <emscripten/emscripten.h>
#include <math.h>
#include <stdio.h>

#include "base/result.h"
#include "ocean.h"

static const double DEGREE = 0.017453292519943295; /* pi / 180 */

static void find_angles(const facet_camera *c, double *azimuth, double *elevation)
{
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = (double)c->target[i] - (double)c->eye[i];
    *azimuth = atan2(d[0], d[2]) / DEGREE;
    *elevation = atan2(d[1], hypot(d[0], d[2])) / DEGREE;
}

/* The default's elevation, which --heading keeps. */
static double default_elevation(void)
{
    const facet_camera c = facet_sea_camera(ocean.settings.run.sea, 3.0f, 0.0f);
    double azimuth, elevation;
    find_angles(&c, &azimuth, &elevation);
    return elevation;
}

static int set_both(const char *heading, const char *target)
{
    int result = ocean_set_option(heading ? "target" : "heading", NULL);
    return result == FACET_OK ? ocean_set_option(heading ? "heading" : "target", heading ? heading : target)
                              : result;
}

/* Looks in a direction, degrees, from where the camera is. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_look(double azimuth, double elevation)
{
    static const double FAR_M = 100.0;
    char value[96];
    facet_result result = ocean_update_sea(&ocean.error);
    if (result != FACET_OK)
        return result;
    azimuth = remainder(azimuth, 360.0);
    elevation = fmin(fmax(elevation, -89.0), 89.0);
    if (fabs(elevation - default_elevation()) < 0.05) {
        snprintf(value, sizeof value, "%.2f", azimuth);
        return set_both(value, NULL);
    }
    const facet_camera c = ocean_run_camera(&ocean.settings.run, &ocean.settings.run.options);
    double level = FAR_M * cos(elevation * DEGREE);
    snprintf(value, sizeof value, "%.2f,%.2f,%.2f", (double)c.eye[0] + level * sin(azimuth * DEGREE),
             (double)c.eye[1] + FAR_M * sin(elevation * DEGREE),
             (double)c.eye[2] + level * cos(azimuth * DEGREE));
    return set_both(NULL, value);
}

/* Turns the camera as the pointer drags the image: by pixels of an image of that height. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_turn(double dx, double dy, double height)
{
    double azimuth, elevation;
    facet_result result = ocean_update_sea(&ocean.error);
    if (result != FACET_OK)
        return result;
    const facet_camera c = ocean_run_camera(&ocean.settings.run, &ocean.settings.run.options);
    double per_pixel = (double)c.fov_y_rad / DEGREE / height;
    find_angles(&c, &azimuth, &elevation);
    return facet_ocean_look(azimuth + dx * per_pixel, elevation + dy * per_pixel);
}

/* Height above the still water, m; below 0: under water. The direction stays. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_rise(double height_m)
{
    double azimuth, elevation;
    char value[32];
    facet_result result = ocean_update_sea(&ocean.error);
    if (result != FACET_OK)
        return result;
    const facet_camera c = ocean_run_camera(&ocean.settings.run, &ocean.settings.run.options);
    find_angles(&c, &azimuth, &elevation);
    snprintf(value, sizeof value, "%.4g", height_m);
    result = ocean_set_option("height-of-eye", value);
    return result == FACET_OK ? facet_ocean_look(azimuth, elevation) : result;
}

/* Narrows the field of view by steps of a wheel; negative: widens it. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_zoom(double steps)
{
    char value[32];
    facet_result result = ocean_update_sea(&ocean.error);
    if (result != FACET_OK)
        return result;
    const facet_camera c = ocean_run_camera(&ocean.settings.run, &ocean.settings.run.options);
    double degrees = (double)c.fov_y_rad / DEGREE * pow(0.9, steps);
    snprintf(value, sizeof value, "%.1f", fmin(fmax(degrees, 1.0), 120.0));
    return ocean_set_option("fov", value);
}

/* JSON: time, camera, and what is known of the sea. */
EMSCRIPTEN_KEEPALIVE char *facet_ocean_state(void)
{
    if (ocean_update_sea(&ocean.error) != FACET_OK)
        return NULL;
    const facet_camera c = ocean_run_camera(&ocean.settings.run, &ocean.settings.run.options);
    const facet_sea_info info = facet_sea_get_info(ocean.settings.run.sea);
    double azimuth, elevation;
    find_angles(&c, &azimuth, &elevation);
    text t = {.data = NULL};
    text_json_begin_object(&t, NULL);
    text_json_float(&t, "time", (float)ocean.time_s);
    text_json_float(&t, "ev100", (float)ocean.ev100);
    text_json_float(&t, "azimuth", (float)azimuth);
    text_json_float(&t, "elevation", (float)elevation);
    text_json_float(&t, "height", c.eye[1]);
    text_json_float(&t, "fov", c.fov_y_rad / DEGREE);
    text_json_float(&t, "waveHeight", (float)info.height_m);
    text_json_float(&t, "wavePeriod", (float)info.peak_period_s);
    text_json_float(&t, "waveLength", (float)info.peak_length_m);
    text_json_float(&t, "foam", (float)info.foam_coverage);
    text_json_float(&t, "ior", (float)info.ior);
    text_json_end_object(&t);
    return ocean_finish_text(&t);
}
