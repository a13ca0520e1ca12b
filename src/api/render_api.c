/* render_api.c - facet_render(): fills in the desc, runs the renderer, develops the film. */
#include "api/api.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "base/text.h"
#include "api/gl_library.h"
#include "api/render_check.h"
#include "film/meter.h"
#include "cpu/preview.h"
#include "film/matte.h"
#include "path/path_render.h"
#include "scene/identity.h"

#include <math.h>
#include <string.h>

enum { MAX_IMAGE_SIZE = 65536, MAX_PREVIEW_SAMPLES = 4096, MAX_PATH_SAMPLES = 1 << 24, DEFAULT_DEPTH = 64 };

static uint32_t samples_of(facet_quality quality, bool is_path)
{
    switch (quality) {
    case FACET_QUALITY_DRAFT:
        return is_path ? 16 : 1;
    case FACET_QUALITY_FINAL:
        return is_path ? 512 : 16;
    default:
        return is_path ? 64 : 4;
    }
}

static bool are_finite(const float *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

/* What is not light is drawn as it is, over black. */
static facet_result resolve_gl(facet_render_desc *d, facet_error *error)
{
    const facet_gl_desc *gl = &d->gl;
    if ((unsigned)gl->channel >= FACET_CHANNEL_COUNT || (unsigned)gl->brdf > FACET_BRDF_MULTISCATTER ||
        (unsigned)gl->transparency > FACET_TRANSPARENCY_WEIGHTED)
        return fail(error, FACET_ERROR_ARGUMENT, "channel %d, brdf %d, transparency %d; there is no such",
                    (int)gl->channel, (int)gl->brdf, (int)gl->transparency);
    if (!(gl->bloom >= 0.0f && gl->bloom <= 1.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "bloom: %g; it is a share of the light, 0 to 1",
                    (double)gl->bloom);
    if (gl_channel_is_light(gl->channel))
        return FACET_OK;
    d->tonemap = FACET_TONEMAP_NONE;
    d->exposure_ev = 0.0f;
    d->background = FACET_BACKGROUND_COLOR;
    for (int i = 0; i < 3; i++)
        d->background_color[i] = 0.0f;
    return FACET_OK;
}

/* What the renderers ask of a desc, its numbers being finite. */
static facet_result resolve_renderer(facet_render_desc *d, facet_error *error)
{
    bool is_path = d->renderer == FACET_RENDERER_KIND_PATH;
    uint32_t most = is_path ? MAX_PATH_SAMPLES : MAX_PREVIEW_SAMPLES;
    if (!d->samples)
        d->samples = samples_of(d->quality, is_path);
    if (d->samples > most)
        return fail(error, FACET_ERROR_ARGUMENT, "samples: %u per pixel; the most are %u", d->samples, most);
    if (d->renderer == FACET_RENDERER_KIND_PREVIEW && d->ground != FACET_GROUND_NONE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "ground: the preview finds no shadow; path tracing does, and OpenGL");
    if (!is_path && d->aovs & (FACET_AOV_VARIANCE | FACET_AOV_SAMPLES))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "layers: variance and samples are known to path tracing only");
    if (is_path && d->path.resumes && d->aovs & FACET_AOV_CRYPTOMATTE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "layers: a checkpoint does not keep Cryptomatte's; render them without resuming");
    if (is_path && d->shading != FACET_SHADING_GLTF)
        return fail(error, FACET_ERROR_ARGUMENT, "shading: path tracing knows that of glTF only");
    if (!d->path.max_depth)
        d->path.max_depth = DEFAULT_DEPTH;
    return d->renderer == FACET_RENDERER_KIND_GL ? resolve_gl(d, error) : FACET_OK;
}

static facet_result check_numbers(const facet_render_desc *d, facet_error *error)
{
    const float light[] = {
        d->exposure_ev,           d->environment_ev,   d->environment_rotation_rad, d->sun.azimuth_rad,
        d->sun.elevation_rad,     d->sun.diameter_rad, d->sun.illuminance_lux[0],   d->sun.illuminance_lux[1],
        d->sun.illuminance_lux[2]};
    if (!are_finite(light, sizeof light / sizeof *light))
        return fail(error, FACET_ERROR_ARGUMENT, "exposure, light: a value is not a finite number");
    const float path[] = {d->path.noise, d->path.clamp, d->path.shutter_s,
                          d->camera ? d->camera->lens_radius_m : 0.0f, d->camera ? d->camera->focus_m : 0.0f};
    for (size_t i = 0; i < sizeof path / sizeof *path; i++)
        if (!isfinite(path[i]) || path[i] < 0.0f)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "noise, clamp, shutter, lens: a value is negative or not a finite number");
    if ((unsigned)d->renderer > FACET_RENDERER_KIND_GL || (unsigned)d->ground > FACET_GROUND_SHADOW ||
        (unsigned)d->path.filter > FACET_FILTER_MITCHELL ||
        (unsigned)d->path.light_sampling > FACET_LIGHT_SAMPLING_LIGHTS)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "renderer %d, ground %d, filter %d, light sampling %d; there is no such",
                    (int)d->renderer, (int)d->ground, (int)d->path.filter, (int)d->path.light_sampling);
    return FACET_OK;
}

