/* text.h - growing text, and JSON written into it. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include "facet/facet.h"

/* Growing text. {.allocator} starts it; data is NULL or ends with 0. Running out of memory sets
 * has_failed, after which calls have no effect: check once, at the end. */
typedef struct text {
    facet_allocator allocator;
    char *data;
    size_t length, capacity;
    bool has_failed;
    bool needs_comma; /* for the text_json_ functions */
} text;

void text_add(text *t, const char *string);
void text_add_bytes(text *t, const void *bytes, size_t size);
void text_addf(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_destroy(text *t); /* {0} is allowed */
/* As HTML: &, <, > and quotes as entities; invalid UTF-8 and control characters become U+FFFD. */
void text_add_html(text *t, const char *string);
/* As the path of a URL: all but letters, digits and -._~/ as %XX. */
void text_add_url(text *t, const char *string);
/* As base64 (RFC 4648), padded, without line breaks. */
void text_add_base64(text *t, const void *bytes, size_t size);

enum { TEXT_FLOAT_SIZE = 40 };
/* The shortest decimal that reads back as the same finite float. */
void text_shortest_float(float value, char digits[TEXT_FLOAT_SIZE]);
/* The same for doubles, from 15 digits on. A double below 4096 that equals a float is printed as that
 * float: 0.1f is 0.1, not 0.10000000149011612. */
void text_shortest_double(double value, char digits[TEXT_FLOAT_SIZE]);
/* A short decimal of origin + value, from which the same float results when the origin is subtracted,
 * within the precision of a double. */
void text_shortest_place(float value, double origin, char digits[TEXT_FLOAT_SIZE]);

/* JSON: keys are NULL inside arrays and at the top. Numbers print as the shortest decimal that reads back
 * as the same float; NaN and infinities, which JSON lacks, become null. Strings are UTF-8; invalid bytes
 * become U+FFFD. */
void text_json_begin_object(text *t, const char *key);
void text_json_end_object(text *t);
void text_json_begin_array(text *t, const char *key);
void text_json_end_array(text *t);
void text_json_string(text *t, const char *key, const char *value); /* NULL: null */
void text_json_bool(text *t, const char *key, bool value);
void text_json_integer(text *t, const char *key, int64_t value);
void text_json_float(text *t, const char *key, float value);
void text_json_raw(text *t, const char *key, const char *json); /* a value as JSON text; NULL: null */
void text_json_floats(text *t, const char *key, const float *values, size_t count);
void text_json_doubles(text *t, const char *key, const double *values, size_t count);
/* Three numbers by text_shortest_place(). */
void text_json_place(text *t, const char *key, const float values[3], const double origin[3]);

#endif
