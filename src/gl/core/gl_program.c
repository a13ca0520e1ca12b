/* gl_program.c - see gl_program.h. */
#include "gl/core/gl_program.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_blocks.h"

/* Texture units of samplers. */
static const struct {
    const char *name;
    int unit;
} samplers[] = {{"u_environment", GL_UNIT_ENVIRONMENT},
                {"u_sharp", GL_UNIT_SHARP},
                {"u_tables", GL_UNIT_TABLES},
                {"u_glass", GL_UNIT_GLASS},
                {"u_lights", GL_UNIT_LIGHTS},
                {"u_shadows", GL_UNIT_SHADOWS},
                {"u_opaque", GL_UNIT_OPAQUE},
                {"u_level", GL_UNIT_OPAQUE},
                {"u_rays", GL_UNIT_RAYS},
                {"u_traced", GL_UNIT_RAYS},
                {"u_image", 0},
                {"u_heights", GL_UNIT_MATERIAL},
                {"u_ground", GL_UNIT_MATERIAL},
                {"u_sum", GL_UNIT_MATERIAL},
                {"u_weights", GL_UNIT_MATERIAL + 1},
                {"u_peeled", GL_UNIT_PEELED},
                {"u_sea_low", GL_UNIT_SEA_LOW},
                {"u_sea_high", GL_UNIT_SEA_HIGH},
                {"u_sea_foam", GL_UNIT_SEA_FOAM},
                {"u_sea_patches", GL_UNIT_SEA_PATCHES},
                {"u_sea_sky", GL_UNIT_SEA_SKY},
                {"u_sea_lobes", GL_UNIT_SEA_LOBES},
                {"u_sea_means", GL_UNIT_SEA_MEANS},
                {"u_sea_model", GL_UNIT_SEA_MODEL},
                {"u_sea_model_depth", GL_UNIT_SEA_MODEL_DEPTH},
                {"u_sea_mirrored", GL_UNIT_SEA_MIRRORED},
                {"u_sea_mirrored_depth", GL_UNIT_SEA_MIRRORED_DEPTH},
                {"u_sea_window", GL_UNIT_SEA_WINDOW},
                {"u_sea_window_depth", GL_UNIT_SEA_WINDOW_DEPTH},
                {"u_sea_model_normal", GL_UNIT_SEA_MODEL_NORMAL},
                {"u_sea_model_albedo", GL_UNIT_SEA_MODEL_ALBEDO},
                {"u_sea_model_number", GL_UNIT_SEA_MODEL_NUMBER},
                {"u_sea_contact", GL_UNIT_SEA_CONTACT},
                {"u_sea_grid", GL_UNIT_SEA_GRID},
                {"u_sea_rest", GL_UNIT_SEA_SEEN},
                {"u_sea_seen", GL_UNIT_SEA_SEEN},
                {"u_sea_caustics", GL_UNIT_SEA_CAUSTICS},
                {"u_material0", GL_UNIT_MATERIAL},
                {"u_material1", GL_UNIT_MATERIAL + 1},
                {"u_material2", GL_UNIT_MATERIAL + 2},
                {"u_material3", GL_UNIT_MATERIAL + 3},
                {"u_material4", GL_UNIT_MATERIAL + 4},
                {"u_material5", GL_UNIT_MATERIAL + 5},
                {"u_material6", GL_UNIT_MATERIAL + 6},
                {"u_material7", GL_UNIT_MATERIAL + 7},
                {"u_material8", GL_UNIT_MATERIAL + 8}};

static const char *const attributes[GL_ATTRIBUTE_COUNT] = {
    "position",  "normal",         "tangent",        "color",          "texcoord0",
    "texcoord1", "texcoord2",      "texcoord3",      "world0",         "world1",
    "world2",    "normal_matrix0", "normal_matrix1", "normal_matrix2", "instance"};
