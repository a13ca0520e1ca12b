/* suggest.c - suggestions for unknown words: similar names, and other tools' names. */
#include "cli/shared/suggest.h"

#include "cli/shared/failure.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MAX_WORD = 63 };

/* Options of f3d, blender, <model-viewer>, screenshot-glb, cmgen, glTF-IBL-Sampler, cmft, ktx,
 * gltf-transform and ImageMagick, and their counterparts here. Of several rows with one name the first
 * counts whose option the verb has. */
static const struct {
    const char *theirs;
    option_id id; /* suggested only if the verb has it */
    const char *ours;
} foreign_names[] = {
    /* facet bake */
    {"deploy", OPT_LAYOUT, "-o FOLDER --layout filament"},
    {"extract", OPT_LAYOUT, "--lobe none -o '{face}.hdr'"},
    {"extract-blur", OPT_LAYOUT, "--lobe ggx --level N -o '{face}.hdr'"},
    {"ibl-ld", OPT_LAYOUT, "-o 'm{level}_{face}.hdr' --mapping filament"},
    {"ibl-irradiance", OPT_DIFFUSE, "--diffuse FILE"},
    {"irradiance", OPT_DIFFUSE, "--diffuse FILE"},
    {"lambert", OPT_DIFFUSE, "--diffuse FILE"},
    {"sh-output", OPT_SH, "--sh FILE.json, .h or .txt"},
    {"sh-shader", OPT_SH, "--sh FILE.txt"},
    {"sh-irradiance", OPT_SH, "--sh FILE.json, which has it"},
    {"spherical-harmonics", OPT_SH, "--sh FILE.json"},
    {"ibl-dfg", OPT_DFG, "--dfg -o FILE"},
    {"ibl-dfg-multiscatter", OPT_DFG, "--dfg --distribution multiscatter"},
    {"ibl-dfg-cloth", OPT_DFG, "--dfg --distribution filament"},
    {"brdf", OPT_DFG, "--dfg -o FILE"},
    {"lut", OPT_DFG, "--dfg -o FILE"},
    {"outlut", OPT_DFG, "--dfg -o FILE, a command of its own"},
    {"outcubemap", OPT_LOBE, "--output FILE.ktx2"},
    {"output0", OPT_LOBE, "--output FILE.ktx2"},
    {"outputnum", OPT_LOBE, "--output, --diffuse, --sheen, each with its file"},
    {"output0params", OPT_PROJECTION, "--format and --projection"},
    {"inputpath", OPT_LOBE, "nothing: the environment is given without an option"},
    {"input", OPT_LOBE, "nothing: the environment is given without an option"},
    {"env", OPT_LOBE, "nothing: the environment is given without an option"},
    {"environment", OPT_LOBE, "nothing: the environment is given without an option"},
    {"hdri", OPT_LOBE, "nothing: the environment is given without an option"},
    {"src", OPT_LOBE, "nothing: the environment is given without an option"},
    {"inputfacesize", OPT_SIZE, "--size N"},
    {"srcfacesize", OPT_SIZE, "--size N"},
    {"dstfacesize", OPT_LOBE, "--size N"},
    {"cubemapresolution", OPT_LOBE, "--size N"},
    {"face-size", OPT_LOBE, "--size N"},
    {"resolution", OPT_LOBE, "--size N"},
    {"width", OPT_LOBE, "--size N"},
    {"height", OPT_LOBE, "--size N"},
    {"samplecount", OPT_LOBE, "--samples N"},
    {"no-mirror", OPT_PROJECTION, "--input-layout for the layout of the image; nothing is mirrored"},
    {"ibl-min-lod-size", OPT_MIPS, "--mips N"},
    {"miplevelcount", OPT_MIPS, "--mips N"},
    {"mip-count", OPT_MIPS, "--mips N"},
    {"mipcount", OPT_MIPS, "--mips N"},
    {"levels", OPT_MIPS, "--mips N"},
    {"mip-levels", OPT_MIPS, "--mips N"},
    {"genmipmap", OPT_MIPS, "--mips N"},
    {"generate-mipmap", OPT_MIPS, "--mips N"},
    {"targetformat", OPT_ZSTD, "--format rgba16f"},
    {"target-format", OPT_ZSTD, "--format rgba16f"},
    {"lodbias", OPT_SAMPLES, "--samples N; samples are filtered by their density"},
    {"filter", OPT_LOBE, "--lobe LOBE"},
    {"lightingmodel", OPT_LOBE, "--lobe LOBE"},
    {"type", OPT_PROJECTION, "--projection HOW"},
    {"cube-layout", OPT_PROJECTION, "--projection HOW"},
    {"env-layout", OPT_INPUT_LAYOUT, "--input-layout HOW"},
    {"env-rotation", OPT_ROTATION, "--rotation DEG"},
    {"environment-rotation", OPT_ROTATION, "--rotation DEG"},
    {"env-intensity", OPT_ROTATION, "--exposure 2x"},
    {"intensity", OPT_ROTATION, "--exposure 2x"},
    {"zcmp", OPT_ZSTD, "--zstd LEVEL"},
    {"numcpuprocessingthreads", OPT_LOBE, "--threads N"},
    {"ibl-no-prefilter", OPT_METHOD, "--method reference"},
    {"sheet", OPT_PREVIEW, "--preview FILE.png"},
    {"resolution", OPT_SIZE, "--size 640x480"},
    {"width", OPT_SIZE, "--size 640x480"},
    {"height", OPT_SIZE, "--size 640x480"},
    {"geometry", OPT_SIZE, "--size 640x480"},
    {"dimensions", OPT_SIZE, "--size 640x480"},
    {"resize", OPT_SIZE, "--size 640x480"},
    {"out", OPT_OUTPUT, "--output FILE"},
    {"out-file", OPT_OUTPUT, "--output FILE"},
    {"outfile", OPT_OUTPUT, "--output FILE"},
    {"output-file", OPT_OUTPUT, "--output FILE"},
    {"output-format", OPT_FORMAT, "--format FORMAT"},
    {"render-output", OPT_OUTPUT, "--output FILE"},
    {"output-path", OPT_OUTPUT, "--output FILE"},
    {"render-format", OPT_FORMAT, "--format png"},
    {"file-format", OPT_FORMAT, "--format png"},
    {"hdri-file", OPT_ENV, "--env FILE"},
    {"hdri", OPT_ENV, "--env FILE"},
    {"hdr", OPT_ENV, "--env FILE"},
    {"hdri-ambient", OPT_ENV, "--env FILE"},
    {"ibl", OPT_ENV, "--env FILE"},
    {"environment", OPT_ENV, "--env FILE"},
    {"env-map", OPT_ENV, "--env FILE"},
    {"environment-rotation", OPT_ENV_ROTATION, "--env-rotation DEG"},
    {"environment-intensity", OPT_ENV_INTENSITY, "--env-intensity X"},
    {"skybox", OPT_BACKGROUND, "--background env"},
    {"skybox-image", OPT_BACKGROUND, "--env FILE --background env"},
    {"hdri-skybox", OPT_BACKGROUND, "--background env"},
    {"no-background", OPT_BACKGROUND, "--background transparent"},
    {"transparent", OPT_BACKGROUND, "--background transparent"},
    {"film-transparent", OPT_BACKGROUND, "--background transparent"},
    {"alpha", OPT_BACKGROUND, "--background transparent"},
    {"background-color", OPT_BACKGROUND, "--background '#rrggbb'"},
    {"bg-color", OPT_BACKGROUND, "--background '#rrggbb'"},
    {"bg", OPT_BACKGROUND, "--background '#rrggbb'"},
    {"ambient-occlusion", OPT_AO, "--ao"},
    {"ssao", OPT_AO, "--ao"},
    {"shadow-intensity", OPT_GROUND, "--renderer path --ground shadow"},
    {"shadow-softness", OPT_GROUND, "--renderer path --ground shadow"},
    {"blur-background", OPT_BACKGROUND_BLUR, "--background-blur 0.3"},
    {"camera-azimuth-angle", OPT_ORBIT, "--orbit AZIMUTH"},
    {"azimuth", OPT_ORBIT, "--orbit AZIMUTH"},
    {"camera-elevation-angle", OPT_ORBIT, "--orbit 0,POLAR (90 minus the elevation)"},
    {"elevation", OPT_ORBIT, "--orbit 0,POLAR (90 minus the elevation)"},
    {"camera-zoom-factor", OPT_ORBIT, "--orbit 0,75,50%"},
    {"zoom", OPT_ORBIT, "--orbit 0,75,50%"},
    {"distance", OPT_ORBIT, "--orbit 0,75,2m"},
    {"camera-focal-point", OPT_TARGET, "--target X,Y,Z"},
    {"look-at", OPT_TARGET, "--target X,Y,Z"},
    {"lookat", OPT_TARGET, "--target X,Y,Z"},
    {"camera-position", OPT_EYE, "--eye X,Y,Z"},
    {"position", OPT_EYE, "--eye X,Y,Z"},
    {"camera-view-up", OPT_UP, "--up z"},
    {"camera-direction", OPT_ORBIT, "--orbit AZIMUTH,POLAR"},
    {"camera-view-angle", OPT_FOV, "--fov DEG"},
    {"fovy", OPT_FOV, "--fov DEG"},
    {"camera-index", OPT_CAMERA, "--camera NUMBER"},
    {"camera-name", OPT_CAMERA, "--camera NAME"},
    {"camera-orthographic", OPT_ORTHO, "--ortho"},
    {"orthographic", OPT_ORTHO, "--ortho"},
    {"light-intensity", OPT_EXPOSURE, "--exposure 2x"},
    {"brightness", OPT_EXPOSURE, "--exposure +1"},
    {"tonemap", OPT_TONE_MAPPING, "--tone-mapping OPERATOR"},
    {"tone-map", OPT_TONE_MAPPING, "--tone-mapping OPERATOR"},
    {"view-transform", OPT_TONE_MAPPING, "--tone-mapping OPERATOR"},
    {"spp", OPT_SAMPLES, "--samples N"},
    {"samples-per-pixel", OPT_SAMPLES, "--samples N"},
    {"cycles-samples", OPT_SAMPLES, "--samples N"},
    {"raytracing-samples", OPT_SAMPLES, "--samples N"},
    {"ibl-samples", OPT_SAMPLES, "--samples N"},
    {"sample-count", OPT_SAMPLES, "--samples N"},
    {"msaa", OPT_SAMPLES, "--samples 16"},
    {"anti-aliasing", OPT_SAMPLES, "--samples 16"},
    {"engine", OPT_RENDERER, "--renderer preview"},
    {"jobs", OPT_THREADS, "--threads N"},
    {"num-threads", OPT_THREADS, "--threads N"},
    {"thread-count", OPT_THREADS, "--threads N"},
    {"threads-count", OPT_THREADS, "--threads N"},
    {"memory-limit", OPT_MAX_MEMORY, "--max-memory 2G"},
    {"timeout", OPT_TIME_LIMIT, "--time-limit 30s"},
    {"loading-progress", OPT_PROGRESS, "--progress plain"},
    {"silent", OPT_QUIET, "--quiet"},
    {"debug", OPT_VERBOSE, "-vv"},
    {"log-level", OPT_VERBOSE, "-v"},
    {"quality-level", OPT_QUALITY, "--quality final"},
    {"compression", OPT_PNG_COMPRESSION, "--png-compression N"},
    {"jpg-quality", OPT_JPEG_QUALITY, "--jpeg-quality N"},
    {"webp-quality", OPT_JPEG_QUALITY, "--jpeg-quality N"},
    {"shot", OPT_TURNTABLE, "--turntable 36"},
    {"auto-rotate", OPT_TURNTABLE, "--turntable 36"},
    {"spin", OPT_TURNTABLE, "--turntable 36"},
    {"skip-existing", OPT_NO_CLOBBER, "--no-clobber"},
    {"no-overwrite", OPT_NO_CLOBBER, "--no-clobber"},
    {"overwrite", OPT_OUTPUT, "nothing: an existing output is replaced unless --no-clobber is given"},
    {"force", OPT_OUTPUT, "nothing: an existing output is replaced unless --no-clobber is given"},
    {"input", OPT_HELP, "nothing: the model is given without an option"},
    {"src", OPT_HELP, "nothing: the model is given without an option"},
};

