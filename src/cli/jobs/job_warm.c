/* job_warm.c - see job_warm.h. */
#include "cli/jobs/job_warm.h"

#include "cli/shared/command_line.h"
#include "cli/shared/environment_input.h"
#include "cli/shared/environment_share.h"
#include "cli/shared/failure.h"

#include <string.h>

static facet_result prepare(const command_line *c, const environment_input *input, facet_error *error)
{
    facet_environment *environment = NULL;
    const facet_environment_desc desc = {.cache_folder = option_text(c, OPT_ENV_CACHE, NULL)};
    facet_result result = environment_input_load(input, &desc, &environment, error);
    if (result == FACET_OK && environment)
        result = facet_environment_prepare(environment, 0, error);
    if (result == FACET_OK && environment && environment_share(input, environment))
        return FACET_OK;
    facet_environment_destroy(environment);
    return result;
}

static facet_result warm(command_line *c, facet_error *error)
{
    config storage = {0};
    environment_input input;
    bool is_render = strcmp(c->verb->name, "render") == 0;
    facet_result result = config_apply(c, &storage, error);
    const char *text = option_text(c, OPT_ENV, is_render ? "neutral" : NULL);
    bool has_env = result == FACET_OK && text && option_find_id(c->verb, OPT_ENV);
    if (has_env)
        result = environment_input_parse("--env", text, ENVIRONMENT_TAKES_NONE, &input, error);
    if (has_env && result == FACET_OK && !environment_share_has(&input))
        result = prepare(c, &input, error);
    config_destroy(&storage);
    return result;
}

facet_result job_warm(const job_words *words, facet_error *error)
{
    command_line line = {.verb = NULL};
    TRY(job_words_check(words, error));
    const verb *v = verb_find(words->words[0]);
    facet_result result = command_line_parse(v, (int)words->count - 1, words->words + 1, &line, error);
    if (result == FACET_OK)
        result = warm(&line, error);
    command_line_destroy(&line);
    return result;
}
