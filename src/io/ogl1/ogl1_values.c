/* ogl1_values.c - values as R's toJSON() writes them: scalars also as arrays of one, NULL as {}, colors in
 * R's notations; see ogl1_reader.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/ogl1/ogl1_json.h"
#include "io/ogl1/ogl1_reader.h"

enum { MAX_DEPTH = 8 }; /* arrays around a value; R makes one or two */

static bool is_absent(const json_t *value)
{
    return !value || json_is_null(value) || (json_is_object(value) && json_object_size(value) == 0) ||
           (json_is_array(value) && json_array_size(value) == 0) ||
           (json_is_string(value) && strcmp(json_string_value(value), "NA") == 0);
}

json_place ogl1_member(const json_place *object, const char *key)
{
    json_place at = {.parent = object, .key = key};
    at.value = json_is_object(object->value) ? json_object_get(object->value, key) : NULL;
    for (int i = 0; i < MAX_DEPTH && json_is_array(at.value) && json_array_size(at.value) == 1; i++)
        at.value = json_array_get(at.value, 0);
    if (is_absent(at.value))
        at.value = NULL;
    return at;
}

/* The first value of a vector, with a warning if others differ. */
static json_place first_of(io_reader *r, const json_place *object, const char *key)
{
    json_place at = ogl1_member(object, key);
    if (!json_is_array(at.value))
        return at;
    const json_t *first = json_array_get(at.value, 0);
    bool is_same = true;
    for (size_t i = 1; i < json_array_size(at.value) && is_same; i++)
        is_same = json_equal(first, json_array_get(at.value, i));
    if (!is_same)
        io_warn(r, &at, NULL, "has %zu values; the first is used", json_array_size(at.value));
    at.value = first;
    return at;
}

json_place ogl1_object(io_reader *r, const json_place *object, const char *key)
{
    return io_as_object(r, ogl1_member(object, key));
}

bool ogl1_number(io_reader *r, const json_place *object, const char *key, double *out)
{
    json_place at = first_of(r, object, key);
    if (!at.value)
        return false;
    if (!json_is_number(at.value))
        return io_fail_type(r, &at, "a number");
    *out = json_number_value(at.value) + 0.0; /* no -0, which JSON integers cannot represent */
    return true;
}

bool ogl1_number_in(io_reader *r, const json_place *object, const char *key, double minimum, double maximum,
                    float *out)
{
    double number = 0.0;
    if (!ogl1_number(r, object, key, &number))
        return false;
    double clamped = fmin(fmax(number, minimum), maximum);
    if (clamped != number)
        io_warn(r, object, key, "%g is out of range; %g is used", number, clamped);
    *out = (float)clamped;
    return true;
}

bool ogl1_bool(io_reader *r, const json_place *object, const char *key, bool *out)
{
    json_place at = first_of(r, object, key);
    if (!at.value)
        return false;
    if (json_is_boolean(at.value))
        *out = json_is_true(at.value);
    else if (json_is_integer(at.value) && (json_integer_value(at.value) | 1) == 1)
        *out = json_integer_value(at.value) == 1;
    else
        return io_fail_type(r, &at, "a boolean");
    return true;
}

bool ogl1_string(io_reader *r, const json_place *object, const char *key, const char **out)
{
    json_place at = first_of(r, object, key);
    return at.value && ogl1_string_value(r, &at, out);
}

bool ogl1_string_value(io_reader *r, const json_place *at, const char **out)
{
    if (!json_is_string(at->value))
        return io_fail_type(r, at, "a string");
    if (strlen(json_string_value(at->value)) != json_string_length(at->value))
        return io_fail(r, at, NULL, FACET_ERROR_INVALID, "contains a NUL character");
    *out = json_string_value(at->value);
    return true;
}

bool ogl1_choice(io_reader *r, const json_place *object, const char *key, const char *const *names, int *out)
{
    const char *value = NULL;
    char all[256] = "";
    if (!ogl1_string(r, object, key, &value))
        return false;
    for (int i = 0; names[i]; i++) {
        if (strcmp(value, names[i]) == 0) {
            *out = i;
            return true;
        }
        size_t length = strlen(all);
        snprintf(all + length, sizeof all - length, "%s%s", i ? ", " : "", names[i]);
    }
    return io_fail(r, object, key, FACET_ERROR_INVALID, "\"%.40s\" is not one of %s", value, all);
}

