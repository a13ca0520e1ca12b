/* light.c - see light.h. */
#include "light.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "files.h"

struct web_light {
    web_light *next;
    char *text;      /* NULL: of a scene */
    unsigned number; /* of the file; 0: none */
    unsigned uses;
    facet_environment *environment;
};

static web_light *first;

static web_light *find(const char *text, unsigned number)
{
    web_light *light = first;
    while (light && (!light->text || strcmp(light->text, text) != 0 || light->number != number))
        light = light->next;
    return light;
}

static facet_result keep(facet_environment *environment, const char *text, unsigned number, web_light **out,
                         facet_error *error)
{
    web_light *light = calloc(1, sizeof *light);
    if (light && text)
        light->text = strdup(text);
    if (!light || (text && !light->text)) {
        free(light);
        facet_environment_destroy(environment);
        return fail_memory(error, "light", sizeof *light);
    }
    light->next = first;
    light->number = number;
    light->uses = 1;
    light->environment = environment;
    first = light;
    *out = light;
    return FACET_OK;
}

static facet_result load(const environment_input *input, const web_file *file, bool is_alike,
                         const facet_environment_desc *desc, facet_environment **environment,
                         facet_error *error)
{
    if (input->kind == ENVIRONMENT_FACES)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "--env: six files are not read in a browser; facet bake makes one .ktx2 of them");
    if (input->kind != ENVIRONMENT_FILE)
        return environment_input_create(input, desc, environment, error);
    if (!file)
        return fail(error, FACET_ERROR_READ, "%s: there is no such file", input->path);
    if (is_alike)
        log_warning(&desc->log, "there is no file \"%.200s\"; \"%.200s\" is read instead", input->path,
                    file->path);
    return facet_environment_load_memory(file->bytes, file->size, file->path, desc, environment, error);
}

facet_result web_light_create(const char *text, const environment_input *input,
                              const facet_environment_desc *desc, web_light *last, web_light **out,
                              facet_error *error)
{
    facet_environment *environment = NULL;
    bool is_alike = false;
    const bool is_file = input->kind == ENVIRONMENT_FILE;
    const web_file *file = is_file ? web_files_find(input->path, &is_alike) : NULL;
    web_light *light = find(text, file ? file->number : 0);
    if (is_file && !file && last && strcmp(last->text, text) == 0)
        light = last;
    *out = light;
    if (light) {
        light->uses++;
        return FACET_OK;
    }
    TRY(load(input, file, is_alike, desc, &environment, error));
    return keep(environment, text, file ? file->number : 0, out, error);
}

facet_result web_light_create_from_scene(const facet_scene *scene, const facet_pose_desc *pose,
                                         const facet_environment_desc *desc, web_light **out,
                                         facet_error *error)
{
    facet_environment *environment;
    TRY(facet_environment_create_from_scene(scene, pose, desc, &environment, error));
    return keep(environment, NULL, 0, out, error);
}

void web_light_release(web_light *light)
{
    if (!light || --light->uses)
        return;
    web_light **link = &first;
    while (*link != light)
        link = &(*link)->next;
    *link = light->next;
    facet_environment_destroy(light->environment);
    free(light->text);
    free(light);
}

web_light *web_light_keep_file(web_light *light, web_light *last, const char *text)
{
    const bool is_file = light && light->number;
    if (is_file)
        light->uses++;
    if (!is_file && last && strcmp(last->text, text) == 0)
        return last;
    web_light_release(last);
    return is_file ? light : NULL;
}

facet_environment *web_light_get(const web_light *light)
{
    return light ? light->environment : NULL;
}
