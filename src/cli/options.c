/* options.c - the verbs and options of this version. */
#include "cli/options.h"

#include <stdint.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define WORDS(...)                                                                                           \
    (const char *const[])                                                                                    \
    {                                                                                                        \
        __VA_ARGS__, NULL                                                                                    \
    }

/* ---- options that verbs share ---- */

static const option machine_options[] = {
    {.id = OPT_THREADS,
     .name = "threads",
     .letter = 'j',
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "the CPUs that this process may use",
     .help = "threads to work with; the picture does not depend on it",
     .minimum = 1,
     .maximum = 1024},
    {.id = OPT_MAX_MEMORY,
     .name = "max-memory",
     .kind = OPTION_TEXT,
     .argument = "SIZE",
     .default_text = "80 % of what the machine or container has",
     .help = "give up (exit 7) rather than use more memory than this for data: 512M, 2G; 0: no limit"},
    {.id = OPT_MAX_TEXTURE,
     .name = "max-texture",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "16384",
     .help = "refuse images with more texels than this along an edge",
     .minimum = 1,
     .maximum = 65536},
    {.id = OPT_TIME_LIMIT,
     .name = "time-limit",
     .kind = OPTION_TEXT,
     .argument = "TIME",
     .help = "give up (exit 7) after this time for the whole command: 500ms, 30s, 5m"},
};

static const option message_options[] = {
    {.id = OPT_QUIET, .name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "errors only"},
    {.id = OPT_VERBOSE,
     .name = "verbose",
     .letter = 'v',
     .kind = OPTION_COUNT,
     .help = "details; twice (-vv) also timings"},
    {.id = OPT_JSON,
     .name = "json",
     .kind = OPTION_FLAG,
     .help = "the result as one JSON object on standard output"},
    {.id = OPT_STRICT, .name = "strict", .kind = OPTION_FLAG, .help = "warnings become exit code 1"},
    {.id = OPT_HELP, .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "this text"},
};

static const option running_options[] = {
    {.id = OPT_PROGRESS,
     .name = "progress",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "auto",
     .help =
         "auto shows a bar on a terminal and nothing elsewhere; plain and json write lines to standard error",
     .choices = WORDS("auto", "plain", "json", "none")},
    {.id = OPT_PRESET,
     .name = "preset",
     .kind = OPTION_CHOICE,
     .argument = "NAME",
     .help =
         "options in one word; what is given beside it wins. thumbnail: --size 256 --background transparent "
         "--time-limit 5s for each model --max-memory 1G --quiet, and --threads 1 when niced",
     .choices = WORDS("thumbnail")},
    {.id = OPT_CONFIG,
     .name = "config",
     .kind = OPTION_FILE,
     .argument = "FILE.json",
     .help = "options from a JSON object with the long names as members; the command line wins"},
};

static const option_group machine_group = {"Limits", machine_options, COUNT(machine_options)};
static const option_group message_group = {"Messages", message_options, COUNT(message_options)};
static const option_group running_group = {"Running", running_options, COUNT(running_options)};

/* ---- render ---- */

static const option image_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text = "the model's name with .png, in the current folder",
     .help = "the picture: .png .jpg .webp .exr .hdr .pfm, .y4m for a video, or - for standard output. "
             "{stem} becomes the model's "
             "name, #### or %04d the frame's number"},
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
    {.id = OPT_CROP,
     .name = "crop",
     .kind = OPTION_TEXT,
     .argument = "X,Y,W,H",
     .help = "draw only this part of the picture, in pixels from its top left"},
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
    {.id = OPT_AOV,
     .name = "aov",
     .kind = OPTION_CHOICES,
     .argument = "LIST",
     .help = "further layers of an .exr file, separated by commas",
     .choices = WORDS("depth", "normal", "albedo", "material", "uv", "occlusion")},
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
};

static const option light_options[] = {
    {.id = OPT_ENV,
     .name = "env",
     .letter = 'e',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text = "neutral",
     .help = "what lights the model: an equirectangular .hdr, .exr, .png or .jpg, neutral (a built-in "
             "studio), white "
             "or #rrggbb (the same from everywhere), none",
     .choices = WORDS("neutral", "white", "none")},
    {.id = OPT_ENV_ROTATION,
     .name = "env-rotation",
     .kind = OPTION_TEXT,
     .argument = "DEG",
     .default_text = "0",
     .help = "turn the environment around the upward axis"},
    {.id = OPT_ENV_INTENSITY,
     .name = "env-intensity",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "1",
     .help = "factor for the light of the environment",
     .minimum = 0,
     .maximum = 1e9},
    {.id = OPT_ENV_CACHE,
     .name = "env-cache",
     .kind = OPTION_FOLDER,
     .argument = "DIR",
     .help = "keep prepared environments there for the next run (at most 256 MiB)"},
    {.id = OPT_LIGHTS,
     .name = "lights",
     .kind = OPTION_CHOICE,
     .argument = "WHICH",
     .default_text = "scene",
     .help = "the file's own lights (KHR_lights_punctual, and EXT_lights_image_based unless --env is given), "
             "or none "
             "of them",
     .choices = WORDS("scene", "none")},
};

