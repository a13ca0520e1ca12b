/* ocean_options.c - converts the options of facet ocean to descs. */
#include "cli/ocean/ocean_run.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/render/render_options.h"
#include "cli/shared/value.h"

#define DEGREE 0.017453292519943295 /* pi / 180 */

static const double DEFAULT_SUN_EL = 22.0, BESIDE_SUN = 36.0;
/* Upper limits of option values: length and position, m; azimuth, degrees; illuminance, lx; coefficient, 1/m. */
static const double MAX_LENGTH = 1e7, MAX_DISTANCE = 1e6, MAX_TURN = 1e6, MAX_BRIGHTNESS = 1e9,
                    MAX_ABSORPTION = 1e3;
static const float SAND[3] = {0.42f, 0.36f, 0.27f};

/* ---- notations ---- */

bool value_length(const char *text, double *metres)
{
    if (strcasecmp(text, "inf") == 0) {
        *metres = (double)INFINITY;
        return true;
    }
    double number;
    const char *at = text;
    if (!scan_number(&at, &number))
        return false;
    if (strcmp(at, "km") == 0)
        number *= 1000.0;
    else if (*at && strcmp(at, "m") != 0)
        return false;
    *metres = number;
    return number <= MAX_LENGTH;
}

/* Parses between least and most comma-separated numbers. Returns their count, 0: not such a list. */
static size_t scan_list(const char *text, size_t least, size_t most, double *numbers)
{
    for (size_t count = least; count <= most; count++)
        if (value_numbers(text, count, numbers))
            return count;
    return 0;
}

static bool are_within(const double *numbers, size_t count, double least, double most)
{
    for (size_t i = 0; i < count; i++)
        if (!(numbers[i] >= least && numbers[i] <= most))
            return false;
    return true;
}

static bool is_azimuth(double degrees)
{
    return fabs(degrees) <= MAX_TURN;
}

/* Options have azimuths from +Z towards +X, descs angles from +X towards +Z. */
static float plane_angle(double azimuth)
{
    return (float)((90.0 - azimuth) * DEGREE);
}

/* ---- waves ---- */

static facet_result read_wind(const command_line *c, ocean_options *out, facet_error *error)
{
    double numbers[2] = {0.0, 90.0}, fetch = 0.0;
    if (is_given(c, OPT_WIND)) {
        size_t count = scan_list(option_text(c, OPT_WIND, ""), 1, 2, numbers);
        if (!count || !are_within(numbers, 1, 0.0, 40.0) || !is_azimuth(numbers[1]))
            return option_fail(c, OPT_WIND,
                               "SPEED or SPEED,DIRECTION such as 10 or 10,45: 0 to 40 m/s, degrees", error);
        out->sea.wind_mps = (float)numbers[0];
        if (count == 2)
            out->sea.wind_direction_rad = plane_angle(numbers[1]);
    }
    if (!is_given(c, OPT_FETCH))
        return FACET_OK;
    if (!value_length(option_text(c, OPT_FETCH, ""), &fetch) || fetch < 100.0)
        return option_fail(c, OPT_FETCH, "a length from 100 m to 10000 km, such as 5000 or 20km, or inf",
                           error);
    out->sea.fetch_m = (float)fetch;
    return FACET_OK;
}

static facet_result read_swell(const command_line *c, ocean_options *out, facet_error *error)
{
    if (!is_given(c, OPT_SWELL))
        return FACET_OK;
    double numbers[3] = {0.0, 0.0, 90.0};
    if (!scan_list(option_text(c, OPT_SWELL, ""), 2, 3, numbers) || !are_within(numbers, 1, 0.0, 30.0) ||
        !are_within(numbers + 1, 1, 0.1, 40.0) || !is_azimuth(numbers[2]))
        return option_fail(c, OPT_SWELL,
                           "HEIGHT,PERIOD[,DIRECTION] such as 2,12 or 2,12,45: to 30 m, 0.1 to 40 s, degrees",
                           error);
    out->sea.swell = (facet_swell){.height_m = (float)numbers[0],
                                   .period_s = (float)numbers[1],
                                   .direction_rad = plane_angle(numbers[2]),
                                   .elongation = 0.8f};
    return FACET_OK;
}

