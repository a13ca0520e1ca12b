/* request.c - see request.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/serve/request.h"

#include "base/base64.h"
#include "cli/shared/environment_input.h"
#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A request while its parameters are read. */
typedef struct reader {
    request_limits *limits;
    request *r;
    json_t *options; /* the parameters that become options, changed where they are paths or limits */
    const json_t *params;
    request_body body; /* until it is taken */
    answer *refusal;
} reader;

static const verb *verb_of(const reader *d)
{
    return d->r->method->verb;
}

/* Refuses with the sentence of an error of the command. */
static bool refuse(const reader *d, const facet_error *error)
{
    return answer_fail(d->refusal, answer_kind_of(exit_code_of(error->result), false), "%s", error->message);
}

static bool refuse_memory(const reader *d)
{
    return answer_fail(d->refusal, ANSWER_TOO_LARGE, "out of memory");
}

static const char *text_of(const reader *d, const char *name, const char *otherwise)
{
    const char *value = json_string_value(json_object_get(d->params, name));
    return value ? value : otherwise;
}

/* ---- inputs that come with the request ---- */

static bool make_folder(reader *d)
{
    facet_error error;
    request_limits *l = d->limits;
    if (d->r->folder.path[0])
        return true;
    if (!l->folder.path[0] && folder_create(&l->folder, &error) != FACET_OK)
        return refuse(d, &error);
    return folder_create_below(&d->r->folder, &l->folder, l->last_request, &error) == FACET_OK ||
           refuse(d, &error);
}

/* Decodes the text of a base64 value; *bytes is for free(). place begins messages. */
static bool decode(reader *d, const char *place, const json_t *value, unsigned char **bytes, size_t *size)
{
    size_t length = json_string_length(value);
    if (!json_is_string(value))
        return answer_fail(d->refusal, ANSWER_USAGE, "%s: base64 must be text", place);
    if (length / 4 * 3 > d->limits->max_body_bytes)
        return answer_fail(d->refusal, ANSWER_TOO_LARGE,
                           "%s: it is larger than the limit of %.6g MiB (--max-body)", place,
                           (double)d->limits->max_body_bytes / 1048576.0);
    *bytes = malloc(base64_bound(length));
    if (!*bytes)
        return refuse_memory(d);
    if (base64_decode(json_string_value(value), length, *bytes, size)) {
        d->r->held_bytes += *size;
        return true;
    }
    free(*bytes);
    *bytes = NULL;
    return answer_fail(d->refusal, ANSWER_USAGE, "%s: its base64 has characters that are not base64", place);
}

/* Keeps bytes as a file of the request; path: its place. */
static bool keep_file(reader *d, const char *name, const void *bytes, size_t size, char path[ROOT_PATH_SIZE])
{
    facet_error error;
    if (!make_folder(d))
        return false;
    if (folder_add(&d->r->folder, name, bytes, size, path, ROOT_PATH_SIZE, &error) == FACET_OK)
        return true;
    return refuse(d, &error);
}

/* Keeps the files beside a model: an object of names and base64. */
static bool keep_files(reader *d, const json_t *files)
{
    const char *name;
    json_t *value;
    if (!json_is_object(files))
        return answer_fail(d->refusal, ANSWER_USAGE, "files: it must be an object of names and base64");
    json_object_foreach((json_t *)(uintptr_t)files, name, value)
    {
        unsigned char *bytes;
        size_t size;
        char path[ROOT_PATH_SIZE];
        if (!decode(d, name, value, &bytes, &size))
            return false;
        bool is_kept = keep_file(d, name, bytes, size, path);
        free(bytes);
        if (!is_kept)
            return false;
    }
    return true;
}

/* Puts the word for bytes to path: - for standard input, which the first nameless bytes become; else a file. It takes
 * bytes if it returns true. */
static bool take_bytes(reader *d, unsigned char *bytes, size_t size, const char *name, const char *otherwise,
                       bool has_files, char path[ROOT_PATH_SIZE])
{
    if (!name && !has_files && !d->r->input && otherwise) {
        d->r->input = bytes;
        d->r->input_size = size;
        memcpy(path, "-", 2);
        return true;
    }
    if (!keep_file(d, name ? name : otherwise ? otherwise : "input", bytes, size, path))
        return false;
    free(bytes);
    return true;
}

/* An input in base64: {"base64": .., "name": .., "files": {..}}. otherwise: its name; NULL: it may not be standard
 * input, and place is the name. */
