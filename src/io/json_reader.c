/* json_reader.c - parses JSON text, also in other encodings than UTF-8, and gives typed access to its
 * members; see json_reader.h. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/result.h"
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

/* The code unit of an escape "\uXXXX" at the string; -1: there is none. */
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

/* Copies an escape. An unpaired surrogate becomes U+FFFD; a backslash that begins no escape is escaped.
 * Returns the number of bytes read; *mends counts changes. */
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

/* Converts text of another encoding, taken as Latin-1, to valid JSON. has_pairs: GBK or Shift-JIS, where
 * the second byte of a character may be a backslash. out has 2 * size bytes. Returns the length; *mends
 * counts changes. */
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

/* Parses mended text; NULL: nothing needed mending (*error is unchanged), the result is not JSON either, or
 * (recorded) no memory. */
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
    if (!json &&
        json_error_code(&error) == json_error_numeric_overflow) { /* for example a 64-bit id in extras */
        json = json_loadb(text, size, JSON_ALLOW_NUL | JSON_DECODE_INT_AS_REAL, &error);
        if (json)
            io_note(r, NULL, NULL, "has integers beyond 2^63; they are rounded");
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

/* ---- memory and work ---- */

enum { LIMIT_ELEMENTS = 1 << 28 };

void *io_alloc_raw(io_reader *r, const char *what, size_t count, size_t size)
{
    if (!io_is_ok(r))
        return NULL;
    void *memory = arena_alloc(r->scene->arena, count, size);
    if (!memory)
        io_fail_memory(r, what, count > SIZE_MAX / size ? SIZE_MAX : count * size);
    return memory;
}

void *io_alloc(io_reader *r, const char *what, size_t count, size_t size)
{
    void *memory = io_alloc_raw(r, what, count, size);
    if (memory)
        memset(memory, 0, count * size);
    return memory;
}

bool io_load_uri(io_reader *r, const char *uri, uri_bytes *out)
{
    const file_scope scope = {.scene = r->scene,
                              .allocator = r->allocator,
                              .files = r->files,
                              .folder = r->folder,
                              .root = r->root,
                              .log = r->log,
                              .max_file_bytes = r->max_file_bytes};
    return uri_load(&scope, uri, out);
}

bool io_spend(io_reader *r, const json_place *at, uint64_t elements)
{
    r->work += elements;
    if (r->work <= LIMIT_ELEMENTS)
        return io_is_ok(r);
    return io_fail(r, at, NULL, FACET_ERROR_LIMIT,
                   "the model refers to more than %d elements of vertices and indices", (int)LIMIT_ELEMENTS);
}

/* ---- members ---- */

static const char *type_name(const json_t *value)
{
    return json_is_object(value)    ? "an object"
           : json_is_array(value)   ? "an array"
           : json_is_string(value)  ? "a string"
           : json_is_number(value)  ? "a number"
           : json_is_boolean(value) ? "a boolean"
                                    : "null";
}

static json_place get_member(const json_place *object, const char *key)
{
    return (json_place){.parent = object,
                        .key = key,
                        .value = json_is_object(object->value) ? json_object_get(object->value, key) : NULL};
}

bool io_fail_type(io_reader *r, const json_place *at, const char *wanted)
{
    return io_fail(r, at, NULL, FACET_ERROR_INVALID, "must be %s, but is %s", wanted, type_name(at->value));
}

bool io_has_member(const json_place *object, const char *key)
{
    return get_member(object, key).value != NULL;
}

json_place io_as_object(io_reader *r, json_place at)
{
    if (at.value && !json_is_object(at.value)) {
        io_fail_type(r, &at, "an object");
        at.value = NULL;
    }
    return at;
}

json_place io_get_object(io_reader *r, const json_place *object, const char *key)
{
    return io_as_object(r, get_member(object, key));
}

json_place io_get_array(io_reader *r, const json_place *object, const char *key)
{
    json_place at = get_member(object, key);
    if (at.value && !json_is_array(at.value)) {
        io_fail_type(r, &at, "an array");
        at.value = NULL;
    } else if (at.value && json_array_size(at.value) == 0) {
        io_note(r, &at, NULL, "is empty, which glTF does not allow");
    } else if (at.value && json_array_size(at.value) >= SCENE_NONE) {
        io_fail(r, &at, NULL, FACET_ERROR_LIMIT, "has more than 2^32 - 2 elements");
        at.value = NULL;
    }
    return at;
}

size_t io_get_count(const json_place *array)
{
    return array->value ? json_array_size(array->value) : 0;
}

json_place io_get_element(const json_place *array, size_t index)
{
    return (json_place){.parent = array, .index = index, .value = json_array_get(array->value, index)};
}

json_place io_get_element_object(io_reader *r, const json_place *array, size_t index)
{
    return io_as_object(r, io_get_element(array, index));
}

json_place io_get_extension(io_reader *r, const json_place *object, const char *name)
{
    /* The chain must outlive this call, so that "extensions" and the name are one link in messages. A
     * value that is not an object extends nothing; gltf_extensions.c reports it. */
    json_place extensions = get_member(object, "extensions");
    json_place at = get_member(&extensions, name);
    at.parent = object;
    (void)r;
    if (at.value && !json_is_object(at.value))
        at.value = NULL;
    return at;
}

/* ---- numbers ---- */

/* A whole number in [0, maximum]. */
static bool to_uint(const json_t *value, uint64_t maximum, uint64_t *out)
{
    if (json_is_integer(value)) {
        json_int_t number = json_integer_value(value);
        if (number < 0 || (uint64_t)number > maximum)
            return false;
        *out = (uint64_t)number;
        return true;
    }
    if (!json_is_real(value))
        return false;
    double number = json_real_value(value);
    if (!(number >= 0.0 && number <= 9007199254740992.0 && number == floor(number)) ||
        (uint64_t)number > maximum)
        return false;
    *out = (uint64_t)number;
    return true;
}

uint64_t io_get_uint(io_reader *r, const json_place *object, const char *key, uint64_t maximum,
                     uint64_t fallback)
{
    json_place at = get_member(object, key);
    uint64_t out = 0;
    if (!at.value && fallback != IO_REQUIRED_UINT)
        return fallback;
    if (!at.value)
        io_fail(r, object, key, FACET_ERROR_INVALID, "is missing");
    else if (!json_is_number(at.value))
        io_fail_type(r, &at, "a number");
    else if (!to_uint(at.value, maximum, &out))
        io_fail(r, &at, NULL, FACET_ERROR_INVALID, "%.17g is not a whole number from 0 to %llu",
                json_number_value(at.value), (unsigned long long)maximum);
    else
        return out;
    return fallback == IO_REQUIRED_UINT ? 0 : fallback;
}

uint32_t io_get_index_value(io_reader *r, const json_place *at, uint32_t count, const char *what)
{
    uint64_t index;
    if (!json_is_number(at->value))
        io_fail_type(r, at, "a number");
    else if (!to_uint(at->value, SCENE_NONE - 1, &index) || index >= count)
        io_fail(r, at, NULL, FACET_ERROR_INVALID, "%s %.17g does not exist (there %s %u)", what,
                json_number_value(at->value), count == 1 ? "is" : "are", count);
    else
        return (uint32_t)index;
    return SCENE_NONE;
}

uint32_t io_get_index(io_reader *r, const json_place *object, const char *key, uint32_t count,
                      const char *what)
{
    json_place at = get_member(object, key);
    return at.value ? io_get_index_value(r, &at, count, what) : SCENE_NONE;
}

uint32_t io_get_required_index(io_reader *r, const json_place *object, const char *key, uint32_t count,
                               const char *what)
{
    if (object->value && !io_has_member(object, key))
        io_fail(r, object, key, FACET_ERROR_INVALID, "is missing");
    return io_get_index(r, object, key, count, what);
}

uint32_t io_peek_index(const json_place *object, const char *key, uint32_t count)
{
    const json_t *value = json_object_get(object->value, key);
    uint64_t index;
    return value && to_uint(value, SCENE_NONE - 1, &index) && index < count ? (uint32_t)index : SCENE_NONE;
}

/* False: an error is recorded. Doubles beyond the range of float become the largest float. */
static bool to_float(io_reader *r, const json_place *at, float *out)
{
    if (!json_is_number(at->value)) {
        io_fail_type(r, at, "a number");
        return false;
    }
    double number = json_number_value(at->value);
    *out = number > (double)FLT_MAX ? FLT_MAX : number < -(double)FLT_MAX ? -FLT_MAX : (float)number;
    return true;
}

float io_get_float(io_reader *r, const json_place *object, const char *key, float fallback)
{
    json_place at = get_member(object, key);
    float out = fallback;
    if (at.value)
        to_float(r, &at, &out);
    return out;
}

static float clamp_with_warning(io_reader *r, const json_place *at, float value, float minimum, float maximum)
{
    if (value >= minimum && value <= maximum)
        return value;
    float clamped = value < minimum ? minimum : maximum;
    io_warn(r, at, NULL, "%g is out of range; %g is used", (double)value, (double)clamped);
    return clamped;
}

float io_get_float_in(io_reader *r, const json_place *object, const char *key, float minimum, float maximum,
                      float fallback)
{
    json_place at = get_member(object, key);
    float out = fallback;
    if (!at.value || !to_float(r, &at, &out))
        return fallback;
    return clamp_with_warning(r, &at, out, minimum, maximum);
}

bool io_get_floats_value(io_reader *r, const json_place *at, float *out, size_t count)
{
    if (!json_is_array(at->value)) {
        io_fail_type(r, at, "an array");
        return false;
    }
    if (io_get_count(at) != count)
        return io_fail(r, at, NULL, FACET_ERROR_INVALID, "must have %zu numbers, but has %zu", count,
                       io_get_count(at));
    for (size_t i = 0; i < count; i++) {
        json_place element = io_get_element(at, i);
        if (!to_float(r, &element, &out[i]))
            return false;
    }
    return true;
}

bool io_get_doubles(io_reader *r, const json_place *object, const char *key, double *out, size_t count)
{
    float rounded[16];
    if (!io_get_floats(r, object, key, rounded, count))
        return false;
    json_place at = get_member(object, key);
    for (size_t i = 0; i < count; i++)
        out[i] =
            fabsf(rounded[i]) < FLT_MAX ? json_number_value(json_array_get(at.value, i)) : (double)rounded[i];
    return true;
}

bool io_get_floats(io_reader *r, const json_place *object, const char *key, float *out, size_t count)
{
    json_place at = io_get_array(r, object, key);
    return at.value && io_get_floats_value(r, &at, out, count);
}

void io_get_floats_in(io_reader *r, const json_place *object, const char *key, float minimum, float maximum,
                      float *out, size_t count)
{
    if (!io_get_floats(r, object, key, out, count))
        return;
    json_place at = get_member(object, key);
    for (size_t i = 0; i < count; i++) {
        json_place element = io_get_element(&at, i);
        out[i] = clamp_with_warning(r, &element, out[i], minimum, maximum);
    }
}

/* ---- others ---- */

bool io_get_bool(io_reader *r, const json_place *object, const char *key, bool fallback)
{
    json_place at = get_member(object, key);
    if (!at.value)
        return fallback;
    if (!json_is_boolean(at.value)) {
        io_fail_type(r, &at, "a boolean");
        return fallback;
    }
    return json_is_true(at.value);
}

const char *io_get_string(io_reader *r, const json_place *object, const char *key, const char *fallback)
{
    json_place at = get_member(object, key);
    if (!at.value)
        return fallback;
    if (!json_is_string(at.value)) {
        io_fail_type(r, &at, "a string");
        return fallback;
    }
    const char *string = json_string_value(at.value);
    if (strlen(string) != json_string_length(at.value)) {
        io_fail(r, &at, NULL, FACET_ERROR_INVALID, "contains a NUL character");
        return fallback;
    }
    return string;
}

const char *io_get_name(io_reader *r, const json_place *object)
{
    json_place at = get_member(object, "name");
    if (!at.value)
        return "";
    if (!json_is_string(at.value)) {
        io_note(r, &at, NULL, "must be a string, but is %s", type_name(at.value));
        return "";
    }
    char *copy = arena_strdup(r->scene->arena, json_string_value(at.value));
    if (!copy)
        io_fail_memory(r, "name", json_string_length(at.value));
    return copy ? copy : "";
}
