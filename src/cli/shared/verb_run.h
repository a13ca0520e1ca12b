/* verb_run.h - the common frame of verbs: --config, limits, memory budget, messages, the object of --json
 * and the exit code. A verb embeds a verb_run as the first member of its state and provides a verb_work. */
#ifndef CLI_VERB_RUN_H
#define CLI_VERB_RUN_H

#include "cli/shared/command_line.h"
#include "cli/shared/limits.h"
#include "cli/shared/messages.h"
#include "cli/shared/model_list.h"

#include <jansson.h>

typedef struct verb_run verb_run;

/* The functions of a verb, in calling order. */
typedef struct verb_work {
    /* Reads the command line, limits included: nothing is loaded, made or written yet. */
    facet_result (*read)(verb_run *run, facet_error *error);
    /* Does the work, with a memory budget and the time limit. FACET_ERROR_CANCELLED after a signal. */
    facet_result (*work)(verb_run *run, facet_error *error);
    /* Adds the verb's own members to the object of --json; NULL: the verb prints JSON itself. */
    void (*add_json)(const verb_run *run, json_t *root);
    void (*destroy)(verb_run *run); /* {0} is allowed */
} verb_work;

/* {0}, with line. */
struct verb_run {
    command_line *line;
    const verb_work *work;
    limits limits; /* verb_work.read writes it */
    messages messages;
    progress_mode progress;
    facet_budget *budget;
    facet_allocator allocator;   /* of the budget */
    double start_s;              /* interrupt_clock() */
    json_t *failures, *warnings; /* lists; NULL without --json */
    size_t input_count;          /* of verb_run_models() */
    size_t failure_count, warning_count;
    int failure_code;    /* exit code of the last failure */
    bool has_failed;     /* verb_work.work did */
    bool is_negative;    /* the answer is exit code 1 */
    bool is_interrupted; /* by a signal; the outputs so far are valid */
};

/* Runs the verb of c: everything from --config to the exit code, which it returns. */
int verb_run_all(verb_run *run, command_line *c, const verb_work *parts);

/* Calls each() for all models in order. Failures, which must name their file, are reported, and the next
 * model follows; warnings are printed per model. Stops after a signal and if standard output is closed. */
void verb_run_models(verb_run *run, const model_list *models,
                     facet_result (*each)(verb_run *run, size_t index, facet_error *error));

/* Descs for environments and models with the run's budget, messages and limits; for models also with
 * --root and the options of OBJ files and OpenGL 1 materials. Text stays with the command line. */
facet_environment_desc verb_run_environment_desc(verb_run *run, const char *cache_folder);
facet_scene_desc verb_run_scene_desc(verb_run *run);

#endif