/* Names of commands in other tools, and words that users may try. */
static const struct {
    const char *theirs, *ours;
} foreign_verbs[] = {
    {"path", "render"},      {"pathtrace", "render"}, {"pathtracer", "render"}, {"trace", "render"},
    {"raytrace", "render"},  {"thumbnail", "render"}, {"screenshot", "render"}, {"cmgen", "bake"},
    {"ibl", "bake"},         {"prefilter", "bake"},   {"filter", "bake"},       {"envmap", "bake"},
    {"cubemap", "bake"},     {"diff", "compare"},     {"flip", "compare"},      {"info", "inspect"},
    {"describe", "inspect"}, {"export", "convert"},
};

static const struct {
    char theirs;
    option_id id;
    const char *ours;
} foreign_letters[] = {
    {'x', OPT_LAYOUT, "-o FOLDER --layout filament"},
    {'f', OPT_LAYOUT, "the extension of --output, or --format FORMAT"},
    {'i', OPT_LAYOUT, "nothing: the environment is given without an option"},
    {'t', OPT_PROJECTION, "--projection HOW, or -j N for threads"},
    {'w', OPT_SH_WINDOW, "--sh-window auto"},
    {'w', OPT_SIZE, "--size 640x480"},
    {'W', OPT_SIZE, "--size 640x480"},
    {'i', OPT_HELP, "nothing: the model is given without an option"},
    {'t', OPT_THREADS, "-j N, --threads N"},
    {'f', OPT_FORMAT, "--format png"},
    {'F', OPT_FORMAT, "--format png"},
    {'b', OPT_BACKGROUND, "--background WHAT"},
    {'c', OPT_BACKGROUND, "--background WHAT"},
};

