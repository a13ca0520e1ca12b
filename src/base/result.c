/* result.c - see result.h. */
#include "base/result.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

facet_result fail(facet_error *error, facet_result result, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        error->result = result;
        int length = vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
        if (length < 0)
            error->message[0] = 0;
        /* A sentence is one line, whatever a hostile file put into a name. */
        for (char *c = error->message; *c; c++)
            if ((unsigned char)*c < 0x20 || *c == 0x7f)
                *c = '?';
    }
    return result;
}

facet_result fail_memory(facet_error *error, const char *what, size_t size)
{
    return fail(error, FACET_ERROR_MEMORY, "out of memory: %s (%zu bytes)", what, size);
}

static void send(const facet_log *log, facet_log_level level, const char *format, va_list arguments)
{
    char text[1024];
    if (vsnprintf(text, sizeof text, format, arguments) < 0)
        return;
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    log->message(log->user, level, text);
}

#define SEND(level)                                                                                          \
    do {                                                                                                     \
        if (!log || !log->message)                                                                           \
            return;                                                                                          \
        va_list arguments;                                                                                   \
        va_start(arguments, format);                                                                         \
        send(log, level, format, arguments);                                                                 \
        va_end(arguments);                                                                                   \
    } while (0)

void log_warning(const facet_log *log, const char *format, ...)
{
    SEND(FACET_LOG_WARNING);
}

void log_info(const facet_log *log, const char *format, ...)
{
    SEND(FACET_LOG_INFO);
}

void log_debug(const facet_log *log, const char *format, ...)
{
    SEND(FACET_LOG_DEBUG);
}
