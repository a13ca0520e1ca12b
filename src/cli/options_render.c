/* options_render.c - facet render. See options_table.h. */
#include "cli/options_table.h"

static const option image_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text = "the model's name with .png, in the current folder",
     .help = "the picture: .png .jpg .webp .exr .hdr .pfm, .y4m for a video, or - for standard output. "
             "{stem} becomes the model's "
             "name, {name} that with its extension, {dir} its folder, {index} its number, #### or %04d the "
             "frame's "
             "number; missing folders are made"},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep a picture that exists already, and say so (exit 0)"},
    {.id = OPT_FORMAT,
     .name = "format",
     .kind = OPTION_CHOICE,
     .argument = "FORMAT",
     .default_text = "by the name of the output",
     .help =
         "png16 has 16 bits a channel; exr is half, exr32 full float; y4m and raw (RGBA of 8 bits) hold all "
         "frames one after the other, for programs that make videos",
     .choices = WORDS("png", "png16", "jpg", "webp", "exr", "exr32", "hdr", "pfm", "y4m", "raw")},
    {.id = OPT_SIZE,
     .name = "size",
     .letter = 's',
     .kind = OPTION_TEXT,
     .argument = "WxH",
     .default_text = "1024x768",
     .help = "width and height in pixels; one number for a square"},
    {.id = OPT_BACKGROUND,
     .name = "background",
     .kind = OPTION_TEXT,
     .argument = "WHAT",
     .default_text = "white",
     .help = "transparent, env (the environment), or a color: #rgb, #rrggbb, a CSS name",
     .choices = WORDS("transparent", "env", "white", "black")},
    {.id = OPT_BACKGROUND_BLUR,
     .name = "background-blur",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "0",
     .help = "how blurred the environment is as background, 0 to 1",
     .minimum = 0,
     .maximum = 1},
    {.id = OPT_CROP,
     .name = "crop",
     .kind = OPTION_TEXT,
     .argument = "X,Y,W,H",
     .help = "draw only this part of the picture, in pixels from its top left"},
    {.id = OPT_AOV,
     .name = "aov",
     .kind = OPTION_CHOICES,
     .argument = "LIST",
     .help = "further layers of an .exr file, separated by commas, or all that the renderer has: material, "
             "object "
             "(node) and instance are numbers from 1; cryptomatte is crypto-object, -material and -instance: "
             "names "
             "with the share of each pixel that they cover, for compositing; one of object, material and "
             "instance into a "
             ".png: false color in place of the image; variance and samples with "
             "--renderer "
             "path only",
     .choices =
         WORDS("all", "depth", "normal", "albedo", "material", "object", "instance", "uv", "occlusion",
               "variance", "samples", "cryptomatte", "crypto-object", "crypto-material", "crypto-instance")},
    {.id = OPT_JPEG_QUALITY,
     .name = "jpeg-quality",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "92",
     .help = "1 to 100, for .jpg and .webp; .webp is lossless at 100",
     .minimum = 1,
     .maximum = 100},
    {.id = OPT_PNG_COMPRESSION,
     .name = "png-compression",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "4",
     .help = "1 (fast) to 9 (small)",
     .minimum = 1,
     .maximum = 9},
};