static facet_result read_waves(const command_line *c, ocean_options *out, facet_error *error)
{
    facet_sea_desc *d = &out->sea;
    facet_result result = read_wind(c, out, error);
    if (result == FACET_OK)
        result = read_swell(c, out, error);
    if (result != FACET_OK)
        return result;
    d->spectrum = (facet_sea_spectrum)option_choice(c, OPT_SPECTRUM, (int)d->spectrum);
    d->spreading = (facet_sea_spreading)option_choice(c, OPT_SPREADING, (int)d->spreading);
    d->choppiness = (float)option_number(c, OPT_CHOPPINESS, (double)d->choppiness);
    d->seed = (uint64_t)option_number(c, OPT_SEED, (double)d->seed);
    d->resolution = (uint32_t)option_number(c, OPT_TILE_SAMPLES, d->resolution);
    d->cascade_count = (uint32_t)option_number(c, OPT_CASCADES, d->cascade_count);
    d->loop_s = option_number(c, OPT_LOOP, 0.0);
    if (d->resolution & (d->resolution - 1))
        return option_fail(c, OPT_TILE_SAMPLES, "a power of two from 32 to 1024", error);
    return FACET_OK;
}

/* ---- water, bed ---- */

/* --absorption replaces one of three coefficients; the water type's others stay. */
static facet_result read_absorption(const command_line *c, facet_sea_desc *d, facet_error *error)
{
    double numbers[3];
    if (!is_given(c, OPT_ABSORPTION))
        return FACET_OK;
    if (!value_numbers(option_text(c, OPT_ABSORPTION, ""), 3, numbers) ||
        !are_within(numbers, 3, 0.0, MAX_ABSORPTION))
        return option_fail(c, OPT_ABSORPTION, "R,G,B in 1/m, each from 0 to 1000", error);
    facet_sea_desc flat = *d;
    flat.wind_mps = flat.swell.height_m = 0.0f;
    facet_sea *sea = NULL;
    facet_result result = facet_sea_create(&flat, &sea, error);
    if (result != FACET_OK)
        return result;
    facet_sea_info info = facet_sea_get_info(sea);
    facet_sea_destroy(sea);
    d->water.kind = FACET_WATER_KIND_COEFFICIENTS;
    for (int i = 0; i < 3; i++) {
        d->water.absorption[i] = (float)numbers[i];
        d->water.scattering[i] = (float)info.scattering[i];
        d->water.backscattering[i] = (float)info.backscattering[i];
    }
    return FACET_OK;
}

static facet_result read_water(const command_line *c, ocean_options *out, facet_error *error)
{
    facet_water *w = &out->sea.water;
    int type = option_choice(c, OPT_WATER, -1);
    if (type >= 0 && is_given(c, OPT_CHLOROPHYLL))
        return fail(error, FACET_ERROR_ARGUMENT, "--water: a Jerlov type excludes --chl; give one of them");
    if (type >= 0)
        w->kind = (facet_water_kind)(FACET_WATER_KIND_JERLOV_I + type);
    if (is_given(c, OPT_CHLOROPHYLL)) {
        w->kind = FACET_WATER_KIND_CHLOROPHYLL;
        w->chlorophyll_mg_m3 = (float)option_number(c, OPT_CHLOROPHYLL, 0.0);
    }
    w->salinity = (float)option_number(c, OPT_SALINITY, (double)w->salinity);
    w->temperature_C = (float)option_number(c, OPT_TEMPERATURE, (double)w->temperature_C);
    w->ior = (float)option_number(c, OPT_IOR, (double)w->ior);
    return read_absorption(c, &out->sea, error);
}

