/* page.c - see page.h. A page is HTML with the view as JSON; a page of one file also has the bytes of its files, each
 * compressed by gzip, as base64. */
#include "cli/view/page.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/result.h"
#include "cli/shared/failure.h"
#include "cli/shared/value.h"

#include <jansson.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct filling {
    const page *p;
    text *out;
    uint32_t nonce[4];
    const char *decoders[8]; /* in the page */
    size_t decoder_count;
    facet_result result;
    facet_error *error;
} filling;

/* ---- text ---- */

/* A folder and a relative name as a URL. */
static json_t *url_json(const char *folder, const char *name)
{
    text url = {0};
    text_add_url(&url, folder);
    text_add_url(&url, name);
    json_t *json = url.has_failed ? NULL : json_string(url.data ? url.data : "");
    text_destroy(&url);
    return json;
}

/* ---- the view ---- */

/* Whether an option is about the image: all others concern the command, reading (page_reads_otherwise()), or the CPU. */
static bool is_of_view(option_id id)
{
    return option_is_among(id, OPTION_IDS(VIEW_OPTIONS, OPT_SUN, OPT_SPECULAR_AA, OPT_SHADING,
                                          OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG));
}

bool page_reads_otherwise(const command_line *c)
{
    static const option_id ids[] = {OPT_PARAMETERS, OPT_METHOD,      OPT_PROFILE,        OPT_FIT_TARGET,
                                    OPT_MTL_COLORS, OPT_DIALECT,     OPT_ILLUM,          OPT_AMBIENT,
                                    OPT_KEEP_HUE,   OPT_GLASS,       OPT_MIRRORS,        OPT_NORMALS,
                                    OPT_REFIT,      OPT_LIGHT_SCALE, OPT_BAKE_OCCLUSION, OPT_FLIP_TEXTURES};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        if (is_given(c, ids[i]))
            return true;
    return false;
}

/* The value of --env for the page, in which files have other names. */
static json_t *environment_json(const page *p, const char *value)
{
    environment_input input;
    facet_error ignored;
    char path[ENVIRONMENT_PATH_SIZE];
    const unsigned takes = ENVIRONMENT_TAKES_NONE | ENVIRONMENT_TAKES_STDIN;
    if (environment_input_parse("--env", value, takes, &input, &ignored) != FACET_OK ||
        !environment_input_get_file(&input, 0, path))
        return report_string_json(value);
    text names = {0};
    if (input.kind == ENVIRONMENT_FACES)
        text_add(&names, "faces:");
    for (int i = 0; environment_input_get_file(&input, i, path); i++) {
        const char *name = page_files_name(&p->files, path);
        text_addf(&names, "%s%s", i ? "," : "", name ? name : "");
    }
    json_t *json = report_string_json(names.data);
    text_destroy(&names);
    return json;
}

static json_t *option_json(const page *p, const option *o)
{
    const char *value = option_text(p->line, o->id, "");
    if (!option_takes_value(o))
        return json_true();
    return o->id == OPT_ENV ? environment_json(p, value) : report_string_json(value);
}

static json_t *options_json(const page *p)
{
    json_t *json = json_object();
    const option *o;
    for (size_t i = 0; (o = option_at(p->line->verb, i)); i++) {
        option_source source = p->line->values[o->id].source;
        if (source != SOURCE_NONE && source != SOURCE_PRESET && is_of_view(o->id))
            json_object_set_new(json, o->name, option_json(p, o));
    }
    return json;
}

static json_t *files_json(const page *p)
{
    json_t *json = json_array();
    for (size_t i = 0; i < p->files.count; i++) {
        const page_file *file = &p->files.items[i];
        json_t *entry = json_pack("{s:o}", "path", report_string_json(file->name));
        if (p->model_url)
            json_object_set_new(entry, "url",
                                url_json(file->is_light ? p->light_url : p->model_url, file->name));
        json_array_append_new(json, entry);
    }
    return json;
}

/* JSON inside a script element: no tag begins in it. */
static void add_json(filling *f, const json_t *json)
{
    char *dump = json ? json_dumps(json, JSON_ENSURE_ASCII) : NULL;
    if (!dump)
        f->result = fail(f->error, FACET_ERROR_MEMORY, "out of memory: the view");
    for (const char *s = dump; s && *s; s++)
        if (*s == '<')
            text_add(f->out, "\\u003c");
        else
            text_add_bytes(f->out, s, 1);
    free(dump);
}

static void add_view(filling *f)
{
    const page *p = f->p;
    json_t *json = json_pack("{s:o, s:o, s:o, s:o, s:b}", "title", report_string_json(p->title), "model",
                             report_string_json(p->files.model), "files", files_json(p), "options",
                             options_json(p), "controls", (int)is_given(p->line, OPT_CONTROLS));
    add_json(f, json);
    json_decref(json);
}

/* ---- bytes ---- */