static const option color_options[] = {
    {.id = OPT_EXPOSURE,
     .name = "exposure",
     .kind = OPTION_TEXT,
     .argument = "STOPS",
     .default_text = "0",
     .help = "+1 is twice as bright; 2x is the factor 2, as exposure=\"2\" of model-viewer"},
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
     .help = "draft takes 1, normal 4, final 16 samples per pixel",
     .choices = WORDS("draft", "normal", "final")},
    {.id = OPT_SAMPLES,
     .name = "samples",
     .letter = 'n',
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "as --quality says",
     .help = "samples per pixel",
     .minimum = 1,
     .maximum = 4096},
    {.id = OPT_RENDERER,
     .name = "renderer",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .default_text = "preview",
     .help = "preview: prefiltered light, what real-time viewers show",
     .choices = WORDS("preview")},
    {.id = OPT_ENERGY,
     .name = "energy",
     .kind = OPTION_CHOICE,
     .argument = "MODE",
     .default_text = "gltf",
     .help =
         "gltf: the formulas of the specification; conserving: with light scattered several times on rough "
         "surfaces",
     .choices = WORDS("gltf", "conserving")},
    {.id = OPT_SPECULAR_AA,
     .name = "specular-aa",
     .kind = OPTION_FLAG,
     .help =
         "fewer sparkles on fine bumps: highlights are widened by how much the surface bends within a pixel"},
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

static const option model_options[] = {
    {.id = OPT_ROOT,
     .name = "root",
     .kind = OPTION_FOLDER,
     .argument = "DIR",
     .default_text = "the model's own folder",
     .help = "the folder that files named by the model must be in"},
};

static const option_group image_group = {"Picture", image_options, COUNT(image_options)};
static const option_group camera_group = {"Camera", camera_options, COUNT(camera_options)};
static const option_group light_group = {"Light", light_options, COUNT(light_options)};
static const option_group color_group = {"Color", color_options, COUNT(color_options)};
static const option_group quality_group = {"Quality", quality_options, COUNT(quality_options)};
static const option_group motion_group = {"Motion", motion_options, COUNT(motion_options)};
static const option_group scene_group = {"Scene", scene_options, COUNT(scene_options)};
static const option_group model_group = {"Files", model_options, COUNT(model_options)};

static const verb render_verb = {
    .name = "render",
    .summary = "draw a glTF model to a picture",
    .arguments = "[MODEL...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf",
    .description = "Reads each MODEL (.glb or .gltf; - is standard input) and draws it on the CPU: no GPU, "
                   "display or network "
                   "is needed. The whole model is in the picture unless --orbit, --eye or --camera say "
                   "otherwise. Without a "
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
            {"facet render *.glb -o 'thumbs/{stem}.png' --preset thumbnail",
             "small pictures of many models, into a folder that exists"},
            {"curl -s URL | facet render - -o - --format png > out.png", "without files"},
            {NULL, NULL}},
    .groups = (const option_group *const[]){&image_group, &camera_group, &light_group, &color_group,
                                            &quality_group, &motion_group, &scene_group, &model_group,
                                            &machine_group, &message_group, &running_group, NULL},
};

/* ---- convert ---- */

static const option convert_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "the new model, instead of a second name: .glb, or .gltf with a .bin and the images beside it"},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep a file that exists already, and say so (exit 0)"},
};
static const option_group convert_group = {"Output", convert_options, COUNT(convert_options)};

