/* environment_share.h - environments that were prepared once, before this process forked children: each child takes the
 * one that it needs, in pages of memory shared with its parent, instead of loading it. */
#ifndef CLI_ENVIRONMENT_SHARE_H
#define CLI_ENVIRONMENT_SHARE_H

#include "cli/shared/environment_input.h"

/* Keeps environment under the words of input and takes the reference. False: 8 are kept already, or there is no memory;
 * the caller then keeps the reference. */
bool environment_share(const environment_input *input, facet_environment *environment);

/* The environment that is kept under the words of input, if its files have not changed since; the caller then owns it, and
 * another call does not find it: for a child, which loads an environment once. NULL: none. */
facet_environment *environment_share_take(const environment_input *input);

/* Whether environment_share_take() would find one. */
bool environment_share_has(const environment_input *input);

#endif
