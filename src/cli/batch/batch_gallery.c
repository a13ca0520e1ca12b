/* batch_gallery.c - the page of --gallery: images as links to their files, relative to the page, so that both can be moved
 * together; above them the failures. No script. */
#define _GNU_SOURCE
#include "cli/batch/batch_survey.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/shared/failure.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_TILES = 20000 }; /* what a browser still scrolls */

static const char style[] =
    ":root{color-scheme:light "
    "dark;--paper:#fff;--ink:#1b1d20;--soft:#667;--line:#dcdfe4;--tile:#f4f5f7;--check:#e6e8ec;"
    "--bad:#b3261e}"
    "@media(prefers-color-scheme:dark){:root{--paper:#16181b;--ink:#e8eaed;--soft:#9aa0a8;--line:#34383e;--"
    "tile:#202327;"
    "--check:#2b2f35;--bad:#ff8a80}}"
    "*{box-sizing:border-box}body{margin:0;padding:24px "
    "clamp(12px,3vw,40px);background:var(--paper);color:var(--ink);"
    "font:15px/1.45 system-ui,sans-serif}"
    "h1{font-size:22px;margin:0 0 4px}h2{font-size:16px;margin:28px 0 10px}p{margin:0;color:var(--soft)}"
    ".grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(180px,42vw),1fr));gap:14px;margin-"
    "top:20px}"
    "figure{margin:0;min-width:0}"
    "figure a{display:block;aspect-ratio:1;border:1px solid var(--line);border-radius:8px;overflow:hidden;"
    "background:repeating-conic-gradient(var(--check) 0 25%,var(--tile) 0 50%) 0 0/20px 20px}"
    "figure a:hover,figure a:focus-visible{border-color:var(--ink)}"
    "figure img{display:block;width:100%;height:100%;object-fit:contain}"
    "figure "
    "a.file{display:grid;place-items:center;background:var(--tile);color:var(--soft);text-decoration:none;"
    "font-size:20px}"
    "figcaption{margin-top:5px;font-size:13px;color:var(--soft);white-space:nowrap;overflow:hidden;text-"
    "overflow:ellipsis}"
    "ul{margin:0;padding:0;list-style:none;border:1px solid var(--line);border-radius:8px}"
    "li{padding:9px 12px;overflow-wrap:anywhere}li+li{border-top:1px solid var(--line)}"
    "li b{color:var(--bad);font-weight:600}li span{color:var(--soft)}";

typedef struct gallery {
    char *folder;         /* of the page, absolute, without links */
    text tiles, failures; /* HTML */
    uint64_t tile_count;
} gallery;

/* The absolute path of the folder of a file without links; NULL: it does not exist, or there is no memory. */
static char *folder_of(const char *path)
{
    char *folder = path_folder(NULL, path);
    char *real = folder ? realpath(folder, NULL) : NULL;
    mem_free(folder);
    return real;
}

/* Appends the address of a file relative to the page. */
static void add_link(const gallery *g, text *t, const char *path)
{
    char *folder = folder_of(path);
    if (folder && g->folder) {
        const char *from = g->folder, *to = folder;
        size_t common = 0;
        for (size_t i = 0; from[i] && from[i] == to[i]; i++)
            if (from[i] == '/')
                common = i;
        size_t length = strlen(from), other = strlen(to);
        size_t shorter = length < other ? length : other;
        bool is_inside = strncmp(from, to, shorter) == 0 &&
                         (from[shorter] == '/' || to[shorter] == '/' || length == other);
        common = is_inside ? shorter : common;
        for (const char *rest = from + common; *rest; rest++)
            if (*rest == '/')
                text_add(t, "../");
        const char *rest = to + common + (to[common] == '/');
        text_add_url(t, rest);
        if (*rest)
            text_add(t, "/");
        text_add_url(t, path_base_name(path));
    } else {
        text_add_url(t, path);
    }
    free(folder);
}

static void add_tile(gallery *g, const batch_item *item)
{
    text *t = &g->tiles;
    const char *base = path_base_name(item->output), *dot = strrchr(base, '.');
    if (g->tile_count++ >= MAX_TILES)
        return;
    bool is_shown =
        output_name_has_type(item->output, "png jpg jpeg webp avif") && !output_name_has_frame(item->output);
    text_addf(t, "<figure><a%s href=\"", is_shown ? "" : " class=\"file\"");
    add_link(g, t, item->output);
    if (is_shown) {
        text_add(t, "\"><img loading=\"lazy\" src=\"");
        add_link(g, t, item->output);
        text_add(t, "\" alt=\"");
        text_add_html(t, base);
        text_add(t, "\"></a>");
    } else {
        text_add(t, "\">");
        text_add_html(t, dot ? dot : base);
        text_add(t, "</a>");
    }
    text_add(t, "<figcaption title=\"");
    text_add_html(t, item->name);
    text_add(t, "\">");
    text_add_html(t, base);
    text_add(t, "</figcaption></figure>\n");
}

static void add_item(void *user, const batch_item *item, batch_known known, const char *message)
{
    gallery *g = user;
    if (known == KNOWN_DONE) {
        if (item->output)
            add_tile(g, item);
        return;
    }
    text *t = &g->failures;
    text_add(t, "<li><b>");
    text_add_html(t, path_base_name(item->output ? item->output : item->name));
    text_add(t, "</b> <span>");
    text_add_html(t, message ? message : known == KNOWN_FAILED ? "failed" : "not made yet");
    text_add(t, "</span></li>\n");
}

static void assemble(const gallery *g, const batch_survey *s, text *page)
{
    text_add(page, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                   "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
                   "<title>facet batch</title><style>");
    text_add(page, style);
    text_addf(page, "</style></head>\n<body><h1>facet batch</h1>\n<p>%" PRIu64 " done", s->done);
    if (s->failed)
        text_addf(page, ", %" PRIu64 " failed", s->failed);
    if (s->missing)
        text_addf(page, ", %" PRIu64 " not made yet", s->missing);
    text_add(page, "</p>\n");
    if (g->failures.length) {
        text_add(page, "<h2>Failed or missing</h2>\n<ul>\n");
        text_add_bytes(page, g->failures.data, g->failures.length);
        text_add(page, "</ul>\n");
    }
    text_add(page, "<div class=\"grid\">\n");
    if (g->tiles.length)
        text_add_bytes(page, g->tiles.data, g->tiles.length);
    text_add(page, "</div>\n");
    if (g->tile_count > MAX_TILES)
        text_addf(page, "<p>%" PRIu64 " more are not shown.</p>\n", g->tile_count - MAX_TILES);
    text_add(page, "</body></html>\n");
}

facet_result batch_gallery_write(batch_survey *survey, const char *path, facet_error *error)
{
    gallery g = {.folder = NULL};
    text page = {.data = NULL};
    facet_result result = output_make_folders(path, error);
    g.folder = result == FACET_OK ? folder_of(path) : NULL;
    if (result == FACET_OK)
        result = batch_survey_all(survey, &g, add_item, error);
    if (result == FACET_OK) {
        assemble(&g, survey, &page);
        if (g.tiles.has_failed || g.failures.has_failed || page.has_failed)
            result = fail_memory(error, path, 0);
        else
            result = output_write_bytes(page.data, page.length, path, error);
    }
    free(g.folder);
    text_destroy(&g.tiles);
    text_destroy(&g.failures);
    text_destroy(&page);
    return result;
}
