/* environment_input.c - names of environments. all_words is the table of keywords; their parameters are
 * comma-separated fields. */
#include "cli/shared/environment_input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/shared/environment_share.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/value.h"

#define DEGREE 0.017453292519943295 /* pi / 180 */

enum { MAX_FIELDS = 16, FIELD_SIZE = 64 };
static const float default_albedo = 0.2f; /* dry grass, soil */
static const float white_illuminance = 3.14159265f;

/* Comma-separated fields. */
typedef struct field_list {
    char fields[MAX_FIELDS][FIELD_SIZE];
    size_t count;
} field_list;

/* False: too many, too long, or empty. */
static bool split(const char *text, field_list *out)
{
    out->count = 0;
    for (;;) {
        size_t length = strcspn(text, ",");
        if (out->count == MAX_FIELDS || length >= FIELD_SIZE || length == 0)
            return false;
        char *field = out->fields[out->count++];
        memcpy(field, text, length);
        field[length] = '\0';
        if (!text[length])
            return true;
        text += length + 1;
    }
}

/* ---- colors ---- */

/* Parses a CSS color, "R/G/B", or one number for grey: radiance, at least 0. */
static bool parse_radiance(const char *text, float out[3])
{
    double numbers[3];
    size_t count = 0;
    if (color_parse(text, out))
        return true;
    while (count < 3 && scan_number(&text, &numbers[count]) && numbers[count] >= 0.0 &&
           numbers[count] <= 1e12) {
        count++;
        if (*text != '/')
            break;
        text++;
    }
    if (*text || (count != 1 && count != 3))
        return false;
    for (size_t i = 0; i < 3; i++)
        out[i] = (float)numbers[count == 1 ? 0 : i];
    return true;
}

static bool read_constant(const char *text, environment_input *out)
{
    double numbers[3];
    out->kind = ENVIRONMENT_CONSTANT;
    if (parse_radiance(text, out->radiance[0]))
        return true;
    if (!value_numbers(text, 3, numbers))
        return false;
    for (int i = 0; i < 3; i++) {
        if (!(numbers[i] >= 0.0 && numbers[i] <= 1e12))
            return false;
        out->radiance[0][i] = (float)numbers[i];
    }
    return true;
}

static bool read_gradient(const char *text, environment_input *out)
{
    field_list list;
    out->kind = ENVIRONMENT_GRADIENT;
    if (!split(text, &list) || list.count < 2 || list.count > 3)
        return false;
    for (size_t i = 0; i < 3; i++) /* the nadir defaults to the horizon */
        if (!parse_radiance(list.fields[i < list.count ? i : list.count - 1], out->radiance[i]))
            return false;
    return true;
}

/* ---- skies ---- */

static bool begins(const char *text, const char *prefix)
{
    return strncmp(text, prefix, strlen(prefix)) == 0;
}

static bool number_in(const char *text, double minimum, double maximum, float *out)
{
    double number;
    if (!value_number(text, &number) || !(number >= minimum && number <= maximum))
        return false;
    *out = (float)number;
    return true;
}

static bool read_albedo(const char *text, float albedo[3])
{
    if (!parse_radiance(text, albedo))
        return false;
    return albedo[0] <= 1.0f && albedo[1] <= 1.0f && albedo[2] <= 1.0f;
}

/* Parses a keyword after the numbers of a sky. */
static bool read_sky_word(const char *word, facet_sky_desc *sky)
{
    float height;
    if (strcmp(word, "lux") == 0)
        sky->illuminance_lux = 0.0f;
    else if (strcmp(word, "nodisc") == 0)
        sky->omits_disc = true;
    else if (begins(word, "albedo="))
        return read_albedo(word + strlen("albedo="), sky->ground_albedo);
    else if (begins(word, "altitude=") && sky->model == FACET_SKY_MODEL_ATMOSPHERE)
        return number_in(word + strlen("altitude="), 0.0, 50000.0, &sky->altitude_m);
    else if (begins(word, "height=") && number_in(word + strlen("height="), 16.0, 16384.0, &height))
        sky->height = (uint32_t)height;
    else
        return false;
    return true;
}

