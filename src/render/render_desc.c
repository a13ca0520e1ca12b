/* render_desc.c - checks a facet_render_desc and fills in its defaults: see renderer.h. */
#include <math.h>

#include "base/result.h"
#include "render/renderer.h"

enum { MAX_IMAGE_SIZE = 65536 };

static bool are_finite(const float *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

static facet_result check_numbers(const facet_render_desc *d, facet_error *error)
{
    const float light[] = {d->exposure_ev,
                           d->environment_ev,
                           d->environment_rotation_rad,
                           d->sun.azimuth_rad,
                           d->sun.elevation_rad,
                           d->sun.diameter_rad,
                           d->sun.illuminance_lux[0],
                           d->sun.illuminance_lux[1],
                           d->sun.illuminance_lux[2],
                           d->background_color[0],
                           d->background_color[1],
                           d->background_color[2]};
    if (!are_finite(light, sizeof light / sizeof *light))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "exposure, light, background: a value is not a finite number");
    const float path[] = {d->path.noise, d->path.clamp, d->path.shutter_s,
                          d->camera ? d->camera->lens_radius_m : 0.0f, d->camera ? d->camera->focus_m : 0.0f};
    for (size_t i = 0; i < sizeof path / sizeof *path; i++)
        if (!isfinite(path[i]) || path[i] < 0.0f)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "noise, clamp, shutter, lens: a value is negative or not a finite number");
    if (!renderer_get(d->renderer) || (unsigned)d->ground > FACET_GROUND_SHADOW ||
        (unsigned)d->path.filter > FACET_FILTER_MITCHELL ||
        (unsigned)d->path.light_sampling > FACET_LIGHT_SAMPLING_LIGHTS)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "renderer %d, ground %d, filter %d, light sampling %d: at least one is no constant of its type",
            (int)d->renderer, (int)d->ground, (int)d->path.filter, (int)d->path.light_sampling);
    return FACET_OK;
}

/* ---- the sea ---- */

static facet_result check_sea_shading(const facet_sea_shading *s, facet_error *error)
{
    if ((unsigned)s->style > FACET_SEA_STYLE_LEGACY_INTENDED ||
        (unsigned)s->normals > FACET_SEA_NORMALS_GGX ||
        (unsigned)s->masking > FACET_SEA_MASKING_SCHLICK_KARIS || s->stage > 5)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "sea_shading: style %d, normals %d, masking %d, stage %u: at least one is out of range",
                    (int)s->style, (int)s->normals, (int)s->masking, s->stage);
    float r = s->perceptual_roughness;
    if (r != 0.0f && !(r >= 0.001f && r <= 1.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "sea_shading: a roughness of %g is not within [0.001, 1]",
                    (double)r);
    if (!(s->clamp >= 0.0f && s->clamp < INFINITY))
        return fail(error, FACET_ERROR_ARGUMENT, "sea_shading: clamp is %g, not 0 or more", (double)s->clamp);
    return FACET_OK;
}

/* Whether the shading is the physical style with nothing left out. */
static bool is_physical(const facet_sea_shading *s)
{
    return s->style == FACET_SEA_STYLE_PHYSICAL && s->stage == 0 &&
           s->normals == FACET_SEA_NORMALS_BECKMANN && s->masking == FACET_SEA_MASKING_SCALES &&
           !s->omits_glints && !s->omits_caustics;
}

/* Refuses what the renderer does not draw in a sea. The sky is the background. */
static facet_result resolve_sea(const renderer_row *r, facet_render_desc *d, facet_error *error)
{
    TRY(check_sea_shading(&d->sea_shading, error));
    if (d->ground != FACET_GROUND_NONE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "ground: in a sea the water and its bed (facet_sea_bed) take its place");
    if (!(r->info.features & FACET_RENDERER_FEATURE_SEA_STYLES) && !is_physical(&d->sea_shading))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "sea_shading: %s supports the physical style only: no stage, GGX normals, other masking, "
                    "omits_glints or omits_caustics",
                    r->title);
    d->background = FACET_BACKGROUND_ENVIRONMENT;
    return FACET_OK;
}

/* ---- ambient occlusion ---- */

