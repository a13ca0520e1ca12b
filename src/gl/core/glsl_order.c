/* glsl_order.c - see glsl_order.h. Words, numbers and signs one after the other; types and functions by how they stand: a
 * word before a word is a type, a word before a bracket is called. */
#include "gl/core/glsl_order.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_NAMES = 4096, MAX_MACROS = 1024, MAX_IFS = 64, MAX_NAME = 64, MAX_BODY_DEPTH = 16 };

/* Of GLSL ES 3.00, which is the smaller of the two languages. */
static const char *const keywords[] = {"if",    "else",     "for",     "while",  "do",   "return",
                                       "break", "continue", "discard", "switch", "case", "default",
                                       "true",  "false",    "struct",  "layout", NULL};
static const char *const qualifiers[] = {"const",    "in",        "out",       "inout", "uniform",
                                         "centroid", "flat",      "smooth",    "highp", "mediump",
                                         "lowp",     "precision", "invariant", NULL};
static const char *const types[] = {"void",
                                    "float",
                                    "int",
                                    "uint",
                                    "bool",
                                    "vec2",
                                    "vec3",
                                    "vec4",
                                    "ivec2",
                                    "ivec3",
                                    "ivec4",
                                    "uvec2",
                                    "uvec3",
                                    "uvec4",
                                    "bvec2",
                                    "bvec3",
                                    "bvec4",
                                    "mat2",
                                    "mat3",
                                    "mat4",
                                    "mat2x3",
                                    "mat3x2",
                                    "mat2x4",
                                    "mat4x2",
                                    "mat3x4",
                                    "mat4x3",
                                    "sampler2D",
                                    "sampler3D",
                                    "samplerCube",
                                    "sampler2DArray",
                                    "sampler2DShadow",
                                    "sampler2DArrayShadow",
                                    "samplerCubeShadow",
                                    "usampler2D",
                                    "isampler2D",
                                    NULL};
static const char *const functions[] = {"radians",
                                        "degrees",
                                        "sin",
                                        "cos",
                                        "tan",
                                        "asin",
                                        "acos",
                                        "atan",
                                        "sinh",
                                        "cosh",
                                        "tanh",
                                        "asinh",
                                        "acosh",
                                        "atanh",
                                        "pow",
                                        "exp",
                                        "log",
                                        "exp2",
                                        "log2",
                                        "sqrt",
                                        "inversesqrt",
                                        "abs",
                                        "sign",
                                        "floor",
                                        "trunc",
                                        "round",
                                        "roundEven",
                                        "ceil",
                                        "fract",
                                        "mod",
                                        "modf",
                                        "min",
                                        "max",
                                        "clamp",
                                        "mix",
                                        "step",
                                        "smoothstep",
                                        "isnan",
                                        "isinf",
                                        "floatBitsToInt",
                                        "floatBitsToUint",
                                        "intBitsToFloat",
                                        "uintBitsToFloat",
                                        "packHalf2x16",
                                        "unpackHalf2x16",
                                        "packUnorm2x16",
                                        "unpackUnorm2x16",
                                        "packSnorm2x16",
                                        "unpackSnorm2x16",
                                        "length",
                                        "distance",
                                        "dot",
                                        "cross",
                                        "normalize",
                                        "faceforward",
                                        "reflect",
                                        "refract",
                                        "matrixCompMult",
                                        "outerProduct",
                                        "transpose",
                                        "determinant",
                                        "inverse",
                                        "lessThan",
                                        "lessThanEqual",
                                        "greaterThan",
                                        "greaterThanEqual",
                                        "equal",
                                        "notEqual",
                                        "any",
                                        "all",
                                        "not",
                                        "textureSize",
                                        "texture",
                                        "textureProj",
                                        "textureLod",
                                        "textureOffset",
                                        "texelFetch",
                                        "texelFetchOffset",
                                        "textureGrad",
                                        "textureGradOffset",
                                        "textureLodOffset",
                                        "dFdx",
                                        "dFdy",
                                        "fwidth",
                                        NULL};

typedef struct name {
    char text[MAX_NAME];
} name;

typedef struct macro {
    name name;
    const char *body;       /* to the end of its line */
    const char *parameters; /* NULL: it has none */
} macro;

