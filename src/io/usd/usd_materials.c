/* usd_materials.c - materials as UsdPreviewSurface (Pixar, "UsdPreviewSurface Specification" 2.6) with textures
 * (UsdUVTexture), their transforms (UsdTransform2d) and sets of coordinates (UsdPrimvarReader_float2). */
#include "io/usd/usd_writer.h"

/* An input of the surface, and the texture and channels that it is read from. */
typedef struct input {
    const char *name, *type;
    scene_texture_slot slot;
    const char *output; /* "rgb", "r", .. */
    float value[3];
    size_t width;
    float bias[4];
    bool is_srgb;
} input;

static const char *wrap_name(scene_wrap wrap)
{
    return wrap == SCENE_WRAP_CLAMP ? "clamp" : wrap == SCENE_WRAP_MIRROR ? "mirror" : "repeat";
}

/* The path of the image that a slot reads; NULL: none. */
static const char *image_of(const usd_writer *w, const scene_material *m, scene_texture_slot slot)
{
    const uint32_t texture = m->textures[slot].texture;
    const uint32_t image = texture == SCENE_NONE ? SCENE_NONE : w->scene->textures[texture].image;
    return image == SCENE_NONE ? NULL : w->images[image];
}

/* Coordinates of the slot: those of the mesh, moved by the reference. glTF's v points down and USD's up, so that with
 * v = 1 - w the offset becomes (t1 + t2, 1 - t4 - t5) and the rotation keeps its sense. */
static void write_coordinates(usd_writer *w, uint32_t material, const scene_texture_ref *ref,
                              const char *name)
{
    text *t = &w->out;
    text_addf(t,
              "            def Shader \"%s_st\"\n            {\n"
              "                uniform token info:id = \"UsdPrimvarReader_float2\"\n"
              "                string inputs:varname = \"st",
              name);
    if (ref->texcoord)
        text_addf(t, "%u", ref->texcoord);
    text_add(t, "\"\n                float2 outputs:result\n            }\n");
    if (!ref->has_transform)
        return;
    const float offset[2] = {ref->transform[1] + ref->transform[2],
                             1.0f - ref->transform[4] - ref->transform[5]};
    text_addf(t,
              "            def Shader \"%s_transform\"\n            {\n"
              "                uniform token info:id = \"UsdTransform2d\"\n"
              "                float2 inputs:in.connect = "
              "</Root/Materials/Material_%u/%s_st.outputs:result>\n                float inputs:rotation = ",
              name, material, name);
    usd_float(w, ref->rotation_rad * 57.2957795f);
    text_add(t, "\n                float2 inputs:scale = ");
    usd_tuple(w, ref->scale, 2);
    text_add(t, "\n                float2 inputs:translation = ");
    usd_tuple(w, offset, 2);
    text_add(t, "\n                float2 outputs:result\n            }\n");
}

static void write_texture(usd_writer *w, uint32_t material, const scene_material *m, const input *in)
{
    text *t = &w->out;
    const scene_texture_ref *ref = &m->textures[in->slot];
    const scene_texture *texture = &w->scene->textures[ref->texture];
    const float factor[4] = {in->value[0], in->width == 3 ? in->value[1] : in->value[0],
                             in->width == 3 ? in->value[2] : in->value[0],
                             in->width == 3 ? 1.0f : in->value[0]};
    write_coordinates(w, material, ref, in->name);
    text_addf(
        t,
        "            def Shader \"%s_texture\"\n            {\n"
        "                uniform token info:id = \"UsdUVTexture\"\n"
        "                asset inputs:file = @%s@\n"
        "                float2 inputs:st.connect = </Root/Materials/Material_%u/%s_%s.outputs:result>\n"
        "                token inputs:sourceColorSpace = \"%s\"\n"
        "                token inputs:wrapS = \"%s\"\n                token inputs:wrapT = \"%s\"\n"
        "                float4 inputs:scale = ",
        in->name, image_of(w, m, in->slot), material, in->name, ref->has_transform ? "transform" : "st",
        in->is_srgb ? "sRGB" : "raw", wrap_name(texture->wrap_u), wrap_name(texture->wrap_v));
    usd_tuple(w, factor, 4);
    text_add(t, "\n                float4 inputs:bias = ");
    usd_tuple(w, in->bias, 4);
    text_addf(t, "\n                %s outputs:%s\n            }\n", in->width == 3 ? "float3" : "float",
              in->output);
}