static bool read_data(reader *d, const char *place, const json_t *object, const char *otherwise,
                      char path[ROOT_PATH_SIZE])
{
    const char *member;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, member, value)
    {
        if (strcmp(member, "base64") != 0 && strcmp(member, "name") != 0 && strcmp(member, "files") != 0)
            return answer_fail(d->refusal, ANSWER_USAGE, "%s: it has base64, name and files, but no %.100s",
                               place, member);
    }
    const json_t *files = json_object_get(object, "files"), *name = json_object_get(object, "name");
    unsigned char *bytes = NULL;
    size_t size = 0;
    if (name && !json_is_string(name))
        return answer_fail(d->refusal, ANSWER_USAGE, "%s: name must be text", place);
    if (!decode(d, place, json_object_get(object, "base64"), &bytes, &size))
        return false;
    const char *word = name ? json_string_value(name) : otherwise ? NULL : place;
    if ((!files || keep_files(d, files)) && take_bytes(d, bytes, size, word, otherwise, files != NULL, path))
        return true;
    free(bytes);
    return false;
}

/* ---- paths ---- */

bool request_find_environment(const root *r, const char *place, const char *text, unsigned takes,
                              char path[ROOT_PATH_SIZE], answer *refusal)
{
    environment_input input;
    facet_error error;
    char file[ENVIRONMENT_PATH_SIZE];
    if (environment_input_parse(place, text, takes, &input, &error) != FACET_OK)
        return answer_fail(refusal, ANSWER_USAGE, "%s", error.message);
    if (input.kind == ENVIRONMENT_FILE) {
        if (!root_find(r, input.path, file, refusal))
            return false;
        snprintf(path, ROOT_PATH_SIZE, "%s%.*s", file[0] == '.' ? "" : "./", ROOT_PATH_SIZE - 4, file);
        return true;
    }
    for (int i = 0; input.kind == ENVIRONMENT_FACES && i < 6; i++) {
        char found[ROOT_PATH_SIZE];
        if (environment_input_get_file(&input, i, file) && !root_find(r, file, found, refusal))
            return false;
    }
    snprintf(path, ROOT_PATH_SIZE, "%.*s", ROOT_PATH_SIZE - 1, text);
    return true;
}

/* The path of an input of the method, which is one file: a folder would be several models, and a pipe may never end. */
static bool find_file(const reader *d, const char *text, char path[ROOT_PATH_SIZE])
{
    struct stat info;
    if (!root_find(&d->limits->root, text, path, d->refusal))
        return false;
    return (stat(path, &info) == 0 && S_ISREG(info.st_mode)) ||
           answer_fail(d->refusal, ANSWER_USAGE, "%.800s: it is not a file", text);
}

/* The word for an input: a path, or data. otherwise: as in read_data(). */
static bool read_input(reader *d, const char *place, const json_t *value, bool is_environment,
                       const char *otherwise, char path[ROOT_PATH_SIZE])
{
    const char *text = json_string_value(value);
    if (json_is_object(value))
        return read_data(d, place, value, otherwise, path);
    if (!text)
        return answer_fail(d->refusal, ANSWER_USAGE, "%s: it must be a path, or an object with base64",
                           place);
    unsigned takes = d->r->method->takes_environment ? 0 : ENVIRONMENT_TAKES_NONE;
    if (!d->r->name[0])
        snprintf(d->r->name, sizeof d->r->name, "%.*s", REQUEST_NAME_SIZE - 1, text);
    if (is_environment)
        return request_find_environment(&d->limits->root, place, text, takes, path, d->refusal);
    return otherwise ? find_file(d, text, path) : root_find(&d->limits->root, text, path, d->refusal);
}

/* Adds the arguments of the verb. */
static bool read_inputs(reader *d)
{
    const method *m = d->r->method;
    for (int i = 0; m->inputs[i]; i++) {
        const json_t *value = json_object_get(d->params, m->inputs[i]);
        char path[ROOT_PATH_SIZE];
        if (i == 0 && d->body.bytes && value)
            return answer_fail(d->refusal, ANSWER_USAGE, "%s: the body of the request holds it already",
                               m->inputs[0]);
        if (!value && !(i == 0 && d->body.bytes)) {
            if (m->takes_environment && json_is_true(json_object_get(d->params, "dfg")))
                continue;
            return answer_fail(d->refusal, ANSWER_USAGE, "%s: %s is missing: %s", m->verb->name, m->inputs[i],
                               m->input_help);
        }
        if (value && !read_input(d, m->inputs[i], value, m->takes_environment, m->inputs[i], path))
            return false;
        if (!value) {
            if (!take_bytes(d, d->body.bytes, d->body.size, text_of(d, "name", NULL), m->inputs[i], false,
                            path))
                return false;
            d->body.bytes = NULL;
        }
        job_words_add(&d->r->words, path);
    }
    return true;
}

/* ---- options ---- */

static bool set_text(reader *d, const char *name, const char *value)
{
    json_t *text = report_string_json(value);
    return json_object_set_new(d->options, name, text) == 0 || refuse_memory(d);
}

