/* ibl_sheet_words_none.c - no text in builds without cairo. */
#include "report/ibl_sheet_words.h"

#include "base/result.h"

facet_result sheet_write_words(const sheet_word *words, uint32_t count, const facet_allocator *allocator,
                               image *picture, facet_error *error)
{
    (void)words, (void)count, (void)allocator, (void)picture;
    return fail(error, FACET_ERROR_UNSUPPORTED, "this build writes no words; build it with cairo");
}
