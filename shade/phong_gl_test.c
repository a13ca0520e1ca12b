/* phong_gl_test.c - phong.h against the pipeline that it describes: fixed-function OpenGL (Mesa's, without a
 * window), with random lights, sides, texture environments, separate highlights, fog and sphere maps. Exits
 * with 77 without a context of fixed-function OpenGL. */
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include "testing/test_support.h"

enum { SAMPLE_COUNT = 2000, MAP_SIZE = 256, LIGHT_COUNT = 2 };

/* Half the height of the triangle around a point, m: small against the distances of lighting. */
static const double EXTENT = 1e-5;

/* Drivers compute cos^s by log2 near 1, exact to some 1e-7 times s. */
static const double TOLERANCE = 5e-5;

/* ---- one sample ---- */

/* All inputs of a fragment. */
typedef struct setting {
    int variant;
    bool is_front;
    vec3 P, N; /* eye space */
    PhongMaterial material;
    PhongLight lights[LIGHT_COUNT];
    float opacity;
    int texture_type, texture_mode; /* -1: no texture */
    PhongColor texel;
    PhongFog fog;
} setting;

static float between(test_rng *rng, float low, float high)
{
    return low + (high - low) * rng_float(rng);
}

static float code(test_rng *rng)
{
    return (float)(rng_uint(rng) % 256u) / 255.0f;
}

static PhongLight random_light(test_rng *rng)
{
    vec3 ambient = rng_color(rng) * 0.3f, diffuse = rng_color(rng), specular = rng_color(rng);
    if (rng_float(rng) < 0.5f)
        return phong_light_directional(rng_direction(rng), ambient, diffuse, specular);
    vec3 position = vec3(between(rng, -5.0f, 5.0f), between(rng, -5.0f, 5.0f), between(rng, -10.0f, 3.0f));
    PhongLight l = phong_light_point(position, ambient, diffuse, specular);
    if (rng_float(rng) < 0.5f)
        l.attenuation = vec3(between(rng, 0.5f, 1.5f), between(rng, 0.0f, 0.3f), between(rng, 0.0f, 0.1f));
    if (rng_float(rng) < 0.5f) {
        l.spot_direction =
            normalize(vec3(between(rng, -4.0f, 4.0f), between(rng, -4.0f, 4.0f), -6.0f) - position);
        l.spot_cos = cos(between(rng, 0.3f, 1.4f));
        l.spot_exponent = between(rng, 0.0f, 20.0f);
    }
    return l;
}

static setting random_setting(test_rng *rng)
{
    setting s;
    s.variant = rng_float(rng) < 0.5f ? PHONG_FIXED : PHONG_RGL_DESKTOP;
    s.is_front = rng_float(rng) < 0.5f;
    s.P = vec3(between(rng, -3.0f, 3.0f), between(rng, -3.0f, 3.0f), between(rng, -8.0f, -2.0f));
    s.N = rng_direction(rng);
    s.material.ambient = rng_color(rng) * 0.5f;
    s.material.diffuse = rng_color(rng);
    s.material.specular = rng_color(rng);
    s.material.emission = rng_color(rng) * 0.2f;
    s.material.shininess = rng_float(rng) < 0.1f ? 0.0f : 128.0f * rng_float(rng) * rng_float(rng);
    s.opacity = rng_float(rng);
    for (int i = 0; i < LIGHT_COUNT; ++i)
        s.lights[i] = random_light(rng);
    s.texture_type = (int)(rng_uint(rng) % 6u) - 1;
    s.texture_mode = (int)(rng_uint(rng) % 5u);
    if (s.texture_mode == PHONG_DECAL && s.texture_type > PHONG_RGBA) /* undefined in OpenGL */
        s.texture_mode = PHONG_MODULATE;
    float grey = code(rng);
    s.texel.rgb = s.texture_type > PHONG_RGBA ? vec3(grey) : vec3(grey, code(rng), code(rng));
    s.texel.opacity = code(rng);
    s.fog.mode = (int)(rng_uint(rng) % 4u);
    s.fog.color = rng_color(rng);
    s.fog.near_m = between(rng, 1.0f, 3.0f);
    s.fog.far_m = between(rng, 6.0f, 12.0f);
    s.fog.scale = between(rng, 0.5f, 2.0f);
    s.fog.w = 1.0f / 3.0f;
    return s;
}

