/* file_alike.c - see file_alike.h. Names are compared as lower-case base letters and combining marks
 * (Unicode's canonical decomposition). */
#define _POSIX_C_SOURCE 200809L
#include "io/file_alike.h"

#include <dirent.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"

/* ---- letters ---- */

enum { LONGEST_NAME = 255, MAX_LETTERS = 3 * LONGEST_NAME, MAX_PARTS = 3 };

/* Reads the next character and advances *p. */
static uint32_t take_character(const unsigned char **p)
{
    static const uint32_t least[] = {0, 0x80, 0x800, 0x10000};
    const unsigned char *s = *p;
    unsigned more = s[0] >= 0xf0 && s[0] < 0xf8   ? 3
                    : s[0] >= 0xe0 && s[0] < 0xf0 ? 2
                                                  : s[0] >= 0xc2 && s[0] < 0xe0;
    uint32_t c = more ? s[0] & (0x3fu >> more) : s[0];
    unsigned i = 1;
    for (; i <= more && (s[i] & 0xc0) == 0x80; i++)
        c = c << 6 | (s[i] & 0x3fu);
    if (i <= more || c < least[more]) { /* Latin-1 */
        *p = s + 1;
        return s[0];
    }
    *p = s + i;
    return c;
}

static uint32_t to_lower(uint32_t c)
{
    if ((c >= 'A' && c <= 'Z') || (c >= 0xc0 && c <= 0xde && c != 0xd7) || (c >= 0x391 && c <= 0x3ab) ||
        (c >= 0x410 && c <= 0x42f))
        return c + 32;
    if ((c >= 0x100 && c <= 0x137) || (c >= 0x14a && c <= 0x177) || (c >= 0x1e00 && c <= 0x1eff))
        return c | 1; /* pairs of upper-case and lower-case letters */
    if ((c >= 0x139 && c <= 0x148) || (c >= 0x179 && c <= 0x17e) || (c >= 0x1cd && c <= 0x1dc))
        return c + (c & 1);
    if (c >= 0x400 && c <= 0x40f)
        return c + 80;
    if (c >= 0x388 && c <= 0x38a)
        return c + 37;
    return c == 0x386                 ? 0x3ac
           : c == 0x38c               ? 0x3cc
           : c == 0x38e || c == 0x38f ? c + 63
           : c == 0x3c2               ? 0x3c3
                                      : c;
}

/* The combining mark of a character in the tables below. */
static uint32_t mark_of(char letter)
{
    static const char letters[] = "`'^~-u.:?o\"v+_,;";
    static const uint16_t marks[] = {0x300, 0x301, 0x302, 0x303, 0x304, 0x306, 0x307, 0x308,
                                     0x309, 0x30a, 0x30b, 0x30c, 0x31b, 0x323, 0x327, 0x328};
    const char *at = letter ? strchr(letters, letter) : NULL;
    return at ? marks[at - letters] : 0;
}

/* Base letters and marks of the lower-case letters from U+00C0, U+01CE and U+1EA1 on; blanks: none. The
 * first table has both letters of a case pair, the others one of two. */
static const char LATIN[] =
    "a`a'a^a~a:ao  c,e`e'e^e:i`i'i^i:  n~o`o'o^o~o:    u`u'u^u:y'    a`a'a^a~a:ao  c,e`e'"
    "e^e:i`i'i^i:  n~o`o'o^o~o:    u`u'u^u:y'  y:a-a-auaua;a;c'c'c^c^c.c.cvcvdvdv    e-e-"
    "eueue.e.e;e;evevg^g^gugug.g.g,g,h^h^    i~i~i-i-iuiui;i;i.      j^j^k,k,  l'l'l,l,lv"
    "lv        n'n'n,n,nvnv      o-o-ououo\"o\"    r'r'r,r,rvrvs's's^s^s,s,svsvt,t,tvtv  "
    "  u~u~u-u-uuuuuouou\"u\"u;u;w^w^y^y^y:z'z'z.z.zvzv  ";
static const char PINYIN[] = "av iv ov uv u:-u:'u:vu:`";
static const char VIETNAMESE[] =
    "a_ a? a^'a^`a^?a^~a_^au'au`au?au~a_ue_ e? e~ e^'e^`e^?e^~e_^i? i_ o_ o? o^'o^`o^?o^~"
    "o_^o+'o+`o+?o+~o+_u_ u? u+'u+`u+?u+~u+_y` y_ y? y~ ";