/* Attributes of sprites in the same locations. */
static const char *const sprite_attributes[GL_ATTRIBUTE_COUNT] = {
    [GL_ATTRIBUTE_TANGENT] = "position_end",
    [GL_ATTRIBUTE_NORMAL_MATRIX] = "normal_end",
    [GL_ATTRIBUTE_NORMAL_MATRIX + 1] = "color_end",
    [GL_ATTRIBUTE_TEXCOORD + 2] = "texcoord0_end",
    [GL_ATTRIBUTE_TEXCOORD + 3] = "texcoord1_end"};

/* ---- programs ---- */

typedef struct gl_program {
    gl_program_key key;
    GLuint name, shaders[2];
    bool is_linked;
} gl_program;

struct gl_programs {
    gl_context *context;
    facet_allocator allocator;
    facet_log log;
    const char *prelude;
    gl_program *items;
    size_t count, capacity;
};

facet_result gl_programs_create(gl_context *context, const facet_allocator *allocator, const facet_log *log,
                                gl_programs **out, facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "programs", sizeof **out);
    (*out)->context = context;
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    gl_programs_set_log(*out, log);
    if (context->has_parallel_compile)
        gl_api_compile_in_parallel();
    return FACET_OK;
}

void gl_programs_set_log(gl_programs *programs, const facet_log *log)
{
    programs->log = log ? *log : (facet_log){0};
}

void gl_programs_set_prelude(gl_programs *programs, const char *prelude)
{
    programs->prelude = prelude;
}

/* Only when nothing asks for their messages anymore: a browser forgets a shader at once. The program keeps them. */
static void delete_shaders(gl_program *p)
{
    for (int i = 0; i < 2; i++)
        glDeleteShader(p->shaders[i]);
    p->shaders[0] = p->shaders[1] = 0;
}

static void delete_program(gl_program *p)
{
    delete_shaders(p);
    glDeleteProgram(p->name);
}

void gl_programs_destroy(gl_programs *programs)
{
    if (!programs)
        return;
    if (programs->count > 0)
        glUseProgram(0); /* a program in use would not be deleted */
    for (size_t i = 0; i < programs->count; i++)
        delete_program(&programs->items[i]);
    mem_free(programs->items);
    mem_free(programs);
}

static gl_program *find(gl_programs *programs, gl_program_key key)
{
    for (size_t i = 0; i < programs->count; i++)
        if (programs->items[i].key.main == key.main && programs->items[i].key.features == key.features)
            return &programs->items[i];
    return NULL;
}

/* Shader source with the prelude inserted after its #version line. */
static facet_result source_text(const gl_programs *programs, gl_program_key key, GLenum stage, text *out,
                                facet_error *error)
{
    facet_result result = gl_program_text(programs->context->glsl_version, key, stage, out, error);
    if (result != FACET_OK || !programs->prelude)
        return result;
    text whole = {.allocator = programs->allocator};
    size_t version = strcspn(out->data, "\n") + 1;
    text_add_bytes(&whole, out->data, version);
    text_add(&whole, programs->prelude);
    text_add(&whole, out->data + version);
    text_destroy(out);
    *out = whole;
    return out->has_failed ? fail_memory(error, "shader", out->length) : FACET_OK;
}

facet_result gl_programs_request(gl_programs *programs, gl_program_key key, facet_error *error)
{
    static const GLenum stages[2] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
    if (find(programs, key))
        return FACET_OK;
    if (!mem_reserve(&programs->allocator, (void **)&programs->items, &programs->capacity,
                     programs->count + 1, sizeof *programs->items))
        return fail_memory(error, "programs", (programs->count + 1) * sizeof *programs->items);
    gl_program *p = &programs->items[programs->count];
    *p = (gl_program){.key = key, .name = glCreateProgram()};
    facet_result result = FACET_OK;
    for (int i = 0; i < 2 && result == FACET_OK; i++) {
        text t = {.allocator = programs->allocator};
        result = source_text(programs, key, stages[i], &t, error);
        if (result == FACET_OK) {
            p->shaders[i] = glCreateShader(stages[i]);
            const char *source = t.data;
            glShaderSource(p->shaders[i], 1, &source, NULL);
            glCompileShader(p->shaders[i]);
            glAttachShader(p->name, p->shaders[i]);
        }
        text_destroy(&t);
    }
    for (GLuint i = 0; i < GL_ATTRIBUTE_COUNT; i++)
        glBindAttribLocation(p->name, i, attributes[i]);
    for (GLuint i = 0; i < GL_ATTRIBUTE_COUNT; i++)
        if (sprite_attributes[i])
            glBindAttribLocation(p->name, i, sprite_attributes[i]);
    glLinkProgram(p->name);
    programs->count += result == FACET_OK;
    if (result != FACET_OK)
        delete_program(p);
    return result;
}