static const option camera_options[] = {
    {.id = OPT_ORBIT,
     .name = "orbit",
     .kind = OPTION_TEXT,
     .argument = "AZ,POLAR,RADIUS",
     .default_text = "0,75,105%",
     .help = "as model-viewer's camera-orbit: degrees around the model (0: in front), degrees from straight "
             "above, "
             "and distance in % of what frames the model or in m; also \"0deg 75deg 105%\", rad, cm, auto"},
    {.id = OPT_TARGET,
     .name = "target",
     .kind = OPTION_TEXT,
     .argument = "X,Y,Z",
     .default_text = "auto",
     .help = "the point to look at, m; auto: the middle of the model"},
    {.id = OPT_FOV,
     .name = "fov",
     .kind = OPTION_TEXT,
     .argument = "DEG",
     .default_text = "30",
     .help = "vertical field of view"},
    {.id = OPT_EYE,
     .name = "eye",
     .kind = OPTION_TEXT,
     .argument = "X,Y,Z",
     .help = "where the camera stands, m, instead of --orbit"},
    {.id = OPT_UP,
     .name = "up",
     .kind = OPTION_CHOICE,
     .argument = "AXIS",
     .default_text = "y",
     .help = "the model's upward axis; z for models from CAD and Blender that were not converted",
     .choices = WORDS("y", "z")},
    {.id = OPT_ORTHO, .name = "ortho", .kind = OPTION_FLAG, .help = "parallel projection"},
    {.id = OPT_FRAMING,
     .name = "framing",
     .kind = OPTION_CHOICE,
     .argument = "WHAT",
     .default_text = "dense",
     .help =
         "what the camera's distance and the middle are found for. dense: the model without few parts that "
         "lie so "
         "far away that the rest would be a dot, which a warning reports; all: everything that can be seen",
     .choices = WORDS("dense", "all")},
    {.id = OPT_CAMERA,
     .name = "camera",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .help = "a camera of the file, by name or number from 0, instead of all these"},
    {.id = OPT_TURNTABLE,
     .name = "turntable",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .help =
         "N pictures once around the model, which moves meanwhile if --animation is given; an output that is "
         "named needs #### or %04d",
     .minimum = 1,
     .maximum = 100000},
    {.id = OPT_CAMERA_MATRIX,
     .name = "camera-matrix",
     .kind = OPTION_TEXT,
     .argument = "M0,..,M15",
     .help = "the camera as another renderer has it, instead of all these but --fov: 16 numbers, column by "
             "column, as "
             "the matrix of a glTF node; it looks along its -Z axis, +Y is up in the image"},
    {.id = OPT_VIEW_MATRIX,
     .name = "view-matrix",
     .kind = OPTION_TEXT,
     .argument = "M0,..,M15",
     .help = "the inverse of that, from the world to the camera, as OpenGL programs have it"},
};

static const option light_options[] = {
    {.id = OPT_ENV,
     .name = "env",
     .letter = 'e',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text = "neutral",
     .help = "what lights the model: a picture (.hdr, .exr, .png, .jpg ..: equirectangular, or a cube map as "
             "cross, strip or "
             "six files NAME{face}.hdr) or a .ktx2, neutral (a built-in studio), white or #rrggbb (the same "
             "from everywhere), "
             "none, a clear sky sun:ELEVATION,AZIMUTH (degrees, elevation first; preetham:.. by another "
             "formula), "
             "constant:COLOR, gradient:ZENITH,HORIZON. Skies are exposed for a camera; see "
             "environments.md of facet help documents",
     .choices = WORDS("neutral", "white", "none")},
    {.id = OPT_LIGHTS,
     .name = "lights",
     .kind = OPTION_CHOICE,
     .argument = "WHICH",
     .default_text = "scene",
     .help = "the file's own lights (KHR_lights_punctual, and EXT_lights_image_based unless --env is given), "
             "or none "
             "of them",
     .choices = WORDS("scene", "none")},
    {.id = OPT_SUN,
     .name = "sun",
     .kind = OPTION_TEXT,
     .argument = "AZ,EL,LUX",
     .default_text = "none; LUX 3.14, as a white sky",
     .help = "a sun: degrees around the model as --orbit's, degrees above the horizon, illuminance of what "
             "faces it; "
             "a fourth number is its diameter in degrees (0.53)"},
    {.id = OPT_GROUND,
     .name = "ground",
     .kind = OPTION_CHOICE,
     .argument = "WHAT",
     .default_text = "none",
     .help = "shadow: the model casts a shadow on a plane below it that is not seen itself; needs --renderer "
             "path, or gl, where it is a soft one of what is near the ground",
     .choices = WORDS("none", "shadow")},
};

static const option color_options[] = {
    {.id = OPT_EXPOSURE,
     .name = "exposure",
     .kind = OPTION_TEXT,
     .argument = "STOPS",
     .default_text = "0",
     .help = "+1 is twice as bright; 2x is the factor 2, which exposure=\"2\" of model-viewer means; auto "
             "meters what is "
             "seen, as a camera does, with the same result for every renderer and one for all frames; auto+1 "
             "is a stop "
             "brighter"},
    {.id = OPT_TONE_MAPPING,
     .name = "tone-mapping",
     .kind = OPTION_CHOICE,
     .argument = "OPERATOR",
     .default_text = "neutral; none for exr, hdr and pfm",
     .help = "how bright light becomes display color; neutral is Khronos PBR Neutral",
     .choices =
         WORDS("neutral", "aces", "aces-narkowicz", "agx", "reinhard", "reinhard-extended", "hable", "none")},
};

