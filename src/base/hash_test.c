/* Tests of hash.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/hash.h"

/* Of the reference implementation (SMHasher), every length of the last block, with and without a seed. */
static void hashes_are_those_of_the_reference(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint32_t seed, hash;
    } cases[] = {
        {"", 0, 0u},
        {"", 1, 0x514e28b7u},
        {"", 0xffffffffu, 0x81f16f39u},
        {"a", 0x9747b28cu, 0x7fa09ea6u},
        {"aa", 0x9747b28cu, 0x5d211726u},
        {"aaa", 0x9747b28cu, 0x283e0130u},
        {"aaaa", 0x9747b28cu, 0x5a97808au},
        {"abc", 0, 0xb3dd93fau},
        {"Hello, world!", 0x9747b28cu, 0x24884cbau},
        {"The quick brown fox jumps over the lazy dog", 0x9747b28cu, 0x2fa826cdu},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_int_equal(murmur3(cases[i].text, strlen(cases[i].text), cases[i].seed), cases[i].hash);
    assert_int_equal(murmur3("\xff\xff\xff\xff", 4, 0), 0x76293b50u);
    assert_int_equal(murmur3("\0\0\0", 3, 0), 0x85f0b427u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hashes_are_those_of_the_reference)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