typedef struct scan {
    const char *at;
    int line;
    name types[MAX_NAMES], functions[MAX_NAMES];
    size_t type_count, function_count, macro_count;
    macro macros[MAX_MACROS];
    struct {
        bool is_taken, was_taken; /* this branch; some branch */
    } ifs[MAX_IFS];
    int if_depth;
    char *complaint;
    size_t size;
    bool has_failed;
} scan;

static void complain(scan *s, const char *what, const char *which)
{
    if (!s->has_failed)
        snprintf(s->complaint, s->size, "line %d: %s \"%s\"", s->line, what, which);
    s->has_failed = true;
}

static bool is_listed(const char *const *list, const char *word)
{
    for (; *list; list++)
        if (**list == *word && strcmp(*list, word) == 0)
            return true;
    return false;
}

static bool is_named(const name *names, size_t count, const char *word)
{
    for (size_t i = 0; i < count; i++)
        if (names[i].text[0] == *word && strcmp(names[i].text, word) == 0)
            return true;
    return false;
}

static const macro *find_macro(const scan *s, const char *word)
{
    for (size_t i = 0; i < s->macro_count; i++)
        if (s->macros[i].name.text[0] == *word && strcmp(s->macros[i].name.text, word) == 0)
            return &s->macros[i];
    return NULL;
}

static bool is_type(const scan *s, const char *word)
{
    return is_listed(types, word) || is_named(s->types, s->type_count, word);
}

static bool is_function(const scan *s, const char *word)
{
    return is_listed(functions, word) || is_named(s->functions, s->function_count, word);
}

static void define(scan *s, name *names, size_t *count, const char *word)
{
    if (*count == MAX_NAMES)
        complain(s, "too many names; the last is", word);
    else
        snprintf(names[(*count)++].text, MAX_NAME, "%s", word);
}

/* ---- words ---- */

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* The next word, number or sign of a line's text into token; false: the text ends, or the line where ends_with_line. */
static bool next_token(const char **at, int *line, bool ends_with_line, char token[MAX_NAME])
{
    const char *c = *at;
    for (;;) {
        if (strncmp(c, "//", 2) == 0) {
            c += strcspn(c, "\n");
        } else if (strncmp(c, "/*", 2) == 0) {
            for (c += 2; *c && strncmp(c, "*/", 2) != 0; c++)
                *line += *c == '\n';
            c += *c ? 2 : 0;
        } else if (*c == '\n' && !ends_with_line) {
            ++*line;
            c++;
        } else if (*c == ' ' || *c == '\t' || *c == '\r' || (*c == '\\' && c[1] == '\n')) {
            *line += *c == '\\';
            c += *c == '\\' ? 2 : 1;
        } else {
            break;
        }
    }
    size_t length = 0;
    if (is_letter(*c) || is_digit(*c) || (*c == '.' && is_digit(c[1])))
        while (is_letter(c[length]) || is_digit(c[length]) ||
               (is_digit(*c) && (c[length] == '.' || ((c[length] == '+' || c[length] == '-') &&
                                                      (c[length - 1] == 'e' || c[length - 1] == 'E')))) ||
               (*c == '.' && length == 0))
            length++;
    else if (*c && *c != '\n')
        length = 1;
    size_t kept = length < MAX_NAME ? length : MAX_NAME - 1;
    memcpy(token, c, kept);
    token[kept] = 0;
    *at = c + length;
    return length > 0;
}

/* ---- the preprocessor ---- */

static bool is_included(const scan *s)
{
    for (int i = 0; i < s->if_depth; i++)
        if (!s->ifs[i].is_taken)
            return false;
    return true;
}

static bool evaluate_or(scan *s, const char **at);

static bool evaluate_one(scan *s, const char **at)
{
    char token[MAX_NAME];
    if (!next_token(at, &s->line, true, token))
        return false;
    if (strcmp(token, "!") == 0)
        return !evaluate_one(s, at);
    if (strcmp(token, "(") == 0) {
        bool value = evaluate_or(s, at);
        next_token(at, &s->line, true, token);
        return value;
    }
    if (strcmp(token, "defined") != 0) {
        if (!is_digit(*token))
            complain(s, "#if knows numbers and defined(), not", token);
        return atoi(token) != 0;
    }
    next_token(at, &s->line, true, token);
    bool has_bracket = strcmp(token, "(") == 0;
    if (has_bracket)
        next_token(at, &s->line, true, token);
    bool value = find_macro(s, token) != NULL;
    if (has_bracket)
        next_token(at, &s->line, true, token);
    return value;
}