/* ---- by phong.h, in the order of src/cpu/ogl1_shade.c ---- */

/* Up to the color sum, which is not clamped yet. */
static PhongColor color_sum(const setting *s)
{
    PhongRules r = phong_rules(s->variant);
    vec3 V = normalize(-s->P), N = phong_normal(r, s->N, V, s->is_front);
    PhongLit lit = phong_unlit_part(r, s->material);
    for (int i = 0; i < LIGHT_COUNT; ++i)
        lit = phong_add(lit, phong_light_part(r, s->material, s->lights[i], s->P, N, V));
    if (s->texture_type < 0) {
        lit.color += lit.highlight;
        lit.highlight = vec3(0.0f);
    }
    PhongColor c = {clamp(lit.color, 0.0f, 1.0f), s->opacity};
    if (s->texture_type >= 0)
        c = phong_texture(s->texture_type, s->texture_mode, c, s->texel);
    c.rgb += clamp(lit.highlight, 0.0f, 1.0f);
    return c;
}

/* Cases where exponent 0 is not compared: 0^0 is undefined in OpenGL (Mesa: 0, phong_power(): 1), and Mesa's
 * special case for it has other attenuations. */
static bool is_exponent_0_open(const setting *s)
{
    PhongRules r = phong_rules(s->variant);
    vec3 V = normalize(-s->P), N = phong_normal(r, s->N, V, s->is_front);
    bool is_open = false;
    for (int i = 0; i < LIGHT_COUNT; ++i)
        is_open = is_open || s->lights[i].is_point ||
                  phong_NdotH(N, phong_view(r, V), phong_light_vector(s->lights[i], s->P)) <= 0.0f;
    return is_open && s->material.shininess <= 0.0f;
}

static PhongColor expected(const setting *s)
{
    PhongColor c = color_sum(s);
    c.rgb = phong_fogged(phong_rules(s->variant), s->fog, clamp(c.rgb, 0.0f, 1.0f), -s->P[2]);
    return c;
}

/* ---- by OpenGL ---- */

static void set_color(GLenum face, GLenum name, vec3 c, float opacity)
{
    const GLfloat v[4] = {c[0], c[1], c[2], opacity};
    glMaterialfv(face, name, v);
}

static void set_light(GLenum light, const PhongLight *l)
{
    const GLfloat ambient[4] = {l->ambient[0], l->ambient[1], l->ambient[2], 1.0f};
    const GLfloat diffuse[4] = {l->diffuse[0], l->diffuse[1], l->diffuse[2], 1.0f};
    const GLfloat specular[4] = {l->specular[0], l->specular[1], l->specular[2], 1.0f};
    const GLfloat position[4] = {l->position[0], l->position[1], l->position[2], l->is_point ? 1.0f : 0.0f};
    const GLfloat direction[3] = {l->spot_direction[0], l->spot_direction[1], l->spot_direction[2]};
    glLightfv(light, GL_AMBIENT, ambient);
    glLightfv(light, GL_DIFFUSE, diffuse);
    glLightfv(light, GL_SPECULAR, specular);
    glLightfv(light, GL_POSITION, position);
    glLightfv(light, GL_SPOT_DIRECTION, direction);
    glLightf(light, GL_SPOT_EXPONENT, l->spot_exponent);
    glLightf(light, GL_SPOT_CUTOFF, l->spot_cos <= -1.0f ? 180.0f : acosf(l->spot_cos) * (180.0f / PI));
    glLightf(light, GL_CONSTANT_ATTENUATION, l->attenuation[0]);
    glLightf(light, GL_LINEAR_ATTENUATION, l->attenuation[1]);
    glLightf(light, GL_QUADRATIC_ATTENUATION, l->attenuation[2]);
    glEnable(light);
}

