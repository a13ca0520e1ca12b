#!/bin/sh
# names.sh begin|end > header: what shade.h includes before and after the shader library for programs outside of its
# dialect. Macros of the same names, of the program or the standard library, are saved and restored; in C every function
# and type of the library gets the prefix shade_, and the constants remain as SHADE_ macros.
set -eu
here=$(dirname "$0")
part=${1:?begin or end}
headers=$(sed -n 's/^#include "\([a-z_]*\.h\)"$/\1/p' "$here/shade.h")
text() { for h in $headers; do cat "$here/$h"; done; }

words=$(sed -n 's/^#define \([A-Za-z_0-9]*\).*/\1/p' "$here/lang/lang_c.h" "$here/lang/lang_c_begin.h" | grep -v '^LANG_' | sort -u)
constants=$(text | sed -n 's/^#define \([A-Z_0-9]*\) ..*/\1/p')
functions=$(text | sed -n 's/^FN [A-Za-z0-9]* \([A-Za-z_0-9]*\)(.*/\1/p' | sort -u)
types=$(text | sed -n 's/^STRUCT(\([A-Za-z0-9]*\)).*/\1/p')
# macros of system headers that are identifiers in the library
system="I complex near far major minor unix linux"
all="$words $constants $functions $types $system"

if [ "$part" = begin ]; then
    echo "/* Written by shade/names.sh from the shader library. */"
    for name in $all; do printf '#pragma push_macro("%s")\n#undef %s\n' "$name" "$name"; done
    echo "#if !defined(__cplusplus)"
    for name in $functions; do echo "#define $name(...) shade_$name(__VA_ARGS__)"; done
    for name in $types; do echo "#define $name shade_$name"; done
    echo "#endif"
else
    echo "/* Written by shade/names.sh from the shader library. */"
    for name in $all; do printf '#undef %s\n#pragma pop_macro("%s")\n' "$name" "$name"; done
    # a constant may be made of others
    text | sed -n 's/^#define \([A-Z_0-9]*\) \(..*\)$/\1 \2/p' | sed 's: */\*.*::' | grep -v 'vec3(' |
        sed -e 's/^/#define SHADE_/'
fi