static bool read_sky(const char *text, facet_sky_model model, environment_input *out)
{
    field_list list;
    double angles[2] = {0.0, 0.0};
    size_t i = 0;
    facet_sky_desc *sky = &out->sky;
    bool is_atmosphere = model == FACET_SKY_MODEL_ATMOSPHERE;
    out->kind = ENVIRONMENT_SKY;
    *sky = (facet_sky_desc){.model = model,
                            .ground_albedo = {default_albedo, default_albedo, default_albedo},
                            .illuminance_lux = white_illuminance};
    if (!split(text, &list))
        return false;
    for (; i < list.count && i < 2 && value_angle(list.fields[i], &angles[i]); i++)
        ;
    if (i == 0 || !(angles[0] >= (is_atmosphere ? -90.0001 : 0.0) * DEGREE && angles[0] <= 90.0001 * DEGREE))
        return false;
    sky->sun_elevation_rad = (float)fmax(-90.0 * DEGREE, fmin(90.0 * DEGREE, angles[0]));
    sky->sun_azimuth_rad = (float)angles[1];
    if (i == 2 && i < list.count &&
        number_in(list.fields[i], is_atmosphere ? 1.0 : 1.7, 10.0, &sky->turbidity))
        i++;
    for (; i < list.count; i++)
        if (!read_sky_word(list.fields[i], sky))
            return false;
    return true;
}

static bool read_sun(const char *text, environment_input *out)
{
    return read_sky(text, FACET_SKY_MODEL_ATMOSPHERE, out);
}

static bool read_preetham(const char *text, environment_input *out)
{
    return read_sky(text, FACET_SKY_MODEL_PREETHAM, out);
}

/* ---- faces ---- */

enum { NAMING_COUNT = 3 };
static const char *const face_namings[NAMING_COUNT][6] = {
    {"px", "nx", "py", "ny", "pz", "nz"},
    {"posx", "negx", "posy", "negy", "posz", "negz"},
    {"right", "left", "top", "bottom", "front", "back"}};
static const char face_mark[] = "{face}";

static bool read_faces(const char *text, environment_input *out)
{
    size_t commas = 0;
    out->kind = ENVIRONMENT_FACES;
    out->path = text;
    for (const char *p = text; *p; p++) {
        if (*p == ',' && (p == text || p[1] == ',' || p[1] == '\0'))
            return false;
        commas += *p == ',';
    }
    return commas == 5;
}

/* The pattern's name for a face; false: too long. */
static bool expand_face(const char *pattern, const char *face, char name[ENVIRONMENT_PATH_SIZE])
{
    const char *mark = strstr(pattern, face_mark);
    int length = snprintf(name, ENVIRONMENT_PATH_SIZE, "%.*s%s%s", (int)(mark - pattern), pattern, face,
                          mark + strlen(face_mark));
    return length >= 0 && length < ENVIRONMENT_PATH_SIZE;
}

/* Writes the file names of the list, or of the pattern with that naming, to names. */
static bool list_faces(const char *text, int naming, char names[6][ENVIRONMENT_PATH_SIZE])
{
    bool is_pattern = strstr(text, face_mark) != NULL;
    for (int i = 0; i < 6; i++) {
        if (is_pattern) {
            if (!expand_face(text, face_namings[naming][i], names[i]))
                return false;
            continue;
        }
        size_t length = strcspn(text, ",");
        if (length >= ENVIRONMENT_PATH_SIZE)
            return false;
        memcpy(names[i], text, length);
        names[i][length] = '\0';
        text += length + (text[length] == ',');
    }
    return true;
}

/* Writes the six names of the input: of a pattern the first naming with an existing file, else the first naming. False: one
 * is too long. */
