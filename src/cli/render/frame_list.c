/* frame_list.c - see frame_list.h. */
#include "cli/render/frame_list.h"

#include <string.h>

static bool scan_whole(const char **text, uint32_t *number)
{
    const char *at = *text;
    uint32_t value = 0;
    if (*at < '0' || *at > '9')
        return false;
    for (; *at >= '0' && *at <= '9'; at++) {
        value = 10 * value + (uint32_t)(*at - '0');
        if (value > 100000000)
            return false;
    }
    *text = at;
    *number = value;
    return true;
}

static bool skip(const char **text, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0)
        return false;
    *text += length;
    return true;
}

static uint32_t count_of(const frame_range *r)
{
    return (r->last - r->first) / r->step + 1;
}

static bool scan_range(const char **text, frame_range *out)
{
    while (skip(text, " "))
        ;
    if (!scan_whole(text, &out->first))
        return false;
    out->last = out->first;
    out->step = 1;
    if ((skip(text, "-") || skip(text, "..")) && !scan_whole(text, &out->last))
        return false;
    if (skip(text, "x") && !scan_whole(text, &out->step))
        return false;
    while (skip(text, " "))
        ;
    return out->first >= 1 && out->last >= out->first && out->step > 0;
}

bool frame_list_parse(const char *text, frame_list *out)
{
    frame_list list = {0};
    do {
        if (list.range_count == FRAME_LIST_RANGES || !scan_range(&text, &list.ranges[list.range_count]))
            return false;
        uint32_t count = count_of(&list.ranges[list.range_count++]);
        if (count > FRAME_LIST_FRAMES - list.frame_count)
            return false;
        list.frame_count += count;
    } while (skip(&text, ","));
    if (*text)
        return false;
    *out = list;
    return true;
}

frame_list frame_list_all(uint32_t first, uint32_t last)
{
    frame_list list = {.range_count = 1, .ranges = {{first, last, 1}}};
    list.frame_count = count_of(&list.ranges[0]);
    return list;
}

uint32_t frame_list_at(const frame_list *list, uint32_t index)
{
    const frame_range *r = list->ranges;
    for (; index >= count_of(r); r++)
        index -= count_of(r);
    return r->first + index * r->step;
}