static facet_result read_bed(const command_line *c, ocean_options *out, facet_error *error)
{
    facet_sea_bed *bed = &out->sea.bed;
    double depth, numbers[2] = {0.0, 90.0};
    if (is_given(c, OPT_DEPTH)) {
        if (!value_length(option_text(c, OPT_DEPTH, ""), &depth) || depth < 0.001)
            return option_fail(c, OPT_DEPTH, "a length from 1 mm to 10000 km, such as 3, or inf", error);
        if (bed->depth_m <= 0.0f)
            memcpy(bed->albedo, SAND, sizeof SAND);
        bed->depth_m = isinf(depth) ? 0.0f : (float)depth;
    }
    if (is_given(c, OPT_BED_SLOPE)) {
        size_t count = scan_list(option_text(c, OPT_BED_SLOPE, ""), 1, 2, numbers);
        if (!count || !are_within(numbers, 1, 0.0, 1.0) || !is_azimuth(numbers[1]))
            return option_fail(c, OPT_BED_SLOPE, "SLOPE or SLOPE,DIRECTION such as 0.05,90: 0 to 1, degrees",
                               error);
        bed->slope = (float)numbers[0];
        bed->direction_rad = plane_angle(numbers[1]);
    }
    if (is_given(c, OPT_BED_COLOR) && !color_parse(option_text(c, OPT_BED_COLOR, ""), bed->albedo))
        return option_fail(c, OPT_BED_COLOR, "#rgb, #rrggbb or a CSS color name", error);
    if (bed->depth_m <= 0.0f && (is_given(c, OPT_BED_SLOPE) || is_given(c, OPT_BED_COLOR)))
        return fail(error, FACET_ERROR_ARGUMENT, "--bed-%s: it needs a bed, as --depth 5",
                    is_given(c, OPT_BED_SLOPE) ? "slope" : "color");
    return FACET_OK;
}

/* ---- light ---- */

static facet_result read_sky(const command_line *c, ocean_options *out, facet_error *error)
{
    render_options *o = &out->render;
    double numbers[3] = {DEFAULT_SUN_EL, 0.0, 0.0};
    size_t count = 2;
    TRY(image_options_environment(c, o, error));
    if (is_given(c, OPT_SUN))
        count = scan_list(option_text(c, OPT_SUN, ""), 1, 3, numbers);
    if (!count || !are_within(numbers, 1, -90.0, 90.0) || !is_azimuth(numbers[1]) ||
        !are_within(numbers + 2, 1, 0.0, MAX_BRIGHTNESS))
        return option_fail(c, OPT_SUN,
                           "ELEVATION or ELEVATION,AZIMUTH in degrees such as 30,15, from -90 to 90; with "
                           "--env also the illuminance of the sun, up to 1e9 lux",
                           error);
    if (count == 3 && !o->has_environment)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--sun: the third number, lux, needs --env; the sky's sun has its own illuminance");
    if (count < 3 && is_given(c, OPT_SUN) && o->has_environment)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--sun: with --env it needs the illuminance of the sun in lux, as 30,15,100000");
    out->sky = (facet_sky_desc){.sun_elevation_rad = (float)(numbers[0] * DEGREE),
                                .sun_azimuth_rad = (float)(numbers[1] * DEGREE),
                                .turbidity = (float)option_number(c, OPT_TURBIDITY, 0.0)};
    if (o->has_environment && count == 3)
        o->desc.sun =
            (facet_sun){.azimuth_rad = out->sky.sun_azimuth_rad,
                        .elevation_rad = out->sky.sun_elevation_rad,
                        .illuminance_lux = {(float)numbers[2], (float)numbers[2], (float)numbers[2]}};
    out->has_ev100 = is_given(c, OPT_EV100);
    out->ev100 = option_number(c, OPT_EV100, 0.0);
    return image_options_exposure(c, o, error);
}

/* ---- shading ---- */

/* The first option that is given by a source up to last; NULL: none. */
static const option *first_given(const command_line *c, const option_id *ids, size_t count,
                                 option_source last)
{
    for (size_t i = 0; i < count; i++)
        if (is_given(c, ids[i]) && c->values[ids[i]].source <= last)
            return option_find_id(c->verb, ids[i]);
    return NULL;
}