/* The remaining letters with marks, in lower case. */
static const struct {
    uint16_t composed, letter, marks[2];
} OTHERS[] = {
    {0x1a1, 'o', {0x31b}},   {0x1b0, 'u', {0x31b}},          {0x390, 0x3b9, {0x301, 0x308}},
    {0x3ac, 0x3b1, {0x301}}, {0x3ad, 0x3b5, {0x301}},        {0x3ae, 0x3b7, {0x301}},
    {0x3af, 0x3b9, {0x301}}, {0x3b0, 0x3c5, {0x301, 0x308}}, {0x3ca, 0x3b9, {0x308}},
    {0x3cb, 0x3c5, {0x308}}, {0x3cc, 0x3bf, {0x301}},        {0x3cd, 0x3c5, {0x301}},
    {0x3ce, 0x3c9, {0x301}}, {0x439, 0x438, {0x306}},        {0x450, 0x435, {0x300}},
    {0x451, 0x435, {0x308}}, {0x453, 0x433, {0x301}},        {0x457, 0x456, {0x308}},
    {0x45c, 0x43a, {0x301}}, {0x45d, 0x438, {0x300}},        {0x45e, 0x443, {0x306}},
};

static size_t parts_of_row(const char *row, size_t width, uint32_t out[MAX_PARTS])
{
    size_t count = 0;
    for (size_t i = 0; i < width && row[i] != ' '; i++)
        out[count++] = i == 0 ? (unsigned char)row[0] : mark_of(row[i]);
    return count;
}

/* A Hangul syllable, whose parts follow from its code point (Unicode, section 3.12). */
static size_t parts_of_hangul(uint32_t c, uint32_t out[MAX_PARTS])
{
    uint32_t number = c - 0xac00;
    out[0] = 0x1100 + number / 588;
    out[1] = 0x1161 + number % 588 / 28;
    out[2] = 0x11a7 + number % 28;
    return number % 28 ? 3 : 2;
}

/* Kana with a voiced or semi-voiced mark follow those without. 0: the character has no mark. */
static size_t parts_of_kana(uint32_t c, uint32_t out[MAX_PARTS])
{
    uint32_t at = c >= 0x30a0 ? c - 0x30a0 : c - 0x3040; /* in either syllabary */
    uint32_t base = c - at;
    bool is_voiced = (at >= 0x0c && at <= 0x22 && at % 2 == 0) || at == 0x25 || at == 0x27 || at == 0x29;
    uint32_t h = at >= 0x2f && at <= 0x3d ? (at - 0x2f) % 3 : 0; /* ha, ba, pa, hi .. */
    if (at == 0x54)
        out[0] = base + 0x06;
    else if (is_voiced || h)
        out[0] = c - (h ? h : 1);
    else
        return 0;
    out[1] = h == 2 ? 0x309a : 0x3099;
    return 2;
}

/* Decomposes a character into a lower-case letter and marks. Returns their number. */
static size_t take_apart(uint32_t c, uint32_t out[MAX_PARTS])
{
    size_t count = 0;
    c = to_lower(c);
    if (c >= 0xc0 && c < 0x180)
        count = parts_of_row(LATIN + 2 * (c - 0xc0), 2, out);
    else if (c >= 0x1ce && c <= 0x1dc)
        count = parts_of_row(PINYIN + 3 * ((c - 0x1ce) / 2), 3, out);
    else if (c >= 0x1ea1 && c <= 0x1ef9)
        count = parts_of_row(VIETNAMESE + 3 * ((c - 0x1ea1) / 2), 3, out);
    else if (c >= 0xac00 && c <= 0xd7a3)
        count = parts_of_hangul(c, out);
    else if (c >= 0x3041 && c <= 0x30ff)
        count = parts_of_kana(c, out);
    for (size_t i = 0; count == 0 && i < sizeof OTHERS / sizeof *OTHERS; i++)
        if (OTHERS[i].composed == c) {
            out[count++] = OTHERS[i].letter;
            for (size_t k = 0; k < 2 && OTHERS[i].marks[k]; k++)
                out[count++] = OTHERS[i].marks[k];
        }
    if (count == 0)
        out[count++] = c;
    return count;
}

static bool is_mark(uint32_t c)
{
    return (c >= 0x300 && c <= 0x36f) || c == 0x3099 || c == 0x309a;
}