facet_result render_desc_resolve(const facet_render_desc *desc, facet_render_desc *out, facet_error *error)
{
    *out = *desc;
    if (!out->width && !out->height) {
        out->width = 1024;
        out->height = 768;
    }
    if (!out->width || !out->height || out->width > MAX_IMAGE_SIZE || out->height > MAX_IMAGE_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "picture: %u x %u pixels; each side must be 1 to %d",
                    out->width, out->height, MAX_IMAGE_SIZE);
    const uint32_t *crop = out->crop;
    if (crop[0] || crop[1] || crop[2] || crop[3]) {
        if (!crop[2] || !crop[3] || crop[0] >= out->width || crop[1] >= out->height ||
            crop[2] > out->width - crop[0] || crop[3] > out->height - crop[1])
            return fail(error, FACET_ERROR_ARGUMENT,
                        "crop: %u,%u,%u,%u is not inside the picture of %u x %u pixels", crop[0], crop[1],
                        crop[2], crop[3], out->width, out->height);
    } else {
        out->crop[2] = out->width;
        out->crop[3] = out->height;
    }
    if ((unsigned)out->shading > FACET_SHADING_OGL1 ||
        (unsigned)out->ogl1.variant > FACET_OGL1_VARIANT_RGL_DESKTOP)
        return fail(error, FACET_ERROR_ARGUMENT, "shading: %d, variant %d; there is no such",
                    (int)out->shading, (int)out->ogl1.variant);
    if ((unsigned)out->isa > FACET_ISA_AVX512)
        return fail(error, FACET_ERROR_ARGUMENT, "isa: %d is no instruction set", (int)out->isa);
    facet_result result = check_numbers(out, error);
    if (result == FACET_OK)
        result = resolve_renderer(out, error);
    if (!out->thread_count)
        out->thread_count = facet_thread_count();
    return result;
}

/* The default camera for what the desc shows; the pose is kept for the picture. */
static facet_result fit_camera(prepared_scene *prepared, const facet_render_desc *desc, facet_camera *camera,
                               facet_error *error)
{
    facet_orbit orbit = facet_orbit_default();
    orbit.log = desc->log;
    facet_result result = prepared_scene_pose(prepared, desc, error);
    if (result == FACET_ERROR_MEMORY) {
        prepared_scene_clear(prepared);
        result = prepared_scene_pose(prepared, desc, error);
    }
    if (result != FACET_OK)
        return result;
    return scene_fit_pose(prepared->scene, &prepared->pose, &orbit, (float)desc->width / (float)desc->height,
                          desc->thread_count, camera, error);
}

/* Puts the background behind the picture: as light, or, where the model was drawn with the display's numbers, as such. */
static void develop(const facet_render_desc *desc, film *picture)
{
    const float *behind = desc->background == FACET_BACKGROUND_COLOR ? desc->background_color : NULL;
    bool is_encoded = desc->shading == FACET_SHADING_OGL1 && !desc->ogl1.is_linear;
    film_develop(picture, desc->tonemap, is_encoded ? NULL : behind, desc->thread_count);
    if (is_encoded && behind)
        film_blend_encoded(picture, behind, desc->thread_count);
}

/* Cryptomatte's metadata. */
static facet_result describe_mattes(const facet_scene *scene, const facet_render_desc *desc, film *picture,
                                    facet_error *error)
{
    static const uint32_t aovs[SCENE_IDENTITY_KINDS] = {FACET_AOV_CRYPTO_OBJECT, FACET_AOV_CRYPTO_MATERIAL,
                                                        FACET_AOV_CRYPTO_INSTANCE};
    facet_result result = FACET_OK;
    for (uint32_t kind = 0; kind < SCENE_IDENTITY_KINDS && result == FACET_OK; kind++) {
        if (!(desc->aovs & aovs[kind]))
            continue;
        text manifest = {.allocator = desc->allocator};
        result = scene_identity_manifest(scene, (scene_identity_kind)kind, &manifest, error);
        if (result == FACET_OK)
            result = matte_describe(picture, kind, manifest.data, &desc->allocator, error);
        text_destroy(&manifest);
    }
    return result;
}