static facet_result read_shading(const command_line *c, ocean_options *out, facet_error *error)
{
    render_options *o = &out->render;
    int legacy = option_choice(c, OPT_BEFORE, -1);
    out->is_before_after = is_given(c, OPT_BEFORE_AFTER);
    out->shading = (facet_sea_shading){
        .style = (facet_sea_style)(legacy + 1),
        .normals = (facet_sea_normals)option_choice(c, OPT_NORMALS, 0),
        .masking = (facet_sea_masking)option_choice(c, OPT_MASKING, 0),
        .has_schlick_fresnel = option_choice(c, OPT_FRESNEL, 0) == 1,
        .perceptual_roughness = (float)option_number(c, OPT_ROUGHNESS, 0.0),
        .omits_glints = is_given(c, OPT_NO_GLINTS),
        .omits_foam = is_given(c, OPT_NO_FOAM),
        .omits_caustics = is_given(c, OPT_NO_CAUSTICS),
        .stage = (uint32_t)option_number(c, OPT_STAGE, 0.0),
        .clamp = (float)option_number(c, OPT_CLAMP, 0.0),
    };
    if (out->shading.style && is_given(c, OPT_STAGE))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--before: it is the style before all stages and excludes --stage");
    o->desc.samples = (uint32_t)option_number(c, OPT_SAMPLES, 0.0);
    TRY(image_options_renderer(c, o, error));
    TRY(image_options_need(c, OPTION_IDS(OPT_SHADING), FACET_RENDERER_FEATURE_OGL1, o, error));
    TRY(image_options_shading(c, o, error));
    if (is_given(c, OPT_SHADING) && !is_given(c, OPT_WITH))
        return fail(error, FACET_ERROR_ARGUMENT, "--shading: it needs a model, as --with boat.obj");
    if (is_given(c, OPT_AOV) && (out->is_before_after || out->sweep))
        return fail(error, FACET_ERROR_ARGUMENT, "--aov: a sheet has no layers; it excludes --%s",
                    out->sweep ? "sweep" : "before-after");
    if (out->has_image)
        TRY(image_options_aov(c, o, error));
    o->desc.path.denoises = is_given(c, OPT_DENOISE);
    TRY(image_options_need(c, OPTION_IDS(OPT_DENOISE), FACET_RENDERER_FEATURE_PATH, o, error));
    static const option_id styles[] = {OPT_BEFORE,  OPT_BEFORE_AFTER, OPT_STAGE,      OPT_NORMALS,
                                       OPT_MASKING, OPT_NO_GLINTS,    OPT_NO_CAUSTICS};
    const option *other = first_given(c, styles, sizeof styles / sizeof *styles, SOURCE_PRESET);
    if (other && !(o->renderer.features & FACET_RENDERER_FEATURE_SEA_STYLES))
        return fail(error, FACET_ERROR_ARGUMENT, "--%s: it has no effect with --renderer %s", other->name,
                    o->renderer.name);
    return FACET_OK;
}

/* ---- camera ---- */

/* --camera, of a model. */
static facet_result read_model_camera(const command_line *c, ocean_options *out, facet_error *error)
{
    static const option_id others[] = {OPT_EYE, OPT_EYE_HEIGHT, OPT_HEADING, OPT_TARGET, OPT_FOV};
    const option *other = first_given(c, others, sizeof others / sizeof *others, SOURCE_PRESET);
    out->render.camera = option_text(c, OPT_CAMERA, NULL);
    if (out->render.camera && !is_given(c, OPT_WITH))
        return fail(error, FACET_ERROR_ARGUMENT, "--camera: it needs a model, as --with boat.glb");
    if (out->render.camera && other)
        return fail(error, FACET_ERROR_ARGUMENT, "--camera: it excludes --%s; give one of them", other->name);
    return FACET_OK;
}

