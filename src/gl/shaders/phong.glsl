/* phong.glsl - image and material of OpenGL 1 (gl_phong.c), and the host of shade/compose/ogl1_light.h in both stages.
 * The eye space is that of shade/phong.h; values are those of the computation, encoded ones or linear light. */
layout(std140) uniform Ogl1
{
    vec4 ogl1_view[3];     /* rows: world to eye space, of the eye at w, m, for all views of an image */
    /* variant; 1: computed with encoded values; 1: colors are sRGB; number of lights, 0: punctual ones */
    ivec4 ogl1_modes;
    vec4 ogl1_ambient;     /* global; w: 1 rgl's colors */
    vec4 ogl1_fog_color;   /* w: mode */
    vec4 ogl1_fog;         /* near, far, m; scale; w */
    vec4 ogl1_lights[256]; /* four vectors each: position, 1: a point light; ambient; diffuse; specular */
};

layout(std140) uniform Material
{
    vec4 phong_ambient;  /* w: shininess */
    vec4 phong_diffuse;  /* w: opacity */
    vec4 phong_specular; /* w: type of the texture */
    vec4 phong_emission; /* w: its mode */
    /* 1: the texture is multiplied with all light; 1: halo; 1: fog; multiplier of bumps */
    vec4 phong_flags;
    /* three vectors each: rows of the transform, w: the set, 1: trilinear; base, gain, channel */
    vec4 phong_maps[21];
};

PhongFrame phong_frame()
{
    PhongFrame f;
    f.rules = phong_rules(ogl1_modes.x);
    f.rules.global_ambient = ogl1_ambient.xyz;
    f.fog.mode = int(ogl1_fog_color.w);
    f.fog.color = ogl1_fog_color.xyz;
    f.fog.near_m = ogl1_fog.x;
    f.fog.far_m = ogl1_fog.y;
    f.fog.scale = ogl1_fog.z;
    f.fog.w = ogl1_fog.w;
    f.is_encoded = ogl1_modes.y != 0;
    f.are_colors_srgb = ogl1_modes.z != 0;
    f.has_rgl_colors = ogl1_ambient.w > 0.0;
    return f;
}

PhongSurface phong_surface()
{
    PhongSurface s;
    s.material.ambient = phong_ambient.xyz;
    s.material.diffuse = phong_diffuse.xyz;
    s.material.specular = phong_specular.xyz;
    s.material.emission = phong_emission.xyz;
    s.material.shininess = phong_ambient.w;
    s.opacity = phong_diffuse.w;
    s.texture_type = int(phong_specular.w);
    s.texture_mode = int(phong_emission.w);
    s.has_texture_over_light = phong_flags.x > 0.0;
    s.is_halo = phong_flags.y > 0.0;
    s.has_fog = phong_flags.z > 0.0;
    return s;
}

/* ---- a point ---- */

struct Ogl1Host
{
    vec3 P;
    vec3 V;
    bool is_front;
    vec3 position; /* m, relative to the eye, world directions */
    vec3 N;        /* host_normal() */
    vec4 color;    /* of a vertex or interpolated, in the values of the computation */
};

/* A direction in eye space. */
vec3 to_eye_space(vec3 v)
{
    return vec3(dot(ogl1_view[0].xyz, v), dot(ogl1_view[1].xyz, v), dot(ogl1_view[2].xyz, v));
}

/* A point relative to the eye of the view. In a mirror the lights are where the image has them. */
vec3 point_in_eye_space(vec3 at)
{
    return to_eye_space(at + (eye.xyz - vec3(ogl1_view[0].w, ogl1_view[1].w, ogl1_view[2].w)));
}

Ogl1Host ogl1_host(vec3 position, vec3 N, vec4 color, bool is_front)
{
    vec3 axis = vec3(0.0, 0.0, 1.0);
    vec3 P = point_in_eye_space(position);
    vec3 V = eye.w > 0.5 ? axis : normalize_or(-P, axis);
    return Ogl1Host(P, V, is_front, position, N, color);
}

vec3 host_P(Ogl1Host host)
{
    return host.P;
}

vec3 host_V(Ogl1Host host)
{
    return host.V;
}

bool host_is_front(Ogl1Host host)
{
    return host.is_front;
}

PhongFrame host_frame(Ogl1Host host)
{
    return phong_frame();
}

PhongSurface host_surface(Ogl1Host host)
{
    return phong_surface();
}

vec3 host_normal(Ogl1Host host)
{
    return host.N;
}

bool host_has_vertex_colors(Ogl1Host host)
{
#ifdef HAS_COLORS
    return true;
#else
    return false;
#endif
}

PhongColor host_vertex_color(Ogl1Host host)
{
    return PhongColor(host.color.xyz, host.color.w);
}

/* ---- light ---- */

/* Legacy lights; if there are none, punctual ones. */
struct Ogl1Cursor
{
    int light;
    int count;
    bool has_light;
};

Ogl1Cursor host_first_ogl1_light(Ogl1Host host)
{
    int count = ogl1_modes.w;
#ifdef HAS_LIGHTS
    if (count == 0)
        count = light_count(host.position);
#endif
    return Ogl1Cursor(0, count, count > 0);
}

Ogl1Cursor host_next_ogl1_light(Ogl1Host host, Ogl1Cursor c)
{
    return Ogl1Cursor(c.light + 1, c.count, c.light + 1 < c.count);
}

PhongLight host_ogl1_light(Ogl1Host host, Ogl1Cursor c)
{
#ifdef HAS_LIGHTS
    if (ogl1_modes.w == 0) {
        LightSample light = light_illuminate(light_at(c.light), host.position);
        return phong_light_punctual(host_frame(host), light, to_eye_space(light.L));
    }
#endif
    vec4 position = ogl1_lights[4 * c.light];
    vec3 ambient = ogl1_lights[4 * c.light + 1].xyz;
    vec3 diffuse = ogl1_lights[4 * c.light + 2].xyz;
    vec3 specular = ogl1_lights[4 * c.light + 3].xyz;
    if (position.w > 0.0)
        return phong_light_point(position.xyz, ambient, diffuse, specular);
    return phong_light_directional(position.xyz, ambient, diffuse, specular);
}

bool host_separates_highlight(Ogl1Host host)
{
#ifdef HAS_DIFFUSE_MAP
    return true;
#else
    return false;
#endif
}
