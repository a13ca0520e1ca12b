/* answer.c - see answer.h. */
#include "cli/serve/answer.h"

#include "cli/serve/rpc.h"
#include "cli/shared/failure.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Codes below -32000 are free for servers; those of facet are -32000 minus the exit code where there is one. 499 is what
 * nginx logs for a client that has gone. */
const answer_code answer_codes[ANSWER_KIND_COUNT] = {
    [ANSWER_DONE] = {EXIT_DONE, 0, 200, "done"},
    [ANSWER_USAGE] = {EXIT_USAGE, RPC_INVALID_PARAMS, 400, "usage"},
    [ANSWER_NO_METHOD] = {EXIT_USAGE, RPC_NO_METHOD, 404, "unknown"},
    [ANSWER_WRONG_VERB] = {EXIT_USAGE, RPC_INVALID_REQUEST, 405, "method"},
    [ANSWER_FORBIDDEN] = {EXIT_READ, -32002, 403, "forbidden"},
    [ANSWER_MISSING] = {EXIT_READ, -32003, 404, "missing"},
    [ANSWER_INVALID] = {EXIT_INVALID, -32004, 422, "invalid"},
    [ANSWER_UNSUPPORTED] = {EXIT_UNSUPPORTED, -32005, 415, "unsupported"},
    [ANSWER_UNWRITABLE] = {EXIT_WRITE, -32006, 500, "write"},
    [ANSWER_TOO_LARGE] = {EXIT_LIMIT, -32007, 413, "limit"},
    [ANSWER_TIMED_OUT] = {EXIT_LIMIT, -32001, 504, "time"},
    [ANSWER_ENVIRONMENT] = {EXIT_ENVIRONMENT, -32008, 501, "environment"},
    [ANSWER_BUG] = {EXIT_BUG, -32070, 500, "bug"},
    [ANSWER_BUSY] = {EXIT_AGAIN, -32075, 429, "busy"},
    [ANSWER_STOPPING] = {EXIT_AGAIN, -32076, 503, "stopping"},
    [ANSWER_CANCELLED] = {EXIT_AGAIN, -32077, 499, "cancelled"},
};

answer_kind answer_kind_of(int exit_code, bool timed_out)
{
    switch (exit_code) {
    case EXIT_DONE:
    case EXIT_NEGATIVE:
        return ANSWER_DONE;
    case EXIT_USAGE:
        return ANSWER_USAGE;
    case EXIT_READ:
        return ANSWER_MISSING;
    case EXIT_INVALID:
        return ANSWER_INVALID;
    case EXIT_UNSUPPORTED:
        return ANSWER_UNSUPPORTED;
    case EXIT_WRITE:
        return ANSWER_UNWRITABLE;
    case EXIT_LIMIT:
        return timed_out ? ANSWER_TIMED_OUT : ANSWER_TOO_LARGE;
    case EXIT_ENVIRONMENT:
        return ANSWER_ENVIRONMENT;
    case EXIT_AGAIN:
        return ANSWER_CANCELLED;
    default:
        return ANSWER_BUG;
    }
}

bool answer_fail(answer *out, answer_kind kind, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    out->kind = kind;
    out->exit_code = answer_codes[kind].exit_code;
    vsnprintf(out->message, sizeof out->message, format, arguments);
    va_end(arguments);
    return false;
}

void answer_destroy(answer *out)
{
    for (size_t i = 0; i < out->file_count; i++) {
        free(out->files[i].name);
        free(out->files[i].bytes);
    }
    free(out->files);
    json_decref(out->report);
    *out = (answer){0};
}

const char *media_type_of(const char *name)
{
    static const struct {
        const char *extension, *type;
    } types[] = {
        {"png", "image/png"},
        {"jpg", "image/jpeg"},
        {"jpeg", "image/jpeg"},
        {"webp", "image/webp"},
        {"exr", "image/x-exr"},
        {"hdr", "image/vnd.radiance"},
        {"pfm", "image/x-portable-floatmap"},
        {"ktx2", "image/ktx2"},
        {"glb", "model/gltf-binary"},
        {"gltf", "model/gltf+json"},
        {"obj", "model/obj"},
        {"mtl", "model/mtl"},
        {"json", "application/json"},
        {"html", "text/html"},
        {"y4m", "video/x-yuv4mpeg"},
        {"h", "text/plain"},
        {"txt", "text/plain"},
    };
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof types / sizeof *types; i++)
        if (strcasecmp(dot + 1, types[i].extension) == 0)
            return types[i].type;
    return "application/octet-stream";
}
