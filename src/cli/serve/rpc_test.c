/* Tests of rpc.h with the examples of the specification, and with lines that are none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cli/serve/rpc.h"

static rpc_message parsed(const char *line)
{
    rpc_message message;
    assert_true(rpc_parse(line, strlen(line), &message));
    return message;
}

static void calls_are_read(void **state)
{
    (void)state;
    rpc_message m =
        parsed("{\"jsonrpc\":\"2.0\",\"method\":\"render\",\"params\":{\"size\":\"256\"},\"id\":\"a\"}");
    assert_int_equal(m.count, 1);
    assert_false(m.is_batch);
    assert_string_equal(m.calls[0].method, "render");
    assert_string_equal(json_string_value(m.calls[0].id), "a");
    assert_string_equal(json_string_value(json_object_get(m.calls[0].params, "size")), "256");
    rpc_message_destroy(&m);
    m = parsed("{\"jsonrpc\":\"2.0\",\"method\":\"foobar\"}");
    assert_null(m.calls[0].id);
    assert_int_equal(m.calls[0].error, 0);
    rpc_message_destroy(&m);
    m = parsed("{\"jsonrpc\":\"2.0\",\"method\":\"foobar\",\"id\":null}");
    assert_true(json_is_null(m.calls[0].id));
    rpc_message_destroy(&m);
}

static void batches_keep_their_order(void **state)
{
    (void)state;
    rpc_message m =
        parsed("[{\"jsonrpc\":\"2.0\",\"method\":\"a\",\"id\":1},{\"foo\":\"boo\"},1,"
               "{\"jsonrpc\":\"2.0\",\"id\":7,\"result\":{}},{\"jsonrpc\":\"2.0\",\"method\":\"b\"}]");
    assert_true(m.is_batch);
    assert_int_equal(m.count, 5);
    assert_string_equal(m.calls[0].method, "a");
    assert_int_equal(m.calls[1].error, RPC_INVALID_REQUEST);
    assert_int_equal(m.calls[2].error, RPC_INVALID_REQUEST);
    assert_true(m.calls[3].is_response);
    assert_string_equal(m.calls[4].method, "b");
    rpc_message_destroy(&m);
}

static void wrong_lines_have_one_error(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int error;
    } cases[] = {
        {"", RPC_PARSE_ERROR},
        {"{\"jsonrpc\": \"2.0\", \"method\": \"foobar, \"params\": \"bar\", \"baz]", RPC_PARSE_ERROR},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"a\",\"params\":{\"x\":NaN}}", RPC_PARSE_ERROR},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"a\",\"params\":{\"x\":1e999}}", RPC_PARSE_ERROR},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"id\":2,\"method\":\"a\"}", RPC_PARSE_ERROR},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"a\"} {}", RPC_PARSE_ERROR},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"a\\u0000b\"}", RPC_PARSE_ERROR},
        {"[]", RPC_INVALID_REQUEST},
        {"1", RPC_PARSE_ERROR}, /* jansson: a message is an object or an array */
        {"{\"jsonrpc\":\"1.0\",\"id\":1,\"method\":\"a\"}", RPC_INVALID_REQUEST},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":1,\"params\":\"bar\"}", RPC_INVALID_REQUEST},
        {"{\"jsonrpc\":\"2.0\",\"id\":{},\"method\":\"a\"}", RPC_INVALID_REQUEST},
        {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"a\",\"params\":[1]}", RPC_INVALID_PARAMS},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        rpc_message m = parsed(cases[i].line);
        assert_int_equal(m.count, 1);
        assert_int_equal(m.calls[0].error, cases[i].error);
        assert_non_null(m.calls[0].problem);
        assert_null(m.calls[0].method);
        rpc_message_destroy(&m);
    }
}

static void deep_and_long_messages_are_refused(void **state)
{
    (void)state;
    enum { DEPTH = 100000 };
    char *line = malloc(DEPTH);
    assert_non_null(line);
    memset(line, '[', DEPTH);
    rpc_message m;
    assert_true(rpc_parse(line, DEPTH, &m));
    assert_int_equal(m.calls[0].error, RPC_PARSE_ERROR);
    rpc_message_destroy(&m);
    line[0] = '[';
    for (size_t i = 1; i + 1 < DEPTH; i++)
        line[i] = i % 2 ? '1' : ',';
    line[DEPTH - 2] = '1';
    line[DEPTH - 1] = ']';
    assert_true(rpc_parse(line, DEPTH, &m));
    assert_int_equal(m.count, 1);
    assert_int_equal(m.calls[0].error, RPC_INVALID_REQUEST);
    rpc_message_destroy(&m);
    free(line);
}

static void responses_are_one_line(void **state)
{
    (void)state;
    text t = {0};
    json_t *id = json_string("x\ny");
    rpc_add_result(&t, id, "{\"a\":1}", 7);
    assert_string_equal(t.data, "{\"jsonrpc\":\"2.0\",\"id\":\"x\\ny\",\"result\":{\"a\":1}}");
    text_destroy(&t);
    rpc_add_error(&t, NULL, RPC_PARSE_ERROR, "a \"b\"\n", "{\"exit_code\":2}");
    assert_string_equal(t.data, "{\"jsonrpc\":\"2.0\",\"id\":null,\"error\":{\"code\":-32700,\"message\":\"a "
                                "\\\"b\\\"\\u000a\",\"data\":{\"exit_code\":2}}}");
    text_destroy(&t);
    json_decref(id);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_are_read),
        cmocka_unit_test(batches_keep_their_order),
        cmocka_unit_test(wrong_lines_have_one_error),
        cmocka_unit_test(deep_and_long_messages_are_refused),
        cmocka_unit_test(responses_are_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
