/* ogl1_lights_write.c - lights and fog as rgl's light3d() and bg3d() take them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/ogl1/ogl1_writer.h"

void ogl1_write_line(text *out)
{
    text_add(out, out->needs_comma ? ",\n" : "\n");
    out->needs_comma = false;
}

void ogl1_write_color(text *out, const char *key, const float rgb[3])
{
    int bytes[3];
    bool has_8_bits = true;
    for (int k = 0; k < 3; k++) {
        float scaled = rgb[k] >= 0.0f && rgb[k] <= 1.0f ? rgb[k] * 255.0f : -1.0f;
        bytes[k] = (int)lrintf(scaled);
        has_8_bits &= bytes[k] >= 0 && (float)bytes[k] / 255.0f == rgb[k];
    }
    if (has_8_bits) {
        char hex[8];
        snprintf(hex, sizeof hex, "#%02X%02X%02X", (unsigned)bytes[0] & 255, (unsigned)bytes[1] & 255,
                 (unsigned)bytes[2] & 255);
        text_json_string(out, key, hex);
    } else {
        text_json_floats(out, key, rgb, 3);
    }
}

/* Degrees in as few digits as give the direction to the last bit; false: 9 digits do not. */
static bool find_angles(const float direction[3], char theta[32], char phi[32])
{
    const double to_rad = 3.14159265358979323846 / 180.0;
    double y = fmin(fmax((double)direction[1], -1.0), 1.0);
    double exact_theta = atan2((double)direction[0], (double)direction[2]) / to_rad;
    double exact_phi = atan2(y, hypot((double)direction[0], (double)direction[2])) / to_rad;
    for (int digits = 1; digits <= 9; digits++) {
        float back[3];
        snprintf(theta, 32, "%.*g", digits, exact_theta);
        snprintf(phi, 32, "%.*g", digits, exact_phi);
        legacy_light_direction((float)(strtod(theta, NULL) * to_rad), (float)(strtod(phi, NULL) * to_rad),
                               back);
        if (memcmp(back, direction, sizeof back) == 0)
            return true;
    }
    return false;
}

static void write_light(const legacy_light *light, text *out)
{
    static const char *const axes[3] = {"x", "y", "z"};
    char theta[32];
    char phi[32];
    ogl1_write_line(out);
    text_json_begin_object(out, NULL);
    if (light->is_point) {
        for (int k = 0; k < 3; k++)
            text_json_float(out, axes[k], light->position[k]);
    } else {
        bool is_exact = find_angles(light->position, theta, phi);
        text_json_raw(out, "theta", theta);
        text_json_raw(out, "phi", phi);
        if (!is_exact) /* rgl does not know it; here it counts more than the angles */
            text_json_floats(out, "direction", light->position, 3);
    }
    text_json_bool(out, "viewpoint.rel", light->is_viewpoint_relative);
    ogl1_write_color(out, "ambient", light->ambient);
    ogl1_write_color(out, "diffuse", light->diffuse);
    ogl1_write_color(out, "specular", light->specular);
    text_json_end_object(out);
}

void ogl1_write_lights(const scene_legacy *legacy, text *out)
{
    static const char *const types[] = {"none", "linear", "exp", "exp2"};
    const legacy_fog *fog = &legacy->fog;
    if (legacy->light_count) {
        ogl1_write_line(out);
        text_json_begin_array(out, "lights");
        for (uint32_t i = 0; i < legacy->light_count; i++)
            write_light(&legacy->lights[i], out);
        text_json_end_array(out);
    }
    if (fog->mode != LEGACY_FOG_NONE || fog->color[0] != 0.0f || fog->color[1] != 0.0f ||
        fog->color[2] != 0.0f) {
        ogl1_write_line(out);
        text_json_begin_object(out, "background");
        text_json_string(out, "fogtype", types[fog->mode]);
        text_json_float(out, "fogScale", fog->scale);
        ogl1_write_color(out, "color", fog->color);
        text_json_end_object(out);
    }
}
