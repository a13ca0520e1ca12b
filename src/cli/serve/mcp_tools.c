/* mcp_tools.c - see mcp_tools.h. A schema holds the main options of the verb, those of its short help; the tool
 * options lists all of them, so that a session does not begin with a hundred descriptions. */
#include "cli/serve/mcp_tools.h"

#include <string.h>

static const mcp_tool tools[] = {
    {methods + 0, "render", "Render a 3D model",
     "Renders a model (glTF, OBJ, STL, PLY) and returns the image as PNG, " MCP_IMAGE_SIZE
     " unless size is given. With "
     "output "
     "the image is written to that file instead. The whole model is in the image unless orbit, eye or camera "
     "say "
     "otherwise.",
     true},
    {methods + 1, "inspect", "Describe a 3D model",
     "Returns what is in a model as JSON: meshes, materials, textures, animations, cameras, bounds, "
     "extensions, "
     "warnings.",
     false},
    {methods + 3, "compare", "Compare two images",
     "Measures the difference of two images (FLIP, SSIM, PSNR and others) and returns the numbers as JSON "
     "and the "
     "difference as a PNG image.",
     true},
    {methods + 2, "convert", "Convert a 3D model",
     "Converts a model between formats (.glb, .gltf, .obj, .json of OpenGL 1 materials), with its materials, "
     "and writes "
     "it to output.",
     true},
    {NULL, "options", "List the options of a tool",
     "Lists all options of another tool with their values and defaults; each is an argument of that tool by "
     "the same name.",
     false},
};
enum { TOOL_COUNT = sizeof tools / sizeof *tools };

const mcp_tool *mcp_tool_find(const char *name)
{
    for (size_t i = 0; i < TOOL_COUNT; i++)
        if (strcmp(tools[i].name, name) == 0)
            return &tools[i];
    return NULL;
}

/* ---- schemas ---- */

/* "help; N, default X". */
static void add_description(text *out, const mcp_tool *tool, const option *o)
{
    bool is_image_size = tool->method->verb == &render_verb && o->id == OPT_SIZE;
    const char *default_text = is_image_size ? MCP_IMAGE_SIZE : o->default_text;
    text sentence = {0};
    text_add(&sentence, o->help);
    if (o->argument && o->kind != OPTION_CHOICE && o->kind != OPTION_CHOICES)
        text_addf(&sentence, "; %s", o->argument);
    if (default_text)
        text_addf(&sentence, " (default: %s)", default_text);
    text_json_string(out, "description", sentence.data);
    text_destroy(&sentence);
}

static void add_enum(text *out, const char *const *choices)
{
    text_json_begin_array(out, "enum");
    for (; *choices; choices++)
        text_json_string(out, NULL, *choices);
    text_json_end_array(out);
}

static void add_number(text *out, const char *key, double value)
{
    char digits[TEXT_FLOAT_SIZE];
    text_shortest_double(value, digits);
    text_json_raw(out, key, digits);
}

static void add_option(text *out, const mcp_tool *tool, const option *o)
{
    bool is_number = o->kind == OPTION_NUMBER || o->kind == OPTION_INTEGER;
    text_json_begin_object(out, o->name);
    text_json_string(out, "type",
                     o->kind == OPTION_FLAG      ? "boolean"
                     : o->kind == OPTION_NUMBER  ? "number"
                     : o->kind == OPTION_INTEGER ? "integer"
                                                 : "string");
    if (o->kind == OPTION_CHOICE)
        add_enum(out, o->choices);
    if (is_number) {
        add_number(out, "minimum", o->minimum);
        add_number(out, "maximum", o->maximum);
    }
    add_description(out, tool, o);
    text_json_end_object(out);
}

/* Whether an option is an argument of tools: files only where a path makes sense. */
static bool is_argument(const option *o)
{
    return o && o->id != OPT_OUTPUT && parameter_use_of(o) != PARAMETER_REFUSED;
}

static void add_text_property(text *out, const char *name, const char *description)
{
    text_json_begin_object(out, name);
    text_json_string(out, "type", "string");
    text_json_string(out, "description", description);
    text_json_end_object(out);
}

static void add_properties(text *out, const mcp_tool *tool)
{
    const method *m = tool->method;
    text_json_begin_object(out, "properties");
    if (!m) {
        text_json_begin_object(out, "tool");
        text_json_string(out, "type", "string");
        add_enum(out, OPTION_WORDS("render", "inspect", "compare", "convert"));
        text_json_end_object(out);
    }
    for (int i = 0; m && m->inputs[i]; i++)
        add_text_property(out, m->inputs[i], m->input_help);
    if (m && tool->writes)
        add_text_property(out, "output",
                          "path of the file to write, in the folder that the server may write to");
    const option_id *basics = m ? m->verb->basics : NULL;
    if (m && basics)
        for (; *basics != OPTION_ID_COUNT; basics++)
            if (is_argument(option_find_id(m->verb, *basics)))
                add_option(out, tool, option_find_id(m->verb, *basics));
    const option *o;
    for (size_t i = 0; m && !basics && (o = option_at(m->verb, i)); i++)
        if (is_argument(o))
            add_option(out, tool, o);
    text_json_end_object(out);
}

static void add_required(text *out, const mcp_tool *tool)
{
    text_json_begin_array(out, "required");
    for (int i = 0; tool->method && tool->method->inputs[i]; i++)
        text_json_string(out, NULL, tool->method->inputs[i]);
    if (!tool->method)
        text_json_string(out, NULL, "tool");
    else if (tool->method->verb == &convert_verb)
        text_json_string(out, NULL, "output");
    text_json_end_array(out);
}

void mcp_tools_list(text *out)
{
    text_json_begin_object(out, NULL);
    text_json_begin_array(out, "tools");
    for (size_t i = 0; i < TOOL_COUNT; i++) {
        const mcp_tool *tool = &tools[i];
        text_json_begin_object(out, NULL);
        text_json_string(out, "name", tool->name);
        text_json_string(out, "title", tool->title);
        text_json_string(out, "description", tool->description);
        text_json_begin_object(out, "inputSchema");
        text_json_string(out, "type", "object");
        add_properties(out, tool);
        add_required(out, tool);
        text_json_end_object(out);
        text_json_begin_object(out, "annotations");
        text_json_bool(out, "readOnlyHint", !tool->writes);
        text_json_bool(out, "destructiveHint", tool->writes); /* a file of the same name is replaced */
        text_json_bool(out, "idempotentHint", true);
        text_json_bool(out, "openWorldHint", false);
        text_json_end_object(out);
        text_json_end_object(out);
    }
    text_json_end_array(out);
    text_json_end_object(out);
}

bool mcp_tool_options(const char *name, text *out)
{
    const mcp_tool *tool = mcp_tool_find(name);
    if (!tool || !tool->method)
        return false;
    const option *o;
    for (size_t i = 0; (o = option_at(tool->method->verb, i)); i++) {
        if (!is_argument(o))
            continue;
        text_addf(out, "%s%s%s: %s", o->name, o->argument ? " " : "",
                  o->argument ? o->argument : " (true or false)", o->help);
        if (o->kind == OPTION_CHOICE || o->kind == OPTION_CHOICES)
            for (const char *const *c = o->choices; *c; c++)
                text_addf(out, "%s%s", c == o->choices ? "; one of " : ", ", *c);
        if (o->default_text)
            text_addf(out, " (default: %s)", o->default_text);
        text_add(out, "\n");
    }
    return true;
}
