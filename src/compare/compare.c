/* compare.c - see compare.h. */
#include "compare/compare.h"

typedef int compare_is_not_there_yet;