/* Two signs that stand together, or nothing is taken. */
static bool take_pair(const char **at, const char *pair)
{
    const char *c = *at + strspn(*at, " \t");
    if (strncmp(c, pair, 2) != 0)
        return false;
    *at = c + 2;
    return true;
}

static bool evaluate_and(scan *s, const char **at)
{
    bool value = evaluate_one(s, at);
    while (take_pair(at, "&&"))
        value = evaluate_one(s, at) && value;
    return value;
}

static bool evaluate_or(scan *s, const char **at)
{
    bool value = evaluate_and(s, at);
    while (take_pair(at, "||"))
        value = evaluate_and(s, at) || value;
    return value;
}

static void begin_if(scan *s, bool is_taken)
{
    if (s->if_depth == MAX_IFS) {
        complain(s, "too deep an", "#if");
        return;
    }
    s->ifs[s->if_depth].is_taken = s->ifs[s->if_depth].was_taken = is_taken;
    s->if_depth++;
}

static void begin_else(scan *s, bool is_taken)
{
    if (s->if_depth == 0) {
        complain(s, "there is no #if before", "#else");
        return;
    }
    s->ifs[s->if_depth - 1].is_taken = is_taken && !s->ifs[s->if_depth - 1].was_taken;
    s->ifs[s->if_depth - 1].was_taken |= is_taken;
}

static void define_macro(scan *s, const char *at)
{
    char token[MAX_NAME];
    next_token(&at, &s->line, true, token);
    if (s->macro_count == MAX_MACROS) {
        complain(s, "too many macros; the last is", token);
        return;
    }
    macro *m = &s->macros[s->macro_count++];
    snprintf(m->name.text, MAX_NAME, "%s", token);
    m->parameters = *at == '(' ? at : NULL;
    m->body = m->parameters ? at + strcspn(at, ")\n") : at;
}

static void read_directive(scan *s)
{
    char token[MAX_NAME], word[MAX_NAME];
    const char *at = s->at + 1;
    int line = s->line;
    next_token(&at, &line, true, token);
    const char *behind = at;
    next_token(&at, &line, true, word);
    if (strcmp(token, "ifdef") == 0)
        begin_if(s, find_macro(s, word) != NULL);
    else if (strcmp(token, "ifndef") == 0)
        begin_if(s, find_macro(s, word) == NULL);
    else if (strcmp(token, "if") == 0)
        begin_if(s, evaluate_or(s, &behind));
    else if (strcmp(token, "elif") == 0)
        begin_else(s, evaluate_or(s, &behind));
    else if (strcmp(token, "else") == 0)
        begin_else(s, true);
    else if (strcmp(token, "endif") == 0)
        s->if_depth -= s->if_depth > 0;
    else if (strcmp(token, "define") == 0 && is_included(s))
        define_macro(s, behind);
    else if (strcmp(token, "error") == 0 && is_included(s))
        complain(s, "the text says", "#error");
    else if (strcmp(token, "undef") == 0 && is_included(s))
        complain(s, "not understood:", "#undef");
    while (*s->at && *s->at != '\n')
        s->at += *s->at == '\\' && s->at[1] == '\n' ? (s->line++, 2) : 1;
}

/* The next token of the text that counts. */
static bool next(scan *s, char token[MAX_NAME])
{
    for (;;) {
        if (!next_token(&s->at, &s->line, false, token))
            return false;
        if (strcmp(token, "#") == 0) {
            s->at--;
            read_directive(s);
        } else if (is_included(s)) {
            return true;
        }
    }
}

static void peek(scan *s, char token[MAX_NAME])
{
    const char *at = s->at;
    int line = s->line;
    if (!next_token(&at, &line, false, token))
        *token = 0;
}

/* ---- what is used ---- */