struct facet_renderer {
    prepared_scene prepared; /* scene NULL: of a window's images, which people look at */
    gl_renderer *gl;         /* NULL: not asked for yet */
    render_check check;
};

static facet_result render_gl(facet_renderer *renderer, const facet_render_desc *desc, facet_image *image,
                              facet_error *error)
{
    const gl_entry *gl;
    facet_result result = gl_library_open(&gl, error);
    if (result == FACET_OK && !renderer->gl)
        result = gl->create(renderer->prepared.scene, &renderer->prepared.allocator, &renderer->gl, error);
    return result == FACET_OK ? gl->render(renderer->gl, desc, &image->film, &image->stats, error) : result;
}

/* A picture whose passes somebody wants to see. */
typedef struct watched_picture {
    const facet_render_desc *desc;
    facet_image *image;
} watched_picture;

/* The next pass fills the film anew. */
static void show_pass(void *user, const facet_image *unknown, uint32_t samples)
{
    const watched_picture *w = user;
    (void)unknown;
    develop(w->desc, &w->image->film);
    w->desc->path.pass(w->desc->path.pass_user, w->image, samples);
}

static facet_result render_path(facet_renderer *renderer, const facet_render_desc *desc, facet_image *image,
                                facet_error *error)
{
    watched_picture watched = {.desc = desc, .image = image};
    facet_render_desc with_film = *desc;
    if (desc->path.pass) {
        with_film.path.pass = show_pass;
        with_film.path.pass_user = &watched;
    }
    return path_render_prepared(&renderer->prepared, &with_film, &image->film, &image->stats, error);
}

/* ---- the meter ---- */

enum { METER_SIZE = 128 }; /* pixels along the longer edge */

/* The same view, small, by the preview. Warnings are those of the image itself. */
static facet_render_desc meter_desc(const facet_render_desc *desc)
{
    facet_render_desc d = *desc;
    double longer = d.width > d.height ? d.width : d.height;
    d.width = (uint32_t)ceil(METER_SIZE * d.width / longer);
    d.height = (uint32_t)ceil(METER_SIZE * d.height / longer);
    d.crop[0] = d.crop[1] = 0;
    d.crop[2] = d.width;
    d.crop[3] = d.height;
    d.samples = 1;
    d.quality = FACET_QUALITY_DRAFT;
    d.renderer = FACET_RENDERER_KIND_PREVIEW;
    d.energy = FACET_ENERGY_GLTF;
    d.ground = FACET_GROUND_NONE;
    d.exposure_ev = 0.0f;
    d.aovs = 0;
    d.log = (facet_log){0};
    d.progress = (facet_progress){0};
    return d;
}

static facet_result meter(facet_renderer *renderer, const facet_render_desc *resolved, double *ev100,
                          facet_error *error)
{
    prepared_scene *prepared = &renderer->prepared;
    facet_render_desc desc = meter_desc(resolved);
    facet_camera camera;
    facet_render_stats stats;
    film metered = {0};
    facet_result result = FACET_OK;
    *ev100 = meter_exposure_ev(0.0); /* an exposure of 0 */
    if (desc.shading == FACET_SHADING_OGL1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "exposure: the numbers of OpenGL 1 are a display's, and no light that can be metered");
    if (!desc.camera) { /* that of the image, to the last bit of its proportions */
        facet_render_desc whole = *resolved;
        whole.log = desc.log;
        result = fit_camera(prepared, &whole, &camera, error);
        desc.camera = &camera;
    }
    if (result == FACET_OK)
        result = film_create(&desc.allocator, desc.width, desc.height, 0, &metered, error);
    if (result == FACET_OK)
        result = preview_render_prepared(prepared, &desc, &metered, &stats, error);
    if (result == FACET_OK) {
        double average = film_meter(&metered);
        if (average > 0.0)
            *ev100 = meter_ev100(average);
        else
            log_warning(&resolved->log, "%s: nothing is seen that could be metered: the exposure is 0",
                        prepared->scene->source);
    }
    film_destroy(&metered);
    return result;
}

/* ---- one image ---- */

