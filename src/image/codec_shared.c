/* codec_shared.c - checks, conversions and notes that all codecs share. */
#include "image/codec.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/result.h"

facet_result codec_check_size(const char *name, uint64_t width, uint64_t height, uint32_t max_size,
                              facet_error *error)
{
    if (width == 0 || height == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: the image has no texels (%llu x %llu)", name,
                    (unsigned long long)width, (unsigned long long)height);
    if (width > max_size || height > max_size)
        return fail(error, FACET_ERROR_LIMIT, "%s: %llu x %llu texels, more than %u along an edge", name,
                    (unsigned long long)width, (unsigned long long)height, max_size);
    return FACET_OK;
}

facet_result codec_check_texels(const char *name, const char *format, uint32_t width, uint32_t height,
                                uint32_t max_size, uint64_t needed, size_t size, facet_error *error)
{
    facet_result result = codec_check_size(name, width, height, max_size, error);
    if (result == FACET_OK && needed > size)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: %s: %u x %u texels need %llu bytes or more, the file has %zu", name, format, width,
                    height, (unsigned long long)needed, size);
    return result;
}

facet_result codec_check_input(const image *i, const char *codec_name, bool is_type_right, const char *types,
                               uint32_t channel_counts, facet_error *error)
{
    if (!i->pixels || i->width == 0 || i->height == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: there is no image to write", codec_name);
    if (!is_type_right || !(channel_counts >> i->channel_count & 1u))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: images of %s channels are written, not %u of type %d",
                    codec_name, types, i->channel_count, (int)i->type);
    return FACET_OK;
}

static void swap_bytes(unsigned char *a, unsigned char *b, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        const unsigned char kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

void codec_flip(image *i, bool has_flipped_columns, bool has_flipped_rows)
{
    const size_t row_size = image_row_size(i), texel_size = image_texel_size(i);
    unsigned char *pixels = i->pixels;
    for (size_t y = 0; has_flipped_rows && y < i->height / 2; y++)
        swap_bytes(pixels + y * row_size, pixels + (i->height - 1 - y) * row_size, row_size);
    for (size_t y = 0; has_flipped_columns && y < i->height; y++)
        for (size_t x = 0; x < i->width / 2; x++)
            swap_bytes(pixels + y * row_size + x * texel_size,
                       pixels + (y + 1) * row_size - (x + 1) * texel_size, texel_size);
}

facet_result codec_set_channels(image *i, const image_decode_desc *desc, facet_error *error)
{
    if (desc->channel_count == 0 || desc->channel_count == i->channel_count || i->type != IMAGE_U8)
        return FACET_OK;
    image asked = {0};
    facet_result result = image_convert(i, &desc->allocator, desc->thread_count, desc->channel_count,
                                        IMAGE_U8, i->is_srgb, &asked, error);
    image_destroy(i);
    *i = asked;
    return result;
}

double codec_parse_number(const char *text, const char *end, const char **after)
{
    const char *p = text;
    double sign = p < end && *p == '-' ? -1.0 : 1.0;
    if (p < end && (*p == '-' || *p == '+'))
        p++;
    double x = 0.0;
    int digits = 0;
    int scale = 0; /* power of ten */
    bool is_fraction = false;
    for (; p < end && ((*p >= '0' && *p <= '9') || (*p == '.' && !is_fraction)); p++) {
        if (*p == '.') {
            is_fraction = true;
            continue;
        }
        x = x * 10.0 + (*p - '0');
        digits++;
        scale -= is_fraction;
    }
    if (digits > 0 && end - p >= 2 && (*p == 'e' || *p == 'E')) {
        const char *q = p + 1;
        int exponent_sign = *q == '-' ? -1 : 1;
        if (*q == '-' || *q == '+')
            q++;
        int exponent = 0;
        const char *first = q;
        for (; q < end && *q >= '0' && *q <= '9'; q++)
            exponent = exponent < 1000 ? exponent * 10 + (*q - '0') : exponent;
        if (q > first) {
            scale += exponent_sign * exponent;
            p = q;
        }
    }
    if (after)
        *after = p;
    return digits ? sign * x * pow(10.0, scale) : (double)NAN;
}

void image_note_set(image_note *note, facet_log_level level, const char *format, ...)
{
    if (!note)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(note->text, sizeof note->text, format, arguments);
    va_end(arguments);
    note->level = level;
}

void image_note_log(const image_note *note, const char *name, const facet_log *log)
{
    if (note->text[0])
        log_message(log, note->level, "%s: %s", name, note->text);
}
