/* header.c - facet.h compiles alone, as C11 and, with -x c++, as C++. */
#include "facet/facet.h"

static facet_render_desc desc; /* {0} is valid */

int main(void)
{
    return desc.width == 0 && facet_version()[0] ? 0 : 1;
}