static facet_result render(facet_renderer *renderer, const facet_render_desc *resolved, facet_image *image,
                           facet_error *error)
{
    prepared_scene *prepared = &renderer->prepared;
    facet_render_desc desc = *resolved;
    facet_camera camera;
    facet_result result = FACET_OK;
    if (!desc.camera && desc.renderer != FACET_RENDERER_KIND_GL) { /* OpenGL's poses the scene for itself */
        result = fit_camera(prepared, &desc, &camera, error);
        if (result != FACET_OK)
            return result;
        desc.camera = &camera;
    }
    if (desc.meters_exposure && prepared->scene) {
        double ev100;
        result = meter(renderer, &desc, &ev100, error);
        if (result != FACET_OK)
            return result;
        desc.exposure_ev += (float)meter_exposure_ev(ev100);
    }
    result = film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, &image->film, error);
    if (result == FACET_OK && desc.renderer == FACET_RENDERER_KIND_GL)
        result = render_gl(renderer, &desc, image, error);
    else if (result == FACET_OK && desc.renderer == FACET_RENDERER_KIND_PATH)
        result = render_path(renderer, &desc, image, error);
    else if (result == FACET_OK)
        result = preview_render_prepared(prepared, &desc, &image->film, &image->stats, error);
    if (result == FACET_OK && prepared->scene)
        render_check_film(&renderer->check, prepared->scene,
                          desc.renderer == FACET_RENDERER_KIND_GL ? NULL : &prepared->pose, &desc,
                          &image->film);
    if (result == FACET_OK)
        develop(&desc, &image->film);
    if (result == FACET_OK && desc.aovs & FACET_AOV_CRYPTOMATTE)
        result = describe_mattes(prepared->scene, &desc, &image->film, error);
    return result;
}

static facet_result render_image(facet_renderer *renderer, const facet_render_desc *resolved,
                                 facet_image **image, facet_error *error)
{
    double start = clock_seconds();
    facet_image *made = mem_zalloc(&resolved->allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    facet_result result = render(renderer, resolved, made, error);
    if (result != FACET_OK) {
        facet_image_destroy(made);
        return result;
    }
    made->stats.thread_count = resolved->thread_count;
    made->stats.total_s = clock_seconds() - start;
    *image = made;
    return FACET_OK;
}

static const facet_render_desc default_desc = {0};

static void clear(facet_renderer *renderer)
{
    const gl_entry *gl;
    if (renderer->gl && gl_library_open(&gl, NULL) == FACET_OK)
        gl->destroy(renderer->gl);
    prepared_scene_clear(&renderer->prepared);
}

facet_result facet_render(const facet_scene *scene, const facet_render_desc *desc, facet_image **image,
                          facet_error *error)
{
    *image = NULL;
    facet_render_desc resolved;
    facet_result result = render_desc_resolve(desc ? desc : &default_desc, &resolved, error);
    if (result != FACET_OK)
        return result;
    facet_renderer renderer = {.gl = NULL};
    prepared_scene_init(&renderer.prepared, scene, &resolved.allocator);
    result = render_image(&renderer, &resolved, image, error);
    clear(&renderer);
    return result;
}

facet_result render_by_gl(gl_renderer *gl, const facet_render_desc *desc, facet_image **image,
                          facet_error *error)
{
    *image = NULL;
    facet_render_desc resolved;
    facet_renderer borrowed = {.gl = gl}; /* nothing is prepared beside what gl has */
    facet_result result = render_desc_resolve(desc, &resolved, error);
    return result == FACET_OK ? render_image(&borrowed, &resolved, image, error) : result;
}

/* ---- several pictures ---- */

facet_result facet_renderer_create(const facet_scene *scene, const facet_allocator *allocator,
                                   facet_renderer **renderer, facet_error *error)
{
    *renderer = mem_zalloc(allocator, 1, sizeof **renderer);
    if (!*renderer)
        return fail_memory(error, "renderer", sizeof **renderer);
    prepared_scene_init(&(*renderer)->prepared, scene, allocator);
    return FACET_OK;
}

facet_result facet_renderer_render(facet_renderer *renderer, const facet_render_desc *desc,
                                   facet_image **image, facet_error *error)
{
    *image = NULL;
    facet_render_desc resolved;
    facet_result result = render_desc_resolve(desc ? desc : &default_desc, &resolved, error);
    return result == FACET_OK ? render_image(renderer, &resolved, image, error) : result;
}

facet_result facet_renderer_meter(facet_renderer *renderer, const facet_render_desc *desc, double *ev100,
                                  facet_error *error)
{
    *ev100 = 0.0;
    facet_render_desc resolved;
    facet_result result = render_desc_resolve(desc ? desc : &default_desc, &resolved, error);
    return result == FACET_OK ? meter(renderer, &resolved, ev100, error) : result;
}

void facet_renderer_destroy(facet_renderer *renderer)
{
    if (!renderer)
        return;
    clear(renderer);
    mem_free(renderer);
}

facet_render_stats facet_image_get_render_stats(const facet_image *image)
{
    return image->stats;
}
