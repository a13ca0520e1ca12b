/* html.c - see html.h. */
#include "report/html.h"

#include <math.h>
#include <string.h>

/* ---- numbers ---- */

void html_number(text *out, double value)
{
    if (isnan(value))
        text_add(out, "&ndash;");
    else
        text_addf(out, "%.3g", value);
}

/* ---- images ---- */

void html_image(text *out, const char *mime_type, const unsigned char *bytes, size_t size, uint32_t width,
                uint32_t height, const char *alternative)
{
    text_addf(out, "<img width=\"%u\" height=\"%u\" alt=\"", width, height);
    text_add_html(out, alternative);
    text_addf(out, "\" src=\"data:%s;base64,", mime_type);
    text_add_base64(out, bytes, size);
    text_add(out, "\">");
}

/* ---- the page ---- */

static const char style[] =
    ":root{color-scheme:light dark;--ink:#1c1f24;--dim:#5c6570;--paper:#fff;--card:#f5f6f8;--line:#d9dde3;"
    "--good:#1b7f4b;--fair:#7a6a00;--poor:#b35900;--bad:#b3261e}"
    "@media(prefers-color-scheme:dark){:root{--ink:#e6e9ee;--dim:#9aa4b0;--paper:#14171b;--card:#1d2127;"
    "--line:#343b45;--good:#5ecf95;--fair:#d9c34a;--poor:#ff9f4a;--bad:#ff7a70}}"
    "body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);margin:0 auto;"
    "padding:2rem 1.25rem;max-width:62rem}"
    "h1{font-size:1.5rem;margin:0 0 .25rem}h2{font-size:1.15rem;margin:0 0 .5rem}p{margin:.5rem 0}"
    ".dim{color:var(--dim)}.card{background:var(--card);border:1px solid var(--line);border-radius:8px;"
    "padding:1rem 1.25rem;margin:1rem 0;break-inside:avoid}"
    ".good{color:var(--good)}.fair{color:var(--fair)}.poor{color:var(--poor)}.bad{color:var(--bad)}"
    ".grade{font-weight:600;margin-left:.5rem}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.5rem 0}"
    "th,td{padding:.15rem .9rem .15rem 0;text-align:left;vertical-align:top}"
    "th{font-weight:600;color:var(--dim)}td.n,th.n{text-align:right}"
    ".row{display:flex;flex-wrap:wrap;gap:1.5rem;align-items:flex-start}"
    "figure{margin:0;text-align:center}figcaption{font-size:.85rem;color:var(--dim)}"
    ".curves img{background:#fff;border-radius:6px;max-width:100%;height:auto}"
    ".swatch{display:inline-block;width:.9em;height:.9em;border:1px solid var(--line);border-radius:3px;"
    "vertical-align:-.1em;margin-right:.35em}"
    "ul{margin:.25rem 0;padding-left:1.2rem}code{font-size:.92em}"
    "@media print{body{max-width:none;padding:0}.card{border-color:#999}}";

void html_begin(text *out, const char *title)
{
    text_add(out, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                  "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>");
    text_add_html(out, title);
    text_add(out, "</title>\n<style>");
    text_add(out, style);
    text_add(out, "</style>\n</head>\n<body>\n");
}

void html_end(text *out)
{
    text_add(out, "</body>\n</html>\n");
}