static bool choose_faces(const char *text, char names[6][ENVIRONMENT_PATH_SIZE])
{
    bool fits = true;
    int naming = 0;
    if (strstr(text, face_mark))
        for (int n = NAMING_COUNT - 1; fits && n >= 0; n--) {
            fits = list_faces(text, n, names);
            if (fits && input_is_same_file(names[0], names[0]))
                naming = n;
        }
    return fits && list_faces(text, naming, names);
}

static facet_result load_faces(const environment_input *input, const facet_environment_desc *desc,
                               facet_environment **environment, facet_error *error)
{
    char(*names)[ENVIRONMENT_PATH_SIZE] = malloc(6 * sizeof *names);
    if (!names)
        return fail(error, FACET_ERROR_MEMORY, "%s: out of memory", input->path);
    bool fits = choose_faces(input->path, names);
    const char *paths[6] = {names[0], names[1], names[2], names[3], names[4], names[5]};
    facet_result result = fits ? facet_environment_load_faces(paths, desc, environment, error)
                               : fail(error, FACET_ERROR_ARGUMENT, "%s: a name is too long", input->path);
    free(names);
    return result;
}

bool environment_input_get_file(const environment_input *input, int index, char path[ENVIRONMENT_PATH_SIZE])
{
    int count = input->kind == ENVIRONMENT_FILE ? 1 : input->kind == ENVIRONMENT_FACES ? 6 : 0;
    if (index >= count)
        return false;
    if (input->kind == ENVIRONMENT_FILE)
        return snprintf(path, ENVIRONMENT_PATH_SIZE, "%s", input->path) < ENVIRONMENT_PATH_SIZE;
    char(*names)[ENVIRONMENT_PATH_SIZE] = malloc(6 * sizeof *names);
    bool fits = names && choose_faces(input->path, names);
    if (fits)
        memcpy(path, names[index], ENVIRONMENT_PATH_SIZE);
    free(names);
    return fits;
}

/* ---- all words ---- */

typedef struct environment_word {
    const char *name;
    bool (*read)(const char *text, environment_input *out);
    const char *expected;
} environment_word;

static const environment_word all_words[] = {
    {"constant", read_constant, "constant:COLOR, a CSS color, one number or R,G,B, at least 0"},
    {"gradient", read_gradient,
     "gradient:ZENITH,HORIZON[,NADIR], each a CSS color, one number or R/G/B, at least 0"},
    {"sun", read_sun,
     "sun:ELEVATION[,AZIMUTH[,TURBIDITY]], elevation first, -90 to 90 degrees above the horizon, azimuth "
     "from "
     "+Z towards +X, turbidity 1 to 10; then any of lux, nodisc, albedo=X, altitude=M (0 to 50000), "
     "height=ROWS "
     "(16 to 16384)"},
    {"preetham", read_preetham,
     "preetham:ELEVATION[,AZIMUTH[,TURBIDITY]], elevation first, 0 to 90 degrees above the horizon, azimuth "
     "from "
     "+Z towards +X, turbidity 1.7 to 10; then any of lux, nodisc, albedo=X, height=ROWS (16 to 16384)"},
    {"faces", read_faces, "faces:PX,NX,PY,NY,PZ,NZ, six files, or one name with {face} in it"},
};

static facet_result fail_expected(const char *place, const char *text, const char *expected,
                                  facet_error *error)
{
    return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is not %s", place, text, expected);
}

/* Parses a keyword without parameters. False: text is none. */
static bool read_plain_word(const char *text, environment_input *out)
{
    if (strcmp(text, "neutral") == 0 || strcmp(text, "studio") == 0)
        out->kind = ENVIRONMENT_STUDIO;
    else if (strcmp(text, "none") == 0)
        out->kind = ENVIRONMENT_NONE;
    else
        return false;
    return true;
}