static facet_result read_camera(const command_line *c, ocean_options *out, facet_error *error)
{
    double numbers[3], angle = (double)out->sky.sun_azimuth_rad + BESIDE_SUN * DEGREE;
    out->eye_height_m = (float)option_number(c, OPT_EYE_HEIGHT, 0.0);
    if (is_given(c, OPT_EYE_HEIGHT) && out->eye_height_m == 0.0f)
        out->eye_height_m = 1e-6f; /* 0 would select the default height */
    if (is_given(c, OPT_HEADING) && !value_angle(option_text(c, OPT_HEADING, ""), &angle))
        return option_fail(c, OPT_HEADING, "an angle in degrees", error);
    out->heading_rad = (float)angle;
    out->render.has_eye = is_given(c, OPT_EYE);
    if (out->render.has_eye) {
        if (is_given(c, OPT_EYE_HEIGHT))
            return fail(error, FACET_ERROR_ARGUMENT, "--eye: it excludes --height-of-eye; give one of them");
        if (!value_numbers(option_text(c, OPT_EYE, ""), 3, numbers) ||
            !are_within(numbers, 3, -MAX_DISTANCE, MAX_DISTANCE))
            return option_fail(c, OPT_EYE, "X,Y,Z in metres, each from -1e6 to 1e6", error);
        for (int i = 0; i < 3; i++)
            out->render.eye[i] = numbers[i];
    }
    TRY(read_model_camera(c, out, error));
    out->has_target = is_given(c, OPT_TARGET);
    if (out->has_target) {
        if (is_given(c, OPT_HEADING))
            return fail(error, FACET_ERROR_ARGUMENT, "--target: it excludes --heading; give one of them");
        if (!value_numbers(option_text(c, OPT_TARGET, ""), 3, numbers) ||
            !are_within(numbers, 3, -2.0 * MAX_DISTANCE, 2.0 * MAX_DISTANCE))
            return option_fail(c, OPT_TARGET, "X,Y,Z in metres, each from -2e6 to 2e6", error);
        for (int i = 0; i < 3; i++)
            out->target[i] = (float)numbers[i];
    }
    if (!is_given(c, OPT_FOV))
        return FACET_OK;
    if (!value_angle(option_text(c, OPT_FOV, ""), &angle) || angle < 0.1 * DEGREE || angle > 170.0 * DEGREE)
        return option_fail(c, OPT_FOV, "an angle from 0.1 to 170 degrees", error);
    out->fov_y_rad = (float)angle;
    return FACET_OK;
}

/* ---- what is made ---- */

static bool is_mesh_name(const char *name)
{
    static const char *const extensions[] = {".glb", ".gltf", ".obj"};
    const char *dot = name ? strrchr(name, '.') : NULL;
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        if (strcasecmp(dot, extensions[i]) == 0)
            return true;
    return false;
}

static facet_result read_sequence(const command_line *c, ocean_options *out, facet_error *error)
{
    render_options *o = &out->render;
    TRY(image_options_frames(c, o, error));
    double loop = out->sea.loop_s;
    o->is_sequence = o->has_frames || (!o->has_time && (is_given(c, OPT_LOOP) || o->has_fps));
    if (!o->has_frames)
        o->frames = frame_list_all(1, 1);
    if (!o->has_frames && o->is_sequence && loop <= 0.0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--fps: a sea has no end; give --frames, or a period with --loop");
    double count = round(loop * o->fps);
    if (!o->has_frames && o->is_sequence && count > FRAME_LIST_FRAMES)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--loop: it has more than a million frames at %g frames per second", o->fps);
    if (!o->has_frames && o->is_sequence && count >= 1.0)
        o->frames = frame_list_all(1, (uint32_t)count);
    o->has_frames = o->has_frames || o->is_sequence;
    return FACET_OK;
}

static facet_result read_output(const command_line *c, ocean_options *out, facet_error *error)
{
    render_options *o = &out->render;
    TRY(part_options_read(c, o, error));
    TRY(image_options_output(c, o, error));
    out->maps = option_text(c, OPT_MAPS, NULL);
    out->sweep = option_text(c, OPT_SWEEP, NULL);
    out->models = c->values[OPT_WITH].texts;
    out->model_count = c->values[OPT_WITH].count;
    out->has_mesh = is_mesh_name(o->output);
    out->has_image = o->output && !out->has_mesh;
    out->has_info = is_given(c, OPT_INFO);
    out->mesh = (facet_sea_mesh_desc){.size_m = (float)option_number(c, OPT_MESH_SIZE, 0.0),
                                      .samples = (uint32_t)option_number(c, OPT_MESH_SAMPLES, 0.0)};
    if (o->is_stdout && out->has_info)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--info: it writes to standard output, as --output - does; give one of them");
    if (!o->output && !out->maps && !out->has_info && !is_given(c, OPT_JSON))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "ocean: no output is named; for an image: facet ocean -o sea.png");
    if (out->sweep && (!out->has_image || out->is_before_after))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--sweep: it makes one sheet, named by --output, and excludes --before-after");
    return out->has_image ? image_options_format(c, o, error) : FACET_OK;
}

