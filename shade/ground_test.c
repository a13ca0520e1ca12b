/* ground_test.c - the fade of a shadow towards the border of the image. */
#include "testing/test_support.h"

static void fade_is_0_at_the_border_and_1_inside(void **state)
{
    (void)state;
    for (int i = 0; i <= 64; i++) {
        float at = (float)i / 64.0f;
        assert_true(ground_fade(vec2(at, 0.0f)) == 0.0f && ground_fade(vec2(1.0f, at)) == 0.0f);
        assert_true(ground_fade(vec2(at, 1.0f)) == 0.0f && ground_fade(vec2(0.0f, at)) == 0.0f);
    }
    assert_true(ground_fade(vec2(0.5f, 0.5f)) == 1.0f);
    assert_true(ground_fade(vec2(0.2f, 0.75f)) > 0.99999f);
}

static void fade_is_symmetric_and_grows_inwards(void **state)
{
    (void)state;
    float before = 0.0f;
    for (int i = 0; i <= 32; i++) {
        float at = (float)i / 64.0f;
        float fade = ground_fade(vec2(at, 0.3f));
        assert_true(fade >= before && fade <= 1.0f);
        assert_true(fade == ground_fade(vec2(1.0f - at, 0.3f)) && fade == ground_fade(vec2(0.3f, at)));
        before = fade;
    }
    /* opacity .3 at the middle of the outermost pixel of 256 is below half a code of 8 bits */
    assert_true(0.3f * ground_fade(vec2(0.5f / 256.0f, 0.5f)) < 0.5f / 255.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fade_is_0_at_the_border_and_1_inside),
        cmocka_unit_test(fade_is_symmetric_and_grows_inwards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