static void write_inputs(usd_writer *w, uint32_t index, const scene_material *m, const input *inputs,
                         size_t count)
{
    text *t = &w->out;
    for (size_t i = 0; i < count; i++)
        if (image_of(w, m, inputs[i].slot))
            write_texture(w, index, m, &inputs[i]);
    text_add(t, "            def Shader \"Surface\"\n            {\n"
                "                uniform token info:id = \"UsdPreviewSurface\"\n");
    for (size_t i = 0; i < count; i++) {
        const input *in = &inputs[i];
        if (image_of(w, m, in->slot)) {
            text_addf(t,
                      "                %s inputs:%s.connect = "
                      "</Root/Materials/Material_%u/%s_texture.outputs:%s>\n",
                      in->type, in->name, index, in->name, in->output);
            continue;
        }
        if (in->slot == SCENE_NORMAL_TEXTURE || in->slot == SCENE_OCCLUSION_TEXTURE)
            continue; /* without a texture they are the surface's own */
        text_addf(t, "                %s inputs:%s = ", in->type, in->name);
        if (in->width == 3)
            usd_tuple(w, in->value, 3);
        else
            usd_float(w, in->value[0]);
        text_add(t, "\n");
    }
}

static void write_material(usd_writer *w, uint32_t index, const scene_material *m)
{
    const float e = m->emissive_strength, n = m->normal_scale, o = m->occlusion_strength;
    const bool has_opacity = m->alpha_mode != SCENE_ALPHA_OPAQUE;
    const input inputs[] = {
        {"diffuseColor",
         "color3f",
         SCENE_BASE_COLOR_TEXTURE,
         "rgb",
         {m->base_color[0], m->base_color[1], m->base_color[2]},
         3,
         {0},
         true},
        {"emissiveColor",
         "color3f",
         SCENE_EMISSIVE_TEXTURE,
         "rgb",
         {e * m->emissive[0], e * m->emissive[1], e * m->emissive[2]},
         3,
         {0},
         true},
        {"metallic", "float", SCENE_METALLIC_ROUGHNESS_TEXTURE, "b", {m->metallic}, 1, {0}, false},
        {"roughness",
         "float",
         SCENE_METALLIC_ROUGHNESS_TEXTURE,
         "g",
         {m->perceptual_roughness},
         1,
         {0},
         false},
        {"normal", "normal3f", SCENE_NORMAL_TEXTURE, "rgb", {2 * n, 2 * n, 2}, 3, {-n, -n, -1, 0}, false},
        {"occlusion", "float", SCENE_OCCLUSION_TEXTURE, "r", {o}, 1, {1 - o, 1 - o, 1 - o, 1 - o}, false},
        {"clearcoat", "float", SCENE_CLEARCOAT_TEXTURE, "r", {m->clearcoat}, 1, {0}, false},
        {"clearcoatRoughness",
         "float",
         SCENE_CLEARCOAT_ROUGHNESS_TEXTURE,
         "g",
         {m->clearcoat_roughness},
         1,
         {0},
         false},
        {"opacity", "float", SCENE_BASE_COLOR_TEXTURE, "a", {m->base_color[3]}, 1, {0}, true},
    };
    const size_t count = sizeof inputs / sizeof *inputs;
    const unsigned known = SCENE_EMISSIVE_STRENGTH | SCENE_IOR | SCENE_CLEARCOAT;
    text *t = &w->out;
    if (m->extensions & ~known)
        w->losses |= USD_LOST_LAYERS;
    text_addf(
        t,
        "        def Material \"Material_%u\"\n        {\n"
        "            token outputs:surface.connect = </Root/Materials/Material_%u/Surface.outputs:surface>\n",
        index, index);
    write_inputs(w, index, m, inputs, has_opacity ? count : count - 1);
    if (m->alpha_mode == SCENE_ALPHA_MASK) {
        text_add(t, "                float inputs:opacityThreshold = ");
        usd_float(w, m->alpha_cutoff);
        text_add(t, "\n");
    }
    text_add(t, "                float inputs:ior = ");
    usd_float(w, m->ior);
    text_add(t,
             "\n                int inputs:useSpecularWorkflow = 0\n                token outputs:surface\n"
             "            }\n        }\n");
}

void usd_write_materials(usd_writer *w)
{
    text_add(&w->out, "    def Scope \"Materials\"\n    {\n");
    for (uint32_t i = 0; i < w->scene->material_count; i++)
        write_material(w, i, &w->scene->materials[i]);
    text_add(&w->out, "    }\n");
}