/* ---- near names ---- */

/* Lower case, "-" for "_", at most MAX_WORD characters. */
static size_t fold(const char *word, char *folded)
{
    size_t n = 0;
    for (; n < MAX_WORD && word[n]; n++)
        folded[n] = word[n] == '_' ? '-' : (char)tolower((unsigned char)word[n]);
    folded[n] = 0;
    return n;
}

static unsigned minimum(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* Optimal string alignment distance: Levenshtein 1966 with transpositions, in three rows. */
unsigned edit_distance(const char *a, const char *b)
{
    char x[MAX_WORD + 1], y[MAX_WORD + 1];
    size_t nx = fold(a, x), ny = fold(b, y);
    unsigned rows[3][MAX_WORD + 1];
    unsigned *before = rows[0], *last = rows[1], *row = rows[2];
    for (size_t j = 0; j <= ny; j++)
        last[j] = (unsigned)j;
    for (size_t i = 1; i <= nx; i++) {
        row[0] = (unsigned)i;
        for (size_t j = 1; j <= ny; j++) {
            row[j] = minimum(minimum(last[j], row[j - 1]) + 1, last[j - 1] + (x[i - 1] != y[j - 1]));
            if (i > 1 && j > 1 && x[i - 1] == y[j - 2] && x[i - 2] == y[j - 1])
                row[j] = minimum(row[j], before[j - 2] + 1);
        }
        unsigned *free_row = before;
        before = last;
        last = row;
        row = free_row;
    }
    return last[ny];
}

/* Whether text may be a mistyped word, or a prefix of at least 3 letters; a smaller badness is nearer. */
static bool is_near(const char *text, const char *word, unsigned *badness)
{
    size_t length = strlen(text);
    unsigned distance = edit_distance(text, word);
    *badness = 2 * distance;
    if (length >= 3 && length < strlen(word) && strncmp(text, word, length) == 0) {
        *badness = 1;
        return true;
    }
    return distance <= (length <= 3 ? 1u : length <= 7 ? 2u : 3u) && distance < length;
}

/* Option values of other programs, for options that have ours as a choice. */
static const struct {
    const char *theirs, *ours;
} foreign_words[] = {{"commerce", "neutral"}, /* model-viewer */
                     {"pbr-neutral", "neutral"},
                     {"khronos-pbr-neutral", "neutral"}};

static const char *find_foreign_word(const char *text, const char *const *words)
{
    for (size_t i = 0; i < sizeof foreign_words / sizeof *foreign_words; i++)
        for (const char *const *word = words; *word && strcmp(text, foreign_words[i].theirs) == 0; word++)
            if (strcmp(*word, foreign_words[i].ours) == 0)
                return *word;
    return NULL;
}

const char *suggest_word(const char *text, const char *const *words)
{
    const char *foreign = find_foreign_word(text, words);
    if (foreign)
        return foreign;
    const char *best = NULL;
    unsigned best_badness = ~0u, badness;
    for (; *words; words++)
        if (is_near(text, *words, &badness) && badness < best_badness) {
            best_badness = badness;
            best = *words;
        }
    return best;
}

const char *suggest_verb(const char *text)
{
    for (size_t i = 0; i < sizeof foreign_verbs / sizeof *foreign_verbs; i++)
        if (strcmp(text, foreign_verbs[i].theirs) == 0)
            return foreign_verbs[i].ours;
    const char *names[16] = {0};
    for (size_t i = 0; i < 15 && verbs[i]; i++)
        names[i] = verbs[i]->name;
    return suggest_word(text, names);
}

/* ---- options ---- */

/* The counterpart in v of another tool's option (folded); NULL: none. */
static const char *find_foreign(const verb *v, const char *folded)
{
    for (size_t i = 0; i < sizeof foreign_names / sizeof *foreign_names; i++)
        if (strcmp(folded, foreign_names[i].theirs) == 0 && option_find_id(v, foreign_names[i].id))
            return foreign_names[i].ours;
    return NULL;
}

const char *suggest_foreign(const verb *v, const char *name, size_t length)
{
    char text[MAX_WORD + 1], folded[MAX_WORD + 1];
    snprintf(text, sizeof text, "%.*s", (int)(length < MAX_WORD ? length : MAX_WORD), name);
    fold(text, folded);
    return find_foreign(v, folded);
}

/* The first verb that has an option of that exact name; NULL: none. */
static const verb *find_owner(const char *name)
{
    for (size_t i = 0; verbs[i]; i++)
        if (option_find(verbs[i], name, strlen(name)))
            return verbs[i];
    return NULL;
}

facet_result suggest_option(const verb *v, const char *name, size_t length, facet_error *error)
{
    char text[MAX_WORD + 1], folded[MAX_WORD + 1];
    snprintf(text, sizeof text, "%.*s", (int)(length < MAX_WORD ? length : MAX_WORD), name);
    fold(text, folded);
    const char *ours = find_foreign(v, folded);
    if (ours)
        return fail(error, FACET_ERROR_ARGUMENT, "unknown option --%s; did you mean %s?", text, ours);
    if (option_is_planned(folded))
        return fail(error, FACET_ERROR_ARGUMENT, "--%s: this version of facet does not have it yet", text);
    const verb *owner = find_owner(folded);
    if (owner && strcmp(v->name, "ocean") == 0 && strcmp(folded, "ground") == 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--ground is an option of facet render; in a sea the water and its bed are the ground "
                    "(--depth, --bed-color)");
    if (strcmp(v->name, "batch") == 0 && option_find(verb_find("render"), folded, strlen(folded)))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--%s is an option of facet render; options of all items stand after --, as in facet batch "
            "models/ -o '{stem}.png' -- --%s",
            folded, folded);
    if (owner)
        return fail(error, FACET_ERROR_ARGUMENT, "--%s is an option of facet %s, not of facet %s", folded,
                    owner->name, v->name);
    const char *best = NULL;
    unsigned best_badness = ~0u, badness;
    const option *o;
    for (size_t i = 0; (o = option_at(v, i)); i++)
        if (is_near(folded, o->name, &badness) && badness < best_badness) {
            best_badness = badness;
            best = o->name;
        }
    if (best)
        return fail(error, FACET_ERROR_ARGUMENT, "unknown option --%s; did you mean --%s?", text, best);
    return fail(error, FACET_ERROR_ARGUMENT, "unknown option --%s; facet help %s lists the options", text,
                v->name);
}

facet_result suggest_letter(const verb *v, char letter, facet_error *error)
{
    for (size_t i = 0; i < sizeof foreign_letters / sizeof *foreign_letters; i++)
        if (letter == foreign_letters[i].theirs && option_find_id(v, foreign_letters[i].id))
            return fail(error, FACET_ERROR_ARGUMENT, "unknown option -%c; did you mean %s?", letter,
                        foreign_letters[i].ours);
    return fail(error, FACET_ERROR_ARGUMENT, "unknown option -%c; facet help %s lists the options", letter,
                v->name);
}