bool ogl1_vector(io_reader *r, const json_place *object, const char *key, float out[3])
{
    json_place at = ogl1_member(object, key);
    if (!at.value)
        return false;
    if (!json_is_array(at.value) || json_array_size(at.value) != 3)
        return io_fail_type(r, &at, "three numbers");
    for (size_t i = 0; i < 3; i++) {
        json_place element = io_get_element(&at, i);
        double number = json_number_value(element.value);
        if (!json_is_number(element.value))
            return io_fail_type(r, &element, "a number");
        if (!(fabs(number) <= (double)SCENE_FARTHEST))
            return io_fail(r, &element, NULL, FACET_ERROR_INVALID, "%g is too far out", number);
        out[i] = (float)number + 0.0f; /* no -0, as above */
    }
    return true;
}

/* ---- colors ---- */

static bool color_of_numbers(io_reader *r, const json_place *at, float rgba[4])
{
    size_t count = json_array_size(at->value);
    if (count != 3 && count != 4)
        return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                       "has %zu numbers; a color has red, green, blue and perhaps alpha, from 0 to 1", count);
    rgba[3] = 1.0f;
    for (size_t i = 0; i < count; i++) {
        json_place element = io_get_element(at, i);
        double number = json_number_value(element.value);
        if (!json_is_number(element.value))
            return io_fail_type(r, &element, "a number");
        if (!(number >= 0.0 && number <= (double)LEGACY_LARGEST))
            return io_fail(r, &element, NULL, FACET_ERROR_INVALID,
                           "%g is not a component of a color, which is from 0 to 1", number);
        if (number > 1.0)
            io_warn(r, at, NULL,
                    "has numbers above 1, brighter than OpenGL shows; divide by 255 what col2rgb() "
                    "gives");
        rgba[i] = (float)(i == 3 && number > 1.0 ? 1.0 : number);
    }
    return true;
}

bool ogl1_color_value(io_reader *r, const json_place *at, float rgba[4])
{
    char number[24];
    const char *name = number;
    if (json_is_array(at->value))
        return color_of_numbers(r, at, rgba);
    if (json_is_integer(at->value))
        snprintf(number, sizeof number, "%" JSON_INTEGER_FORMAT, json_integer_value(at->value));
    else if (!json_is_string(at->value))
        return io_fail_type(r, at, "a color");
    else if (!ogl1_string_value(r, at, &name))
        return false;
    if (ogl1_find_r_color(name, rgba))
        return true;
    return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                   "\"%.40s\" is not a color of R; expected was a name of colors(), \"#rrggbb\" or three "
                   "numbers from 0 to 1",
                   name);
}

bool ogl1_color(io_reader *r, const json_place *object, const char *key, float rgba[4])
{
    json_place at = ogl1_member(object, key);
    if (!at.value)
        return false;
    if (json_is_array(at.value) && !json_is_number(json_array_get(at.value, 0))) {
        io_warn(r, &at, NULL, "has %zu colors, for the vertices; the material gets the first one",
                json_array_size(at.value));
        at.value = json_array_get(at.value, 0);
    }
    return ogl1_color_value(r, &at, rgba);
}

/* ---- lists ---- */

ogl1_list ogl1_list_begin(io_reader *r, const json_place *object, const char *key,
                          bool (*is_element)(const json_t *))
{
    ogl1_list list = {.at = {.parent = object, .key = key, .value = json_object_get(object->value, key)}};
    json_t *value = (json_t *)list.at.value;
    list.is_single = json_is_object(value) && is_element(value);
    if (list.is_single)
        list.count = 1;
    else if (json_is_object(value))
        list.count = json_object_size(value);
    else if (json_is_array(value))
        list.count = json_array_size(value);
    else if (value && !json_is_null(value))
        io_fail_type(r, &list.at, "an array of objects");
    if (json_is_object(value) && !list.is_single)
        list.iterator = json_object_iter(value);
    return list;
}

bool ogl1_list_next(io_reader *r, ogl1_list *list, json_place *element)
{
    if (list->next >= list->count || !io_is_ok(r))
        return false;
    *element = (json_place){.parent = &list->at, .index = list->next++};
    if (list->is_single) {
        *element = list->at;
    } else if (list->iterator) {
        element->key = json_object_iter_key(list->iterator);
        element->value = json_object_iter_value(list->iterator);
        list->iterator = json_object_iter_next((json_t *)list->at.value, list->iterator);
    } else {
        element->value = json_array_get(list->at.value, element->index);
    }
    return json_is_object(element->value) || io_fail_type(r, element, "an object");
}
