/* json_text.c - JSON text as a tree, also where exporters wrote it in another encoding than UTF-8; see json_reader.h. */
#include <string.h>

#include "base/utf8.h"
#include "io/json_reader.h"

size_t io_json_memory_estimate(const char *text, size_t size)
{
    size_t memory = size;
    for (size_t i = 0; i < size; i++)
        memory += text[i] == '{' ? 300 : text[i] == '[' ? 160 : text[i] == ':' ? 96 : text[i] == ',' ? 48 : 0;
    return memory;
}

/* ---- text that is no UTF-8 ---- */

/* The code unit of an escape "\uXXXX" at text; -1: none is there. */
static long escaped_unit(const char *text, size_t size)
{
    long unit = 0;
    if (size < 6 || text[0] != '\\' || text[1] != 'u')
        return -1;
    for (int i = 2; i < 6; i++) {
        const char *digits = "0123456789abcdef0123456789ABCDEF";
        const char *at = text[i] ? strchr(digits, text[i]) : NULL;
        if (!at)
            return -1;
        unit = unit * 16 + (at - digits) % 16;
    }
    return unit;
}

static bool is_surrogate(long unit, long first)
{
    return unit >= first && unit < first + 0x400;
}

/* Copies an escape. Half of a surrogate pair becomes U+FFFD; a backslash that escapes nothing stands for itself. Returns
 * how many bytes of text it took; *mends counts. */
static size_t mend_escape(const char *text, size_t size, char *out, size_t *used, size_t *mends)
{
    long unit = escaped_unit(text, size);
    bool is_pair = is_surrogate(unit, 0xd800) && is_surrogate(escaped_unit(text + 6, size - 6), 0xdc00);
    size_t length = is_pair ? 12 : unit >= 0 ? 6 : 2;
    if (unit < 0 && (size < 2 || !text[1] || !strchr("\"\\/bfnrtu", text[1]))) {
        memcpy(out + *used, "\\\\", 2);
        *used += 2;
        ++*mends;
        return 1;
    }
    bool is_half = !is_pair && (is_surrogate(unit, 0xd800) || is_surrogate(unit, 0xdc00));
    memcpy(out + *used, is_half ? "\\ufffd" : text, length);
    *used += length;
    *mends += is_half;
    return length;
}

/* Makes JSON text of bytes of another encoding, taken for Latin-1. has_pairs: of GBK or Shift-JIS, where the second byte
 * of a character may be a backslash. out has 2 * size bytes. Returns the length; *mends: how often it was not a copy. */
static size_t mend(const char *text, size_t size, bool has_pairs, char *out, size_t *mends)
{
    size_t used = 0;
    *mends = 0;
    for (size_t i = 0; i < size;) {
        size_t length = utf8_length(text + i, size - i);
        if (text[i] == '\\') {
            i += mend_escape(text + i, size - i, out, &used, mends);
        } else if (length) {
            memcpy(out + used, text + i, length);
            used += length;
            i += length;
        } else {
            used += utf8_from_latin1(text + i++, 1, out + used);
            ++*mends;
            if (has_pairs && i < size && text[i] == '\\') {
                memcpy(out + used, "\\\\", 2);
                used += 2;
                i++;
            } else if (has_pairs && i < size && (text[i] & 0x80)) {
                used += utf8_from_latin1(text + i++, 1, out + used);
            }
        }
    }
    return used;
}

/* Parses mended text; NULL: there was nothing to mend (*error stays), it is still no JSON, or (recorded) no memory. */
static json_t *parse_mended(io_reader *r, const char *text, size_t size, bool has_pairs, json_error_t *error)
{
    size_t mends;
    json_t *json = NULL;
    char *mended = mem_alloc(r->allocator, size, 2);
    if (!mended) {
        io_fail_memory(r, "JSON", 2 * size);
        return NULL;
    }
    size_t length = mend(text, size, has_pairs, mended, &mends);
    if (mends)
        json = json_loadb(mended, length, JSON_ALLOW_NUL, error);
    if (json)
        io_warn(r, NULL, NULL, "has text that is not UTF-8; its bytes are taken as Latin-1");
    mem_free(mended);
    return json;
}

json_t *io_parse_json(io_reader *r, const char *text, size_t size)
{
    json_error_t error;
    json_error_t second;
    json_t *json = json_loadb(text, size, JSON_ALLOW_NUL, &error);
    if (!json && json_error_code(&error) == json_error_numeric_overflow) { /* an id of 64 bits in extras */
        json = json_loadb(text, size, JSON_ALLOW_NUL | JSON_DECODE_INT_AS_REAL, &error);
        if (json)
            io_note(r, NULL, NULL, "has whole numbers beyond 2^63; they are rounded");
    }
    if (!json && json_error_code(&error) != json_error_out_of_memory) {
        json = parse_mended(r, text, size, false, &error);
        if (!json && io_is_ok(r))
            json = parse_mended(r, text, size, true, &second);
    }
    if (!json && json_error_code(&error) == json_error_out_of_memory)
        io_fail_memory(r, "JSON", size);
    else if (!json)
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "is not valid JSON: line %d, column %d: %s", error.line,
                error.column, error.text);
    return json;
}