/* Appends bytes as base64 of gzip (RFC 1952), the same for the same bytes. */
static facet_result add_packed(text *out, const unsigned char *bytes, size_t size, const char *name,
                               facet_error *error)
{
    z_stream stream = {0};
    if (size > UINT_MAX / 2)
        return fail(error, FACET_ERROR_LIMIT,
                    "%s: %zu bytes are too many for a page of one file; --html DIR/ "
                    "writes them beside it",
                    name, size);
    if (deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return fail_memory(error, name, size);
    size_t bound = deflateBound(&stream, (uLong)size);
    unsigned char *packed = mem_alloc(&out->allocator, bound, 1);
    if (packed) {
        stream.next_in = (unsigned char *)bytes;
        stream.avail_in = (uInt)size;
        stream.next_out = packed;
        stream.avail_out = (uInt)bound;
        deflate(&stream, Z_FINISH);
        text_add_base64(out, packed, stream.total_out);
    }
    deflateEnd(&stream);
    mem_free(packed);
    return packed ? FACET_OK : fail_memory(error, name, bound);
}

static void add_file(filling *f, const page_file *file)
{
    file_bytes bytes = {0};
    f->result = file_open(file->path, 0, &f->out->allocator, &bytes, f->error);
    if (f->result != FACET_OK)
        return;
    text_add(f->out, "<script type=\"application/octet-stream;base64\" data-path=\"");
    text_add_html(f->out, file->name);
    text_add(f->out, "\">");
    f->result = add_packed(f->out, bytes.data, bytes.size, file->path, f->error);
    text_add(f->out, "</script>\n");
    file_close(&bytes);
}

static void add_files(filling *f)
{
    for (size_t i = 0; !f->p->model_url && i < f->p->files.count && f->result == FACET_OK; i++)
        add_file(f, &f->p->files.items[i]);
}

/* A decoder of the viewer, unless the page has it. The browser itself decodes AVIF. */
static void add_decoder(filling *f, const char *name)
{
    char file[64];
    file_bytes bytes = {0};
    for (size_t i = 0; i < f->decoder_count; i++)
        if (strcmp(f->decoders[i], name) == 0)
            return;
    f->decoders[f->decoder_count++] = name;
    if (f->result != FACET_OK || strcmp(name, "avif") == 0)
        return;
    snprintf(file, sizeof file, "facet-viewer/codec_%s.wasm", name);
    f->result = viewer_package_open(f->p->package, file, &f->out->allocator, &bytes, f->error);
    if (f->result != FACET_OK)
        return;
    text_addf(f->out, "<script type=\"application/octet-stream;base64\" data-module=\"codec_%s.wasm\">",
              name);
    f->result = add_packed(f->out, bytes.data, bytes.size, file, f->error);
    text_add(f->out, "</script>\n");
    file_close(&bytes);
}

static void add_decoders(filling *f)
{
    const page *p = f->p;
    const char *name;
    for (uint32_t i = 0; (name = facet_scene_get_decoder(p->scene, i)); i++)
        add_decoder(f, name);
    for (size_t i = 0; i < p->files.count && f->result == FACET_OK; i++) {
        file_bytes bytes = {0};
        if (!p->files.items[i].is_light)
            continue;
        f->result = file_open(p->files.items[i].path, 0, &f->out->allocator, &bytes, f->error);
        name = f->result == FACET_OK ? facet_image_find_decoder(bytes.data, bytes.size) : NULL;
        if (name)
            add_decoder(f, name);
        file_close(&bytes);
    }
}

static void add_preview(filling *f)
{
    if (f->p->preview_url) {
        text_add_url(f->out, f->p->preview_url);
        return;
    }
    text_add(f->out, "data:image/png;base64,");
    text_add_base64(f->out, f->p->preview, f->p->preview_size);
}

/* ---- the template ---- */

static void add_title(filling *f)
{
    text_add_html(f->out, f->p->title);
}

static void add_version(filling *f)
{
    text_add_html(f->out, facet_version());
}

static void add_links(filling *f)
{
    text_add(f->out, f->p->links ? f->p->links : "");
}

/* The nonce of the page's own script and style, by its content: nothing else in it may run. */
static void add_nonce(filling *f)
{
    text_addf(f->out, "%08x%08x%08x%08x", f->nonce[0], f->nonce[1], f->nonce[2], f->nonce[3]);
}

static const struct {
    const char *mark;
    void (*add)(filling *f);
} parts[] = {{"{{title}}", add_title}, {"{{decoders}}", add_decoders}, {"{{version}}", add_version},
             {"{{nonce}}", add_nonce}, {"{{preview}}", add_preview},   {"{{links}}", add_links},
             {"{{files}}", add_files}, {"{{view}}", add_view}};
enum { PART_COUNT = sizeof parts / sizeof *parts };

/* The part whose mark is at that place; PART_COUNT: none. */
static size_t find_part(const char *at, size_t size)
{
    size_t i = 0;
    while (i < PART_COUNT &&
           (size < strlen(parts[i].mark) || memcmp(at, parts[i].mark, strlen(parts[i].mark)) != 0))
        i++;
    return i;
}

facet_result page_fill(const page *p, const char *template, size_t size, text *out, facet_error *error)
{
    filling f = {.p = p, .out = out, .error = error};
    for (uint32_t i = 0; i < 4; i++)
        f.nonce[i] = murmur3(template, size, i) ^ murmur3(p->preview, p->preview_size, i);
    const char *end = template + size;
    while (template <end &&f.result == FACET_OK) {
        const char *brace = memchr(template, '{', (size_t)(end - template));
        size_t part = brace ? find_part(brace, (size_t)(end - brace)) : PART_COUNT;
        const char *next = part < PART_COUNT ? brace : brace ? brace + 1 : end;
        text_add_bytes(out, template, (size_t)(next - template));
        template = next;
        if (part == PART_COUNT)
            continue;
        parts[part].add(&f);
        template += strlen(parts[part].mark);
    }
    if (f.result == FACET_OK && out->has_failed)
        f.result = fail_memory(error, "page", out->length);
    return f.result;
}