static const option quality_options[] = {
    {.id = OPT_QUALITY,
     .name = "quality",
     .kind = OPTION_CHOICE,
     .argument = "LEVEL",
     .default_text = "normal",
     .help = "draft takes 1, normal 4, final 16 samples per pixel; with --renderer path 16, 64, 512",
     .choices = WORDS("draft", "normal", "final")},
    {.id = OPT_SAMPLES,
     .name = "samples",
     .letter = 'n',
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "as --quality says",
     .help = "samples per pixel, of the preview at most 4096",
     .minimum = 1,
     .maximum = 16777216},
    {.id = OPT_RENDERER,
     .name = "renderer",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .default_text = "preview",
     .help = "preview: prefiltered light, what real-time viewers show; path: path tracing, with shadows, "
             "reflections and glass as light makes them; gl: the preview, drawn with OpenGL on a GPU or "
             "without one",
     .choices = WORDS("preview", "path", "gl")},
    {.id = OPT_ENERGY,
     .name = "energy",
     .kind = OPTION_CHOICE,
     .argument = "MODE",
     .default_text = "gltf; conserving with --renderer path",
     .help =
         "gltf: the formulas of the specification; conserving: with light scattered several times on rough "
         "surfaces",
     .choices = WORDS("gltf", "conserving")},
    {.id = OPT_ISA,
     .name = "isa",
     .kind = OPTION_CHOICE,
     .argument = "SET",
     .default_text = "portable",
     .help =
         "instruction set that intersects rays: portable gives the same bytes on every x86-64 processor of a "
         "maker; native is the widest, a tenth to a fifth quicker; others fail where the processor lacks "
         "them",
     .choices = WORDS("portable", "native", "sse2", "sse4.2", "avx", "avx2", "avx512")},
    {.id = OPT_SPECULAR_AA,
     .name = "specular-aa",
     .kind = OPTION_FLAG,
     .help =
         "fewer sparkles on fine bumps: highlights are widened by how much the surface bends within a pixel"},
};

static const option shading_options[] = {
    {.id = OPT_SHADING,
     .name = "shading",
     .kind = OPTION_CHOICE,
     .argument = "MODEL",
     .default_text = "gltf",
     .help = "gltf: physically based; ogl1: as OpenGL 1 programs drew it (Blinn-Phong, the old lights, no "
             "environment, no tone mapping)",
     .choices = WORDS("gltf", "ogl1")},
    {.id = OPT_OGL1_VARIANT,
     .name = "ogl1-variant",
     .kind = OPTION_CHOICE,
     .argument = "NAME",
     .default_text = "vignette",
     .help = "vignette: light per pixel, both sides lit; webgl: rgl's present shader; fixed: fixed-function "
             "OpenGL, light at the vertices; rgl-desktop: the same as rgl's windows set it up",
     .choices = WORDS("vignette", "webgl", "fixed", "rgl-desktop")},
    {.id = OPT_OGL1_SPACE,
     .name = "ogl1-space",
     .kind = OPTION_CHOICE,
     .argument = "SPACE",
     .default_text = "display",
     .help = "display: adds light in the screen's numbers, as then; linear: adds light as light",
     .choices = WORDS("display", "linear")},
    {.id = OPT_FOG,
     .name = "fog",
     .kind = OPTION_CHOICE,
     .argument = "WHICH",
     .default_text = "scene",
     .help = "with --shading ogl1: the fog of the parameters, or none",
     .choices = WORDS("scene", "none")},
};

static const option motion_options[] = {
    {.id = OPT_ANIMATION,
     .name = "animation",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .default_text = "none; the first with --time, --frames or --fps",
     .help =
         "which animation of the file, by name or number from 0; all at once; none. Without --time all its "
         "frames are drawn, and an output that is named needs #### or %04d",
     .choices = WORDS("all", "none")},
    {.id = OPT_TIME,
     .name = "time",
     .kind = OPTION_NUMBER,
     .argument = "S",
     .help = "one picture, of the animation at this time in s",
     .minimum = -1e9,
     .maximum = 1e9},
    {.id = OPT_FRAMES,
     .name = "frames",
     .kind = OPTION_TEXT,
     .argument = "LIST",
     .default_text = "all",
     .help = "which frames, from 1: 1-48, 1-48x2, 1,3,5..10; frame n is (n - 1) / fps after the begin"},
    {.id = OPT_FPS,
     .name = "fps",
     .kind = OPTION_NUMBER,
     .argument = "N",
     .default_text = "24",
     .help = "frames per second",
     .minimum = 0.001,
     .maximum = 1e5},
};