/* Decomposes a name; the marks of a letter are sorted by code point. SIZE_MAX: too long. */
static size_t spell(const char *name, uint32_t out[MAX_LETTERS])
{
    size_t count = 0;
    const unsigned char *p = (const unsigned char *)name;
    if (strlen(name) > LONGEST_NAME)
        return SIZE_MAX;
    while (*p) {
        uint32_t parts[MAX_PARTS];
        size_t part_count = take_apart(take_character(&p), parts);
        for (size_t i = 0; i < part_count; i++) {
            size_t at = count++;
            for (; is_mark(parts[i]) && at > 0 && is_mark(out[at - 1]) && out[at - 1] > parts[i]; at--)
                out[at] = out[at - 1];
            out[at] = parts[i];
        }
    }
    return count;
}

bool file_names_are_alike(const char *a, const char *b)
{
    uint32_t x[MAX_LETTERS];
    uint32_t y[MAX_LETTERS];
    size_t count = spell(a, x);
    return count != SIZE_MAX && spell(b, y) == count && memcmp(x, y, count * sizeof *x) == 0;
}

/* ---- folders ---- */

enum { LONGEST_PATH = 4096 };

/* A search that descends part by part: text is the folder and the path found so far. */
typedef struct search {
    char text[LONGEST_PATH];
    size_t length;
    size_t *budget;
} search;

/* Whether the path with that part appended exists, as a folder or, for the last part, as a file; if so it
 * stays appended. */
static bool append_part(search *s, const char *part, size_t length, bool is_last)
{
    struct stat status;
    if (length == 0 || s->length + length + 2 > LONGEST_PATH)
        return false;
    memcpy(s->text + s->length, part, length);
    s->text[s->length + length] = 0;
    if (stat(s->text, &status) != 0 || !(is_last ? S_ISREG(status.st_mode) : S_ISDIR(status.st_mode))) {
        s->text[s->length] = 0;
        return false;
    }
    s->length += length;
    return true;
}

/* Appends the only entry of the current folder that is alike. */
static bool append_alike(search *s, const char *name, bool is_last)
{
    uint32_t wanted[MAX_LETTERS];
    uint32_t letters[MAX_LETTERS];
    size_t wanted_count = spell(name, wanted);
    size_t begin = s->length;
    char only[LONGEST_NAME + 1];
    size_t count = 0;
    DIR *folder = wanted_count == SIZE_MAX ? NULL : opendir(s->text);
    for (struct dirent *e; folder && count < 2 && *s->budget > 0 && (e = readdir(folder));) {
        (*s->budget)--;
        if (spell(e->d_name, letters) != wanted_count ||
            memcmp(letters, wanted, wanted_count * sizeof *wanted) ||
            !append_part(s, e->d_name, strlen(e->d_name), is_last))
            continue;
        memcpy(only, e->d_name, strlen(e->d_name) + 1);
        s->length = begin;
        s->text[begin] = 0;
        count++;
    }
    if (folder)
        closedir(folder);
    return count == 1 && append_part(s, only, strlen(only), is_last);
}

/* Descends all parts of a path. The longest name has LONGEST_NAME bytes. */
static bool find_parts(search *s, const char *path)
{
    while (*path) {
        char name[LONGEST_NAME + 1];
        size_t length = strcspn(path, "/");
        const char *next = path + length + strspn(path + length, "/");
        bool is_last = !*next;
        if (length > LONGEST_NAME)
            return false;
        memcpy(name, path, length);
        name[length] = 0;
        if (!append_part(s, name, length, is_last) && !append_alike(s, name, is_last))
            return false;
        if (!is_last) {
            s->text[s->length++] = '/';
            s->text[s->length] = 0;
        }
        path = next;
    }
    return true;
}

char *file_find_alike(const facet_allocator *allocator, const char *folder, const char *path, size_t *budget,
                      bool *has_failed)
{
    search s = {.length = strlen(folder), .budget = budget};
    *has_failed = false;
    if (s.length + 2 > LONGEST_PATH || path[0] == '/' || path[0] == 0 || path[strlen(path) - 1] == '/')
        return NULL;
    memcpy(s.text, folder, s.length);
    s.text[s.length++] = '/';
    size_t begin = s.length;
    if (!find_parts(&s, path))
        return NULL;
    char *found = mem_alloc(allocator, s.length - begin + 1, 1);
    if (found)
        memcpy(found, s.text + begin, s.length - begin + 1);
    *has_failed = !found;
    return found;
}