static facet_result check_maps(const command_line *c, const ocean_options *out, facet_error *error)
{
    const char *maps = out->maps, *dot = maps ? strrchr(maps, '.') : NULL;
    bool has_place = maps && output_name_has_frame(maps);
    if (has_place && (!dot || strcasecmp(dot, ".exr") != 0))
        return option_fail(c, OPT_MAPS, "a folder, or a name with #### that ends in .exr", error);
    if (has_place && out->render.is_sequence)
        return option_fail(c, OPT_MAPS, "a folder, as there are several frames", error);
    return FACET_OK;
}

/* Refuses options without effect on a mesh. */
static facet_result check_mesh(const command_line *c, const ocean_options *out, facet_error *error)
{
    static const option_id of_images[] = {
        OPT_FORMAT,    OPT_SIZE,      OPT_CROP,    OPT_JPEG_QUALITY, OPT_SUN,
        OPT_TURBIDITY, OPT_ENV,       OPT_EV100,   OPT_BEFORE,       OPT_BEFORE_AFTER,
        OPT_STAGE,     OPT_ROUGHNESS, OPT_NORMALS, OPT_MASKING,      OPT_CLAMP,
        OPT_AOV,       OPT_CAMERA,    OPT_SHADING, OPT_WITH,         OPT_RENDERER,
        OPT_EXPOSURE,  OPT_SAMPLES,   OPT_EYE,     OPT_TARGET,       OPT_HEADING};
    const option *other =
        first_given(c, of_images, sizeof of_images / sizeof *of_images, SOURCE_COMMAND_LINE);
    if (other && out->has_mesh)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--%s: it is an option of images, but %s is a mesh of the water", other->name,
                    out->render.output);
    return FACET_OK;
}

/* Requires a frame number in the names of sequences; a sheet is one image. */
static facet_result check_output(const command_line *c, const ocean_options *out, facet_error *error)
{
    facet_result result = check_maps(c, out, error);
    if (result != FACET_OK || !out->render.output)
        return result;
    if (out->sweep && out->render.frames.frame_count > 1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--sweep: it has one moment and excludes --frames and --loop");
    result = check_mesh(c, out, error);
    return result == FACET_OK ? image_options_check_sequence(c, &out->render, error) : result;
}

/* A part is of one image of the sea. */
static facet_result check_shard(const ocean_options *o, facet_error *error)
{
    TRY(part_options_check(&o->render, error));
    if (o->render.desc.part.count && (o->is_before_after || o->sweep || o->has_mesh || o->maps))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--shard-by: --before-after, --sweep, --maps and meshes are not divided; an image is, or "
                    "the frames of "
                    "a sequence");
    return FACET_OK;
}

facet_result ocean_options_read(const command_line *c, ocean_options *out, facet_error *error)
{
    *out = (ocean_options){.sea = facet_sea_default()};
    if (is_given(c, OPT_PRESET))
        TRY(facet_sea_preset(option_text(c, OPT_PRESET, ""), &out->sea, error));
    facet_result (*const readers[])(const command_line *, ocean_options *, facet_error *) = {
        read_output, read_waves, read_water, read_bed, read_sky, read_shading, read_camera, read_sequence};
    TRY(limits_read(c, &out->render.limits, error));
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
        TRY(readers[i](c, out, error));
    TRY(image_options_size(c, "1280x720", &out->render, error));
    TRY(check_output(c, out, error));
    bool is_before = out->shading.style || (out->shading.stage && out->shading.stage <= 2);
    image_options_quality(c, is_before ? FACET_TONEMAP_NONE : FACET_TONEMAP_AGX, &out->render);
    out->render.desc.thread_count = out->render.save.thread_count = out->render.limits.thread_count;
    out->sea.thread_count = out->render.limits.thread_count;
    return check_shard(out, error);
}

void ocean_options_halves(const command_line *c, const ocean_options *o, ocean_half *before, ocean_half *now)
{
    *before = *now = (ocean_half){o->shading, o->render.desc.tonemap};
    before->tonemap = FACET_TONEMAP_NONE; /* these are display values already */
    before->shading.stage = 0;
    if (!before->shading.style)
        before->shading.style = FACET_SEA_STYLE_LEGACY_INTENDED;
    now->shading.style = FACET_SEA_STYLE_PHYSICAL;
    if (o->shading.style && !is_given(c, OPT_TONE_MAPPING))
        now->tonemap = FACET_TONEMAP_AGX;
}