static const option scene_options[] = {
    {.id = OPT_SCENE,
     .name = "scene",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .default_text = "the one that the file names",
     .help = "which scene of the file, by name or number from 0"},
    {.id = OPT_VARIANT,
     .name = "variant",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .help = "which variant of the materials (KHR_materials_variants), by name or number from 0"},
};

static const option_group image_group = {"Picture", image_options, COUNT(image_options)};
static const option_group camera_group = {"Camera", camera_options, COUNT(camera_options)};
const option_group light_group = {"Light", light_options, COUNT(light_options)};
const option_group color_group = {"Color", color_options, COUNT(color_options)};
const option_group shading_group = {"Shading", shading_options, COUNT(shading_options)};
const option_group quality_group = {"Quality", quality_options, COUNT(quality_options)};
static const option_group motion_group = {"Motion", motion_options, COUNT(motion_options)};
const option_group scene_group = {"Scene", scene_options, COUNT(scene_options)};

/* Of facet view: --size, --background, --background-blur; not --turntable and what is after it; --animation, --time. */
const option_group window_group = {"Window", image_options + 3, 3};
const option_group window_camera_group = {"Camera", camera_options, COUNT(camera_options) - 3};
const option_group window_motion_group = {"Motion", motion_options, 2};

const verb render_verb = {
    .name = "render",
    .summary = "draw a model to a picture",
    .arguments = "[MODEL|FOLDER...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "png png16 jpg jpeg webp exr hdr pfm y4m",
    .description =
        "Reads each MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - is "
        "standard input) and draws it on the CPU, or with --renderer gl on a GPU: no GPU, "
        "display or network "
        "is needed. The whole model is in the picture unless --orbit, --eye or --camera say "
        "otherwise. A FOLDER stands for the models in it and below it. Without a "
        "MODEL the built-in scene is drawn.\n\n"
        "The output appears whole or not at all. The same command gives the same bytes for every "
        "number of threads.",
    .examples =
        (const example[]){
            {"facet render helmet.glb -o helmet.png", "the whole model, on white"},
            {"facet render helmet.glb -o helmet.png --size 1920x1080 --env studio.hdr --background "
             "transparent",
             "larger, under a light of your own, to put over something else"},
            {"facet render shoe.glb -o shoe.png --orbit 30,75,105% --exposure +0.5 --tone-mapping agx",
             "from the right, a little brighter"},
            {"facet render scene.gltf -o beauty.exr --aov depth,normal --camera Hero",
             "linear light and layers from a camera of the file"},
            {"facet render shoe.glb -o 'turn_####.png' --turntable 72", "once around the model"},
            {"facet render walk.glb -o 'walk_####.png' --animation Walk", "the frames of an animation"},
            {"facet render fox.glb -o - --format y4m --animation Run | ffmpeg -i - -pix_fmt yuv420p fox.mp4",
             "a video; with --turntable 120 seen from all around"},
            {"facet render *.glb -o 'thumbs/{stem}.png' --preset thumbnail", "small pictures of many models"},
            {"facet render models/ -o 'thumbs/{dir}/{stem}.png' --size 256",
             "of all models in a folder and below it, in the same folders"},
            {"facet render ring.glb -o ring.png --renderer path --samples 256 --ground shadow --denoise",
             "path traced, with its shadow"},
            {"facet render shoe.glb -o 'turn_####.png' --turntable 360 --renderer gl",
             "the same picture, on a GPU"},
            {"facet render old.obj -o old.png --shading ogl1", "as an OpenGL 1 program showed it"},
            {"curl -sL URL | facet render - -o - --format png > out.png", "without files"},
            {NULL, NULL}},
    .basics =
        (const option_id[]){OPT_OUTPUT, OPT_SIZE, OPT_BACKGROUND, OPT_ORBIT, OPT_CAMERA, OPT_TURNTABLE,
                            OPT_ANIMATION, OPT_ENV, OPT_SUN, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_RENDERER,
                            OPT_SAMPLES, OPT_DENOISE, OPT_GROUND, OPT_TIME_LIMIT, OPT_JSON, OPTION_ID_COUNT},
    .groups =
        (const option_group *const[]){&image_group, &camera_group, &light_group, &environment_group,
                                      &color_group, &quality_group, &path_group, &gl_group, &shading_group,
                                      &motion_group, &scene_group, &model_group, &legacy_group,
                                      &machine_group, &message_group, &running_group, NULL},
};
