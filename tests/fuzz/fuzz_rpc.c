/* fuzz_rpc.c - a line of JSON-RPC: what a client of facet serve sends, and the responses to it. */
#include "fuzz_support.h"

#include "cli/serve/rpc.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    rpc_message message;
    if (!rpc_parse((const char *)data, size, &message))
        return 0;
    if (message.count < 1 || message.count > RPC_MAX_CALLS)
        abort();
    text responses = {0};
    for (size_t i = 0; i < message.count; i++) {
        const rpc_call *call = &message.calls[i];
        if ((call->error != 0) != (call->problem != NULL) || (call->error && call->method) ||
            (call->params && !json_is_object(call->params)))
            abort();
        rpc_add_error(&responses, call->id, call->error, call->problem ? call->problem : "", NULL);
        rpc_add_result(&responses, call->id, "{}", 2);
    }
    if (responses.data && memchr(responses.data, '\n', responses.length)) /* a response is one line */
        abort();
    text_destroy(&responses);
    rpc_message_destroy(&message);
    return 0;
}
