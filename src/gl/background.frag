/* background.frag - the environment behind the model. */
in vec2 v_place;

out vec4 fragment;

void main()
{
    fragment = vec4(vec3(v_place.y * 0.2) * exposure, 1.0);
}