static void check_use(scan *s, const char *word, const char *behind, int depth);

static bool is_parameter(const macro *m, const char *word)
{
    char token[MAX_NAME];
    const char *at = m->parameters;
    int line = 0;
    while (at && next_token(&at, &line, true, token) && strcmp(token, ")") != 0)
        if (is_letter(*token) && strcmp(token, word) == 0)
            return true;
    return false;
}

/* What a macro says is used where it stands. */
static void check_macro(scan *s, const macro *m, int depth)
{
    char token[MAX_NAME] = "", following[MAX_NAME], previous[MAX_NAME] = "";
    const char *at = m->body;
    int line = s->line;
    while (depth < MAX_BODY_DEPTH && next_token(&at, &line, true, token)) {
        const char *further = at;
        if (!next_token(&further, &line, true, following))
            *following = 0;
        if (is_letter(*token) && strcmp(previous, ".") != 0 && !is_parameter(m, token))
            check_use(s, token, is_parameter(m, following) ? "" : following, depth + 1);
        memcpy(previous, token, sizeof previous);
    }
}

/* A word that stands before another token. */
static void check_use(scan *s, const char *word, const char *behind, int depth)
{
    const macro *m = find_macro(s, word);
    if (m)
        check_macro(s, m, depth);
    else if (is_listed(keywords, word) || is_listed(qualifiers, word))
        return;
    else if (strcmp(behind, "(") == 0 && !is_type(s, word) && !is_function(s, word))
        complain(s, "not defined before it is called:", word);
    else if (is_letter(*behind) && !is_listed(keywords, behind) && !is_type(s, word))
        complain(s, "not defined before something is of its type:", word);
}

/* ---- the text ---- */

/* struct NAME or STRUCT(NAME): the name counts behind its bracket. */
static void read_struct(scan *s, bool is_macro, char defined[MAX_NAME])
{
    char token[MAX_NAME];
    if (is_macro)
        next(s, token);
    next(s, defined);
    if (is_macro)
        next(s, token);
}

/* A function's name stands behind its type, outside of all brackets. */
static bool is_definition(const scan *s, const char *previous, const char *behind, int depth)
{
    return depth == 0 && strcmp(behind, "(") == 0 && (is_type(s, previous) || is_listed(types, previous));
}

static void read_text(scan *s)
{
    char token[MAX_NAME] = "", behind[MAX_NAME], previous[MAX_NAME] = "", pending[MAX_NAME] = "";
    bool is_struct = false;
    int depth = 0, brackets = 0;
    while (!s->has_failed && next(s, token)) {
        peek(s, behind);
        bool is_macro_struct = strcmp(token, "STRUCT") == 0;
        if (is_macro_struct || strcmp(token, "struct") == 0) {
            read_struct(s, is_macro_struct, pending);
            is_struct = true;
        } else if (strcmp(token, "{") == 0) {
            depth++;
        } else if (strcmp(token, "}") == 0 || strcmp(token, ";") == 0) {
            depth -= *token == '}';
            if (depth == 0 && brackets == 0 && *pending) {
                if (is_struct)
                    define(s, s->types, &s->type_count, pending);
                else
                    define(s, s->functions, &s->function_count, pending);
                *pending = 0;
                is_struct = false;
            }
        } else if (*token == '(' || *token == ')') {
            brackets += *token == '(' ? 1 : -1;
        } else if (is_letter(*token) && strcmp(previous, ".") != 0) {
            if (brackets == 0 && !*pending && is_definition(s, previous, behind, depth))
                snprintf(pending, sizeof pending, "%s", token);
            else
                check_use(s, token, behind, 0);
        }
        memcpy(previous, token, sizeof previous);
    }
    if (!s->has_failed && (depth || brackets || s->if_depth))
        complain(s, "the text ends", "in the middle");
}

bool glsl_order_check(const char *text, char *complaint, size_t size)
{
    scan *s = calloc(1, sizeof *s);
    if (!s) {
        snprintf(complaint, size, "out of memory");
        return false;
    }
    s->at = text;
    s->line = 1;
    s->complaint = complaint;
    s->size = size;
    read_text(s);
    bool is_good = !s->has_failed;
    free(s);
    return is_good;
}