/* Checks a member that is an option, and replaces paths. */
static bool read_option(reader *d, const option *o, const json_t *value)
{
    char path[ROOT_PATH_SIZE];
    if (o->id == OPT_NO_CLOBBER && !json_object_get(d->params, "output"))
        return answer_fail(d->refusal, ANSWER_USAGE, "%s: it needs output, the file that may exist", o->name);
    switch (parameter_use_of(o)) {
    case PARAMETER_VALUE:
        return true;
    case PARAMETER_REFUSED:
        return answer_fail(d->refusal, ANSWER_USAGE, "%s: it cannot be given in a request", o->name);
    case PARAMETER_ENVIRONMENT:
    case PARAMETER_INPUT:
        return read_input(d, o->name, value, o->id == OPT_ENV, NULL, path) && set_text(d, o->name, path);
    case PARAMETER_OUTPUT:
        break;
    }
    if (!json_is_string(value))
        return answer_fail(d->refusal, ANSWER_USAGE, "%s: it must be the path of a file to write", o->name);
    /* what they stand for is not checked below: the stem of "...glb" is ".." */
    if (output_name_has_model(json_string_value(value)))
        return answer_fail(d->refusal, ANSWER_USAGE,
                           "%s: a request has one model: {stem}, {name}, {dir} and {index} cannot be in the "
                           "name of its output",
                           o->name);
    if (json_object_get(d->params, "output") || !d->r->method->makes_file)
        return root_place(&d->limits->root, json_string_value(value), path, d->refusal) &&
               set_text(d, o->name, path);
    if (!folder_name_is_plain(json_string_value(value)))
        return answer_fail(d->refusal, ANSWER_USAGE,
                           "%s: without output it is the name of a file of the result", o->name);
    if (!make_folder(d))
        return false;
    snprintf(path, sizeof path, "%s/out/%s", d->r->folder.path, json_string_value(value));
    return set_text(d, o->name, path);
}

/* Whether the member is an input or belongs to one. */
static bool is_input(const method *m, const char *name)
{
    for (int i = 0; m->inputs[i]; i++)
        if (strcmp(m->inputs[i], name) == 0)
            return true;
    return strcmp(name, "name") == 0;
}

static bool read_options(reader *d)
{
    const char *name;
    json_t *value;
    void *next;
    json_object_foreach_safe(d->options, next, name, value)
    {
        if (is_input(d->r->method, name)) {
            json_object_del(d->options, name);
            continue;
        }
        const option *o = option_find(verb_of(d), name, strlen(name));
        if (o && !read_option(d, o, json_object_get(d->params, name)))
            return false; /* unknown ones: job_options_add() */
    }
    return true;
}

/* ---- limits ---- */

/* The text of a number or text. */
static const char *scalar(const json_t *value, char buffer[64])
{
    if (json_is_number(value))
        snprintf(buffer, 64, "%.17g", json_number_value(value));
    return json_is_number(value) ? buffer : json_string_value(value);
}

/* Lowers the limits of a request to those of the server; a text that is no limit stays, and is refused later. */
static bool cap_limits(reader *d)
{
    const request_limits *l = d->limits;
    char buffer[64], cap[64];
    double seconds;
    uint64_t bytes;
    const char *text = scalar(json_object_get(d->options, "time-limit"), buffer);
    snprintf(cap, sizeof cap, "%.6gs", l->time_limit_s);
    if ((!text || (value_seconds(text, &seconds) && seconds > l->time_limit_s)) &&
        !set_text(d, "time-limit", cap))
        return false;
    text = scalar(json_object_get(d->options, "max-memory"), buffer);
    snprintf(cap, sizeof cap, "%llu", (unsigned long long)l->max_memory_bytes);
    if ((!text || (value_bytes(text, &bytes) && (bytes == 0 || bytes > l->max_memory_bytes))) &&
        !set_text(d, "max-memory", cap))
        return false;
    double number;
    text = scalar(json_object_get(d->options, "threads"), buffer);
    d->r->has_threads = text != NULL;
    snprintf(cap, sizeof cap, "%u", l->max_threads);
    if (text && value_number(text, &number) && number > l->max_threads && !set_text(d, "threads", cap))
        return false;
    text = scalar(json_object_get(d->options, "max-texture"), buffer);
    snprintf(cap, sizeof cap, "%u", l->max_texture_size);
    bool is_over = !text || (value_number(text, &number) && number > l->max_texture_size);
    return !l->max_texture_size || !is_over || set_text(d, "max-texture", cap);
}

/* ---- the output ---- */