static facet_result resolve_ambient_occlusion(const renderer_row *r, facet_render_desc *d, facet_error *error)
{
    bool is_possible = (r->info.features & FACET_RENDERER_FEATURE_AMBIENT_OCCLUSION) &&
                       d->shading == FACET_SHADING_GLTF && !d->sea;
    if ((unsigned)d->ambient_occlusion > FACET_AMBIENT_OCCLUSION_ON)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "ambient occlusion: %d is no constant of facet_ambient_occlusion",
                    (int)d->ambient_occlusion);
    if (d->ambient_occlusion == FACET_AMBIENT_OCCLUSION_ON && !is_possible)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "ambient occlusion: %s has it for models with FACET_SHADING_GLTF outside of seas only",
                    d->sea || d->shading != FACET_SHADING_GLTF ? r->title : "the preview");
    if (d->ambient_occlusion == FACET_AMBIENT_OCCLUSION_AUTO)
        d->ambient_occlusion = is_possible && d->ground == FACET_GROUND_SHADOW ? FACET_AMBIENT_OCCLUSION_ON
                                                                               : FACET_AMBIENT_OCCLUSION_OFF;
    return FACET_OK;
}

/* ---- all ---- */

static facet_result resolve_renderer(facet_render_desc *d, facet_error *error)
{
    const renderer_row *r = renderer_get(d->renderer);
    const facet_renderer_info *info = &r->info;
    if (r->lacks)
        return fail(error, FACET_ERROR_SYSTEM, "%s: this facet was built without it (%s)", r->title,
                    r->lacks);
    if (!d->samples)
        d->samples = info->samples[(unsigned)d->quality <= FACET_QUALITY_FINAL ? d->quality : 0];
    if (d->samples > info->max_samples)
        return fail(error, FACET_ERROR_ARGUMENT, "samples: %u per pixel; the maximum is %u", d->samples,
                    info->max_samples);
    uint32_t unknown = d->aovs & ~renderer_get(FACET_RENDERER_KIND_PATH)->info.aovs; /* it has all */
    if (unknown)
        return fail(error, FACET_ERROR_ARGUMENT, "aovs: 0x%x has bits 0x%x that are no facet_aov", d->aovs,
                    unknown);
    if (d->aovs & ~info->aovs)
        return fail(error, FACET_ERROR_ARGUMENT, "layers: only path tracing has variance and samples");
    if (d->shading != FACET_SHADING_GLTF && !(info->features & FACET_RENDERER_FEATURE_OGL1))
        return fail(error, FACET_ERROR_ARGUMENT, "shading: %s supports FACET_SHADING_GLTF only", r->title);
    if (d->sea)
        TRY(resolve_sea(r, d, error));
    if (d->ground != FACET_GROUND_NONE && !(info->features & FACET_RENDERER_FEATURE_GROUND))
        return fail(error, FACET_ERROR_ARGUMENT, "ground: %s has no ground shadow", r->title);
    TRY(resolve_ambient_occlusion(r, d, error));
    return r->resolve ? r->resolve(d, error) : FACET_OK;
}

facet_result render_desc_resolve(const facet_render_desc *desc, facet_render_desc *out, facet_error *error)
{
    *out = *desc;
    if (!out->width && !out->height) {
        out->width = 1024;
        out->height = 768;
    }
    if (!out->width || !out->height || out->width > MAX_IMAGE_SIZE || out->height > MAX_IMAGE_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "image: %u x %u pixels; each side must be 1 to %d",
                    out->width, out->height, MAX_IMAGE_SIZE);
    const uint32_t *crop = out->crop;
    if (crop[0] || crop[1] || crop[2] || crop[3]) {
        if (!crop[2] || !crop[3] || crop[0] >= out->width || crop[1] >= out->height ||
            crop[2] > out->width - crop[0] || crop[3] > out->height - crop[1])
            return fail(error, FACET_ERROR_ARGUMENT,
                        "crop: %u,%u,%u,%u is not inside the image of %u x %u pixels", crop[0], crop[1],
                        crop[2], crop[3], out->width, out->height);
    } else {
        out->crop[2] = out->width;
        out->crop[3] = out->height;
    }
    if ((unsigned)out->shading > FACET_SHADING_OGL1 ||
        (unsigned)out->ogl1.variant > FACET_OGL1_VARIANT_RGL_DESKTOP)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "shading: %d is not a facet_shading, or variant %d not a facet_ogl1_variant",
                    (int)out->shading, (int)out->ogl1.variant);
    if ((unsigned)out->isa > FACET_ISA_AVX512)
        return fail(error, FACET_ERROR_ARGUMENT, "isa: %d is not a facet_isa", (int)out->isa);
    facet_result result = check_numbers(out, error);
    if (result == FACET_OK)
        result = resolve_renderer(out, error);
    if (!out->thread_count)
        out->thread_count = facet_thread_count();
    return result;
}
