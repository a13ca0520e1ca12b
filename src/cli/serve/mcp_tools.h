/* mcp_tools.h - the tools that agents see over the Model Context Protocol, with schemas of their arguments from
 * the table of options. */
#ifndef CLI_SERVE_MCP_TOOLS_H
#define CLI_SERVE_MCP_TOOLS_H

#include "base/text.h"
#include "cli/serve/method.h"

/* Of an image that an agent asks for without a size: it is cheap to look at. */
#define MCP_IMAGE_SIZE "640x480"

typedef struct mcp_tool {
    const method *method; /* NULL: the tool options, which describes the others */
    const char *name, *title, *description;
    bool writes; /* files below the root, beside what it returns */
} mcp_tool;

const mcp_tool *mcp_tool_find(const char *name); /* NULL: none */
/* Appends the result of tools/list. */
void mcp_tools_list(text *out);
/* Appends all options of a tool, one a line. False: there is no such tool. */
bool mcp_tool_options(const char *name, text *out);

#endif