static void set_lighting(const setting *s)
{
    bool is_rgl = s->variant == PHONG_RGL_DESKTOP;
    const GLfloat global = is_rgl ? 0.0f : 0.2f;
    const GLfloat ambient[4] = {global, global, global, 1.0f};
    glEnable(GL_LIGHTING);
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, ambient);
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, is_rgl);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, is_rgl);
    glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL,
                  s->texture_type >= 0 ? GL_SEPARATE_SPECULAR_COLOR : GL_SINGLE_COLOR);
    set_color(GL_FRONT_AND_BACK, GL_AMBIENT, s->material.ambient, 1.0f);
    set_color(GL_FRONT_AND_BACK, GL_DIFFUSE, s->material.diffuse, s->opacity);
    set_color(GL_FRONT_AND_BACK, GL_SPECULAR, s->material.specular, 1.0f);
    set_color(GL_FRONT_AND_BACK, GL_EMISSION, s->material.emission, 1.0f);
    glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, s->material.shininess);
    for (int i = 0; i < LIGHT_COUNT; ++i)
        set_light((GLenum)(GL_LIGHT0 + i), &s->lights[i]);
}

static void set_texture(const setting *s)
{
    static const GLint formats[5] = {GL_RGB8, GL_RGBA8, GL_ALPHA8, GL_LUMINANCE8, GL_LUMINANCE8_ALPHA8};
    static const GLint modes[5] = {GL_MODULATE, GL_REPLACE, GL_DECAL, GL_BLEND, GL_ADD};
    static const GLfloat black[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    if (s->texture_type < 0) {
        glDisable(GL_TEXTURE_2D);
        return;
    }
    bool is_alpha = s->texture_type == PHONG_ALPHA; /* rgl stores the mean of the colors there */
    const GLfloat texel[4] = {s->texel.rgb[0], s->texel.rgb[1], s->texel.rgb[2],
                              is_alpha ? s->texel.rgb[0] : s->texel.opacity};
    glEnable(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, formats[s->texture_type], 1, 1, 0, GL_RGBA, GL_FLOAT, texel);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, modes[s->texture_mode]);
    glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, black);
}

/* As in rgl's Background.cpp. */
static void set_fog(const PhongFog *f)
{
    static const GLint modes[4] = {0, GL_LINEAR, GL_EXP, GL_EXP2};
    const GLfloat color[4] = {f->color[0], f->color[1], f->color[2], 1.0f};
    if (f->mode == PHONG_FOG_NONE) {
        glDisable(GL_FOG);
        return;
    }
    glEnable(GL_FOG);
    glFogi(GL_FOG_MODE, modes[f->mode]);
    glFogfv(GL_FOG_COLOR, color);
    glFogf(GL_FOG_START, f->near_m);
    glFogf(GL_FOG_END, f->near_m + (f->far_m - f->near_m) / f->scale);
    glFogf(GL_FOG_DENSITY, f->scale / f->far_m);
}

/* A triangle around P that covers the image's one pixel. */
static void draw_at(vec3 P, vec3 N, bool is_front, float pixel[4])
{
    const double x = (double)P[0], y = (double)P[1];
    const float reach = 4.0f * (float)EXTENT;
    const float offsets[3][2] = {{-reach, -reach}, {reach, -reach}, {0.0f, reach}};
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(x - EXTENT, x + EXTENT, y - EXTENT, y + EXTENT, -100.0, 100.0);
    glBegin(GL_TRIANGLES);
    glNormal3f(N[0], N[1], N[2]);
    for (int i = 0; i < 3; ++i) {
        const float *offset = offsets[is_front ? i : 2 - i];
        glVertex3f(P[0] + offset[0], P[1] + offset[1], P[2]);
    }
    glEnd();
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, pixel);
}

/* ---- tests ---- */

