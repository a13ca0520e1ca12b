/* sheet_words_none.c - no text in builds without cairo. */
#include "report/sheet_words.h"

#include "base/result.h"

facet_result sheet_write_words(const sheet_word *words, uint32_t count, const facet_allocator *allocator,
                               image *target, facet_error *error)
{
    (void)words, (void)count, (void)allocator, (void)target;
    return fail(error, FACET_ERROR_UNSUPPORTED, "this build writes no words; build it with cairo");
}
