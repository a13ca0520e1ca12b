/* lights.glsl - punctual lights (and the sun) that may reach a point: a loop over them is
 *     int count = light_count(P);
 *     for (int i = 0; i < count; i++)
 *         ... light_at(i) ...
 * P and the lights' positions are relative to the eye (m). With HAS_SHADOWS their intensity is what arrives at P. */
int light_count(vec3 P)
{
    return 0;
}

/* The i-th of them; light_count() comes first. */
Light light_at(int i)
{
    return light_point(vec3(0.0), vec3(0.0), 0.0);
}