static void test_fixed_functions(void **state)
{
    (void)state;
    test_rng rng = {2026};
    glDisable(GL_TEXTURE_GEN_S);
    glDisable(GL_TEXTURE_GEN_T);
    for (int i = 0; i < SAMPLE_COUNT; ++i) {
        setting s = random_setting(&rng);
        float pixel[4];
        if (is_exponent_0_open(&s))
            s.material.shininess = 1.0f;
        /* The sum is clamped before fog (OpenGL 2.1, 3.9); Mesa clamps after it only. */
        if (max3(color_sum(&s).rgb) > 1.0f)
            s.fog.mode = PHONG_FOG_NONE;
        set_lighting(&s);
        set_texture(&s);
        set_fog(&s.fog);
        draw_at(s.P, s.N, s.is_front, pixel);
        PhongColor c = expected(&s);
        for (int k = 0; k < 3; ++k)
            expect_near((double)pixel[k], (double)c.rgb[k], TOLERANCE,
                        "sample %d (variant %d, front %d, texture %d/%d, fog %d, s %g), channel %d", i,
                        s.variant, s.is_front, s.texture_type, s.texture_mode, s.fog.mode,
                        (double)s.material.shininess, k);
        expect_near((double)pixel[3], (double)c.opacity, TOLERANCE, "sample %d (texture %d/%d), opacity", i,
                    s.texture_type, s.texture_mode);
    }
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

/* A texture that holds its own coordinates, looked up through glTexGen. */
static void test_sphere_map(void **state)
{
    (void)state;
    static float texels[MAP_SIZE][MAP_SIZE][4];
    for (int y = 0; y < MAP_SIZE; ++y)
        for (int x = 0; x < MAP_SIZE; ++x) {
            texels[y][x][0] = ((float)x + 0.5f) / MAP_SIZE;
            texels[y][x][1] = ((float)y + 0.5f) / MAP_SIZE;
        }
    glDisable(GL_LIGHTING);
    glDisable(GL_FOG);
    glEnable(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, MAP_SIZE, MAP_SIZE, 0, GL_RGBA, GL_FLOAT, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glTexGeni(GL_S, GL_TEXTURE_GEN_MODE, GL_SPHERE_MAP);
    glTexGeni(GL_T, GL_TEXTURE_GEN_MODE, GL_SPHERE_MAP);
    glEnable(GL_TEXTURE_GEN_S);
    glEnable(GL_TEXTURE_GEN_T);
    test_rng rng = {5};
    for (int i = 0; i < 500; ++i) {
        vec3 P = vec3(between(&rng, -3.0f, 3.0f), between(&rng, -3.0f, 3.0f), between(&rng, -8.0f, -2.0f));
        vec3 N = rng_direction(&rng);
        vec2 uv = phong_sphere_map(N, normalize(-P));
        float pixel[4];
        vec3 r = reflect(normalize(P), N);
        if (r[2] < -0.95f) /* near the rim the smallest triangle spans the map */
            continue;
        draw_at(P, N, true, pixel);
        expect_near((double)pixel[0], (double)uv[0], 1e-4, "u of sample %d", i);
        expect_near((double)pixel[1], (double)uv[1], 1e-4, "v of sample %d", i);
    }
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

/* ---- the context ---- */

static bool create_context(void)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!extensions || !strstr(extensions, "EGL_MESA_platform_surfaceless"))
        return false;
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API))
        return false;
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

/* One pixel of floats; colors clamped where OpenGL 1 clamped them. */
static bool create_target(void)
{
    GLuint texture, target;
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 1, 1, 0, GL_RGBA, GL_FLOAT, NULL);
    GLuint framebuffer;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glViewport(0, 0, 1, 1);
    glClampColor(GL_CLAMP_VERTEX_COLOR, GL_TRUE);
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

int main(void)
{
    if (!create_context() || !create_target()) {
        printf("0 passed, 0 failed, 2 skipped: no OpenGL with fixed functions without a window\n");
        return 77;
    }
    printf("%s\n", (const char *)glGetString(GL_RENDERER));
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fixed_functions),
                                       cmocka_unit_test(test_sphere_map)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