/* Whether a render makes a sequence of images. */
static bool is_sequence(const reader *d)
{
    static const char *const words[] = {"turntable", "frames", "fps"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (json_object_get(d->params, words[i]))
            return true;
    return !json_object_get(d->params, "time") && json_object_get(d->params, "animation") &&
           strcmp(text_of(d, "animation", ""), "none") != 0;
}

/* The extension of files of a format. */
static const char *extension_of(const char *format)
{
    static const char *const pairs[][2] = {
        {"png16", "png"}, {"exr32", "exr"}, {"mtl", "obj"}, {"ogl1", "json"}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (strcmp(format, pairs[i][0]) == 0)
            return pairs[i][1];
    return format;
}

/* The name of what is made, with the stem of the input. */
static void name_output(const reader *d, char name[REQUEST_NAME_SIZE])
{
    const verb *v = verb_of(d);
    char stem[64] = "";
    const char *format = text_of(d, v == &convert_verb ? "to" : "format", NULL);
    const char *parts = "";
    bool has_stem = d->r->name[0] && output_name_stem(d->r->name, stem, sizeof stem) &&
                    folder_name_is_plain(stem) &&
                    !strpbrk(stem, ":#%{},"); /* words of an environment; placeholders */
    if (!has_stem)
        snprintf(stem, sizeof stem, "%s",
                 v == &convert_verb ? "model"
                 : v == &bake_verb  ? "environment"
                                    : "image");
    if (v == &bake_verb) {
        static const char *const images = " exr exr32 hdr pfm png ";
        char word[32];
        snprintf(word, sizeof word, " %.20s ", format ? format : "");
        bool is_image = format && strstr(images, word),
             is_dfg = json_is_true(json_object_get(d->params, "dfg"));
        if (!is_image && (!format || strcmp(format, "h") != 0))
            format = "ktx2";
        if (is_image && !is_dfg)
            parts = strcmp(text_of(d, "projection", ""), "faces") == 0 ? "_{level}_{face}" : "_{level}";
    } else if (v == &render_verb && is_sequence(d) &&
               (!format || (strcmp(format, "y4m") != 0 && strcmp(format, "raw") != 0))) {
        parts = "_####";
    }
    snprintf(name, REQUEST_NAME_SIZE, "%.40s%s.%.20s", stem, parts,
             format               ? extension_of(format)
             : v == &convert_verb ? "glb"
                                  : "png");
}

/* Whether the difference image of facet compare is wanted. */
static bool wants_difference(const reader *d)
{
    static const char *const words[] = {"heat-map", "sheet", "gain", "format"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (json_object_get(d->params, words[i]))
            return true;
    return false;
}

/* Names the output unless the request does: one file comes through the job's output, others through the folder. */
static bool add_output(reader *d)
{
    const verb *v = verb_of(d);
    char name[REQUEST_NAME_SIZE];
    if (json_object_get(d->params, "output") ||
        (!d->r->method->makes_file && !(v == &compare_verb && wants_difference(d))))
        return true;
    name_output(d, name);
    bool is_single = (v == &render_verb && !strstr(name, "####")) || v == &compare_verb;
    if (is_single) {
        memcpy(d->r->output, name, sizeof name);
        job_words_add(&d->r->words, "--output=" JOB_OUTPUT);
        if (!json_object_get(d->params, "format"))
            job_words_add(&d->r->words, "--format=png");
        return true;
    }
    if (!make_folder(d))
        return false;
    const char *file = json_object_get(d->params, "layout") ? "" : name;
    job_words_addf(&d->r->words, "--output=%s/out/%s", d->r->folder.path, file);
    return true;
}

/* ---- the whole ---- */

static bool read_request(reader *d)
{
    facet_error error;
    request *r = d->r;
    job_words_add(&r->words, verb_of(d)->name);
    if (!read_inputs(d) || !read_options(d) || !cap_limits(d) || !add_output(d))
        return false;
    if (job_options_add(&r->words, verb_of(d), d->options, NULL, verb_of(d)->name, &error) != FACET_OK ||
        job_words_check(&r->words, &error) != FACET_OK)
        return refuse(d, &error);
    return true;
}

bool request_create(request_limits *limits, const method *m, const json_t *params, request_body body,
                    request *out, answer *refusal)
{
    *out = (request){.method = m, .held_bytes = body.size};
    limits->last_request++;
    reader d = {limits, out,  params ? json_copy((json_t *)(uintptr_t)params) : json_object(),
                params, body, refusal};
    bool is_read = d.options ? read_request(&d) : refuse_memory(&d);
    json_decref(d.options);
    free(d.body.bytes);
    if (!is_read)
        request_destroy(out);
    return is_read;
}

void request_destroy(request *r)
{
    folder_remove(&r->folder);
    job_words_destroy(&r->words);
    free(r->input);
    *r = (request){0};
}