facet_result environment_input_parse(const char *place, const char *text, unsigned takes,
                                     environment_input *out, facet_error *error)
{
    *out = (environment_input){.kind = ENVIRONMENT_FILE, .path = text};
    if (read_plain_word(text, out)) {
        if (out->kind == ENVIRONMENT_NONE && !(takes & ENVIRONMENT_TAKES_NONE))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "%s: none is not an environment here; ./none is a file of that name", place);
        return FACET_OK;
    }
    if (strcmp(text, "white") == 0 || text[0] == '#') {
        out->kind = ENVIRONMENT_CONSTANT;
        if (color_parse(text, out->radiance[0]))
            return FACET_OK;
        return fail_expected(place, text,
                             "neutral, white, #rrggbb, a sky such as sun:40,135, or a file (./# for a name "
                             "that begins so)",
                             error);
    }
    if (strcmp(text, "-") == 0 && !(takes & ENVIRONMENT_TAKES_STDIN))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: environments are not read from standard input; name a file", place);
    for (size_t i = 0; i < sizeof all_words / sizeof *all_words; i++) {
        const environment_word *word = &all_words[i];
        size_t length = strlen(word->name);
        if (strncmp(text, word->name, length) != 0 || (text[length] != ':' && text[length] != '\0'))
            continue;
        if (text[length] == ':' && word->read(text + length + 1, out))
            return FACET_OK;
        return fail_expected(place, text, word->expected, error);
    }
    if (strstr(text, face_mark))
        out->kind = ENVIRONMENT_FACES;
    return FACET_OK;
}

facet_result environment_input_create(const environment_input *input, const facet_environment_desc *desc,
                                      facet_environment **environment, facet_error *error)
{
    *environment = NULL;
    switch (input->kind) {
    case ENVIRONMENT_STUDIO:
        return facet_environment_create_studio(desc, environment, error);
    case ENVIRONMENT_CONSTANT:
        return facet_environment_create_constant(input->radiance[0], desc, environment, error);
    case ENVIRONMENT_GRADIENT:
        return facet_environment_create_gradient(input->radiance[0], input->radiance[1], input->radiance[2],
                                                 desc, environment, error);
    case ENVIRONMENT_SKY:
        return facet_environment_create_sky(&input->sky, desc, environment, error);
    default:
        return FACET_OK;
    }
}

static facet_result load(const environment_input *input, const facet_environment_desc *desc,
                         facet_environment **environment, facet_error *error)
{
    if (input->kind == ENVIRONMENT_FILE)
        return input_load_environment(input->path, desc, environment, error);
    return input->kind == ENVIRONMENT_FACES ? load_faces(input, desc, environment, error)
                                            : environment_input_create(input, desc, environment, error);
}

facet_result environment_input_load(const environment_input *input, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error)
{
    *environment = environment_share_take(input);
    if (*environment)
        return FACET_OK;
    if (!desc->cache_folder) /* the cache writes files */
        interrupt_begin_reading(environment_input_name(input));
    facet_result result = load(input, desc, environment, error);
    interrupt_end();
    return result;
}

const char *environment_input_name(const environment_input *input)
{
    static const char *const names[] = {[ENVIRONMENT_STUDIO] = "studio",
                                        [ENVIRONMENT_NONE] = "none",
                                        [ENVIRONMENT_CONSTANT] = "constant",
                                        [ENVIRONMENT_GRADIENT] = "gradient",
                                        [ENVIRONMENT_SKY] = "sky"};
    return input->kind == ENVIRONMENT_FILE    ? input_name(input->path)
           : input->kind == ENVIRONMENT_FACES ? input->path
                                              : names[input->kind];
}

bool environment_input_is_file(const environment_input *input, const char *path)
{
    if (input->kind == ENVIRONMENT_FILE)
        return input_is_same_file(path, input->path);
    if (input->kind != ENVIRONMENT_FACES)
        return false;
    char(*names)[ENVIRONMENT_PATH_SIZE] = malloc(6 * sizeof *names);
    bool is_same = false;
    for (int n = 0; names && n < NAMING_COUNT; n++)
        if (list_faces(input->path, n, names))
            for (int i = 0; i < 6; i++)
                is_same = is_same || input_is_same_file(path, names[i]);
    free(names);
    return is_same;
}