/* Logs the source with line numbers, so that the line of a compiler error can be found. */
static void report_source(const gl_programs *programs, const char *source)
{
    char line[320];
    int number = 1;
    for (const char *at = source; *at && programs->log.message; number++) {
        int length = (int)strcspn(at, "\n");
        snprintf(line, sizeof line, "%4d  %.*s", number, length < 300 ? length : 300, at);
        programs->log.message(programs->log.user, FACET_LOG_LEVEL_WARNING, line);
        at += length + (at[length] == '\n');
    }
}

static facet_result fail_link(gl_programs *programs, const gl_program *p, facet_error *error)
{
    static const GLenum stages[2] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
    char message[512] = "";
    for (int i = 0; i < 2 && !message[0]; i++) {
        GLint is_compiled = 0;
        glGetShaderiv(p->shaders[i], GL_COMPILE_STATUS, &is_compiled);
        if (is_compiled)
            continue;
        glGetShaderInfoLog(p->shaders[i], sizeof message, NULL, message);
        text t = {.allocator = programs->allocator};
        if (source_text(programs, p->key, stages[i], &t, NULL) == FACET_OK)
            report_source(programs, t.data);
        text_destroy(&t);
    }
    if (!message[0])
        glGetProgramInfoLog(p->name, sizeof message, NULL, message);
    message[strcspn(message, "\n")] = 0;
    return fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): the shader \"%s\" does not compile: %.300s",
                programs->context->name, gl_program_main_name(p->key.main), message);
}

static void bind_names(const gl_program *p)
{
    static const char *const blocks[GL_BLOCK_COUNT] = {"Frame", "Material", "Lighting", "Ogl1", "Sea"};
    for (GLuint i = 0; i < GL_BLOCK_COUNT; i++) {
        GLuint index = glGetUniformBlockIndex(p->name, blocks[i]);
        if (index != GL_INVALID_INDEX)
            glUniformBlockBinding(p->name, index, i);
    }
    glUseProgram(p->name);
    for (size_t i = 0; i < sizeof samplers / sizeof *samplers; i++) {
        GLint location = glGetUniformLocation(p->name, samplers[i].name);
        if (location >= 0)
            glUniform1i(location, samplers[i].unit);
    }
}

bool gl_programs_is_ready(gl_programs *programs, gl_program_key key)
{
    const gl_program *p = find(programs, key);
    GLint is_complete = 1;
    if (p && !p->is_linked && programs->context->has_parallel_compile)
        glGetProgramiv(p->name, GL_COMPLETION_STATUS_KHR, &is_complete);
    return is_complete != 0;
}

facet_result gl_programs_get(gl_programs *programs, gl_program_key key, uint32_t *name, facet_error *error)
{
    TRY(gl_programs_request(programs, key, error));
    gl_program *p = find(programs, key);
    if (!p->is_linked) {
        GLint is_linked = 0;
        glGetProgramiv(p->name, GL_LINK_STATUS, &is_linked);
        if (!is_linked)
            return fail_link(programs, p, error);
        bind_names(p);
        delete_shaders(p);
        p->is_linked = true;
    }
    *name = p->name;
    return FACET_OK;
}
