/* fuzz_config.c - JSON of --config, for the verb that the first byte chooses. */
#include "fuzz_support.h"

#include "cli/shared/command_line.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t choice;
    fuzz_take(&data, &size, &choice, 1);
    size_t verb_count = 0;
    while (verbs[verb_count])
        verb_count++;
    const verb *v = verbs[choice % verb_count];
    if (!option_find_id(v, OPT_CONFIG))
        return 0;
    char *words[] = {(char[]){"--config"}, (char *)(uintptr_t)fuzz_file(data, size)};
    command_line c;
    facet_error error = {0};
    facet_result result = command_line_parse(v, 2, words, &c, &error);
    config storage = {0};
    if (result == FACET_OK)
        result = config_apply(&c, &storage, &error);
    fuzz_check_error(result, &error);
    config_destroy(&storage);
    command_line_destroy(&c);
    return 0;
}
