/* result.c - see result.h. */
#include "base/result.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A name in a malicious file must not break a message into lines. */
static void make_one_line(char *text)
{
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
}

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
        make_one_line(error->message);
    }
    return result;
}

facet_result fail_memory(facet_error *error, const char *what, size_t size)
{
    return size ? fail(error, FACET_ERROR_MEMORY, "out of memory: %s (%zu bytes)", what, size)
                : fail(error, FACET_ERROR_MEMORY, "out of memory: %s", what);
}

static void send_message(const facet_log *log, facet_log_level level, const char *format, va_list arguments)
{
    if (!log || !log->message)
        return;
    char text[1024];
    if (vsnprintf(text, sizeof text, format, arguments) < 0)
        return;
    make_one_line(text);
    log->message(log->user, level, text);
}

void log_message(const facet_log *log, facet_log_level level, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send_message(log, level, format, arguments);
    va_end(arguments);
}

void log_warning(const facet_log *log, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send_message(log, FACET_LOG_LEVEL_WARNING, format, arguments);
    va_end(arguments);
}
