/* chart_test_xml.h - for tests: an XML scanner. Checks that elements nest, attributes are quoted,
 * characters are valid and references resolve. */
#ifndef PLOT_CHART_TEST_XML_H
#define PLOT_CHART_TEST_XML_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { XML_DEPTH = 64, XML_NAME = 32 };

static inline size_t name_length(const char *p)
{
    return strcspn(p, " \t\r\n/>=");
}

/* Fails if an ampersand begins no entity or a character is not valid in XML. */
static inline void scan_characters(const char *from, const char *end)
{
    for (const char *p = from; p < end; p++) {
        assert_true((unsigned char)*p >= 0x20 || *p == '\n' || *p == '\t');
        if (*p == '&')
            assert_true(strncmp(p, "&lt;", 4) == 0 || strncmp(p, "&gt;", 4) == 0 ||
                        strncmp(p, "&amp;", 5) == 0 || strncmp(p, "&quot;", 6) == 0);
    }
}

/* Scans attributes from p to the end of the tag; returns whether it is self-closing. */
static inline const char *scan_attributes(const char *p, bool *is_empty)
{
    for (;;) {
        p += strspn(p, " \t\r\n");
        if (*p == '/' || *p == '>') {
            *is_empty = *p == '/';
            p += *is_empty;
            assert_int_equal(*p, '>');
            return p + 1;
        }
        p += name_length(p);
        assert_int_equal(*p, '=');
        assert_int_equal(p[1], '"');
        const char *end = strchr(p + 2, '"');
        assert_non_null(end);
        assert_null(memchr(p + 2, '<', (size_t)(end - p - 2)));
        scan_characters(p + 2, end);
        p = end + 1;
    }
}

static inline void expect_well_formed(const char *p)
{
    char names[XML_DEPTH][XML_NAME];
    int depth = 0, root_count = 0;
    assert_true(strncmp(p, "<?xml ", 6) == 0);
    p = strstr(p, "?>") + 2;
    while (*p) {
        const char *tag = p + strcspn(p, "<");
        scan_characters(p, tag);
        if (*tag == 0)
            break;
        assert_true(depth > 0 || root_count == 0);
        if (tag[1] == '/') {
            const size_t length = name_length(tag + 2);
            assert_true(depth > 0);
            depth--;
            assert_true(strlen(names[depth]) == length && memcmp(names[depth], tag + 2, length) == 0);
            assert_int_equal(tag[2 + length], '>');
            p = tag + 3 + length;
            continue;
        }
        const size_t length = name_length(tag + 1);
        bool is_empty;
        assert_true(depth < XML_DEPTH && length > 0 && length < XML_NAME);
        memcpy(names[depth], tag + 1, length);
        names[depth][length] = 0;
        root_count += depth == 0;
        p = scan_attributes(tag + 1 + length, &is_empty);
        depth += !is_empty;
    }
    assert_int_equal(depth, 0);
    assert_int_equal(root_count, 1);
}

/* Every "#name" refers to the id of one element. */
static inline void expect_references(const char *svg)
{
    int count = 0;
    for (const char *p = svg; (p = strstr(p, "#")) != NULL; p++) {
        char id[80];
        const size_t length = strcspn(p + 1, "\")");
        assert_true(length > 0 && length < 60);
        snprintf(id, sizeof id, " id=\"%.*s\"", (int)length, p + 1);
        const char *found = strstr(svg, id);
        assert_non_null(found);
        assert_null(strstr(found + 1, id));
        count++;
    }
    assert_true(count > 0);
}

#endif