static const verb convert_verb = {
    .name = "convert",
    .summary = "write a glTF model anew, as one file or as several",
    .arguments = "MODEL NEW",
    .max_arguments = 2,
    .file_types = "glb gltf",
    .description = "Reads MODEL (.glb or .gltf; - is standard input) and writes it as NEW (.glb or .gltf): "
                   "meshes, materials "
                   "with all their extensions, textures as they are, motion, cameras, lights, variants, "
                   "metadata. What was "
                   "compressed (Draco, meshopt, quantised) is written plainly.\n\n"
                   "The output appears whole or not at all; of a .gltf file the other files come first.",
    .examples = (const example[]){{"facet convert scene.gltf scene.glb", "many files into one"},
                                  {"facet convert scene.glb scene.gltf", "to look at the JSON"},
                                  {"facet convert packed.glb plain.glb", "for a program that reads no Draco"},
                                  {NULL, NULL}},
    .groups =
        (const option_group *const[]){&convert_group, &model_group, &machine_group, &message_group, NULL},
};

/* ---- inspect, version, help ---- */

static const verb inspect_verb = {
    .name = "inspect",
    .summary = "say what is in a glTF model",
    .arguments = "MODEL...",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf",
    .description =
        "Reads each MODEL (.glb or .gltf; - is standard input) and prints counts, bounds, materials, "
        "textures, images, cameras, lights, the extensions with what facet makes of them, and the "
        "warnings of reading. With -v lists are printed to their end.\n\n"
        "The exit code is 0 when the model can be read, also with warnings (--strict: 1).",
    .examples = (const example[]){{"facet inspect helmet.glb", "for reading"},
                                  {"facet inspect helmet.glb --json | jq .materials", "for a program"},
                                  {"facet inspect --strict models/*.glb", "check many"},
                                  {NULL, NULL}},
    .groups = (const option_group *const[]){&model_group, &machine_group, &message_group, NULL},
};

static const option version_options[] = {
    {.id = OPT_VERBOSE,
     .name = "verbose",
     .letter = 'v',
     .kind = OPTION_COUNT,
     .help = "also compiler, libraries, CPU and threads: what a bug report needs"},
    {.id = OPT_JSON, .name = "json", .kind = OPTION_FLAG, .help = "as one JSON object"},
    {.id = OPT_HELP, .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "this text"},
};
static const option_group version_group = {"Options", version_options, COUNT(version_options)};

static const verb version_verb = {
    .name = "version",
    .summary = "say which facet this is",
    .arguments = "",
    .description = "Prints the version; with -v also how it was built and what it found on this machine.",
    .examples = (const example[]){{"facet version -v", "for a bug report"}, {NULL, NULL}},
    .groups = (const option_group *const[]){&version_group, NULL},
};

static const option help_options[] = {
    {.id = OPT_HELP, .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "this text"},
};
static const option_group help_group = {"Options", help_options, COUNT(help_options)};

static const verb help_verb = {
    .name = "help",
    .summary = "explain facet or one of its commands",
    .arguments = "[COMMAND]",
    .max_arguments = 1,
    .words = WORDS("render", "convert", "inspect", "version", "help", "exit-codes"),
    .description = "Prints what facet --help or facet COMMAND --help print; exit-codes explains those.",
    .examples = (const example[]){{"facet help render", "all options of render"},
                                  {"facet help exit-codes", "what 0 to 75 mean"},
                                  {NULL, NULL}},
    .groups = (const option_group *const[]){&help_group, NULL},
};

const verb *const verbs[] = {&render_verb, &convert_verb, &inspect_verb, &version_verb, &help_verb, NULL};

/* ---- looking up ---- */

const verb *verb_find(const char *name)
{
    for (const verb *const *v = verbs; *v; v++)
        if (strcmp((*v)->name, name) == 0)
            return *v;
    return NULL;
}

static bool is_among(const char *name, const char *const *words)
{
    for (; *words; words++)
        if (strcmp(name, *words) == 0)
            return true;
    return false;
}

bool verb_is_planned(const char *name)
{
    return is_among(name, WORDS("bake", "ocean", "view", "plot", "compare", "batch", "serve", "merge"));
}

bool option_is_planned(const char *name)
{
    return is_among(
        name, WORDS("sun", "ground", "bounces", "noise", "denoise", "seed", "material-override", "shard"));
}

const option *option_find(const verb *v, const char *name, size_t length)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (size_t i = 0; i < (*g)->option_count; i++) {
            const option *o = &(*g)->options[i];
            if (strlen(o->name) == length && memcmp(o->name, name, length) == 0)
                return o;
        }
    return NULL;
}

const option *option_find_letter(const verb *v, char letter)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (size_t i = 0; i < (*g)->option_count; i++)
            if ((*g)->options[i].letter == letter)
                return &(*g)->options[i];
    return NULL;
}

const option *option_find_id(const verb *v, option_id id)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (size_t i = 0; i < (*g)->option_count; i++)
            if ((*g)->options[i].id == id)
                return &(*g)->options[i];
    return NULL;
}
